"""Cuts a time span out of a trace. A row that still applies at its start, such as the colour of a traffic light, is kept."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Final

import pyarrow as pa
import pyarrow.compute as pc

from drivelint.arrays import replace_columns

if TYPE_CHECKING:
    from drivelint.drive.trace import Trace

_KEYS_OF_LASTING_ROWS: Final = {"signal_state": ["signal_id"], "declared_event": ["actor_id", "event"]}
"""Table -> its keys: a row applies until the next row with the same keys."""


def cut_trace(trace: Trace, from_ns: int, to_ns: int) -> Trace:
    """Return a trace with the states from `from_ns` to `to_ns`, both included, and the actors that have states there.

    Errors: `ValueError` if there is no state in the span.
    """
    tables = dict(trace.tables)
    states = _rows_between(tables["actor_state"], from_ns, to_ns)
    if not states.num_rows:
        raise ValueError(f"no state from {from_ns} to {to_ns} ns")
    actor_ids = pc.unique(states["actor_id"])
    tables["actor_state"] = states
    tables["actor"] = tables["actor"].filter(pc.is_in(tables["actor"]["actor_id"], value_set=actor_ids))
    for name, keys in _KEYS_OF_LASTING_ROWS.items():
        tables[name] = _rows_between_and_still_valid_before(tables[name], keys, from_ns, to_ns)
    about = tables["quality"]["actor_id"]
    tables["quality"] = tables["quality"].filter(pc.or_(pc.is_null(about), pc.is_in(about, value_set=actor_ids)))
    tables["data_log"] = _log_row_of_states(tables["data_log"], states)
    return replace(trace, tables=tables, frame_times=None)


def _rows_between(rows: pa.Table, from_ns: int, to_ns: int) -> pa.Table:
    return rows.filter(pc.and_(pc.greater_equal(rows["t_ns"], from_ns), pc.less_equal(rows["t_ns"], to_ns)))


def _rows_between_and_still_valid_before(rows: pa.Table, keys: list[str], from_ns: int, to_ns: int) -> pa.Table:
    """Return the rows of the span and, for each key, the last row before it."""
    before = rows.filter(pc.less(rows["t_ns"], from_ns))
    last = before.group_by(keys).aggregate([("t_ns", "max")]).rename_columns([*keys, "t_ns"])
    valid = before.join(last, [*keys, "t_ns"], join_type="left semi", use_threads=False).select(rows.column_names)
    order = [(name, "ascending") for name in ("t_ns", *keys)]
    return pa.concat_tables([valid, _rows_between(rows, from_ns, to_ns)]).sort_by(order).cast(rows.schema)


def _log_row_of_states(log: pa.Table, states: pa.Table) -> pa.Table:
    """Return the row of `data_log` with the times and the number of these states."""
    span = pc.min_max(states["t_ns"]).as_py()
    start, utc = log["t_start_ns"][0].as_py(), log["utc_start_ns"][0].as_py()
    later = None if utc is None or start is None else utc + span["min"] - start
    return replace_columns(
        log,
        {
            "t_start_ns": [span["min"]],
            "t_end_ns": [span["max"]],
            "n_states": [states.num_rows],
            "utc_start_ns": pa.array([later], pa.int64()),
        },
    )
