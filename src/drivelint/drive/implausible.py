"""Doubts what no road user does: a jolt there and back, a step aside and back, a turn on the spot, a pedestrian as fast as a car.

What is doubted stays as it is recorded; the table `doubt` says of whom, of what and when, and no verdict rests on it. `states` are in
order, with their velocities completed.

A tracker may keep a second track of a long vehicle, and a data set may have a rider and the bicycle. Two boxes that lie deep in each
other from the first sample that both have, at the same velocity, are one body: vehicles that collide were apart before. So are two that
drive bumper to bumper, nearer than anybody follows, and sink into each other without an impact.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from drivelint.drive.order import integral_per_step, known_motion, track_starts, wrapped
from drivelint.drive.outliers import common_jolts
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
    text = "velocities of most actors change alike at once, and back, in {n} of {of} states ({ids}): the times or places of the log do"
    findings += states.findings(common_jolts(states, step), "common_jolt", "warning", text, quantity="velocity")
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
ENTRY_SAMPLES: Final = 3
"""A track that begins somewhere else comes to its place within so many samples."""
ENTRY_LEAST_MPS: Final = 5.0
"""A first step that differs less from the next one is noise of the first detections."""


COUPLED_M: Final = 2.0
COUPLED_ASIDE_M: Final = 1.0
COUPLED_MPS: Final = 5.0
COUPLED_LEAST: Final = 10
SUNK_M: Final = 0.3
"""In at least so many samples two boxes keep so near behind each other, in line, at more than this speed, and overlap by so much in the
end: one body. Nobody follows so near for a second."""


class _Boxes(NamedTuple):
    """Boxes (n): middle (2, n), unit vector along the box (2, n), half length and half width, velocity (2, n)."""

    place: Floats
    along: Floats
    half: Floats
    velocity: Floats


BEGIN_M: Final = 0.3
BEGIN_MPS: Final = 2.0
"""Boxes of two that move overlap by so much from the first sample that both have: nobody saw them touch, and their places are in doubt."""
HIT_MPS: Final = 1.5
"""A velocity that changes by more from one sample to the next may be that of a vehicle that was hit."""
HELD_NS: Final = 2_000_000_000
ARRIVAL_NS: Final = 1_000_000_000
LEAVING_MPS2: Final = 4.0
"""Whoever stands as its track ends can have gone from there with this, and is not where another one is at once: it was not there before."""


def same_bodies(states: States, actors: Actors, egos: Collection[str]) -> list[QualityFinding]:
    """Return a finding on the tracks that are another one's body; of two, the ego's, else the longer one, is believed."""
    starts = track_starts(states.actor)
    ends = np.r_[starts[1:], len(states)]
    rows, begun, pairs = np.zeros(len(states), np.bool_), np.zeros(len(states), np.bool_), []
    for a, b in _begin_upon(states, actors, starts):
        rows_a, rows_b = _common(states, slice(starts[a], ends[a]), slice(starts[b], ends[b]))
        one, other = _boxes(states, actors, rows_a), _boxes(states, actors, rows_b)
        deep = _deep(one, other)
        if len(deep) < LEAST_COMMON or not deep[0] or deep.mean() < COMMON_SHARE:
            if not _coupled(one, other):
                together = _overlap_at_begin(one, other)
                begun[rows_a[together]] = begun[rows_b[together]] = True
                continue
            deep = np.ones(len(deep), np.bool_)
        if not np.nanmedian(np.hypot(*(one.velocity - other.velocity))) <= SAME_MPS:
            continue
        order = sorted((a, b), key=lambda i: (states.ids[i] not in egos, int(starts[i] - ends[i]), states.ids[i]))
        kept, left = (states.ids[i] for i in order)
        rows[(rows_a if states.ids[a] == left else rows_b)[deep]] = True
        pairs.append(f"{left} is the same body as {kept}")
    text = f"{listed(pairs)}, in {{n}} of {{of}} states: it is not believed" if pairs else ""
    findings = states.findings(rows, "same_body", "warning", text, quantity="identity")
    text = "boxes of moving actors overlap from their first sample, in {n} of {of} states ({ids}): their places are not exact"
    return findings + states.findings(begun, "begin_overlap", "warning", text, quantity="position")


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


def held_tracks(states: States, actors: Actors) -> list[QualityFinding]:
    """Return a finding on the end of tracks that are held: standing, where another vehicle then is, sooner than they can have left."""
    starts, order = track_starts(states.actor), np.argsort(states.t_ns, kind="stable")
    t_ns, rows = states.t_ns[order], np.zeros(len(states), np.bool_)
    vehicle = np.isin(np.array(actors.classes, dtype=object), list(MOTOR_VEHICLES))
    index = {name: i for i, name in enumerate(actors.ids)}
    motor = vehicle[np.array([index[name] for name in states.ids])]
    lasts = np.r_[starts[1:], len(states)] - 1
    with np.errstate(invalid="ignore"):
        stands = np.hypot(*states.velocity[:, lasts]) < SPIN_MPS / 2.0
    for first, last in zip(starts[stands], lasts[stands], strict=True):
        now, after, end = np.searchsorted(
            t_ns, [states.t_ns[last], states.t_ns[last] + 1, states.t_ns[last] + ARRIVAL_NS]
        )
        # who touches it then, or brakes hard from then on, may have run into it
        before = order[now:after]
        clear = (
            _overlap(_boxes(states, actors, np.full(len(before), last)), _boxes(states, actors, before))[0].min(axis=0)
            < 0.0
        )
        speed = dict(
            zip(states.actor[before[clear]].tolist(), np.hypot(*states.velocity[:, before[clear]]), strict=True)
        )
        others = order[after:end]
        others = others[motor[states.actor[others]]]
        were = np.array([speed.get(number, np.nan) for number in states.actor[others].tolist()])
        others = others[np.hypot(*states.velocity[:, others]) > np.maximum(were - HIT_MPS, SPIN_MPS)]
        if not len(others):
            continue
        since_s = (states.t_ns[others] - states.t_ns[last]) * 1e-9
        mine = _boxes(states, actors, np.full(len(others), last))
        depth = _overlap(mine, _boxes(states, actors, others))[0].min(axis=0)
        if (depth > BEGIN_M + LEAVING_MPS2 / 2.0 * since_s**2).any():
            rows[first : last + 1] |= states.t_ns[first : last + 1] >= states.t_ns[last] - HELD_NS
    text = (
        "tracks stand at their end where another vehicle goes on at once, in {n} of {of} states ({ids}): they are held"
    )
    return states.findings(rows, "held_track", "warning", text, quantity="existence")


def _begin_upon(states: States, actors: Actors, starts: Indices) -> Iterator[tuple[int, int]]:
    """Yield pairs of tracks of which one has its first sample deep in the other's box, or close before or behind it."""
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
            theirs = _boxes(states, actors, others)
            for row in others[
                _deep(mine, theirs) | _in_line(mine, theirs) | (_overlap(mine, theirs)[0] >= BEGIN_M).all(axis=0)
            ]:
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


def _deep(one: _Boxes, other: _Boxes) -> Mask:
    """Say of each pair of boxes (n) whether they overlap by half of the smaller one along the first box and across it; NaN: no."""
    overlap, reach = _overlap(one, other)
    deep: Mask = np.logical_and.reduce(overlap >= 2.0 * DEEP_SHARE * np.minimum(one.half, reach))
    return deep


def _in_line(one: _Boxes, other: _Boxes) -> Mask:
    """Say of each pair of boxes (n) whether they are close behind each other, one heading and one track; NaN: no."""
    overlap, reach = _overlap(one, other)
    aside = one.half[1] + reach[1] - overlap[1]
    ahead = one.half[0] + reach[0] - overlap[0]
    along = (one.along * other.along).sum(axis=0) > 0.95
    line: Mask = (overlap[0] >= -COUPLED_M) & (aside <= COUPLED_ASIDE_M) & (ahead > aside) & along
    return line


def _coupled(one: _Boxes, other: _Boxes) -> bool:
    """Say whether two tracks keep close in line at speed in all that both have, and sink into each other without an impact."""
    line = _in_line(one, other)
    if len(line) < COUPLED_LEAST or not line.all():
        return False
    sunk = _overlap(one, other)[0][0] >= SUNK_M
    speeds = np.stack([np.hypot(*boxes.velocity) for boxes in (one, other)])
    return bool(sunk.any() and np.nanmedian(speeds) >= COUPLED_MPS)


def _overlap_at_begin(one: _Boxes, other: _Boxes) -> Mask:
    """Say in which of their first samples (n) two tracks that move overlap, deep at once, and part again with no sign of an impact."""
    depth, speeds = _overlap(one, other)[0].min(axis=0), np.minimum(np.hypot(*one.velocity), np.hypot(*other.velocity))
    together: Mask = np.logical_and.accumulate(depth >= 0.0)
    if not (together.any() and depth[0] >= BEGIN_M and speeds[0] >= BEGIN_MPS) or together.all():
        return np.zeros(len(together), np.bool_)
    until = int(together.sum()) + 1
    hit = [np.hypot(*np.diff(boxes.velocity[:, :until])) > HIT_MPS for boxes in (one, other)]
    return together & ~np.any(hit)


def _overlap(one: _Boxes, other: _Boxes) -> tuple[Floats, Floats]:
    """Return by how much pairs of boxes (n) overlap along the first and across it, negative: are apart, and the other's half extents so."""
    apart = other.place - one.place
    cos, sin = (one.along * other.along).sum(axis=0), one.along[0] * other.along[1] - one.along[1] * other.along[0]
    length, width = other.half
    reach = np.stack([length * abs(cos) + width * abs(sin), length * abs(sin) + width * abs(cos)])
    offset = np.stack([(apart * one.along).sum(axis=0), one.along[0] * apart[1] - one.along[1] * apart[0]])
    return one.half + reach - np.abs(offset), reach
