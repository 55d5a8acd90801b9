"""Finds one body that is recorded as two tracks, and the first samples of tracks that begin somewhere else.

A tracker may keep a second track of a long vehicle, and a data set may have a rider and the bicycle. Two boxes that lie deep in each
other from the first sample that both have, at the same velocity, are one body: vehicles that collide were apart before. `states` are in
order, with their velocities completed; what is not believed is doubted, and stays as it is recorded.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from drivelint.drive.implausible import TYRE_MPS2
from drivelint.drive.order import track_starts

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from drivelint.arrays import Floats, Indices
    from drivelint.drive.actors import Actors
    from drivelint.drive.order import Steps
    from drivelint.drive.trace import QualityFinding, States

DEEP_SHARE: Final = 0.5
"""Two boxes lie deep in each other if they overlap by this share of the smaller one, along it and across it."""
SAME_MPS: Final = 2.0
"""Tracks of one body differ in velocity by no more than this, as the median."""
COMMON_SHARE: Final = 0.8
"""They lie in each other in at least this share of the samples that both have,"""
LEAST_COMMON: Final = 3
"""and have at least so many in common."""
ENTRY_SAMPLES: Final = 3
"""A track that begins somewhere else comes to its place within so many samples."""
ENTRY_LEAST_MPS: Final = 5.0
"""A first step that differs less from the next one is noise of the first detections."""


class _Boxes(NamedTuple):
    """Boxes (n): middle (2, n), unit vector along the box (2, n), half length and half width, velocity (2, n)."""

    place: Floats
    along: Floats
    half: Floats
    velocity: Floats


def same_bodies(states: States, actors: Actors, egos: Collection[str]) -> list[QualityFinding]:
    """Return a finding for each track that is another one's body; of two, the ego's, else the longer one, is believed."""
    starts = track_starts(states.actor)
    ends = np.r_[starts[1:], len(states)]
    findings = []
    for a, b in _begin_upon(states, actors, starts):
        rows_a, rows_b = _common(states, slice(starts[a], ends[a]), slice(starts[b], ends[b]))
        one, other = _boxes(states, actors, rows_a), _boxes(states, actors, rows_b)
        deep = _deep(one, other)
        if len(deep) < LEAST_COMMON or not deep[0] or deep.mean() < COMMON_SHARE:
            continue
        if not np.nanmedian(np.hypot(*(one.velocity - other.velocity))) <= SAME_MPS:
            continue
        order = sorted((a, b), key=lambda i: (states.ids[i] not in egos, int(starts[i] - ends[i]), states.ids[i]))
        kept, left = (states.ids[i] for i in order)
        rows = np.zeros(len(states), np.bool_)
        rows[(rows_a if states.ids[a] == left else rows_b)[deep]] = True
        text = f"{left} is the same body as {kept}, in {{n}} of {{of}} states: it is not believed"
        findings += states.findings(rows, "same_body", "warning", text, quantity="identity")
    return findings


def false_entries(states: States, step: Steps) -> list[QualityFinding]:
    """Return a finding on the first samples of tracks that come to their place by a step that nobody makes."""
    n = len(states)
    rows = np.zeros(n, np.bool_)
    starts = track_starts(states.actor)
    ends = np.r_[starts[1:], n]
    with np.errstate(invalid="ignore", divide="ignore"):
        moved = np.where(step.continuous, np.diff(states.place) / step.dt_s, np.nan)
    for k in range(ENTRY_SAMPLES):
        first = starts[ends - starts > ENTRY_SAMPLES + 2] + k
        change = np.hypot(*(moved[:, first] - moved[:, first + 1]))
        hard = change > ENTRY_LEAST_MPS + TYRE_MPS2 * (step.dt_s[first] + step.dt_s[first + 1])
        faster = np.hypot(*moved[:, first]) > np.hypot(*moved[:, first + 1])
        for at in first[hard & faster]:
            rows[at - k : at + 1] = True
    text = "tracks begin elsewhere than they go on, as no motion explains, in {n} of {of} states ({ids})"
    return states.findings(rows, "false_entry", "warning", text, quantity="existence")


def _begin_upon(states: States, actors: Actors, starts: Indices) -> Iterator[tuple[int, int]]:
    """Yield pairs of tracks of which one has its first sample deep in the other's box."""
    order = np.argsort(states.t_ns, kind="stable")
    t_ns = states.t_ns[order]
    for number, first in enumerate(starts):
        low, high = np.searchsorted(t_ns, [states.t_ns[first], states.t_ns[first] + 1])
        others = order[low:high]
        # of two that begin together each is met once
        others = others[
            (states.actor[others] != number)
            & ((starts[states.actor[others]] != others) | (states.actor[others] > number))
        ]
        if len(others):
            mine = _boxes(states, actors, np.full(len(others), first))
            for row in others[_deep(mine, _boxes(states, actors, others))]:
                yield number, int(states.actor[row])


def _common(states: States, a: slice, b: slice) -> tuple[Indices, Indices]:
    """Return the rows of two tracks at the times that both have."""
    _, in_a, in_b = np.intersect1d(states.t_ns[a], states.t_ns[b], assume_unique=True, return_indices=True)
    return in_a + a.start, in_b + b.start


def _boxes(states: States, actors: Actors, rows: Indices) -> _Boxes:
    index = {name: i for i, name in enumerate(actors.ids)}
    who = np.array([index[name] for name in states.ids])[states.actor[rows]]
    yaw = states.numbers["yaw_rad"][rows]
    half = np.stack([actors.sizes["length_m"][who], actors.sizes["width_m"][who]]) / 2.0
    return _Boxes(states.place[:, rows], np.stack([np.cos(yaw), np.sin(yaw)]), half, states.velocity[:, rows])


def _deep(one: _Boxes, other: _Boxes) -> Floats:
    """Say of each pair of boxes (n) whether they overlap by half of the smaller one along the first box and across it; NaN: no."""
    apart = other.place - one.place
    cos, sin = (one.along * other.along).sum(axis=0), one.along[0] * other.along[1] - one.along[1] * other.along[0]
    length, width = other.half
    reach = np.stack([length * abs(cos) + width * abs(sin), length * abs(sin) + width * abs(cos)])
    offset = np.stack([(apart * one.along).sum(axis=0), one.along[0] * apart[1] - one.along[1] * apart[0]])
    overlap = one.half + reach - np.abs(offset)
    deep: Floats = (overlap >= 2.0 * DEEP_SHARE * np.minimum(one.half, reach)).all(axis=0)
    return deep
