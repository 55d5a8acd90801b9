"""Where the paper's own case studies come out otherwise here than in the paper: said in the report, beside the views."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    Row = Mapping[str, Any]


class Note(NamedTuple):
    """What a note is about; per row what the authors have, what this report has, and why."""

    title: str
    rows: list[tuple[str, str, str, str]]


_OVERTAKES: Final = Note(
    "Beside the paper's Table 1 (Harper et al.): the same verdicts, other distances",
    [
        (
            "distance ahead",
            "76.43, 58.33, 35.63 m (safe, near miss, collision)",
            "some 2 m less",
            "they measure two steps (0.2 s) earlier, and in a scale of latitude and longitude that is 0.18 % too long",
        ),
        (
            "safe distance ahead",
            "101.39, 63.73, 40.02 m (relaxed, nominal, aggressive)",
            "the same within 5 cm",
            "the speeds are those that the log has at the moment",
        ),
        (
            "the near miss",
            "no contact",
            "a contact, told by the speeds",
            "the recorded boxes, a little smaller than the bodies, never touch, but one of the two loses speed faster than tyres can",
        ),
    ],
)
_FILM: Final = Note(
    "Beside the paper's Table 2 (Harper et al.); second 0 here is second 90 of the film, frame 0",
    [
        (
            "oncoming vehicle (assertions 2, 3, 4)",
            "fail in frame 175 (95.83 s), and from 196 (96.53 s) to the abort",
            "the same; of all frames 170 (95.67 s) is the first",
            "they look at every 7th frame",
        ),
        ("the same in frames 182 and 189", "pass", "unknown", "nobody was detected, which is not nobody there"),
        (
            "the same before frame 170",
            "pass",
            "unknown",
            "the detector saw nobody beyond 50.9 m; the danger spaces reach 71.4 m each",
        ),
        (
            "vehicle being passed (assertion 1)",
            "pass throughout",
            "fail, unknown where it was not detected",
            "theirs is a constant; it was 12.3 m ahead and less, and with the offsets assumed it is in the path",
        ),
    ],
)
_OF: Final = {
    "17be8a04c5126c316f44070ff7b758308e61b5e4a0138ad3fc8b1585e620432b": _OVERTAKES,  # safe
    "7eb4007c2f6fd4ca213411115b9ce19973c840b6c4a568ab70a1cfda9456b1dc": _OVERTAKES,  # near miss
    "e8ed5bf77d803c40ed41d3f29ddeca7054affddcdff1c44a29b66ccb9b693610": _OVERTAKES,  # collision
    "517679d844fca426b466d6b86ed5ee3d570cb5cfe527b74acfd6e71503da0857": _FILM,
}
"""The authors' published logs by their sha256: what is said here is true of no other."""


def notes(drives: Sequence[Row]) -> list[Note]:
    """Return the notes on the case studies that are among the drives."""
    found: list[Note] = []
    for row in drives:
        note = _OF.get(row["sha256"])
        if note is not None and note not in found:
            found.append(note)
    return found
