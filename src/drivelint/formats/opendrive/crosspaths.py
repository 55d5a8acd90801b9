"""Reads the cross paths of OpenDRIVE 1.8: a road with walking lanes leads across the lanes of a junction or of another road."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely

from drivelint.formats.opendrive.map_object import PlacedObject
from drivelint.formats.opendrive.xml import MalformedError, number_attribute, required_attribute

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from lxml import etree

    from drivelint.arrays import Floats
    from drivelint.formats.opendrive.lanelet import Lanelet
    from drivelint.formats.opendrive.network import Network
    from drivelint.road.quality import MapQuality

_WALKED_LANE_TYPES = frozenset({"walking", "sidewalk"})  # a path of biking lanes alone is no pedestrian crossing
_MIN_COMMON_AREA_M2 = 0.5  # a path that overlaps a crossing among the objects by more is drawn by it


def cross_paths(
    net: Network, lanes: Sequence[Lanelet], crossings: Sequence[PlacedObject], quality: MapQuality
) -> list[PlacedObject]:
    """Return the pedestrian cross paths as flat objects; not those that are among `crossings`, the map's crossing objects."""
    walked: dict[str, list[Lanelet]] = {}
    for lane in lanes:
        if lane.lane.kind in _WALKED_LANE_TYPES:
            walked.setdefault(lane.road.road_id, []).append(lane)
    drawn_area = shapely.union_all(
        [_polygon(c.outline) for c in crossings if c.outline is not None and len(c.outline) > 2]
    )
    paths = []
    for junction, element in net.cross_paths:
        name = f"{junction}/{element.get('id', '')}"
        try:
            path = _placed_path(net, name, element, walked)
        except MalformedError as error:
            message = f"cross path {name} is left out: {error}"
            quality.add("invalid_object", "warning", element.get("crossingRoad"), message)
            continue
        if (
            path is not None
            and shapely.area(shapely.intersection(_polygon(path.outline), drawn_area)) < _MIN_COMMON_AREA_M2
        ):
            paths.append(path)
    return paths


def _placed_path(
    net: Network, name: str, element: etree._Element, walked: dict[str, list[Lanelet]]
) -> PlacedObject | None:
    """Return the path as an object of the road at which it starts, whose height it has; None: nobody walks on it."""
    start_road, start = required_attribute(element, "roadAtStart"), element.find("startLaneLink")
    if start_road not in net.roads:
        raise MalformedError(f"its road {start_road} does not exist")
    parts = walked.get(required_attribute(element, "crossingRoad"), [])
    if not parts:
        return None
    outline = _outline(np.vstack([lane.line.right, lane.line.left[::-1]]) for lane in parts)
    station = 0.0 if start is None else number_attribute(start, "s", 0.0)
    x, y = outline.mean(axis=0)
    return PlacedObject(net.roads[start_road], element, name, station, float(x), float(y), outline)


def _outline(parts: Iterable[Floats]) -> Floats:
    """Return the outline of the lanes together."""
    together = shapely.union_all([_polygon(part) for part in parts])
    shape = together if isinstance(together, shapely.Polygon) else together.convex_hull
    return np.asarray(shapely.get_coordinates(shapely.get_exterior_ring(shape))[:-1], dtype=np.float64)


def _polygon(corners: Floats | None) -> shapely.Geometry:
    return shapely.Polygon(corners).buffer(0.0)
