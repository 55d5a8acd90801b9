"""Makes values of an actor unknown that contradict each other.

Positions decide over velocities and headings as long as they are a track. If a position jumps, or stands still although the velocity is
not 0, the state is unknown (no position, heading or velocity). If a track continues at another place after a jump, it is another actor's
from there on. If position and velocity both advance over half a second but differ, the position is used and the velocity is unknown. If a
heading turns round from one sample to the next while the motion continues, it is turned back; a heading across the motion is unknown. A
doubted place that lies on another actor is reported, because code that limits how near the two came needs it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from drivelint.arrays import wrapped
from drivelint.drive.jumps import COUNT_PREFIX, MOTION_COLUMNS, MOVING_MPS, NO_SPLIT, SplitTracks, set_unknown
from drivelint.drive.order import displacements, integral_per_step, known_motion, sums_until
from drivelint.drive.trace import MOTOR_VEHICLES, QualityFinding
from drivelint.drive.velocity import Tracklets, sample_noise
from drivelint.phrases import listed

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from drivelint.arrays import Floats, Indices, Mask
    from drivelint.drive.actors import Actors
    from drivelint.drive.order import Steps
    from drivelint.drive.trace import States


MISMATCH_M: Final = 1.0
MISMATCH_SHARE: Final = 0.15
"""Positions contradict velocities if over a second they lead elsewhere by more than 1 m + 15 % of the way: noise of 0.3 m and
velocities of 10 % error do not."""
STEP_MISMATCH_M: Final = 2.0
"""A single step contradicts the velocities, whatever the next one does, from this on: six times the noise above."""
WINDOW_S: Final = 0.5
DIRECTION_LEAST_M: Final = 0.4
DIRECTION_LEAST_SHARE: Final = 0.5
"""A motion has a direction if the actor moves 0.4 m within a second around it, and half as far as its speed says."""
REVERSING_MPS: Final = 8.0
"""No vehicle reverses faster than this (29 km/h),"""
FAST_REVERSING_MPS: Final = 20.0
REVERSE_START_MPS: Final = 3.0
"""unless it is seen to stop and to set off backwards: at its first moving sample it is no faster than 3 m/s, and never than 72 km/h."""
BACKWARDS_RAD: Final = np.deg2rad(150.0)
SIDEWAYS_RAD: Final = np.deg2rad(30.0)
SIDEWAYS_MPS: Final = 3.0
"""A heading this far off the motion is that of a slide, or wrong; slip angles of a car stay below 10 degrees."""
HEADING_FLIP_RAD: Final = np.deg2rad(90.0)
SPIN_RAD: Final = np.deg2rad(45.0)
"""No heading turns round between two samples; and no vehicle spins further than this, which is 450 degrees/s at 10 Hz."""
DIRECTED_CLASSES: Final = frozenset((*MOTOR_VEHICLES, "trailer", "bicycle", None))
"""Actors whose heading is that of their motion; people and animals face where they like, things have no front."""
STRETCH_S: Final = 0.5
"""Over so long a time the mean velocity is compared with the way, over two steps at least."""
STRETCH_MISMATCH_MPS: Final = 0.8
STRETCH_MISMATCH_SHARE: Final = 0.05
"""A turning vehicle's rear axle is 0.7 m/s off its middle (1.4 m, 0.5 rad/s), a speedometer 5 %, a filter that is late 0.8 m/s."""
SIGMAS: Final = 4.0
"""And so many standard deviations of the positions' noise."""
SINGLE_STEP_SHARE: Final = 0.75
"""A single step that makes up more of the difference is a step of the positions, of which the velocity knows nothing."""
WHOLE_TRACK_SHARE: Final = 0.5
"""If more than this share of a track contradicts its velocities, the recorded velocity is wrong, not a stretch of it (see `checks`)."""
LARGEST_HALF_BOX_M: Final = 6.0
"""No box reaches further than this from its middle, where its size is not known."""


def resolve(
    states: States, step: Steps, actors: Actors, *, derived: bool, split_tracks: SplitTracks = NO_SPLIT
) -> list[QualityFinding]:
    """Make values unknown that contradict the motion, in place (states in order, velocities complete).

    `derived`: velocities come from the positions, and contradict nothing. `split_tracks`: samples that were doubted before.
    """
    if len(states) < 3:
        return []
    findings: list[QualityFinding] = []
    places = [split_tracks.rejected_states] if split_tracks.rejected_states else []
    if not derived:
        frozen = _frozen(states, step)
        if frozen.any():
            places.append(states.take(frozen))
        text = COUNT_PREFIX + "position and velocity contradict each other: they are unknown"
        findings += states.findings(frozen, "motion_unknown", "warning", text)
        set_unknown(states, frozen)
        astray = _mismatched(states, step)
        text = "for half a second or longer, the velocity does not match the positions: it is unknown"
        findings += states.findings(astray, "velocity_unknown", "warning", COUNT_PREFIX + text)
        set_unknown(states, astray, MOTION_COLUMNS)
    for each in places:
        findings += _upon_others(states, step, actors, each, split_tracks.alias)
    turned, sideways = _headings(states, step, actors)
    yaw = states.numbers["yaw_rad"]
    text = COUNT_PREFIX + "the heading is turned round, but the motion is not: the motion is used"
    findings += states.findings(turned, "heading_turned", "warning", text)
    text = COUNT_PREFIX + "the heading is across the motion: it is unknown"
    findings += states.findings(sideways, "heading_unknown", "warning", text)
    yaw = np.where(turned, wrapped(yaw + np.pi), yaw)
    states.numbers["yaw_rad"] = np.where(sideways, np.nan, yaw)
    return findings


def _upon_others(
    states: States, step: Steps, actors: Actors, rejected_states: States, alias: Mapping[str, str]
) -> list[QualityFinding]:
    """Report the actors of whose refused places one is so near to another actor's place that their boxes may overlap."""
    index = {name: i for i, name in enumerate(actors.ids)}
    half = np.hypot(actors.sizes["length_m"], actors.sizes["width_m"]) / 2
    half = np.where(np.isfinite(half), half, LARGEST_HALF_BOX_M)
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
    own = half[[index[name] for name in own_names]][place] if len(n) else np.zeros(0)
    # the track that goes on after the jump is the same actor's in the log
    in_log = np.array([alias.get(name, name) for name in states.ids], dtype=np.str_)
    own_in_log = np.array([alias.get(name, name) for name in own_names], dtype=np.str_)
    upon = (away <= own + half_of[other_row]) & (in_log[states.actor[other_row]] != own_in_log[place])
    findings = []
    for number in np.unique(rejected_states.actor[place[upon]]):
        name = rejected_states.ids[number]
        rows = upon & (rejected_states.actor[place] == number)
        others = sorted({states.ids[i] for i in states.actor[other_row[rows]]})
        times = np.unique(rejected_states.t_ns[place[rows]])
        message = f"a position of {name} that is not credible lies on {listed(others)}: it is unknown whether they touched there"
        findings.append(QualityFinding("jumps_onto", "warning", message, len(times), int(times[0]), name))
    return findings


def _frozen(states: States, step: Steps) -> Mask:
    """Return the samples at which positions and velocities contradict each other.

    A sample is one if both steps beside it do, or one of them by far, or if half a second before and after it they lead elsewhere
    without such steps.
    """
    n = len(states)
    usable = known_motion(states, step)
    went, led, slack = _step_by_step(states, step, usable)

    def contradict(displacement: Floats, velocity_displacement: Floats, slack_m: Floats) -> Mask:
        fastest = np.maximum(np.hypot(*displacement), np.hypot(*velocity_displacement))
        wrong: Mask = (
            np.hypot(*(displacement - velocity_displacement)) > MISMATCH_M + MISMATCH_SHARE * fastest + slack_m
        )
        return wrong

    alone = contradict(went, led, slack)
    if not alone.any() and not _drifts(went - led, step):
        return np.zeros(n, np.bool_)
    ends = np.ones(n + 1, np.bool_)  # beyond a track's end nothing vouches for its last sample
    ends[1:-1] = alone | ~usable
    both = ends[:-1] & ends[1:] & (np.r_[alone, False] | np.r_[False, alone])
    moved = contradict(went, led, slack + STEP_MISMATCH_M - MISMATCH_M)
    beside = both | np.r_[moved, False] | np.r_[False, moved]
    went, led, slack = (np.where(alone, 0.0, values) for values in (went, led, slack))
    first, last = _around(states, np.cumsum(np.r_[False, ~usable]), np.arange(n))

    def between(values: Floats) -> Floats:
        sums = sums_until(values)
        return sums[..., last] - sums[..., first]

    frozen: Mask = beside | contradict(between(went), between(led), between(slack))
    return frozen


def _step_by_step(states: States, step: Steps, usable: Mask) -> tuple[Floats, Floats, Floats]:
    """Return how far positions go and velocities lead in each step (2, n - 1), and how far off the velocity's way may be."""
    went = np.where(usable, np.diff(states.place), 0.0)
    led = integral_per_step(states.velocity, step, usable)
    # what the velocity did between two samples is not known
    slack = np.where(usable, 0.5 * np.abs(np.diff(states.velocity)) * step.dt_s, 0.0)
    return went, led, np.hypot(*slack)


def _apart(states: States, step: Steps, usable: Mask) -> tuple[Floats, Floats]:
    """Return how far positions and velocities lead apart in each step (n - 1), and how far off the velocity's way may be."""
    went, led, slack = _step_by_step(states, step, usable)
    went -= led
    return np.hypot(*went), slack


def _drifts(rest: Floats, step: Steps) -> bool:
    """Examine only every half second: whether the velocities of any actor may lead away from its positions."""
    stride = max(1, round(WINDOW_S * 1e9 / step.period_ns)) if step.period_ns else 1
    way = np.cumsum(rest, axis=1)[:, ::stride]
    # a one-second window spans at most three strides, so one of them has at least a third of its difference
    return bool((np.hypot(*np.diff(way, axis=1)) > MISMATCH_M / 3).any())


def _mismatched(states: States, step: Steps) -> Mask:
    """Return the samples (n, in order, velocities complete) of stretches whose velocities contradict their positions."""
    n = len(states)
    mismatched = np.zeros(n, np.bool_)
    k = max(2, round(STRETCH_S * 1e9 / step.period_ns)) if step.period_ns else n
    if n <= k:
        return mismatched
    usable = known_motion(states, step)
    alone, slack = _apart(states, step, usable)
    went, led, whole, span = displacements(states, step, usable, k)
    span = np.where(whole, span, np.nan)
    went /= span
    led /= span
    off = np.hypot(*(went - led))
    # in place: these are the largest arrays of all, for a long drive
    np.maximum(np.abs(went, out=went), np.abs(led, out=led), out=went)
    fastest = np.hypot(*went)
    del went, led
    allowed = STRETCH_MISMATCH_MPS + STRETCH_MISMATCH_SHARE * fastest + _sliding_max(slack, k) / span
    wrong = whole & (off > allowed) & (_sliding_max(alone, k) < SINGLE_STEP_SHARE * off * span)
    if not wrong.any():
        return mismatched
    sigma = sample_noise(states.place, Tracklets.from_samples(states.t_ns, states.place, step), states.actor)
    wrong &= off > allowed + SIGMAS * np.sqrt(2.0) * sigma[:-k] / span
    rows = np.flatnonzero(wrong)
    edges = np.zeros(n + 1, np.int64)
    np.add.at(edges, rows, 1)
    np.add.at(edges, rows + k + 1, -1)
    mismatched = np.cumsum(edges[:-1]) > 0
    wrong_by_actor, all_by_actor = (
        np.bincount(who, minlength=len(states.ids)) for who in (states.actor[mismatched], states.actor)
    )
    many = wrong_by_actor > WHOLE_TRACK_SHARE * all_by_actor
    return mismatched & ~many[states.actor]


def _sliding_max(values: Floats, k: int) -> Floats:
    """Return the largest of every k neighbouring values (m - k + 1 of m)."""
    most: Floats = np.lib.stride_tricks.sliding_window_view(values, k).max(axis=1)
    return most


def _around(states: States, pieces: NDArray[np.integer], rows: Indices) -> tuple[Indices, Indices]:
    """Return for each of these rows the first and the last row of its piece within half a second of it."""
    half = int(WINDOW_S * 1e9)
    apart = np.diff(states.t_ns)
    # longer steps and those to another piece are just too long: their sum stays small, whatever the clock said
    near = (np.diff(pieces) == 0) & (apart >= 0) & (apart <= half)
    key = np.r_[0, np.cumsum(np.where(near, apart, half + 1))]
    return np.searchsorted(key, key[rows] - half), np.searchsorted(key, key[rows] + half, side="right") - 1


def _leads(states: States, rows: Mask) -> Mask:
    """Keep the rows around which the positions advance as the speed states: an actor that trembles on the spot has no direction."""
    marked_rows = np.flatnonzero(rows)
    first, last = _around(states, states.actor, marked_rows)
    place, speed = states.place, np.hypot(*states.velocity[:, marked_rows])
    way = np.hypot(*(place[:, last] - place[:, first]))
    span = (states.t_ns[last] - states.t_ns[first]) * 1e-9
    kept = rows.copy()
    kept[marked_rows] = way > np.maximum(DIRECTION_LEAST_M, DIRECTION_LEAST_SHARE * speed * span)
    return kept


def _headings(states: States, step: Steps, actors: Actors) -> tuple[Mask, Mask]:
    """Return the samples whose heading is turned round against the motion, and those at which it lies across it.

    A stretch in which a vehicle moves backwards is reversing if it is entered and left by a standstill or with the log, without a
    turn of the heading, and is slow throughout, or the vehicle is seen to go forwards with that heading before or after, and to
    gain speed from the standstill between; a stretch across the motion is a slide if the heading turns into it and out of it
    as far as a vehicle can.
    """
    n, yaw, (vx, vy) = len(states), states.numbers["yaw_rad"], states.velocity
    kinds = dict(zip(actors.ids, actors.classes, strict=True))
    long_kind = np.array([kinds.get(name) in DIRECTED_CLASSES for name in states.ids], np.bool_)[states.actor]
    speed = np.hypot(vx, vy)
    off = np.abs(wrapped(yaw - np.arctan2(vy, vx)))
    moving = long_kind & (speed > MOVING_MPS) & np.isfinite(yaw)
    backwards = moving & (off > BACKWARDS_RAD)
    across = moving & (speed > SIDEWAYS_MPS) & (off > SIDEWAYS_RAD) & ~backwards
    turn = np.where(step.same, np.abs(wrapped(np.diff(yaw))), 0.0)
    nothing = np.zeros(n, np.bool_)
    if not (backwards.any() or across.any()):
        return nothing, nothing
    backwards, across = _leads(states, backwards), _leads(states, across)
    forwards = moving & ~backwards & ~across
    turned, sideways = nothing, nothing.copy()
    row = np.arange(n)
    # the last row before, and the first one after, at which its vehicle goes forwards; and how often headings have turned until a row
    went = np.maximum.accumulate(np.where(forwards, row, -1))
    goes = np.minimum.accumulate(np.where(forwards, row, n)[::-1])[::-1]
    turns_until = np.r_[0, np.cumsum(turn > HEADING_FLIP_RAD)]

    def is_reversing_start(end: int, forth: int) -> bool:
        return bool(
            0 <= forth < n
            and states.actor[forth] == states.actor[end]
            and turns_until[forth] == turns_until[end]
            and speed[end] < REVERSE_START_MPS
        )

    for rows, out, most in ((backwards, turned, HEADING_FLIP_RAD), (across, sideways, SPIN_RAD)):
        turns = turn > most
        for first, last in _runs(states, rows):
            seam = (first > 0 and step.same[first - 1]), (last < n - 1 and step.same[last])
            broken = (seam[0] and turns[first - 1]) or (seam[1] and turns[last])
            beside = (seam[0] and forwards[first - 1]) or (seam[1] and forwards[last + 1])
            if out is turned:
                fastest = (
                    FAST_REVERSING_MPS
                    if is_reversing_start(first, went[first]) or is_reversing_start(last, goes[last])
                    else REVERSING_MPS
                )
                real = speed[first : last + 1].max() < fastest and not broken and not beside
            else:
                real = beside and not broken and not turns[first:last].any()
            if not real:
                out[first : last + 1] = True
    return turned, sideways


def _runs(states: States, rows: Mask) -> list[tuple[int, int]]:
    """Return the first and the last row of each stretch of marked rows of one actor."""
    same = np.r_[False, (states.actor[1:] == states.actor[:-1]) & rows[:-1] & rows[1:]]
    first = np.flatnonzero(rows & ~same)
    last = np.flatnonzero(rows & ~np.r_[same[1:], False])
    return list(zip(first.tolist(), last.tolist(), strict=True))
