"""The objects of a 123D map by their layers. A row has the object's number, its features (MessagePack with arrays) and outline (WKB)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, TypeVar

import msgspec
import numpy as np
import pyarrow as pa
import shapely

from drivelint.errors import MapError, TraceError
from drivelint.formats.d123 import facts
from drivelint.formats.d123.arrow_files import METADATA_KEY, log_info, schema_metadata

if TYPE_CHECKING:
    from drivelint.arrays import Floats
    from drivelint.road.map_reader import MapSource
    from drivelint.road.quality import MapQuality

T = TypeVar("T")
_MAX_BOUND_LENGTH_M: Final = 100_000.0  # a longer bound is a mistake
MAP_FILE_COLUMNS: Final = {"object_id": pa.int64(), "map_layer": pa.int8(), "features": pa.binary(), "wkb": pa.binary()}
LIGHT_LANES_KEY: Final = b"drivelint.light_lanes"
"""Metadata that drivelint adds to the map of a log: the lanes for which the log has states of lights."""


class Lane(msgspec.Struct):
    """Features of a lane; other features are ignored."""

    left_boundary: Any
    right_boundary: Any
    lane_group_id: int | None = None
    lane_type: int = 0
    left_lane_id: int | None = None
    right_lane_id: int | None = None
    predecessor_ids: list[int] | None = None
    successor_ids: list[int] | None = None
    speed_limit_mps: float | None = None


class LaneGroup(msgspec.Struct):
    """Features of a group of lanes."""

    lane_ids: list[int] | None = None
    intersection_id: int | None = None


class Intersection(msgspec.Struct):
    """Features of an intersection."""

    intersection_type: int = 0
    lane_group_ids: list[int] | None = None


class RoadLineFeatures(msgspec.Struct):
    """Features of a road line."""

    road_line_type: int


class MapLayers:
    """The rows and the metadata of a map. `name`: the name of the map in errors."""

    def __init__(self, name: str, rows: pa.Table) -> None:
        """Take a table with the columns `MAP_FILE_COLUMNS`.

        Errors: `TraceError` if it is not a map of 123D, or of a version that is not read.
        """
        if lacking := [column for column in MAP_FILE_COLUMNS if column not in rows.schema.names]:
            raise TraceError(f"{name}: no column {', '.join(lacking)}: this is not a map of 123D")
        self.header = schema_metadata(name, rows.schema)
        self.info = log_info(name, self.header)
        try:
            self.rows = (
                rows.select(list(MAP_FILE_COLUMNS)).cast(pa.schema(list(MAP_FILE_COLUMNS.items()))).combine_chunks()
            )
        except pa.ArrowException as error:
            raise TraceError(
                f"{name}: its columns are not those of a map of 123D: {error}: convert it again"
            ) from error
        if self.rows["object_id"].null_count or self.rows["map_layer"].null_count:
            raise TraceError(f"{name}: an object has no number or no layer: convert it again")
        self._layer = np.asarray(self.rows["map_layer"].to_numpy(), np.int64)
        self.packed_header = rows.schema.metadata[METADATA_KEY]
        self.light_lanes = _lanes_with_light_states(name, rows.schema)

    @classmethod
    def of_source(cls, source: MapSource) -> MapLayers:
        """Return the layers of a map file. Errors: `MapError`."""
        try:
            with pa.ipc.open_file(pa.BufferReader(source.content)) as file:
                return cls(f"map {source.name}", file.read_all())
        except TraceError as error:
            raise MapError(str(error)) from error
        except pa.ArrowException as error:
            why = " ".join(str(error).split())
            raise MapError(f"map {source.name} is not readable in Arrow's file format: {why}: copy it again") from error

    def n_objects(self, layer: str) -> int:
        """Return the number of objects of a layer."""
        return int((self._layer == facts.LAYER_NUMBERS[layer]).sum())

    @property
    def unknown_layer_numbers(self) -> list[int]:
        """The numbers of layers that 123D does not have."""
        return sorted(set(self._layer.tolist()) - set(facts.LAYER_NUMBERS.values()))

    def features(self, layer: str, kind: type[T], quality: MapQuality) -> dict[int, T]:
        """Return the features of each object of a layer, in the order of the map; unreadable objects are reported and left out."""
        some = self._rows_of_layer(layer)
        feature_by_id: dict[int, T] = {}
        decoder = msgspec.msgpack.Decoder(kind)
        for name, packed in zip(some["object_id"].to_pylist(), some["features"].to_pylist(), strict=True):
            if name in feature_by_id:
                self._report_left_out(layer, name, "another has the same number", quality)
                continue
            try:
                feature_by_id[name] = decoder.decode(packed or b"")
            except (msgspec.MsgspecError, UnicodeDecodeError) as error:
                self._report_left_out(layer, name, f"its features cannot be read: {error}", quality)
        return feature_by_id

    def outlines(self, layer: str, quality: MapQuality) -> dict[int, Floats]:
        """Return the points, (n, 2) or (n, 3), of the outline of each object of a layer; objects without one are reported and left out."""
        some = self._rows_of_layer(layer)
        shapes = shapely.from_wkb(some["wkb"].to_pylist(), on_invalid="ignore")
        outline_by_id = {}
        for name, shape in zip(some["object_id"].to_pylist(), shapes, strict=True):
            line = shape.exterior if isinstance(shape, shapely.Polygon) else shape
            if isinstance(line, shapely.LineString) and not line.is_empty:
                outline_by_id[name] = shapely.get_coordinates(line, include_z=line.has_z)
            else:
                self._report_left_out(layer, name, "it has no outline", quality)
        return outline_by_id

    def _rows_of_layer(self, layer: str) -> pa.Table:
        return self.rows.filter(pa.array(self._layer == facts.LAYER_NUMBERS[layer]))

    @staticmethod
    def _report_left_out(layer: str, object_id: int, why: str, quality: MapQuality) -> None:
        check = "invalid_lane" if layer == "LANE" else "invalid_object"
        noun = "lanelet" if layer == "LANE" else layer.lower().replace("_", " ")
        quality.add(check, "error", str(object_id), f"{noun} {object_id} is left out: {why}")


def decode_points(value: Any) -> Floats:
    """Return the points, (n, 2) or (n, 3), of an encoded array among features. Errors: `ValueError` if it is not an array of points."""
    try:
        kind = np.dtype(value[b"dtype"])
        if kind.kind not in "fiu":
            raise ValueError(f"its points are {kind}")
        points = np.asarray(np.frombuffer(value[b"data"], kind).reshape(value[b"shape"]), np.float64)
    except (KeyError, TypeError) as error:
        raise ValueError(f"a bound is no array: {error!r}") from error
    if points.ndim != 2 or points.shape[1] not in {2, 3} or len(points) < 2:
        raise ValueError(f"the points of a bound have the shape {points.shape}")
    length_m = float(np.hypot(*np.diff(points[:, :2], axis=0).T).sum())
    if not length_m < _MAX_BOUND_LENGTH_M:
        raise ValueError(f"a bound is {length_m / 1000:.0f} km long")
    return points


def _lanes_with_light_states(name: str, schema: pa.Schema) -> frozenset[int]:
    """Return the lanes for which the log of this map has states of lights."""
    packed = schema.metadata.get(LIGHT_LANES_KEY)
    try:
        return frozenset() if packed is None else frozenset(msgspec.msgpack.decode(packed, type=list[int]))
    except msgspec.MsgspecError as error:
        raise TraceError(f"{name}: {LIGHT_LANES_KEY.decode()} in its metadata is no list of lanes: {error}") from error
