"""The automated driver changes lane."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.fourteenth.drive import Drive
from tests.outsiders.fourteenth.places import MID, SLOW
from tests.outsiders.fourteenth.scenes import changes


def lane_changes_a() -> Iterator[Drive]:
    r = "alks-r157.r79.lane-change"
    done = "alks-r157.r79.lane-change-done"
    slow = ((6.0, SLOW), (9.0, 9.3), (15.0, 8.1), (19.0, MID))
    back = ((8.0, MID), (12.0, SLOW))
    yield changes("r79-18", "indicator 1.8 s before the line", [(r, "fail", "1.8 s")], 1.8)
    yield changes("r79-4", "indicator 4 s before the line", [(r, "pass", "4 s"), (done, "pass", "1.4 s astride")], 4.0)
    yield changes("r79-7", "indicator 7 s before the line", [(r, "fail", "7 s")], 7.0, nation="gb")
    yield changes("r79-wrong", "indicator of the other side", [(r, "fail", "wrong side")], 4.0, wrong=True)
    yield changes(
        "r79-none", "no indicator, back to the slow lane", [(r, "fail", "none")], None, points=back, nation="gb"
    )
    yield changes(
        "r79-out-early",
        "indicator 4 s before, out 1.2 s before the line",
        [(r, "fail", "not on when it crossed")],
        4.0,
        stop_s=1.2,
    )
    yield changes(
        "r79-long",
        "astride the line for over 7 s",
        [(r, "pass", "4 s"), (done, "fail", "over 7 s astride")],
        4.0,
        points=slow,
        hz=20.0,
    )
    yield changes(
        "r79-home", "to the slow lane, 3.6 s", [(r, "pass", "3.6 s"), (done, "pass", "short")], 3.6, points=back
    )


def lane_changes() -> Iterator[Drive]:
    """Return the drives of this chapter."""
    yield from lane_changes_a()
