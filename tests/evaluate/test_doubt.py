"""What a check doubts is not judged: by the quantities that a rule's columns are made of, for the ego and for the object."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from drivelint.catalogue import load_rules
from drivelint.sql.declarations import column_comments, input_quantities_by_column, lifetimes
from tests.evaluate.packs import EXECUTION, INVARIANT, MEASURED, brief, verdicts, write

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.catalogue import Rule

QUANTITIES = {"existence", "identity", "position", "heading", "velocity", "size", "class"}
SPEED = "SELECT drive_id, ego_id, t_ns, speed_mps AS observed, 10 AS required FROM ego_state"
GAP = "SELECT drive_id, ego_id, object_id, t_ns, clearance_m AS observed, 0 AS required FROM pair"


def doubt(actor: str, quantity: str, t_s: tuple[float, float] = (0.8, 1.2)) -> dict[str, Any]:
    return {
        "doubt": {
            "actor_id": actor,
            "quantity": quantity,
            "t_from_s": t_s[0],
            "t_to_s": t_s[1],
            "code": "velocity_jolt",
        }
    }


def speed_rule(folder: Path) -> Rule:
    return write(folder, INVARIANT | MEASURED | {"reads": '["ego_state"]'}, {"condition": SPEED})


def gap_rule(folder: Path) -> Rule:
    return write(folder, INVARIANT | MEASURED | {"reads": '["pair"]'}, {"condition": GAP})


def drive(speed: Any = 12, gap: Any = 3) -> dict[str, Any]:
    return {
        "ego_state": {"t_s": "0..2 by 0.1", "speed_mps": speed},
        "pair": {"t_s": "0..2 by 0.1", "object_id": "7", "clearance_m": gap},
    }


@pytest.mark.parametrize("speed", [12, {"else": 12, "1": 9}])
def test_a_doubted_step_is_neither_kept_nor_broken(tmp_path: Path, speed: Any) -> None:
    (row,) = verdicts(speed_rule(tmp_path), drive(speed) | doubt("e", "velocity"))
    assert (row["verdict"], row["reason_code"], row["cause_code"]) == ("unknown", "doubted", "doubted")
    assert "the recorded velocity of the ego is not credible at that time (velocity_jolt)" in row["reason"]


@pytest.mark.parametrize("speed", [12, {"else": 12, "1": 9}])
def test_a_single_doubted_step_counts_as_not_recorded(tmp_path: Path, speed: Any) -> None:
    (row,) = verdicts(speed_rule(tmp_path), drive(speed) | doubt("e", "velocity", (0.95, 1.05)))
    assert (row["verdict"], row["n_judged"]) == ("pass", 20)
    (row,) = verdicts(speed_rule(tmp_path), drive({"else": 12, "1..1.1": 9}) | doubt("e", "velocity", (0.95, 1.05)))
    assert (row["verdict"], row["t_worst_ns"]) == ("fail", 1_100_000_000)


@pytest.mark.ci
def test_the_last_step_is_not_between_two(tmp_path: Path) -> None:
    assert brief(verdicts(speed_rule(tmp_path), drive() | doubt("e", "velocity", (1.95, 2.0)))) == [
        ("unknown", "doubted")
    ]


def test_a_rule_may_say_what_does_not_affect_it(tmp_path: Path) -> None:
    rule = write(
        tmp_path,
        INVARIANT | MEASURED | {"reads": '["ego_state"]', "unaffected_by": '["velocity"]'},
        {"condition": SPEED},
    )
    assert brief(verdicts(rule, drive() | doubt("e", "velocity"))) == [("pass", "kept")]


def test_a_breach_beside_the_doubted_step_stands(tmp_path: Path) -> None:
    assert brief(verdicts(speed_rule(tmp_path), drive({"else": 12, "0.5": 9}) | doubt("e", "velocity"))) == [
        ("fail", "violated")
    ]


def test_another_quantity_does_not_matter(tmp_path: Path) -> None:
    assert brief(verdicts(speed_rule(tmp_path), drive() | doubt("e", "size"))) == [("pass", "kept")]


@pytest.mark.parametrize("quantity", ["position", "heading", "size", "existence", "identity"])
@pytest.mark.parametrize("actor", ["7", "e"])
def test_the_object_counts_as_the_ego_does(tmp_path: Path, quantity: str, actor: str) -> None:
    for gap in (3, {"else": 3, "1": -1}):
        assert brief(verdicts(gap_rule(tmp_path), drive(gap=gap) | doubt(actor, quantity))) == [("unknown", "doubted")]


def test_another_object_is_judged(tmp_path: Path) -> None:
    assert brief(verdicts(gap_rule(tmp_path), drive() | doubt("8", "size"))) == [("pass", "kept")]


def test_a_reference_point_in_doubt(tmp_path: Path) -> None:
    sections = {"reference": "SELECT drive_id, ego_id, t_ns FROM exit_taken", "condition": SPEED}
    rule = write(tmp_path, EXECUTION | MEASURED | {"reads": '["ego_state", "exit_taken"]'}, sections)
    given = drive() | {"exit_taken": {"t_s": [1.0, 2.0], "side": "left"}} | doubt("e", "velocity")
    assert brief(verdicts(rule, given)) == [("unknown", "doubted"), ("pass", "kept")]


@pytest.mark.ci
def test_what_only_words_a_reason_is_not_used(tmp_path: Path) -> None:
    worded = GAP.replace(
        "FROM pair", ", why('object_lacks', {'object_id': speed_mps, 'lack': 'no_size'}) AS reason FROM pair"
    )
    rule = write(tmp_path, INVARIANT | MEASURED | {"reads": '["pair"]'}, {"condition": worded})
    assert "velocity" not in rule.quantities


def test_declared_quantities_are_words_of_the_vocabulary() -> None:
    assert {
        q for columns in input_quantities_by_column().values() for used in columns.values() for q in used
    } <= QUANTITIES


@pytest.mark.parametrize("rule", load_rules().values(), ids=lambda rule: rule.id)
def test_every_measure_of_a_shipped_rule_declares_what_it_is_made_of(rule: Rule) -> None:
    """A column in metres, metres a second or radians, of an ego or another actor, is made of something."""
    kept = lifetimes()
    bare = [
        f"{table}.{column}"
        for table in rule.reads
        if kept.get(table) in {"drive", "part"} and "ego_id" in column_comments()[table]
        for column in column_comments()[table]
        if column.endswith(("_mps", "_mps2", "_mps3", "_rad"))
        and column not in input_quantities_by_column().get(table, {})
        if "limit" not in column and table not in NOT_OF_ACTORS
    ]
    assert not bare


NOT_OF_ACTORS = {"ego_condition"}
"""Tables of what holds around the ego, as the map and the user say."""
