"""Actors, drives, what is expected of them, and how they are written."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from tests.outsiders import log
from tests.outsiders.log import Scene, Size
from tests.outsiders.seventeenth.road import Map, Moved
from tests.outsiders.seventeenth.ways import EAST, WEST, Pairs, Speeds, Way, gone, smooth

SIZES: dict[str | None, Size] = {
    "car": (4.5, 1.8, 1.5),
    "van": (5.4, 2.0, 2.2),
    "truck": (12.0, 2.5, 3.6),
    "bus": (11.5, 2.55, 3.2),
    "motorcycle": (2.2, 0.8, 1.4),
    "bicycle": (1.8, 0.6, 1.7),
    "trailer": (5.0, 2.0, 2.0),
    "pedestrian": (0.5, 0.6, 1.75),
    "animal": (2.4, 0.7, 2.2),
}
Lamps = Sequence[tuple[float, str]]  # (from, state)
Wanted = tuple[str, str, str]  # rule, verdict, why
_E = 1e-3  # seconds, for differences


@dataclass
class Actor:
    """Somebody: the way, the speeds along it, where it begins, and how far to the left of it they are."""

    name: str
    way: Way
    speeds: Speeds
    s0: float = 0.0
    off: Pairs = ((0.0, 0.0),)
    cls: str | None = "car"
    ind: Lamps | None = ((0.0, "off"),)
    seen_from: float = 0.0

    def pose(self, t: float) -> tuple[float, float, float]:
        """Return x, y and heading."""
        x, y, h = self.way.at(self.s0 + gone(self.speeds, t))
        d = smooth(self.off, t)
        along = gone(self.speeds, t + _E) - gone(self.speeds, t - _E)
        aside = smooth(self.off, t + _E) - smooth(self.off, t - _E)
        yaw = h + (math.atan(aside / along) if abs(along) > _E else 0.0)
        return x - math.sin(h) * d, y + math.cos(h) * d, yaw

    def velocity(self, t: float) -> tuple[float, float]:
        before, after = self.pose(t - _E), self.pose(t + _E)
        return (after[0] - before[0]) / (2 * _E), (after[1] - before[1]) / (2 * _E)

    def columns(
        self, times: Sequence[float], moved: Moved, noise: float, random: np.random.Generator
    ) -> dict[str, list[Any]]:
        """Return the columns of `actor_state`."""
        seen = [t for t in times if t >= self.seen_from]
        rows = [self._row(t, moved, noise, random) for t in seen]
        names = ("x_m", "y_m", "yaw_rad", "vx_mps", "vy_mps")
        return {
            "actor_id": [self.name] * len(seen),
            "t_ns": [round(t * 1e9) for t in seen],
            **{name: [row[i] for row in rows] for i, name in enumerate(names)},
            "indicator": [None if self.ind is None else log.at(self.ind, t) for t in seen],
            "brake_light": [None] * len(seen),
        }

    def _row(self, t: float, moved: Moved, noise: float, random: np.random.Generator) -> tuple[float, ...]:
        """Return place, heading and velocity as the log has them, in the map's frame."""
        x, y, yaw = self.pose(t)
        vx, vy = self.velocity(t)
        if noise:
            x, y = x + random.normal(0, noise), y + random.normal(0, noise)
        x0, y0, turned = moved
        c, s = math.cos(turned), math.sin(turned)
        heading = math.atan2(math.sin(yaw + turned), math.cos(yaw + turned))
        return c * x - s * y + x0, s * x + c * y + y0, heading, c * vx - s * vy, s * vx + c * vy


def go(name: str, speeds: Speeds, x: float, y: float = 1.75, *, back: bool = False, **more: Any) -> Actor:
    """Return somebody who goes along x (or against it) at y."""
    return Actor(name, Way(x, y, WEST if back else EAST), speeds, **more)


@dataclass
class Drive:
    """One drive and what is expected of its verdicts."""

    name: str
    map: Map
    actors: Sequence[Actor]
    seconds: float
    wanted: Sequence[Wanted]
    nation: str = "gb"
    weather: str = "dry"
    light: str = "day"
    more: Mapping[str, str] = field(default_factory=dict)
    hz: float = 10.0
    moved: Moved = (0.0, 0.0, 0.0)
    signals: Sequence[tuple[str, float, str]] = ()
    events: Sequence[tuple[float, str, Any]] = ()
    noise: float = 0.0

    @property
    def scene(self) -> Scene:
        """What happens, which is why a verdict is expected, and the verdicts."""
        return Scene(
            self.name,
            "; ".join(why for _, _, why in self.wanted),
            {rule: verdict for rule, verdict, _ in self.wanted},
        )

    def write(self, folder: Path) -> None:
        """Write the drive into a folder of its name."""
        random = np.random.default_rng(sum(map(ord, self.name.removesuffix("_s"))))
        times = [i / self.hz for i in range(round(self.seconds * self.hz) + 1)]
        log.write(
            folder / self.name,
            self.map(self.moved),
            [log.Box(who.name, who.cls, SIZES[who.cls]) for who in self.actors],
            [who.columns(times, self.moved, self.noise, random) for who in self.actors],
            {"nation": self.nation, "weather": self.weather, "light": self.light, **self.more},
            [(signal, round(t * 1e9), state) for signal, t, state in self.signals],
            self.events,
        )


def draw(
    name: str, drawn: Map, actors: Sequence[Actor], seconds: float, wanted: Sequence[Wanted], **more: Any
) -> Drive:
    """Return a drive; its name ends as all of this outsider do."""
    return Drive(f"{name}_s", drawn, actors, seconds, wanted, **more)
