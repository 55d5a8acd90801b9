"""An unknown verdict says what is missing, and of whom."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from tests.evaluate.packs import EXECUTION, HOLDS, INVARIANT, MEASURED, PLACE_BEFORE, verdicts, write

if TYPE_CHECKING:
    from pathlib import Path

SPEED = "SELECT drive_id, ego_id, t_ns, fastest_3s_mps AS observed, 10 AS required FROM ego_state"
STATE = {
    "t_s": [0.0, 0.1, 0.2], "fastest_3s_mps": [12, None, 12], "speed_mps": 12, "yaw_rad": 0.0, "lanelet_id": "l", "front_s_m": 5.0,
}  # fmt: skip


def test_the_authors_reason_of_an_unknown_applicability(tmp_path: Path) -> None:
    applies = (
        "SELECT drive_id, ego_id, t_ns, in_junction AS applies, 'the map has no junctions' AS reason FROM ego_state"
    )
    rule = write(tmp_path, INVARIANT | MEASURED | {"reads": '["ego_state"]'}, {"applies": applies, "condition": SPEED})
    given = {"ego_state": {**STATE, "fastest_3s_mps": 12, "in_junction": [True, None, True]}}
    (row,) = verdicts(rule, given)
    assert row["reason"] == "Whether the rule applies is not known at 0.100 s: the map has no junctions."
    given["ego_state"]["in_junction"] = [True, True, False]
    assert [r["verdict"] for r in verdicts(rule, given)] == ["pass"]


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
    header = INVARIANT | MEASURED | {"reads": '["ego_state"]', "requires": '["map", "registration"]'}
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
    rule = write(tmp_path, INVARIANT | MEASURED | {"reads": '["pair"]'}, {"condition": sql})
    there = {
        "x_m": 1.0, "y_m": 0.0, "yaw_rad": 0.0, "length_m": 4.0, "width_m": 2.0, "speed_mps": 3.0, "actor_class": "car",
    }  # fmt: skip
    pair = there | {"t_s": [0.0, 0.1], "object_id": "o", "clearance_m": [3, None]} | lacks
    ego = {"t_s": [0.0, 0.1], "x_m": 0.0, "y_m": 0.0, "yaw_rad": 0.0, "speed_mps": 3.0}
    (row,) = verdicts(rule, {"ego_state": ego, "pair": pair})
    assert row["reason"] == f"A value that the rule needs is not known at 0.100 s; {because}."


def test_the_heights_of_an_object_that_may_be_on_another_level_are_told(tmp_path: Path) -> None:
    sql = "SELECT drive_id, ego_id, t_ns, object_id, clearance_m AS observed, 0 AS required FROM pair"
    rule = write(tmp_path, INVARIANT | MEASURED | {"reads": '["pair"]'}, {"condition": sql})
    pair = {"t_s": [0.0, 0.1], "object_id": "o", "clearance_m": [3, None], "off_level": [False, True]}
    ego = {"t_s": [0.0, 0.1], "x_m": 0.0, "y_m": 0.0, "yaw_rad": 0.0, "speed_mps": 3.0, "z_m": [0.5, 0.6]}
    object_ = {"t_s": [0.0, 0.1], "actor_id": "o", "x_m": 1.0, "y_m": 0.0, "z_m": [7.0, 7.21]}
    (row,) = verdicts(rule, {"ego_state": ego, "pair": pair, "state_dynamics": object_})
    assert (
        "may be over or under the road (its height is 7.2 m at that time, the ego's 0.6 m): record or correct the heights"
        in row["reason"]
    )


def test_what_the_log_lacks_where_a_reference_point_has_no_time(tmp_path: Path) -> None:
    header = (
        EXECUTION
        | MEASURED
        | {"reads": '["ego_state", "exit_taken"]', "without_time": '"the log does not show the exit"'}
    )
    reference = "SELECT drive_id, ego_id, t_sign_ns AS t_ns, side FROM exit_taken"
    rule = write(tmp_path, header, {"reference": reference, "condition": SPEED})
    (row,) = verdicts(rule, {"ego_state": STATE, "exit_taken": {"t_s": 0.1, "t_sign_s": None}})
    assert (row["reason_code"], row["reason"]) == (
        "reference_time_unknown",
        "The log does not show the exit.",
    )


def test_what_the_log_lacks_where_an_anchor_has_no_time(tmp_path: Path) -> None:
    header = (
        PLACE_BEFORE
        | HOLDS
        | {"reads": '["ego_state", "exit_taken"]', "without_anchor": '"the log does not show the sign"'}
    )
    sections = {
        "reference": "SELECT drive_id, ego_id, t_ns FROM exit_taken",
        "anchor": "SELECT ref_id, NULL::BIGINT AS t_ns FROM reference",
        "condition": "SELECT drive_id, ego_id, t_ns, true AS holds FROM ego_state",
    }
    rule = write(tmp_path, header, sections)
    (row,) = verdicts(rule, {"ego_state": STATE, "exit_taken": {"t_s": 0.1}})
    assert (row["reason_code"], row["reason"]) == ("anchor_unknown", "The log does not show the sign.")
