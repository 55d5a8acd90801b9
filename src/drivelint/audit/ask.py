"""`drivelint sql`: runs one SELECT over the tables of an audit or a check. It changes nothing and opens no other file."""

from __future__ import annotations

import json
import re
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Final

import duckdb

from drivelint.audit import sealed
from drivelint.audit.compact import escape_wildcards, open_database
from drivelint.audit.run import AUDIT_FILE
from drivelint.audit.store import LocalFolder, open_store
from drivelint.audit.unpacked import create_views_of_all_results
from drivelint.errors import UsageError
from drivelint.fleet.distinct_logs import COUNTED_PREFIX, create_counted_views
from drivelint.phrases import terminal_safe, terminal_safe_json
from drivelint.result.certainty import LEAST_SHARE_OF_COPIES_FOR_CERTAIN_FINDING
from drivelint.result.folder import changed_files
from drivelint.sql.internal_names import without_internal_names
from drivelint.sql.statements import statement
from drivelint.sql.store import quoted

if TYPE_CHECKING:
    from collections.abc import Callable

    from drivelint.audit.store import ResultStore


_CSV_CELL: Final = re.compile(r'(")((?:[^"]|"")*)"|[^,"\r\n]+')
_NUMBER: Final = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?|[+-]?(?:inf|nan)")
_FORMULA_STARTS: Final = tuple("=+-@\n\uff1d\uff0b\uff0d\uff20")
"""First characters of a cell that a spreadsheet treats as a formula. A tab is not needed here: `terminal_safe` replaces it by a backslash
and t."""


def run_query(dest: str, query: str, format_: str, warn: Callable[[str], None] = lambda _: None) -> str:
    """Return the rows of a SELECT as text, csv or json. `warn` receives a warning if the audit has not ended or files were changed.

    Errors: `UsageError` for another kind of statement, or one that fails.
    """
    with open_database() as con, TemporaryDirectory(prefix="drivelint-sql-") as downloads:
        _create_views_and_lock(con, dest, Path(downloads), warn)
        try:
            statements = con.extract_statements(query)
            if len(statements) != 1 or statements[0].type != duckdb.StatementType.SELECT:
                raise UsageError("drivelint sql takes exactly one SELECT, without other statements before or after it")
            if format_ == "text":
                return terminal_safe(f"{con.sql(query)}\n")
            if format_ == "csv":
                file = Path(downloads) / "rows.csv"
                con.execute(f"COPY ({query.strip().rstrip(';')}) TO {quoted(file)} (FORMAT csv, HEADER)")
                return _CSV_CELL.sub(_spreadsheet_safe_cell, file.read_text(encoding="utf-8"))
            rows = con.execute(statements[0]).to_arrow_table().to_pylist()
        except duckdb.Error as error:
            raise UsageError(f"drivelint sql: {' '.join(without_internal_names(str(error)).split())[:400]}") from error
    return terminal_safe_json(json.dumps(rows, indent=2, default=str, ensure_ascii=False)) + "\n"


def _spreadsheet_safe_cell(cell: re.Match[str]) -> str:
    """Return a CSV cell without control characters that a spreadsheet does not run as a formula. Numbers do not change."""
    quote, text = cell[1] or "", terminal_safe(cell[2] if cell[1] else cell[0])
    is_formula = text.startswith(_FORMULA_STARTS) and not _NUMBER.fullmatch(text)
    return f"{quote}{chr(39) * is_formula}{text}{quote}"


def _create_views_and_lock(
    con: duckdb.DuckDBPyConnection, dest: str, downloads: Path, warn: Callable[[str], None]
) -> None:
    """Create the views of an audit, or of a check's result, and then bar the database from all other files."""
    results = open_store(dest)
    is_audit = results.read(AUDIT_FILE) is not None
    _warn_of_changed_files(results, dest, downloads, warn, is_audit=is_audit)
    if is_audit:
        if warning := create_views_of_all_results(con, results, downloads).warning:
            warn(f"{dest}: {warning}")
        create_counted_views(con)
        event = statement("fleet/event", of=COUNTED_PREFIX, least_share=str(LEAST_SHARE_OF_COPIES_FOR_CERTAIN_FINDING))
        con.execute(f"CREATE TEMP VIEW {COUNTED_PREFIX}events AS {event}")
    else:
        files = [Path(name).name for name in results.names("") if "/" not in name and name.endswith(".parquet")]
        if "verdicts.parquet" not in files:
            raise UsageError(
                f"{dest}: neither an audit nor a result is here: name the folder of audit --out or check --out"
            )
        for file in sorted(files):
            _create_view(con, results, Path(file).stem, file, downloads)
    folders = [
        str(downloads),
        *([str(results.root), *escape_wildcards([str(results.root)])] if isinstance(results, LocalFolder) else []),
    ]
    con.execute("SET allowed_directories=?", [folders])
    con.execute("SET enable_external_access=false")
    con.execute("SET lock_configuration=true")


def _warn_of_changed_files(
    results: ResultStore, dest: str, downloads: Path, warn: Callable[[str], None], *, is_audit: bool
) -> None:
    """Warn about the first file that has changed since it was written: the query may read that file.

    Errors: `UsageError` for an audit that has ended but lacks the list of its files.
    """
    if is_audit:
        sealed.require_file_list(results, dest)
        try:
            sealed.require_audit_unchanged(results, downloads, dest)
        except UsageError as error:
            warn(str(error))
    elif isinstance(results, LocalFolder):  # the files of a bucket would have to be downloaded
        for name in changed_files(results.root)[:1]:
            warn(f"{dest.rstrip('/')}/{name}: was changed since drivelint check wrote it: check the drives again")


def _create_view(con: duckdb.DuckDBPyConnection, results: ResultStore, name: str, file: str, downloads: Path) -> None:
    con.read_parquet(escape_wildcards([str(results.fetch(file, downloads))])).create_view(name)
