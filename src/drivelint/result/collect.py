"""The output tables, taken from a database that has been judged: verdicts, findings and one row per drive."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import pyarrow as pa

from drivelint.drive.trace import LOSS_CHECKS
from drivelint.reasons.reason_table import make_reason_table
from drivelint.result.schemas import arrow_schema, conform
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    import duckdb

_KEYS: Final = (
    "drive_id, ego_id, rule_id, profile NULLS FIRST, object_id NULLS FIRST, occurrence, ref_id NULLS FIRST, "
    "t_start_ns NULLS FIRST"
)

_ONLY: Final = "coalesce(list_contains($only::VARCHAR[], drive_id), true)"  # no list: every drive


def verdicts(con: duckdb.DuckDBPyConnection, only: list[str] | None = None) -> pa.Table:
    """Return the table `verdict`, of these drives or all, totally ordered."""
    return conform(
        con.execute(f"SELECT * FROM verdict WHERE {_ONLY} ORDER BY {_KEYS}", {"only": only}).to_arrow_table(), "verdict"
    )


def findings(con: duckdb.DuckDBPyConnection, only: list[str] | None = None) -> pa.Table:
    """Return the table `finding`, of these drives or all, totally ordered."""
    rows = con.execute(f"SELECT * FROM finding WHERE {_ONLY} ORDER BY {_KEYS}, finding_id", {"only": only})
    return conform(rows.to_arrow_table(), "finding")


def drives(con: duckdb.DuckDBPyConnection, only: list[str] | None = None) -> pa.Table:
    """Return one row of the table `drive` per log in the database, or per named one: judged, and on what; ordered."""
    make_reason_table(con, "SELECT NULL AS rule_no, reason AS cause, 0 AS start_ns FROM capability WHERE NOT available")
    return conform(
        con.execute(statement("evidence/drive"), {"only": only, "losses": LOSS_CHECKS}).to_arrow_table(), "drive"
    )


def unjudged_drive(drive_id: str, file_name: str, reason: str, sha256: str | None = None) -> pa.Table:
    """Return the row of the table `drive` for a log that could not be judged at all, and why."""
    schema = arrow_schema("drive")
    row = dict.fromkeys(schema.names)
    row |= {key: [] for key in ("conditions", "exposure", "occasions", "quality", "not_judged")}
    row |= dict.fromkeys(("n_states", "n_steps", "n_egos"), 0)
    row |= {"drive_id": drive_id, "file_name": file_name, "sha256": sha256, "km": 0.0, "lossy": False}
    row |= {"status": "not_judged", "status_reason": reason}
    return pa.Table.from_pylist([row], schema=schema)
