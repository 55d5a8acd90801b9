"""Finds tracks that are not separate bodies: one body in two tracks, tracks with a false start, and tracks prolonged at their end.

A tracker may have two tracks of one long vehicle, and a data set may have both a rider and the bicycle. Two boxes that overlap deeply
from their first common sample on, at the same velocity, are one body: vehicles that collide were apart before. Two boxes are also one
body if one follows closer than any vehicle does, and they then overlap without an impact.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from drivelint.drive.implausible.motion import SPIN_FASTEST_MPS, TYRE_LIMIT_MPS2
from drivelint.drive.order import track_starts
from drivelint.drive.trace import MOTOR_VEHICLES
from drivelint.phrases import name_list

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from drivelint.arrays import Floats, Indices, Mask
    from drivelint.drive.actors import Actors
    from drivelint.drive.order import Steps
    from drivelint.drive.trace import QualityFinding, States

DEEP_OVERLAP_SHARE: Final = 0.5
"""Two boxes overlap deeply if they overlap by this share of the smaller extent, both along and across the first box."""
SAME_BODY_MOST_VELOCITY_DIFFERENCE_MPS: Final = 2.0
"""The median difference of the velocities of two tracks of one body is at most this."""
LEAST_DEEP_SAMPLE_SHARE: Final = 0.8
"""Two tracks of one body overlap deeply in at least this share of their common samples."""
SAME_BODY_LEAST_COMMON_SAMPLES: Final = 3
"""Two tracks of one body have at least this many common samples."""
FARTHEST_OVERLAPPING_CENTRES_M: Final = 100.0
"""The centres of two overlapping bodies are at most this far apart."""
LARGEST_CELL_NUMBER: Final = 10**10
"""Numbers of grid cells are clipped to this, so that the cell number times the number of times fits into 64 bits."""
BOX_PAIRS_PER_PART: Final = 1_000_000
"""The approximate number of pairs of boxes in memory at once."""
MOST_FALSE_TRACK_START_SAMPLES: Final = 3
"""A track with a false start reaches its true position within this many samples."""
FALSE_TRACK_START_LEAST_CHANGE_MPS: Final = 5.0
"""If the first step differs by less than this from the next one, the difference is noise of the first detections."""


MOST_COUPLED_GAP_M: Final = 2.0
MOST_COUPLED_SIDE_OFFSET_M: Final = 1.0
LEAST_COUPLED_MPS: Final = 5.0
LEAST_COUPLED_SAMPLES: Final = 10
LEAST_COUPLED_OVERLAP_M: Final = 0.3
"""Two tracks are coupled (one body) if in all common samples, at least `LEAST_COUPLED_SAMPLES`, one box is within `MOST_COUPLED_GAP_M`
behind the other and `MOST_COUPLED_SIDE_OFFSET_M` to the side, at a median speed of at least `LEAST_COUPLED_MPS`,
and they overlap by at least `LEAST_COUPLED_OVERLAP_M` in some sample."""


LONGEST_PERSON_M: Final = 1.5
ONE_PLACE_OVERLAP_SHARE: Final = 1 / 3
"""Two boxes of persons, not longer than `LONGEST_PERSON_M`, that overlap by this share along and across, in `LEAST_DEEP_SAMPLE_SHARE` of
their common samples and at one velocity, may be one person or two: the position of one at least is wrong by a decimetre or more."""


class _Boxes(NamedTuple):
    """Boxes (n): centre (2, n), unit vector along the box (2, n), half length and half width (2, n), velocity (2, n)."""

    place: Floats
    unit_along: Floats
    half_sizes: Floats
    velocity: Floats


LEAST_OVERLAP_AT_TRACK_BEGIN_M: Final = 0.3
LEAST_SPEED_AT_TRACK_BEGIN_MPS: Final = 2.0
"""If two boxes, both at least this fast, overlap by this much in their first common sample, no contact was recorded: the positions are
doubtful."""
LATERAL_OVERLAP_NOISE_M: Final = 0.3
"""The noise that positions and headings add to a lateral overlap."""
MOST_SIDE_BY_SIDE_OVERLAP_SHARE: Final = 2 / 3
"""Two boxes that overlap laterally by at most this share of the smaller width may be side by side: the position error may be lateral."""
LEAST_VELOCITY_CHANGE_OF_IMPACT_MPS: Final = 1.5
"""A velocity that changes by more than this between two samples may be caused by an impact."""
REPEATED_END_POSITIONS_NS: Final = 2_000_000_000
NEXT_VEHICLE_ARRIVAL_NS: Final = 1_000_000_000
MOST_LEAVING_ACCELERATION_MPS2: Final = 4.0
"""The highest acceleration of an actor after a standstill at the end of its track. If another vehicle is there sooner, within
`NEXT_VEHICLE_ARRIVAL_NS`, the last `REPEATED_END_POSITIONS_NS` of the track are repeated positions."""


def same_body_findings(states: States, actors: Actors, egos: Collection[str]) -> list[QualityFinding]:
    """Return findings on tracks that are the same body as another, and on tracks that overlap from the start.

    Of two tracks of one body, the ego's is used, else the longer one.
    """
    rows, begun, pairs = np.zeros(len(states), np.bool_), np.zeros(len(states), np.bool_), []
    half = _half_sizes(states, actors)
    for a, b in _pairs_close_at_start(states, actors):
        track_a, track_b = (slice(*np.searchsorted(states.actor, [i, i + 1]).tolist()) for i in (a, b))
        rows_a, rows_b = _rows_at_common_times(states, track_a, track_b)
        first, second = _boxes_of_rows(states, half, rows_a), _boxes_of_rows(states, half, rows_b)
        deep = _overlap_deeply(first, second)
        if len(deep) < SAME_BODY_LEAST_COMMON_SAMPLES or not deep[0] or deep.mean() < LEAST_DEEP_SAMPLE_SHARE:
            if not _are_coupled(first, second):
                together = _doubtful_begin_samples(first, second) | _samples_in_one_place(first, second)
                begun[rows_a[together]] = begun[rows_b[together]] = True
                continue
            deep = np.ones(len(deep), np.bool_)
        if not np.nanmedian(np.hypot(*(first.velocity - second.velocity))) <= SAME_BODY_MOST_VELOCITY_DIFFERENCE_MPS:
            continue
        length = {a: track_a.stop - track_a.start, b: track_b.stop - track_b.start}
        order = sorted((a, b), key=lambda i: (states.ids[i] not in egos, -length[i], states.ids[i]))
        name, second_name = (states.ids[i] for i in order)
        rows[(rows_a if states.ids[a] == second_name else rows_b)[deep]] = True
        pairs.append(f"{second_name} is the same body as {name}")
    text = f"{name_list(pairs)}, in {{n}} of {{of}} states: the first of the two is not used" if pairs else ""
    findings = states.findings(rows, "same_body", "warning", text, quantity="identity")
    text = "boxes of two actors overlap from their first sample, in {n} of {of} states ({ids}): their positions are not exact"
    return findings + states.findings(begun, "begin_overlap", "warning", text, quantity="position")


def false_track_start_findings(states: States, step: Steps) -> list[QualityFinding]:
    """Return a finding on the first samples of tracks that begin with an impossible step."""
    n = len(states)
    rows = np.zeros(n, np.bool_)
    starts = track_starts(states.actor)
    ends = np.r_[starts[1:], n]
    with np.errstate(invalid="ignore", divide="ignore"):
        velocity = np.where(step.continuous, np.diff(states.place) / step.dt_s, np.nan)
    for k in range(MOST_FALSE_TRACK_START_SAMPLES):
        first = starts[ends - starts > MOST_FALSE_TRACK_START_SAMPLES + 2] + k
        change = np.hypot(*(velocity[:, first] - velocity[:, first + 1]))
        hard = change > FALSE_TRACK_START_LEAST_CHANGE_MPS + TYRE_LIMIT_MPS2 * (step.dt_s[first] + step.dt_s[first + 1])
        faster = np.hypot(*velocity[:, first]) > np.hypot(*velocity[:, first + 1])
        for at in first[hard & faster]:
            rows[at - k : at + 1] = True
    text = (
        "tracks begin at one position and continue at another that no motion can reach, in {n} of {of} states ({ids})"
    )
    return states.findings(rows, "false_entry", "warning", text, quantity="existence")


def repeated_end_position_findings(states: States, actors: Actors) -> list[QualityFinding]:
    """Return a finding on tracks that end with repeated positions.

    They end at a standstill, and another vehicle is at the same position sooner than the first one could leave it.
    """
    starts, order = track_starts(states.actor), np.argsort(states.t_ns, kind="stable")
    t_ns, rows = states.t_ns[order], np.zeros(len(states), np.bool_)
    vehicle = np.isin(np.array(actors.classes, dtype=object), list(MOTOR_VEHICLES))
    index = {name: i for i, name in enumerate(actors.ids)}
    motor = vehicle[np.array([index[name] for name in states.ids])]
    lasts, speeds, half = np.r_[starts[1:], len(states)] - 1, np.hypot(*states.velocity), _half_sizes(states, actors)
    with np.errstate(invalid="ignore"):
        stands = (speeds[lasts] < SPIN_FASTEST_MPS / 2.0) & (states.t_ns[lasts] < t_ns[-1])
    for first, last in zip(starts[stands], lasts[stands], strict=True):
        now, after, end = np.searchsorted(
            t_ns, [states.t_ns[last], states.t_ns[last] + 1, states.t_ns[last] + NEXT_VEHICLE_ARRIVAL_NS]
        )
        # an actor that touches it at that time, or brakes hard from then on, may have collided with it
        before = order[now:after]
        clear = (
            _overlaps_and_second_half_extents_m(
                _boxes_of_rows(states, half, np.full(len(before), last)), _boxes_of_rows(states, half, before)
            )[0].min(axis=0)
            < 0.0
        )
        speed = dict(zip(states.actor[before[clear]].tolist(), speeds[before[clear]], strict=True))
        other_rows = order[after:end]
        other_rows = other_rows[motor[states.actor[other_rows]]]
        were = np.array([speed.get(number, np.nan) for number in states.actor[other_rows].tolist()])
        other_rows = other_rows[
            speeds[other_rows] > np.maximum(were - LEAST_VELOCITY_CHANGE_OF_IMPACT_MPS, SPIN_FASTEST_MPS)
        ]
        if not len(other_rows):
            continue
        since_s = (states.t_ns[other_rows] - states.t_ns[last]) * 1e-9
        last_boxes = _boxes_of_rows(states, half, np.full(len(other_rows), last))
        depth = _overlaps_and_second_half_extents_m(last_boxes, _boxes_of_rows(states, half, other_rows))[0].min(axis=0)
        if (depth > LEAST_OVERLAP_AT_TRACK_BEGIN_M + MOST_LEAVING_ACCELERATION_MPS2 / 2.0 * since_s**2).any():
            rows[first : last + 1] |= states.t_ns[first : last + 1] >= states.t_ns[last] - REPEATED_END_POSITIONS_NS
    text = (
        "tracks end with a standstill at a position from which another vehicle drives on at once, in {n} of {of} "
        "states ({ids}): these positions are repeated, not measured"
    )
    return states.findings(rows, "held_track", "warning", text, quantity="existence")


def _pairs_close_at_start(states: States, actors: Actors) -> Iterator[tuple[int, int]]:
    """Yield pairs of tracks of which one starts inside the box of the other, or close before or behind it.

    In the second case, only tracks with at least `LEAST_COUPLED_SAMPLES` samples are used, which excludes many short tracks of a crowd.
    """
    starts, half = track_starts(states.actor), _half_sizes(states, actors)
    may_be_coupled = np.bincount(states.actor, minlength=len(states.ids)) >= LEAST_COUPLED_SAMPLES
    number = np.full(len(states), -1)
    number[starts] = np.arange(len(starts))
    for first, second in _possible_overlap_rows(states, actors, starts):
        # if both tracks start at this time, the pair is yielded only once
        once = (states.actor[first] != states.actor[second]) & ((number[second] < 0) | (number[second] > number[first]))
        first, second = first[once], second[once]  # noqa: PLW2901  only these pairs are used
        first_boxes, second_boxes = _boxes_of_rows(states, half, first), _boxes_of_rows(states, half, second)
        coupled = (
            may_be_coupled[states.actor[first]]
            & may_be_coupled[states.actor[second]]
            & _are_in_line(first_boxes, second_boxes)
        )
        near = (
            _overlap_deeply(first_boxes, second_boxes)
            | _are_persons_in_one_place(first_boxes, second_boxes)
            | coupled
            | (_overlaps_and_second_half_extents_m(first_boxes, second_boxes)[0] >= LEAST_OVERLAP_AT_TRACK_BEGIN_M).all(
                axis=0
            )
        )
        yield from zip(states.actor[first[near]].tolist(), states.actor[second[near]].tolist(), strict=True)


def _possible_overlap_rows(states: States, actors: Actors, starts: Indices) -> Iterator[tuple[Indices, Indices]]:
    """Yield pairs of rows in parts: the first row of a track, and a row of the same time whose box may overlap it along x."""
    half_m = np.hypot(actors.sizes["length_m"], actors.sizes["width_m"]) / 2.0
    reach_m = min(2.0 * float(np.nanmax(half_m, initial=0.0)) + MOST_COUPLED_GAP_M, FARTHEST_OVERLAPPING_CENTRES_M)
    x = states.numbers["x_m"]
    rows, starts = np.flatnonzero(np.isfinite(x)), starts[np.isfinite(x[starts])]
    if not len(starts):
        return
    cell = np.floor(x[rows] / reach_m).clip(-LARGEST_CELL_NUMBER, LARGEST_CELL_NUMBER).astype(np.int64)
    # one integer key for time and cell, so that neighbouring keys never belong to different times
    time = np.unique(states.t_ns[rows], return_inverse=True)[1].astype(np.int64)
    key = time * int(np.ptp(cell) + 3) + cell - cell.min()
    at = key[np.searchsorted(rows, starts)]
    order = np.argsort(key, kind="stable")
    rows, key = rows[order], key[order]
    low, high = np.searchsorted(key, at - 1), np.searchsorted(key, at + 1, side="right")
    part = np.cumsum(high - low) // BOX_PAIRS_PER_PART
    for k in np.unique(part):
        n, begin = (high - low)[part == k], low[part == k]
        nth = np.arange(int(n.sum())) - np.repeat(np.cumsum(n) - n, n)
        yield np.repeat(starts[part == k], n), rows[np.repeat(begin, n) + nth]


def _rows_at_common_times(states: States, a: slice, b: slice) -> tuple[Indices, Indices]:
    """Return the rows of two tracks at their common times."""
    _, in_a, in_b = np.intersect1d(states.t_ns[a], states.t_ns[b], assume_unique=True, return_indices=True)
    return in_a + a.start, in_b + b.start


def _half_sizes(states: States, actors: Actors) -> Floats:
    """Return half the length and half the width (2, n) of the actors in `states.ids`, in the same order."""
    index = {name: i for i, name in enumerate(actors.ids)}
    places = [index[name] for name in states.ids]
    half: Floats = np.stack([actors.sizes["length_m"][places], actors.sizes["width_m"][places]]) / 2.0
    return half


def _boxes_of_rows(states: States, half_sizes: Floats, rows: Indices) -> _Boxes:
    """Return the boxes at these states. This is called for each pair of tracks, so it must not loop over all actors."""
    x, y, yaw, vx, vy = (states.numbers[name][rows] for name in ("x_m", "y_m", "yaw_rad", "vx_mps", "vy_mps"))
    sizes = half_sizes[:, states.actor[rows]]
    return _Boxes(np.stack([x, y]), np.stack([np.cos(yaw), np.sin(yaw)]), sizes, np.stack([vx, vy]))


def _overlap_deeply(first: _Boxes, second: _Boxes) -> Mask:
    """Return the mask of the pairs of boxes (n) that overlap deeply (see `DEEP_OVERLAP_SHARE`); False where a value is NaN."""
    overlap, reach = _overlaps_and_second_half_extents_m(first, second)
    deep: Mask = np.all(overlap >= 2.0 * DEEP_OVERLAP_SHARE * np.minimum(first.half_sizes, reach), axis=0)
    return deep


def _are_persons_in_one_place(first: _Boxes, second: _Boxes) -> Mask:
    """Return the mask of the pairs of boxes (n) of two persons that overlap (see `ONE_PLACE_OVERLAP_SHARE`); False for NaN."""
    overlap, reach = _overlaps_and_second_half_extents_m(first, second)
    small = np.maximum(first.half_sizes[0], second.half_sizes[0]) <= LONGEST_PERSON_M / 2.0
    inside: Mask = small & np.all(
        overlap >= 2.0 * ONE_PLACE_OVERLAP_SHARE * np.minimum(first.half_sizes, reach), axis=0
    )
    return inside


def _samples_in_one_place(first: _Boxes, second: _Boxes) -> Mask:
    """Return the mask of the common samples (n) at which two tracks of persons overlap; empty unless they do so nearly all the time."""
    inside = _are_persons_in_one_place(first, second)
    together = len(inside) >= SAME_BODY_LEAST_COMMON_SAMPLES and inside[0] and inside.mean() >= LEAST_DEEP_SAMPLE_SHARE
    apart_mps = np.nanmedian(np.hypot(*(first.velocity - second.velocity))) if together else np.nan
    return inside & (apart_mps <= SAME_BODY_MOST_VELOCITY_DIFFERENCE_MPS)


def _are_in_line(first: _Boxes, second: _Boxes) -> Mask:
    """Return the mask of the pairs of boxes (n) that are close behind each other, in line, with one heading; False for NaN."""
    overlap, reach = _overlaps_and_second_half_extents_m(first, second)
    aside = first.half_sizes[1] + reach[1] - overlap[1]
    ahead = first.half_sizes[0] + reach[0] - overlap[0]
    near = (overlap[0] >= -MOST_COUPLED_GAP_M) & (aside <= MOST_COUPLED_SIDE_OFFSET_M) & (ahead > aside)
    line: Mask = near & ((first.unit_along * second.unit_along).sum(axis=0) > 0.95)
    return line


def _are_coupled(first: _Boxes, second: _Boxes) -> bool:
    """Return whether two tracks are coupled, which means that they are one body.

    All common samples are in line and close behind each other, the median speed is high enough, and some sample overlaps.
    """
    line = _are_in_line(first, second)
    if len(line) < LEAST_COUPLED_SAMPLES or not line.all():
        return False
    sunk = _overlaps_and_second_half_extents_m(first, second)[0][0] >= LEAST_COUPLED_OVERLAP_M
    speeds = np.stack([np.hypot(*boxes.velocity) for boxes in (first, second)])
    return bool(sunk.any() and np.nanmedian(speeds) >= LEAST_COUPLED_MPS)


def _doubtful_begin_samples(first: _Boxes, second: _Boxes) -> Mask:
    """Return the mask of the first common samples (n) with doubtful positions, because two moving tracks overlap from the start.

    It extends until the boxes are as far apart as they overlapped. If a velocity changes as in an impact meanwhile, it is empty.
    """
    across, depth = (
        _overlaps_and_second_half_extents_m(first, second)[0][1],
        _overlaps_and_second_half_extents_m(first, second)[0].min(axis=0),
    )
    speeds = np.minimum(np.hypot(*first.velocity), np.hypot(*second.velocity))
    together: Mask = np.logical_and.accumulate(depth >= 0.0)
    if (
        not (
            together.any()
            and depth[0] >= LEAST_OVERLAP_AT_TRACK_BEGIN_M
            and speeds[0] >= LEAST_SPEED_AT_TRACK_BEGIN_MPS
        )
        or together.all()
    ):
        return np.zeros(len(together), np.bool_)
    until = int(together.sum()) + 1
    hit = [
        np.hypot(*np.diff(boxes.velocity[:, :until])) > LEAST_VELOCITY_CHANGE_OF_IMPACT_MPS for boxes in (first, second)
    ]
    # the position error may be as large as the overlap
    near: Mask = np.logical_and.accumulate(depth > -depth[together].max())
    if across[0] <= MOST_SIDE_BY_SIDE_OVERLAP_SHARE * 2 * min(first.half_sizes[1][0], second.half_sizes[1][0]):
        farthest = across[together].max() + LATERAL_OVERLAP_NOISE_M
        near |= np.logical_and.accumulate((across <= farthest) & (across > -farthest))
    return near & ~np.any(hit)


def _overlaps_and_second_half_extents_m(first: _Boxes, second: _Boxes) -> tuple[Floats, Floats]:
    """Return the overlaps (2, n) of pairs of boxes along and across the first box, negative if they are apart.

    Also return the half extents (2, n) of the second box in these directions.
    """
    apart = second.place - first.place
    cos, sin = (
        (first.unit_along * second.unit_along).sum(axis=0),
        first.unit_along[0] * second.unit_along[1] - first.unit_along[1] * second.unit_along[0],
    )
    length, width = second.half_sizes
    reach = np.stack([length * abs(cos) + width * abs(sin), length * abs(sin) + width * abs(cos)])
    offset = np.stack(
        [(apart * first.unit_along).sum(axis=0), first.unit_along[0] * apart[1] - first.unit_along[1] * apart[0]]
    )
    return first.half_sizes + reach - np.abs(offset), reach
