"""What lies on or beside the lanes: signals, stop lines, objects and crossings, laid over the lanelets."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely

from drivelint.formats.opendrive.objects import PlacedObject, placed_objects
from drivelint.formats.opendrive.signals import signal_rows
from drivelint.road.tables import Rows, crossing_row, stop_line_row

if TYPE_CHECKING:
    from drivelint.arrays import Floats
    from drivelint.formats.opendrive.lanelet import Lanelet
    from drivelint.formats.opendrive.network import Network
    from drivelint.road.quality import MapQuality

MIN_STOP_LINE_SHARE = 0.5  # a stop line that covers less of a lane's width is another lane's
MIN_STOP_LINE_ANGLE_RAD = 0.87  # 50 degrees: a line more along the lane than this is not one to stop at
MIN_CROSSING_AREA_M2 = 0.5  # a crossing that only touches a lane does not lie across it


def furniture(net: Network, lanes: list[Lanelet], offset: tuple[float, float], quality: MapQuality) -> dict[str, Rows]:
    """Return rows of `traffic_signal`, `stop_line`, `road_object` and `crossing`."""
    signals, painted = signal_rows(net, lanes, offset, quality)
    objects = placed_objects(net, offset, quality)
    stop_lines, crossings = _laid_over(objects, [lane for lane in lanes if lane.drivable], quality)
    return {
        "traffic_signal": signals,
        "stop_line": sorted([*painted, *stop_lines], key=lambda r: (r["stop_line_id"], r["lanelet_id"], r["lane_s_m"])),
        "road_object": [placed.row() for placed in objects],
        "crossing": crossings,
    }


def _laid_over(objects: list[PlacedObject], lanes: list[Lanelet], quality: MapQuality) -> tuple[Rows, Rows]:
    """Return the stop lines and crossings among the objects, one row per drivable lanelet that they lie across."""
    flat = [
        (p, p.outline)
        for p in objects
        if p.kind in {"stop_line", "crossing"} and p.outline is not None and len(p.outline) > 1
    ]
    if not flat:
        return [], []
    tree = shapely.STRtree([_area(lane) for lane in lanes])
    found: dict[str, Rows] = {"stop_line": [], "crossing": []}
    for placed, corners in flat:
        rows = []
        shape = _shape(corners)
        for i in sorted(int(i) for i in tree.query(shape)):
            common = shapely.intersection(shape, tree.geometries[i])
            if common.is_empty:
                continue
            points = shapely.get_coordinates(common)
            centre = shapely.LineString(lanes[i].line.centre)
            s = np.atleast_1d(shapely.line_locate_point(centre, shapely.points(points)))
            if placed.kind == "crossing" and float(shapely.area(common)) >= MIN_CROSSING_AREA_M2:
                rows.append(crossing_row(placed.object_id, lanes[i].lanelet_id, s, _crossing_kind(placed)))
            if placed.kind == "stop_line" and _lies_across(lanes[i], corners, points, float(np.mean(s))):
                rows.append(stop_line_row(placed.object_id, lanes[i].lanelet_id, float(s.min())))
        if not rows:
            name = f"{placed.kind} {placed.object_id} of road {placed.road.road_id}"
            message = f"{name} lies across no lane that vehicles drive on"
            quality.add("object_without_lane", "info", placed.road.road_id, message)
        found[placed.kind] += rows
    return found["stop_line"], found["crossing"]


def _area(lane: Lanelet) -> shapely.Geometry:
    polygon = shapely.Polygon(np.vstack([lane.line.right, lane.line.left[::-1]]))
    return polygon if polygon.is_valid else polygon.buffer(0.0)


def _shape(corners: Floats) -> shapely.Geometry:
    """Return the area of an outline; a line that was drawn without a width stays a line."""
    if len(corners) > 2:
        polygon = shapely.Polygon(corners)
        if polygon.area > 0.005 * polygon.length**2:  # a square has 0.0625; 0.2 m by 3.5 m has 0.013
            return polygon if polygon.is_valid else polygon.buffer(0.0)
    axis = np.linalg.svd(corners - corners.mean(axis=0))[2][0]
    reach = (corners - corners.mean(axis=0)) @ axis
    return shapely.LineString([corners.mean(axis=0) + r * axis for r in (reach.min(), reach.max())])


def _lies_across(lane: Lanelet, corners: Floats, points: Floats, middle: float) -> bool:
    """Say whether a line is across a lane, far enough; `points`: what of it is on the lane, `middle`: the mean station of them (m)."""
    line = lane.line
    columns = (*line.centre.T, *line.tangent.T, line.half_width)
    x, y, tx, ty, half = (float(np.interp(middle, line.s, column)) for column in columns)
    norm = max(float(np.hypot(tx, ty)), 1e-9)
    d = ((points[:, 1] - y) * tx - (points[:, 0] - x) * ty) / norm  # left positive
    axis = np.linalg.svd(corners - corners.mean(axis=0))[2][0]
    across = abs(float(axis[0] * ty - axis[1] * tx)) / norm
    return not (d.max() - d.min() < MIN_STOP_LINE_SHARE * 2.0 * half or across < np.sin(MIN_STOP_LINE_ANGLE_RAD))


def _crossing_kind(placed: PlacedObject) -> str | None:
    said = f"{placed.element.get('subtype', '')} {placed.element.get('name', '')}".lower()
    return "zebra" if "zebra" in said else "signalled" if "signal" in said else None
