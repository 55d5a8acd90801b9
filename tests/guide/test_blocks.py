"""The code blocks of README and of the guides do what the pages say.

`<!-- run: 0 1 -->` above a block: its lines are run, in a folder with the files of `PREPARED`, and exit so. `with FILE as NAME`
behind it: the reference file or folder is there under that name. `<!-- prints -->`: the lines are in what the block before
printed, in this order; `...` stands for any lines between. `<!-- file: NAME -->`: the block is that file.
"""

from __future__ import annotations

import importlib.util
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pyarrow as pa
import pytest
import yaml

from drivelint import demo as demo_files
from drivelint.drive.trace import IngestOptions
from drivelint.errors import TraceError
from drivelint.formats import registry
from drivelint.guide import FOLDER
from drivelint.inspect import InspectRequest, inspect
from tests.guide.blocks import PAGES, Block, blocks
from tests.scene_drives import scene_drive
from tests.scenes import derived, drive, moving, road, times
from tests.shared_data import ROOT, shared

OVERTAKE = ROOT / "fixtures" / "overtake"
NAMES = [page.name for page in PAGES]
MARKS = {"", "run", "prints", "file", "command", "workflow", "condition", "shards"}


@pytest.fixture(scope="module")
def demo(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("demo")
    demo_files.write(folder)
    return folder


@pytest.fixture
def folder(demo: Path, tmp_path: Path) -> Path:
    """Return a folder with what a reader of the guides has: a log of each kind, a map, the demo; and `drivelint` to run."""
    shutil.copytree(demo, tmp_path / "demo")
    for source, name in (
        (demo / "near-miss.mcap", "drive.mcap"),
        (demo / "near-miss.mcap", "drives/near-miss.mcap"),
        (demo / "collision.mcap", "more/days/collision.mcap"),
        (demo / "road.xodr", "road.xodr"),
        (demo / "road.xodr", "maps/near-miss.xodr"),
        (OVERTAKE / "near_miss.csv", "log.csv"),
        (OVERTAKE / "mapping.toml", "my.toml"),
    ):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(source, tmp_path / name)
    tools = tmp_path / "tools"
    tools.mkdir()
    for name, words in (("drivelint", "-m drivelint"), ("python", "")):
        (tools / name).write_text(f'#!/bin/sh\nexec "{sys.executable}" {words} "$@"\n', encoding="utf-8")
        (tools / name).chmod(0o755)
    return tmp_path


def run(line: str, folder: Path) -> subprocess.CompletedProcess[str]:
    path = f"{folder / 'tools'}{os.pathsep}{os.environ['PATH']}"
    env = {**os.environ, "PATH": path, "PYTHONPATH": str(ROOT / "src")}
    return subprocess.run(
        ["bash", "-c", line], cwd=folder, env=env, check=False, capture_output=True, text=True, timeout=300
    )


def run_block(block: Block, folder: Path) -> str:
    """Run the lines of a block; return what they printed."""
    codes, _, needs = block.argument.partition(" with ")
    if needs:
        source, _, name = needs.partition(" as ")
        copy = shutil.copytree if shared(source).is_dir() else shutil.copy
        copy(shared(source), folder / name)
    printed = ""
    lines = block.body.splitlines()
    assert len(lines) == len(codes.split()), "an exit code for each line"
    for line, code in zip(lines, codes.split(), strict=True):
        done = run(line, folder)
        assert done.returncode == int(code), f"{line}\n{done.stdout[-1500:]}\n{done.stderr[-1500:]}"
        assert "Traceback" not in done.stderr
        printed += done.stdout
    return printed


def missing_lines(text: str, output: str) -> list[str]:
    """Return the lines that were not printed, or not in this order."""
    rest = iter(line.rstrip() for line in output.splitlines())
    return [line for line in text.splitlines() if line != "..." and line.rstrip() not in rest]


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_marked_blocks_run(name: str, folder: Path) -> None:
    (page,) = (page for page in PAGES if page.name == name)
    printed = ""
    skipped: list[str] = []
    for block in blocks(page):
        if block.word == "run":
            try:
                printed = run_block(block, folder)
            except pytest.skip.Exception as reason:
                skipped.append(str(reason))
        elif block.word == "prints" and name != "README.md":
            assert missing_lines(block.body, printed) == []
        elif block.word == "file" and not (ROOT / block.argument).exists() and block.argument != "drivelint.toml":
            (folder / block.argument).parent.mkdir(parents=True, exist_ok=True)
            (folder / block.argument).write_text(block.body, encoding="utf-8")
    if skipped:
        pytest.skip("; ".join(skipped))


def test_every_mark_is_known() -> None:
    for page in PAGES:
        assert {block.word for block in blocks(page)} <= MARKS, page.name


@pytest.mark.parametrize("name", NAMES)
def test_a_block_without_a_mark_is_no_code(name: str) -> None:
    """What could be run is run; the rest is text."""
    (page,) = (page for page in PAGES if page.name == name)
    assert [block.body for block in blocks(page) if not block.mark and block.language != "text"] == []


def test_the_condition_with_shapes_says_what_the_columns_of_pair_say() -> None:
    """On a straight road: an object ahead in the ego's way is in the danger space if its rear is nearer than the ego can stop."""
    (block,) = (block for page in PAGES for block in blocks(page) if block.mark == "condition")
    way, t = road(), times(6.0)
    actors = [moving("ego", way, t, 50 + 12 * t, way.ego_d), moving("slower", way, t, 105 + 4 * t, way.ego_d)]
    con = derived(drive(actors, way.environment), tables=["pair", "ego_state"])
    found = con.execute(f"""
        SELECT c.holds, p.rear_s_m - e.front_s_m > stopping_distance_m(e.speed_mps) OR p.front_s_m < e.front_s_m AS is_clear
        FROM ({block.body}) c JOIN pair p USING (drive_id, ego_id, t_ns, object_id) JOIN ego_state e USING (drive_id, ego_id, t_ns)
        WHERE abs(e.heading_diff_rad) < 0.001 AND abs(p.d_m - e.d_m) < 0.5
    """).fetchall()
    assert {holds for holds, _ in found} == {True, False}
    assert [holds for holds, is_clear in found if holds != is_clear] == []


@pytest.mark.slow
def test_the_condition_about_lights_says_what_they_show(tmp_path: Path) -> None:
    (block,) = (block for page in PAGES for block in blocks(page) if block.mark == "condition: lights")
    found = {}
    for name in ("green", "red", "unknown"):
        made = scene_drive("crossroads", "red" if name == "red" else "green", tmp_path / name)
        if name == "unknown":
            states = made.trace.tables["signal_state"]
            made.trace.tables["signal_state"] = states.set_column(3, "state", pa.nulls(len(states), pa.string()))
        con = derived(made, tables=["way_mark", "mark_phase", "ego_state"])
        found[name] = set(con.execute(f"SELECT holds FROM ({block.body})").fetchall())
    assert found == {"green": {(True,)}, "red": {(False,)}, "unknown": {(None,)}}


def test_files_of_the_repository_are_shown_as_they_are() -> None:
    shown = {block.argument: block.body for page in PAGES for block in blocks(page) if block.word == "file"}
    there = [name for name in shown if (ROOT / name).exists()]
    assert there == ["fixtures/overtake/mapping.toml"]
    for name in there:
        assert shown[name] == (ROOT / name).read_text(encoding="utf-8")


@pytest.mark.ci
def test_readmes_command_prints_what_readme_shows(folder: Path) -> None:
    readme = blocks(ROOT / "README.md")
    (command,) = (block.body.strip() for block in readme if block.mark == "command: run")
    shutil.rmtree(folder / "demo")
    *_, demo, check = command.split(" && ")
    assert run(demo.removeprefix(".venv/bin/"), folder).returncode == 0
    done = run(check.removeprefix(".venv/bin/"), folder)
    (shown,) = (block.body for block in readme if block.word == "prints")
    assert done.returncode == 1, done.stderr
    assert missing_lines(shown, done.stdout) == []
    assert (folder / "demo" / "results" / "report.html").is_file()


@pytest.mark.slow
@pytest.mark.parametrize(("drive", "code"), [("safe", 0), ("near-miss", 1)])
def test_the_first_workflow_passes_the_safe_drive(drive: str, code: int, folder: Path) -> None:
    (workflow,) = (block.body for block in blocks(FOLDER / "ready-made.md") if block.mark == "workflow: first")
    assert len(workflow.splitlines()) <= 14
    (line,) = (s["run"] for s in yaml.safe_load(workflow)["jobs"]["check"]["steps"] if "check" in s.get("run", ""))
    shutil.rmtree(folder / "drives")
    (folder / "drives").mkdir()
    shutil.copy(folder / "demo" / f"{drive}.mcap", folder / "drives")
    assert run(line, folder).returncode == code
    assert (folder / "results" / "report.html").is_file()


@pytest.mark.slow
def test_the_settings_of_the_ci_guide_are_taken(folder: Path) -> None:
    (settings,) = (block.body for block in blocks(FOLDER / "ci.md") if block.mark == "file: drivelint.toml")
    (folder / "drivelint.toml").write_text(settings, encoding="utf-8")
    done = run("drivelint check drives --no-annotate", folder)
    assert done.returncode == 1, done.stderr
    assert "[nominal]" in done.stdout
    assert "[aggressive]" not in done.stdout, "nothing fails with it"
    assert "at or above severity major" in done.stdout


@pytest.mark.slow
def test_the_hooks_stop_a_commit(folder: Path) -> None:
    (config,) = (b.body for b in blocks(FOLDER / "ready-made.md") if b.mark == "workflow: pre-commit")
    hooks: list[dict[str, Any]] = yaml.safe_load(config)["repos"][0]["hooks"]
    rules, drives = (hook["entry"] for hook in hooks)
    assert [bool(re.search(hook["files"], "drives/a.mcap")) for hook in hooks] == [False, True]
    assert [bool(re.search(hook["files"], "my-rules/mine/r1.sql")) for hook in hooks] == [True, False]
    assert all(shlex.split(entry)[0] == "drivelint" for entry in (rules, drives))
    assert run("drivelint rules new mine.r1 --dir my-rules", folder).returncode == 0
    assert run(rules, folder).returncode == 0
    assert run(drives, folder).returncode == 1


def test_the_reader_of_the_format_guide_reads(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (code,) = (block.body for block in blocks(FOLDER / "adding-a-format.md") if block.mark == "file: jsonlines.py")
    (tmp_path / "jsonlines.py").write_text(code, encoding="utf-8")
    spec = importlib.util.spec_from_file_location("jsonlines", tmp_path / "jsonlines.py")
    assert spec
    assert spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)

    monkeypatch.setitem(sys.modules, "drivelint.formats.jsonlines", module)
    monkeypatch.setattr(
        registry, "READER_MODULES", (*registry.READER_MODULES[:-1], "jsonlines", registry.READER_MODULES[-1])
    )
    states = [
        {"t_s": k / 10, "id": actor, "x": k + 10.0 * actor, "y": 0.0, "heading": 0.0, "kind": "car"}
        for k in range(20)
        for actor in (1, 2)
    ]
    log = tmp_path / "log.jsonl"
    log.write_text("\n".join(map(json.dumps, states)), encoding="utf-8")
    trace = registry.read_trace(log, IngestOptions(ego="1"))
    assert trace.tables["actor"].to_pydict()["actor_class"] == ["car", "car"]
    assert trace.tables["actor_state"].num_rows == 40
    assert trace.tables["actor_state"].to_pydict()["vx_mps"][0] == pytest.approx(10.0), "derived"
    found = inspect(InspectRequest(str(log)))
    assert (found.problem, found.content.sheets) == (None, [])
    for damage in ('{"t_s": 0.1, "id": 1, "x": "far"}', '{"t_s": Infinity}', "{", "\udcff"):
        log.write_text(
            '{"t_s": 0.0, "id": 1, "x": 0, "y": 0, "heading": 0, "kind": "car"}\n' + damage, "utf-8", "surrogateescape"
        )
        with pytest.raises(TraceError, match=r"log\.jsonl:2: not a state"):
            registry.read_trace(log, IngestOptions(ego="1"))
