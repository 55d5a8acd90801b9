"""States of one actor at a place."""

from __future__ import annotations

from pathlib import Path

import pyarrow as pa

from drivelint.drive.trace import Trace
from drivelint.sql.store import table_with_owner_id


def states(x: float) -> pa.Table:
    return pa.table(
        {
            "x_m": [x + i for i in range(20)],
            "y_m": [0.0] * 20,
            "yaw_rad": [0.0] * 20,
            "vx_mps": [10.0] * 20,
            "vy_mps": [0.0] * 20,
        }
    )


def log_of(
    rows: pa.Table, path: Path = Path("logs/drive.mcap"), *, embedded: bytes | None = None, reference: str | None = None
) -> Trace:
    """Return a drive of these states only."""
    tables = {"drive_condition": table_with_owner_id("drive_condition", "drive", [], "few"), "actor_state": rows}
    return Trace("drive", path, tables, embedded, None, [], geo_reference=reference)
