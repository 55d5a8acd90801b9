"""Messages of DuckDB about a query, without its own tables, and with the place of a table that a result lacks."""

from __future__ import annotations

import re
from typing import Final

from drivelint.sql.declarations import column_comments

_SUGGESTION: Final = re.compile(r'\s*Did you mean "(?:pg_|duckdb_|sqlite_|information_schema)[^"]*"\?')
_MISSING_TABLE: Final = re.compile(r"Table with name (\w+) does not exist!(?!\s*Did you mean)")
_TABLES_OF_LOGS: Final = frozenset({"actor", "actor_state", "data_log", "declared_event", "signal_state"})
"""The tables that `drivelint convert` writes."""


def without_internal_names(message: str) -> str:
    """Return an error message of DuckDB without the suggestion of one of its own tables; it says where a table of drivelint is."""
    return _MISSING_TABLE.sub(lambda match: f"{match[0]}{_place_of_table(match[1])}", _SUGGESTION.sub("", message))


def _place_of_table(name: str) -> str:
    """Return a sentence that says where a table is that a result does not contain; '' for a table that drivelint does not have."""
    if name in _TABLES_OF_LOGS:
        return f" {name} is in the log: drivelint convert LOG --to parquet writes it; drivelint docs columns joins it with findings."
    return f" {name} is kept only by drivelint check --keep-db." if name in column_comments() else ""
