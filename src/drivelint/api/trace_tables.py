"""The tables of one recorded drive as a Python object."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from drivelint.api.tables import Table, TableSet
from drivelint.result.schemas import empty_table

if TYPE_CHECKING:
    import pyarrow as pa

    from drivelint.drive.trace import Trace

_LANE_TABLE: Final = "lane_shape"


class TraceTables(TableSet):
    """The tables of one drive on which rules are judged, in metres, seconds and radians, with positions of box centres.

    `data_log` has one row. `drivelint docs dictionary` describes the columns. `lanes`: the lanes of the drive's map with their bounds, see
    `drivelint docs columns`; empty without a map. `embedded_map`: OpenDRIVE from the log, or None. `notes`: the reader's messages
    about the log.
    """

    data_log: Table
    actor: Table
    actor_state: Table
    signal_state: Table
    declared_event: Table
    drive_condition: Table
    quality: Table
    doubt: Table
    lanes: Table

    def __init__(self, trace: Trace, lanes: pa.Table | None = None) -> None:
        tables = {**trace.tables, "lanes": empty_table(_LANE_TABLE) if lanes is None else lanes}
        super().__init__(tables, schema_tables={"lanes": _LANE_TABLE})
        for name, table in self.tables.items():
            setattr(self, name, table)
        self.drive_id = trace.drive_id
        self.path = trace.path
        self.embedded_map = trace.embedded_map
        self.notes = tuple(trace.notes)

    def __repr__(self) -> str:
        rows = ", ".join(f"{name} {len(table)}" for name, table in self.tables.items())
        return f"<drivelint.TraceTables of {self.drive_id}: rows of {rows}>"
