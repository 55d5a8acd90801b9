"""The names of DuckDB's own tables, which no query of a user means."""

from __future__ import annotations

import re
from typing import Final

_SUGGESTION: Final = re.compile(r'\s*Did you mean "(?:pg_|duckdb_|sqlite_|information_schema)[^"]*"\?')


def without_internal_names(message: str) -> str:
    """Return an error message of DuckDB without the suggestion of one of its own tables."""
    return _SUGGESTION.sub("", message)
