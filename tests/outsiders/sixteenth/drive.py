"""A drive, what an examiner says of it, and how it is written."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path as Folder
from typing import Any

import numpy as np

from tests.outsiders import log
from tests.outsiders.log import Scene, Size
from tests.outsiders.sixteenth.road import Frame, Map
from tests.outsiders.sixteenth.ways import TICK, Motion

SIZES: dict[str | None, Size] = {
    "car": (4.5, 1.8, 1.5),
    "van": (6.0, 2.1, 2.4),
    "truck": (12.0, 2.5, 3.6),
    "bus": (12.0, 2.5, 3.2),
    "motorcycle": (2.2, 0.8, 1.4),
    "bicycle": (1.8, 0.6, 1.7),
    "trailer": (5.0, 2.0, 1.8),
    "pedestrian": (0.5, 0.6, 1.75),
    "animal": (2.4, 0.7, 2.2),
    None: (4.4, 1.8, 1.5),
}
_BEGIN = 1.0  # the logs begin a second after zero
_UNLIT = ("pedestrian", "animal", "bicycle", "object", "trailer")
_NO_INDICATOR = ("pedestrian", "animal", "bicycle", "object")
_OTHER_SIDE = {"left": "right", "right": "left"}

Lamps = Sequence[tuple[float, str]]  # (from, state)
Wanted = tuple[str, str, str]  # rule, verdict, why
Said = tuple[float, str, str | None]  # time, event, value


@dataclass
class Actor:
    """Somebody, and what the log does to its track; lamps None: those of it are not known."""

    id: str
    cls: str | None
    way: Motion
    ind: Lamps | None = ((0, "off"),)
    brakes: bool = True
    size: Size | None = None
    since: float = 0.0
    gaps: Sequence[tuple[float, float]] = ()
    noise: float = 0.0

    def box(self) -> log.Box:
        return log.Box(self.id, self.cls, self.size or SIZES[self.cls])

    def columns(self, ticks: Sequence[int], frame: Frame, random: np.random.Generator) -> dict[str, list[Any]]:
        """Return the columns of `actor_state`."""
        seen = [i for i in ticks if self._seen(float(self.way.t[i]))]
        places = [self._place(i, frame, random) for i in seen]
        gain = self.way.gain()
        c, s = math.cos(frame.turned), math.sin(frame.turned)
        vx, vy = [float(self.way.vx[i]) for i in seen], [frame.side * float(self.way.vy[i]) for i in seen]
        return {
            "actor_id": [self.id] * len(seen),
            "t_ns": [round((_BEGIN + float(self.way.t[i])) * 1e9) for i in seen],
            "x_m": [x for x, _, _ in places],
            "y_m": [y for _, y, _ in places],
            "yaw_rad": [yaw for _, _, yaw in places],
            "vx_mps": [a * c - b * s for a, b in zip(vx, vy, strict=True)],
            "vy_mps": [a * s + b * c for a, b in zip(vx, vy, strict=True)],
            "indicator": [self._indicator(float(self.way.t[i]), frame) for i in seen],
            "brake_light": [self._brake_light(float(gain[i]), float(self.way.speed[i])) for i in seen],
        }

    def _seen(self, t: float) -> bool:
        return t >= self.since - 1e-9 and not any(begin <= t <= end for begin, end in self.gaps)

    def _place(self, i: int, frame: Frame, random: np.random.Generator) -> tuple[float, float, float]:
        x, y, yaw = frame.place(float(self.way.x[i]), float(self.way.y[i]), float(self.way.yaw[i]))
        if self.noise:
            x, y = x + random.normal(0, self.noise), y + random.normal(0, self.noise)
        return x, y, (yaw + math.pi) % (2 * math.pi) - math.pi

    def _indicator(self, t: float, frame: Frame) -> str | None:
        if self.ind is None or self.cls in _NO_INDICATOR:
            return None
        state = log.at(self.ind, t)
        return _OTHER_SIDE.get(state, state) if frame.mirrored else state

    def _brake_light(self, gain: float, speed: float) -> str | None:
        if not self.brakes or self.cls in _UNLIT:
            return None
        if gain < -5:
            return "strong"
        return "on" if gain < -0.6 or abs(speed) < 0.05 else "off"


@dataclass
class Drive:
    """One drive and what is expected of its verdicts."""

    name: str
    map: Map
    actors: Sequence[Actor]
    conditions: Mapping[str, str]
    seconds: float
    wanted: Sequence[Wanted]
    hz: float = 10.0
    turned: float = 0.0
    shift: tuple[float, float] = (0.0, 0.0)
    lights: Mapping[str, Lamps] = field(default_factory=dict)
    events: Sequence[Said] = ()

    @property
    def scene(self) -> Scene:
        """What happens, which is why a verdict is expected, and the verdicts."""
        return Scene(
            self.name,
            "; ".join(why for _, _, why in self.wanted),
            {rule: verdict for rule, verdict, _ in self.wanted},
        )

    def write(self, folder: Folder) -> None:
        """Write the drive into a folder of its name."""
        random = np.random.default_rng(0)
        frame = Frame(self.conditions["nation"].startswith("gb"), self.turned, *self.shift)
        steps = np.round(np.arange(0, self.seconds + 1e-9, 1 / self.hz) / TICK)
        ticks = [int(step) for step in steps]
        times = [i * TICK for i in ticks]
        shown = [
            (name, round((_BEGIN + t) * 1e9), log.at(states, t)) for name, states in self.lights.items() for t in times
        ]
        said: list[tuple[float, str, Any]] = []
        for t, event, value in sorted(self.events, key=lambda one: one[0]):
            seen = _OTHER_SIDE.get(value or "", value) if frame.mirrored else value
            said.append((_BEGIN + t, event, seen))
        log.write(
            folder / self.name,
            self.map.xml(frame),
            [actor.box() for actor in self.actors],
            [actor.columns(ticks, frame, random) for actor in self.actors],
            self.conditions,
            shown,
            said,
        )


def draw(  # noqa: PLR0917
    name: str,
    drawn: Map,
    actors: Sequence[Actor],
    conditions: Mapping[str, str],
    seconds: float,
    wanted: Sequence[Wanted],
    **more: Any,
) -> Drive:
    """Return a drive; its name ends as all of this outsider do."""
    return Drive(f"{name}_r", drawn, actors, conditions, seconds, wanted, **more)
