"""Reads CSV and Parquet tables column by column through one interface."""

from __future__ import annotations

import codecs
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from drivelint.errors import TraceError
from drivelint.formats.tables import parquet
from drivelint.formats.tables.mapping import TIME_UNITS

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    import polars as pl

    from drivelint.arrays import Floats, Indices, Mask, Times
    from drivelint.formats.tables.mapping import TextLayout

MAX_NS = 2.0**63
TEXT_BLOCK_BYTES = 1 << 20
_MOST_LISTED_PLACES = 5
"""A message lists at most this many places."""


class CsvSheet:
    """A CSV file in UTF-8. Every cell is first read as text, so that no type is guessed and no invalid cell is missed."""

    def __init__(self, path: Path, layout: TextLayout) -> None:
        """Read the header. Errors: `TraceError` if there is none."""
        self._path, self._layout = path, layout
        self.bad_lines: list[int] = []  # lines with a wrong number of cells, which are left out of the rows
        self.zeros_at: int | None = None
        self.metadata: dict[bytes, bytes] = {}
        self._skipped: list[int] = []
        self._columns: dict[str, pl.Series] = {}
        header, following = self._header_and_first_row()
        self.names = [name.strip() for name in header]
        # some writers put a separator at the end of every line except the header
        self._spare = int(len(following) == len(header) + 1 and not following[-1].strip())

    def _header_and_first_row(self) -> tuple[list[str], list[str]]:
        import csv

        try:
            with self._path.open(encoding="utf-8-sig", newline="") as file:
                for _ in range(self._layout.skip_rows):
                    file.readline()
                lines = csv.reader((line.rstrip("\r\n") for line in file), delimiter=self._layout.separator)
                header = next(lines, [])
                following = next((line for line in lines if any(cell.strip() for cell in line)), [])
        except UnicodeDecodeError:
            self._check_utf8()
            raise
        except csv.Error as error:
            raise TraceError(f"{self._path}: not a CSV table: {error}") from error
        if not any(name.strip() for name in header):
            raise TraceError(
                f"{self._path}: line {self._layout.skip_rows + 1} should contain the names of the columns, but is blank"
            )
        return header, following

    def _check_utf8(self) -> None:
        """Raise `TraceError` with the place of bytes that are not UTF-8: in malformed lines, the CSV parser ignores them."""
        decoder, at = codecs.getincrementaldecoder("utf-8")(), 0
        with self._path.open("rb") as file:
            while True:
                block = file.read(TEXT_BLOCK_BYTES)
                if self.zeros_at is None and b"\0" in block:
                    self.zeros_at = at + block.index(b"\0")
                pending = len(decoder.getstate()[0])
                try:
                    decoder.decode(block, final=not block)
                except UnicodeDecodeError as error:
                    place = at - pending + error.start
                    raise TraceError(f"{self._path}: not UTF-8 text at byte {place}: save it as UTF-8") from error
                if not block:
                    return
                at += len(block)

    def load(self, names: Iterable[str]) -> int:
        """Read these columns as text, and return the number of rows."""
        import pyarrow.csv as arrow_csv

        self._check_utf8()
        width = len(self.names) + self._spare
        column_names = {str(self.names.index(name)): name for name in names}
        options = (
            arrow_csv.ReadOptions(
                skip_rows=self._layout.skip_rows + 1, column_names=[str(i) for i in range(width)], use_threads=False
            ),
            arrow_csv.ParseOptions(
                delimiter=self._layout.separator, invalid_row_handler=self._skip_bad_line, ignore_empty_lines=False
            ),
            arrow_csv.ConvertOptions(
                include_columns=list(column_names),
                column_types=dict.fromkeys(column_names, pa.string()),
                strings_can_be_null=False,
            ),
        )
        try:
            with self._path.open("rb") as file:
                table = arrow_csv.read_csv(file, *options)
        except pa.ArrowInvalid as error:
            if "Empty CSV" in str(error):
                raise TraceError(f"{self._path}: no row follows the header: nothing can be judged") from error
            raise TraceError(f"{self._path}: not a CSV table: {' '.join(str(error).split())}") from error
        self._columns = {
            name: _trimmed_texts(table.column(key), self._layout.null_values) for key, name in column_names.items()
        }
        return int(table.num_rows)

    def row_counts_before_bad_lines(self) -> list[int]:
        """Return for each malformed line the number of rows before it."""
        skipped = np.array(self._skipped, np.int64)
        return [line - self._layout.skip_rows - 2 - int(np.searchsorted(skipped, line)) for line in self.bad_lines]

    @property
    def has_content_after_zeros(self) -> bool:
        """Whether anything but zeros follows the first zero byte."""
        if self.zeros_at is None:
            return False
        with self._path.open("rb") as file:
            file.seek(self.zeros_at)
            return bool(file.read().strip(b"\0\r\n"))

    def _skip_bad_line(self, row: Any) -> str:
        """Record a line with the wrong number of cells, as pyarrow's callback, and skip it; a blank line is no loss."""
        if row.text.strip(f" \t\r\n{self._layout.separator}"):
            self.bad_lines.append(row.number)
        self._skipped.append(row.number)
        return "skip"

    def text_column(self, name: str) -> pa.Array:
        """Return the column as trimmed strings; NULL for empty cells."""
        return self._columns[name].to_arrow().cast(pa.string())

    def is_filled(self, name: str) -> Mask:
        """Return for each cell whether it is not empty."""
        return self._columns[name].is_not_null().to_numpy()

    def numbers_and_bad(self, name: str) -> tuple[Floats, Mask]:
        """Return values (NaN: empty or not a number), and for each cell whether it is text that is not a number."""
        import polars as pl

        column = self._columns[name]
        values = column.cast(pl.Float64, strict=False)
        return values.fill_null(float("nan")).to_numpy(), (column.is_not_null() & values.is_null()).to_numpy()

    def times_and_bad(self, name: str, unit_ns: float) -> tuple[Times, Mask]:
        """Return nanoseconds (exact for integers), and for each cell whether it is empty or not a time. `unit_ns`: those of 1."""
        import polars as pl

        t_ns, bad = _nanoseconds_and_bad(*self.numbers_and_bad(name), factor=unit_ns)
        if unit_ns > 1:
            return t_ns, bad
        exact = self._columns[name].cast(pl.Int64, strict=False)  # beyond 2^53 a double is not exact to the nanosecond
        return np.where(exact.is_not_null().to_numpy(), exact.fill_null(0).to_numpy(), t_ns), bad

    def describe_rows(self, rows: Indices) -> str:
        """Return words with the line numbers of the first rows in `rows`."""
        return describe_places("line", [self._line_number(int(row)) for row in rows[:_MOST_LISTED_PLACES]], len(rows))

    def _line_number(self, row: int) -> int:
        line = row + self._layout.skip_rows + 2
        for skipped in self._skipped:
            line += skipped <= line
        return line


class ParquetSheet:
    """A Parquet file with the interface of `CsvSheet`."""

    def __init__(self, path: Path) -> None:
        """Read the schema. Errors: `TraceError` if the file is damaged."""
        self._path = path
        self.bad_lines: list[int] = []
        self.zeros_at: int | None = None
        self.has_content_after_zeros = False
        schema = parquet.schema(path)
        self.names = list(schema.names)
        self.metadata: dict[bytes, bytes] = dict(schema.metadata or {})

    def load(self, names: Iterable[str]) -> int:
        """Read these columns, and return the number of rows."""
        self._table = parquet.table(self._path, names)
        return int(self._table.num_rows)

    def row_counts_before_bad_lines(self) -> list[int]:
        """Return an empty list: Parquet has no malformed lines."""
        return []

    def _column(self, name: str) -> pa.Array:
        return parquet.column(self._table, name)

    def text_column(self, name: str) -> pa.Array:
        """Return the column as trimmed strings. A column of only whole numbers has no decimal points."""
        column = self._column(name)
        try:
            if pa.types.is_floating(column.type) and not pc.any(pc.not_equal(column, pc.floor(column))).as_py():
                column = column.cast(pa.int64())
            return _trimmed_texts(column.cast(pa.string()), []).to_arrow().cast(pa.string())
        except pa.ArrowException as error:
            raise TraceError(f"{self._path}: column {name!r} is {column.type}, not text: map another column") from error

    def is_filled(self, name: str) -> Mask:
        """Return for each cell whether it is not NULL."""
        return np.asarray(self._column(name).is_valid().to_numpy(zero_copy_only=False), np.bool_)

    def numbers_and_bad(self, name: str) -> tuple[Floats, Mask]:
        """Return values (NaN: NULL), and False for each cell. Errors: `TraceError` if the column's type is not numeric."""
        column = self._column(name)
        try:
            values = column.cast(pa.float64(), safe=False)
        except pa.ArrowException as error:
            raise TraceError(
                f"{self._path}: column {name!r} is {column.type}, not a number: map another column"
            ) from error
        return pc.fill_null(values, float("nan")).to_numpy(zero_copy_only=False), np.zeros(len(column), np.bool_)

    def times_and_bad(self, name: str, unit_ns: float) -> tuple[Times, Mask]:
        """Return nanoseconds, and for each cell whether it is NULL or out of range. Time stamps and durations ignore `unit_ns`."""
        column = self._column(name)
        if pa.types.is_timestamp(column.type) or pa.types.is_duration(column.type):
            column, unit_ns = column.cast(pa.int64()), TIME_UNITS[column.type.unit]
        if not pa.types.is_integer(column.type) or unit_ns != int(unit_ns):
            return _nanoseconds_and_bad(*self.numbers_and_bad(name), factor=unit_ns)
        whole = pc.fill_null(column.cast(pa.int64(), safe=False), 0).to_numpy(zero_copy_only=False)
        factor = int(unit_ns)
        largest = int(MAX_NS) // factor
        beyond = (whole > largest) | (whole < -largest)  # the least integer has no absolute value
        return np.where(beyond, 0, whole) * factor, beyond | column.is_null().to_numpy(zero_copy_only=False)

    def describe_rows(self, rows: Indices) -> str:
        """Return words with the numbers of the first rows in `rows`."""
        return describe_places("row", [int(row) + 1 for row in rows[:_MOST_LISTED_PLACES]], len(rows))


Sheet = CsvSheet | ParquetSheet
"""A table on disk whose columns are read by name. Empty cells become NaN or NULL."""


def describe_places(noun: str, first: list[int], n: int) -> str:
    """Return the first of `n` places as text: `line 7`, `lines 7, 9`, `lines 1, 2, 3, 4, 5 and 12 more`."""
    more = n - len(first[:_MOST_LISTED_PLACES])
    return f"{noun}{'s' * (n > 1)} {', '.join(map(str, first[:_MOST_LISTED_PLACES]))}" + (
        f" and {more} more" if more else ""
    )


def _trimmed_texts(column: pa.Array | pa.ChunkedArray, null_texts: list[str]) -> pl.Series:
    import polars as pl

    series = pl.Series(column).str.strip_chars()
    return series.set(series.is_in(["", *null_texts]) if null_texts else series == "", None)


def _nanoseconds_and_bad(values: Floats, bad: Mask, *, factor: float) -> tuple[Times, Mask]:
    """Return values scaled to nanoseconds and rounded (8.3 s is 8,300,000,000 ns), and for each cell whether it is bad or too large."""
    with np.errstate(invalid="ignore", over="ignore"):
        scaled = np.rint(values * factor)
        is_bad = bad | ~(np.abs(scaled) < MAX_NS)
    return np.where(is_bad, 0.0, scaled).astype(np.int64), is_bad
