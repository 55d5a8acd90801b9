"""Computes where drives and findings are on the earth, by the projection of the map, else by that of the log."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pyarrow.compute as pc

from drivelint.road.geo_reference import GeoFrame, why_unusable
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    from collections.abc import Sequence

    import duckdb

    from drivelint.drive.trace import Trace
    from drivelint.road.map_reader import MapTables


def frame_and_reference_problem(trace: Trace, environment: MapTables | None) -> tuple[GeoFrame | None, str | None]:
    """Return the frame of the map, else that of the log (None: unknown), and why the log's geo reference is unusable, if it is.

    `map_quality` contains the problems of the map's geo reference.
    """
    if environment is not None and (frame := frame_of_map(environment)):
        return frame, None
    return log_frame_and_problem(trace)


def log_frame_and_problem(trace: Trace) -> tuple[GeoFrame | None, str | None]:
    """Return the frame of the log's own geo reference, or None and why that reference is unusable (None: there is none)."""
    states = trace.tables["actor_state"]
    ends = [pc.min_max(states[axis]).as_py() for axis in ("x_m", "y_m")]
    if trace.geo_reference is None or any(end["min"] is None for end in ends):
        return None, None
    x, y, yaw = trace.geo_offset
    frame = GeoFrame(trace.geo_reference, x, y, yaw_rad=yaw)
    trouble = why_unusable(frame, *((end["min"] + end["max"]) / 2.0 for end in ends))
    if trouble:
        return None, f"the log's geo reference {frame.reference!r} gives no positions on the earth: {trouble}"
    return frame, None


def frame_of_map(environment: MapTables) -> GeoFrame | None:
    """Return the frame that relates a drive's coordinates on the map to the map's projection; None: there is no usable projection."""
    (row,) = environment.tables["environment"].to_pylist()
    if not row["geo_usable"]:
        return None
    frame = GeoFrame(row["geo_reference"], *(row[f"geo_offset_{name}"] for name in ("x_m", "y_m", "z_m", "yaw_rad")))
    return frame.after_shift(row["offset_x_m"], row["offset_y_m"])


def set_longitude_and_latitude(con: duckdb.DuckDBPyConnection, ids: Sequence[str], table: str) -> None:
    """Set the longitude and latitude of these drives in `data_log`, or of their findings in `finding`.

    `table`: `data_log` or `finding`.
    """
    key, places = ("drive_id", "places_of_drives") if table == "data_log" else ("rowid", "places_of_findings")
    if ids:
        position = statement("earth/position", table=table, key=key, places=statement(f"earth/{places}"))
        con.execute(position, {"ids": list(ids)})
