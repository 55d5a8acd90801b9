"""One row per actor: its class and box, from its states or from the log's own actor table."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from drivelint.drive.order import track_starts
from drivelint.drive.trace import ACTOR_CLASSES, SIZE_COLUMNS, QualityFinding
from drivelint.phrases import listed

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pyarrow as pa

    from drivelint.arrays import Floats
    from drivelint.drive.trace import States

LARGEST_SIZE_SPREAD_M = 0.05
"""Sizes that spread by more than this over a track were estimated, not known."""


@dataclass
class Actors:
    """Actors sorted by id: class (None: unknown) and sizes in metres (NaN: unknown)."""

    ids: list[str]
    classes: list[str | None]
    sizes: dict[str, Floats]


def from_states(states: States) -> tuple[Actors, list[QualityFinding]]:
    """Collect each actor's class (the first known) and sizes (the median of those known). `states` in order."""
    starts = track_starts(states.actor)
    classes: list[str | None] = [None] * len(states.ids)
    codes = states.codes.get("actor_class")
    if codes is not None and len(states):
        known = np.flatnonzero(codes >= 0)
        actors, first = np.unique(states.actor[known], return_index=True)
        for actor, row in zip(actors, known[first], strict=True):
            classes[actor] = ACTOR_CLASSES[codes[row]]
    sizes, varying = {}, set()
    for name in SIZE_COLUMNS:
        values = states.numbers.get(name)
        if values is None or not len(states):
            sizes[name] = np.full(len(states.ids), np.nan)
            continue
        positive = np.where(values > 0.0, values, np.nan)  # a box of no size is one whose size was not written
        low, high = np.fmin.reduceat(positive, starts), np.fmax.reduceat(positive, starts)
        ends = np.r_[starts[1:], len(states)]
        for i in np.flatnonzero(high - low > 0.0):
            track = np.sort(positive[starts[i] : ends[i]])
            track = track[~np.isnan(track)]
            if high[i] - low[i] > LARGEST_SIZE_SPREAD_M:
                varying.add(states.ids[i])
            low[i] = track[(len(track) - 1) // 2]
        sizes[name] = low
    findings = []
    if varying:
        ids = sorted(varying)
        message = f"box size changes over the log ({listed(ids)}): the median is used throughout"
        findings.append(QualityFinding.of_actors("size_varies", "warning", message, ids))
    return Actors(states.ids, classes, sizes), findings


def from_table(table: pa.Table, states: States, alias: Mapping[str, str]) -> Actors:
    """Read the log's own actor table (first row of each id); actors that only have states are added as unknown.

    `alias`: an id that the table does not have -> the one whose row is its own (see `contradiction`).
    """
    rows = {str(row["actor_id"]): row for row in reversed(table.to_pylist()) if row["actor_id"] not in {None, ""}}
    rows |= {new: rows[old] for new, old in alias.items() if old in rows}
    ids = sorted({*rows, *states.ids})
    nothing: dict[str, object] = {}
    classes = [str(value) if (value := rows.get(i, nothing).get("actor_class")) else None for i in ids]
    sizes = {}
    for name in SIZE_COLUMNS:
        raw = np.array(
            [np.nan if (value := rows.get(i, nothing).get(name)) is None else value for i in ids], np.float64
        )
        sizes[name] = np.where(np.isfinite(raw) & (raw > 0.0), raw, np.nan)
    return Actors(ids, classes, sizes)
