"""A scene as data, and how its drive is written."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from tests.outsiders import log
from tests.outsiders.second.words import scene

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from tests.outsiders.log import Scene
    from tests.outsiders.second.movement import Actor, Steps
    from tests.outsiders.second.worlds import World

MOTORWAY: dict[str, Any] = {"road_type": "motorway"}


@dataclass
class Drive:
    """Who, where, how long, and what the log says besides."""

    name: str
    world: World
    actors: Sequence[Actor]
    seconds: float = 20
    conditions: dict[str, str] = field(default_factory=dict)
    events: Sequence[tuple[float, str, str]] = ()
    lights: Mapping[str, Steps] = field(default_factory=dict)
    rate: float = 10
    noise: float = 0

    @property
    def scene(self) -> Scene:
        """What happens, and what is expected."""
        return scene(self.name)

    def write(self, folder: Path) -> None:
        """Write the drive into a folder of its name."""
        hand, line = self.world.hand, self.world.line
        tenths = range(int(self.seconds * 10) + 1)
        log.write(
            folder / self.name,
            self.world.xodr(),
            [actor.box() for actor in self.actors],
            [a.states(line, hand, self.seconds, self.rate, self.noise, n) for n, a in enumerate(self.actors)],
            {"nation": "de" if hand > 0 else "gb", "weather": "dry", "light": "day"} | self.conditions,
            [(n, k * 100_000_000, log.at(steps, k / 10)) for n, steps in self.lights.items() for k in tenths],
            self.events,
        )
