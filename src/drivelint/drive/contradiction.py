"""Makes values of an actor unknown that contradict each other.

Plausible positions take precedence over velocities and headings:

* If position and velocity differ by far (`POSITION_VELOCITY_MISMATCH_M`, `SINGLE_STEP_MISMATCH_M`), the whole state is unknown: position,
  heading and velocity. For example, the position stands still although the velocity is not 0.
* If they differ by less, but for half a second (`STRETCH_MISMATCH_MPS`), the position is used and the velocity is unknown.
* A heading opposite to the motion is turned round, unless the vehicle may be reversing. A heading across the motion is unknown, unless the
  vehicle may be sliding.

It also reports rejected positions that overlap another actor: it is then unknown how near the two came. `jumps` treats jumps.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from drivelint.arrays import wrap_angles
from drivelint.drive.jumps import (
    COUNT_OF_STATES_PREFIX,
    LEAST_SPEED_WITH_MOTION_DIRECTION_MPS,
    MOTION_COLUMNS,
    NO_SPLIT,
    SplitTracks,
    set_unknown,
)
from drivelint.drive.order import integral_per_step, motion_over_steps, prefix_sums, steps_with_known_motion
from drivelint.drive.trace import MOTOR_VEHICLES, QualityFinding
from drivelint.drive.velocity import Tracklets, noise_of_samples_m
from drivelint.phrases import name_list

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from drivelint.arrays import Floats, Indices, Mask
    from drivelint.drive.actors import Actors
    from drivelint.drive.order import Steps
    from drivelint.drive.trace import States


POSITION_VELOCITY_MISMATCH_M: Final = 1.0
POSITION_VELOCITY_MISMATCH_SHARE: Final = 0.15
"""Positions contradict velocities if, over one second, their displacements differ by more than 1 m + 15 % of the larger one. Noise of
0.3 m and a velocity error of 10 % stay below that."""
SINGLE_STEP_MISMATCH_M: Final = 2.0
"""A single step contradicts the velocities, whatever the next step does, if it differs by more than this: six times a noise of 0.3 m."""
HALF_COMPARISON_WINDOW_S: Final = 0.5
DIRECTION_LEAST_DISPLACEMENT_M: Final = 0.4
DIRECTION_LEAST_SHARE_OF_DISTANCE: Final = 0.5
"""A motion has a direction if, within one second around it, the actor moves more than 0.4 m and half the distance at its speed."""
FASTEST_REVERSING_MPS: Final = 8.0
"""The highest speed of reversing (29 km/h), except in the case of `FASTEST_REVERSE_START_MPS`."""
FASTEST_REVERSING_BESIDE_FORWARD_MOTION_MPS: Final = 20.0
FASTEST_REVERSE_START_MPS: Final = 3.0
"""Reversing may reach 20 m/s (72 km/h) if the log also shows forward motion, and the stretch of reversing starts or ends slower than
3 m/s."""
LEAST_ANGLE_OF_BACKWARD_MOTION_RAD: Final = np.deg2rad(150.0)
LEAST_ANGLE_OF_SIDEWAYS_MOTION_RAD: Final = np.deg2rad(30.0)
LEAST_SPEED_OF_SIDEWAYS_MOTION_MPS: Final = 3.0
"""Above this speed, a heading more than 30 degrees off the motion is wrong or a slide; slip angles of a car are below 10 degrees."""
HEADING_FLIP_RAD: Final = np.deg2rad(90.0)
MOST_TURN_IN_SLIDE_RAD: Final = np.deg2rad(45.0)
"""No heading changes by more than 90 degrees between two samples. In a slide, the limit is 45 degrees: 450 degrees/s at 10 Hz."""
CLASSES_MOVING_ALONG_HEADING: Final = frozenset((*MOTOR_VEHICLES, "trailer", "bicycle", None))
"""Classes of actors whose heading is the direction of their motion (None: unknown class). Pedestrians and animals can face any direction;
objects have no front."""
VELOCITY_COMPARISON_STRETCH_S: Final = 0.5
"""The mean velocity over this time, or over two steps if that is longer, is compared with the displacement."""
STRETCH_MISMATCH_MPS: Final = 0.8
STRETCH_MISMATCH_SHARE: Final = 0.05
"""The tolerated difference: the velocity of a rear axle is up to 0.7 m/s off (1.4 m from the centre, 0.5 rad/s), a speedometer 5 %, a
delayed filter 0.8 m/s."""
POSITION_NOISE_SIGMAS_IN_TOLERANCE: Final = 4.0
"""The tolerance for a stretch includes this many standard deviations of the position noise."""
LEAST_SHARE_OF_DIFFERENCE_IN_ONE_STEP: Final = 0.75
"""If one step causes at least this share of the difference, the positions are wrong, not the velocity."""
MOST_CONTRADICTORY_SHARE_OF_TRACK: Final = 0.5
"""If more than this share of a track contradicts its velocities, the velocity is wrong as a whole, which `checks` reports."""
ASSUMED_HALF_DIAGONAL_M: Final = 6.0
"""The half diagonal that is assumed for a box of unknown size."""


def remove_contradictions(
    states: States, step: Steps, actors: Actors, *, derived_velocities: bool, split_tracks: SplitTracks = NO_SPLIT
) -> list[QualityFinding]:
    """Make values unknown that contradict the motion, in place, and return findings (states in order, velocities complete).

    `derived_velocities`: velocities are derived from the positions, and not compared with them. `split_tracks`: the states that `jumps`
    rejected.
    """
    if len(states) < 3:
        return []
    findings: list[QualityFinding] = []
    places = [split_tracks.rejected_states] if split_tracks.rejected_states else []
    if not derived_velocities:
        frozen = _contradictory_positions(states, step)
        if frozen.any():
            places.append(states.take(frozen))
        text = COUNT_OF_STATES_PREFIX + "position and velocity contradict each other: both are unknown"
        findings += states.findings(frozen, "motion_unknown", "warning", text)
        set_unknown(states, frozen)
        astray = _contradictory_velocities(states, step)
        text = "for half a second or longer, the velocity does not match the positions: the velocity is unknown"
        findings += states.findings(astray, "velocity_unknown", "warning", COUNT_OF_STATES_PREFIX + text)
        set_unknown(states, astray, MOTION_COLUMNS)
    for place in places:
        findings += _rejected_position_overlap_findings(states, step, actors, place, split_tracks.old_id_by_id)
    turned, sideways = _backward_and_sideways_heading_samples(states, step, actors)
    yaw = states.numbers["yaw_rad"]
    text = COUNT_OF_STATES_PREFIX + "the heading is opposite to the motion: the direction of motion is used"
    findings += states.findings(turned, "heading_turned", "warning", text)
    text = COUNT_OF_STATES_PREFIX + "the heading is at an angle to the motion: the heading is unknown"
    findings += states.findings(sideways, "heading_unknown", "warning", text)
    yaw = np.where(turned, wrap_angles(yaw + np.pi), yaw)
    states.numbers["yaw_rad"] = np.where(sideways, np.nan, yaw)
    return findings


def _rejected_position_overlap_findings(
    states: States, step: Steps, actors: Actors, rejected_states: States, old_id_by_id: Mapping[str, str]
) -> list[QualityFinding]:
    """Return a finding for each actor with a rejected position at which its box may overlap the box of another actor."""
    index = {name: i for i, name in enumerate(actors.ids)}
    half = np.hypot(actors.sizes["length_m"], actors.sizes["width_m"]) / 2
    half = np.where(np.isfinite(half), half, ASSUMED_HALF_DIAGONAL_M)
    half_of = half[[index[name] for name in states.ids]][states.actor]
    placed_rows = np.flatnonzero(np.isfinite(states.place).all(axis=0))
    placed_rows = placed_rows[np.argsort(states.t_ns[placed_rows], kind="stable")]
    t_ns, beside = states.t_ns[placed_rows], max(step.period_ns, 1)
    first = np.searchsorted(t_ns, rejected_states.t_ns - beside)
    n = np.searchsorted(t_ns, rejected_states.t_ns + beside, side="right") - first
    place = np.repeat(np.arange(len(n)), n)
    other_row = placed_rows[np.arange(len(place)) - np.repeat(np.cumsum(n) - n, n) + first[place]]
    away = np.hypot(*(rejected_states.place[:, place] - states.place[:, other_row]))
    own_names = [rejected_states.ids[i] for i in rejected_states.actor]
    ego_half = half[[index[name] for name in own_names]][place] if len(n) else np.zeros(0)
    # in the log, the track after a jump belongs to the same actor
    in_log = np.array([old_id_by_id.get(name, name) for name in states.ids], dtype=np.str_)
    own_in_log = np.array([old_id_by_id.get(name, name) for name in own_names], dtype=np.str_)
    upon = (away <= ego_half + half_of[other_row]) & (in_log[states.actor[other_row]] != own_in_log[place])
    findings = []
    for number in np.unique(rejected_states.actor[place[upon]]):
        name = rejected_states.ids[number]
        rows = upon & (rejected_states.actor[place] == number)
        names = sorted({states.ids[i] for i in states.actor[other_row[rows]]})
        times = np.unique(rejected_states.t_ns[place[rows]])
        message = (
            f"a position of {name} that is not credible overlaps {name_list(names)}: whether they touched is unknown"
        )
        findings.append(QualityFinding("jumps_onto", "warning", message, len(times), int(times[0]), name))
    return findings


def _contradictory_positions(states: States, step: Steps) -> Mask:
    """Return the mask of the samples at which positions and velocities contradict each other.

    They do so if they differ in both steps beside the sample, or in one step by far, or (apart from such steps) over half a second before
    and after it.
    """
    n = len(states)
    usable = steps_with_known_motion(states, step)
    went, led, slack = _displacements_and_tolerance(states, step, usable)

    def is_contradiction(displacement: Floats, velocity_displacement: Floats, slack_m: Floats) -> Mask:
        fastest = np.maximum(np.hypot(*displacement), np.hypot(*velocity_displacement))
        wrong: Mask = (
            np.hypot(*(displacement - velocity_displacement))
            > POSITION_VELOCITY_MISMATCH_M + POSITION_VELOCITY_MISMATCH_SHARE * fastest + slack_m
        )
        return wrong

    alone = is_contradiction(went, led, slack)
    if not alone.any() and not _may_velocities_drift(went - led, step):
        return np.zeros(n, np.bool_)
    ends = np.ones(n + 1, np.bool_)  # at the end of a track, the one step beside the sample decides
    ends[1:-1] = alone | ~usable
    at_both_ends = ends[:-1] & ends[1:] & (np.r_[alone, False] | np.r_[False, alone])
    by_far = is_contradiction(went, led, slack + SINGLE_STEP_MISMATCH_M - POSITION_VELOCITY_MISMATCH_M)
    beside = at_both_ends | np.r_[by_far, False] | np.r_[False, by_far]
    went, led, slack = (np.where(alone, 0.0, values) for values in (went, led, slack))
    first, last = _first_and_last_rows_within_half_second(states, np.cumsum(np.r_[False, ~usable]), np.arange(n))

    def sum_half_second_around(values: Floats) -> Floats:
        sums = prefix_sums(values)
        return sums[..., last] - sums[..., first]

    frozen: Mask = beside | is_contradiction(
        sum_half_second_around(went), sum_half_second_around(led), sum_half_second_around(slack)
    )
    return frozen


def _displacements_and_tolerance(states: States, step: Steps, usable: Mask) -> tuple[Floats, Floats, Floats]:
    """Return the displacements of positions and of velocities in each step (2, n - 1), and the tolerance for their difference (n - 1)."""
    went = np.where(usable, np.diff(states.place), 0.0)
    led = integral_per_step(states.velocity, step, usable)
    # the velocity between two samples is unknown
    slack = np.where(usable, 0.5 * np.abs(np.diff(states.velocity)) * step.dt_s, 0.0)
    return went, led, np.hypot(*slack)


def _displacement_differences_per_step_m(states: States, step: Steps, usable: Mask) -> tuple[Floats, Floats]:
    """Return by how much the displacements of positions and velocities differ in each step (n - 1), and the tolerance."""
    went, led, slack = _displacements_and_tolerance(states, step, usable)
    went -= led
    return np.hypot(*went), slack


def _may_velocities_drift(difference: Floats, step: Steps) -> bool:
    """Return whether the velocities of any actor may deviate from its positions: a fast test of one sample per half second.

    `difference` (2, n - 1): the displacement of the positions minus that of the velocities, per step.
    """
    stride = max(1, round(HALF_COMPARISON_WINDOW_S * 1e9 / step.period_ns)) if step.period_ns else 1
    way = np.cumsum(difference, axis=1)[:, ::stride]
    # a one-second window spans at most three strides, so one of them has at least a third of its difference
    return bool((np.hypot(*np.diff(way, axis=1)) > POSITION_VELOCITY_MISMATCH_M / 3).any())


def _contradictory_velocities(states: States, step: Steps) -> Mask:
    """Return the mask of the samples (n, in order, velocities complete) in stretches whose velocities contradict the positions."""
    n = len(states)
    mismatched = np.zeros(n, np.bool_)
    k = max(2, round(VELOCITY_COMPARISON_STRETCH_S * 1e9 / step.period_ns)) if step.period_ns else n
    if n <= k:
        return mismatched
    usable = steps_with_known_motion(states, step)
    alone, slack = _displacement_differences_per_step_m(states, step, usable)
    went, led, whole, span = motion_over_steps(states, step, usable, k)
    span = np.where(whole, span, np.nan)
    went /= span
    led /= span
    off = np.hypot(*(went - led))
    # in place: for a long drive, these are the largest arrays
    np.maximum(np.abs(went, out=went), np.abs(led, out=led), out=went)
    fastest = np.hypot(*went)
    del went, led
    tolerance = STRETCH_MISMATCH_MPS + STRETCH_MISMATCH_SHARE * fastest + _sliding_max(slack, k) / span
    wrong = whole & (off > tolerance) & (_sliding_max(alone, k) < LEAST_SHARE_OF_DIFFERENCE_IN_ONE_STEP * off * span)
    if not wrong.any():
        return mismatched
    sigma = noise_of_samples_m(states.place, Tracklets.from_samples(states.t_ns, states.place, step), states.actor)
    wrong &= off > tolerance + POSITION_NOISE_SIGMAS_IN_TOLERANCE * np.sqrt(2.0) * sigma[:-k] / span
    rows = np.flatnonzero(wrong)
    edges = np.zeros(n + 1, np.int64)
    np.add.at(edges, rows, 1)
    np.add.at(edges, rows + k + 1, -1)
    mismatched = np.cumsum(edges[:-1]) > 0
    wrong_by_actor, all_by_actor = (
        np.bincount(actor, minlength=len(states.ids)) for actor in (states.actor[mismatched], states.actor)
    )
    is_mostly_wrong = wrong_by_actor > MOST_CONTRADICTORY_SHARE_OF_TRACK * all_by_actor
    return mismatched & ~is_mostly_wrong[states.actor]


def _sliding_max(values: Floats, width: int) -> Floats:
    """Return the largest of every k neighbouring values: m - k + 1 of m values."""
    maxima: Floats = np.lib.stride_tricks.sliding_window_view(values, width).max(axis=1)
    return maxima


def _first_and_last_rows_within_half_second(
    states: States, pieces: NDArray[np.integer], rows: Indices
) -> tuple[Indices, Indices]:
    """Return for each of these rows the first and the last row of the same piece (`pieces`, n) within half a second of it."""
    half = int(HALF_COMPARISON_WINDOW_S * 1e9)
    apart = np.diff(states.t_ns)
    # steps to another piece, backward steps and long steps are set to just over half a second, so that the sum does not overflow
    near = (np.diff(pieces) == 0) & (apart >= 0) & (apart <= half)
    key = np.r_[0, np.cumsum(np.where(near, apart, half + 1))]
    return np.searchsorted(key, key[rows] - half), np.searchsorted(key, key[rows] + half, side="right") - 1


def _rows_with_motion_direction(states: States, rows: Mask) -> Mask:
    """Return the mask of marked rows where the motion has a direction, as `DIRECTION_LEAST_SHARE_OF_DISTANCE` defines it."""
    marked_rows = np.flatnonzero(rows)
    first, last = _first_and_last_rows_within_half_second(states, states.actor, marked_rows)
    place, speed = states.place, np.hypot(*states.velocity[:, marked_rows])
    way = np.hypot(*(place[:, last] - place[:, first]))
    span = (states.t_ns[last] - states.t_ns[first]) * 1e-9
    moving_rows = rows.copy()
    moving_rows[marked_rows] = way > np.maximum(
        DIRECTION_LEAST_DISPLACEMENT_M, DIRECTION_LEAST_SHARE_OF_DISTANCE * speed * span
    )
    return moving_rows


def _backward_and_sideways_heading_samples(states: States, step: Steps, actors: Actors) -> tuple[Mask, Mask]:
    """Return the mask of samples with a heading opposite to the motion, and the mask of samples with a heading across it.

    A stretch of backward motion is real reversing if no forward motion adjoins it, the heading does not flip at its ends, and it is slower
    than `FASTEST_REVERSING_MPS`. The limit is `FASTEST_REVERSING_BESIDE_FORWARD_MOTION_MPS` if the vehicle drives forwards with that
    heading before or after, and the stretch starts or ends slowly on that side.

    A stretch with the heading across the motion is a real slide if forward motion adjoins it, and the heading changes by at most
    `MOST_TURN_IN_SLIDE_RAD` per sample.
    """
    n, yaw, (vx, vy) = len(states), states.numbers["yaw_rad"], states.velocity
    kinds = dict(zip(actors.ids, actors.classes, strict=True))
    in_line = np.array([kinds.get(name) in CLASSES_MOVING_ALONG_HEADING for name in states.ids], np.bool_)[states.actor]
    speed = np.hypot(vx, vy)
    off = np.abs(wrap_angles(yaw - np.arctan2(vy, vx)))
    moving = in_line & (speed > LEAST_SPEED_WITH_MOTION_DIRECTION_MPS) & np.isfinite(yaw)
    backwards = moving & (off > LEAST_ANGLE_OF_BACKWARD_MOTION_RAD)
    across = (
        moving & (speed > LEAST_SPEED_OF_SIDEWAYS_MOTION_MPS) & (off > LEAST_ANGLE_OF_SIDEWAYS_MOTION_RAD) & ~backwards
    )
    turn = np.where(step.same_actor, np.abs(wrap_angles(np.diff(yaw))), 0.0)
    no_sample = np.zeros(n, np.bool_)
    if not (backwards.any() or across.any()):
        return no_sample, no_sample
    backwards, across = _rows_with_motion_direction(states, backwards), _rows_with_motion_direction(states, across)
    forwards = moving & ~backwards & ~across
    turned, sideways = no_sample, no_sample.copy()
    row = np.arange(n)
    # for each row: the last forward row before it, the first one after it, and the number of heading flips until it
    went = np.maximum.accumulate(np.where(forwards, row, -1))
    goes = np.minimum.accumulate(np.where(forwards, row, n)[::-1])[::-1]
    turns_until = np.r_[0, np.cumsum(turn > HEADING_FLIP_RAD)]

    def is_slow_end_beside_forward_motion(end: int, forward_row: int) -> bool:
        return bool(
            0 <= forward_row < n
            and states.actor[forward_row] == states.actor[end]
            and turns_until[forward_row] == turns_until[end]
            and speed[end] < FASTEST_REVERSE_START_MPS
        )

    for rows, out, largest_turn in ((backwards, turned, HEADING_FLIP_RAD), (across, sideways, MOST_TURN_IN_SLIDE_RAD)):
        turns = turn > largest_turn
        for first, last in _first_and_last_rows_of_runs(states, rows):
            seam = (first > 0 and step.same_actor[first - 1]), (last < n - 1 and step.same_actor[last])
            broken = (seam[0] and turns[first - 1]) or (seam[1] and turns[last])
            beside = (seam[0] and forwards[first - 1]) or (seam[1] and forwards[last + 1])
            if out is turned:
                fastest = (
                    FASTEST_REVERSING_BESIDE_FORWARD_MOTION_MPS
                    if is_slow_end_beside_forward_motion(first, went[first])
                    or is_slow_end_beside_forward_motion(last, goes[last])
                    else FASTEST_REVERSING_MPS
                )
                real = speed[first : last + 1].max() < fastest and not broken and not beside
            else:
                real = beside and not broken and not turns[first:last].any()
            if not real:
                out[first : last + 1] = True
    return turned, sideways


def _first_and_last_rows_of_runs(states: States, rows: Mask) -> list[tuple[int, int]]:
    """Return the first and the last row of each stretch of successive marked rows of one actor."""
    same = np.r_[False, (states.actor[1:] == states.actor[:-1]) & rows[:-1] & rows[1:]]
    first = np.flatnonzero(rows & ~same)
    last = np.flatnonzero(rows & ~np.r_[same[1:], False])
    return list(zip(first.tolist(), last.tolist(), strict=True))
