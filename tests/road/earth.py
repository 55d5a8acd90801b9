"""Places on the earth as a run writes them."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

from drivelint.engine.batch import drive_with_map
from drivelint.engine.earth import set_longitude_and_latitude
from drivelint.sql import store
from tests.engine.few_states import log_of, states

if TYPE_CHECKING:
    from drivelint.road.geo_reference import GeoFrame
    from drivelint.road.map_reader import MapTables

UTM = "+proj=utm +zone=32 +datum=WGS84 +units=m +no_defs"
KARLSRUHE = "+proj=tmerc +lat_0=49 +lon_0=8.4 +datum=WGS84"


def lon_lat(geo: GeoFrame, *places: tuple[float, float]) -> list[tuple[float | None, float | None]]:
    """Return longitude and latitude of findings at these places (m) of a drive, as a run writes them, in a locked database."""
    with store.connect() as con:
        store.lock_down(con)
        row = {"drive_id": "d", "geo_reference": geo.reference, "geo_x_m": geo.x_m, "geo_y_m": geo.y_m}
        add(con, "data_log", row | {"geo_yaw_rad": geo.yaw_rad})
        add(con, "actor", {"drive_id": "d", "actor_id": "e", "is_ego": True})
        add(con, "actor", {"drive_id": "d", "actor_id": "a", "is_ego": False})
        for i, (x, y) in enumerate(places):
            add(con, "finding", {"finding_id": f"{i:06}", "drive_id": "d", "x_m": x, "y_m": y})
            add(con, "actor_state", {"drive_id": "d", "actor_id": "e", "t_ns": i, "x_m": x, "y_m": y})
            add(con, "actor_state", {"drive_id": "d", "actor_id": "a", "t_ns": i - 9, "x_m": 7.0, "y_m": 7.0})
        set_longitude_and_latitude(con, ["d"], "finding")
        set_longitude_and_latitude(con, ["d"], "data_log")
        found = con.execute("SELECT lon, lat FROM finding ORDER BY finding_id").fetchall()
        assert con.execute("SELECT lon, lat FROM data_log").fetchall() == found[:1]
        return found


def add(con: Any, table: str, row: dict[str, object]) -> None:
    """Insert a row, what it has to have and is not given being 0 or empty."""
    needed = {
        name: False if kind == "BOOLEAN" else "" if kind == "VARCHAR" else 0
        for name, kind, null, *_ in con.execute(f"DESCRIBE {table}").fetchall()
        if null == "NO"
    }
    values = needed | row
    marks = ", ".join("?" * len(values))
    con.execute(f"INSERT INTO {table} ({', '.join(values)}) VALUES ({marks})", list(values.values()))


def geo_of(environment: MapTables, **log: Any) -> GeoFrame:
    """Return the frame of a drive on the map."""
    library = SimpleNamespace(find=lambda log: (environment, log), doubts_on_map=lambda *_: {})
    geo = drive_with_map(log_of(states(5.0), **log), library).geo  # type: ignore[arg-type]
    assert geo is not None
    return geo


def row_of(environment: MapTables) -> dict[str, Any]:
    (row,) = environment.tables["environment"].to_pylist()
    return dict(row)


def metres_apart(a: tuple[float | None, float | None], b: tuple[float, float]) -> float:
    assert a[0] is not None
    assert a[1] is not None
    return math.hypot((a[0] - b[0]) * math.cos(math.radians(b[1])), a[1] - b[1]) * 111_195.0
