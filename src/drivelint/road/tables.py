"""Makes Arrow tables with exactly the columns and types of schemas/map.sql."""

from __future__ import annotations

from pathlib import PurePath
from typing import TYPE_CHECKING, Any

import pyarrow as pa
import pyarrow.compute as pc

from drivelint.road.geo_reference import GeoFrame, why_unusable
from drivelint.road.map_reader import MapTables
from drivelint.road.quality import SIGNS_UNMAPPED_CHECK
from drivelint.sql.store import table_with_owner_id

if TYPE_CHECKING:
    from collections.abc import Mapping

    from drivelint.road.map_reader import MapOptions, MapSource
    from drivelint.road.quality import MapQuality

Rows = list[dict[str, Any]]


def crossing_row(crossing: str, lanelet: str, stations: Any, kind: str | None) -> dict[str, Any]:
    """Return a row of `crossing` that extends from the least to the largest of these stations (m) on the lanelet."""
    return {
        "crossing_id": crossing, "lanelet_id": lanelet,
        "s_start_m": float(min(stations)), "s_end_m": float(max(stations)), "kind": kind,
    }  # fmt: skip


def stop_line_row(stop_line: str, lanelet: str, s_m: float, source: str = "object") -> dict[str, Any]:
    """Return a row of `stop_line`."""
    return {"stop_line_id": stop_line, "lanelet_id": lanelet, "lane_s_m": s_m, "source": source}


def map_tables(
    source: MapSource,
    request: MapOptions,
    content: Mapping[str, Rows | dict[str, Any]],
    quality: MapQuality,
    *,
    map_format: str,
    side_and_source: tuple[str, str],
    geo: GeoFrame | None = None,
    lanes_reversed: bool = False,
    nation: str | None = None,
) -> MapTables:
    """Return the map with `content` (table -> rows or columns), `environment` and `map_quality`.

    The map's id is `<map stem>-<first 8 hex of sha256><offset, if any>@<lht or rht>`, the same on every machine. A question mark follows if
    the side is a guess, and a tilde if `lanes_reversed`.

    `side_and_source`: the driving side and its source; `geo`: the frame of the map's own coordinates; `lanes_reversed`: the lanes'
    directions are opposite to those of the driving side; `nation`: the country of the roads, as two letters, None: unknown.
    """
    x, y = (float(v) + 0.0 for v in request.offset)
    shift = f"{x:+}{y:+}" if x or y else ""
    # a default side is marked, because the traces of another drive may show the real one
    marks = f"{'?' if side_and_source[1] == 'default' else ''}{'~' if lanes_reversed else ''}"
    name = f"{PurePath(source.name).stem}-{source.sha256[:8]}{shift}@{side_and_source[0]}{marks}"
    tables = {table: table_with_owner_id(table, name, rows, map_format) for table, rows in content.items()}
    trouble = _why_unusable_for_lanes(geo, tables["lane_point"], request) if geo else None
    if geo and trouble:
        quality.add_unusable_geo_reference(geo.reference, trouble)
    environment = {
        "name": source.name, "sha256": source.sha256, "format": map_format,
        "offset_x_m": request.offset[0], "offset_y_m": request.offset[1],
        "handedness": side_and_source[0], "handedness_source": side_and_source[1], "geo_reference": geo.reference if geo else None,
        **{f"geo_offset_{part}": getattr(geo, part, None) for part in ("x_m", "y_m", "z_m", "yaw_rad")},
        "geo_usable": trouble is None if geo else None,
        "signs_mapped": all(row["check_id"] != SIGNS_UNMAPPED_CHECK for row in quality.rows),
    }  # fmt: skip
    about = table_with_owner_id("environment", name, [environment], map_format)
    quality_table = table_with_owner_id("map_quality", name, quality.sorted_rows(), map_format)
    return MapTables(
        name, *side_and_source, {"environment": about, **tables, "map_quality": quality_table}, nation=nation
    )


def _why_unusable_for_lanes(geo: GeoFrame, points: pa.Table, request: MapOptions) -> str | None:
    """Return why the frame gives no positions on the earth, tested in the middle of the lanes; None: it is usable."""
    middle = [sum(pc.min_max(points[axis]).as_py().values()) / 2.0 for axis in ("x_m", "y_m")]
    return why_unusable(geo, middle[0] - request.offset[0], middle[1] - request.offset[1])
