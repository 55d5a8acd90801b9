"""Adds GeoParquet geometry columns to result files, made from the columns with coordinates.

`geom` is in the map's metres: x to the east, y to the north. It has no coordinate reference system, since a map may lack one and a
result may use several maps. `geom_lonlat` is in degrees of longitude and latitude (WGS 84), if map or log give them.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
import pyarrow as pa
import shapely

from drivelint.arrays import floats

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.typing import NDArray

    Geometries = NDArray[np.object_]

GEOMETRY_IN_METRES_COLUMN: Final = "geom"
GEOMETRY_IN_DEGREES_COLUMN: Final = "geom_lonlat"
_LEAST_RING_POINTS: Final = 4  # the least number: a triangle with its first point repeated


class GeometryColumn(NamedTuple):
    """A geometry column of a table: its type in GeoParquet, its meaning, and the function that makes it from the rows.

    The function returns None for rows without a geometry.
    """

    kind: str
    comment: str
    make: Callable[[pa.Table], Geometries]


def with_geometry(rows: pa.Table, table: str) -> pa.Table:
    """Return the rows of a schema table with its geometries as WKB, and the metadata of GeoParquet 1.1 in the schema.

    Tables without geometries are returned unchanged.
    """
    if not (shapes := GEOMETRIES_OF_TABLE.get(table)):
        return rows
    about: dict[str, dict[str, Any]] = {}
    metadata = rows.schema.metadata or {}
    for column, shape in shapes.items():
        wkb = shapely.to_wkb(shape.make(rows), output_dimension=2, byte_order=1)
        field = pa.field(column, pa.binary(), metadata={"comment": f"{shape.kind}: {shape.comment}"})
        rows = rows.append_column(field, pa.array(wkb, pa.binary(), from_pandas=True))
        # no key "crs" means longitude and latitude; null means that the reference system is unknown
        frame = {} if column == GEOMETRY_IN_DEGREES_COLUMN else {"crs": None}
        about[column] = {"encoding": "WKB", "geometry_types": [shape.kind], **frame}
    geo = {"version": "1.1.0", "primary_column": next(iter(shapes)), "columns": about}
    return rows.replace_schema_metadata({**metadata, b"geo": json.dumps(geo, sort_keys=True).encode()})


def without_geometry(rows: pa.Table) -> pa.Table:
    """Return the rows without the columns that `with_geometry` added."""
    return rows.drop_columns(
        [name for name in (GEOMETRY_IN_METRES_COLUMN, GEOMETRY_IN_DEGREES_COLUMN) if name in rows.column_names]
    )


def _points_on_map(rows: pa.Table) -> Geometries:
    return _points_from_columns(rows, "x_m", "y_m")


def _points_on_earth(rows: pa.Table) -> Geometries:
    return _points_from_columns(rows, "lon", "lat")


def _points_from_columns(rows: pa.Table, x: str, y: str) -> Geometries:
    xy = np.column_stack([floats(rows[x]), floats(rows[y])])
    points = np.full(len(xy), None, object)
    has_place = np.isfinite(xy).all(axis=1)
    points[has_place] = shapely.points(xy[has_place])
    return points


def _danger_space_polygons(rows: pa.Table) -> Geometries:
    return _polygons(*_points_and_offsets(rows, ""))


def _lane_polygons(rows: pa.Table) -> Geometries:
    """Return the area between the bounds as a closed ring: along the left bound, then back along the right bound."""
    left, left_offsets = _points_and_offsets(rows, "left_")
    right, right_offsets = _points_and_offsets(rows, "right_")
    begins = np.flatnonzero(np.diff(left_offsets))
    begin = left[left_offsets[begins]]
    row = np.concatenate([_row_of_points(left_offsets), _row_of_points(right_offsets), begins])
    place = np.concatenate(
        [np.arange(len(left)), -np.arange(len(right)) + len(left) + len(right), np.full(len(begin), np.inf)]
    )
    order = np.lexsort((place, row))
    offsets = np.concatenate([[0], np.cumsum(np.bincount(row, minlength=rows.num_rows))])
    return _polygons(np.concatenate([left, right, begin])[order], offsets)


def _actor_box_areas(rows: pa.Table) -> Geometries:
    """Return the areas of the boxes of each scene's actors in plan view; actors of unknown size are omitted."""
    actors = rows["actors"].combine_chunks()
    if isinstance(actors, pa.ChunkedArray):  # no rows
        return np.empty(0, object)
    row = _row_of_points(np.asarray(actors.offsets) - actors.offsets[0].as_py())
    x, y, yaw, length, width = (
        floats(actors.flatten().field(name)) for name in ("x_m", "y_m", "yaw_rad", "length_m", "width_m")
    )
    along, across = np.array([1, -1, -1, 1, 1]) * length[:, None] / 2, np.array([1, 1, -1, -1, 1]) * width[:, None] / 2
    cos, sin = np.cos(yaw)[:, None], np.sin(yaw)[:, None]
    corners = np.stack([x[:, None] + along * cos - across * sin, y[:, None] + along * sin + across * cos], axis=-1)
    has_corners = np.isfinite(corners).all(axis=(1, 2))
    boxes = shapely.polygons(corners[has_corners])
    covered = _geometries_by_row(shapely.multipolygons, boxes, row[has_corners], rows.num_rows)
    overlapping = ~shapely.is_valid(covered) & ~shapely.is_missing(covered)  # two actors are in contact
    covered[overlapping] = shapely.buffer(covered[overlapping], 0)
    is_polygon = shapely.get_type_id(covered) == shapely.GeometryType.POLYGON
    covered[is_polygon] = shapely.multipolygons(covered[is_polygon][:, None])
    return covered


def _track_lines(rows: pa.Table) -> Geometries:
    """Return one line per row through its known positions; a single position gives a line of zero length."""
    xy, row = _known_points_and_their_rows(rows)
    single = np.bincount(row, minlength=rows.num_rows)[row] == 1
    return _geometries_by_row(
        shapely.linestrings, np.repeat(xy, 1 + single, axis=0), np.repeat(row, 1 + single), rows.num_rows
    )


def _judged_points(rows: pa.Table) -> Geometries:
    xy, row = _known_points_and_their_rows(rows)
    return _geometries_by_row(shapely.multipoints, shapely.points(xy), row, rows.num_rows)


def _geometries_by_row(
    make: Callable[..., Geometries], parts: NDArray[Any], row: NDArray[np.int64], n: int
) -> Geometries:
    """Return the geometries (n) that `make` builds from the parts of each row; None for a row without parts.

    With no parts at all, shapely would return an empty array, even with `out`.
    """
    shapes = np.full(n, None, object)
    return np.asarray(make(parts, indices=row, out=shapes)) if len(parts) else shapes


def _known_points_and_their_rows(rows: pa.Table) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Return the known positions, and the row of each position."""
    xy, offsets = _points_and_offsets(rows, "")
    has_place = np.isfinite(xy).all(axis=1)
    return xy[has_place], _row_of_points(offsets)[has_place]


def _points_and_offsets(rows: pa.Table, prefix: str) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Return the points of all rows' lists of coordinates, and the offsets at which the points of each row begin."""
    columns = [rows[f"{prefix}{axis}_m"] for axis in "xy"]
    lengths = np.asarray(pa.compute.list_value_length(columns[0]).fill_null(0), np.int64)
    xy = np.column_stack([floats(pa.compute.list_flatten(column)) for column in columns])
    return xy, np.concatenate([[0], np.cumsum(lengths)])


def _polygons(xy: NDArray[np.float64], offsets: NDArray[np.int64]) -> Geometries:
    """Return a polygon for each ring; None for a ring with too few or unknown points."""
    n_points, row = np.diff(offsets), _row_of_points(offsets)
    n_unknown = np.bincount(row[~np.isfinite(xy).all(axis=1)], minlength=len(n_points))
    whole = (n_points >= _LEAST_RING_POINTS) & (n_unknown == 0)
    polygons = np.full(len(n_points), None, object)
    if whole.any():
        rings = np.concatenate([[0], np.cumsum(n_points[whole])]), np.arange(whole.sum() + 1)
        polygons[whole] = shapely.from_ragged_array(shapely.GeometryType.POLYGON, xy[whole[row]], rings)
    return polygons


def _row_of_points(offsets: NDArray[np.int64]) -> NDArray[np.int64]:
    return np.repeat(np.arange(len(offsets) - 1), np.diff(offsets))


GEOMETRIES_OF_TABLE: Final[Mapping[str, Mapping[str, GeometryColumn]]] = {
    "finding": {
        GEOMETRY_IN_METRES_COLUMN: GeometryColumn("Point", "the ego at the worst step", _points_on_map),
        GEOMETRY_IN_DEGREES_COLUMN: GeometryColumn(
            "Point", "the same, in degrees of longitude and latitude (WGS 84)", _points_on_earth
        ),
    },
    "drive": {GEOMETRY_IN_DEGREES_COLUMN: GeometryColumn("Point", "lon and lat", _points_on_earth)},
    "scene": {
        GEOMETRY_IN_METRES_COLUMN: GeometryColumn(
            "MultiPolygon", "the ground under the boxes of the actors at the moment", _actor_box_areas
        )
    },
    "lane_shape": {GEOMETRY_IN_METRES_COLUMN: GeometryColumn("Polygon", "the lane between its bounds", _lane_polygons)},
    "danger_space": {GEOMETRY_IN_METRES_COLUMN: GeometryColumn("Polygon", "the danger space", _danger_space_polygons)},
    "track": {GEOMETRY_IN_METRES_COLUMN: GeometryColumn("LineString", "the way", _track_lines)},
    "course": {GEOMETRY_IN_METRES_COLUMN: GeometryColumn("MultiPoint", "the ego at the judged steps", _judged_points)},
}
"""Table of the schema -> column in the file -> its geometry. Viewers show the first column."""
