"""The nations, places across the roads, and who is in most drives."""

from __future__ import annotations

import math

from tests.outsiders.nineteenth.drive import Actor, Knots
from tests.outsiders.nineteenth.path import Path

OWN, OPPOSING = -1.75, 1.75  # the middles of a road's two lanes


def oncoming(  # noqa: PLR0917
    path: Path, far: float, speed: Knots, name: str = "o1", cls: str = "car", across: Knots = OWN
) -> Actor:
    """Somebody who comes the other way and is so far along the path at first."""
    return Actor(name, cls, path.reverse(), path.length - far, speed, across)


def walker(x: float, y: float, speed: Knots, name: str = "w") -> Actor:
    """Somebody on foot who walks across, from the near side."""
    return Actor(name, "pedestrian", Path(x, y, math.pi / 2, [(60, 0)]), 0, speed)


def halting(v: float, start: float, stop: float, wait: float) -> list[tuple[float, float]]:
    """Return the speeds of one who brakes with 2.5 m/s2, stands at a place and goes on with 1.5 m/s2 to 8 m/s."""
    begin = (stop - start - v * v / 5.0) / v
    end = begin + v / 2.5
    return [(0, v), (begin, v), (end, 0), (end + wait, 0), (end + wait + 8.0 / 1.5, 8.0), (99, 8.0)]


def passing_place(  # noqa: PLR0917
    ego_speed: float, other_speed: float, gap: float, out: float, back: float, seconds: float = 3.5, length: float = 4.5
) -> tuple[list[tuple[float, float]], float, float]:
    """Return places across of an overtake from 60 m, where the other is, and when the ego begins to come back.

    gap: between the two when it pulls out; back: behind it when it comes back.
    """
    faster = ego_speed - other_speed
    other = 60.0 + 2.25 + gap + faster * out + length / 2
    home = out + (gap + length + 4.5 + back) / faster
    return [(out, OWN), (out + seconds, OPPOSING), (home, OPPOSING), (home + seconds, OWN)], other, home
