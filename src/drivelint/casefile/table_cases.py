"""Reads and runs `<table>.cases.yml`, the regression cases beside the tables of the library.

A case gives rows of the tables that the SELECT reads, and all rows that the SELECT must return:

    - name: the nearer of two vehicles is the lead
      given:
        ego_state: {t_s: 0..1 by 0.5, speed_mps: 10, front_s_m: 5}
        lane_ahead:
          - {t_s: 0..1 by 0.5, object_id: x, gap_m: 30}
          - {t_s: 0..1 by 0.5, object_id: y, gap_m: 20}
      expect: {t_s: 0..1 by 0.5, object_id: y, gap_m: {else: 20, 1: 19.5}}

* `given` and `expect` have the form of `given` in the cases of rules: blocks with scalars, lists, ranges, and values by time.
* `step`, `clock` and `_ego_clock` are computed as in the cases of rules if the SELECT reads them and the case does not give them. Every
  drive has a row of `data_log`. The map is `m` where none is given.
* Of the rows in `expect`, only the given columns are compared. Rows are compared in the order of their ids, times, counts and words; where
  these are the same, each is compared with the row that it agrees with. Numbers must agree to the written decimals, at least two; in
  quotes, zeros at the end count: '0.050'. `expect: []` means: no row. A column that is declared NOT NULL never is.
* A text that is JSON, such as a reason, may be expected as a mapping with the parts that matter, in a list with an item for each row:
  `reason: [{code: on_lane}]`. A geometry is given and expected as well-known text: `geom: POLYGON ((0 0, 2 0, 2 2, 0 0))`; an equal area
  agrees, wherever its outline begins.
"""

from __future__ import annotations

import json
import re
from decimal import Decimal
from itertools import groupby
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import duckdb
import msgspec

from drivelint.casefile import CaseResult, is_same_value
from drivelint.casefile.case_list import parse_cases_file
from drivelint.casefile.merged_cases import NumberedCase, merge_cases
from drivelint.casefile.scene import Row, case_database, complete_table_scene, insert_rows, rows_of_blocks
from drivelint.catalogue.check import error_message, raise_problems
from drivelint.errors import RuleError
from drivelint.phrases import nearest_word
from drivelint.sql import declarations, syntax
from drivelint.sql.statements import statement, statement_texts

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence
    from pathlib import Path

    from drivelint.sql.library import LibraryTable

_MAP: Final = "m"
_NUMBER: Final = re.compile(r"-?\d+(\.\d+)?")
_CASE_NUMBER: Final = re.compile(r"(\d+):")
_UNORDERED_TYPE: Final = re.compile(r"DOUBLE|FLOAT|GEOMETRY|STRUCT|.*\]", re.IGNORECASE)


class TableCase(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """One case as written in the file."""

    name: str
    given_tables: dict[str, Any] = msgspec.field(name="given")
    expect: dict[str, Any] | list[dict[str, Any]]
    line: int = 0
    """The case's line in the file, set by the reader."""


class CompleteCase(NamedTuple):
    """A case with all its rows. `place`: its file, line and name; `numbered`: its number in the file, and the rows that it gives."""

    case: TableCase
    place: str
    numbered: NumberedCase
    expected_rows: list[Row]


def cases_file(table: LibraryTable) -> Path:
    """Return the file of a table's cases."""
    return table.path.with_suffix(".cases.yml")


def tables_read_by(table: LibraryTable) -> frozenset[str]:
    """Return all tables that the SELECT of a table reads. Errors: `RuleError` for one that there is not."""
    tree = syntax.parse_select(table.select, str(table.path))
    table_names = declarations.column_comments().keys()
    if unknown := sorted(syntax.tables_read(tree) - table_names):
        near = nearest_word(unknown[0], table_names)
        instead = f"did you mean {near!r}?" if near else "drivelint docs dictionary prints all"
        raise RuleError(f"{table.path}: there is no table {unknown[0]!r}: {instead}")
    return syntax.tables_read(tree)


def read_table_cases(table: LibraryTable) -> list[CompleteCase]:
    """Read the cases of a table. Errors: `RuleError` with a line for each problem, or if the file is missing."""
    file = cases_file(table)
    if not file.exists():
        raise RuleError(
            f"{file}:1: table {table.name} has no cases: write some in this file; CONTRIBUTING.md, 'A table', has an example"
        )
    cases, problems = parse_cases_file(file, TableCase)
    reads = tables_read_by(table)
    complete: list[CompleteCase] = []
    for no, case in enumerate(cases):
        place = f"{file}:{case.line}: case {case.name!r}"
        try:
            _refuse_unread_tables(table, case, reads)
            scene = complete_table_scene(reads, case.given_tables, _MAP)
            expected_rows = rows_of_blocks(table.name, case.expect, "expect")
        except RuleError as error:
            problems += [f"{place}: {line}" for line in str(error).split("\n")]
        else:
            complete.append(CompleteCase(case, place, NumberedCase(no, scene, {}), expected_rows))
    raise_problems(problems)
    return complete


def _refuse_unread_tables(table: LibraryTable, case: TableCase, reads: Collection[str]) -> None:
    if unread := sorted(case.given_tables.keys() - reads):
        raise RuleError(f"given: {table.name} does not read {unread[0]!r}; it reads {', '.join(sorted(reads))}")


def run_table_cases(table: LibraryTable) -> list[CaseResult]:
    """Run the cases of a table together, as drives of one database, and return their results in order.

    Errors: `RuleError` for a cases file that cannot be read, and for a SELECT that fails.
    """
    cases = read_table_cases(table)
    with_rows = FilledCases(table, cases)
    try:
        rows_by_case = with_rows.rows_by_case(table.select)
    except duckdb.Error as error:
        raise RuleError(f"{table.path}: {error_message(error)}") from error
    finally:
        with_rows.clear()
    return [
        CaseResult(case.case.name, not message, message and f"{case.place}: {message}")
        for case in cases
        for message in [rows_difference(table.name, case.expected_rows, rows_by_case.get(case.numbered.no, []))]
    ]


class FilledCases:
    """The case database, filled with the rows of all cases of a table; call `clear` at the end."""

    def __init__(self, table: LibraryTable, cases: Sequence[CompleteCase]) -> None:
        self._con = case_database()
        kinds = declarations.column_types()[table.name]
        self._columns = ", ".join(f"ST_AsText({c}) AS {c}" if "GEOMETRY" in kinds[c] else c for c in kinds)
        self._numbered_columns = [
            c for c in ("drive_id", "environment_id") if c in declarations.column_comments()[table.name]
        ]
        scene = merge_cases([case.numbered for case in cases], "drive_id")
        self._filled = list(scene)
        try:
            for name, rows in scene.items():
                insert_rows(self._con, name, rows)
            shapes = set(statement_texts("map_shapes") if re.search(r"\bgeom\b", table.select) else ())
            for name in shapes & scene.keys():
                self._con.execute(statement(f"map_shapes/{name}"))
        except BaseException:
            self.clear()
            raise

    def rows_by_case(self, select: str) -> dict[int, list[Row]]:
        """Return the rows of a SELECT for the table, by the number of the case. Errors: `duckdb.Error`."""
        # into the table, so that the values have the declared types
        by_case: dict[int, list[Row]] = {}
        rows = self._con.execute(f"SELECT {self._columns} FROM (\n{select}\n)").to_arrow_table().to_pylist()
        for row in rows:
            number = 0
            for column in self._numbered_columns:
                if row[column] is not None and (marked := _CASE_NUMBER.match(row[column])):
                    number, row[column] = int(marked[1]), row[column][marked.end() :]
            by_case.setdefault(number, []).append(row)
        return by_case

    def clear(self) -> None:
        """Delete the rows of all cases."""
        self._con.execute(";".join(f"DELETE FROM {name}" for name in self._filled))


def rows_difference(table: str, expected_rows: Sequence[Row], rows: Sequence[Row]) -> str:
    """Return how the rows differ from the expected ones, in one line; '' if they do not."""
    if len(expected_rows) != len(rows):
        return f"expected {_count(expected_rows)}, got {_count(rows)}{': ' if rows else ''}{'; '.join(_row_text(row) for row in rows[:3])}"
    kinds = declarations.column_types()[table]
    for row in rows:
        if empty := [c for c, kind in kinds.items() if kind.endswith(" NOT NULL") and c in row and row[c] is None]:
            return f"{empty[0]} is declared NOT NULL, but is NULL: {_row_text(row)}"
    ordered = [
        c
        for c in kinds
        if not _UNORDERED_TYPE.match(kinds[c])
        and all(c in row and not isinstance(row[c], dict) for row in expected_rows)
    ]
    remaining = _in_order(rows, ordered)
    for _, group in groupby(_in_order(expected_rows, ordered), key=lambda row: _order_key(row, ordered)):
        tied = list(group)
        candidates, remaining = remaining[: len(tied)], remaining[len(tied) :]
        # rows with the same ids are in no order: each is compared with the row that it agrees with, the most detailed one first
        for expected_row in sorted(tied, key=len, reverse=True):
            messages = [_row_difference(expected_row, row, kinds) for row in candidates]
            if "" not in messages:
                return messages[0]
            del candidates[messages.index("")]
    return ""


def _row_difference(expected_row: Row, row: Row, kinds: Mapping[str, str]) -> str:
    for column, value in expected_row.items():
        is_same = _is_same_shape if "GEOMETRY" in kinds[column] else _is_same
        if not is_same(value, row[column]):
            wanted_text, got = (_cell_text(column, cell) for cell in (value, row[column]))
            return f"expected {wanted_text}, got {got.partition(': ')[2]}: {_row_text(row)}"
    return ""


def _count(rows: Sequence[Row]) -> str:
    return f"{len(rows)} row{'' if len(rows) == 1 else 's'}"


def _in_order(rows: Sequence[Row], columns: Sequence[str]) -> list[Row]:
    return sorted(rows, key=lambda row: _order_key(row, columns))


def _order_key(row: Row, columns: Sequence[str]) -> list[tuple[bool, Any]]:
    return [(row[c] is None, "" if row[c] is None else row[c]) for c in columns]


def _is_same(expected_value: Any, actual_value: Any) -> bool:
    if isinstance(expected_value, list) and isinstance(actual_value, list):
        return len(expected_value) == len(actual_value) and all(map(_is_same, expected_value, actual_value))
    if isinstance(expected_value, dict):
        parts = _value_of_json(actual_value) if isinstance(actual_value, str) else actual_value
        return isinstance(parts, dict) and all(
            key in parts and _is_same(value, parts[key]) for key, value in expected_value.items()
        )
    if isinstance(expected_value, str) and isinstance(actual_value, float | Decimal):
        is_number = _NUMBER.fullmatch(expected_value) is not None
        return is_number and is_same_value(Decimal(expected_value), actual_value, 1)
    return is_same_value(expected_value, actual_value, 1)


def _is_same_shape(expected_text: str | None, actual_text: str | None) -> bool:
    equal = "SELECT $1 IS NOT DISTINCT FROM $2 OR coalesce(ST_Equals(ST_GeomFromText($1), ST_GeomFromText($2)), false)"
    return bool(case_database().execute(equal, [expected_text, actual_text]).fetchall()[0][0])


def _value_of_json(text: str) -> Any:
    try:
        return json.loads(text)
    except ValueError:
        return text


def _row_text(row: Mapping[str, Any]) -> str:
    return "{" + ", ".join(_cell_text(name, value) for name, value in row.items() if value is not None) + "}"


def _cell_text(column: str, value: Any) -> str:
    """Return a column and its value as cases write them: times in seconds, words as in YAML, numbers without the noise of sums."""
    if column.endswith("_ns") and isinstance(value, int):
        return f"{column.removesuffix('ns')}s: {Decimal(value) / 10**9:f}"
    if value is None or isinstance(value, bool):
        return f"{column}: {json.dumps(value)}"
    return f"{column}: {value:.10g}" if isinstance(value, float) else f"{column}: {value}"
