"""Puts drives and their findings on the earth, by the projection of the map, else by that of the log."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import pyarrow.compute as pc

from drivelint.road.geo_reference import GeoFrame, why_unusable

if TYPE_CHECKING:
    from collections.abc import Sequence

    import duckdb

    from drivelint.drive.trace import Trace
    from drivelint.road.map_reader import MapTables

# the drive's coordinates in the projection, then in degrees; a projection may have no place for some
_PLACED: Final = """
SELECT p.key, ST_X(place) AS lon, ST_Y(place) AS lat FROM (
    SELECT p.key, ST_Transform(ST_Point(
        p.x_m * cos(l.geo_yaw_rad) - p.y_m * sin(l.geo_yaw_rad) + l.geo_x_m,
        p.x_m * sin(l.geo_yaw_rad) + p.y_m * cos(l.geo_yaw_rad) + l.geo_y_m
    ), l.geo_reference, 'EPSG:4326', always_xy := true) AS place
    FROM ({places}) p JOIN data_log l USING (drive_id)
    WHERE l.geo_reference IS NOT NULL AND list_contains($ids, l.drive_id)
) p WHERE isfinite(ST_X(place)) AND isfinite(ST_Y(place))
"""
_FIRST: Final = """
SELECT drive_id, drive_id AS key, arg_min(x_m, (actor_id, t_ns)) AS x_m, arg_min(y_m, (actor_id, t_ns)) AS y_m
FROM actor_state SEMI JOIN (FROM actor WHERE is_ego) a USING (drive_id, actor_id)
WHERE x_m IS NOT NULL AND y_m IS NOT NULL GROUP BY drive_id
"""


def place_on_earth(trace: Trace, environment: MapTables | None) -> tuple[GeoFrame | None, str | None]:
    """Return how the drive's coordinates become those of a projection (None: nothing says it), and what is wrong with the log's own.

    What is wrong with the map's is in its `map_quality`.
    """
    if environment is not None and (frame := _of_map(environment)):
        return frame, None
    if trace.geo_reference is None:
        return None, None
    states = trace.tables["actor_state"]
    ends = [pc.min_max(states[axis]).as_py() for axis in ("x_m", "y_m")]
    if any(end["min"] is None for end in ends):
        return None, None
    x, y, yaw = trace.geo_offset
    frame = GeoFrame(trace.geo_reference, x, y, yaw_rad=yaw)
    trouble = why_unusable(frame, *((end["min"] + end["max"]) / 2.0 for end in ends))
    if trouble:
        return None, f"the log's geo reference {frame.reference!r} gives no positions on the earth: {trouble}"
    return frame, None


def _of_map(environment: MapTables) -> GeoFrame | None:
    """Return how the coordinates of a drive on the map become those of the map's projection; None: it has no usable one."""
    (row,) = environment.tables["environment"].to_pylist()
    if not row["geo_usable"]:
        return None
    own = GeoFrame(row["geo_reference"], *(row[f"geo_offset_{name}"] for name in ("x_m", "y_m", "z_m", "yaw_rad")))
    return own.after_shift(row["offset_x_m"], row["offset_y_m"])


def place_drives(con: duckdb.DuckDBPyConnection, ids: Sequence[str]) -> None:
    """Set longitude and latitude of these drives in `data_log`, which has their projection."""
    _update(con, "data_log", "drive_id", _FIRST, ids)


def place_findings(con: duckdb.DuckDBPyConnection, ids: Sequence[str]) -> None:
    """Set longitude and latitude of the findings of these drives that have none yet."""
    _update(con, "finding", "rowid", "SELECT drive_id, rowid AS key, x_m, y_m FROM finding WHERE lon IS NULL", ids)


def _update(con: duckdb.DuckDBPyConnection, table: str, key: str, places: str, ids: Sequence[str]) -> None:
    placed = _PLACED.format(places=places)
    if ids:
        con.execute(
            f"UPDATE {table} SET lon = g.lon, lat = g.lat FROM ({placed}) g WHERE g.key = {table}.{key}",
            {"ids": list(ids)},
        )
