"""Views of an audit's verdicts and findings in which logs of one content count once."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from drivelint.sql.statements import statement

if TYPE_CHECKING:
    import duckdb

COUNTED: Final = "counted_"
"""What the names of these views begin with."""
_SAME: Final = {
    "verdicts": "ego_id, rule_id, profile, object_id, occurrence, ref_id, t_start_ns, verdict",
    "findings": "ego_id, rule_id, profile, object_id, t_start_ns, t_end_ns",
}
"""Table -> what makes two rows of logs of one content the same."""


def create_counted_views(con: duckdb.DuckDBPyConnection) -> None:
    """Create `counted_verdicts` and `counted_findings`, of the views of an audit."""
    for table, same in _SAME.items():
        con.execute(statement("fleet/counted", table=table, columns=same))
