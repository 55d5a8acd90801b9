"""The ego, places across the roads, and what holds in most drives."""

from __future__ import annotations

from typing import Any

from tests.outsiders.twelfth.drive import Actor, Lamps
from tests.outsiders.twelfth.ways import Motion, Point, Walk

GB = {"nation": "gb"}
DE = {"nation": "de"}
AL = {"nation": "de", "engaged": "yes"}  # driven by the automated driver
N1, O1 = 1.75, -1.75  # Great Britain, two lanes: the own one, and the opposing one
M3, M2, M1, MS = 1.825, 5.475, 9.125, 12.45  # motorway: right-hand, middle and left lane, hard shoulder
ND, OD = -1.75, 1.75  # Germany, two lanes
DL, DM, DR, DS = -1.825, -5.475, -9.125, -12.45  # Autobahn: left, middle and right lane, hard shoulder
GREEN: dict[str, Lamps] = {f"L{k}": [(0, "green")] for k in range(4)}
ALL = (0, 1, 2, 3)


def ego(way: Motion, cls: str = "car", ind: Lamps | None = (), **more: Any) -> Actor:
    """The ego; its indicators are off if nothing else is said."""
    return Actor("ego", cls, way, ind=ind, **more)


def walk(*points: Point) -> Actor:
    """Somebody on foot."""
    return Actor("p", "pedestrian", Walk(points))


def same(*states: tuple[float, str]) -> dict[str, Lamps]:
    """Both lights of a signalled crossing."""
    return {"P1": states, "P2": states}
