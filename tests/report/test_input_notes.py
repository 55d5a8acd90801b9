"""The line on what the verdicts rest on: egos that never move are counted, as moving rules ask nothing of them."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from drivelint.report.inputs import input_notes
from tests.report.synthetic import drive, result, verdict

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


def test_an_unknown_size_of_the_ego_names_the_option_that_gives_it() -> None:
    rows = [
        verdict("unknown", reason_code="missing_ego_size"),
        verdict("unknown", reason_code="missing_map", rule_id="ukhc.r2"),
    ]
    (words,) = (note.words for note in input_notes(result(rows, [])) if note.label == "not judged")
    assert "1 rule without ego size, which --ego-size gives" in words
    assert words.count("--") == 1


def test_a_malformed_cell_is_told_with_its_line_and_column() -> None:
    cell = {
        "check_id": "malformed_cell", "severity": "warning", "actor_id": None, "n": 1, "t_first_ns": None,
        "message": "a.csv, line 8: column 'v' is not a number: those values are unknown",
    }  # fmt: skip
    other = cell | {"check_id": "teleport", "message": "b jumps"}

    def words(*quality: Mapping[str, object]) -> str:
        notes = input_notes(result([verdict("pass")], [], drives=[drive(quality=list(quality))]))
        return next(note.words for note in notes if note.label == "log")

    assert words(cell).endswith(f"1 warning (malformed cell): {cell['message']}")
    assert words(cell, other).endswith(f"{cell['message']}; drivelint inspect shows the others")
    assert words(other).endswith("1 warning (teleport)")
