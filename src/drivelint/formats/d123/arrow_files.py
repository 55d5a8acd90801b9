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
"""The names of the files, without their suffix. In the first file, columns of these names contain row numbers of the other files."""
METADATA_KEY: Final = b"metadata"


class LogInfo(NamedTuple):
    """The metadata of a log: data set, location (None: not stated) and version of py123d."""

    dataset: str
    location: str | None
    version: str


class ModalityFile(NamedTuple):
    """One file of a log: its columns by the part of their name after the dot, and its metadata."""

    path: Path
    columns: dict[str, pa.Array]
    metadata: dict[str, Any]

    @property
    def n_rows(self) -> int:
        """The number of rows."""
        return len(self.columns["timestamp_us"])


def file_path(folder: Path, name: str) -> Path:
    """Return the path of a file of a log."""
    return folder / f"{name}.arrow"


def read_modality(folder: Path, name: str, types: Mapping[str, pa.DataType]) -> ModalityFile | None:
    """Return a file of a log with the given columns and `timestamp_us`; None if the log does not have the file.

    Errors: `TraceError` for a damaged file, a column that is missing or of another type, and a row without a time.
    """
    path = file_path(folder, name)
    if not path.is_file():
        return None
    type_by_column = {"timestamp_us": pa.int64(), **types}
    rows = ipc.table(path, [f"{name}.{column}" for column in type_by_column])
    columns = {column: _cast_column(path, rows, f"{name}.{column}", kind) for column, kind in type_by_column.items()}
    if columns["timestamp_us"].null_count:
        raise TraceError(f"{path}: {name}.timestamp_us has rows without a time: convert the log again")
    return ModalityFile(path, columns, schema_metadata(path, rows.schema))


def frame_table_columns_and_log_info(folder: Path) -> tuple[dict[str, pa.Array], LogInfo]:
    """Return the columns of the table of frames, and the metadata of the log.

    The columns are `timestamp_us` and, for each other file, the number of its row in the frame (NULL: the file has no row for it).
    Errors: as `read_modality`, and for a version that is not read.
    """
    path = file_path(folder, SYNC)
    time = f"{SYNC}.timestamp_us"
    rows = ipc.table(path, [time, EGO_STATE], [BOXES, LIGHTS])
    columns = {name.removeprefix(f"{SYNC}."): _cast_column(path, rows, name, pa.int64()) for name in rows.schema.names}
    return columns, log_info(path, schema_metadata(path, rows.schema))


def log_info(path: Path | str, entries: Mapping[str, Any]) -> LogInfo:
    """Return data set, location and version of a log or map. Errors: `TraceError` for a version that is not read."""
    version, location = str(entries.get("version", "unknown")), entries.get("location")
    if not facts.is_supported_version(version):
        raise TraceError(
            f"{path}: py123d {version} wrote the file, but only the versions {facts.SUPPORTED_VERSIONS[0]} to "
            f"{facts.SUPPORTED_VERSIONS[-1]} are supported: convert the log again with one of these"
        )
    return LogInfo(str(entries.get("dataset", "")), None if location is None else str(location), version)


def schema_metadata(path: Path | str, schema: pa.Schema) -> dict[str, Any]:
    """Return the metadata of a schema. Errors: `TraceError` if they are missing or not readable."""
    packed = (schema.metadata or {}).get(METADATA_KEY)
    if packed is None:
        raise TraceError(f"{path}: its schema has no {METADATA_KEY.decode()!r}: py123d did not write this file")
    try:
        return msgspec.msgpack.decode(packed, type=dict[str, Any])
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        raise TraceError(
            f"{path}: the metadata of its schema cannot be read: {error}: convert the log again"
        ) from error


def _cast_column(path: Path, rows: pa.Table, name: str, arrow_type: pa.DataType) -> pa.Array:
    column = rows[name]
    if column.type != arrow_type:
        try:
            column = column.cast(arrow_type)
        except pa.ArrowException as error:
            raise TraceError(
                f"{path}: column {name!r} is {column.type}, not {arrow_type}: convert the log again"
            ) from error
    return column.combine_chunks() if isinstance(column, pa.ChunkedArray) else column


def vectors(array: pa.FixedSizeListArray) -> Floats:
    """Return lists of k numbers as an array (n, k), with NaN for NULL lists and NULL numbers."""
    width = array.type.list_size
    numbers = array.values.slice(array.offset * width, len(array) * width)
    rows = np.asarray(numbers.to_numpy(zero_copy_only=False), np.float64).reshape(-1, width)
    if array.null_count:
        rows = np.where(is_null(array)[:, None], np.nan, rows)
    return rows


def integers(array: pa.Array) -> NDArray[np.int64]:
    """Return a column as integers, with -1 for NULL."""
    filled = pc.fill_null(array, -1) if array.null_count else array
    return np.asarray(filled.to_numpy(zero_copy_only=False), np.int64)


def is_null(array: pa.Array) -> Mask:
    """Return which values are NULL."""
    return np.asarray(pc.is_null(array).to_numpy(zero_copy_only=False), np.bool_)


def list_lengths(array: pa.ListArray) -> NDArray[np.int64]:
    """Return the number of values of each list, -1: NULL."""
    return integers(pc.list_value_length(array))
