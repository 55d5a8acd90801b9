"""SUMO's traffic as tracks of boxes: what was really there."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

_RIGHT, _LEFT, _BRAKE = 1, 2, 8  # bits of SUMO's `signals`
_KINDS = {"lorry": "truck", "tractor": "truck"}
_SIZE = (5.0, 1.8)  # SUMO's own of a passenger car


@dataclass(frozen=True)
class Track:
    """One actor's samples, arrays of one length; x, y is the middle of the box, velocities are of the world.

    `indicator`: 0 off, 1 left, 2 right; `brake`: its brake lights are on.
    """

    actor_id: str
    kind: str | None
    length: float
    width: float
    t_ns: NDArray[np.int64]
    x: Floats
    y: Floats
    yaw: Floats
    vx: Floats
    vy: Floats
    indicator: NDArray[np.int64]
    brake: NDArray[np.bool_]

    def take(self, rows: NDArray[np.bool_] | slice, **changes: object) -> Track:
        """Return it with these of its samples only."""
        names = ("t_ns", "x", "y", "yaw", "vx", "vy", "indicator", "brake")
        return replace(self, **{name: getattr(self, name)[rows] for name in names}, **changes)  # type: ignore[arg-type]


def tracks(log: Path, routes: Path) -> list[Track]:
    """Read SUMO's FCD and the sizes of its vehicles, by id. SUMO gives the middle of the front bumper and degrees from north."""
    types = {e.attrib["id"]: e.attrib for e in ET.parse(routes).getroot().iter("vType")}  # noqa: S314
    rows: dict[str, list[tuple[float, ...]]] = {}
    kinds: dict[str, str] = {}
    t = 0.0
    for event, element in ET.iterparse(log, events=("start", "end")):  # noqa: S314
        if element.tag == "timestep":
            if event == "start":
                t = float(element.attrib["time"])
            else:
                element.clear()
        elif event == "end" and element.tag == "vehicle":
            a = element.attrib
            kinds[a["id"]] = a["type"]
            numbers = (
                t,
                float(a["x"]),
                float(a["y"]),
                float(a["angle"]),
                float(a["speed"]),
                float(a.get("signals", 0)),
            )
            rows.setdefault(a["id"], []).append(numbers)
    return [_track(name, kinds[name], types.get(kinds[name], {}), np.array(rows[name])) for name in sorted(rows)]


def _track(name: str, kind: str, vehicle_type: dict[str, str], rows: Floats) -> Track:
    t, front_x, front_y, angle, speed, signals = rows.T
    length, width = (
        float(vehicle_type.get(key, default)) for key, default in zip(("length", "width"), _SIZE, strict=True)
    )
    yaw = np.remainder(np.pi / 2 - np.radians(angle) + np.pi, 2 * np.pi) - np.pi
    bits = signals.astype(np.int64)
    indicator = np.where(bits & _LEFT, 1, np.where(bits & _RIGHT, 2, 0))
    x, y = front_x - length / 2 * np.cos(yaw), front_y - length / 2 * np.sin(yaw)
    return Track(
        name, _KINDS.get(kind, "car"), length, width, np.round(t * 1e9).astype(np.int64), x, y, yaw,
        speed * np.cos(yaw), speed * np.sin(yaw), indicator, (bits & _BRAKE) > 0,
    )  # fmt: skip
