"""The Arrow files of 123D: their columns, the metadata of their schemas, and the version that wrote them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, NamedTuple

import msgspec
import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from drivelint.errors import TraceError
from drivelint.formats.d123 import facts
from drivelint.formats.tables import ipc

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from numpy.typing import NDArray

    from drivelint.arrays import Floats, Mask

SYNC: Final = "sync"
EGO_STATE: Final = "ego_state_se3"
BOXES: Final = "box_detections_se3"
LIGHTS: Final = "traffic_light_detections"
"""The names of the files, without their ending, and of the columns of the first that point into the others."""
METADATA_KEY: Final = b"metadata"


class LogInfo(NamedTuple):
    """The metadata of a log: data set, place (None: not stated) and version of py123d."""

    dataset: str
    location: str | None
    version: str


class Modality(NamedTuple):
    """One of a log's files: its columns by the name behind the dot, and its metadata."""

    path: Path
    columns: dict[str, pa.Array]
    metadata: dict[str, Any]

    @property
    def n(self) -> int:
        """Number of rows."""
        return len(self.columns["timestamp_us"])


def path_of(folder: Path, name: str) -> Path:
    """Return the path of one of a log's files."""
    return folder / f"{name}.arrow"


def modality(folder: Path, name: str, types: Mapping[str, pa.DataType]) -> Modality | None:
    """Read the given columns of a log's file, or None where it has no such file; `timestamp_us` is always read.

    Errors: `TraceError` for a damaged file, and a column that is missing, of another type or, of times, not always given.
    """
    path = path_of(folder, name)
    if not path.is_file():
        return None
    wanted = {"timestamp_us": pa.int64(), **types}
    rows = ipc.table(path, [f"{name}.{column}" for column in wanted])
    columns = {column: _cast(path, rows, f"{name}.{column}", kind) for column, kind in wanted.items()}
    if columns["timestamp_us"].null_count:
        raise TraceError(f"{path}: {name}.timestamp_us has rows without a time: convert the log again")
    return Modality(path, columns, metadata(path, rows.schema))


def sync_table(folder: Path) -> tuple[dict[str, pa.Array], LogInfo]:
    """Return the columns of the table of frames, and the metadata of the log.

    The columns are `timestamp_us` and, for each other file that there is, the number of its row, NULL: it has none in that frame.
    Errors: as `modality`, and for a version that is not read.
    """
    path = path_of(folder, SYNC)
    time = f"{SYNC}.timestamp_us"
    rows = ipc.table(path, [time, EGO_STATE], [BOXES, LIGHTS])
    columns = {name.removeprefix(f"{SYNC}."): _cast(path, rows, name, pa.int64()) for name in rows.schema.names}
    return columns, log_info(path, metadata(path, rows.schema))


def log_info(path: Path | str, entries: Mapping[str, Any]) -> LogInfo:
    """Return data set, place and version of a log or map. Errors: `TraceError` for a version that is not read."""
    version, location = str(entries.get("version", "unknown")), entries.get("location")
    if not facts.is_read(version):
        raise TraceError(
            f"{path}: version {version} of py123d wrote it, and {facts.VERSIONS[0]} to {facts.VERSIONS[-1]} are read: convert it "
            "again with one of these"
        )
    return LogInfo(str(entries.get("dataset", "")), None if location is None else str(location), version)


def metadata(path: Path | str, schema: pa.Schema) -> dict[str, Any]:
    """Return the metadata of a schema. Errors: `TraceError` where that is missing or not readable."""
    packed = (schema.metadata or {}).get(METADATA_KEY)
    if packed is None:
        raise TraceError(f"{path}: its schema has no {METADATA_KEY.decode()!r}: it was not written by py123d")
    try:
        return msgspec.msgpack.decode(packed, type=dict[str, Any])
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        raise TraceError(
            f"{path}: the metadata of its schema cannot be read: {error}: convert the log again"
        ) from error


def _cast(path: Path, rows: pa.Table, name: str, kind: pa.DataType) -> pa.Array:
    column = rows[name]
    if column.type != kind:
        try:
            column = column.cast(kind)
        except pa.ArrowException as error:
            raise TraceError(f"{path}: column {name!r} is {column.type}, not {kind}: convert the log again") from error
    return column.combine_chunks() if isinstance(column, pa.ChunkedArray) else column


def vectors(array: pa.FixedSizeListArray) -> Floats:
    """Return rows of numbers, (n, k), NaN where the row or one of its numbers is NULL."""
    width = array.type.list_size
    numbers = array.values.slice(array.offset * width, len(array) * width)
    found = np.asarray(numbers.to_numpy(zero_copy_only=False), np.float64).reshape(-1, width)
    if array.null_count:
        found = np.where(is_null(array)[:, None], np.nan, found)
    return found


def integers(array: pa.Array) -> NDArray[np.int64]:
    """Return whole numbers, -1 for NULL."""
    filled = pc.fill_null(array, -1) if array.null_count else array
    return np.asarray(filled.to_numpy(zero_copy_only=False), np.int64)


def is_null(array: pa.Array) -> Mask:
    """Say which values are NULL."""
    return np.asarray(pc.is_null(array).to_numpy(zero_copy_only=False), np.bool_)


def lengths(array: pa.ListArray) -> NDArray[np.int64]:
    """Return the number of values of each list, -1: NULL."""
    return integers(pc.list_value_length(array))
