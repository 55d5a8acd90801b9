"""The line on what the verdicts rest on: egos that never move are counted, as moving rules ask nothing of them."""

from __future__ import annotations

import pytest

from drivelint.report.inputs import input_notes
from tests.report.synthetic import result, verdict

PARKED = {"reason_code": "ego_never_moves"}


@pytest.mark.parametrize(
    ("parked", "words"),
    [
        ((), None),
        (("a",), "1 of 3 egos never moves: only rules about standing vehicles apply"),
        (("a", "b"), "2 of 3 egos never move: only rules about standing vehicles apply"),
    ],
)
def test_egos_that_never_move_are_counted_once(parked: tuple[str, ...], words: str | None) -> None:
    rows = [
        verdict("not_applicable", ego_id=ego, rule_id=rule, **PARKED if ego in parked else {})
        for ego in "abc"
        for rule in ("ukhc.no-collision", "ukhc.r126.thinking-gap")
    ]
    notes = {note.label: note for note in input_notes(result(rows, []))}
    assert (notes["parked"].words if "parked" in notes else None) == words
