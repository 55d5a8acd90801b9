"""One lane of one lane section, evaluated."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from drivelint.formats.opendrive.network import DRIVABLE

if TYPE_CHECKING:
    from collections.abc import Iterable

    from drivelint.arrays import Floats
    from drivelint.formats.opendrive.network import Lane, LaneSection, Road
    from drivelint.road.boundary_lanes import LaneGeometry

LaneKey = tuple[str, int, int]  # road, section, lane number


def lanelet_id(key: LaneKey) -> str:
    """Return the id of a lane in the tables."""
    return f"{key[0]}.{key[1]}.{key[2]}"


@dataclass(eq=False)
class Lanelet:
    """A lane of a section in the direction of travel: its points `line`, and as arrays (n,) what else they are."""

    key: LaneKey
    lane: Lane
    road: Road
    strip: LaneSection
    along: int
    bidirectional: bool
    line: LaneGeometry
    road_s: Floats
    z: Floats
    t: Floats  # of the centre line, in road coordinates
    left: Lanelet | None = None
    right: Lanelet | None = None

    @property
    def lanelet_id(self) -> str:
        """The id, road.section.lane."""
        return lanelet_id(self.key)

    @property
    def drivable(self) -> bool:
        """Motor vehicles may drive here."""
        return self.lane.kind in DRIVABLE

    @property
    def length_m(self) -> float:
        """Length along the centre line."""
        return float(self.line.s[-1])

    def station_at(self, road_s: float) -> float:
        """Return the lanelet station (m) of a road station (m), held within the lanelet."""
        step = self.along
        return float(np.interp(road_s, self.road_s[::step], self.line.s[::step]))

    def lateral_range(self, road_s: float) -> tuple[float, float]:
        """Return the road coordinates t between which the lanelet lies at a road station (m)."""
        s = self.station_at(road_s)
        t, half = (float(np.interp(s, self.line.s, values)) for values in (self.t, self.line.half_width))
        return t - half, t + half

    def lanelet_spans(self, spans: Iterable[tuple[int, float, float]]) -> list[tuple[int, float, float]]:
        """Return (index, from, to) spans of road stations as spans of the lanelet, in the direction of travel."""
        found = [(i, self.station_at(a), self.station_at(b)) for i, a, b in spans]
        ordered = [(i, min(a, b), max(a, b)) for i, a, b in found if abs(b - a) > 1e-6]
        return sorted(ordered, key=lambda r: r[1])

    def mean_width(self) -> float:
        """Return the mean distance between the bounds (m)."""
        ds, half = np.diff(self.line.s), self.line.half_width
        return float(((half[:-1] + half[1:]) * ds).sum() / ds.sum()) if ds.sum() > 0 else 0.0
