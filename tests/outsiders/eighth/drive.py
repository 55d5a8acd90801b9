"""A scene as data, and how its drive is written."""

from __future__ import annotations

import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from tests.outsiders import log
from tests.outsiders.log import Scene

if TYPE_CHECKING:
    from pathlib import Path

    from tests.outsiders.eighth.movement import Actor
    from tests.outsiders.eighth.road import Map

Lights = Mapping[str, Sequence[tuple[float, str]]]
Events = Sequence[tuple[float, str, Any]]


@dataclass
class Drive:
    """Who moves where and how long, and what the log says besides; the scene's name begins with the nation."""

    scene: Scene
    map: Map
    actors: Sequence[Actor]
    until: float
    rate: int = 10
    lights: Lights = field(default_factory=dict)
    events: Events = ()
    conditions: Mapping[str, str] = field(default_factory=dict)

    def write(self, folder: Path) -> None:
        """Write the drive into a folder of its name."""
        name = self.scene.name
        random = np.random.default_rng(zlib.crc32(name.encode()))
        steps = [i / self.rate for i in range(int(self.until * self.rate) + 1)]
        log.write(
            folder / name,
            self.map.xml(),
            [actor.box() for actor in self.actors],
            [actor.states(self.until, self.rate, random) for actor in self.actors],
            dict(sorted({"nation": name.partition("_")[0], **self.conditions}.items())),
            [(light, round(t * 1e9), log.at(states, t)) for light, states in self.lights.items() for t in steps],
            self.events,
        )


def draw(  # noqa: PLR0917
    name: str,
    what: str,
    expect: str,
    drawn: Map,
    actors: Sequence[Actor],
    until: float,
    rate: int = 10,
    lights: Lights | None = None,
    events: Events = (),
    **conditions: str,
) -> Drive:
    """Return a drive with its scene."""
    scene = Scene(name, what, log.judgements(expect))
    return Drive(scene, drawn, actors, until, rate, lights or {}, events, conditions)
