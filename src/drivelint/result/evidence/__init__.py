"""Evidence for pictures and charts, taken from the database while a batch is in it, into tables that stay until the end of the run.

Scenes of findings and near misses with lanes and danger spaces; tracks; overtakes and opportunities. (Courses are the evaluation's.)
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from drivelint.reasons.reason_table import make_reason_table
from drivelint.result.evidence import lane_shapes, surroundings
from drivelint.result.schemas import TABLE_OF_FILE
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    import duckdb
    import pyarrow as pa

_KEYS: Final = {
    "scenes": "drive_id, ego_id, t_ns",
    "lanes": "environment_id, lanelet_id",
    "spaces": "drive_id, ego_id, t_ns, actor_id <> ego_id, actor_id",
    "courses": "finding_id IS NULL, finding_id, drive_id, ego_id, rule_id, profile, object_id, occurrence",
    "tracks": "drive_id, NOT is_ego, actor_id, part",
    "overtakes": "drive_id, ego_id, occurrence",
    "opportunities": "drive_id, ego_id, occurrence, style, profile",
}
"""Table of evidence in a result -> the order of its rows."""


def gather(con: duckdb.DuckDBPyConnection) -> None:
    """Add the evidence of the batch that was just judged.

    Reads `finding` and `verdict` (of which those of this batch have their states in `ego_state` and `pair`).
    """
    surroundings.gather(con)
    lane_shapes.gather(con)
    con.execute(statement("evidence/track"), {"step_ns": surroundings.PATH_STEP_NS})
    make_reason_table(con, "SELECT NULL AS rule_no, reason AS cause, 0 AS start_ns FROM overtake_sda")
    con.execute(statement("evidence/overtake_record"))
    con.execute(statement("evidence/opportunity_record"))


def tables(con: duckdb.DuckDBPyConnection) -> dict[str, pa.Table]:
    """Return the tables of evidence under the names that `Result` has for them, totally ordered."""
    return {
        name: con.execute(f"SELECT * FROM {TABLE_OF_FILE[name]} ORDER BY {keys}").to_arrow_table()
        for name, keys in _KEYS.items()
    }
