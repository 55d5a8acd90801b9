"""A drive, what an examiner says of it, and how it is written."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from tests.outsiders import log
from tests.outsiders.log import Scene
from tests.outsiders.thirteenth.motion import FINE, Actor
from tests.outsiders.thirteenth.road import Frame, Map

GB = {"nation": "gb", "weather": "dry", "light": "day"}
DE = {"nation": "de", "weather": "dry", "light": "day"}
NIGHT = {**GB, "light": "night"}
TURNED: Frame = (0.7, 431.0, -218.0)
FAR: Frame = (-2.2, -1500.0, 90.0)
Wanted = Sequence[tuple[str, str, str]]  # rule, verdict, why
Lights = Mapping[str, Sequence[tuple[float, str]]]
Events = Sequence[tuple[float, str, str]]


@dataclass
class Drive:
    """One drive and what is expected of its verdicts."""

    name: str
    map: Map
    actors: Sequence[Actor]
    seconds: float
    wanted: Wanted
    conditions: Mapping[str, str]
    hz: float = 10
    lights: Lights | None = None
    events: Events = ()

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
        random = np.random.default_rng(1)
        twice = [k / 2 for k in range(int(self.seconds * 2) + 1)]
        lights = self.lights or {}
        log.write(
            folder / self.name,
            self.map.xml(),
            [actor.box() for actor in self.actors],
            [self._columns(actor, random) for actor in self.actors],
            self.conditions,
            [(name, round(t * 1e9), log.at(states, t)) for name, states in lights.items() for t in twice],
            self.events,
        )

    def _columns(self, actor: Actor, random: np.random.Generator) -> dict[str, list[Any]]:
        """Return the columns of `actor_state`."""
        turned, dx, dy = self.map.frame
        c, s = math.cos(turned), math.sin(turned)
        track = actor.track(self.seconds)
        rows = []
        for k in range(int(self.seconds * self.hz) + 1):
            t = k / self.hz
            if not actor.visible(t):
                continue
            i = min(round(t / FINE), len(track.x) - 1)
            noise = random.normal(0, actor.noise, 4) if actor.noise else np.zeros(4)
            x, y, vx, vy = np.array([track.x[i], track.y[i], track.vx[i], track.vy[i]]) + noise
            yaw = math.remainder(track.h[i] + turned, 2 * math.pi)
            rows.append((round(t * 1e9), c * x - s * y + dx, s * x + c * y + dy, yaw, c * vx - s * vy, s * vx + c * vy))
        columns = dict(
            zip(("t_ns", "x_m", "y_m", "yaw_rad", "vx_mps", "vy_mps"), map(list, zip(*rows, strict=True)), strict=True)
        )
        n = len(rows)
        return {
            "actor_id": [actor.name] * n,
            **columns,
            "z_m": [(actor.box().size[2] or 0) / 2] * n,
            "indicator": [actor.lamp(t / 1e9) for t in columns["t_ns"]],
            "brake_light": [None] * n,
        }


def draw(name: str, drawn: Map, actors: Sequence[Actor], seconds: float, wanted: Wanted, **more: Any) -> Drive:
    """Return a drive; its name ends as all of this outsider do."""
    return Drive(f"{name}_o", drawn, actors, seconds, wanted, more.pop("conditions", GB), **more)
