"""Makes a temporary database table with the text of each distinct reason."""

from __future__ import annotations

import json
from math import isfinite
from typing import TYPE_CHECKING, Any

import pyarrow as pa

from drivelint.reasons import reason_text
from drivelint.sql import store

if TYPE_CHECKING:
    from collections.abc import Mapping

    import duckdb

    from drivelint.reasons.reason_text import ReasonText

_TABLE = """
CREATE OR REPLACE TEMP TABLE _worded
    (rule_no INTEGER, cause VARCHAR, start_ns BIGINT, words VARCHAR, cause_code VARCHAR, cause_args VARCHAR)
"""


def _json(arguments: Mapping[str, Any]) -> str:
    """Return arguments as JSON, with null for NaN and infinity, which JSON does not have."""
    values = {
        name: None if isinstance(value, float) and not isfinite(value) else value for name, value in arguments.items()
    }
    return json.dumps(values)


def make_reason_table(
    con: duckdb.DuckDBPyConnection, select: str, rule_texts: Mapping[int, Mapping[str, ReasonText]] | None = None
) -> None:
    """Make the temporary table `_worded` from the distinct rows of `select`: rule_no, cause, start_ns (the log's start, not NULL).

    It has these columns, and the words of the cause, its code, and its arguments as JSON. `rule_texts`: rule_no -> code -> text, for
    the codes of that rule.
    """
    con.execute(_TABLE)
    causes = con.execute(
        f"SELECT DISTINCT rule_no, cause, start_ns FROM ({select}) WHERE cause IS NOT NULL ORDER BY ALL"
    ).fetchall()
    if not causes:
        return  # saves ten milliseconds; most short drives have no causes
    reasons = [reason_text.parse_reason(cause) for _, cause, _ in causes]
    sentences = [reason_text.sentence(cause, start_ns, (rule_texts or {}).get(no)) for no, cause, start_ns in causes]
    rows = {
        "rule_no": pa.array([no for no, _, _ in causes], pa.int32()),
        "cause": pa.array([cause for _, cause, _ in causes], pa.string()),
        "start_ns": pa.array([start_ns for _, _, start_ns in causes], pa.int64()),
        "words": pa.array(sentences, pa.string()),
        "cause_code": pa.array([reason.code for reason in reasons], pa.string()),
        "cause_args": pa.array(
            [_json(reason.arguments) if reason.arguments else None for reason in reasons], pa.string()
        ),
    }
    store.insert(con, "_worded", pa.table(rows))
