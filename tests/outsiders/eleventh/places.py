"""Roads that several scenes use, and places across them."""

from __future__ import annotations

import numpy as np

from tests.outsiders.eleventh.motion import Actor, actor, track
from tests.outsiders.eleventh.road import DE, GB, Path, simple

N = 1.75
STRAIGHT = [(1400.0, 0.0)]
BENDS = [(150.0, 0.0), (180.0, 1 / 230), (150.0, -1 / 260), (700.0, 0.0)]
INNER = [2 + 1.75, 2 + 5.25, 2 + 8.75]  # the middles of a motorway's lanes, from the inner one
SHOULDER = 2 + 10.5 + 1.6


def beside(x: float, when: float, side: int = GB, pre: float = 4.0, post: float = 2.5) -> list[tuple[float, float]]:
    """Move to x (metres from the middle, near side positive) around a moment, and back."""
    n = side * N
    return [(0, n), (when - pre, n), (when - pre + 2.5, side * x), (when + post, side * x), (when + post + 3, n)]


def out(a: float, b: float, side: int = GB, takes: float = 2.5) -> list[tuple[float, float]]:
    """Out into the other lane at a, back at b."""
    n = side * N
    return [(0, n), (a, n), (a + takes, -n), (b, -n), (b + takes, n)]


def near(side: int = GB, x: float = N) -> list[tuple[float, float]]:
    """Keep to a place across the road, the middle of the own lane if none is said."""
    return [(0.0, side * x)]


def horse(p: Path, span: float, s: float, v: float, x: float = 2.65, hz: float = 10.0, name: str = "h") -> Actor:  # noqa: PLR0917
    """Somebody on a horse."""
    return actor(name, "animal", track(p, span, s, v, lat=near(GB, x), hz=hz))


def cyclist(  # noqa: PLR0917
    p: Path, span: float, s: float, v: float, x: float = 2.65, side: int = GB, hz: float = 10.0, name: str = "c"
) -> Actor:
    """Somebody on a bicycle."""
    return actor(name, "bicycle", track(p, span, s, v, lat=near(side, x), hz=hz))


def bahn(length: float = 2500.0) -> tuple[str, Path]:
    """Return a motorway of Germany."""
    return simple(DE, [(length, 0.0)], kind="motorway", speed=130, near=3, far=3, median=2.0, verge="shoulder")


def on(i: int) -> list[tuple[float, float]]:
    """Keep to a lane of it, 0 the inner one."""
    return [(0.0, -INNER[i])]


def motorway() -> tuple[str, Path]:
    """Return a motorway of Great Britain."""
    return simple(GB, [(2000.0, 0.0)], kind="motorway", speed=70, near=3, far=3, median=2.0, verge="shoulder")


def says(sid: str, span: float, *when: tuple[float, str]) -> list[tuple[str, float, str]]:
    """Say what a light shows, ten times a second."""
    return [(sid, float(t), [w for a, w in when if a <= t + 1e-6][-1]) for t in np.arange(0, span + 0.05, 0.1)]
