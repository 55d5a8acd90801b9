"""A story: the ego drives along a way through chapters, each a stretch of road, what it meets there, and how it behaves.

A chapter is a function of a `Story` and of what may be changed in it. It lays its roads and says how the ego drives; whom
the ego meets it says afterwards (`story.then`), when it is known when the ego is where.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa

from drivelint.engine.batch import Drive
from drivelint.formats import load_map
from drivelint.road.map_reader import MapSource
from tests import scenes
from tests.clean.motion import CAR, HZ, Body, Plan, track
from tests.clean.route import Route
from tests.scenes import Actor

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import ArrayLike, NDArray

    from tests.demo.line import Line

    Floats = NDArray[np.float64]

LOOKS = ("mirror_check", "blind_spot_check")
GARAGE_Y = -3000.0  # where those stand who are not on the road yet, or no more


@dataclass
class Story:
    """What chapters write into. `nation` gives the side of the road and the words of `--env`."""

    nation: str
    events: list[tuple[float, str, str | None]] = field(default_factory=list)
    conditions: dict[str, str] = field(default_factory=dict)
    lights: list[tuple[str, float, float]] = field(default_factory=list)
    hazards: list[tuple[float, float]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.route = Route("rht" if self.nation == "de" else "lht")
        self.plan = Plan(10.0, self.route.offset(), 13.0)
        self.events += [(0.0, "chosen_speed", "13.0;start"), (0.0, "engaged", "on")]
        self.events += [(0.0, mode, "off") for mode in ("emergency_manoeuvre", "minimal_risk_manoeuvre", "horn")]
        self.conditions.update(nation=self.nation, light="day", weather="dry")
        self.others: list[Actor] = []
        self.signals: list[tuple[str, float, str]] = []
        self._then: list[Callable[[], None]] = []
        self.t: Floats = np.zeros(0)
        self.s: Floats = np.zeros(0)

    # ---- while the way is laid

    def then(self, scene: Callable[[], None]) -> None:
        """Say whom the ego meets, when its drive is known."""
        self._then.append(scene)

    def slow(self, start: float, length: float, speed: float, why: str = "road") -> None:
        """Drive no faster than this from a station on, and say that and why."""
        self.plan.slow(start, start + length, speed)
        self.then(lambda: self.events.append((self.when(start), "chosen_speed", f"{speed};{why}")))

    def indicates(self, side: str, start: float, end: float, *, looks: bool = True) -> None:
        """Have the indicator of the nearside or the offside on between two stations of the ego's centre, after a look."""
        self.lights.append((side, start, end))
        if looks:
            self.then(lambda: self.events.append((self.when(start) - 1.0, "mirror_check", None)))

    def leaves(self, by: float, at: float, within: float, *, looks: Sequence[str] = LOOKS) -> None:
        """Move to the nearside by so much, far enough to leave the lane, after two looks."""
        self.plan.shift(by, at, within)
        self.then(lambda: self.events.extend((self.when(at) - 1.5 + k, look, None) for k, look in enumerate(looks)))

    def stands(self, halt: float) -> float:
        """Return when the ego comes to stand at the station of a halt."""
        return self.when(halt - 0.1)

    # ---- when the drive is known

    def when(self, s: float) -> float:
        """Return when the ego's centre first reaches a station."""
        return float(self.t[min(int(np.searchsorted(self.s, s)), len(self.t) - 1)])

    def where(self, t: ArrayLike) -> Floats:
        """Return the ego's station at times; before and after the drive it goes on as fast as at its ends."""
        t = np.asarray(t, np.float64)
        found = np.interp(t, self.t, self.s)
        first, last = (self.s[1] - self.s[0]) * HZ, (self.s[-1] - self.s[-2]) * HZ
        found = found + np.minimum(t - self.t[0], 0.0) * first + np.maximum(t - self.t[-1], 0.0) * last
        return np.asarray(found, np.float64)

    def meets(
        self,
        s: ArrayLike,
        n: ArrayLike,
        body: Body = CAR,
        *,
        line: Line | None = None,
        between: tuple[float, float] | None = None,
        turned: float = 0.0,
    ) -> None:
        """Add somebody at stations and offsets of the ego's way, or of another line, at the times `t`, or between two times.

        Before and after these he stands far away. `turned`: see `track`.
        """
        where, beside, _ = np.broadcast_arrays(np.asarray(s, np.float64), np.asarray(n, np.float64), self.t)
        name = f"{len(self.others) + 2:03d}"
        actor = track(name, body, line or self.route.line, self.route.h, self.t, where, beside, turned=turned)
        if between is not None:
            actor = _garaged(actor, (self.t >= between[0]) & (self.t <= between[1]), len(self.others))
        self.others.append(actor)

    def drive(self, name: str) -> Drive:
        """Return the whole story as a drive, ready for the bench."""
        self.t, self.s = self.plan.stations(self.route.line, self.route.h)
        for scene in self._then:
            scene()
        ego = track("ego", CAR, self.route.line, self.route.h, self.t, self.s, self.plan.offsets(self.s))
        ego = replace(ego, indicator=self._lamps())
        text = self.route.text()
        made = scenes.drive([ego, *self.others], load_map(MapSource(f"{name}.xodr", text.encode())), drive_id=name)
        return _with(made, name, self)

    def _lamps(self) -> tuple[str, ...]:
        near, off = ("left", "right") if self.route.h > 0 else ("right", "left")
        lamp = np.full(self.s.shape, "off", dtype=object)
        for side, start, end in self.lights:
            lamp[(self.s >= start) & (self.s < end)] = near if side == "nearside" else off
        for start, end in self.hazards:
            lamp[(self.t >= start) & (self.t < end)] = "hazard"
        return tuple(lamp)


def _garaged(actor: Actor, on: NDArray[np.bool_], place: int) -> Actor:
    x, y = 20.0 * place, GARAGE_Y

    def there(values: Floats, otherwise: float = 0.0) -> Floats:
        return np.where(on, values, otherwise)

    return replace(
        actor, x=there(actor.x, x), y=there(actor.y, y), yaw=there(actor.yaw), vx=there(actor.vx), vy=there(actor.vy)
    )


def _with(drive: Drive, name: str, story: Story) -> Drive:
    """Return the drive with what else the log says: lights' states, declared events, conditions."""
    rows: dict[str, list[dict[str, Any]]] = {
        "signal_state": [
            {"drive_id": name, "signal_id": signal, "t_ns": round(t * 1e9), "state": state}
            for signal, t, state in sorted(story.signals)
        ],
        "declared_event": [
            {"drive_id": name, "actor_id": "ego", "t_ns": round(t * 1e9), "event": event, "value": value}
            for t, event, value in sorted(story.events, key=lambda e: (e[0], e[1]))
        ],
        "drive_condition": [
            {"drive_id": name, "condition": condition, "value": value, "source": "env"}
            for condition, value in sorted(story.conditions.items())
        ],
    }
    tables = drive.trace.tables | {
        table: pa.Table.from_pylist(content, schema=drive.trace.tables[table].schema) for table, content in rows.items()
    }
    return replace(drive, trace=replace(drive.trace, tables=tables))
