"""Turns the recorded state of the headlights into declared events, which rules can read."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

if TYPE_CHECKING:
    from drivelint.drive.trace import States

HEADLIGHTS: Final = "headlights"
"""Name of the code in `States.codes`, which indexes `HEADLIGHT_STATES`, and of the event."""
HEADLIGHT_STATES: Final = ("off", "on")


def with_headlight_events(events: pa.Table | None, states: States) -> pa.Table | None:
    """Return the log's events with one row for each change of an actor's headlights; NULL means unknown from then on.

    `states` in order of actor and time. An actor that declares its headlights itself is left as it is.
    """
    codes = states.codes.get(HEADLIGHTS)
    if codes is None or not (codes >= 0).any():
        return events
    changed = np.r_[True, (states.actor[1:] != states.actor[:-1]) | (codes[1:] != codes[:-1])]
    told = np.bincount(states.actor[codes >= 0], minlength=len(states.ids)) > 0
    if events is not None:
        declared = set(events.filter(pc.equal(events["event"], HEADLIGHTS))["actor_id"].to_pylist())
        told &= [name not in declared for name in states.ids]
    rows = np.flatnonzero(changed & told[states.actor])
    lamps = pa.table(
        {
            "t_ns": pa.array(states.t_ns[rows], pa.int64()),
            "actor_id": pa.array([states.ids[i] for i in states.actor[rows]], pa.string()),
            "event": pa.array([HEADLIGHTS] * len(rows), pa.string()),
            "value": pa.array([None if code < 0 else HEADLIGHT_STATES[code] for code in codes[rows]], pa.string()),
        }
    )
    return lamps if events is None else pa.concat_tables([events.select(lamps.column_names), lamps])
