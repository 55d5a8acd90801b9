"""A scene as data, and how its drive is written."""

from __future__ import annotations

import zlib
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tests.outsiders import log
from tests.outsiders.log import Scene

if TYPE_CHECKING:
    from pathlib import Path

    from tests.outsiders.first.movement import Actor
    from tests.outsiders.first.road import Map

Lights = dict[int, list[tuple[float, str]]]
Events = list[tuple[float, str, str]]


@dataclass
class Spec:
    """Who moves where; the first actor is the ego."""

    scene: Scene
    roads: Map
    actors: list[Actor]
    duration: float
    hz: float
    where: dict[str, str]
    lights: Lights
    events: Events

    def write(self, folder: Path) -> None:
        """Write the drive into a folder of its name."""
        names = ["ego", *(f"{actor.kind}_{i + 1}" for i, actor in enumerate(self.actors[1:]))]
        seeds = [zlib.crc32(f"{self.scene.name}/{name}".encode()) + i for i, name in enumerate(names)]
        steps = [round(t * 10) for t in np.arange(0.0, self.duration + 1e-9, 0.1)]
        log.write(
            folder / self.scene.name,
            self.roads.xml(),
            [actor.box(name) for name, actor in zip(names, self.actors, strict=True)],
            [
                actor.states(name, seed, self.duration, self.hz)
                for name, seed, actor in zip(names, seeds, self.actors, strict=True)
            ],
            self.where,
            [(str(n), k * 100_000_000, log.at(states, k / 10)) for n, states in self.lights.items() for k in steps],
            self.events,
        )


def scene(  # noqa: PLR0917
    name: str,
    what: str,
    expect: str,
    roads: Map,
    actors: list[Actor],
    duration: float,
    hz: float = 10.0,
    lights: Lights | None = None,
    events: Events | None = None,
    **where: str,
) -> Spec:
    """Return a scene; `expect` reads 'fail a b | pass c | not fail d': verdicts, and the rules (of ukhc unless they say)."""
    nation = "gb" if next(iter(roads.roads.values())).side > 0 else "de"
    full = {"nation": nation, "light": "day", "weather": "dry", "vehicle_class": "car"} | where
    given = {key: value for key, value in full.items() if value}
    return Spec(
        Scene(name, what, log.judgements(expect)), roads, actors, duration, hz, given, lights or {}, events or []
    )
