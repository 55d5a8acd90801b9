"""Reads SUMO's floating car data in CSV and Parquet, as SUMO writes them or its tools convert them from XML.

SUMO names all columns after the element that it wrote first, whatever element a row is. Up to `slope`, all elements have the same
attributes in the same order. After `slope`, the values of another element are in columns with wrong names, or missing.
The tool xml2csv writes separate columns for each kind of element.
Source: SUMO's documentation of "Tabular Outputs" and "Simulation/Output/FCDOutput", and files of SUMO 1.28.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.csv as pa_csv

from drivelint.errors import TraceError
from drivelint.formats.sumo.rows import ATTRIBUTES, KINDS, PERSON_OR_CONTAINER, UNKNOWN_KIND, VEHICLE, Rows, typed_rows
from drivelint.formats.tables import parquet

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from drivelint.arrays import Codes, Mask

    Columns = dict[str, str]

_TIME_COLUMN: Final = "timestep_time"
_COLUMNS_WITHOUT_ELEMENT_NAME: Final = frozenset({"time", "id", "x", "y", "angle", "pos", "lane", "edge", "slope"})
"""Columns without the name of an element (`--output.column-header plain`) are SUMO's if all of these are present."""
_NUMBER_COLUMNS: Final = frozenset({"time", "x", "y", "angle", "speed"})
"""Columns that are read as numbers directly. Columns after `slope` may contain texts of another element."""
_READ_COLUMNS: Final = (*ATTRIBUTES, "lane", "edge")
_NUMBER_PATTERN: Final = r"^-?[0-9.]+(e-?[0-9]+)?$"
_VEHICLE_ONLY_ATTRIBUTES: Final = ("signals", "acceleration")
"""Attributes that only vehicles have."""


def column_groups(names: Sequence[str]) -> dict[str, Columns]:
    """Return element -> attribute -> column, for each element with columns of its own, `time` included. Empty: the table is not FCD.

    The element is "" if the columns are not named after an element.
    """
    there = set(names)
    if there >= _COLUMNS_WITHOUT_ELEMENT_NAME:
        return {"": {name: name for name in ("time", *_READ_COLUMNS) if name in there}}
    groups = {}
    for kind in KINDS if _TIME_COLUMN in there else ():
        for prefix in (f"{kind}_", f"timestep_{kind}_"):
            columns = {name: prefix + name for name in _READ_COLUMNS if prefix + name in there}
            if {"id", "x", "y"} <= columns.keys():
                groups[kind] = {"time": _TIME_COLUMN, **columns}
    return groups


def read_parquet(path: Path) -> Rows:
    """Read a Parquet table. Errors: `TraceError`."""
    groups = column_groups(parquet.schema(path).names)
    table = parquet.table(path, _columns_of_groups(groups))
    try:
        table.validate(full=True)  # finds invalid texts
    except pa.ArrowInvalid as error:
        raise TraceError(
            f"{path}: not readable as Parquet: {' '.join(str(error).split())}: copy it again, or write it again"
        ) from error
    return _rows_of_table(path, table, groups)


def read_csv(path: Path) -> Rows:
    """Read a CSV table, whatever its separator. Errors: `TraceError`."""
    with path.open("rb") as file:
        first, second = file.readline(), file.readline()
    delimiter = max(";,\t", key=lambda d: first.count(d.encode()))
    names = [name.strip('"') for name in first.decode("utf-8-sig", "replace").strip().split(delimiter)]
    groups = column_groups(names)
    number_columns = _NUMBER_COLUMNS - ({"time"} if b":" in second else set())
    texts = {name for columns in groups.values() for key, name in columns.items() if key not in number_columns}
    try:
        table = pa_csv.read_csv(
            path,
            parse_options=pa_csv.ParseOptions(delimiter=delimiter),
            convert_options=pa_csv.ConvertOptions(
                column_types=dict.fromkeys(texts, pa.string()), include_columns=_columns_of_groups(groups)
            ),
        )
    except (pa.ArrowInvalid, pa.ArrowKeyError) as error:
        raise TraceError(f"{path}: {' '.join(str(error).split())}: write the log again") from error
    return _rows_of_table(path, table, groups)


def _columns_of_groups(groups: Mapping[str, Columns]) -> list[str]:
    return list(dict.fromkeys(name for columns in groups.values() for name in columns.values()))


def _rows_of_table(path: Path, table: pa.Table, groups: Mapping[str, Columns]) -> Rows:
    if len(groups) == 1:
        (columns,) = groups.values()
        try:
            kind, row_columns = _row_kinds_and_cleaned_columns(
                {name: table[column] for name, column in columns.items()}
            )
        except pa.ArrowException as error:
            raise TraceError(f"{path}: {' '.join(str(error).split())}: write the log again") from error
        return typed_rows(path, row_columns, kind)
    parts, order = [], []
    for element, columns in groups.items():
        here = np.any([_is_filled(table[columns[name]]) for name in ("id", "x", "y") if name in columns], axis=0)
        rows_here = table.filter(pa.array(here))
        codes = np.full(rows_here.num_rows, KINDS.index(element), np.int8)
        parts.append(typed_rows(path, {name: rows_here[column] for name, column in columns.items()}, codes))
        order.append(np.flatnonzero(here))
    rows = np.argsort(np.concatenate(order), kind="stable")
    all_rows = pa.concat_tables([part.table for part in parts]).combine_chunks()
    return Rows(all_rows.take(pa.array(rows)), np.concatenate([part.kind for part in parts])[rows])


def _row_kinds_and_cleaned_columns(
    columns: dict[str, pa.ChunkedArray | pa.Array],
) -> tuple[Codes, dict[str, pa.ChunkedArray | pa.Array]]:
    """Return the kinds of the rows, and the columns without the values of other kinds' attributes."""
    n = len(columns["time"])
    kind = _row_kinds_from_lanes(n, columns)
    null_text = pa.scalar(None, pa.string())
    if "vehicle" in columns:
        carried = pa.array(kind == PERSON_OR_CONTAINER)
        columns["vehicle"] = pc.if_else(carried, pc.fill_null(columns["vehicle"].cast(pa.string()), ""), null_text)
    for name in _VEHICLE_ONLY_ATTRIBUTES:
        if name in columns and not (kind == VEHICLE).all():
            texts = columns[name].cast(pa.string())
            may_be = pc.and_(pa.array(kind != PERSON_OR_CONTAINER), pc.match_substring_regex(texts, _NUMBER_PATTERN))
            columns[name] = pc.if_else(pc.or_(pa.array(kind == VEHICLE), may_be), texts, null_text)
    return kind, columns


def _row_kinds_from_lanes(n: int, columns: Mapping[str, pa.ChunkedArray | pa.Array]) -> Codes:
    """Return the kinds of the rows by their place in the net: a vehicle is on a lane, a person or container on an edge.

    In a mesoscopic simulation, no actor is on a lane: the kinds are unknown.
    """
    lane, edge = (_is_filled(columns[name]) if name in columns else np.zeros(n, np.bool_) for name in ("lane", "edge"))
    carried = edge & ~lane & lane.any()
    return np.select([lane, carried], [np.int8(VEHICLE), np.int8(PERSON_OR_CONTAINER)], np.int8(UNKNOWN_KIND))


def _is_filled(column: pa.ChunkedArray) -> Mask:
    if pa.types.is_dictionary(column.type):
        column = column.cast(column.type.value_type)
    empty = pc.is_null(column)
    if pa.types.is_string(column.type) or pa.types.is_large_string(column.type):
        empty = pc.or_(empty, pc.fill_null(pc.equal(column, ""), fill_value=True))
    filled: Mask = ~empty.to_numpy()
    return filled
