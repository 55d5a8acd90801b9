"""Moves the tables of a long drive to disk after they were copied into the database, so that memory does not contain them twice."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pyarrow as pa

from drivelint.sql.store import spill_folder

if TYPE_CHECKING:
    import duckdb

    from drivelint.drive.trace import Trace

LEAST_SPILLED_TABLE_BYTES = 200_000_000
"""Smaller tables stay in memory."""


def move_large_tables_to_disk(con: duckdb.DuckDBPyConnection, trace: Trace) -> None:
    """Replace large tables of a trace, in place, by memory-mapped files in the database's spill folder.

    If there is no such folder, or no space in it, the tables stay in memory.
    """
    folder = spill_folder(con)
    large = [name for name, rows in trace.tables.items() if rows.nbytes > LEAST_SPILLED_TABLE_BYTES]
    for name in large if folder else ():
        path = Path(folder) / f"{name}.arrow"
        try:
            with pa.OSFile(str(path), "wb") as sink, pa.ipc.new_file(sink, trace.tables[name].schema) as file:
                file.write_table(trace.tables[name].combine_chunks())
            trace.tables[name] = pa.ipc.open_file(pa.memory_map(str(path))).read_all()
        except OSError:
            return
        finally:
            path.unlink(missing_ok=True)  # the system keeps the content as long as it is mapped
    if large:
        pa.default_memory_pool().release_unused()
