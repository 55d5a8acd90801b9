"""Finds the map of a 123D log: `map.arrow` beside its files, or that of its place, which many logs share."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import msgspec
import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from drivelint.drive.trace import QualityFinding
from drivelint.errors import TraceError
from drivelint.formats.d123 import facts
from drivelint.formats.d123.arrow_files import METADATA_KEY, log_info, metadata
from drivelint.formats.tables import ipc

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from drivelint.formats.d123.arrow_files import LogInfo

OWN_MAP: Final = "map.arrow"
COLUMNS: Final = {"object_id": pa.int64(), "map_layer": pa.int8(), "features": pa.binary(), "wkb": pa.binary()}
LIGHT_LANES_KEY: Final = b"drivelint.light_lanes"
"""Metadata that we add to a log's own map: the lanes for which the log has states of lights."""


def find_map(folder: Path, info: LogInfo, lit: Sequence[int]) -> tuple[bytes | None, list[QualityFinding], list[str]]:
    """Return the log's map, its lanes with lights noted in it, with findings and notes; None: there is none that can be used.

    py123d has a data root: `logs/<split>/<log>` and, for places that many logs share, `maps/<data set>/<data set>_<location>.arrow`.
    `lit`: the lanes for which the log has states of lights.
    """
    shared = shared_map(folder, info)
    path = next((path for path in (folder / OWN_MAP, shared) if path is not None and path.is_file()), None)
    if path is None:
        looked = " nor at ".join(str(each) for each in (folder / OWN_MAP, shared) if each is not None)
        return None, [], [f"the log has no map: there is none at {looked}: give one with --map"]
    try:
        rows = ipc.table(path, COLUMNS)
        log_info(path, metadata(path, rows.schema))
        is_lane = pc.equal(rows["map_layer"].cast(pa.int64()), facts.LAYERS["LANE"])
    except (TraceError, pa.ArrowException) as error:
        return None, [QualityFinding.unusable_map(f"the log's own map cannot be used: {error}")], []
    if not pc.any(is_lane).as_py():
        return None, [QualityFinding.unusable_map(f"the log's own map cannot be used: {path.name} has no lanes")], []
    notes = [] if path.name == OWN_MAP else [f"the map of the place is {path.name} under {path.parent.parent}"]
    if set(lit) <= _signalled_lanes(rows):
        return path.read_bytes(), [], notes
    return _with_light_lanes(rows, lit), [], notes


def shared_map(folder: Path, info: LogInfo) -> Path | None:
    """Return where the map of a log's place would lie, by its data root; None: the log names no place."""
    names = (info.dataset, info.location)
    if any(not name or name in {".", ".."} or "/" in name or "\\" in name or "\0" in name for name in names):
        return None
    root = folder.resolve().parents
    return root[2] / "maps" / info.dataset / f"{info.dataset}_{info.location}.arrow" if len(root) > 2 else None


def _signalled_lanes(rows: pa.Table) -> set[int]:
    """Return the lanes that the map says to have lights: see `lanes.py`."""
    layers = np.asarray(rows["map_layer"].to_numpy(), np.int64)
    groups = _features(rows, layers == facts.LAYERS["LANE_GROUP"])
    crossings = _features(rows, layers == facts.LAYERS["INTERSECTION"])
    signalled = {name for name, said in crossings if said.get("intersection_type") == facts.SIGNALLED}
    found: set[int] = set()
    for _, said in groups:
        if said.get("intersection_id") in signalled:
            found.update(said.get("lane_ids") or ())
    return found


def _features(rows: pa.Table, chosen: np.ndarray) -> list[tuple[int, dict[str, Any]]]:
    some = rows.filter(pa.array(chosen))
    try:
        return [
            (name, msgspec.msgpack.decode(packed, type=dict[str, Any]))
            for name, packed in zip(some["object_id"].to_pylist(), some["features"].to_pylist(), strict=True)
        ]
    except (msgspec.DecodeError, TypeError):  # the map's reader says which
        return []


def _with_light_lanes(rows: pa.Table, lit: Sequence[int]) -> bytes:
    """Return the map as a file of its own, which says for which lanes there are lights."""
    said = {METADATA_KEY: rows.schema.metadata[METADATA_KEY], LIGHT_LANES_KEY: msgspec.msgpack.encode(sorted(lit))}
    rows = rows.replace_schema_metadata(said)
    sink = pa.BufferOutputStream()
    with pa.ipc.new_file(sink, rows.schema) as writer:
        writer.write_table(rows)
    return bytes(sink.getvalue())
