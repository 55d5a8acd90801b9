"""The furniture of a map: signals, stop lines, objects and crossings, assigned to the lanelets."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely

from drivelint.formats.opendrive.crosspaths import cross_paths
from drivelint.formats.opendrive.map_object import PlacedObject
from drivelint.formats.opendrive.signals import signal_and_stop_line_rows
from drivelint.formats.opendrive.xml import MalformedError, number_attribute, required_attribute
from drivelint.road.tables import Rows, crossing_row, stop_line_row

if TYPE_CHECKING:
    from collections.abc import Iterator

    from lxml import etree

    from drivelint.arrays import Floats
    from drivelint.formats.opendrive.lanelet import Lanelet
    from drivelint.formats.opendrive.network import Network, Road
    from drivelint.road.quality import MapQuality

MIN_STOP_LINE_SHARE = 0.5  # a stop line that covers less of a lane's width belongs to another lane
MIN_STOP_LINE_ANGLE_RAD = 0.87  # 50 degrees: a line at a smaller angle to the lane is no stop line
MIN_CROSSING_AREA_M2 = 0.5  # a crossing that only touches a lane does not lie across it
OTHER_LEVEL_HEIGHT_DIFFERENCE_M = (
    3.0  # a lane of another road at least this far above or below an object is over or under it
)
MAX_REPEATS = 10_000  # of one object
_BAND_SPACING_M = 5.0
_BAND_WIDTH_M = 0.05  # of a fence or railing that has no width of its own


def furniture_rows(
    net: Network, lanes: list[Lanelet], offset: tuple[float, float], quality: MapQuality
) -> dict[str, Rows]:
    """Return rows of `traffic_signal`, `stop_line`, `road_object` and `crossing`."""
    signals, painted = signal_and_stop_line_rows(net, lanes, offset, quality)
    objects = _placed_objects(net, offset, quality)
    paths = cross_paths(
        net, lanes, [placed_object for placed_object in objects if placed_object.kind == "crossing"], quality
    )
    drivable = [lane for lane in lanes if lane.drivable]
    stop_lines, crossings = _stop_lines_and_crossings([*objects, *paths], drivable, quality)
    return {
        "traffic_signal": signals,
        "stop_line": sorted([*painted, *stop_lines], key=lambda r: (r["stop_line_id"], r["lanelet_id"], r["lane_s_m"])),
        "road_object": [placed_object.road_object_row() for placed_object in objects],
        "crossing": crossings,
    }


def _stop_lines_and_crossings(
    objects: list[PlacedObject], lanes: list[Lanelet], quality: MapQuality
) -> tuple[Rows, Rows]:
    """Return the stop lines and crossings among the objects, one row per drivable lanelet that they lie across."""
    rows_by_kind: dict[str, Rows] = {"stop_line": [], "crossing": []}
    flat = [(p, p.outline) for p in objects if p.kind in rows_by_kind and p.outline is not None and len(p.outline) > 1]
    if not flat:
        return [], []
    tree = shapely.STRtree([_valid_polygon(np.vstack([lane.line.right, lane.line.left[::-1]])) for lane in lanes])
    for flat_object, corners in flat:
        rows = []
        shape = _polygon_or_line(corners)
        for i in sorted(int(i) for i in tree.query(shape)):
            common = shapely.intersection(shape, tree.geometries[i])
            if common.is_empty:
                continue
            points = shapely.get_coordinates(common)
            centre = shapely.LineString(lanes[i].line.centre)
            s = np.atleast_1d(shapely.line_locate_point(centre, shapely.points(points)))
            if _is_on_other_level(flat_object, lanes[i], float(np.mean(s))):
                continue
            if flat_object.kind == "crossing" and float(shapely.area(common)) >= MIN_CROSSING_AREA_M2:
                rows.append(crossing_row(flat_object.object_id, lanes[i].lanelet_id, s, _crossing_kind(flat_object)))
            if flat_object.kind == "stop_line" and _lies_across(lanes[i], corners, points, float(np.mean(s))):
                rows.append(stop_line_row(flat_object.object_id, lanes[i].lanelet_id, float(s.min())))
        if not rows:
            name = f"{flat_object.kind} {flat_object.object_id} of road {flat_object.road.road_id}"
            message = f"{name} lies across no lane that vehicles drive on"
            quality.add("object_without_lane", "info", flat_object.road.road_id, message)
        rows_by_kind[flat_object.kind] += rows
    return rows_by_kind["stop_line"], rows_by_kind["crossing"]


def _is_on_other_level(flat_object: PlacedObject, lane: Lanelet, station_m: float) -> bool:
    """Return whether an object is over or under a lane of another road, as below a bridge. An unknown height shows nothing."""
    heights = flat_object.road.elevation
    if lane.road is flat_object.road or not len(heights.start):
        return False
    at = np.array([flat_object.s])
    z = float(heights.evaluate(at, at)[0][0]) + number_attribute(flat_object.element, "zOffset", 0.0)
    return abs(float(np.interp(station_m, lane.line.s, lane.z)) - z) >= OTHER_LEVEL_HEIGHT_DIFFERENCE_M


def _valid_polygon(corners: Floats) -> shapely.Geometry:
    polygon = shapely.Polygon(corners)
    return polygon if polygon.is_valid else polygon.buffer(0.0)


def _polygon_or_line(corners: Floats) -> shapely.Geometry:
    """Return the polygon of an outline; a line if the outline has almost no width."""
    if len(corners) > 2:
        polygon = shapely.Polygon(corners)
        if polygon.area > 0.005 * polygon.length**2:  # a square has 0.0625; 0.2 m by 3.5 m has 0.013
            return _valid_polygon(corners)
    axis = np.linalg.svd(corners - corners.mean(axis=0))[2][0]
    reach = (corners - corners.mean(axis=0)) @ axis
    return shapely.LineString([corners.mean(axis=0) + r * axis for r in (reach.min(), reach.max())])


def _lies_across(lane: Lanelet, corners: Floats, common_points: Floats, mean_station_m: float) -> bool:
    """Return whether a line crosses enough of a lane's width, at a large enough angle.

    `common_points`: the line's points on the lane; `mean_station_m`: their mean station (m).
    """
    line = lane.line
    columns = (*line.centre.T, *line.tangent.T, line.half_width)
    x, y, tx, ty, half = (float(np.interp(mean_station_m, line.s, column)) for column in columns)
    norm = max(float(np.hypot(tx, ty)), 1e-9)
    d = ((common_points[:, 1] - y) * tx - (common_points[:, 0] - x) * ty) / norm  # left positive
    axis = np.linalg.svd(corners - corners.mean(axis=0))[2][0]
    across = abs(float(axis[0] * ty - axis[1] * tx)) / norm
    return not (d.max() - d.min() < MIN_STOP_LINE_SHARE * 2.0 * half or across < np.sin(MIN_STOP_LINE_ANGLE_RAD))


def _crossing_kind(crossing: PlacedObject) -> str | None:
    words = f"{crossing.element.get('subtype', '')} {crossing.element.get('name', '')}".lower()
    return "zebra" if "zebra" in words else "signalled" if "signal" in words else None


def _placed_objects(net: Network, offset: tuple[float, float], quality: MapQuality) -> list[PlacedObject]:
    """Return every object, and each repetition of it; objects that cannot be placed are reported in `quality`."""
    objects: list[PlacedObject] = []
    for road in net.roads.values():
        for element in road.element.iterfind("objects/object"):
            try:
                objects += _objects_of_element(road, element, offset)
            except MalformedError as error:
                message = f"object {element.get('id')} of road {road.road_id} is left out: {error}"
                quality.add("invalid_object", "warning", road.road_id, message)
    return sorted(objects, key=lambda p: (p.object_id, p.road.road_id, p.s, p.x, p.y))


def _objects_of_element(road: Road, element: etree._Element, offset: tuple[float, float]) -> Iterator[PlacedObject]:
    repeats = element.findall("repeat")
    if not repeats:
        s, t = np.array([number_attribute(element, "s")]), np.array([number_attribute(element, "t", 0.0)])
        yield from _objects_at(road, element, s, t, offset, is_repeated=False)
    n_repeats = 0
    for repeat in repeats:
        distance, length = number_attribute(repeat, "distance", 0.0), number_attribute(repeat, "length", 0.0)
        start = number_attribute(repeat, "s", number_attribute(element, "s"))
        ends = [number_attribute(repeat, end, number_attribute(element, "t", 0.0)) for end in ("tStart", "tEnd")]
        if distance <= 0.0:
            yield _continuous_object_along_road(road, element, repeat, offset)
            continue
        steps = np.arange(min(int(length / distance + 1e-6) + 1, MAX_REPEATS + 1)) * distance
        n_repeats += len(steps)
        if n_repeats > MAX_REPEATS:
            raise MalformedError(f"it is repeated more than {MAX_REPEATS} times")
        t = np.interp(steps, [0.0, max(length, 1e-9)], ends)
        yield from _objects_at(road, element, start + steps.astype(np.float64), t, offset, is_repeated=True)


def _objects_at(
    road: Road, element: etree._Element, s: Floats, t: Floats, offset: tuple[float, float], *, is_repeated: bool
) -> Iterator[PlacedObject]:
    x, y, heading = road.xy_and_heading(s, t, offset)
    local, on_road = _local_outline(element), _outline_corners(element, "cornerRoad", ("s", "t"))
    turned = heading + number_attribute(element, "hdg", 0.0)
    for i in range(len(s)):
        outline = None
        if on_road is not None:
            shift = (
                np.array([s[i] - number_attribute(element, "s"), t[i] - number_attribute(element, "t", 0.0)])
                if is_repeated
                else 0.0
            )
            corners = on_road + shift
            outline = np.column_stack(road.xy_and_heading(corners[:, 0], corners[:, 1], offset)[:2])
        elif local is not None:
            cos, sin = np.cos(turned[i]), np.sin(turned[i])
            outline = np.array([x[i], y[i]]) + local @ np.array([[cos, sin], [-sin, cos]])
        name = required_attribute(element, "id") + (f"/{i}" if is_repeated else "")
        yield PlacedObject(road, element, name, float(s[i]), float(x[i]), float(y[i]), outline)


def _continuous_object_along_road(
    road: Road, element: etree._Element, repeat: etree._Element, offset: tuple[float, float]
) -> PlacedObject:
    """Return an object that runs along the road without gaps."""
    start, length = (
        number_attribute(repeat, "s", number_attribute(element, "s")),
        number_attribute(repeat, "length", 0.0),
    )
    if not 0.0 < length <= 1e5:
        raise MalformedError(f"the length of its <repeat> is {length:g} m: it must be above 0 and at most 100 km")
    along = np.linspace(0.0, 1.0, int(np.ceil(length / _BAND_SPACING_M)) + 1)
    t0 = number_attribute(element, "t", 0.0)
    t = np.interp(along, [0.0, 1.0], [number_attribute(repeat, "tStart", t0), number_attribute(repeat, "tEnd", t0)])
    width = number_attribute(element, "width", 0.0)
    half = (
        np.interp(
            along,
            [0.0, 1.0],
            [number_attribute(repeat, "widthStart", width), number_attribute(repeat, "widthEnd", width)],
        )
        / 2
    )
    half = np.maximum(half, 0.5 * _BAND_WIDTH_M)
    s = np.minimum(start + along * length, road.length_m)
    right, left = (np.column_stack(road.xy_and_heading(s, t + side, offset)[:2]) for side in (-half, half))
    x, y, _ = road.xy_and_heading(s[:1], t[:1], offset)
    outline = np.concatenate([right, left[::-1]])
    return PlacedObject(
        road, element, required_attribute(element, "id"), float(s[0]), float(x[0]), float(y[0]), outline
    )


def _outline_corners(element: etree._Element, tag: str, axes: tuple[str, str]) -> Floats | None:
    for path in (f"outline/{tag}", f"outlines/outline/{tag}"):
        elements = element.findall(path)
        if elements:
            first_outline = [
                c for c in elements if c.getparent() is elements[0].getparent()
            ]  # the first outline of several
            return np.array([[number_attribute(c, axis) for axis in axes] for c in first_outline])
    return None


def _local_outline(element: etree._Element) -> Floats | None:
    """Return the corners in the object's frame: as listed, else its rectangle, else its circle; None: a point."""
    listed = _outline_corners(element, "cornerLocal", ("u", "v"))
    if listed is not None:
        return listed
    length, width, radius = (number_attribute(element, a, 0.0) for a in ("length", "width", "radius"))
    if length > 0.0 and width > 0.0:
        return 0.5 * np.array([[length, width], [-length, width], [-length, -width], [length, -width]])
    if radius > 0.0:
        angle = np.arange(12) * (np.pi / 6)
        return radius * np.column_stack([np.cos(angle), np.sin(angle)])
    return None
