"""A scene as data, and how its drive is written."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from tests.outsiders import log
from tests.outsiders.log import Scene

if TYPE_CHECKING:
    from pathlib import Path

    from tests.outsiders.seventh.maps import Map
    from tests.outsiders.seventh.movement import Actor

Lights = Mapping[str, Sequence[tuple[float, str]]]


@dataclass
class Drive:
    """Who moves where and how long, and what the log says besides; the scene's name begins with the nation."""

    scene: Scene
    map: Map
    actors: Sequence[Actor]
    until: float
    hertz: float = 10
    lights: Lights = field(default_factory=dict)
    events: Sequence[tuple[float, str, Any]] = ()
    conditions: Mapping[str, str] = field(default_factory=dict)

    def write(self, folder: Path) -> None:
        """Write the drive into a folder of its name."""
        high = any(actor.z is not None for actor in self.actors)
        times = [i / self.hertz for i in range(round(self.until * self.hertz) + 1)]
        log.write(
            folder / self.scene.name,
            self.map.xml(),
            [actor.box() for actor in self.actors],
            [actor.states(self.until, self.hertz, high, 7 + i) for i, actor in enumerate(self.actors)],
            {"nation": self.scene.name[:2], "weather": "dry", "light": "day", **self.conditions},
            [(name, round(t * 1e9), log.at(states, t)) for name, states in self.lights.items() for t in times],
            self.events,
        )


def draw(  # noqa: PLR0917
    name: str,
    what: str,
    expect: str,
    drawn: Map,
    actors: Sequence[Actor],
    until: float,
    hertz: float = 10,
    lights: Lights | None = None,
    events: Sequence[tuple[float, str, Any]] = (),
    **conditions: str,
) -> Drive:
    """Return a drive with its scene."""
    scene = Scene(name, what, log.judgements(expect))
    return Drive(scene, drawn, actors, until, hertz, lights or {}, events, conditions)
