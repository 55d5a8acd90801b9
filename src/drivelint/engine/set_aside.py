"""Keeps the tables of a long drive on disk once the database has them: memory has to hold them once, not twice."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pyarrow as pa

from drivelint.sql.store import spill_folder

if TYPE_CHECKING:
    import duckdb

    from drivelint.drive.trace import Trace

LEAST_BYTES = 200_000_000
"""A smaller table stays in memory."""


def set_aside(con: duckdb.DuckDBPyConnection, trace: Trace) -> None:
    """Replace large tables of a trace, in place, by equal ones that the system reads from the database's spill folder when they are used.

    Where there is no such folder, or no room in it, they stay in memory.
    """
    folder = spill_folder(con)
    large = [name for name, rows in trace.tables.items() if rows.nbytes > LEAST_BYTES]
    for name in large if folder else ():
        path = Path(folder) / f"{name}.arrow"
        try:
            with pa.OSFile(str(path), "wb") as sink, pa.ipc.new_file(sink, trace.tables[name].schema) as file:
                file.write_table(trace.tables[name].combine_chunks())
            trace.tables[name] = pa.ipc.open_file(pa.memory_map(str(path))).read_all()
        except OSError:
            return
        finally:
            path.unlink(missing_ok=True)  # the system keeps the content as long as it is in use
    if large:
        pa.default_memory_pool().release_unused()
