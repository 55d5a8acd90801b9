"""A drive as drawn, what is expected of it, and how it is written."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from tests.outsiders import log
from tests.outsiders.fourteenth.lines import Motion
from tests.outsiders.fourteenth.places import Place
from tests.outsiders.log import Scene

Size = tuple[float, float, float]
Lamps = Sequence[tuple[float, str | None]]  # (from, state)
Events = Sequence[tuple[float, str, Any]]  # (time, event, value)
Wanted = Sequence[tuple[str, str, str]]  # rule, verdict, why

SIZES: dict[str | None, Size] = {
    "car": (4.5, 1.8, 1.5),
    "van": (5.8, 2.0, 2.4),
    "truck": (12.0, 2.5, 3.8),
    "bus": (12.0, 2.55, 3.2),
    "motorcycle": (2.2, 0.8, 1.4),
    "bicycle": (1.8, 0.6, 1.7),
    "trailer": (10.0, 2.5, 3.8),
    "pedestrian": (0.5, 0.5, 1.75),
    "animal": (2.4, 0.8, 2.2),
}
UNKNOWN: Lamps = ((0.0, None),)
OFF: Lamps = ((0.0, "off"),)


@dataclass(frozen=True)
class Actor:
    """Somebody in the drive; `lost`: between these times the log has no track of it."""

    name: str
    kind: str | None
    motion: Motion
    size: Size | None = None
    lamp: Lamps = UNKNOWN
    seen: tuple[float, float] = (0.0, 1e9)
    lost: tuple[float, float] = (0.0, 0.0)

    def box(self) -> log.Box:
        return log.Box(self.name, self.kind, self.size or SIZES[self.kind])

    def columns(
        self, times: np.ndarray[Any, np.dtype[np.float64]], shake: float, random: np.random.Generator
    ) -> dict[str, list[Any]]:
        """The columns of `actor_state`."""
        kept = (times >= self.seen[0]) & (times <= self.seen[1]) & ~((times > self.lost[0]) & (times < self.lost[1]))
        t = times[kept]
        x, y, yaw, vx, vy = self.motion.at(t)
        if shake and self.name != "ego":
            x, y, vx, vy = (values + random.normal(0, shake, t.size) for values in (x, y, vx, vy))
        return {
            "actor_id": [self.name] * t.size,
            "t_ns": [round(at * 1e9) for at in t.tolist()],
            "x_m": x.tolist(),
            "y_m": y.tolist(),
            "z_m": [0.0] * t.size,
            "yaw_rad": yaw.tolist(),
            "vx_mps": vx.tolist(),
            "vy_mps": vy.tolist(),
            "indicator": [state_at(self.lamp, at) for at in t.tolist()],
            "brake_light": [None] * t.size,
        }


def car(motion: Motion, kind: str = "car", lamp: Lamps = OFF, size: Size | None = None) -> Actor:
    """The ego; its lamps are off if nothing else is said."""
    return Actor("ego", kind, motion, size=size, lamp=lamp)


def state_at(steps: Lamps, t: float) -> str | None:
    """The state that holds at a time."""
    return [state for begin, state in steps if begin <= t + 1e-9 or begin == steps[0][0]][-1]


@dataclass(frozen=True)
class Drive:
    """A drive with what is expected of its verdicts."""

    title: str
    what: str
    place: Place
    ego: Actor
    others: Sequence[Actor]
    seconds: float
    wanted: Wanted
    hz: float = 10.0
    env: Mapping[str, str] = field(default_factory=dict)
    events: Events = ()
    lights: Mapping[str, Lamps] = field(default_factory=dict)
    noise: float = 0.0

    @property
    def name(self) -> str:
        return f"{self.title}_p"

    @property
    def scene(self) -> Scene:
        """What happens, and the verdicts with their reasons."""
        reasons = "; ".join(why for _, _, why in self.wanted)
        return Scene(self.name, f"{self.what}: {reasons}", {rule: verdict for rule, verdict, _ in self.wanted})

    def write(self, folder: Path) -> None:
        """Write the drive into a folder of its name."""
        n = round(self.seconds * self.hz) + 1
        times = np.arange(n) / self.hz
        random = np.random.default_rng(len(self.name) * 1000 + n)
        tenths = [i / 10 for i in range(round(self.seconds * 10) + 1)]
        shown = [
            (name, round(t * 1e9), state_at(steps, t) or "off") for name, steps in self.lights.items() for t in tenths
        ]
        actors = (self.ego, *self.others)
        log.write(
            folder / self.name,
            self.place.xml(),
            [actor.box() for actor in actors],
            [actor.columns(times, self.noise, random) for actor in actors],
            {"nation": self.place.nation, "weather": "dry", "light": "day"} | dict(self.env),
            shown,
            self.events,
        )
