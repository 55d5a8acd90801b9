"""Places across the roads, what holds in most drives, and who takes part in many of them."""

from __future__ import annotations

import math
from typing import Any

from tests.outsiders.sixteenth.drive import Actor
from tests.outsiders.sixteenth.ways import Knots, Motion, line

DE = {"nation": "de", "weather": "dry", "light": "day"}
GB = {"nation": "gb", "weather": "dry", "light": "day"}
ENGLAND = {**GB, "nation": "gb-eng"}
ENGAGED = {**DE, "engaged": "yes"}  # driven by the automated driver
FAST, MIDDLE, SLOW, SHOULDER = -1.875, -5.625, -9.375, -12.75  # a motorway's lanes
OWN, OPPOSING = -1.75, 1.75  # two lanes


def ego(way: Motion, cls: str = "car", **more: Any) -> Actor:
    """The ego; its indicators are off if nothing else is said."""
    return Actor("ego", cls, way, **more)


def up(x: float, y: float, speed: Knots) -> Actor:
    """Somebody who walks across the road to the left."""
    return Actor("p", "pedestrian", Motion(line(x, y, math.pi / 2), speed))


def down(x: float, y: float, speed: Knots) -> Actor:
    """Somebody who walks across the road to the right."""
    return Actor("p", "pedestrian", Motion(line(x, y, -math.pi / 2), speed))
