"""A scene as data, and how its drive is written."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from tests.outsiders import log
from tests.outsiders.log import Scene
from tests.outsiders.ninth.movement import Clock

if TYPE_CHECKING:
    from pathlib import Path

    from tests.outsiders.ninth.movement import Actor
    from tests.outsiders.ninth.road import Map

Lights = Mapping[str, Sequence[tuple[float, str]]]
Events = Sequence[tuple[float, str, Any]]


@dataclass
class Drive:
    """Who moves where and how long, and what the log says besides; the scene's name begins with the nation."""

    scene: Scene
    map: Map
    actors: Sequence[Actor]
    until: float
    rate: float = 10
    noise: float = 0.0
    lights: Lights = field(default_factory=dict)
    events: Events = ()
    conditions: Mapping[str, str] = field(default_factory=dict)

    def write(self, folder: Path) -> None:
        """Write the drive into a folder of its name."""
        name = self.scene.name
        nation = name.partition("_")[0]
        clock = Clock(name, self.until, self.rate, self.noise)
        steps = [i / self.rate for i in range(round(self.until * self.rate) + 1)]
        sides = {"near": "left", "offside": "right"} if nation == "gb" else {"near": "right", "offside": "left"}
        in_order = sorted(self.events, key=lambda event: event[0])
        said: list[tuple[float, str, Any]] = [(t, event, sides.get(value or "", value)) for t, event, value in in_order]
        log.write(
            folder / name,
            self.map.xml(-1 if nation == "gb" else 1),
            [actor.box() for actor in self.actors],
            [actor.states(self.map, clock) for actor in self.actors],
            {"nation": nation, "weather": "dry", "light": "day", **self.conditions},
            [(light, round(t * 1e9), log.at(states, t)) for light, states in self.lights.items() for t in steps],
            said,
        )


def draw(  # noqa: PLR0917
    name: str,
    what: str,
    expect: str,
    drawn: Map,
    actors: Sequence[Actor],
    until: float,
    rate: float = 10,
    noise: float = 0.0,
    lights: Lights | None = None,
    events: Events = (),
    **conditions: str,
) -> Drive:
    """Return a drive with its scene."""
    scene = Scene(name, what, log.judgements(expect))
    return Drive(scene, drawn, actors, until, rate, noise, lights or {}, events, conditions)
