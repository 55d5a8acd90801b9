"""Pedestrian crossings: who is on them, and the ego's ways over them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from tests.derive.junction_scenes import cross, crosswalk
from tests.scenes import Actor, Road, derived, drive, moving, rows, seconds, times

if TYPE_CHECKING:
    from drivelint.engine.batch import Drive
    from tests.scenes import Row

SIDE = {"rht": -1, "lht": 1}  # of the ego's half, along road 1
X = -200 + 100  # the crossing begins here and is 3 m wide


def zebra(hand: str) -> Road:
    """Return the way from west to east with a crossing at s = 100 of road 1."""
    return cross(hand, (), (("1", crosswalk("x", 100.0, label="zebra")),))["we"]


def going(way: Road) -> Actor:
    """The front is at s0 + 2.4 + 8 t: on the crossing at 9.7 s, the rear past it at 10.675 s."""
    t = times(14.0)
    return moving("ego", way, t, 20.0 + 8.0 * t, way.ego_d)


def walker(name: str, t: np.ndarray, y: np.ndarray) -> Actor:
    vy = np.gradient(y, t)
    yaw = np.where(vy < 0, -1.0, 1.0) * np.pi / 2
    return Actor(name, t, np.full(t.shape, X + 1.5), y, yaw, 0 * t, vy, 0.5, 0.5, "pedestrian")


def passages(scene: Drive) -> list[Row]:
    con = derived(scene, tables=["crossing_passage"])
    return rows(con, "FROM crossing_passage ORDER BY drive_id, ego_id, occurrence")


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize(
    ("half", "since", "on"), [(1, 9.0, True), (1, 10.0, True), (1, 11.5, False), (-1, 9.0, False), (1, 8.0, False)]
)
def test_somebody_on_the_egos_half(hand: str, half: int, since: float, on: bool) -> None:
    """Steps from the kerb onto the ego's half (or the other one) at `since` and stays there for a second."""
    way = zebra(hand)
    t = times(14)
    y = np.where((t >= since) & (t < since + 1), 3.0, 4.5) * SIDE[hand] * half
    (row,) = passages(drive([going(way), walker("w", t, y)], way.environment))
    assert row["on_id"] == ("w" if on else None)
    if on:
        assert seconds([row], "t_on_ns") == [pytest.approx(since)]
    assert row["known"] is True


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize(
    ("out", "v", "comes", "is_known"),
    [
        (-1.0, 1.2, True, True),  # a metre beyond the middle as the ego's front comes, and on to its half
        (-1.0, -1.2, False, True),  # the same, but from the ego's half
        (-3.0, -1.2, False, True),  # from the ego's half, and gone again
        (-2.0, -0.1, False, False),  # on the other half to the end of the log
        (-4.5, 1.2, False, True),  # still beyond the other half
    ],
)
def test_somebody_on_the_other_half(hand: str, out: float, v: float, comes: bool, is_known: bool) -> None:
    """Walks so that it is `out` metres on the ego's side of the middle at 9.7 s, towards that side at `v`."""
    way = zebra(hand)
    t = times(14)
    (row,) = passages(drive([going(way), walker("w", t, SIDE[hand] * (out + v * (t - 9.7)))], way.environment))
    assert (row["coming_id"], row["coming_known"]) == ("w" if comes else None, is_known)
