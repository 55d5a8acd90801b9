"""Lists what a rule's SQL may contain; everything else is refused, because a rule is untrusted code.

Everything here gives the same answer every time (no clock, no chance, no estimate that depends on threads) and touches
nothing outside the tables: no file, no network, no setting, no other statement.
"""

from __future__ import annotations

import re
from functools import cache
from typing import Final

from drivelint.sql import store

ENGINE_TABLES: Final = frozenset({"reference", "reference_step"})
"""Tables that the engine makes for a rule: its reference points, and the steps at which each is judged."""

NODES: Final = frozenset({"SELECT_NODE", "SET_OPERATION_NODE"})
SOURCES: Final = frozenset({"BASE_TABLE", "SUBQUERY", "JOIN", "EMPTY", "TABLE_FUNCTION", "EXPRESSION_LIST"})
EXPRESSIONS: Final = frozenset(
    {
        *("BETWEEN", "CASE", "CAST", "COLUMN_REF", "COMPARISON", "CONJUNCTION", "CONSTANT", "FUNCTION", "LAMBDA"),
        *("OPERATOR", "PARAMETER", "STAR", "SUBQUERY", "WINDOW"),
    }
)
TABLE_FUNCTIONS: Final = frozenset({"range", "generate_series", "unnest"})
REFUSED_NAMES: Final = frozenset(
    {
        *("current_catalog", "current_date", "current_role", "current_schema", "current_time", "current_timestamp"),
        *("current_user", "localtime", "localtimestamp", "session_user", "user"),
    }
)
"""Words that look like columns and, where there is no such column, ask the clock or the session."""

_OPERATORS = "+ - * / // % ** ^ || ~~ !~~ ~~* !~~* ~~~ ^@ & | << >> ~ xor && @>"
_NUMBERS = """abs acos asin atan atan2 cbrt ceil ceiling cos cosh degrees even exp floor fmod greatest isfinite isinf isnan
    least ln log log10 log2 mod pi pow power radians round sign signbit sin sinh sqrt tan tanh trunc nullif ifnull"""
_TEXT = """concat concat_ws contains ends_with format instr left length lower ltrim prefix printf position
    regexp_extract regexp_full_match regexp_matches regexp_replace replace reverse right rtrim split_part starts_with
    strlen strpos string_split substr substring suffix trim upper"""
_LISTS = """array_extract array_length array_slice array_value cardinality element_at flatten generate_series
    len list_apply list_concat list_contains list_count list_distinct list_element list_extract list_filter list_has
    list_has_all list_has_any list_indexof list_intersect list_max list_min list_position list_reverse list_slice
    list_sort list_sum list_transform list_unique list_value list_where list_zip map map_extract range row struct_extract
    struct_pack unnest"""
_TIMES = """date_part date_trunc dayofweek epoch epoch_ms epoch_ns epoch_us hour isodow make_date make_time make_timestamp
    make_timestamp_ms make_timestamp_ns minute month second to_days to_hours to_microseconds to_milliseconds to_minutes
    to_seconds year"""
_AGGREGATES = """any_value arg_max arg_min avg bit_and bit_or bool_and bool_or count count_if count_star first last list
    max max_by median min min_by product quantile_cont quantile_disc stddev_pop stddev_samp string_agg sum var_pop
    var_samp"""
_WINDOWS = """cume_dist dense_rank first_value lag last_value lead nth_value ntile percent_rank rank row_number"""
_STOCK: Final = frozenset(
    name for names in (_OPERATORS, _NUMBERS, _TEXT, _LISTS, _TIMES, _AGGREGATES, _WINDOWS) for name in names.split()
)
_MACRO = re.compile(r"\bMACRO\s+(\w+)", re.IGNORECASE)
_OUTPUTS = ("verdict", "evidence", "output")  # what a run writes is not what a rule reads


@cache
def macros() -> frozenset[str]:
    """Return the names of the library's macros, in lower case."""
    return frozenset(name.lower() for name in _MACRO.findall(store.macro_definitions()))


@cache
def functions() -> frozenset[str]:
    """Return the scalar, aggregate and window functions and macros that a rule may call, in lower case."""
    return _STOCK | macros()


@cache
def tables() -> frozenset[str]:
    """Return the tables that a rule may read: those of schemas/ but the outputs, and the engine's own two."""
    outputs = {table for file in _OUTPUTS for table in store.column_comments(file)}
    return frozenset(store.column_comments().keys() - outputs) | ENGINE_TABLES
