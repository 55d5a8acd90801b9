"""Runs the statements of `queries/fleet_report`, and returns SQL fragments that several of them share."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from drivelint.fleet.distinct_logs import COUNTED_PREFIX
from drivelint.result.certainty import LEAST_SHARE_OF_COPIES_FOR_CERTAIN_FINDING
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    import duckdb

    Row = dict[str, Any]


def query_rows(
    con: duckdb.DuckDBPyConnection, statement_name: str, parameters: Row | None = None, **fragments: str
) -> list[Row]:
    """Return the rows of a statement of `queries/fleet_report`."""
    rows: list[Row] = (
        con.execute(statement(f"fleet_report/{statement_name}", **fragments), parameters or {})
        .to_arrow_table()
        .to_pylist()
    )
    return rows


def ranked_drives_sql() -> str:
    """Return the SELECT of the drives with findings, the worst drives first."""
    return statement(
        "fleet_report/ranked",
        least_share=str(LEAST_SHARE_OF_COPIES_FOR_CERTAIN_FINDING),
        event=finding_per_event_sql(COUNTED_PREFIX),
    )


def finding_per_event_sql(view_prefix: str) -> str:
    """Return the SELECT of one finding per event. `view_prefix`: prefix of the table `findings`."""
    return statement("fleet/event", of=view_prefix, least_share=str(LEAST_SHARE_OF_COPIES_FOR_CERTAIN_FINDING))


def counted_finding_of_each_finding_sql(view_prefix: str) -> str:
    """Return the SELECT of the id of the finding that is counted for the event of each finding."""
    return statement(
        "fleet_report/counted_id", of=view_prefix, least_share=str(LEAST_SHARE_OF_COPIES_FOR_CERTAIN_FINDING)
    )


def severity_order_sql() -> str:
    """Return the ORDER BY expressions that sort the findings `f` of the rules `r` from most to least severe."""
    return statement("fleet_report/gravest_first", least_share=str(LEAST_SHARE_OF_COPIES_FOR_CERTAIN_FINDING))


def options_column_sql(con: duckdb.DuckDBPyConnection) -> str:
    """Return the SQL of a drive's options in its receipt `r`; receipts of older audits lack this column."""
    columns = {row[0] for row in con.execute("DESCRIBE receipts").fetchall()}
    return "r.options" if "options" in columns else "NULL"
