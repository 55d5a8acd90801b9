"""Who moves how along a way, and what the log gets wrong of it."""

from __future__ import annotations

import math
import zlib
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from tests.outsiders.log import Box, Size, at
from tests.outsiders.ninth.maps import OnMap, opposite
from tests.outsiders.ninth.ways import Knots, Moves, Way

if TYPE_CHECKING:
    from tests.outsiders.ninth.road import Map

MPH: Final = 0.44704
KMH: Final = 1 / 3.6
SIZES: Final[dict[str | None, Size]] = {
    "car": (4.5, 1.8, 1.5),
    "van": (5.4, 2.0, 2.3),
    "truck": (11.0, 2.5, 3.6),
    "bus": (12.0, 2.55, 3.1),
    "motorcycle": (2.2, 0.8, 1.5),
    "bicycle": (1.8, 0.6, 1.7),
    "pedestrian": (0.5, 0.5, 1.75),
    "animal": (2.4, 0.8, 2.3),
    "trailer": (4.0, 1.9, 1.8),
    "vehicle": (5.0, 2.0, 2.0),
    None: (4.4, 1.8, 1.5),
}
SIZELESS: Final[Size] = (None, None, None)

Says = Sequence[tuple[float, str]]


class Clock(NamedTuple):
    """A drive's name, length, samples a second, and noise."""

    name: str
    until: float
    rate: float
    noise: float


@dataclass(frozen=True)
class Actor:
    """Somebody on a way: where along it at 0 s, how fast and how far to its left at which times, and what the log knows."""

    name: str
    kind: str | None
    way: Way | OnMap
    start: float
    speeds: Knots | float
    left: Knots | float = 0.0
    size: Size | None = None
    indicator: Says | None = ((0.0, "off"),)
    since: float = 0.0
    until: float | None = None
    turned: bool = False
    from_end: bool = False

    def box(self) -> Box:
        """Return its row of the actors."""
        return Box(self.name, self.kind, self.size or SIZES[self.kind])

    def states(self, drawn: Map, clock: Clock) -> dict[str, list[Any]]:
        """Return the columns of its states, mirrored in Great Britain."""
        british = clock.name.startswith("gb")
        side = -1.0 if british else 1.0
        t = self._times(clock)
        moves = self._moves(drawn, clock, t)
        if clock.noise:
            moves = moves.trembling(zlib.crc32(f"{clock.name}/{self.name}".encode()), clock.noise)
        yaw = [angle + math.pi if self.turned else angle for angle in moves.yaw]
        sides = {"near": "left" if british else "right", "offside": "right" if british else "left"}
        said = [at(self.indicator, when) if self.indicator else None for when in t]
        return {
            "actor_id": [self.name] * len(t),
            "t_ns": [round(when * 1e9) for when in t],
            "x_m": _rounded(moves.x),
            "y_m": _rounded(moves.y, side),
            "yaw_rad": [round((side * angle + math.pi) % (2 * math.pi) - math.pi, 5) for angle in yaw],
            "vx_mps": _rounded(moves.vx),
            "vy_mps": _rounded(moves.vy, side),
            "indicator": [sides.get(word or "", word) for word in said],
            "brake_light": ["strong" if a < -5 else "on" if a < -0.7 else "off" for a in moves.gain],
        }

    def _times(self, clock: Clock) -> list[float]:
        end = clock.until if self.until is None else self.until
        steps = (i / clock.rate for i in range(round(clock.until * clock.rate) + 1))
        return [t for t in steps if self.since - 1e-9 <= t <= end + 1e-9]

    def _moves(self, drawn: Map, clock: Clock, t: list[float]) -> Moves:
        way = self.way if isinstance(self.way, Way) else self.way(drawn)
        start = way.length + self.start if self.from_end else self.start
        return way.travel(start, _knots(self.speeds), _knots(self.left), clock.until, t)


def ego(
    way: Way | OnMap, start: float, speeds: Knots | float, left: Knots | float = 0.0, kind: str = "car", **more: Any
) -> Actor:
    """Return the ego."""
    return Actor("ego", kind, way, start, speeds, left, **more)


def who(  # noqa: PLR0917
    name: str,
    kind: str | None,
    way: Way | OnMap,
    start: float,
    speeds: Knots | float,
    left: Knots | float = 0.0,
    **more: Any,
) -> Actor:
    """Return somebody else."""
    return Actor(name, kind, way, start, speeds, left, **more)


def oncoming(  # noqa: PLR0917
    name: str, kind: str | None, x: float, t: float, speed: float, left: Knots | float = 0.0, **more: Any
) -> Actor:
    """Return somebody in the other lane who is at x at a time."""
    return replace(who(name, kind, opposite, -x - speed * t, speed, left, **more), from_end=True)


def _knots(given: Knots | float) -> Knots:
    return [(0.0, float(given))] if isinstance(given, int | float) else given


def _rounded(values: Sequence[float], side: float = 1.0) -> list[float]:
    return [round(side * value, 4) for value in values]
