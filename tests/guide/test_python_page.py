"""The programs of the page about Python draw what the page says."""

from __future__ import annotations

import math
import runpy
from pathlib import Path
from typing import Any

import pytest

import drivelint
from drivelint import demo
from drivelint.guide import FOLDER
from tests.guide.blocks import blocks

pytest.importorskip("matplotlib", reason="matplotlib is not installed (pip install matplotlib)")


LOG, RULES = '"demo/near-miss.mcap"', 'rules="ukhc.r162.safe-distance-ahead"'
"""What the program checks, and by what."""


@pytest.fixture
def ran(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """Return what the program about the room for an overtake has when it has run."""
    return run(code_of_the_page(), tmp_path, monkeypatch)


def code_of_the_page(name: str = "room.py") -> str:
    (code,) = (block.body for block in blocks(FOLDER / "python.md") if block.argument == name)
    return code


def run(code: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    demo.write(tmp_path / "demo")
    (tmp_path / "room.py").write_text(code, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "Agg")
    return runpy.run_path("room.py")


@pytest.mark.ci
def test_the_gap_around_a_moment_is_that_of_the_finding_at_it(ran: dict[str, Any]) -> None:
    found, steps = list(ran["checked"].findings), ran["steps"]
    assert [(row["profile"], row["t_worst_s"]) for row in found] == [("nominal", 7.7), ("observed", 7.7)]
    assert [len(row["t_ns"]) for row in ran["checked"].courses if row["finding_id"]] == [1, 1], "as the page says"
    at = dict(zip(steps["t_s"], steps["gap_m"], strict=True))
    assert at[7.7] == pytest.approx(found[0]["observed"], abs=0.3), "along the straight line"
    assert len(at) == len(steps) > 50, "each time once, though there are two findings"
    assert (min(at), max(at)) == pytest.approx((2.7, 12.7), abs=0.2)
    assert Path("room.png").stat().st_size > 5000


@pytest.mark.ci
def test_the_headway_of_each_drive_is_drawn(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    headways = run(code_of_the_page("headway.py"), tmp_path, monkeypatch)["headways"]
    assert set(headways["file_name"]) == {file.name for file in Path("demo").glob("*.mcap")}
    assert 2 < headways["observed"].min() < headways["observed"].max() < 10
    assert Path("headway.png").stat().st_size > 5000


@pytest.mark.ci
def test_the_speeds_at_a_finding_are_those_of_the_log(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Also where the two differ, and where an object stands."""
    code = code_of_the_page("speeds.py")
    assert LOG in code
    given = code.replace(LOG, '"demo/collision.mcap"').replace('rules="ukhc.r162.*"', "rules=None")
    found = run(given, tmp_path, monkeypatch)["findings"].to_dicts()
    trace = drivelint.read_trace("demo/collision.mcap")
    speeds = {(row["actor_id"], row["t_ns"]): math.hypot(row["vx_mps"], row["vy_mps"]) for row in trace.actor_state}
    assert len(found) > 5
    for row in found:
        for who in ("ego", "object"):
            assert row[f"{who}_mps"] == pytest.approx(speeds[row[f"{who}_id"], row["t_worst_ns"]]), row
    objects = [row["object_mps"] for row in found]
    assert min(objects) == 0
    assert max(objects) > 5


@pytest.mark.ci
def test_the_gap_is_below_0_side_by_side_without_a_contact(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As the page says, of the demo's near miss at 25 mph."""
    code = code_of_the_page()
    assert LOG in code
    assert RULES in code
    both = 'rules=["ukhc.r162.safe-distance-ahead", "ukhc.no-collision"]'
    ran = run(code.replace(LOG, '"demo/near-miss-25mph.mcap"').replace(RULES, both), tmp_path, monkeypatch)
    assert min(ran["steps"]["gap_m"]) < -1
    verdicts = [row["verdict"] for row in ran["checked"].verdicts if row["rule_id"] == "ukhc.no-collision"]
    assert verdicts
    assert set(verdicts) == {"pass"}
