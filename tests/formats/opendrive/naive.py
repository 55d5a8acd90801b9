"""A second reading of OpenDRIVE, deliberately naive: scalar, standard library only, curves walked in small steps.

It shares no code with the package. Slow, so it is asked for single places.
"""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from bisect import bisect_left
from functools import cache
from itertools import accumulate, pairwise
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

STEP_M = 0.05
Point = tuple[float, float]


class NaiveMap:
    """Edges of lanes at road stations; `inside` says to which side of a station a record must have begun."""

    def __init__(self, source: Path | str) -> None:
        # the reference files carry no DTD, and tests read only files that the project or its reference data made
        root = ET.fromstring(source) if isinstance(source, str) else ET.parse(source).getroot()  # noqa: S314
        self.roads = {road.attrib["id"]: road for road in root.findall("road")}
        self.reference = cache(self._reference)

    def sections(self, road: str) -> list[tuple[float, float]]:
        return [(start, end) for _, start, end in self._pieces(road)]

    def _pieces(self, road: str) -> list[tuple[int, float, float]]:
        """Return place in the file, start and end of each lane section, cut where the type of the road changes; later pieces come last."""
        starts = [float(s.attrib["s"]) for s in self.roads[road].findall("lanes/laneSection")]
        types = [(float(t.attrib["s"]), t.attrib["type"]) for t in self.roads[road].findall("type")]
        changes = [s for (_, before), (s, kind) in pairwise(types) if kind != before]
        first, later = [], []
        for place, (start, end) in enumerate(pairwise([*starts, float(self.roads[road].attrib["length"])])):
            cuts = [start, *(s for s in changes if start + 1.0 < s < end - 1.0), end]
            whole, *rest = [(place, a, b) for a, b in pairwise(cuts)]
            first.append(whole)
            later += rest
        return [*first, *later]

    def _reference(self, road: str, s: float) -> tuple[float, float, float]:
        geometries = self.roads[road].findall("planView/geometry")
        geometry = [g for g in geometries if float(g.attrib["s"]) <= s + 1e-9][-1]
        x, y, heading = (float(geometry.attrib[a]) for a in ("x", "y", "hdg"))
        shape, ds = geometry[0], s - float(geometry.attrib["s"])
        length = float(geometry.attrib["length"])
        if shape.tag in {"paramPoly3", "poly3"}:
            u, v, turn = _polynomial(shape, ds, length)
            return (
                x + u * math.cos(heading) - v * math.sin(heading),
                y + u * math.sin(heading) + v * math.cos(heading),
                heading + turn,
            )
        first, last = 0.0, 0.0
        if shape.tag == "arc":
            first = last = float(shape.attrib["curvature"])
        elif shape.tag == "spiral":
            first, last = float(shape.attrib["curvStart"]), float(shape.attrib["curvEnd"])
        steps = max(1, math.ceil(ds / STEP_M))
        step = ds / steps
        for i in range(steps):
            middle = heading + 0.5 * step * (first + (last - first) * (i + 0.25) * step / length)
            x, y = x + step * math.cos(middle), y + step * math.sin(middle)
            heading += step * (first + (last - first) * (i + 0.5) * step / length)
        return x, y, heading

    def edges(self, road: str, section: int, lane: int, s: float) -> tuple[Point, Point]:
        """Return the inner and the outer edge of a lane."""
        element = self.roads[road].findall("lanes/laneSection")[self._pieces(road)[section][0]]
        start = float(element.attrib["s"])
        inner = _value(self.roads[road].findall("lanes/laneOffset"), "s", 0.0, s)
        side = 1 if lane > 0 else -1
        lanes = {int(e.attrib["id"]): e for e in element.iter("lane")}
        outer = inner
        for n in range(1, abs(lane) + 1):
            inner = outer
            outer = inner + side * max(0.0, _value(lanes[side * n].findall("width"), "sOffset", start, s))
        x, y, heading = self.reference(road, s)
        across = (-math.sin(heading), math.cos(heading))
        return (
            (x + inner * across[0], y + inner * across[1]),
            (x + outer * across[0], y + outer * across[1]),
        )


def _value(records: list[ET.Element], station: str, origin: float, s: float) -> float:
    held = [r for r in records if origin + float(r.attrib[station]) <= s]
    if not held:
        return 0.0
    ds = s - origin - float(held[-1].attrib[station])
    return sum(float(held[-1].get(c, "0")) * ds**i for i, c in enumerate("abcd"))


def _polynomial(shape: ET.Element, ds: float, length: float) -> tuple[float, float, float]:
    if shape.tag == "poly3":
        u: tuple[float, ...] = (0.0, 1.0, 0.0, 0.0)
        v = tuple(float(shape.attrib[c]) for c in "abcd")
    else:
        u, v = (tuple(float(shape.attrib[c + axis]) for c in "abcd") for axis in "UV")
    p = ds
    if shape.tag == "poly3":
        p = _walk(u, v, length, ds)
    elif shape.get("pRange") != "arcLength":
        sums = _sums(u, v, 1.0)
        p = _walk(u, v, 1.0, ds * sums[-1] / length)
    du, dv = (sum(i * c * p ** (i - 1) for i, c in enumerate(w) if i) for w in (u, v))
    return _at(u, p), _at(v, p), math.atan2(dv, du)


def _at(coefficients: tuple[float, ...], p: float) -> float:
    return sum(c * p**i for i, c in enumerate(coefficients))


@cache
def _sums(u: tuple[float, ...], v: tuple[float, ...], top: float) -> list[float]:
    """Return the way made along the curve at each of 5,000 steps up to p = top."""
    places = [(_at(u, top * i / 5000), _at(v, top * i / 5000)) for i in range(5001)]
    return list(accumulate((math.dist(a, b) for a, b in pairwise(places)), initial=0.0))


def _walk(u: tuple[float, ...], v: tuple[float, ...], top: float, target: float) -> float:
    """Return the parameter at which the curve has run for `target` metres."""
    sums = _sums(u, v, top)
    i = min(max(bisect_left(sums, target), 1), len(sums) - 1)
    return top * (i - 1 + (target - sums[i - 1]) / (sums[i] - sums[i - 1])) / (len(sums) - 1)
