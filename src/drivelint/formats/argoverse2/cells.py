"""Converts columns of Argoverse's tables to arrays."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from drivelint.drive.lost_time import times_of_lost_rows
from drivelint.drive.trace import QualityFinding
from drivelint.errors import TraceError
from drivelint.formats.tables.parquet import column

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from drivelint.arrays import Floats, Mask, Times
    from drivelint.drive.trace import LostTime


def cast_column(path: Path, table: pa.Table, name: str, arrow_type: pa.DataType) -> pa.Array:
    """Return a column cast to a type. Errors: `TraceError` if a value cannot be cast."""
    values = column(table, name)
    try:
        return values.cast(arrow_type)
    except pa.ArrowException as error:
        raise TraceError(
            f"{path}: column {name!r} is {values.type}, not {arrow_type}: {' '.join(str(error).split())}: get the log again"
        ) from error


def number_columns(path: Path, table: pa.Table, names: Iterable[str]) -> dict[str, Floats]:
    """Return columns of numbers, with NaN for NULL. Errors: `TraceError` if a value is not a number."""
    columns = {}
    for name in names:
        values = pc.fill_null(cast_column(path, table, name, pa.float64()), float("nan"))
        columns[name] = np.asarray(values.to_numpy(zero_copy_only=False), np.float64)
    return columns


def integer_column(path: Path, table: pa.Table, name: str) -> tuple[Times, Mask]:
    """Return a column of integers, with 0 for NULL, and which rows are not NULL. Errors: `TraceError` if a value is not an integer."""
    values = cast_column(path, table, name, pa.int64())
    return pc.fill_null(values, 0).to_numpy(zero_copy_only=False), values.is_valid().to_numpy(zero_copy_only=False)


def rows_with_track_and_time(
    path: Path, rows: pa.Table, track_column: str, t_ns: Times, has_time: Mask
) -> tuple[Mask, list[QualityFinding], list[LostTime]]:
    """Return which rows have a track (`track_column`) and a time (`has_time`), a finding on the other rows, and the times of these."""
    ids = cast_column(path, rows, track_column, pa.string())
    lost_rows = ~has_time | pc.equal(pc.fill_null(ids, ""), "").to_numpy(zero_copy_only=False)
    n = int(lost_rows.sum())
    if not n:
        return ~lost_rows, [], []
    description = f"{path.name}: rows without {track_column} or time"
    finding = QualityFinding("dropped_row", "error", f"{description}: {n}: they are not judged", n)
    return ~lost_rows, [finding], times_of_lost_rows(t_ns, has_time, lost_rows, description)
