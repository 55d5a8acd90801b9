"""A scene, who moves how in it, and how its drive is written."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from tests.outsiders import log
from tests.outsiders.log import Scene, Size
from tests.outsiders.sixth.maps import side
from tests.outsiders.sixth.movement import SIZES, Actor, Keys, Lamps, follow, lamps, walk

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from tests.outsiders.sixth.lines import Geom
    from tests.outsiders.sixth.road import Map


@dataclass
class Drive:
    """A drive; the scene's name begins with the nation."""

    scene: Scene
    map: Map
    until: float = 20.0
    hz: float = 10.0
    noise: float = 0.0
    high: bool = False  # whether the log knows heights
    conditions: dict[str, str] = field(default_factory=dict)
    actors: list[Actor] = field(default_factory=list)
    lights: list[tuple[str, float, str]] = field(default_factory=list)
    events: list[tuple[float, str, Any]] = field(default_factory=list)

    def add(  # noqa: PLR0917
        self,
        name: str,
        way: list[Geom] | None = None,
        s: float = 0.0,
        v: Keys = 0.0,
        u: Keys = 0.0,
        cls: str | None = "car",
        size: Size | None = None,
        t1: float | None = None,
        ind: Lamps = "off",
        z: float = 0.0,
        against: bool = False,
        turned: float = 0.0,
        edit: Callable[[Actor], None] | None = None,
        soft: float = 0.5,
    ) -> Drive:
        """Somebody who moves along a way (or the first road) from s on, u metres beside it on the side driven on.

        `against`: back along it; `t1`: the log knows them until then; `turned`: the log has their heading turned.
        """
        hand = side(self.scene.name)
        line = way if way is not None else self.map.roads[0].geoms
        columns = follow(line, s, v, u, hand, against, self.until, soft)
        steps = self._steps(0.0, t1)
        at = np.clip(np.round(steps / 0.01).astype(int), 0, len(columns[0]) - 1)
        x, y, yaw, vx, vy = (column[at] for column in columns)
        dims = size if size is not None else SIZES[cls or "car"]
        who = Actor(name, cls, dims, steps, x, y, yaw + turned, vx, vy, np.full(len(steps), z), lamps(ind, steps))
        if edit:
            edit(who)
        self.actors.append(who)
        return self

    def walk(
        self, name: str, path: list[tuple[float, float, float]], size: Size | None = None, t0: float = 0.0
    ) -> Drive:
        """Somebody on foot who moves straight between (t, x, y); the log knows them from t0 on."""
        steps = self._steps(t0, None)
        x, y, yaw, vx, vy = walk(path, steps)
        dims = size if size is not None else SIZES["pedestrian"]
        none: list[str | None] = [None] * len(steps)
        self.actors.append(Actor(name, "pedestrian", dims, steps, x, y, yaw, vx, vy, np.zeros(len(steps)), none))
        return self

    def light(self, ident: str, *states: tuple[float, str]) -> Drive:
        """A light that changes at these times, logged ten times a second."""
        for t in np.arange(0, self.until + 1e-9, 0.1):
            self.lights.append((ident, float(t), log.at(states, float(t))))
        return self

    def says(self, t: float, event: str, value: str | None = None) -> Drive:
        """What the ego declares."""
        self.events.append((t, event, value))
        return self

    def write(self, folder: Path) -> None:
        """Write the drive into a folder of its name."""
        name = self.scene.name
        random = np.random.default_rng(sum(map(ord, name)))
        conditions = {"nation": name.partition("_")[0], "weather": "dry", "light": "day", **self.conditions}
        log.write(
            folder / name,
            self.map.xml(),
            [actor.box() for actor in self.actors],
            [actor.states(self.noise, self.high, random) for actor in self.actors],
            conditions,
            [(ident, round(t * 1e9), state) for ident, t, state in self.lights],
            self.events,
        )

    def _steps(self, t0: float, t1: float | None) -> Any:
        end = self.until if t1 is None else t1
        steps = t0 + np.arange(round((end - t0) * self.hz) + 1) / self.hz
        return steps[steps <= self.until + 1e-9]


class Chapter:
    """The drives of a chapter in their order."""

    def __init__(self) -> None:
        self.drives: list[Drive] = []

    def draw(  # noqa: PLR0917
        self,
        name: str,
        what: str,
        expect: str,
        drawn: Map,
        until: float = 20.0,
        hz: float = 10.0,
        noise: float = 0.0,
        high: bool = False,
        **conditions: str,
    ) -> Drive:
        """Begin a drive with its scene."""
        scene = Scene(name, what, log.judgements(expect))
        self.drives.append(Drive(scene, drawn, until, hz, noise, high, conditions))
        return self.drives[-1]
