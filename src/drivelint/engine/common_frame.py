"""Transforms a log into the coordinates of its map, if both have geo references and these differ."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np
import pyarrow as pa

from drivelint.arrays import floats, replace_columns, rotate_vectors, wrap_angles
from drivelint.drive.finish import with_quality_finding
from drivelint.drive.trace import QualityFinding
from drivelint.engine.earth import frame_of_map, log_frame_and_problem
from drivelint.errors import MapError
from drivelint.road import geo_reference

if TYPE_CHECKING:
    from drivelint.arrays import Floats
    from drivelint.drive.trace import Trace
    from drivelint.road.geo_reference import GeoFrame
    from drivelint.road.map_reader import MapTables

TEST_SQUARE_SIDE_M: Final = 100.0
TEST_SQUARE_SHAPE_TOLERANCE_M: Final = 0.01
"""The most (m) by which a square with sides of `TEST_SQUARE_SIDE_M` may be distorted by the transformation."""
TEST_SQUARE_SIDE_TOLERANCE_M: Final = 0.1
"""The most (m) by which the transformation may change a length of `TEST_SQUARE_SIDE_M`. UTM's scale is 0.9996 to 1.001, a local
projection's 1."""
SAME_POSITION_M: Final = 0.01
LEAST_FAR_MAP_OFFSET_M: Final = 10_000.0
"""With a larger offset of the map's coordinates, a drive fits the map either with or without it, not both."""


def move_into_map_frame(trace: Trace, environment: MapTables) -> Trace:
    """Return the trace in the coordinates of the map, with a finding about it.

    The trace is returned unchanged if a geo reference is missing, or if the user gives `--map-offset` or `--map-origin`. Each position is
    transformed; each heading, velocity and acceleration is turned by the angle between the frames there; heights stay. Errors: `MapError`
    if the transformation would distort lengths or shapes.
    """
    log_frame, map_frame = log_frame_and_problem(trace)[0], frame_of_map(environment)
    if not log_frame or not map_frame or _is_placed_by_user(environment):
        return trace
    states = trace.tables["actor_state"]
    columns = {c: floats(states[c]).copy() for c in states.column_names if pa.types.is_floating(states[c].type)}
    xy = np.stack([columns["x_m"], columns["y_m"]], axis=1)
    has_place = np.isfinite(xy).all(axis=1)
    if not has_place.any():
        return trace
    low, high = xy[has_place].min(axis=0), xy[has_place].max(axis=0)
    turn, stretch = _rotation_and_scale(log_frame, map_frame, low, high)
    # a second point, one metre from each position, shows by which angle headings turn there
    there, beside = np.split(
        _log_to_map_coordinates(
            log_frame, map_frame, np.concatenate([xy[has_place], xy[has_place] + np.array([1.0, 0.0])])
        ),
        2,
    )
    now = replace(
        trace, geo_reference=map_frame.reference, geo_offset=(map_frame.x_m, map_frame.y_m, map_frame.yaw_rad)
    )
    if np.abs(there - xy[has_place]).max() < SAME_POSITION_M:
        return now
    angle = np.full(len(xy), turn)
    angle[has_place] = np.arctan2(*(beside - there).T[::-1])
    columns["x_m"][has_place], columns["y_m"][has_place] = there.T
    columns["yaw_rad"] = wrap_angles(columns["yaw_rad"] + angle)
    for x, y in (("vx_mps", "vy_mps"), ("ax_mps2", "ay_mps2")):
        if x in columns:
            columns[x], columns[y] = rotate_vectors(columns[x], columns[y], angle)
    message = (
        f"the log's coordinates are {log_frame.reference!r}, the map's {map_frame.reference!r}: the log is moved into the map's, turned by "
        f"{math.degrees(turn):.4f} degrees, lengths times {stretch:.5f}"
    )
    trace_on_map = replace(now, tables={**trace.tables, "actor_state": replace_columns(states, columns)})
    return with_quality_finding(trace_on_map, QualityFinding("moved_to_map", "info", message))


def is_far_from_projection(environment: MapTables) -> bool:
    """Return whether map coordinates and projected coordinates are so far apart that a drive can fit the map in only one of them."""
    frame = frame_of_map(environment)
    return frame is not None and max(abs(frame.x_m), abs(frame.y_m)) > LEAST_FAR_MAP_OFFSET_M


def _is_placed_by_user(environment: MapTables) -> bool:
    (row,) = environment.tables["environment"].to_pylist()
    return bool(row["offset_x_m"] or row["offset_y_m"] or geo_reference.is_from_map_origin(row["geo_reference"]))


def _rotation_and_scale(log_frame: GeoFrame, map_frame: GeoFrame, low: Floats, high: Floats) -> tuple[float, float]:
    """Return the rotation (radians) and scale in the middle of an area. Errors: `MapError` if lengths or shapes in it are distorted."""
    at = np.array([(low + high) / 2, low, high, (low[0], high[1]), (high[0], low[1])])
    ends = np.concatenate([at, at + np.array([TEST_SQUARE_SIDE_M, 0.0]), at + np.array([0.0, TEST_SQUARE_SIDE_M])])
    start, along, across = np.split(_log_to_map_coordinates(log_frame, map_frame, ends), 3)
    along, across = along - start, across - start
    bent = np.hypot(*(across - along[:, ::-1] * (-1.0, 1.0)).T).max()
    lengths = np.hypot(*along.T)
    if not (
        bent <= TEST_SQUARE_SHAPE_TOLERANCE_M
        and np.abs(lengths - TEST_SQUARE_SIDE_M).max() <= TEST_SQUARE_SIDE_TOLERANCE_M
    ):
        raise MapError(
            f"the log's coordinates ({log_frame.reference!r}) cannot be moved into the map's ({map_frame.reference!r}): "
            f"{TEST_SQUARE_SIDE_M:.0f} m would be {lengths.min():.3f} to {lengths.max():.3f} m and {bent:.3f} m out of shape; "
            "bring log and map into one projection"
        )
    return math.atan2(along[0, 1], along[0, 0]), float(lengths[0] / TEST_SQUARE_SIDE_M)


def _log_to_map_coordinates(log_frame: GeoFrame, map_frame: GeoFrame, xy: Floats) -> Floats:
    return map_frame.unproject(geo_reference.transform(log_frame.project(xy), log_frame.reference, map_frame.reference))
