"""Doubts what no road user does: a jolt there and back, a step aside and back, a turn on the spot, a pedestrian as fast as a car.

What is doubted stays as it is recorded; the table `doubt` says of whom, of what and when, and no verdict rests on it. `states` are in
order, with their velocities completed.

A tracker may keep a second track of a long vehicle, and a data set may have a rider and the bicycle. Two boxes that lie deep in each
other from the first sample that both have, at the same velocity, are one body: vehicles that collide were apart before.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from drivelint.drive.order import integral_per_step, known_motion, track_starts, wrapped
from drivelint.drive.trace import MOTOR_VEHICLES
from drivelint.drive.velocity import Tracklets, sample_noise
from drivelint.phrases import listed

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from drivelint.arrays import Floats, Indices, Mask
    from drivelint.drive.actors import Actors
    from drivelint.drive.order import Steps
    from drivelint.drive.trace import QualityFinding, States

TYRE_MPS2: Final = 12.0
"""No tyre changes a velocity faster, and an impact does not change it back (see `ukhc.contact-signature`)."""
LONGEST_JOLT: Final = 2
"""A jolt of so many samples is one of the recording: central differences make two of one wrong position."""
LEAST_JOLT_MPS: Final = 1.0
"""Smaller ones are within the accuracy of a tracker's velocities."""
LEAST_STEP_M: Final = 0.5
STEP_SHARE: Final = 0.15
"""A single step of the positions differs from the velocities' way by noise and their error: more is a step of the recording."""
STEP_SIGMAS: Final = 6.0
BACK_SHARE: Final = 0.3
BACK_NS: Final = 3_000_000_000
"""A step aside is taken back by one that differs from its opposite by no more than this share, within this time."""
SPIN_LEAST_RAD: Final = np.deg2rad(12.0)
SPIN_RADIUS_M: Final = 3.0
SPIN_WINDOW_S: Final = 1.0
SPIN_MPS: Final = 1.0
"""A vehicle turns by no more than its way within a second divided by 3 m, which no turning circle undercuts, and a detector's noise."""
FASTEST_MPS: Final = {"pedestrian": 12.5, "animal": 30.0, "bicycle": 30.0}
"""Class -> the fastest that anybody of it is: a sprinter's record, a galloping horse, a descent of racers."""
LEAST_FAST_SAMPLES: Final = 3


def implausible_motion(states: States, step: Steps, actors: Actors, *, derived: bool) -> list[QualityFinding]:
    """Return findings, with their doubts, on what nobody does. `derived`: velocities come from the positions and do not contradict them."""
    if len(states) < 3:
        return []
    jolt = _jolts(states, step)
    findings = states.findings(
        jolt,
        "velocity_jolt",
        "warning",
        "velocity jumps there and back as no tyre can in {n} of {of} states ({ids})",
        quantity="velocity",
    )
    if not derived:
        aside = _displaced(states, step)
        text = "position steps aside, which the velocity does not, in {n} of {of} states ({ids})"
        findings += states.findings(aside, "position_step", "warning", text, quantity="position")
    spin = _spins(states, step, actors)
    text = "heading turns on the spot, as no vehicle can, in {n} of {of} states ({ids})"
    findings += states.findings(spin, "heading_spin", "warning", text, quantity="heading")
    fast = _too_fast(states, actors)
    return findings + states.findings(
        fast, "class_implausible", "warning", "faster than anybody of their class: {ids}", quantity="class"
    )


def _jolts(states: States, step: Steps) -> Mask:
    """Return the samples between two changes of velocity, against each other, of which no tyre makes either."""
    v = states.velocity
    jolt = np.zeros(len(states), np.bool_)
    change = np.diff(v)
    with np.errstate(invalid="ignore"):
        hard = step.continuous & (np.hypot(*change) > np.maximum(TYRE_MPS2 * step.dt_s, LEAST_JOLT_MPS))
    if not hard.any():
        return jolt
    for width in range(1, LONGEST_JOLT + 1):
        to, away = slice(0, -width), slice(width, None)
        whole = np.ones(len(change[0]) - width, np.bool_)
        for i in range(width + 1):
            whole &= step.continuous[i : len(step.continuous) - width + i]
        against = np.sum(change[:, to] * change[:, away], axis=0) < 0.0
        # what is left of both changes is what somebody can have done meanwhile
        span_s = sum(step.dt_s[i : len(step.dt_s) - width + i] for i in range(width + 1))
        goes_on = np.hypot(*(v[:, width + 1 :] - v[:, : -width - 1])) <= TYRE_MPS2 * span_s
        first = np.flatnonzero(hard[to] & hard[away] & whole & against & goes_on)
        for i in range(1, width + 1):
            jolt[first + i] = True
    return jolt


def _displaced(states: States, step: Steps) -> Mask:
    """Return the samples beside single steps of the positions that the velocities do not have, and those until a step is taken back."""
    aside = np.zeros(len(states), np.bool_)
    known = known_motion(states, step)
    off = np.where(known, np.diff(states.place) - integral_per_step(states.velocity, step, known), 0.0)
    size = np.hypot(*off)
    way = np.where(known, np.hypot(*np.diff(states.place)), 0.0)
    turn = np.where(known, np.hypot(*np.diff(states.velocity)) * step.dt_s / 2.0, 0.0)
    limit = LEAST_STEP_M + STEP_SHARE * way + turn
    if not (size > limit).any():
        return aside
    sigma = sample_noise(
        states.place, Tracklets.from_samples(states.t_ns, states.place, step), states.actor, unknown=0.0
    )
    limit = np.maximum(limit, STEP_SIGMAS * np.sqrt(2.0) * sigma[:-1])
    # a step stands alone: where the steps beside it are off alike, it is the velocity that is wrong
    alone = size > 2.0 * np.maximum(_shifted(off, size, 1), _shifted(off, size, -1))
    # an impact moves whom it hits, and changes its velocity
    hit = np.hypot(*np.diff(states.velocity)) > TYRE_MPS2 * step.dt_s
    at = np.flatnonzero((size > limit) & alone & ~hit)
    aside[at] = aside[at + 1] = True
    for a, b in pairwise(at):
        same = states.actor[a] == states.actor[b] and states.t_ns[b] - states.t_ns[a] <= BACK_NS
        if same and np.hypot(*(off[:, a] + off[:, b])) <= BACK_SHARE * size[a]:
            aside[a + 1 : b + 1] = True
    return aside


def _shifted(off: Floats, size: Floats, by: int) -> Floats:
    """Return how far the neighbouring step is off the same way as each step (n - 1)."""
    neighbour = np.roll(off, by, axis=1)
    neighbour[:, 0 if by > 0 else -1] = 0.0
    along: Floats = np.sum(neighbour * off, axis=0) / np.where(size > 0.0, size, 1.0)
    return along


def _spins(states: States, step: Steps, actors: Actors) -> Mask:
    """Return the samples within a second in which a vehicle that hardly moves turns further than its way allows."""
    spin, n = np.zeros(len(states), np.bool_), len(states)
    k = max(1, round(SPIN_WINDOW_S * 1e9 / step.period_ns)) if step.period_ns else n
    if n <= k:
        return spin
    kinds = dict(zip(actors.ids, actors.classes, strict=True))
    vehicle = np.array([kinds.get(name) in MOTOR_VEHICLES for name in states.ids], np.bool_)[states.actor]
    yaw, place = states.numbers["yaw_rad"], states.place
    same = (
        vehicle[k:]
        & (states.actor[k:] == states.actor[:-k])
        & (states.t_ns[k:] - states.t_ns[:-k] <= 2.0e9 * SPIN_WINDOW_S)
    )
    turn = np.abs(wrapped(yaw[k:] - yaw[:-k]))
    way = np.hypot(*(place[:, k:] - place[:, :-k]))
    slow = np.hypot(*states.velocity) < SPIN_MPS
    at = np.flatnonzero(same & slow[k:] & slow[:-k] & (turn > SPIN_LEAST_RAD + way / SPIN_RADIUS_M))
    edges = np.zeros(n + 1, np.int64)
    np.add.at(edges, at, 1)
    np.add.at(edges, at + k + 1, -1)
    spin[:] = (np.cumsum(edges[:-1]) > 0) & slow
    return spin


def _too_fast(states: States, actors: Actors) -> Mask:
    """Return all samples of the actors that are faster than anybody of their class in at least three samples."""
    kinds = dict(zip(actors.ids, actors.classes, strict=True))
    limits = np.array([FASTEST_MPS.get(kinds.get(name) or "", np.inf) for name in states.ids])
    over = np.hypot(*states.velocity) > limits[states.actor]
    many = np.bincount(states.actor[over], minlength=len(states.ids)) >= LEAST_FAST_SAMPLES
    return many[states.actor]


DEEP_SHARE: Final = 0.5
"""Two boxes lie deep in each other if they overlap by this share of the smaller one, along it and across it."""
SAME_MPS: Final = 2.0
"""Tracks of one body differ in velocity by no more than this, as the median."""
COMMON_SHARE: Final = 0.8
"""They lie in each other in at least this share of the samples that both have,"""
LEAST_COMMON: Final = 3
"""and have at least so many in common."""
FARTHEST_REACH_M: Final = 100.0
"""No two middles of bodies that lie in each other are further apart."""
FARTHEST_CELL: Final = 10**10
"""Cells of places that cannot be are one: their number times that of the times is a whole number of 64 bits."""
PAIRS_PER_PART: Final = 1_000_000
"""So many pairs of boxes are held in memory at once."""
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
    """Return a finding on the tracks that are another one's body; of two, the ego's, else the longer one, is believed."""
    rows, pairs = np.zeros(len(states), np.bool_), []
    for a, b in _begin_upon(states, actors):
        track_a, track_b = (slice(*np.searchsorted(states.actor, [i, i + 1]).tolist()) for i in (a, b))
        rows_a, rows_b = _common(states, track_a, track_b)
        one, other = _boxes(states, actors, rows_a), _boxes(states, actors, rows_b)
        deep = _deep(one, other)
        if len(deep) < LEAST_COMMON or not deep[0] or deep.mean() < COMMON_SHARE:
            continue
        if not np.nanmedian(np.hypot(*(one.velocity - other.velocity))) <= SAME_MPS:
            continue
        length = {a: track_a.stop - track_a.start, b: track_b.stop - track_b.start}
        order = sorted((a, b), key=lambda i: (states.ids[i] not in egos, -length[i], states.ids[i]))
        kept, left = (states.ids[i] for i in order)
        rows[(rows_a if states.ids[a] == left else rows_b)[deep]] = True
        pairs.append(f"{left} is the same body as {kept}")
    text = f"{listed(pairs)}, in {{n}} of {{of}} states: it is not believed" if pairs else ""
    return states.findings(rows, "same_body", "warning", text, quantity="identity")


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


def _begin_upon(states: States, actors: Actors) -> Iterator[tuple[int, int]]:
    """Yield pairs of tracks of which one has its first sample deep in the other's box."""
    starts = track_starts(states.actor)
    number = np.full(len(states), -1)
    number[starts] = np.arange(len(starts))
    for first, other in _neighbours(states, actors, starts):
        # of two that begin together each is met once
        once = (states.actor[first] != states.actor[other]) & ((number[other] < 0) | (number[other] > number[first]))
        first, other = first[once], other[once]  # noqa: PLW2901  the rest is of no use
        deep = _deep(_boxes(states, actors, first), _boxes(states, actors, other))
        yield from zip(states.actor[first[deep]].tolist(), states.actor[other[deep]].tolist(), strict=True)


def _neighbours(states: States, actors: Actors, starts: Indices) -> Iterator[tuple[Indices, Indices]]:
    """Yield, in parts, the rows that begin a track beside the rows of the same time whose box may reach so far along x."""
    half_m = np.hypot(actors.sizes["length_m"], actors.sizes["width_m"]) / 2.0
    reach_m = min(max(2.0 * float(np.nanmax(half_m, initial=0.0)), 1.0), FARTHEST_REACH_M)
    x = states.numbers["x_m"]
    rows, starts = np.flatnonzero(np.isfinite(x)), starts[np.isfinite(x[starts])]
    if not len(starts):
        return
    cell = np.floor(x[rows] / reach_m).clip(-FARTHEST_CELL, FARTHEST_CELL).astype(np.int64)
    # one whole number for time and cell, so that no neighbour of a cell is one of another time
    time = np.unique(states.t_ns[rows], return_inverse=True)[1].astype(np.int64)
    key = time * int(np.ptp(cell) + 3) + cell - cell.min()
    at = key[np.searchsorted(rows, starts)]
    order = np.argsort(key, kind="stable")
    rows, key = rows[order], key[order]
    low, high = np.searchsorted(key, at - 1), np.searchsorted(key, at + 1, side="right")
    part = np.cumsum(high - low) // PAIRS_PER_PART
    for k in np.unique(part):
        n, begin = (high - low)[part == k], low[part == k]
        nth = np.arange(int(n.sum())) - np.repeat(np.cumsum(n) - n, n)
        yield np.repeat(starts[part == k], n), rows[np.repeat(begin, n) + nth]


def _common(states: States, a: slice, b: slice) -> tuple[Indices, Indices]:
    """Return the rows of two tracks at the times that both have."""
    _, in_a, in_b = np.intersect1d(states.t_ns[a], states.t_ns[b], assume_unique=True, return_indices=True)
    return in_a + a.start, in_b + b.start


def _boxes(states: States, actors: Actors, rows: Indices) -> _Boxes:
    index = {name: i for i, name in enumerate(actors.ids)}
    who = np.array([index[name] for name in states.ids])[states.actor[rows]]
    x, y, yaw, vx, vy = (states.numbers[name][rows] for name in ("x_m", "y_m", "yaw_rad", "vx_mps", "vy_mps"))
    half = np.stack([actors.sizes["length_m"][who], actors.sizes["width_m"][who]]) / 2.0
    return _Boxes(np.stack([x, y]), np.stack([np.cos(yaw), np.sin(yaw)]), half, np.stack([vx, vy]))


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
