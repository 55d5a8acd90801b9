"""What the log does not show of the ego: a rule with reference points says so, in one row, and not that nothing happened."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from tests.evaluate.packs import EXECUTION, HOLDS, INVARIANT, brief, verdicts, write

if TYPE_CHECKING:
    from pathlib import Path

NEEDS = {"reads": '["ego_state", "exit_taken"]', "requires": '["registration", "indicator"]'}
SECTIONS = {
    "reference": "SELECT drive_id, ego_id, t_ns FROM exit_taken",
    "condition": "SELECT drive_id, ego_id, t_ns, speed_mps > 10 AS holds FROM ego_state",
}
PLACED = {"x_m": 1, "y_m": 1, "yaw_rad": 0, "indicator": "off", "speed_mps": 12}


def said(tmp_path: Path, *states: dict[str, Any], taken: Any = (), needs: dict[str, str] | None = None) -> Any:
    rule = write(tmp_path, EXECUTION | HOLDS | (needs or NEEDS), SECTIONS)
    given: dict[str, Any] = {"ego_state": [PLACED | state for state in states]}
    if taken:
        given["exit_taken"] = {"t_s": list(taken), "side": "left"}
    return verdicts(rule, given)


def test_a_hole_of_a_second_may_have_hidden_one(tmp_path: Path) -> None:
    before = {"t_s": "0..4 by 0.1"}
    (row,) = said(tmp_path, before, {"t_s": "5..9 by 0.1"})
    assert (row["verdict"], row["reason_code"]) == ("unknown", "log_hole")
    assert (row["t_start_ns"], row["t_end_ns"]) == (4 * 10**9, 5 * 10**9)
    assert row["reason"] == "the log has a hole between 4.000 s and 5.000 s"
    assert brief(said(tmp_path, before, {"t_s": "4.9..9 by 0.1"})) == [("not_applicable", "not_triggered")]


def test_one_row_for_all_of_them_beside_what_was_judged(tmp_path: Path) -> None:
    parts = [{"t_s": f"{a}..{a + 2} by 0.1"} for a in (0, 4, 8)]
    rows = said(tmp_path, *parts, taken=[1.0, 5.0])
    assert brief(rows) == [("pass", "kept"), ("unknown", "log_hole"), ("pass", "kept")]
    assert rows[1]["reason"] == "the log has a hole between 2.000 s and 4.000 s, and in 1 more such stretches"


@pytest.mark.ci
def test_a_stretch_without_place_or_heading_or_indicator(tmp_path: Path) -> None:
    for column, code in (("x_m", "ego_not_placed"), ("y_m", "ego_not_placed"), ("yaw_rad", "ego_not_placed"),
                         ("indicator", "indicator_unknown")):  # fmt: skip
        known = PLACED[column]
        for end, expected in (("4", ("unknown", code)), ("3.9", ("not_applicable", "not_triggered"))):
            state = {"t_s": "0..9 by 0.1", column: {"else": known, f"3..{end}": None}}
            assert brief(said(tmp_path, state)) == [expected]
        other = NEEDS | {"requires": '["indicator"]' if code == "ego_not_placed" else '["registration"]'}
        state = {"t_s": "0..9 by 0.1", column: {"else": known, "3..4": None}}
        assert brief(said(tmp_path, state, needs=other)) == [("not_applicable", "not_triggered")]


@pytest.mark.ci
def test_each_ego_and_drive_by_itself_and_what_is_said_already_is_not_said_twice(tmp_path: Path) -> None:
    whole = {"t_s": "0..9 by 0.1"}
    blind = whole | {"x_m": {"else": 1, "3..5": None}, "speed_mps": {"else": 12, "4": None}}
    rows = said(tmp_path, blind, whole | {"ego_id": "f"}, blind | {"drive_id": "g"})
    assert [(row["drive_id"], row["ego_id"], row["verdict"]) for row in rows] == [
        ("d", "e", "unknown"),
        ("d", "f", "not_applicable"),
        ("g", "e", "unknown"),
    ]
    for at in (4.0, 5.2):  # within it, and just after
        late = blind | {"speed_mps": {"else": 12, str(at): None}}
        assert brief(said(tmp_path, late, taken=[at])) == [("unknown", "null_value")]


def test_an_invariant_says_so_of_a_place_but_not_of_a_hole_that_it_does_not_reach(tmp_path: Path) -> None:
    sections = {
        "applies": "SELECT drive_id, ego_id, t_ns FROM exit_taken",
        "condition": "SELECT drive_id, ego_id, t_ns, speed_mps > 10 AS holds FROM ego_state",
    }
    rule = write(tmp_path, INVARIANT | HOLDS | NEEDS, sections)
    holed = [PLACED | {"t_s": "0..4 by 0.1"}, PLACED | {"t_s": "6..9 by 0.1"}]
    assert brief(verdicts(rule, {"ego_state": holed})) == [("not_applicable", "not_triggered")]
    blind = PLACED | {"t_s": "0..9 by 0.1", "x_m": {"else": 1, "3..5": None}}
    assert brief(verdicts(rule, {"ego_state": blind})) == [("unknown", "ego_not_placed")]
