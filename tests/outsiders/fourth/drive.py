"""A scene as data, and how its drive is written."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from tests.outsiders import log
from tests.outsiders.fourth.movement import NS
from tests.outsiders.log import Scene

if TYPE_CHECKING:
    from pathlib import Path

    from tests.outsiders.fourth.faults import Fault
    from tests.outsiders.fourth.movement import Actor
    from tests.outsiders.fourth.road import World


@dataclass
class Drive:
    """Who moves where and how long, and what the log says besides; its name begins with the nation."""

    name: str
    what: str
    expect: str
    world: World
    actors: Sequence[Actor]
    seconds: float = 20.0
    conditions: Mapping[str, str] = field(default_factory=dict)
    events: Sequence[tuple[float, str, str]] = ()
    lights: Mapping[str, Sequence[tuple[float, str]]] = field(default_factory=dict)
    faults: Sequence[Fault] = ()
    rate: float = 10.0

    @property
    def scene(self) -> Scene:
        """What happens, and what is expected."""
        return Scene(self.name, self.what, log.judgements(self.expect))

    def write(self, folder: Path) -> None:
        """Write the drive into a folder of its name."""
        nation = self.name.partition("_")[0]
        flip = -1 if nation == "gb" else 1
        tracks = {actor.name: actor.states(self.seconds, self.rate, flip) for actor in self.actors}
        for fault in self.faults:
            fault(tracks)
        steps = [step / self.rate for step in range(int(self.seconds * self.rate) + 1)]
        log.write(
            folder / self.name,
            self.world.xml(flip),
            [actor.box() for actor in self.actors],
            tracks.values(),
            {"nation": nation, **self.conditions},
            [(ident, round(t * NS), log.at(states, t)) for ident, states in self.lights.items() for t in steps],
            self.events,
        )
