"""Roads, sizes and people that are in many scenes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from tests.outsiders.seventh.movement import Actor, Pace
from tests.outsiders.seventh.road import Bend, Line
from tests.outsiders.seventh.ways import through

if TYPE_CHECKING:
    from tests.outsiders.seventh.maps import Street

WINDING = (Line(250), Bend(300, 1 / 350), Line(400), Bend(200, -1 / 300), Line(300))
STAGGERED = {"e": (34, 0, 0.0), "w": (-34, 0, math.pi), "n": (13, 16, math.pi / 2), "s": (-13, -16, -math.pi / 2)}
NARROW = STAGGERED | {"n": (0, 16, math.pi / 2), "s": (0, -16, -math.pi / 2)}
PERSON = (0.5, 0.6, 1.75)
BICYCLE = (1.8, 0.6, 1.7)
HORSE = (2.4, 0.7, 2.3)
LORRY = (10.0, 2.5, 3.8)


def coming(street: Street, name: str, pace: Pace | float, place: float, **more: Any) -> Actor:
    """Somebody who comes towards the ego, at that place of the road when the log begins."""
    return Actor(name, street.back(), pace, street.road.length - place, **more)


def walker(  # noqa: PLR0917
    name: str, x: float, y0: float, y1: float, speed: float = 1.4, wait: float = 0.0, **more: Any
) -> Actor:
    """Somebody who waits, walks across the road and stays there."""
    pace = Pace(0).hold(wait).to(speed, 2).until(abs(y1 - y0) - speed * speed / 4).to(0, 2).hold(60)
    return Actor(name, through((x, y0), (x, y1)), pace, **{"kind": "pedestrian", "size": PERSON, **more})
