"""Finds the few rows that reproduce the numbers of a finding, and tests them in a DuckDB without drivelint's tables."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any, Final

import duckdb
import pyarrow.parquet as pq

from drivelint.pack import finding_sql
from drivelint.pack.finding_sql import COMPARED_FINDING_COLUMNS
from drivelint.sql import declarations, store

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    import pyarrow as pa

    from drivelint.catalogue import Rule
    from drivelint.pack.finding_sql import Row

TIME_AROUND_FINDING_NS: Final = 10_000_000_000
"""Time before and after a finding whose rows are tried before the whole drive is taken."""
_TIME_COLUMN_PAIRS: Final = (
    ("t_ns", "t_ns"),
    ("t_start_ns", "t_end_ns"),
    ("t_from_ns", "t_to_ns"),
    ("t_first_ns", "t_last_ns"),
)
_OBJECT_COLUMNS: Final = ("object_id", "vbp_id", "ov_id", "lead_id", "actor_id")
SQL_FILE: Final = "finding.sql"


def rows_of_ego(con: duckdb.DuckDBPyConnection, table: str, drive_id: str, ego_id: str) -> pa.Table:
    """Return the rows of a table about a drive and an ego, sorted, with ids as text and without geometry columns."""
    columns = con.execute(f"DESCRIBE {table}").fetchall()
    kinds = {str(name): str(kind) for name, kind, *_ in columns}
    shown_columns = [
        f"{name}::VARCHAR AS {name}" if kind.startswith("ENUM") else name
        for name, kind in kinds.items()
        if not kind.startswith("GEOMETRY")
    ]
    keys = {"drive_id": drive_id, "ego_id": ego_id}
    where = " AND ".join(f"{name}::VARCHAR = ${name}" for name in keys if name in kinds) or "true"
    values = {name: value for name, value in keys.items() if name in kinds}
    sql = f"SELECT {', '.join(shown_columns)} FROM {table} WHERE {where} ORDER BY ALL"
    return con.execute(sql, values).to_arrow_table()


def reproducing_files_or_reason(
    rule: Rule, params: Mapping[str, object], finding: Row, ref_id: int | None, tables: Mapping[str, pa.Table]
) -> dict[str, bytes] | str:
    """Return file name -> content of the files that reproduce the numbers of a finding, or why there are none.

    `tables`: name of a table that the rule's condition reads -> all its rows about the ego.
    """
    sql = finding_sql.select_of_finding(rule, params, finding, ref_id)
    if not finding_sql.is_split_by_shell_as_by_parser(sql):
        return "DuckDB's shell would read it otherwise: the rule has a comment in /* */, or a text in E'' or $$"
    with duckdb.connect(config={"threads": "1"}) as con:
        store.lock_down(con)  # the rule, or the pack that is verified, may be untrusted
        try:
            con.execute(";".join(finding_sql.called_macro_definitions(sql)))
            least_rows = _fewest_sufficient_rows(con, sql, finding, tables)
        except duckdb.Error as error:
            return f"DuckDB alone cannot run it: {str(error).splitlines()[0]}"
    if least_rows is None:
        return "the rule's condition alone does not give its numbers: nobody was there, or a step is missing"
    files = {f"{table}.parquet": _parquet_bytes(table, rows) for table, rows in least_rows.items()}
    return {SQL_FILE: finding_sql.finding_sql_text(rule, finding, sql, least_rows).encode(), **files}


def gives_finding_numbers(sql: str, finding: Row, tables: Mapping[str, pa.Table]) -> bool:
    """Return whether a DuckDB without drivelint's tables computes the numbers of a finding from these rows."""
    with duckdb.connect(config={"threads": "1"}) as con:
        try:
            con.execute(";".join(finding_sql.called_macro_definitions(sql)))
            for table, rows in tables.items():
                con.register(table, rows)
            return _are_finding_numbers_in_rows(con.execute(sql).to_arrow_table().to_pylist(), finding)
        except duckdb.Error:
            return False


def _fewest_sufficient_rows(
    con: duckdb.DuckDBPyConnection, sql: str, finding: Row, tables: Mapping[str, pa.Table]
) -> dict[str, pa.Table] | None:
    """Return the fewest tried rows of each table that give the finding's numbers; None: even all rows give other numbers."""
    choices = {table: _row_choices(con, finding, rows) for table, rows in tables.items()}

    def are_sufficient(rows_by_table: Mapping[str, pa.Table]) -> bool:
        for table, rows in rows_by_table.items():
            con.register(table, rows)
        return _are_finding_numbers_in_rows(con.execute(sql).to_arrow_table().to_pylist(), finding)

    least = {table: choices_of_table[0] for table, choices_of_table in choices.items()}
    if are_sufficient(least):
        return least
    fewest = dict(tables)
    if not are_sufficient(fewest):
        return None
    for table, tries in choices.items():
        fewest[table] = _first_sufficient(tries, lambda rows, table=table: are_sufficient({**fewest, table: rows}))  # type: ignore[misc]
    return fewest


def _first_sufficient(choices: Sequence[pa.Table], is_sufficient: Callable[[pa.Table], bool]) -> pa.Table:
    """Return the first choice of rows that gives the numbers. The last choice is known to give them."""
    return next((rows for rows in choices[:-1] if is_sufficient(rows)), choices[-1])


def _are_finding_numbers_in_rows(rows: list[dict[str, Any]], finding: Row) -> bool:
    return (
        len(rows) == 1
        and rows[0]["holds"] is False
        and all(rows[0][name] == finding[name] for name in COMPARED_FINDING_COLUMNS)
    )


def _row_choices(con: duckdb.DuckDBPyConnection, finding: Row, rows: pa.Table) -> list[pa.Table]:
    """Return choices of a table's rows, from few to all: at the worst step or around the finding, about the two parties or all actors."""
    columns = rows.column_names
    step, around = (
        _time_condition_sql(columns, *times)
        for times in (
            (finding["t_worst_ns"], finding["t_worst_ns"]),
            (finding["t_start_ns"] - TIME_AROUND_FINDING_NS, finding["t_end_ns"] + TIME_AROUND_FINDING_NS),
        )
    )
    parties = ", ".join(
        finding_sql.text_literal(finding[key]) for key in ("ego_id", "object_id") if finding[key] is not None
    )
    terms_of_parties = [
        f"{name} IN ({parties})" for name in _OBJECT_COLUMNS if name in columns and finding["object_id"] is not None
    ]
    of_parties = " OR ".join(terms_of_parties) or None
    profile = (
        f"profile = {finding_sql.text_literal(finding['profile'])}"
        if "profile" in columns and finding["profile"]
        else None
    )
    tried = [(step, of_parties), (step, None), (around, of_parties), (around, None), (None, of_parties), (None, None)]
    terms = dict.fromkeys(tuple(term for term in (*choice, profile) if term is not None) for choice in tried)
    con.register("_rows", rows)
    selections = [
        con.execute(f"FROM _rows WHERE {' AND '.join(f'({term})' for term in choice) or 'true'}").to_arrow_table()
        for choice in terms
    ]
    return [*selections, rows]


def _time_condition_sql(columns: Sequence[str], start_ns: int, end_ns: int) -> str | None:
    for first, last in _TIME_COLUMN_PAIRS:
        if first in columns and last in columns:
            return f"{first} <= {end_ns} AND coalesce({last}, {first}) >= {start_ns}"
    return None


def _parquet_bytes(table_name: str, rows: pa.Table) -> bytes:
    comments = declarations.column_comments().get(table_name, {})
    described = rows.schema.remove_metadata()
    for i, field in enumerate(described):
        metadata = {"comment": comments[field.name]} if field.name in comments else None
        described = described.set(i, field.with_metadata(metadata))
    sink = io.BytesIO()
    pq.write_table(rows.cast(described).combine_chunks(), sink, compression="zstd")
    return sink.getvalue()
