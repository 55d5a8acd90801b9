"""Two vehicles whose ways cross at an angle."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from tests.scenes import Actor, Road, moving, times

if TYPE_CHECKING:
    from tests.scenes import Row


def line(heading: float = 0.0, x: float = 0.0, y: float = 0.0) -> Road:
    """Return a straight way without a map, its station 0 at (x, y)."""
    return Road(None, ((1000.0, 0.0),), (x, y, heading))  # type: ignore[arg-type]


NORTH = line(math.pi / 2)  # comes from the right of who goes east


def east(v: float = 10.0, s0: float = -50.0, end: float = 12.0, name: str = "ego") -> Actor:
    """Go east along y = 0; without more the centre is at the origin at 5 s."""
    t = times(end)
    return moving(name, line(), t, s0 + v * t, 0.0)


SAME = ("t_ego_in_ns", "t_ego_out_ns", "t_object_in_ns", "t_object_out_ns", "pet_s", "pet_at_most", "angle_rad")


def same(row: Row) -> Row:
    """Return what both see of an encounter."""
    return {name: row[name] for name in SAME}


def mirrored(row: Row) -> Row:
    """Return what the other sees of it, the ego and the object having changed places."""
    t1, t2, t3, t4, pet, at_most, angle = same(row).values()
    return dict(zip(SAME, (t3, t4, t1, t2, pet, at_most, -angle), strict=True))
