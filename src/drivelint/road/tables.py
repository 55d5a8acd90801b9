"""Arrow tables with exactly the columns and types of schemas/map.sql."""

from __future__ import annotations

import re
from functools import cache
from typing import TYPE_CHECKING, Any

import pyarrow as pa
import pyarrow.compute as pc

from drivelint.resources import folder
from drivelint.road.geo_reference import GeoFrame, why_unusable
from drivelint.road.map_reader import MapTables

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from drivelint.road.map_reader import MapOptions, MapSource
    from drivelint.road.quality import MapQuality

Rows = list[dict[str, Any]]

_TABLE = re.compile(r"^CREATE TABLE (\w+) \(\n(.*?)^\);", re.DOTALL | re.MULTILINE)
_COLUMN = re.compile(r"^    (\w+) ([A-Z]+(?:\[\])?)", re.MULTILINE)
_TYPES = {
    "VARCHAR": pa.string(),
    "DOUBLE": pa.float64(),
    "BOOLEAN": pa.bool_(),
    "INTEGER": pa.int32(),
    "BIGINT": pa.int64(),
    "DOUBLE[]": pa.list_(pa.float64()),
    "VARCHAR[]": pa.list_(pa.string()),
}


@cache
def schemas() -> dict[str, pa.Schema]:
    """Return table -> Arrow schema, as `schemas/map.sql` has them."""
    text = (folder("schemas") / "map.sql").read_text(encoding="utf-8")
    return {
        name: pa.schema([(column, _TYPES[kind]) for column, kind in _COLUMN.findall(body)])
        for name, body in _TABLE.findall(text)
    }


def from_rows(name: str, environment: str, rows: Sequence[Mapping[str, Any]]) -> pa.Table:
    """Return the table `name` of these rows, each a mapping without `environment_id`, in the order given."""
    schema = schemas()[name]
    columns = {f.name: [row[f.name] for row in rows] for f in schema if f.name != "environment_id"}
    return from_columns(name, environment, columns, len(rows))


def from_columns(name: str, environment: str, columns: Mapping[str, Any], n: int) -> pa.Table:
    """Return the table `name` of `n` rows from lists or arrays by column, `environment_id` added."""
    schema = schemas()[name]
    if columns.keys() != {f.name for f in schema} - {"environment_id"}:
        raise KeyError(f"{name}: columns {sorted(columns)} are not those of schemas/map.sql")
    data = {"environment_id": pa.repeat(pa.scalar(environment), n), **columns}
    return pa.table([_array(data[f.name], f.type) for f in schema], schema=schema)


def crossing_row(crossing: str, lanelet: str, stations: Any, kind: str | None) -> dict[str, Any]:
    """Return a row of `crossing` from the first to the last of some stations (m) on the lanelet."""
    return {
        "crossing_id": crossing, "lanelet_id": lanelet,
        "s_start_m": float(min(stations)), "s_end_m": float(max(stations)), "kind": kind,
    }  # fmt: skip


def stop_line_row(stop_line: str, lanelet: str, s_m: float, source: str = "object") -> dict[str, Any]:
    """Return a row of `stop_line`."""
    return {"stop_line_id": stop_line, "lanelet_id": lanelet, "lane_s_m": s_m, "source": source}


def map_tables(
    name: str,
    source: MapSource,
    request: MapOptions,
    content: Mapping[str, pa.Table | Rows],
    quality: MapQuality,
    *,
    kind: str,
    side: tuple[str, str],
    geo: GeoFrame | None = None,
) -> MapTables:
    """Return the map `name`: `content`, tables or rows by table, with `environment` and `map_quality`.

    `kind`: its format; `side`: the side that is driven on, and what says so; `geo`: how its own coordinates lie on the earth.
    """
    tables = {
        table: from_rows(table, name, rows) if isinstance(rows, list) else rows for table, rows in content.items()
    }
    trouble = _geo_trouble(geo, tables["lane_point"], request) if geo else None
    if geo and trouble:
        message = f"the geo reference {geo.reference!r} gives no positions on the earth: {trouble}"
        quality.add("geo_reference_unusable", "info", None, message)
    environment = {
        "name": source.name, "sha256": source.sha256, "format": kind,
        "offset_x_m": request.offset[0], "offset_y_m": request.offset[1],
        "handedness": side[0], "handedness_source": side[1], "geo_reference": geo.reference if geo else None,
        **{f"geo_offset_{part}": getattr(geo, part, None) for part in ("x_m", "y_m", "z_m", "yaw_rad")},
        "geo_usable": trouble is None if geo else None,
    }  # fmt: skip
    about = from_rows("environment", name, [environment])
    found = from_rows("map_quality", name, quality.sorted_rows())
    return MapTables(name, *side, {"environment": about, **tables, "map_quality": found})


def _geo_trouble(geo: GeoFrame, points: pa.Table, request: MapOptions) -> str | None:
    """Return why the frame gives no positions on the earth, judged in the middle of the lanes."""
    middle = [sum(pc.min_max(points[axis]).as_py().values()) / 2.0 for axis in ("x_m", "y_m")]
    return why_unusable(geo, middle[0] - request.offset[0], middle[1] - request.offset[1])


def _array(values: Any, kind: pa.DataType) -> pa.Array:
    if isinstance(values, (pa.Array, pa.ChunkedArray)):
        return values.cast(kind)
    return pa.array(values, type=kind)


def repeated(names: Sequence[str], counts: Sequence[int]) -> pa.Array:
    """Return each name as often as its count says, as an Arrow string array."""
    import numpy as np

    indices = pa.array(np.repeat(np.arange(len(names), dtype=np.int32), counts))
    return pa.DictionaryArray.from_arrays(indices, pa.array(names, type=pa.string())).cast(pa.string())
