"""An inspection as a person meets it: in a process of its own, narrow, plain, with odd names."""

from __future__ import annotations

import io
import json
import os
import re
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest
from rich.console import Console

from drivelint.catalogue import load_rules, select_rules
from drivelint.inspect import InspectRequest, inspect
from drivelint.inspect.text import render
from tests.formats.osi import osi_log
from tests.shared_data import ROOT

if TYPE_CHECKING:
    from pathlib import Path

FIXTURE = ROOT / "fixtures" / "overtake"
LOG = str(FIXTURE / "safe.csv")
ON_ROAD = {"map": FIXTURE / "road.xodr", "mapping": str(FIXTURE / "mapping.toml")}


def run(*args: str, columns: int = 100, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "drivelint", *args],
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=False,
        cwd=cwd,
        env={**os.environ, "PYTHONPATH": str(ROOT / "src"), "COLUMNS": str(columns), "PYTHONIOENCODING": "utf-8"},
    )


def text(order: InspectRequest, width: int = 100) -> str:
    console = Console(file=io.StringIO(), width=width, color_system=None)
    console.print(render(inspect(order), order.trace))
    assert isinstance(console.file, io.StringIO)
    return console.file.getvalue()


@pytest.mark.ci
@pytest.mark.sample(1)
@pytest.mark.parametrize("width", [40, 80, 200])
def test_nothing_is_cut_off(width: int) -> None:
    shown = text(InspectRequest(LOG, **ON_ROAD), width)  # type: ignore[arg-type]
    assert max(map(len, shown.splitlines())) <= width
    assert "…" not in shown
    whole = "".join(shown.split())
    for said in ("safe.csvcandecide", "road.xodr", "noholes"):
        assert said in whole
    lacking = "".join(text(InspectRequest(LOG, mapping=str(ON_ROAD["mapping"])), width).split())
    for said in ("ukhc.r162.safe-distance-ahead", "theroadasOpenDRIVE:--mapFILE"):
        assert said in lacking


@pytest.mark.ci
def test_drafts_are_counted_apart_from_what_check_runs() -> None:
    n_run = len(select_rules(load_rules(), (), ()))
    n_all = len(select_rules(load_rules(), ("ukhc",), ()))
    shown = " ".join(text(InspectRequest(LOG, **ON_ROAD)).split())  # type: ignore[arg-type]
    assert re.search(
        rf"can decide \d+ of the {n_run} rules that check runs \(ukhc\), and \d+ of {n_all - n_run} drafts", shown
    )
    assert "r163.cut-in (draft)" in shown
    assert "r162.safe-distance-ahead," in shown
    named = " ".join(text(InspectRequest(LOG, **ON_ROAD, rules=("ukhc.r163.cut-in",))).split())  # type: ignore[arg-type]
    assert "can decide 1 of 1 rules (ukhc.r163.cut-in)" in named, "check runs a draft that is named"


@pytest.mark.ci
def test_plain_where_it_is_no_terminal() -> None:
    done = run("inspect", LOG, "--mapping", str(ON_ROAD["mapping"]))
    assert (done.returncode, done.stderr) == (0, "")
    assert "\x1b" not in done.stdout
    assert all(line == line.rstrip() for line in done.stdout.splitlines())
    assert "name a map with --map" in done.stdout


@pytest.mark.ci
def test_json_for_machines() -> None:
    done = run("inspect", LOG, "--mapping", str(ON_ROAD["mapping"]), "--map", str(ON_ROAD["map"]), "--format", "json")
    found = json.loads(done.stdout)
    assert (found["inspect_schema"], found["problem"], found["drive"]["egos"][0]["actor"]["actor_id"]) == (
        1,
        None,
        "ego",
    )


def test_a_file_that_is_no_drive_is_exit_code_4_and_its_content_is_shown() -> None:
    done = run("inspect", LOG)
    assert done.returncode == 4
    assert "cannot be read as a drive" in done.stdout
    assert "heading_deg" in done.stdout
    assert "Traceback" not in done.stderr


@pytest.mark.slow
def test_convert_says_how_to_check(tmp_path: Path) -> None:
    done = run(
        "convert",
        LOG,
        "--to",
        "mcap",
        "--out",
        str(tmp_path),
        "--mapping",
        str(ON_ROAD["mapping"]),
        "--map",
        str(ON_ROAD["map"]),
    )
    assert done.returncode == 0, done.stderr
    command = done.stdout.splitlines()[-1].partition("drivelint check ")[2].removesuffix(" --out results")
    checked = run("check", *command.split(), "-q")
    assert (checked.returncode, checked.stderr) == (0, "")
    wrong = run("convert", str(tmp_path / "safe.mcap"), "--to", "mcap", "--out", str(tmp_path))
    assert (wrong.returncode, wrong.stdout) == (2, "")
    assert "overwrite the log itself" in wrong.stderr


def test_names_are_shown_as_they_are(tmp_path: Path) -> None:
    """Topics and ids may look like markup; they are text."""
    path = osi_log.write(tmp_path / "[red]x.mcap", osi_log.truths(osi_log.drive(5), topic="[bold]t[/bold]"))
    shown = text(InspectRequest(str(path)))
    assert "[bold]t[/bold]: 5 messages" in shown
    assert "[red]x.mcap" in shown


@pytest.mark.slow
def test_a_projects_settings_count_here_too(tmp_path: Path) -> None:
    settings = f'map = "{ON_ROAD["map"]}"\nmapping = "{ON_ROAD["mapping"]}"\nout = "results"\nfail-on = "never"\nformat = "json"\n'
    (tmp_path / "drivelint.toml").write_text(settings, encoding="utf-8")
    shown = run("inspect", LOG, cwd=tmp_path)
    assert (shown.returncode, shown.stderr) == (0, "")
    assert "road.xodr: " in shown.stdout
    assert run("convert", LOG, "--to", "mcap", cwd=tmp_path).returncode == 2  # where to is not what check's results are
    done = run("convert", LOG, "--to", "mcap", "--out", "c", cwd=tmp_path)
    assert "the map road.xodr with it" in done.stdout
    assert {file.name for file in tmp_path.iterdir()} == {"drivelint.toml", "c"}
