"""A drive, what an examiner says of it, and how it is written."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path as Folder
from typing import Any

import numpy as np

from tests.outsiders import log
from tests.outsiders.eighteenth.motion import Track
from tests.outsiders.eighteenth.roads import Array, Frame, Map
from tests.outsiders.log import Scene

Expect = tuple[str, str, str]  # rule, verdict, why
SILENT = ("pedestrian", "animal", "object", "bicycle")  # who has no lamps
HIGH = {"truck": 3.5, "bus": 3.2, "trailer": 3.5, "van": 2.2}


@dataclass
class Drive:
    """One drive and what is expected of its verdicts."""

    title: str
    map: Map
    tracks: Sequence[Track]
    seconds: float
    expect: Sequence[Expect]
    nation: str = "de"
    weather: str = "dry"
    light: str = "day"
    more: dict[str, str] = field(default_factory=dict)
    events: Sequence[tuple[float, str, Any]] = ()
    signals: Sequence[tuple[str, float, str]] = ()
    frame: Frame = field(default_factory=Frame)
    hz: float = 10.0

    @property
    def name(self) -> str:
        """The name, which ends as all of this outsider do."""
        return f"{self.title}_t"

    @property
    def scene(self) -> Scene:
        """What happens, which is why a verdict is expected, and the verdicts."""
        return Scene(
            self.name,
            "; ".join(why for _, _, why in self.expect),
            {rule: verdict for rule, verdict, _ in self.expect},
        )

    def write(self, folder: Folder) -> None:
        """Write the drive into a folder of its name."""
        times = np.arange(round(self.seconds * self.hz) + 1) / self.hz
        log.write(
            folder / self.name,
            self.map.xml(self.frame),
            [log.Box(k.name, k.kind, (*k.size, HIGH.get(k.kind or "", 1.6))) for k in self.tracks],
            [columns(track, times, self.frame) for track in self.tracks],
            {"nation": self.nation, "weather": self.weather, "light": self.light, **self.more},
            [(signal, round(t * 1e9), state) for signal, t, state in self.signals],
            self.events,
        )


def columns(track: Track, times: Array, frame: Frame) -> dict[str, list[Any]]:
    """Return the columns of `actor_state` of one road user, in the map's frame."""
    x, y, yaw, vx, vy, accel = track.at(times)
    x, y = frame.point(x, y)
    vx, vy = Frame(0, 0, frame.turn).point(vx, vy)
    yaw = (yaw + frame.turn + np.pi) % (2 * np.pi) - np.pi
    seen = [i for i, t in enumerate(times) if track.seen(float(t))]
    silent = track.kind in SILENT
    return {
        "actor_id": [track.name] * len(seen),
        "t_ns": [round(times[i] * 1e9) for i in seen],
        "x_m": x[seen].tolist(),
        "y_m": y[seen].tolist(),
        "z_m": [0.0] * len(seen),
        "yaw_rad": yaw[seen].tolist(),
        "vx_mps": vx[seen].tolist(),
        "vy_mps": vy[seen].tolist(),
        "indicator": [None if silent else track.lamp(float(times[i])) for i in seen],
        "brake_light": [None if silent else "on" if accel[i] < -0.3 else "off" for i in seen],
    }
