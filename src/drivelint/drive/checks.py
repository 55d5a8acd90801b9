"""The data-quality checks that every import runs: they find missing values, and values that contradict each other.

Each check needs states in order (by actor and time, no duplicates) and returns findings, one per check and drive.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from drivelint.arrays import wrap_angles
from drivelint.drive.order import (
    MAX_GAP_PERIODS,
    integral_per_step,
    motion_over_steps,
    sliding_sums,
    steps_with_known_motion,
)
from drivelint.drive.trace import MOTOR_VEHICLES, QualityFinding
from drivelint.phrases import name_list

if TYPE_CHECKING:
    from drivelint.arrays import Floats, Mask
    from drivelint.drive.actors import Actors
    from drivelint.drive.order import Steps
    from drivelint.drive.trace import States

VELOCITY_MISMATCH_MPS = 1.0
VELOCITY_MISMATCH_SHARE = 0.15
"""Velocity may differ from the step in position by 1 m/s + 15 %. Rounding to millimetres at 20 Hz causes 0.03 m/s, hard braking within a
step (10 m/s2, 0.1 s) 0.5 m/s. Reading km/h as m/s, or a flipped axis, causes half of the speed or more."""
YAW_MISMATCH_RAD = np.deg2rad(30.0)
YAW_CHECK_LEAST_MPS = 3.0
"""Above 3 m/s, the heading may differ from the direction of motion by 30 degrees; slip angles of a car are below about 10 degrees. Below
3 m/s, the direction is not certain enough."""
FASTEST_REVERSING_MPS = 8.0
REVERSING_LEAST_RAD = np.deg2rad(150.0)
"""A vehicle reverses if it is slower than this (29 km/h), its heading is off the motion by more than 150 degrees, and it drives forwards
elsewhere in the log."""
TELEPORT_M = 3.0
TELEPORT_FACTOR = 2.0
"""A step is a jump if it is longer than 3 m + twice the distance at the higher of both speeds: no acceleration explains that."""
WRONG_UNITS_SHARE = 0.5
"""If more than this share of the moving samples disagree, the units or the frame are wrong, not the sensor."""
LEAST_MOVING_SAMPLES = 20
"""With fewer moving samples, a disagreement is not attributed to units or frame."""
FASTEST_MPS = 150.0
"""No road user is faster than this (540 km/h)."""
LONGER_THAN_WIDE_CLASSES = frozenset((*MOTOR_VEHICLES, "trailer", "bicycle"))
"""Classes of actors whose box is longer than wide."""


def quality_findings(states: States, step: Steps, actors: Actors, *, derived_velocities: bool) -> list[QualityFinding]:
    """Run every check on states in order. `derived_velocities`: velocities are derived from the positions, and not compared with them."""
    unplaced = np.isnan(states.numbers["x_m"]) | np.isnan(states.numbers["y_m"])
    findings = []
    for rows, check, text in (
        (states.not_finite, "not_finite", "NaN or infinity in {n} of {of} states ({ids}): those values are unknown"),
        (unplaced, "no_position", "no position in {n} of {of} states ({ids}): the actors are present but not placed"),
        (
            ~unplaced & np.isnan(states.numbers["yaw_rad"]),
            "no_yaw",
            "no heading in {n} of {of} states ({ids}): their boxes cannot be placed",
        ),
    ):
        findings += states.findings(rows, check, "warning", text)
    findings += [*_size_findings(actors), *_gap_findings(states, step)]
    if len(states) > 1:
        jump = _states_after_jumps(states, step)
        text = "position jumps farther than any vehicle can drive in {n} of {of} states ({ids})"
        is_unit = jump.sum() > max(WRONG_UNITS_SHARE * step.continuous.sum(), LEAST_MOVING_SAMPLES)
        why = ": the unit of position, speed or time is wrong" if is_unit else ""
        findings += states.findings(jump, "teleport", "error" if is_unit else "warning", text + why)
        findings += _excessive_speed_findings(states)
        if not derived_velocities:
            findings += _velocity_findings(states, step, jump)
        findings += _heading_findings(states, actors)
    return findings


def _size_findings(actors: Actors) -> list[QualityFinding]:
    length, width = actors.sizes["length_m"], actors.sizes["width_m"]
    long_kind = np.array([kind in LONGER_THAN_WIDE_CLASSES for kind in actors.classes], np.bool_)
    findings = []
    for check, rows, text in (
        (
            "no_size",
            np.isnan(length) | np.isnan(width),
            "length or width of {} is not known: distances to their boxes are unknown",
        ),
        ("length_below_width", long_kind & (length < width), "shorter than wide: {}: length and width may be swapped"),
    ):
        if ids := [actors.ids[i] for i in np.flatnonzero(rows)]:
            findings.append(QualityFinding.of_actors(check, "warning", text.format(name_list(ids)), ids))
    return findings


def _gap_findings(states: States, step: Steps) -> list[QualityFinding]:
    """Return findings on gaps of the whole log, and on holes of single tracks during which the log continues."""
    if step.period_ns <= 0:
        return []
    times = np.unique(states.t_ns)
    dt = np.diff(times)
    wide = dt > MAX_GAP_PERIODS * step.period_ns
    findings = []
    if wide.any():
        n, first = int(wide.sum()), int(times[:-1][wide][0])
        message = (
            f"gaps in the log of more than {MAX_GAP_PERIODS} periods ({step.period_ns / 1e9:g} s each): {n}, "
            f"the longest {dt.max() / 1e9:g} s, the first from {(first - int(times[0])) / 1e9:g} s: no rule is judged across a gap"
        )
        findings.append(QualityFinding("gap", "warning", message, n, first))
    hole = np.zeros(len(states), np.bool_)
    hole[:-1] = step.same_actor & ~step.continuous
    if findings:  # a hole that is a gap of the whole log is reported once
        inside = np.searchsorted(times, states.t_ns[:-1][hole[:-1]])
        hole[np.flatnonzero(hole)[wide[inside]]] = False
    text = "interruptions of single tracks: {n} ({ids}): these actors are unknown during the interruptions"
    return findings + states.findings(hole, "track_gap", "info", text)


def _states_after_jumps(states: States, step: Steps) -> Mask:
    speed = np.hypot(*states.velocity)
    # if both speeds are unknown, `reach` is NaN, and the step is no jump
    reach = TELEPORT_M + TELEPORT_FACTOR * np.fmax(speed[1:], speed[:-1]) * step.dt_s
    jump = np.zeros(len(states), np.bool_)
    jump[1:] = step.continuous & (np.hypot(*np.diff(states.place)) > reach)
    return jump


def _excessive_speed_findings(states: States) -> list[QualityFinding]:
    """Return a finding if most moving samples are faster than any road user: then the units are wrong."""
    speed = np.hypot(*states.velocity)
    rows = speed > FASTEST_MPS
    n, n_moving = int(rows.sum()), int((speed > YAW_CHECK_LEAST_MPS).sum())
    if n < LEAST_MOVING_SAMPLES or n <= WRONG_UNITS_SHARE * n_moving:
        return []
    text = (
        f"speed is beyond {FASTEST_MPS:g} m/s in {{n}} of {n_moving} moving samples (the fastest {np.nanmax(speed):.0f} m/s): "
        "the unit of position, speed or time is wrong"
    )
    return states.findings(rows, "too_fast", "error", text)


def _velocity_findings(states: States, step: Steps, jump: Mask) -> list[QualityFinding]:
    """Return a finding if steps in position disagree with the mean of the velocities at their ends.

    Whether units or frame are wrong is decided over one second, where position noise is small against the distance.
    """
    wrong = np.zeros(len(states), np.bool_)
    wrong[1:] = _exceeds_velocity_tolerance(*_recorded_speeds_vs_speeds_from_positions(states, step, jump, 1))
    second = max(1, round(1e9 / step.period_ns)) if step.period_ns else 1
    for n_steps in {second: None, 1: None}:
        error, speed, step_speed, usable = _recorded_speeds_vs_speeds_from_positions(states, step, jump, n_steps)
        moving = usable & (np.maximum(step_speed, speed) > YAW_CHECK_LEAST_MPS)
        off = moving & _exceeds_velocity_tolerance(error, speed, step_speed, usable)
        n, n_moving = int(off.sum()), int(moving.sum())
        if n_moving < LEAST_MOVING_SAMPLES:
            continue  # tracks shorter than a second
        if n > WRONG_UNITS_SHARE * n_moving:
            ratio = float(np.nanmedian((speed / step_speed)[moving]))
            text = (
                f"velocity does not match the changes of position in {100.0 * n / n_moving:.0f} % "
                f"of the moving samples (the speed is {ratio:.3g} times the change): {_cause_of_speed_ratio(ratio)}"
            )
            return states.findings(wrong, "velocity_mismatch", "error", text)
        break
    text = "velocity does not match the change of position in {n} of {of} states ({ids})"
    return states.findings(wrong, "velocity_mismatch", "warning", text)


def _exceeds_velocity_tolerance(error: Floats, speed: Floats, step_speed: Floats, usable: Mask) -> Mask:
    """Return the mask of the steps, as returned by `_recorded_speeds_vs_speeds_from_positions`, whose error exceeds the tolerance."""
    return usable & (error > VELOCITY_MISMATCH_MPS + VELOCITY_MISMATCH_SHARE * np.maximum(step_speed, speed))


def _recorded_speeds_vs_speeds_from_positions(
    states: States, step: Steps, jump: Mask, n_steps: int
) -> tuple[Floats, Floats, Floats, Mask]:
    """Compare the mean velocity from positions over every `n_steps` steps with the mean of the recorded velocities, in m/s.

    Returns, indexed by first row (n - n_steps): the difference, the mean speed, the speed from positions, and the mask of the intervals
    without a jump or hole.
    """
    usable_steps = steps_with_known_motion(states, step) & ~jump[1:]
    went, led, usable, span_s = motion_over_steps(states, step, usable_steps, n_steps)
    span_s = np.where(span_s > 0.0, span_s, np.nan)
    speed = sliding_sums(integral_per_step(np.hypot(*states.velocity), step, usable_steps), n_steps) / span_s
    went /= span_s
    led /= span_s
    return np.hypot(*(went - led)), speed, np.hypot(*went), usable


def _cause_of_speed_ratio(ratio: float) -> str:
    """Return the most likely cause of a wrong ratio of recorded speed to the speed from positions."""
    for factor, cause in (
        (3.6, "speeds in km/h read as m/s"),
        (2.237, "speeds in mph read as m/s"),
        (1 / 3.6, "speeds in m/s read as km/h"),
        (0.447, "speeds in m/s read as mph"),
    ):
        if abs(ratio / factor - 1.0) < 0.03:
            return cause
    return (
        "axes flipped differently for positions and velocities, or headings that count from north or clockwise"
        if abs(ratio - 1.0) < 0.1
        else "units of speed, position or time are wrong"
    )


def _heading_findings(states: States, actors: Actors) -> list[QualityFinding]:
    """Return a finding if headings of vehicles disagree with their direction of motion."""
    (vx, vy), yaw = states.velocity, states.numbers["yaw_rad"]
    place = {name: i for i, name in enumerate(actors.ids)}
    long_kind = np.array(
        [actors.classes[place[name]] in {*LONGER_THAN_WIDE_CLASSES, None} for name in states.ids], np.bool_
    )
    speed = np.hypot(vx, vy)
    moving = (speed > YAW_CHECK_LEAST_MPS) & long_kind[states.actor] & ~np.isnan(yaw)
    off = np.abs(wrap_angles(yaw - np.arctan2(vy, vx)))
    wrong = moving & (off > YAW_MISMATCH_RAD)
    backwards = wrong & (off > REVERSING_LEAST_RAD) & (speed < FASTEST_REVERSING_MPS)
    forwards = np.bincount(states.actor[moving & ~wrong], minlength=len(states.ids)) > 0
    # an actor that only drives backwards is accepted if others drive forwards, or if no other actor only drives backwards
    fast = np.bincount(states.actor[wrong & ~backwards], minlength=len(states.ids)) > 0
    only = (np.bincount(states.actor[backwards], minlength=len(states.ids)) > 0) & ~forwards & ~fast
    reverses = forwards | only if forwards.any() or only.sum() == 1 else forwards
    wrong &= ~(backwards & reverses[states.actor])
    n, n_moving = int(wrong.sum()), int(moving.sum())
    if n_moving >= LEAST_MOVING_SAMPLES and n > WRONG_UNITS_SHARE * n_moving:
        degrees = float(np.rad2deg(np.median(off[wrong])))
        text = (
            f"heading is off the direction of motion in {100.0 * n / n_moving:.0f} % of the moving samples "
            f"(by {degrees:.0f} degrees): the unit, sign or zero of the heading is wrong"
        )
        return states.findings(wrong, "yaw_mismatch", "error", text)
    text = "heading is more than 30 degrees off the direction of motion in {n} of {of} states ({ids})"
    return states.findings(wrong, "yaw_mismatch", "warning", text)
