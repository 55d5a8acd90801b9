"""Summarises the log's time stamps, and the track of every actor."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pyarrow.compute as pc

from drivelint.arrays import floats
from drivelint.drive.order import MAX_GAP_PERIODS
from drivelint.drive.trace import MOTOR_VEHICLES
from drivelint.inspect.model import Actor, ClassCount, Clock
from drivelint.result.counts import group_rows
from drivelint.result.text import utc

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.drive.trace import Trace

MIN_MOVED_M = 1.0
"""An actor that moved by less counts as not moving, because positions of parked cars are noisy."""


def clock(trace: Trace) -> Clock:
    """Return start, duration, period and gaps of the log's time stamps."""
    log = trace.tables["data_log"].to_pylist()[0]
    t_ns = np.unique(trace.tables["actor_state"]["t_ns"].to_numpy())
    gaps = np.diff(t_ns)
    period = float(np.median(gaps)) if len(gaps) else None
    holes = np.flatnonzero(gaps > MAX_GAP_PERIODS * period) if period else np.zeros(0, np.intp)
    start = int(t_ns[0])
    return Clock(
        start_ns=start,
        utc_start=utc(log["utc_start_ns"]),
        duration_s=(int(t_ns[-1]) - start) / 1e9,
        steps=len(t_ns),
        period_s=None if period is None else period / 1e9,
        holes=len(holes),
        longest_hole_s=float(gaps[holes].max()) / 1e9 if len(holes) else None,
        first_hole_at_s=(int(t_ns[holes[0]]) - start) / 1e9 if len(holes) else None,
    )


def actors(trace: Trace) -> list[Actor]:
    """Return every actor that has states, sorted by id."""
    states = trace.tables["actor_state"]  # sorted by actor, then time
    start = pc.min(states["t_ns"]).as_py()
    encoded = states["actor_id"].combine_chunks().dictionary_encode()
    code = encoded.indices.to_numpy()
    firsts = np.flatnonzero(np.r_[True, code[1:] != code[:-1]])
    counts = np.diff(np.r_[firsts, len(code)])
    x, y, vx, vy = (floats(states[name]) for name in ("x_m", "y_m", "vx_mps", "vy_mps"))
    step = np.nan_to_num(np.hypot(np.diff(x, prepend=np.nan), np.diff(y, prepend=np.nan)))
    step[firsts] = 0.0
    way = np.add.reduceat(step, firsts)
    top = np.fmax.reduceat(np.hypot(vx, vy), firsts)
    times = states["t_ns"].to_numpy()
    row_by_id = {row["actor_id"]: row for row in trace.tables["actor"].to_pylist()}
    names = encoded.dictionary.take(encoded.indices.take(firsts)).to_pylist()
    return [
        Actor(
            **{key: row_by_id[name][key] for key in ("actor_id", "actor_class", "length_m", "width_m")},
            states=int(counts[k]),
            first_at_s=(int(times[firsts[k]]) - start) / 1e9,
            last_at_s=(int(times[firsts[k] + counts[k] - 1]) - start) / 1e9,
            way_m=float(way[k]),
            top_speed_mps=None if np.isnan(top[k]) else float(top[k]),
        )
        for k, name in enumerate(names)
    ]


def counts_by_actor_class(trace_actors: Sequence[Actor]) -> list[ClassCount]:
    """Return the counts of actors per class, the largest class first."""
    counts = [
        ClassCount(
            actor_class=name,
            n=len(some),
            sized=sum(a.length_m is not None and a.width_m is not None for a in some),
            moving=sum(a.way_m > MIN_MOVED_M for a in some),
        )
        for name, some in group_rows(trace_actors, lambda actor: actor.actor_class).items()
    ]
    return sorted(counts, key=lambda c: (-c.n, c.actor_class or "~"))


def ego_candidates(trace_actors: Sequence[Actor]) -> list[Actor]:
    """Return the possible egos, the longest track first: motor vehicles, else actors of unknown class, else all actors."""
    likely = [a for a in trace_actors if a.actor_class in MOTOR_VEHICLES] or [
        a for a in trace_actors if a.actor_class is None
    ]
    return sorted(likely or trace_actors, key=lambda a: (-round(a.way_m, 3), a.actor_id))
