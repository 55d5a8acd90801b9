"""Defines which rows of an audit count if a log was judged several times. Every count of a fleet follows these rules.

Logs with the same content are one log, whatever their names are.

* A log counts as one drive.
* An ego of a log counts once, and so do its distance and time. Different egos of a log count separately.
* A verdict or finding that occurs in several results of the log counts once. A verdict or finding that occurs in only one result counts
  too, such as one under other conditions.
* A rate takes the verdicts of an ego from the first result that has the ego; with a tag, from the first result at each value of the tag.
  The first result is the one with the smallest `log`; see `queries/fleet/first_result.sql`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from drivelint.fleet.situations import tag_or_situation_sql
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    import duckdb

COUNTED_PREFIX: Final = "counted_"
"""The prefix of these views' names."""
_COLUMNS_THAT_IDENTIFY_ROWS: Final = {
    "verdicts": "t.ego_id, t.rule_id, t.profile, t.object_id, t.occurrence, t.ref_id, t.t_start_ns, t.verdict",
    "findings": "t.ego_id, t.rule_id, t.profile, t.object_id, t.t_start_ns, t.t_end_ns",
}
"""Table -> columns. Rows of the same log that are equal in these columns count once."""


def create_counted_views(con: duckdb.DuckDBPyConnection, of: str = "") -> str:
    """Create views of an audit in which each log is one drive; return the prefix of their names.

    `of`: prefix of the audit's own views. `drives` has the first result of each log, with the egos of all its results, and without tags
    that have several values. In `verdicts` and `findings`, `key` is the key of the row in `drives`, and `result_key` the key of the
    original result.
    """
    prefix = f"{COUNTED_PREFIX}{of}"
    first = statement("fleet/first_result")
    con.execute(statement("fleet/counted_key", of=of, counted=prefix, first=first))
    con.execute(statement("fleet/counted_drives", of=of, counted=prefix))
    for table, same in _COLUMNS_THAT_IDENTIFY_ROWS.items():
        con.execute(statement("fleet/counted_rows", of=of, counted=prefix, table=table, same=same))
    con.execute(f"CREATE OR REPLACE TEMP VIEW {prefix}rules AS FROM {of}rules")
    return prefix


def counted_egos_sql(of: str = "", by: str | None = None, without: str = "", value: str | None = None) -> str:
    """Return the SQL fragment `subject` of a statement: one row per ego that counts, with its distance and time.

    `of`: prefix of the audit's views. `by`: a tag or a situation. `without`: a join that removes drives `d`. `value`: the SQL
    expression of a drive's value; default: that of `by`.
    """
    return statement(
        "fleet/subject",
        of=of,
        value=tag_or_situation_sql(by) if value is None else value,
        without=without,
        first=statement("fleet/first_result"),
    )
