"""Evidence for pictures and charts, taken from the database while a batch is in it, into tables that stay until the end of the run.

Scenes of findings and near misses with lanes and danger spaces; overtakes and opportunities. (Courses are the evaluation's.)
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from drivelint.result.evidence import lane_shapes, overtaking, surroundings
from drivelint.result.schemas import conform

if TYPE_CHECKING:
    import duckdb
    import pyarrow as pa


def gather(con: duckdb.DuckDBPyConnection) -> None:
    """Add the evidence of the batch that was just judged.

    Reads `finding` and `verdict` (of which those of this batch have their states in `ego_state` and `pair`).
    """
    surroundings.gather(con)
    lane_shapes.gather(con)
    overtaking.gather(con)


def scenes(con: duckdb.DuckDBPyConnection) -> pa.Table:
    """Return the table `scene`, totally ordered."""
    return _ordered(con, "scene", "drive_id, ego_id, t_ns")


def lanes(con: duckdb.DuckDBPyConnection) -> pa.Table:
    """Return the table `lane_shape`, totally ordered."""
    return _ordered(con, "lane_shape", "environment_id, lanelet_id")


def danger_spaces(con: duckdb.DuckDBPyConnection) -> pa.Table:
    """Return the table `danger_space`, totally ordered."""
    return _ordered(con, "danger_space", "drive_id, ego_id, t_ns, actor_id <> ego_id, actor_id")


def courses(con: duckdb.DuckDBPyConnection) -> pa.Table:
    """Return the table `course`, totally ordered."""
    return _ordered(
        con, "course", "finding_id IS NULL, finding_id, drive_id, ego_id, rule_id, profile, object_id, occurrence"
    )


def overtakes(con: duckdb.DuckDBPyConnection) -> pa.Table:
    """Return the table `overtake_record`, totally ordered."""
    return _ordered(con, "overtake_record", "drive_id, ego_id, occurrence")


def opportunities(con: duckdb.DuckDBPyConnection) -> pa.Table:
    """Return the table `opportunity_record`, totally ordered."""
    return _ordered(con, "opportunity_record", "drive_id, ego_id, occurrence, style, profile")


def _ordered(con: duckdb.DuckDBPyConnection, table: str, keys: str) -> pa.Table:
    return conform(con.execute(f"SELECT * FROM {table} ORDER BY {keys}").to_arrow_table(), table)
