"""What the log does not show of the ego: a rule with reference points says so, in one row, and not that nothing happened."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from tests.evaluate.packs import EXECUTION, HOLDS, brief, verdicts, write

if TYPE_CHECKING:
    from pathlib import Path

NEEDS = {"reads": '["ego_state", "exit_taken"]', "requires": '["registration", "indicator"]'}
SECTIONS = {
    "reference": "SELECT drive_id, ego_id, t_ns FROM exit_taken",
    "condition": "SELECT drive_id, ego_id, t_ns, speed_mps > 10 AS holds FROM ego_state",
}
PLACED_STATE = {"x_m": 1, "y_m": 1, "yaw_rad": 0, "indicator": "off", "speed_mps": 12}


def state_verdicts(tmp_path: Path, state: dict[str, Any], needs: dict[str, str] = NEEDS) -> Any:
    rule = write(tmp_path, EXECUTION | HOLDS | needs, SECTIONS)
    return verdicts(rule, {"ego_state": PLACED_STATE | state})


@pytest.mark.ci
def test_a_stretch_without_place_or_heading_or_indicator(tmp_path: Path) -> None:
    for column, code in (("x_m", "ego_not_placed"), ("y_m", "ego_not_placed"), ("yaw_rad", "ego_not_placed"),
                         ("indicator", "indicator_unknown")):  # fmt: skip
        known = PLACED_STATE[column]
        for end, expected in (("4", ("unknown", code)), ("3.9", ("not_applicable", "not_triggered"))):
            state = {"t_s": "0..9 by 0.1", column: {"else": known, f"3..{end}": None}}
            assert brief(state_verdicts(tmp_path, state)) == [expected]
        other = NEEDS | {"requires": '["indicator"]' if code == "ego_not_placed" else '["registration"]'}
        state = {"t_s": "0..9 by 0.1", column: {"else": known, "3..4": None}}
        assert brief(state_verdicts(tmp_path, state, other)) == [("not_applicable", "not_triggered")]
