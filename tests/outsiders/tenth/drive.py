"""A drive, what an examiner says of it, and how it is written."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path as Folder
from typing import Any

from tests.outsiders import log
from tests.outsiders.log import Scene
from tests.outsiders.tenth.actors import SIZE, Actor, Change, Lamps
from tests.outsiders.tenth.ways import Knots, Path


@dataclass
class Drive:
    """One drive and what is expected of its verdicts."""

    name: str
    map: str
    seconds: float
    hz: float = 10.0
    conditions: dict[str, str] = field(default_factory=dict)
    actors: list[Actor] = field(default_factory=list)
    lights: list[tuple[str, float, str]] = field(default_factory=list)
    events: list[tuple[float, str, Any]] = field(default_factory=list)
    wanted: list[tuple[str, str, str]] = field(default_factory=list)

    @property
    def scene(self) -> Scene:
        """What happens, which is why a verdict is expected, and the verdicts."""
        return Scene(
            self.name,
            " ".join(why for _, _, why in self.wanted),
            {rule: verdict for rule, verdict, _ in self.wanted},
        )

    def write(self, folder: Folder) -> None:
        """Write the drive into a folder of its name."""
        high = any(actor.z is not None for actor in self.actors)
        times = [k / self.hz for k in range(int(self.seconds * self.hz + 1e-6) + 1)]
        log.write(
            folder / self.name,
            self.map,
            [log.Box(actor.id, actor.cls, actor.size) for actor in self.actors],
            [actor.columns(times, high=high) for actor in self.actors],
            {"nation": self.name[:2], **self.conditions},
            [(signal, round(t * 1e9), state) for signal, t, state in self.lights],
            self.events,
        )

    def add(  # noqa: PLR0917
        self,
        id_: str,
        cls: str | None,
        way: Path,
        s0: float,
        speed: Knots | float,
        lat: Knots | float = 0.0,
        *,
        span: tuple[float, float] | None = None,
        lamps: Lamps | None = None,
        ego: bool = False,
        size: tuple[float | None, float | None, float | None] | None = None,
        change: Change | None = None,
        reverse: bool = False,
        brake: bool = False,
        z: float | None = None,
    ) -> Drive:
        """Add somebody."""
        v = [(0.0, float(speed))] if isinstance(speed, int | float) else speed
        d = [(0.0, float(lat))] if isinstance(lat, int | float) else lat
        self.actors.append(
            Actor(
                id_,
                cls,
                way,
                s0,
                v,
                d,
                span or (0.0, self.seconds),
                lamps or [(0.0, None)],
                ego,
                size or SIZE[cls],
                change,
                reverse,
                brake,
                z,
            )
        )
        return self

    def ego(
        self, way: Path, s0: float, speed: Knots | float, lat: Knots | float = 0.0, cls: str | None = "car", **more: Any
    ) -> Drive:
        """Add the ego."""
        more.setdefault("lamps", [(0.0, "off")])
        more.setdefault("brake", True)
        return self.add("ego", cls, way, s0, speed, lat, ego=True, **more)

    def light(self, id_: str, *states: tuple[float, str]) -> Drive:
        """The states of a light, from when on."""
        for i, (t, state) in enumerate(states):
            end = states[i + 1][0] if i + 1 < len(states) else self.seconds
            n = max(1, round((end - t) * 2))
            self.lights += [(id_, t + k * 0.5, state) for k in range(n) if t + k * 0.5 < end + 1e-9]
        return self

    def says(self, t: float, event: str, value: str | None = None) -> Drive:
        """The ego declares something."""
        self.events.append((t, event, value))
        return self

    def want(self, rule: str, what: str, why: str) -> Drive:
        """An expectation."""
        assert what in ("fail", "pass", "not fail", "not pass"), what
        self.wanted.append((rule, what, why))
        return self
