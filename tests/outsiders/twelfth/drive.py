"""A drive, what an examiner says of it, and how it is written."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path as Folder
from typing import Any

import numpy as np

from tests.outsiders import log
from tests.outsiders.log import Scene, Size
from tests.outsiders.twelfth.road import Map
from tests.outsiders.twelfth.ways import Motion, Pose

SIZES: dict[str | None, Size] = {
    "car": (4.4, 1.8, 1.5),
    "van": (5.6, 2.0, 2.4),
    "truck": (12.0, 2.5, 3.8),
    "bus": (11.5, 2.5, 3.1),
    "motorcycle": (2.1, 0.8, 1.5),
    "bicycle": (1.8, 0.6, 1.7),
    "pedestrian": (0.5, 0.6, 1.75),
    "animal": (2.4, 0.8, 2.3),
    "object": (0.8, 0.8, 0.8),
    "trailer": (6.0, 2.3, 2.5),
    None: (4.5, 1.9, 1.6),
}
Lamps = Sequence[tuple[float, str]]  # (from, state); none: off
Wanted = tuple[str, str, str]  # rule, verdict, why


@dataclass
class Actor:
    """Somebody, and what the log does to its track; ind None: its indicators are not known."""

    id: str
    cls: str | None
    way: Motion
    ind: Lamps | None = None
    size: Size | None = None
    span: tuple[float, float] = (0.0, 1e9)
    gaps: Sequence[tuple[float, float]] = ()
    flip: bool = False
    noise: float = 0.0
    jump: tuple[float, float, float] | None = None
    z: float | None = None

    def box(self) -> log.Box:
        return log.Box(self.id, self.cls, self.size or SIZES[self.cls])

    def columns(
        self, times: Iterable[float], frame: tuple[float, float, float], high: bool, random: np.random.Generator
    ) -> dict[str, list[Any]]:
        """Return the columns of `actor_state`; high: whether the log knows heights."""
        seen = [t for t in times if self._seen(t)]
        poses = [self._logged(t, frame, random) for t in seen]
        height = {"z_m": [self.z or 0.0] * len(seen)} if high else {}
        return {
            "actor_id": [self.id] * len(seen),
            "t_ns": [round(t * 1e9) for t in seen],
            "x_m": [pose.x for pose in poses],
            "y_m": [pose.y for pose in poses],
            **height,
            "yaw_rad": [pose.heading for pose in poses],
            "vx_mps": [pose.vx for pose in poses],
            "vy_mps": [pose.vy for pose in poses],
            "indicator": [self._indicator(t) for t in seen],
            "brake_light": ["on" if self._gains(t) < -0.06 else "off" for t in seen],
        }

    def _seen(self, t: float) -> bool:
        return self.span[0] <= t <= self.span[1] and not any(begin < t < end for begin, end in self.gaps)

    def _gains(self, t: float) -> float:
        """Return the speed gained within a tenth of a second."""
        before, after = self.way.at(t - 0.05), self.way.at(t + 0.05)
        return math.hypot(after.vx, after.vy) - math.hypot(before.vx, before.vy)

    def _logged(self, t: float, frame: tuple[float, float, float], random: np.random.Generator) -> Pose:
        """Return the pose as the log has it, in the map's frame."""
        x, y, h, vx, vy = self.way.at(t)
        if self.jump and t >= self.jump[0]:
            x, y = x + self.jump[1], y + self.jump[2]
        if self.noise:
            x, y = x + random.normal(0, self.noise), y + random.normal(0, self.noise)
        if self.flip:
            h += math.pi
        x0, y0, turned = frame
        c, s = math.cos(turned), math.sin(turned)
        return Pose(
            x0 + x * c - y * s,
            y0 + x * s + y * c,
            math.atan2(math.sin(h + turned), math.cos(h + turned)),
            vx * c - vy * s,
            vx * s + vy * c,
        )

    def _indicator(self, t: float) -> str | None:
        if self.ind is None:
            return None
        return next((state for begin, state in reversed(self.ind) if t >= begin), "off")


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
    lights: Mapping[str, Lamps] = field(default_factory=dict)
    events: Sequence[tuple[float, str, Any]] = ()

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
        random = np.random.default_rng(int(hashlib.sha256(self.name.encode()).hexdigest()[:8], 16))
        high = any(actor.z is not None for actor in self.actors)
        times = [round(i / self.hz, 6) for i in range(round(self.seconds * self.hz) + 1)]
        shown = [(name, round(t * 1e9), log.at(states, t)) for name, states in self.lights.items() for t in times]
        log.write(
            folder / self.name,
            self.map.xml(),
            [actor.box() for actor in self.actors],
            [actor.columns(times, self.map.frame, high, random) for actor in self.actors],
            self.conditions,
            shown,
            self.events,
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
    return Drive(f"{name}_n", drawn, actors, conditions, seconds, wanted, **more)
