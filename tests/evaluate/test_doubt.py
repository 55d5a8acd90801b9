"""What a check doubts is not judged: by the quantities that a rule's columns are made of, for the ego and for the object."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from drivelint.catalogue import load_rules
from drivelint.sql.declarations import column_comments, input_quantities_by_column, lifetimes
from tests.evaluate.packs import INVARIANT, MEASURE, brief, verdicts, write

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.catalogue import Rule

QUANTITIES = {"existence", "identity", "position", "heading", "velocity", "size", "class"}
GAP = "SELECT drive_id, ego_id, object_id, t_ns, clearance_m AS observed, 0 AS required FROM pair"


@pytest.mark.parametrize("quantity", ["position", "heading", "size", "existence", "identity"])
@pytest.mark.parametrize("actor", ["7", "e"])
def test_the_object_counts_as_the_ego_does(tmp_path: Path, quantity: str, actor: str) -> None:
    rule = write(tmp_path, INVARIANT | MEASURE | {"reads": '["pair"]'}, {"condition": GAP})
    doubt = {"actor_id": actor, "quantity": quantity, "t_from_s": 0.8, "t_to_s": 1.2, "code": "velocity_jolt"}
    for gap in (3, {"else": 3, "1": -1}):
        pair = {"t_s": "0..2 by 0.1", "object_id": "7", "clearance_m": gap}
        given = {"ego_state": {"t_s": "0..2 by 0.1", "speed_mps": 12}, "pair": pair, "doubt": doubt}
        assert brief(verdicts(rule, given)) == [("unknown", "doubted")]


@pytest.mark.ci
def test_what_only_words_a_reason_is_not_used(tmp_path: Path) -> None:
    worded = GAP.replace(
        "FROM pair", ", why('object_lacks', {'object_id': speed_mps, 'lack': 'no_size'}) AS reason FROM pair"
    )
    rule = write(tmp_path, INVARIANT | MEASURE | {"reads": '["pair"]'}, {"condition": worded})
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
