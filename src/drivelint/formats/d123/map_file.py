"""Finds the map of a 123D log: `map.arrow` beside its files, or the map of its location, which many logs share."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import msgspec
import pyarrow as pa

from drivelint.drive.trace import QualityFinding
from drivelint.errors import MapError
from drivelint.formats.d123 import facts
from drivelint.formats.d123.arrow_files import METADATA_KEY
from drivelint.formats.d123.map_layers import LIGHT_LANES_KEY, Intersection, LaneGroup, MapLayers
from drivelint.formats.map_registry import read_source
from drivelint.receipts.events import report_searched_path
from drivelint.road.quality import MapQuality

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from drivelint.formats.d123.arrow_files import LogInfo

LOG_MAP_FILE: Final = "map.arrow"


def find_map(
    folder: Path, info: LogInfo, light_lanes: Sequence[int]
) -> tuple[bytes | None, list[QualityFinding], list[str]]:
    """Return the log's map with `light_lanes` in its metadata (None: there is no usable map), findings and notes.

    py123d has a data root: `logs/<split>/<log>` and, for locations that many logs share, `maps/<data set>/<data set>_<location>.arrow`.
    `light_lanes`: the lanes for which the log has states of lights.
    """
    shared = shared_map_path(folder, info)
    path = next(
        (path for path in (folder / LOG_MAP_FILE, shared) if path is not None and report_searched_path(path).is_file()),
        None,
    )
    if path is None:
        looked = " nor at ".join(str(place) for place in (folder / LOG_MAP_FILE, shared) if place is not None)
        return None, [], [f"the log has no map: no file at {looked}: give a map with --map"]
    try:
        source = read_source(path)
        layers = MapLayers.of_source(source)
    except MapError as error:
        return None, [QualityFinding.unusable_map(f"the log's own map cannot be used: {error}")], []
    if not layers.n_objects("LANE"):
        return None, [QualityFinding.unusable_map(f"the log's own map cannot be used: {path.name} has no lanes")], []
    notes = [] if path.name == LOG_MAP_FILE else [f"the map of the place is {path.name} under {path.parent.parent}"]
    if set(light_lanes) <= _signalled_lanes(layers):
        return source.content, [], notes
    return _map_with_light_lanes(layers, light_lanes), [], notes


def shared_map_path(folder: Path, info: LogInfo) -> Path | None:
    """Return the path of the shared map of a log's location, below its data root; None: the log names no location."""
    names = (info.dataset, info.location)
    if any(not name or name in {".", ".."} or "/" in name or "\\" in name or "\0" in name for name in names):
        return None
    root = folder.resolve().parents
    return root[2] / "maps" / info.dataset / f"{info.dataset}_{info.location}.arrow" if len(root) > 2 else None


def _signalled_lanes(layers: MapLayers) -> set[int]:
    """Return the lanes in intersections that the map marks as having lights, as `lanes.py` does."""
    quality = MapQuality()  # not used: the map's reader reports unreadable objects
    intersections = layers.features("INTERSECTION", Intersection, quality)
    signalled = {
        name
        for name, intersection in intersections.items()
        if intersection.intersection_type == facts.SIGNALLED_INTERSECTION_TYPE
    }
    return {
        lane
        for group in layers.features("LANE_GROUP", LaneGroup, quality).values()
        if group.intersection_id in signalled
        for lane in group.lane_ids or ()
    }


def _map_with_light_lanes(layers: MapLayers, light_lanes: Sequence[int]) -> bytes:
    """Return the content of a map file with `light_lanes` in its metadata."""
    header = {METADATA_KEY: layers.packed_header, LIGHT_LANES_KEY: msgspec.msgpack.encode(sorted(light_lanes))}
    rows = layers.rows.replace_schema_metadata(header)
    sink = pa.BufferOutputStream()
    with pa.ipc.new_file(sink, rows.schema) as writer:
        writer.write_table(rows)
    return bytes(memoryview(sink.getvalue()))
