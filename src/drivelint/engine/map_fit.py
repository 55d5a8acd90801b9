"""Compares traces with a map: on which side of the road the vehicles drive, and whether the positions are on the map."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
import pyarrow.compute as pc
import shapely

from drivelint.road.driving_side import opposite_side

if TYPE_CHECKING:
    import pyarrow as pa
    from numpy.typing import NDArray

    from drivelint.arrays import Floats, Indices, Mask
    from drivelint.road.map_reader import MapTables

DRIVING_SIDE_CHECK_SAMPLES: Final = 80  # states for checking a known side; every drive is checked, so this must be fast
DRIVING_SIDE_VOTE_SAMPLES: Final = 400  # states for finding an unknown side, evenly spread; fast also for a long log
LEAST_DRIVING_SIDE_VOTES: Final = 20
FIRST_POSITIONS, MOST_POSITIONS = 20, 2000  # positions for checking whether a drive is on its map
LEAST_STEPS_AGAINST_LANE_EACH_WAY: Final = 5
"""A road counts as reversed if at least this many steps are against the lane in each direction: overtaking explains only one direction."""
FARTHEST_NEIGHBOUR_LANE_M: Final = (
    8.0  # the most between the centre lines of neighbouring lanes of one road, a median strip included
)
LEAST_OPPOSITE_LANE_COSINE: Final = 0.9
LEAST_SHARE_OF_HEADINGS_ALONG_LANES: Final = 0.8  # vehicles drive against their lane only in short overtakes


class OneWayLanes(NamedTuple):
    """The one-way drivable lanelets of a map: areas (spatial index), centre lines, road ids, directions along the road (1, -1)."""

    areas: shapely.STRtree
    lines: NDArray[np.object_]
    road: NDArray[np.object_]
    along: NDArray[np.int64]


class LaneHeadings(NamedTuple):
    """Moving states on one-way lanes (without states on several lanes): whether the heading is along the lane, and the lane's index."""

    agree: Mask
    lane: Indices


def one_way_lanes(environment: MapTables) -> OneWayLanes:
    """Return the lanes whose direction is compared with the headings of traces."""
    lanelets = environment.tables["lanelet"]
    one_way = lanelets.filter(pc.and_(lanelets["drivable"], pc.invert(lanelets["bidirectional"])))
    one_way = one_way.sort_by("lanelet_id")
    areas, lines = _areas_and_centre_lines(environment, one_way["lanelet_id"])
    shapely.prepare(areas)
    return OneWayLanes(
        shapely.STRtree(areas),
        lines,
        one_way["road_id"].to_numpy(zero_copy_only=False),
        one_way["along_road"].to_numpy(),
    )


def compare_headings_with_lanes(
    lanes: OneWayLanes, x_m: Floats, y_m: Floats, yaw_rad: Floats, max_positions: int
) -> LaneHeadings:
    """Compare headings with the directions of lanes.

    `x_m, y_m, yaw_rad`: moving states of any vehicles, shape (n,), in map coordinates. At most `max_positions`, evenly spread, are used.
    """
    with_pose = np.flatnonzero(np.isfinite(x_m) & np.isfinite(y_m) & np.isfinite(yaw_rad))
    if len(with_pose) < LEAST_DRIVING_SIDE_VOTES or not len(lanes.lines):
        return LaneHeadings(np.zeros(0, np.bool_), np.zeros(0, np.intp))
    sample = with_pose[
        np.unique(np.linspace(0, len(with_pose) - 1, min(max_positions, len(with_pose))).astype(np.int64))
    ]
    points = np.asarray(shapely.points(x_m[sample], y_m[sample]))
    state, lane = lanes.areas.query(points, predicate="intersects")
    single = np.bincount(state, minlength=len(sample))[state] == 1
    state, lane = state[single], lane[single]
    return LaneHeadings(np.cos(yaw_rad[sample][state] - _heading_of_lines(lanes.lines[lane], points[state])) > 0, lane)


def vote_handedness(lanes_handedness: str, headings: LaneHeadings) -> str | None:
    """Return the driving side (lht, rht) that the headings show; None: there are too few, or they disagree.

    `lanes_handedness`: the side for which the lanes' directions were made.
    """
    if len(headings.agree) < LEAST_DRIVING_SIDE_VOTES:
        return None
    agree = float(np.mean(headings.agree))
    if agree >= LEAST_SHARE_OF_HEADINGS_ALONG_LANES:
        return lanes_handedness
    if agree <= 1 - LEAST_SHARE_OF_HEADINGS_ALONG_LANES:
        return opposite_side(lanes_handedness)
    return None


def road_with_reversed_traffic(lanes: OneWayLanes, headings: LaneHeadings) -> str | None:
    """Return the id of a road with traffic against its lanes in both directions; None: there is none.

    Nearly all traffic on the map must be against its lane. Two parallel roads of opposite direction count as one road.
    """
    if (
        len(headings.agree) < LEAST_DRIVING_SIDE_VOTES
        or float(np.mean(headings.agree)) > 1 - LEAST_SHARE_OF_HEADINGS_ALONG_LANES
    ):
        return None
    against = headings.lane[~headings.agree]
    for road in sorted({str(name) for name in lanes.road[against]}):
        here = against[lanes.road[against] == road]
        if min(int((lanes.along[here] == way).sum()) for way in (1, -1)) >= LEAST_STEPS_AGAINST_LANE_EACH_WAY:
            return road
    lane, counts = np.unique(against, return_counts=True)
    often = lane[counts >= LEAST_STEPS_AGAINST_LANE_EACH_WAY]
    first, second = (often[k] for k in np.triu_indices(len(often), 1))
    near = shapely.shortest_line(lanes.lines[first], lanes.lines[second])
    heading, back = (
        _heading_of_lines(lanes.lines[lane], shapely.get_point(near, end)) for lane, end in ((first, 0), (second, -1))
    )
    facing = np.cos(heading - back) < -LEAST_OPPOSITE_LANE_COSINE
    is_two_way_road = facing & (shapely.length(near) < FARTHEST_NEIGHBOUR_LANE_M)
    return min((str(lanes.road[k]) for k in first[is_two_way_road]), default=None)


def _heading_of_lines(line: NDArray[np.object_], points: NDArray[np.object_]) -> Floats:
    """Return the heading (rad) of each line at the location closest to the point."""
    at = shapely.line_locate_point(line, points)
    ahead = shapely.get_coordinates(shapely.line_interpolate_point(line, at + 0.5))
    behind = shapely.get_coordinates(shapely.line_interpolate_point(line, np.maximum(at - 0.5, 0.0)))
    heading: Floats = np.arctan2(ahead[:, 1] - behind[:, 1], ahead[:, 0] - behind[:, 0])
    return heading


def lane_areas(environment: MapTables) -> shapely.STRtree:
    """Return a spatial index of the areas of all lanelets of any type."""
    areas = _areas_and_centre_lines(environment, environment.tables["lanelet"]["lanelet_id"])[0]
    shapely.prepare(areas)
    return shapely.STRtree(areas)


def count_examined_and_on_map(lanes: shapely.STRtree, x_m: Floats, y_m: Floats) -> tuple[int, int]:
    """Return how many known positions, evenly spread, were examined, and how many of them are on a lanelet.

    `FIRST_POSITIONS` are examined first; only if none of them is on a lanelet, `MOST_POSITIONS` are examined.
    """
    with_place = np.flatnonzero(np.isfinite(x_m) & np.isfinite(y_m))
    n_examined = n_on_map = 0
    for max_positions in (FIRST_POSITIONS, MOST_POSITIONS):
        if n_on_map or n_examined == len(with_place):
            break
        sample = with_place[
            np.unique(np.linspace(0, len(with_place) - 1, min(max_positions, len(with_place))).astype(np.int64))
        ]
        points = np.asarray(shapely.points(x_m[sample], y_m[sample]))
        n_examined, n_on_map = len(sample), len(np.unique(lanes.query(points, predicate="intersects")[0]))
    return n_examined, n_on_map


def _areas_and_centre_lines(
    environment: MapTables, lanelet_ids: pa.ChunkedArray
) -> tuple[NDArray[np.object_], NDArray[np.object_]]:
    """Return the areas and the centre lines of these lanelets."""
    points = environment.tables["lane_point"]
    points = points.filter(pc.is_in(points["lanelet_id"], value_set=lanelet_ids.combine_chunks())).sort_by(
        [("lanelet_id", "ascending"), ("k", "ascending")]
    )
    ids = points["lanelet_id"].to_numpy(zero_copy_only=False)
    if not len(ids):
        return np.array([], dtype=object), np.array([], dtype=object)
    _, index, counts = np.unique(ids, return_inverse=True, return_counts=True)
    line = np.asarray(shapely.linestrings(_coordinates(points, "x_m", "y_m"), indices=index))
    left, right = _coordinates(points, "left_x_m", "left_y_m"), _coordinates(points, "right_x_m", "right_y_m")
    ends = np.cumsum(counts)
    rings = [np.vstack([left[a:b], right[a:b][::-1]]) for a, b in zip(ends - counts, ends, strict=True)]
    return np.array([shapely.Polygon(ring) for ring in rings], dtype=object), line


def _coordinates(points: pa.Table, x: str, y: str) -> Floats:
    return np.column_stack([points[x].to_numpy(), points[y].to_numpy()])
