"""A drive: a map, road users on paths, what is declared, and what an examiner expects."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from tests.outsiders import log
from tests.outsiders.fifteenth.motions import Floats, Knots, follow
from tests.outsiders.fifteenth.roads import World
from tests.outsiders.log import Scene

SIZES = {
    "car": (4.5, 1.8, 1.5),
    "van": (5.5, 2.0, 2.2),
    "truck": (12.0, 2.5, 3.5),
    "bus": (12.0, 2.55, 3.1),
    "motorcycle": (2.2, 0.8, 1.5),
    "bicycle": (1.8, 0.6, 1.7),
    "trailer": (6.0, 2.2, 2.0),
    "pedestrian": (0.5, 0.5, 1.75),
    "animal": (2.4, 0.8, 2.3),
}
Lamps = Sequence[tuple[float, str]]
Box = tuple[float, float, float]


@dataclass
class User:
    """Somebody on the road: s0 along a path at the beginning, at a speed; seen from and to, and lost in between."""

    key: str
    kind: str | None
    size: Box
    path: Floats
    s0: float
    speed: Knots
    lamp: Lamps | None = None
    seen: tuple[float, float] = (0.0, 1e9)
    lost: tuple[float, float] | None = None

    def columns(self, t: Floats, world: World) -> dict[str, list[Any]]:
        """Return the columns of `actor_state`, in the world's frame."""
        t = t[(t >= self.seen[0]) & (t <= self.seen[1])]
        x, y, heading, vx, vy = follow(self.path, self.s0, self.speed, t)
        place = world.place
        c, s = np.cos(place.rot), np.sin(place.rot)
        turned = (heading + place.rot + np.pi) % (2 * np.pi) - np.pi
        keep = np.ones(len(t), bool) if self.lost is None else (t < self.lost[0]) | (t > self.lost[1])
        n = int(keep.sum())
        return {
            "actor_id": [self.key] * n,
            "t_ns": [round(v * 1e9) for v in t[keep]],
            "x_m": (place.x + c * x - s * y)[keep].tolist(),
            "y_m": (place.y + s * x + c * y)[keep].tolist(),
            "yaw_rad": turned[keep].tolist(),
            "vx_mps": (c * vx - s * vy)[keep].tolist(),
            "vy_mps": (s * vx + c * vy)[keep].tolist(),
            "indicator": [None] * n if self.lamp is None else [log.at(self.lamp, v) for v in t[keep]],
            "brake_light": [None] * n,
        }


@dataclass
class Drive:
    """One drive, and what is expected of it."""

    title: str
    world: World
    time: float
    what: str = ""
    hz: float = 10.0
    nation: str = "gb"
    weather: str = "dry"
    light: str = "day"
    more: dict[str, str] = field(default_factory=dict)
    users: list[User] = field(default_factory=list)
    lights: list[tuple[str, float, str]] = field(default_factory=list)
    events: list[tuple[float, str, Any]] = field(default_factory=list)
    wanted: list[tuple[str, str, str]] = field(default_factory=list)

    @property
    def name(self) -> str:
        """The drive's name; those of this outsider end alike."""
        return f"{self.title}_q"

    @property
    def scene(self) -> Scene:
        """What happens, and the verdicts that are expected."""
        reasons = "; ".join(why for _, _, why in self.wanted if why)
        what = f"{self.what}: {reasons}" if reasons else self.what
        return Scene(self.name, what, {rule: verdict for rule, verdict, _ in self.wanted})

    def add(
        self,
        key: str,
        kind: str | None,
        path: Floats,
        speed: Knots | float,
        s0: float = 0.0,
        *,
        size: str | Box | None = None,
        lamp: Lamps | None = None,
        seen: tuple[float, float] = (0.0, 1e9),
        lost: tuple[float, float] | None = None,
    ) -> Drive:
        """Add a road user who starts s0 along the path."""
        knots = [(0.0, speed)] if isinstance(speed, float | int) else speed
        box = SIZES[size or kind or "car"] if size is None or isinstance(size, str) else size
        self.users.append(User(key, kind, box, path, s0, knots, lamp, seen, lost))
        return self

    def light_at(self, key: str, *states: tuple[float, str]) -> Drive:
        """Show the states of a light, each from its time on."""
        self.lights += [(key, t, s) for t, s in states]
        return self

    def say(self, t: float, event: str, value: str | None = None) -> Drive:
        """Let the ego declare something."""
        self.events.append((t, event, value))
        return self

    def want(self, rule: str, verdict: str, why: str = "") -> Drive:
        """Expect a verdict."""
        self.wanted.append((rule, verdict, why))
        return self

    def write(self, folder: Path) -> None:
        """Write the drive into a folder of its name."""
        t = np.arange(0, round(self.time * self.hz) + 1) / self.hz
        log.write(
            folder / self.name,
            self.world.xml(),
            [log.Box(u.key, u.kind, u.size) for u in self.users],
            [u.columns(t, self.world) for u in self.users],
            {"nation": self.nation, "weather": self.weather, "light": self.light, **self.more},
            [(key, int(when * 1e9), state) for key, when, state in self.lights],
            self.events,
        )
