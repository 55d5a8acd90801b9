"""The lanes of a scenario as centre lines, and the distances to their left and right bounds.

The bounds are those of the lane's outline. If no lane has an outline, they are the lines and edges to which the lane refers; if no lane
refers to any, the lines and edges beside it. A bound that is still unknown is the middle between two parallel lanes.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import shapely

from drivelint.formats.scenarionet.pickled_numpy import PickleError
from drivelint.formats.scenarionet.scenario import point_array
from drivelint.road.lane_geometry import LARGEST_COORDINATE_M, stations

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from drivelint.arrays import Floats, Mask
    from drivelint.formats.scenarionet.scenario import Scenario
    from drivelint.road.quality import MapQuality

LANE_KIND_BY_FEATURE_TYPE: Final = {
    "LANE_SURFACE_STREET": "driving", "LANE_SURFACE_UNSTRUCTURE": "driving", "LANE_FREEWAY": "driving", "LANE_UNKNOWN": "driving",
    "LANE_BIKE_LANE": "biking",
}  # fmt: skip
"""Type of a feature -> lane type. LANE_UNKNOWN counts as a lane for driving."""
_CENTRE_LINE_POINT_SPACING_M: Final = 4.0
_LONGEST_LANE_M: Final = 10_000.0
_SIMPLIFICATION_TOLERANCE_M: Final = 0.02  # the tolerance with which a centre line is simplified
_LANE_END_INSET_M: Final = (
    2.0  # an outline's ends may be oblique: at a lane's ends, the width is measured this far inside
)
_OUTLINE_SEARCH_REACH_M: Final = 10.0  # how far to the side a lane's polygon is looked for
_BOUND_SEARCH_REACH_M: Final = 3.75  # a line or edge farther from the centre line bounds another lane
_LEAST_BOUND_DISTANCE_M: Final = (
    0.8  # a line to which no lane refers, nearer to the centre line than this, bounds another lane
)
_LARGEST_LEFT_RIGHT_BOUND_DIFFERENCE_M: Final = (
    0.6  # a bound farther away than the other bound by more than this lies beyond another strip
)
_PARALLEL_LANE_DISTANCES_M: Final = (2.2, 6.0)  # least and largest distance between the centre lines of parallel lanes
_LEAST_PARALLEL_COSINE: Final = float(np.cos(np.radians(10.0)))


@dataclass(eq=False)
class CentreLine:
    """A lane: `line` (n, 2) in the direction of travel, its stations `s` (n,) and unit normals to the left, heights `z` (n,).

    `bound_distances` (n, 2): the distances from the centre line to the left and to the right bound; NaN: not known.
    """

    lane_id: str
    feature: Mapping[str, Any]
    kind: str
    line: Floats
    s: Floats
    z: Floats
    normal: Floats
    bound_distances: Floats
    predecessors: tuple[str, ...] = field(default=())
    successors: tuple[str, ...] = field(default=())

    @property
    def tangent(self) -> Floats:
        """The direction of travel, unit vectors (n, 2)."""
        return np.column_stack([self.normal[:, 1], -self.normal[:, 0]])

    @property
    def bounds(self) -> tuple[Floats, Floats]:
        """The left and the right bound, each (n, 2)."""
        return self.line + self.normal * self.bound_distances[:, :1], self.line - self.normal * self.bound_distances[
            :, 1:
        ]


def read_centre_lines(scenario: Scenario, quality: MapQuality) -> dict[str, CentreLine]:
    """Return the lanes with their centre lines, still without widths; report lanes without a usable centre line in `quality`."""
    centre_lines = {}
    for name, feature in scenario.features.items():
        kind = LANE_KIND_BY_FEATURE_TYPE.get(str(feature.get("type")))
        if kind is None:
            continue
        try:
            line = point_array(feature.get("polyline"), f"map_features[{name[:100]!r}]['polyline']")
            centre_lines[name] = _centre_line(name, feature, kind, line, heights=scenario.dataset.heights)
        except PickleError as error:
            quality.add("invalid_lane", "error", name, f"lane {name} is left out: {error}")
    return centre_lines


def _centre_line(name: str, feature: Mapping[str, Any], kind: str, line: Floats, *, heights: bool) -> CentreLine:
    if line.shape[1] < 2 or not (np.abs(line[:, :2]) < LARGEST_COORDINATE_M).all():
        raise PickleError("its centre line has a point without a place")
    line = line[np.r_[True, np.hypot(*np.diff(line[:, :2], axis=0).T) > 0.01]]
    if len(line) < 2:
        raise PickleError("its centre line has fewer than two points")
    line_stations = stations(line)
    if line_stations[-1] > _LONGEST_LANE_M:
        raise PickleError(f"its centre line is {line_stations[-1] / 1000.0:.0f} km long")
    whole = shapely.LineString(line[:, :2])
    corners = np.unique(
        shapely.line_locate_point(
            whole, shapely.points(shapely.get_coordinates(shapely.simplify(whole, _SIMPLIFICATION_TOLERANCE_M)))
        )
    )
    pieces = np.maximum(1, np.ceil(np.diff(corners) / _CENTRE_LINE_POINT_SPACING_M)).astype(int)
    s = np.concatenate(
        [
            *(np.linspace(a, b, n, endpoint=False) for a, b, n in zip(corners, corners[1:], pieces, strict=False)),
            line_stations[-1:],
        ]
    )
    at = np.column_stack([np.interp(s, line_stations, column) for column in line.T])
    apart = np.r_[
        True, np.hypot(*np.diff(at[:, :2], axis=0).T) > 1e-3
    ]  # with far coordinates, the digits may not distinguish two points
    s, at = s[apart], at[apart]
    if len(s) < 2:
        raise PickleError("its centre line has fewer than two points")
    way = np.diff(at[:, :2], axis=0)
    way /= np.hypot(*way.T)[:, None]
    tangent = np.vstack([way[:1], way[:-1] + way[1:], way[-1:]])
    tangent /= np.maximum(np.hypot(*tangent.T), 1e-6)[:, None]
    z = at[:, 2] if heights and at.shape[1] > 2 else np.full(len(s), np.nan)
    normal = np.column_stack([-tangent[:, 1], tangent[:, 0]])
    return CentreLine(name, feature, kind, at[:, :2], s, z, normal, np.full((len(s), 2), np.nan))


def measure_bound_distances(lanes: Mapping[str, CentreLine], scenario: Scenario) -> None:
    """Measure the distances from each centre line to its two bounds, in place.

    If some lanes have outlines, the lanes without outline (which connect others) have no lines either, and stay unknown.
    """
    if any("polygon" in lane.feature for lane in lanes.values()):
        for name, lane in lanes.items():
            if "polygon" in lane.feature:
                outline = point_array(lane.feature["polygon"], f"map_features[{name[:100]!r}]['polygon']")[:, :2]
                if len(outline) > 3 and (np.abs(outline) < LARGEST_COORDINATE_M).all():
                    _measure_to_outline(lane, shapely.Polygon(outline))
        return
    lines = {
        name: _line_of_feature(feature, name)
        for name, feature in scenario.features.items()
        if str(feature.get("type")).startswith(("ROAD_LINE", "ROAD_EDGE", "UNKNOWN")) and "polyline" in feature
    }
    if any(lane.feature.get(f"{side}_boundaries") for lane in lanes.values() for side in ("left", "right")):
        for lane in lanes.values():
            _measure_to_named_lines(lane, lines)
    elif lines:
        tree = shapely.STRtree(list(lines.values()))
        for lane in lanes.values():
            _measure_to_nearest_lines(lane, tree)
    _measure_to_parallel_lanes(
        [lane for lane in lanes.values() if np.isnan(lane.bound_distances).any()], list(lanes.values())
    )


def _line_of_feature(feature: Mapping[str, Any], name: str) -> shapely.LineString:
    line = point_array(feature["polyline"], f"map_features[{name[:100]!r}]['polyline']")[:, :2]
    sound = len(line) > 1 and bool((np.abs(line) < LARGEST_COORDINATE_M).all())
    return shapely.LineString(line) if sound else shapely.LineString()


def _rays_to_side(lane: CentreLine, side: int, reach_m: float, points: Floats) -> Any:
    out = lane.normal * (reach_m if side == 0 else -reach_m)
    return shapely.linestrings(np.stack([points, points + out], axis=1))


def _measure_to_outline(lane: CentreLine, outline: shapely.Polygon) -> None:
    """Measure from the centre line to the edge of a polygon; at the ends of the lane, a little inside."""
    inset = min(_LANE_END_INSET_M, lane.s[-1] / 4)
    s = np.clip(lane.s, inset, lane.s[-1] - inset)
    place = np.column_stack([np.interp(s, lane.s, column) for column in lane.line.T])
    inside = shapely.contains(outline, shapely.points(place))
    for side in (0, 1):
        crossed = shapely.intersection(_rays_to_side(lane, side, _OUTLINE_SEARCH_REACH_M, place), outline.exterior)
        lane.bound_distances[:, side] = np.where(inside, shapely.distance(shapely.points(place), crossed), np.nan)


def _measure_to_named_lines(lane: CentreLine, lines: Mapping[str, shapely.LineString]) -> None:
    """Measure to the lines and edges that the lane names, each on its part of the lane."""
    for side, at, name in named_boundary_spans(lane):
        line = lines.get(name)
        if line is not None:
            _reduce_distances_to_line(lane, side, at, line, least_m=0.0)


def named_boundary_spans(lane: CentreLine) -> Iterable[tuple[int, Mask, str]]:
    """Yield for each boundary that a lane names its side (0 left, 1 right), the points (n,) that it lies beside, and its id."""
    line = point_array(lane.feature["polyline"], "polyline")
    line_s = stations(line)
    for side, key in enumerate(("left_boundaries", "right_boundaries")):
        spans = lane.feature.get(key)
        for span in spans if isinstance(spans, (list, tuple)) else ():
            try:
                first, last = (line_s[int(span[f"lane_{end}_index"])] for end in ("start", "end"))
                name = str(span["boundary_feature_id"])
            except (KeyError, ValueError, TypeError, IndexError, OverflowError):
                continue
            yield side, (lane.s >= first - 0.3) & (lane.s <= last + 0.3), name


def _measure_to_nearest_lines(lane: CentreLine, tree: shapely.STRtree) -> None:
    """Measure to the nearest line or edge beside each point, whichever lane it belongs to."""
    for side in (0, 1):
        rays = _rays_to_side(lane, side, _BOUND_SEARCH_REACH_M, lane.line)
        for i in np.unique(tree.query(rays, predicate="intersects")[1]):
            _reduce_distances_to_line(
                lane, side, np.ones(len(lane.s), np.bool_), tree.geometries[i], least_m=_LEAST_BOUND_DISTANCE_M
            )


def _reduce_distances_to_line(lane: CentreLine, side: int, at: Mask, line: Any, *, least_m: float) -> None:
    """Set the distance to a line, at the points `at`, where it is over `least_m` and the smallest so far."""
    crossed = shapely.intersection(_rays_to_side(lane, side, _BOUND_SEARCH_REACH_M, lane.line), line)
    far = np.asarray(shapely.distance(shapely.points(lane.line), crossed), np.float64)
    lane.bound_distances[:, side] = np.where(
        at & (far > least_m), np.fmin(lane.bound_distances[:, side], far), lane.bound_distances[:, side]
    )


def _measure_to_parallel_lanes(lanes: Sequence[CentreLine], all_lanes: Sequence[CentreLine]) -> None:
    """Set unknown bounds to the middle between two parallel lanes, of the same or of opposite direction.

    Lanes that split or merge are left out: they are parallel, too, but overlap.
    """
    tree = shapely.STRtree([shapely.LineString(lane.line) for lane in all_lanes])
    least, farthest = _PARALLEL_LANE_DISTANCES_M
    for lane in lanes:
        for side in (0, 1):
            unknown = np.flatnonzero(np.isnan(lane.bound_distances[:, side]))
            rays = _rays_to_side(lane, side, farthest, lane.line)[unknown]
            for k, i in tree.query(rays, predicate="intersects").T:
                parallel_lane, at = all_lanes[i], int(unknown[k])
                if parallel_lane is lane or not {*lane.predecessors, *lane.successors}.isdisjoint(
                    (*parallel_lane.predecessors, *parallel_lane.successors)
                ):
                    continue
                place = shapely.intersection(rays[k], tree.geometries[i])
                far = float(shapely.distance(shapely.Point(lane.line[at]), place))
                near = int(np.argmin(np.hypot(*(parallel_lane.line - lane.line[at]).T)))
                if (
                    least <= far <= farthest
                    and abs(float(lane.normal[at] @ parallel_lane.normal[near])) > _LEAST_PARALLEL_COSINE
                ):
                    lane.bound_distances[at, side] = np.fmin(lane.bound_distances[at, side], far / 2.0)


def fill_unknown_bound_distances_and_return_filled_shares(lanes: Mapping[str, CentreLine]) -> dict[str, float]:
    """Fill in unknown distances to bounds by the lanes that a lane joins, in place; return lane -> share of its distances filled in.

    At its ends, a lane is as wide as its predecessors or successors; in between, the width changes linearly. A side that is still unknown
    gets the distance of the other side.
    """
    unknown = {name: float(np.isnan(lane.bound_distances).mean()) for name, lane in lanes.items()}
    for _ in range(2):  # twice: the joined lane may itself get its width only in the first pass
        for lane in lanes.values():
            for end, linked_lanes, linked_end in ((0, lane.predecessors, -1), (-1, lane.successors, 0)):
                distances = [lanes[name].bound_distances[linked_end] for name in linked_lanes if name in lanes]
                distances = [half for half in distances if np.isfinite(half).all()]
                if distances:
                    lane.bound_distances[end] = np.where(
                        np.isnan(lane.bound_distances[end]), np.mean(distances, axis=0), lane.bound_distances[end]
                    )
    for lane in lanes.values():
        for side in (0, 1):
            at = np.isfinite(lane.bound_distances[:, side])
            if at.any():
                lane.bound_distances[:, side] = np.interp(lane.s, lane.s[at], lane.bound_distances[at, side])
        lane.bound_distances = np.where(
            np.isnan(lane.bound_distances), lane.bound_distances[:, ::-1], lane.bound_distances
        )
        if (
            "polygon" not in lane.feature
        ):  # a strip between a lane and a far edge, as for parked cars, is not part of the lane
            lane.bound_distances = np.minimum(
                lane.bound_distances, lane.bound_distances[:, ::-1] + _LARGEST_LEFT_RIGHT_BOUND_DIFFERENCE_M
            )
    return {name: share for name, share in unknown.items() if share > 0.0}
