"""An unknown verdict says what is missing, and of whom."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from tests.evaluate.packs import INVARIANT, MEASURE, verdicts, write

if TYPE_CHECKING:
    from pathlib import Path

SPEED = "SELECT drive_id, ego_id, t_ns, fastest_3s_mps AS observed, 10 AS required FROM ego_state"
STATE = {
    "t_s": [0.0, 0.1, 0.2], "fastest_3s_mps": [12, None, 12], "speed_mps": 12, "yaw_rad": 0.0, "lanelet_id": "l", "front_s_m": 5.0,
}  # fmt: skip


@pytest.mark.parametrize(
    ("state", "because"),
    [
        ({"x_m": [1, None, 3], "y_m": 0.0}, "the ego has no position, or only an outdated one: record it"),
        ({"x_m": 1.0, "y_m": 0.0, "yaw_rad": [0, None, 0]}, "the ego has no heading: record it"),
        (
            {"x_m": 1.0, "y_m": 0.0, "lanelet_id": ["l", None, "l"]},
            "the ego is not on a lane of the map: use a map that has its lane",
        ),
        (
            {"x_m": 1.0, "y_m": 0.0, "front_s_m": [5, None, 5]},
            "the ego's box reaches beyond the ends of the map's lanes: use a map whose lanes extend further, ahead of the ego or behind it",
        ),
        ({"x_m": 1.0, "y_m": 0.0, "speed_mps": [12, None, 12]}, "the speed of the ego is not known: record it"),
        (
            {"x_m": 1.0, "y_m": 0.0, "speed_mps": [12, 12, None]},
            "the speed of the ego is not known at some moment within 1 s of that time: record it",
        ),
        ({"x_m": 1.0, "y_m": 0.0}, None),
    ],
)
def test_an_ego_without_a_place(tmp_path: Path, state: dict[str, Any], because: str | None) -> None:
    header = INVARIANT | MEASURE | {"reads": '["ego_state"]', "requires": '["map", "registration"]'}
    rule = write(tmp_path, header, {"condition": SPEED})
    (row,) = verdicts(rule, {"ego_state": STATE | state})
    reason = "A value that the rule needs is not known at 0.100 s"
    assert row["reason"] == (f"{reason}; {because}." if because else f"{reason}.")


@pytest.mark.parametrize(
    ("lacks", "because"),
    [
        ({"x_m": [1, None]}, "object o has no position, or only an outdated one: record it"),
        ({"yaw_rad": [0, None]}, "object o has no heading: record it"),
        ({"length_m": [4, None]}, "object o has no size: record it"),
        (
            {"off_level": [False, True]},
            (
                "object o may be over or under the road: record or correct the heights of both; if the road has only one level, "
                "leave z out of the mapping"
            ),
        ),
        ({"speed_mps": [4, None]}, "the speed of object o is not known: record it"),
        ({"actor_class": ["car", None]}, "the class of object o is not known: record it"),
    ],
)
def test_an_object_of_which_something_is_not_known(tmp_path: Path, lacks: dict[str, Any], because: str) -> None:
    sql = "SELECT drive_id, ego_id, t_ns, object_id, clearance_m AS observed, 0 AS required FROM pair"
    rule = write(tmp_path, INVARIANT | MEASURE | {"reads": '["pair"]'}, {"condition": sql})
    there = {
        "x_m": 1.0, "y_m": 0.0, "yaw_rad": 0.0, "length_m": 4.0, "width_m": 2.0, "speed_mps": 3.0, "actor_class": "car",
    }  # fmt: skip
    pair = there | {"t_s": [0.0, 0.1], "object_id": "o", "clearance_m": [3, None]} | lacks
    ego = {"t_s": [0.0, 0.1], "x_m": 0.0, "y_m": 0.0, "yaw_rad": 0.0, "speed_mps": 3.0}
    (row,) = verdicts(rule, {"ego_state": ego, "pair": pair})
    assert row["reason"] == f"A value that the rule needs is not known at 0.100 s; {because}."
