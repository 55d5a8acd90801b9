"""The allowed elements of a rule's SQL, from `allowed.toml`. All other elements are refused, because a rule is untrusted code."""

from __future__ import annotations

import re
from functools import cache
from itertools import chain
from typing import Final

from drivelint.facts import toml_beside
from drivelint.phrases import nearest_word
from drivelint.sql import declarations, store
from drivelint.sql.library import library_tables

ENGINE_TABLES: Final = frozenset({"reference", "reference_step"})
"""Tables that the engine makes for a rule: its reference points, and the steps at which each reference point is judged."""

_FACTS: Final = toml_beside(__file__, "allowed.toml")
NODES, SOURCES, EXPRESSIONS, TABLE_FUNCTIONS, REFUSED_NAMES, NEEDING_ORDER_BY = (
    frozenset[str](_FACTS[name])
    for name in ("nodes", "sources", "expressions", "table_functions", "refused_names", "ordered")
)
_DUCKDB_FUNCTIONS: Final = frozenset[str](chain.from_iterable(_FACTS["functions"].values()))
_MACRO = re.compile(r"\bMACRO\s+(\w+)", re.IGNORECASE)
_OUTPUT_SCHEMAS = ("verdict", "evidence", "output")  # files of schemas/ with tables that a run writes


@cache
def macros() -> frozenset[str]:
    """Return the names of the macros in `queries/macros`, in lower case."""
    return frozenset(name.lower() for name in _MACRO.findall(store.macro_definitions()))


@cache
def functions() -> frozenset[str]:
    """Return the names of the functions and macros that a rule may call, in lower case."""
    return _DUCKDB_FUNCTIONS | macros()


@cache
def tables() -> frozenset[str]:
    """Return the tables that a rule may read: all declared ones except outputs and private ones, and `ENGINE_TABLES`."""
    outputs = {table for file in _OUTPUT_SCHEMAS for table in declarations.column_comments(file)}
    private = {table.name for table in library_tables().values() if table.is_private}
    return frozenset(declarations.column_comments().keys() - outputs - private) | ENGINE_TABLES


def unknown_table_message(name: str) -> str:
    """Return the message that a rule cannot read this table, with the most similar table."""
    near = nearest_word(name, tables())
    return f"there is no table {name!r} for rules; " + (
        f"did you mean {near!r}?" if near else "drivelint docs dictionary prints those that they read"
    )
