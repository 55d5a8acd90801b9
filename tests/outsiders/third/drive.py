"""A scene as data, and how its drive is written."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from tests.outsiders import log
from tests.outsiders.log import Scene
from tests.outsiders.third.movement import nanoseconds

if TYPE_CHECKING:
    from pathlib import Path

    from tests.outsiders.third.movement import Actor
    from tests.outsiders.third.road import Map

Lights = Mapping[str, Sequence[tuple[float, str]]]


@dataclass
class Drive:
    """Who moves where and how long, and what the log says besides; the scene's name begins with the nation."""

    scene: Scene
    map: Map
    actors: Sequence[Actor]
    until: float
    step: float = 0.1
    lights: Lights = field(default_factory=dict)
    events: Sequence[tuple[float, str, str]] = ()
    conditions: Mapping[str, str] = field(default_factory=dict)

    def write(self, folder: Path) -> None:
        """Write the drive into a folder of its name."""
        nation = self.scene.name.partition("_")[0]
        hand = 1 if nation == "gb" else -1
        high = any(actor.z for actor in self.actors)
        random = np.random.default_rng(7)
        times = np.arange(0, self.until + 1e-9, self.step)
        log.write(
            folder / self.scene.name,
            self.map.xml(hand),
            [actor.box() for actor in self.actors],
            [actor.states(self.until, self.step, hand, high, random) for actor in self.actors],
            {"nation": nation, "weather": "dry", "light": "day", **self.conditions},
            [(name, nanoseconds(t), log.at(states, t)) for name, states in self.lights.items() for t in times],
            self.events,
        )


def draw(  # noqa: PLR0917
    name: str,
    what: str,
    expect: str,
    drawn: Map,
    actors: Sequence[Actor],
    until: float,
    step: float = 0.1,
    lights: Lights | None = None,
    events: Sequence[tuple[float, str, str]] = (),
    **conditions: Any,
) -> Drive:
    """Return a drive with its scene."""
    scene = Scene(name, what, log.judgements(expect))
    return Drive(scene, drawn, actors, until, step, lights or {}, events, conditions)
