"""Reads the types of a road, and where they change: each lanelet has one type of road."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

from drivelint.formats.opendrive.records import record_spans
from drivelint.formats.opendrive.xml import number_attribute

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from lxml import etree

    from drivelint.road.quality import MapQuality

_LEAST_TYPE_M = 1.0  # a shorter stretch of another road type is a matter of rounding
RoadType = tuple[float, str | None]  # station from which a type applies, and the type; None: not stated
TypeStretch = tuple[str | None, float, float]  # type of the road (None: not stated), from and to station


def road_types(road: etree._Element, quality: MapQuality) -> list[RoadType]:
    """Return the types that a road states, by station."""
    types = []
    for element in road.findall("type"):
        word = element.get("type", "unknown")
        kind = None if word == "unknown" else quality.known_word("road_type", word)
        types.append((number_attribute(element, "s", 0.0), kind))
    return sorted(types, key=lambda t: t[0])


def type_stretches(types: Sequence[RoadType], start: float, end: float) -> list[TypeStretch]:
    """Return the stretches of one type between two stations, without those that are too short to count."""
    spans = record_spans((s for s, _ in types), start, end)
    stretches = _join_equal_types((types[i][1] if i >= 0 else None, a, b) for i, a, b in spans)
    if not stretches:
        return [(None, start, end)]
    # A lane section may itself be shorter than the least stretch.
    least = min(_LEAST_TYPE_M, 0.5 * max(b - a for _, a, b in stretches))
    long_stretches = _join_equal_types(stretch for stretch in stretches if stretch[2] - stretch[1] > least)
    edges = [start, *(a for _, a, _ in long_stretches[1:]), end]
    return [(kind, a, b) for (kind, _, _), (a, b) in zip(long_stretches, pairwise(edges), strict=True)]


def _join_equal_types(stretches: Iterable[TypeStretch]) -> list[TypeStretch]:
    """Return the stretches; those that follow each other with the same type are one."""
    longer: list[TypeStretch] = []
    for kind, a, b in stretches:
        if longer and longer[-1][0] == kind:
            longer[-1] = (kind, longer[-1][1], b)
        else:
            longer.append((kind, a, b))
    return longer
