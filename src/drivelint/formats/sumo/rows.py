"""The rows of floating car data, one per vehicle, person or container and step, under the names of SUMO's attributes."""

from __future__ import annotations

import math
from pathlib import Path  # noqa: TC003 - NamedTuple reads it
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from drivelint.errors import TraceError
from drivelint.formats.sumo.clock import seconds_of_texts

if TYPE_CHECKING:
    from drivelint.arrays import Codes, Floats, Mask

KINDS: Final = ("vehicle", "person", "container")
"""The elements of a step."""
VEHICLE, PERSON, CONTAINER = range(3)
PERSON_OR_CONTAINER: Final = 3
"""The kind of a row that is a person or a container; which of them is not known."""
UNKNOWN_KIND: Final = -1
NUMBER_ATTRIBUTES: Final = ("x", "y", "angle", "speed", "signals", "acceleration")
ATTRIBUTES: Final = ("id", "type", "vehicle", *NUMBER_ATTRIBUTES)
"""The attributes that are kept of each row, besides `time`."""
TEXT_ATTRIBUTES: Final = frozenset({"id", "type", "vehicle"})


class Rows(NamedTuple):
    """The rows of a log: `table` has `time` and `ATTRIBUTES`; a missing text is "", a missing number NaN.

    `table["vehicle"]`: the vehicle in which a passenger rides, "": it is no passenger, NULL: not stated. `kind` (n,): index of `KINDS`,
    `PERSON_OR_CONTAINER` or `UNKNOWN_KIND`. `geo_option`: whether SUMO's options, which may precede the data, ask for longitude and
    latitude; None: there are no options. `selection_options`: those with which only some road users are written. `lacks_end`: the end
    tag of the file was missing.
    """

    table: pa.Table
    kind: Codes
    geo_option: bool | None = None
    selection_options: tuple[str, ...] = ()
    lacks_end: bool = False

    def numbers(self, name: str) -> Floats:
        """Return a column of numbers, with NaN for infinite numbers."""
        values = np.asarray(self.table[name].to_numpy(), np.float64)
        return np.where(np.isinf(values), np.nan, values)

    def take(self, rows: Mask) -> Rows:
        """Return the chosen rows."""
        if rows.all():
            return self
        return self._replace(table=self.table.filter(pa.array(rows)), kind=self.kind[rows])


def typed_rows(path: Path, columns: dict[str, pa.ChunkedArray | pa.Array], kind: Codes) -> Rows:
    """Return columns, `time` and some of `ATTRIBUTES`, as rows. Errors: `TraceError` for a cell that is not a number or time."""
    n = len(kind)
    arrays = {}
    for name in ("time", *ATTRIBUTES):
        column = columns.get(name, pa.nulls(n))
        try:
            arrays[name] = _typed_column(name, column)
        except pa.ArrowException as error:
            raise TraceError(
                f"{path}: {name} of vehicles: {' '.join(str(error).split())}: write the log again"
            ) from error
    return Rows(pa.table(arrays), kind)


def _typed_column(name: str, column: pa.ChunkedArray | pa.Array) -> pa.ChunkedArray | pa.Array:
    if name in TEXT_ATTRIBUTES:
        column = column.cast(pa.string())
        return column if name == "vehicle" else pc.fill_null(column, "")
    if pa.types.is_string(column.type) or pa.types.is_binary(column.type):
        column = column.cast(pa.string())
        column = pc.if_else(pc.equal(column, ""), pa.scalar(None, pa.string()), column)
        if name == "time":
            return pc.fill_null(seconds_of_texts(column), math.nan)
    return pc.fill_null(column.cast(pa.float64()), math.nan)
