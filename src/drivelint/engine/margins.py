"""Writes the margins of all batches to one Parquet file, in row groups of fixed size."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import duckdb
import pyarrow as pa
import pyarrow.parquet as pq

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from drivelint.engine.memory import MemoryLimit

ROW_GROUP_ROWS: Final = 1 << 20
"""The rows of a row group, and the most in memory at once: a drive of many egos has too many."""
_SORT_COLUMNS: Final = "drive_id, ego_id, rule_id, profile NULLS FIRST, object_id NULLS FIRST, ref_id NULLS FIRST, t_ns"
_SELECTED_COLUMNS: Final = (
    "* REPLACE (drive_id::VARCHAR AS drive_id, ego_id::VARCHAR AS ego_id, object_id::VARCHAR AS object_id)"
)


class MarginFile:
    """Appends the table `margin` of each batch to a Parquet file at `path`."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._file: pq.ParquetWriter | None = None
        self._waiting: list[pa.RecordBatch] = []

    def add(self, con: duckdb.DuckDBPyConnection, memory: MemoryLimit) -> None:
        """Append the sorted margins of the batch that was just judged."""
        if self._file is None:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            schema = con.execute(f"SELECT {_SELECTED_COLUMNS} FROM margin LIMIT 0").to_arrow_table().schema
            self._file = pq.ParquetWriter(self.path, schema, compression="zstd")
        for block in _sorted_margin_batches(con, memory):
            self._waiting.append(block)
            while sum(rows.num_rows for rows in self._waiting) >= ROW_GROUP_ROWS:
                self._write_row_group()

    def close(self) -> None:
        """Write the waiting rows, and finish the file."""
        if self._file:
            self._write_row_group()
            self._file.close()

    def _write_row_group(self) -> None:
        """Write one row group of the waiting rows, or all rows if they are fewer."""
        if self._file and self._waiting:
            rows = pa.Table.from_batches(self._waiting)
            # as one chunk: the pages of the file would otherwise depend on the chunks
            self._file.write_table(rows.slice(0, ROW_GROUP_ROWS).combine_chunks(), row_group_size=ROW_GROUP_ROWS)
            self._waiting = rows.slice(ROW_GROUP_ROWS).to_batches()


def _sorted_margin_batches(con: duckdb.DuckDBPyConnection, memory: MemoryLimit) -> Iterator[pa.RecordBatch]:
    sent = 0
    while True:
        try:
            rows = con.execute(f"SELECT {_SELECTED_COLUMNS} FROM margin ORDER BY {_SORT_COLUMNS} OFFSET ?", [sent])
            for block in rows.to_arrow_reader(ROW_GROUP_ROWS):
                yield block
                sent += block.num_rows
        except (duckdb.OutOfMemoryException, OSError):  # Arrow's reader raises OSError for every error of the database
            if not memory.raise_to_machine_limit():
                raise
        else:
            return
