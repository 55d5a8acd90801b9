"""What the chapters share: kinds of road, and how those move whom the ego meets."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from tests.clean.route import Kind

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from tests.clean.story import Story

    Floats = NDArray[np.float64]

COUNTRY = {"gb": Kind("rural", (60.0, "mph")), "de": Kind("rural", (100.0, "km/h"))}
TOWN = {"gb": Kind("town", (30.0, "mph")), "de": Kind("town", (50.0, "km/h"))}
_APART = Kind("motorway", (70.0, "mph"), lanes=3, oncoming=0, centre="solid", beside="shoulder")
MOTORWAY = {"gb": _APART, "de": replace(_APART, limit=(120.0, "km/h"))}
SIGNAL_S = {"gb": 5.0, "de": 3.0}  # before a lane change begins: Rule 103 asks for time, UN R79 for no more than 5 s
FRONT = 2.4  # from the ego's centre to its bumper


def open_road(w: Story, length: float = 150.0) -> None:
    """Lay a stretch with nobody there, between two chapters."""
    w.slow(w.route.road(length, COUNTRY[w.nation]), length, 13.0)


def steady(t: Floats, at: float, v: float, t0: float) -> Floats:
    """Return the stations of one who is at a station at t0 and keeps his speed."""
    return at + v * (t - t0)


def moving_off(t: Floats, at: float, t_off: float, v: float = 12.0) -> Floats:
    """Return the stations of one who stands at a station and drives off at a time, with 2 m/s2."""
    rolling = np.clip(t - t_off, 0.0, v / 2.0)
    found: Floats = at + rolling**2 + v * np.clip(t - t_off - v / 2.0, 0.0, None)
    return found
