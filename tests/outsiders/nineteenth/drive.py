"""Who moves how, a drive, what an examiner says of it, and how it is written."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path as Folder
from typing import Any

import numpy as np

from tests.outsiders import log
from tests.outsiders.log import Scene
from tests.outsiders.nineteenth.path import Frame, Numbers, Path
from tests.outsiders.nineteenth.road import Map

Size = tuple[float, float, float]
Knots = float | Sequence[tuple[float, float]]  # one value, or (time, value)
Lamps = str | Sequence[tuple[float, str]] | None  # one state, or (from, state); None: not known
Wanted = tuple[str, str, str]  # rule, verdict, why
SIZES: dict[str | None, Size] = {
    None: (4.5, 1.8, 1.5),
    "car": (4.5, 1.8, 1.5),
    "van": (5.5, 2.0, 2.3),
    "truck": (12.0, 2.5, 3.6),
    "bus": (12.0, 2.55, 3.2),
    "motorcycle": (2.2, 0.8, 1.4),
    "bicycle": (1.8, 0.6, 1.7),
    "trailer": (6.0, 2.2, 2.4),
    "pedestrian": (0.5, 0.5, 1.75),
    "animal": (2.4, 0.7, 1.6),
}
_SWAPPED = {"left": "right", "right": "left"}
_STEP = 0.01  # s: of the sum of the speed
_NEAR = 0.02  # s: of the difference that is the velocity
_UNPLACED = Frame(mirrored=False)


@dataclass(frozen=True)
class Actor:
    """Somebody: along a path from a place on it, with speeds between which it changes evenly, and places across it (left positive)."""

    id: str
    cls: str | None
    path: Path
    start: float
    speed: Knots
    across: Knots = 0.0
    ind: Lamps = None
    size: Size | None = None
    seen: Callable[[float], bool] = lambda _: True
    noise: float = 0.0

    def box(self) -> log.Box:
        return log.Box(self.id, self.cls, self.size or SIZES[self.cls])

    def columns(self, times: Numbers, frame: Frame, random: np.random.Generator) -> dict[str, list[Any]]:
        """Return the columns of `actor_state`."""
        t = times[[self.seen(float(q)) for q in times]]
        x, y, heading, vx, vy = self._poses(t)
        x, y, heading = frame.place(x, y, heading)
        vx, vy = frame.vector(vx, vy)
        if self.noise:
            x, y, vx, vy = (q + random.normal(0, self.noise, len(t)) for q in (x, y, vx, vy))
        lamps = [_at(self.ind, float(q)) for q in t]
        return {
            "actor_id": [self.id] * len(t),
            "t_ns": [round(float(q) * 1e9) for q in t],
            "x_m": x.tolist(),
            "y_m": y.tolist(),
            "yaw_rad": ((heading + np.pi) % (2 * np.pi) - np.pi).tolist(),
            "vx_mps": vx.tolist(),
            "vy_mps": vy.tolist(),
            "indicator": [_SWAPPED.get(q, q) if q and frame.mirrored else q for q in lamps],
            "brake_light": [None] * len(t),
        }

    def _poses(self, t: Numbers) -> tuple[Numbers, Numbers, Numbers, Numbers, Numbers]:
        """Return places, headings and velocities; the box heads where it goes, backwards the other way."""
        before, after = np.maximum(t - _NEAR, 0), t + _NEAR
        x, y, heading = self._along(t)
        x0, y0, _ = self._along(before)
        x1, y1, _ = self._along(after)
        span = after - before
        v = self._speed(t)
        aside = (self._across(after) - self._across(before)) / span
        slip = np.where(np.abs(v) > 0.3, np.arctan2(aside * np.sign(v), np.abs(v) + 1e-9), 0.0)
        return x, y, heading + slip, (x1 - x0) / span, (y1 - y0) / span

    def _along(self, t: Numbers) -> tuple[Numbers, Numbers, Numbers]:
        grid = np.arange(0, max(float(t.max()), _NEAR) + 0.011, _STEP)
        v = self._speed(grid)
        way = self.start + np.concatenate([[0], np.cumsum((v[1:] + v[:-1]) / 2 * _STEP)])
        return self.path.at(np.interp(t, grid, way), self._across(t))

    def _speed(self, t: Numbers) -> Numbers:
        knots = self.speed if isinstance(self.speed, Sequence) else [(0.0, self.speed)]
        return np.interp(t, [when for when, _ in knots], [v for _, v in knots])

    def _across(self, t: Numbers) -> Numbers:
        """Return the place across: from one to the next as a driver steers."""
        if not isinstance(self.across, Sequence):
            return np.full_like(t, float(self.across))
        place = np.full_like(t, self.across[0][1])
        for (a, y0), (b, y1) in zip(self.across, self.across[1:], strict=False):
            u = np.clip((t - a) / max(b - a, 1e-9), 0, 1)
            place = np.where(t >= a, y0 + (y1 - y0) * (u - np.sin(2 * np.pi * u) / (2 * np.pi)), place)
        return place


def _at(lamps: Lamps, t: float) -> str | None:
    if lamps is None or isinstance(lamps, str):
        return lamps
    return next((state for begin, state in reversed(lamps) if t >= begin - 1e-9), None)


@dataclass(frozen=True)
class Drive:
    """One drive and what is expected of its verdicts."""

    name: str
    nation: str
    map: Map
    actors: Sequence[Actor]
    seconds: float
    wanted: Sequence[Wanted]
    hz: float = 10
    cond: Mapping[str, str] = field(default_factory=dict)
    lights: Sequence[tuple[str, float, str]] = ()
    events: Sequence[tuple[float, str, str | None]] = ()
    frame: Frame = _UNPLACED

    @property
    def scene(self) -> Scene:
        """What happens, which is why a verdict is expected, and the verdicts."""
        return Scene(
            self.name,
            "; ".join(why for _, _, why in self.wanted),
            {rule: verdict for rule, verdict, _ in self.wanted},
        )

    def placed(self, i: int) -> Drive:
        """Return the drive where the i-th of all lies: some at the origin, some shifted and turned."""
        where = (
            (0.0, 0.0, 0.0),
            (0.7 * i % 6.28, 350.0 * (i % 5) - 700, 90.0 * (i % 7)),
            (-1.1 * i % 6.28, 4000.0 + i, -2500.0),
        )
        return replace(self, frame=Frame(self.nation.startswith("gb"), *where[i % 3]))

    def write(self, folder: Folder) -> None:
        """Write the drive into a folder of its name."""
        random = np.random.default_rng(sum(map(ord, self.name)))
        times = np.arange(round(self.seconds * self.hz) + 1) / self.hz
        swapped = _SWAPPED if self.frame.mirrored else {}
        log.write(
            folder / self.name,
            self.map.xml(self.frame),
            [actor.box() for actor in self.actors],
            [actor.columns(times, self.frame, random) for actor in self.actors],
            {"nation": self.nation, "weather": "dry", "light": "day", **self.cond},
            [(signal, round(t * 1e9), state) for signal, t, state in self.lights],
            [(t, event, swapped.get(value or "", value)) for t, event, value in self.events],  # type: ignore[misc]
        )


def draw(  # noqa: PLR0917
    name: str,
    nation: str,
    drawn: Map,
    actors: Sequence[Actor],
    seconds: float,
    wanted: Sequence[Wanted],
    **more: Any,
) -> Drive:
    """Return a drive; its name ends as all of this outsider do."""
    return Drive(f"{name}_u", nation, drawn, actors, seconds, wanted, **more)


def gaining(v0: float, gains: Sequence[tuple[float, float]], seconds: float = 80.0) -> list[tuple[float, float]]:
    """Return the speeds that accelerations (time, m/s2), straight between them, make of a first one."""
    t = np.arange(0, seconds + 0.02, 0.02)
    a = np.interp(t, [when for when, _ in gains], [gain for _, gain in gains])
    v = v0 + np.concatenate([[0], np.cumsum((a[1:] + a[:-1]) / 2 * 0.02)])
    return list(zip(t.tolist(), np.maximum(v, 0).tolist(), strict=True))


def steady(gain: float, begin: float, end: float) -> list[tuple[float, float]]:
    """Return an acceleration that comes and goes within a second, half of it before and half after the given times."""
    return [(0, 0), (begin - 0.5, 0), (begin + 0.5, gain), (end - 0.5, gain), (end + 0.5, 0)]
