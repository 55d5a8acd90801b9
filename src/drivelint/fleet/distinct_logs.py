"""Defines the counted rows of an audit in which a log was judged several times. Every count of a fleet follows it.

Logs with the same content are one log, whatever their names are.

* A log counts as one drive.
* An ego of a log counts once, and its distance and time count once. Other egos of the log count each.
* A verdict or finding that several results of the log have counts once. One that a single result has counts too, such as one under
  other conditions: a copy hides nothing.
* A rate takes the verdicts of an ego from the first result that has it; with a tag, from the first at each value of the tag. The first
  is that with the least `log`; see `queries/fleet/first_result.sql`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from drivelint.fleet.situations import value_of
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    import duckdb

COUNTED_PREFIX: Final = "counted_"
"""What the names of these views begin with."""
_SAME: Final = {
    "verdicts": "t.ego_id, t.rule_id, t.profile, t.object_id, t.occurrence, t.ref_id, t.t_start_ns, t.verdict",
    "findings": "t.ego_id, t.rule_id, t.profile, t.object_id, t.t_start_ns, t.t_end_ns",
}
"""Table -> columns that make two rows of one log the same."""


def create_counted_views(con: duckdb.DuckDBPyConnection, of: str = "") -> str:
    """Create views of an audit in which each log is one drive; return the prefix of their names.

    `of`: what the names of the audit's views begin with. `drives` has the first result of each log, with the egos of all its results; a tag
    with several values is left out. In `verdicts` and `findings`, `key` is that of the row in `drives`, `result_key` that of the result.
    """
    counted = f"{COUNTED_PREFIX}{of}"
    first = statement("fleet/first_result")
    con.execute(statement("fleet/counted_key", of=of, counted=counted, first=first))
    con.execute(statement("fleet/counted_drives", of=of, counted=counted))
    for table, same in _SAME.items():
        con.execute(statement("fleet/counted_rows", of=of, counted=counted, table=table, same=same))
    con.execute(f"CREATE OR REPLACE TEMP VIEW {counted}rules AS FROM {of}rules")
    return counted


def subject(of: str = "", by: str | None = None, without: str = "") -> str:
    """Return the part `subject` of a statement: one row per ego that counts, with its distance and time.

    `of`: what the names of the audit's views begin with. `by`: a tag or a situation. `without`: a join that leaves drives `d` out.
    """
    return statement("fleet/subject", of=of, value=value_of(by), without=without, first=statement("fleet/first_result"))
