"""Gathers one record for each overtake and each overtaking opportunity of a batch."""

from __future__ import annotations

from typing import TYPE_CHECKING

from drivelint.reasons.reason_table import make_reason_table
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    import duckdb


def gather(con: duckdb.DuckDBPyConnection) -> None:
    """Add the overtakes and opportunities of the batch, as far as its rules needed them."""
    make_reason_table(con, "SELECT NULL AS rule_no, reason AS cause, 0 AS start_ns FROM overtake_sda")
    con.execute(statement("evidence/overtake_record"))
    con.execute(statement("evidence/opportunity_record"))
