"""A drive, what an examiner says of it, and how it is written."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from tests.outsiders import log
from tests.outsiders.log import Scene
from tests.outsiders.twentieth.motion import Actor, Floats
from tests.outsiders.twentieth.roads import Map

Expect = tuple[str, str, str]  # rule, verdict, why


@dataclass
class Drive:
    """One drive: the map, who is there (the ego first), and what is expected of its verdicts."""

    name: str
    what: str
    map: Map
    actors: list[Actor]
    expect: list[Expect]
    last: float = 20.0
    hz: float = 10.0
    nation: str = "gb"
    weather: str = "dry"
    light: str = "day"
    env: dict[str, str] = field(default_factory=dict)
    lights: Sequence[tuple[str, float, str]] = ()
    says: Sequence[tuple[float, str, Any]] = ()

    @property
    def scene(self) -> Scene:
        """What happens, why verdicts are expected, and the verdicts."""
        reasons = "; ".join(why for _, _, why in self.expect)
        return Scene(self.name, f"{self.what}: {reasons}", {rule: verdict for rule, verdict, _ in self.expect})

    def write(self, folder: Path) -> None:
        """Write the drive into a folder of its name."""
        times: Floats = np.arange(0, int(self.last * self.hz) + 1) / self.hz
        log.write(
            folder / self.name,
            self.map.xml(),
            [log.Box(actor.name, actor.kind, actor.box()) for actor in self.actors],
            [actor.columns(times, 1000 * n + len(self.name)) for n, actor in enumerate(self.actors)],
            {"nation": self.nation, "weather": self.weather, "light": self.light, **self.env},
            [(signal, round(t * 1e9), state) for signal, t, state in self.lights],
            self.says,
        )
