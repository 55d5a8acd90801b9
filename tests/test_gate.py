"""The gate as CI uses it: the workflow of the CI guide, run; `check --baseline`, `--waivers`, `diff` and `report --to`."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pyarrow.parquet as pq
import pytest
import yaml

from drivelint import demo as demo_files
from drivelint.guide import FOLDER
from drivelint.report import outputs
from tests.fleet_report.command import ran as ran_here
from tests.shared_data import ROOT

GUIDE = (FOLDER / "ci.md").read_text(encoding="utf-8")
OVERTAKE = ROOT / "fixtures" / "overtake"
ON_ROAD = ["--map", str(OVERTAKE / "road.xodr"), "--mapping", str(OVERTAKE / "mapping.toml"), "--quiet"]
ON_ROAD += ["--no-robustness"]  # tests/gate has how sure a finding is
SDA = ["--rules", "ukhc.r162.safe-distance-ahead", "--profile", "nominal"]  # one finding for each drive that fails
SAFE, NEAR, COLLISION = (str(OVERTAKE / f"{name}.csv") for name in ("safe", "near_miss", "collision"))

Ran = Callable[..., tuple[int, str, str]]


@pytest.fixture(autouse=True)
def empty_folder(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Return result folders: base (safe, near miss), new (these and the collision)."""
    folder = tmp_path_factory.mktemp("results")
    made = {}
    for name, traces in (("base", [SAFE, NEAR]), ("new", [SAFE, NEAR, COLLISION])):
        command = ["check", *traces, *ON_ROAD, *SDA, "--no-annotate", "--out", str(folder / name)]
        done = ran_here(*command)
        assert done.code == 1, done.err
        made[name] = folder / name
    return made


def block(mark: str) -> str:
    """Return the code block of the CI guide behind a mark."""
    found = re.search(rf"<!-- {re.escape(mark)} -->\n```\w+\n(.*?)```", GUIDE, re.DOTALL)
    assert found, mark
    return found.group(1)


class Workflow:
    """The workflow of the CI guide in a folder of its own, with a `gh` that only notes what it was asked to do."""

    def __init__(self, folder: Path) -> None:
        self.steps: list[dict[str, Any]] = yaml.safe_load(block("workflow: gate"))["jobs"]["check"]["steps"]
        self.folder = folder
        self.kept: Path | None = None
        tools = folder / "tools"
        tools.mkdir()
        (tools / "drivelint").write_text(f'#!/bin/sh\nexec "{sys.executable}" -m drivelint "$@"\n', encoding="utf-8")
        (tools / "gh").write_text(f'#!/bin/sh\nprintf "%s " "$@" > "{folder}/asked"\n', encoding="utf-8")
        for tool in tools.iterdir():
            tool.chmod(0o755)
        path = f"{tools}{os.pathsep}{os.environ['PATH']}"
        self.env = {**os.environ, "PATH": path, "PYTHONPATH": str(ROOT / "src"), "NUMBER": "7"}
        self.env["GITHUB_STEP_SUMMARY"] = str(folder / "summary.md")

    def run(self, *, on_main: bool, drives: list[str], demo: Path) -> tuple[int, str]:
        """Run every step for these drives; return the exit code of the check and the outcome's page."""
        for name in ("drives", "results", "baseline"):
            shutil.rmtree(self.folder / name, ignore_errors=True)
        (self.folder / "summary.md").unlink(missing_ok=True)
        (self.folder / "asked").unlink(missing_ok=True)
        (self.folder / "drives").mkdir()
        for drive in drives:
            shutil.copy(demo / f"{drive}.mcap", self.folder / "drives")
        shutil.copy(demo / "road.xodr", self.folder)
        (self.folder / "waivers.toml").write_text(block("file: waivers.toml"), encoding="utf-8")
        code = 0
        for step in self.steps:
            condition = step.get("if", "")
            if ("refs/heads/main" in condition and not on_main) or ("pull_request" in condition and on_main):
                continue
            ended = self._step(step)
            if step.get("name") == "Check the drives":
                code = ended
            else:
                assert ended == 0, step
        return code, (self.folder / "summary.md").read_text(encoding="utf-8")

    def _step(self, step: dict[str, Any]) -> int:
        action = step.get("uses", "").partition("@")[0]
        if action == "actions/cache/save":
            self.kept = self.folder / "cache"
            shutil.rmtree(self.kept, ignore_errors=True)
            shutil.copytree(self.folder / step["with"]["path"], self.kept)
        elif action == "actions/cache/restore" and self.kept:
            shutil.copytree(self.kept, self.folder / step["with"]["path"])
        if action or "pip install" in step["run"]:
            return 0
        command = ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", step["run"]]  # as the runner does
        done = subprocess.run(
            command, cwd=self.folder, env=self.env, check=False, capture_output=True, text=True, timeout=300
        )
        assert "error:" not in done.stderr, done.stderr
        return done.returncode


@pytest.mark.slow
def test_the_guides_workflow_stops_what_is_new_and_nothing_else(tmp_path: Path) -> None:
    demo = tmp_path / "demo"
    demo_files.write(demo)
    (tmp_path / "work").mkdir()
    workflow = Workflow(tmp_path / "work")

    code, page = workflow.run(on_main=True, drives=["safe", "near-miss"], demo=demo)
    assert code == 1, "main has a near miss, and no earlier result"
    assert "waived until 2099-12-31 by jo@" in page
    assert not (workflow.folder / "asked").exists()

    code, page = workflow.run(on_main=False, drives=["safe", "near-miss"], demo=demo)
    assert code == 0, page
    assert page.startswith("## drivelint: FINDINGS, exit 0\n\nno new finding; ")
    assert (workflow.folder / "asked").read_text(encoding="utf-8").split() == (
        ["pr", "comment", "7", "--body-file", "results/report.md", "--edit-last", "--create-if-none"]
    )

    code, page = workflow.run(on_main=False, drives=["safe", "near-miss", "collision"], demo=demo)
    assert code == 1
    assert "### New findings (" in page
    assert "`ukhc.no-collision`" in page.partition("### New findings")[2].partition("<details>")[0]


def test_check_against_a_baseline_exits_1_only_for_what_is_new(results: dict[str, Path], ran: Ran) -> None:
    base = ["--baseline", str(results["base"])]
    code, out, _ = ran("check", SAFE, NEAR, *ON_ROAD, *SDA, *base)
    assert code == 0
    assert "exit 0: nothing new failed at or above severity critical (of that severity 1 known)" in out
    code, out, _ = ran("check", NEAR, COLLISION, *ON_ROAD, *SDA, *base, "--out", "again", "--no-annotate")
    assert code == 1
    assert "exit 1: 1 new finding at or above severity critical" in out
    assert "FAIL  2 findings in 2 of 2 drives: 1 new (1 critical), 1 known" in out
    gate = json.loads(Path("again/gate.json").read_text(encoding="utf-8"))["gate"]
    assert [entry["standing"] for entry in gate["baseline"]["entries"]] == ["new", "unchanged"]
    assert gate["baseline"]["base_only"][0].startswith("safe-")
    told = json.loads(Path("again/summary.json").read_text(encoding="utf-8"))
    assert (told["exit"]["code"], told["gate"]["baseline"]["new"]) == (1, 1)


@pytest.mark.slow
def test_tables_do_not_depend_on_the_gate(results: dict[str, Path], ran: Ran) -> None:
    Path("drivelint.toml").write_text(block("file: waivers.toml"), encoding="utf-8")
    base = ["--baseline", str(results["base"]), "--today", "2100-01-01"]
    ran("check", SAFE, NEAR, COLLISION, *ON_ROAD, *SDA, *base, "--no-annotate", "--out", "gated")
    for table in sorted(results["new"].glob("*.parquet")):
        assert (Path("gated") / table.name).read_bytes() == table.read_bytes(), table.name
    assert not (results["new"] / "gate.json").exists()


@pytest.mark.slow
def test_waivers_in_the_settings_and_in_a_file_until_their_day(ran: Ran) -> None:
    text = '[[waiver]]\nrule = "ukhc.r162.*"\nreason = "r"\nowner = "jo"\nexpires = 2027-03-31\n'
    Path("drivelint.toml").write_text(f'quiet = true\n{text}drive = "collision*"\n', encoding="utf-8")
    check = ["check", COLLISION, *ON_ROAD, *SDA]
    assert ran(*check, "--today", "2027-03-31")[0] == 0
    code, out, _ = ran(*check, "--today", "2027-04-01")
    assert code == 1
    assert "drivelint.toml:2: expired 2027-03-31 (jo): it has no effect; 1 finding matches it" in out
    Path("more.toml").write_text(f"# ours\n{text.replace('162', '126')}", encoding="utf-8")
    code, out, _ = ran(*check, "--today", "2027-01-01", "--waivers", "more.toml", "--format", "json")
    told = json.loads(out)["gate"]
    assert (code, told["waived_findings"], told["waivers"]) == (0, 1, {"active": 1, "expired": 0, "unmatched": 1})
    assert told["notes"] == ["more.toml:2: no finding matches ukhc.r126.* (jo); correct or remove it"]
    assert ran("inspect", COLLISION, *ON_ROAD[:-2])[0] == 0, "waivers are no option of other commands"


MISTAKES = [
    pytest.param(["--baseline", "nowhere"], "nowhere: no result of drivelint check", id="no baseline"),
    pytest.param(["--baseline", "out", "--out", "out"], "is also --out", id="the baseline is overwritten"),
    pytest.param(["--waivers", "nowhere.toml"], "nowhere.toml: no such file of waivers", id="no waivers"),
    pytest.param(["--waivers", "w.toml"], "w.toml:1: waiver: owner and expires missing", id="nobody answers"),
    pytest.param(["--waivers", "w.toml", "--today", "tomorrow"], "--today 'tomorrow'", id="no day"),
]


@pytest.mark.parametrize(("args", "says"), MISTAKES)
def test_a_mistake_is_told_before_anything_is_judged(args: list[str], says: str, ran: Ran) -> None:
    Path("w.toml").write_text('[[waiver]]\nrule = "*"\nreason = "r"\n', encoding="utf-8")
    code, out, err = ran("check", "no-such-log.csv", *args)
    assert (code, out) == (2, "")
    assert says in err
    assert len(err.splitlines()) == 1


def test_a_day_in_the_settings_would_keep_waivers_alive(ran: Ran) -> None:
    Path("drivelint.toml").write_text('today = "2026-01-01"\n', encoding="utf-8")
    code, _, err = ran("check", COLLISION, *ON_ROAD, *SDA)
    assert code == 2
    assert "unknown setting 'today'" in err


def test_diff_of_two_results(results: dict[str, Path], ran: Ran) -> None:
    base, new = str(results["base"]), str(results["new"])
    code, out, err = ran("diff", base, new)
    assert (code, err) == (1, "")
    assert "1 new, 1 unchanged" in out
    assert out.endswith("exit 1: 1 new finding at or above severity critical\n")
    assert ran("diff", base, new, "--fail-on", "never")[0] == 0
    assert ran("diff", base, base)[0] == 0
    code, out, _ = ran("diff", new, base)
    assert code == 4
    assert "gone but not fixed: 1 not judged now" in out, "a drive that was left out fixes nothing"
    code, out, _ = ran("diff", base, new, "--format", "json")
    assert (code, json.loads(out)["exit"]["code"]) == (1, 1)
    code, out, _ = ran("diff", base, new, "--format", "markdown")
    assert code == 1
    assert out.startswith("## drivelint diff: 1 new")
    assert ran("diff", base, "nowhere")[0] == 2


@pytest.mark.ci
def test_a_log_of_another_content_is_matched_by_its_name(results: dict[str, Path], ran: Ran) -> None:
    """As where a simulation is repeated: the id of the drive and of the finding are others."""
    text = Path(NEAR).read_text(encoding="utf-8").rstrip("\n").splitlines()
    Path("near_miss.csv").write_text("\n".join(text[:-3]) + "\n", encoding="utf-8")  # the last step is cut off
    args = ["check", "near_miss.csv", *ON_ROAD, *SDA, "--no-annotate", "--baseline", str(results["base"])]
    assert ran(*args, "--out", "out")[0] == 0
    entry, *_ = json.loads(Path("out/gate.json").read_text(encoding="utf-8"))["gate"]["baseline"]["entries"]
    assert entry["standing"] in {"unchanged", "changed"}
    assert entry["finding_id"] != entry["base_id"]


@pytest.mark.slow
def test_a_collision_is_not_fixed_by_a_log_in_which_the_other_car_ends_before_it(ran: Ran) -> None:
    header, *rows = Path(COLLISION).read_text(encoding="utf-8").splitlines()
    Path("cut").mkdir()
    kept = [row for row in rows if not (row.split(",")[1] == "oncoming" and float(row.split(",")[0]) > 6)]
    Path("cut/collision.csv").write_text("\n".join([header, *kept, ""]), encoding="utf-8")
    rules = ["--rules", "ukhc.no-collision", "--rules", "ukhc.contact-signature", "--no-annotate", "--no-robustness"]
    assert ran("check", COLLISION, *ON_ROAD, *rules, "--out", "base")[0] == 1
    code, out, _ = ran("check", "cut/collision.csv", *ON_ROAD, *rules, "--baseline", "base", "--out", "new")
    assert code == 4, out
    assert "gone but not fixed: 2 unknown now" in " ".join(out.split())
    entries = json.loads(Path("new/gate.json").read_text(encoding="utf-8"))["gate"]["baseline"]["entries"]
    whys = [entry["why"] for entry in entries]
    assert sorted(whys) == [
        "object oncoming is recorded only from 0.00 s to 6.00 s",
        "object oncoming is recorded only until 6.000 s, 58 m away from the ego, but the ego until 18.000 s: record it for as long",
    ]


@pytest.mark.ci
def test_each_report_is_written_from_the_folder_alone(results: dict[str, Path], ran: Ran, tmp_path: Path) -> None:
    folder = tmp_path / "copy"
    folder.mkdir()
    for file in (*results["new"].glob("*.parquet"), results["new"] / "summary.json"):
        shutil.copy(file, folder)
    for kind, (name, _) in outputs.REPORT_FORMATS.items():
        code, out, err = ran("report", str(folder), "--to", kind)
        assert (code, out, err) == (0, f"{folder / name}\n", "")
        first = (folder / name).read_bytes()
        assert b"safe-distance-ahead" in first
        ran("report", str(folder), "--to", kind)
        assert (folder / name).read_bytes() == first
    assert (folder / "junit.xml").read_bytes() == (results["new"] / "junit.xml").read_bytes()


@pytest.mark.slow
def test_a_new_run_leaves_no_report_of_an_older_one(ran: Ran) -> None:
    Path("w.toml").write_text(block("file: waivers.toml"), encoding="utf-8")
    check = ["check", SAFE, *ON_ROAD, *SDA, "--no-annotate", "--out", "out"]
    ran(*check, "--waivers", "w.toml")
    ran("report", "out", "--to", "sarif")
    assert {"gate.json", "report.sarif"} <= {path.name for path in Path("out").iterdir()}
    ran(*check)
    assert not {"gate.json", "report.sarif"} & {path.name for path in Path("out").iterdir()}
    assert pq.read_table("out/findings.parquet").num_rows == 0


def test_several_reports_are_written_by_one_command(ran: Ran, results: dict[str, Path]) -> None:
    code, out, _ = ran("report", str(results["base"]), "--to", "sarif", "--to", "markdown")
    assert (code, [Path(line).name for line in out.splitlines()]) == (0, ["report.sarif", "report.md"])
    code, _, err = ran("check", SAFE, *ON_ROAD, *SDA, "--report", "sarif")
    assert (code, "--out" in err) == (2, True)


@pytest.mark.ci
def test_a_check_writes_several_reports(ran: Ran) -> None:
    command = [
        "check",
        SAFE,
        *ON_ROAD,
        *SDA,
        "--no-annotate",
        "--report",
        "sarif",
        "--report",
        "markdown",
        "--out",
        "r",
    ]
    for _ in range(2):  # the second run writes the result of the first again
        assert ran(*command)[0] == 0
        assert {"report.sarif", "report.md", "junit.xml"} <= {path.name for path in Path("r").iterdir()}
        shutil.rmtree("r")
