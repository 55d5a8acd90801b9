"""A scene as data, and how its drive is written."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

from tests.outsiders import log
from tests.outsiders.log import Scene

if TYPE_CHECKING:
    from pathlib import Path

    from tests.outsiders.fifth.cast import Actor
    from tests.outsiders.fifth.road import World

Lights = Sequence[tuple[str, float, str]]
Events = Sequence[tuple[float, str, str | None]]
_DRY = {"weather": "dry", "light": "day"}


@dataclass
class Drive:
    """Who moves where, and what the log says besides; the scene's name begins with the nation."""

    scene: Scene
    world: World
    actors: Sequence[Actor]
    conditions: Mapping[str, str]
    lights: Lights
    events: Events

    def write(self, folder: Path) -> None:
        """Write the drive into a folder of its name."""
        log.write(
            folder / self.scene.name,
            self.world.xml(),
            [actor.box() for actor in self.actors],
            [actor.states() for actor in self.actors],
            self.conditions,
            [(name, round(t * 1e9), state) for name, t, state in self.lights],
            cast("Sequence[tuple[float, str, str]]", self.events),
        )


def draw(
    name: str,
    what: str,
    expect: str,
    world: World,
    actors: Sequence[Actor],
    *,
    lights: Lights = (),
    events: Events = (),
    **conditions: str,
) -> Drive:
    """Return a drive with its scene."""
    scene = Scene(name, what, log.judgements(expect))
    known = {"nation": name.partition("_")[0], **_DRY, **conditions}
    return Drive(scene, world, actors, known, lights, events)


def light(ident: str, *steps: tuple[float, str]) -> list[tuple[str, float, str]]:
    """Return what a light shows, told at its changes only."""
    return [(ident, t, state) for t, state in steps]
