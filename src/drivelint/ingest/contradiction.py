"""What a log says about an actor that cannot all be true becomes unknown, so that no verdict is built on it.

Positions decide over velocities and headings as long as they are a track. Where a position jumps, or stands while the velocity
moves on, the state is unknown (no position, heading or velocity). A track that goes on elsewhere after a jump is another actor's.
A heading that turns round from one sample to the next while the motion goes on is turned back; one across the motion is unknown.
A place that is not believed and lies upon another actor is said: whoever bounds how near the two came must know.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Final

import numpy as np

from drivelint.ingest.contrary import contrary
from drivelint.ingest.off_track import off_track
from drivelint.ingest.order import listed, wrapped
from drivelint.ingest.trace import MOTOR_VEHICLES, Finding

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

    from numpy.typing import NDArray

    from drivelint.ingest.actors import Actors
    from drivelint.ingest.order import Steps
    from drivelint.ingest.trace import States

    Mask = NDArray[np.bool_]
    Numbers = NDArray[np.float64]

JUMP_M: Final = 3.0
JUMP_MPS2: Final = 10.0
"""A step is a jump if it is longer than both its neighbours foretell by 3 m + 10 m/s2 dt2: no tyre does that, and a full stop
within one sample of 0.1 s, as simulators have it, only from more than 30 m/s."""
SHORT_S: Final = 2.0
"""A piece of a track between two jumps that is shorter than this is an outlier; a longer one is somebody's track."""
CORRECTED_M: Final = 10.0
CORRECTED_LEFT_M: Final = 1.5
CORRECTED_MPS: Final = 3.0
"""A place is put right by no more than this along the lane, and to its side, where no other lane is; the velocity goes on."""
FROZEN_M: Final = 1.0
FROZEN_SHARE: Final = 0.15
"""Positions contradict velocities if over a second they lead elsewhere by more than 1 m + 15 % of the way: noise of 0.3 m and
velocities of 10 % error do not."""
SHIFT_M: Final = 2.0
"""A single step contradicts the velocities, whatever the next one does, from this on: six times the noise above."""
WINDOW_S: Final = 0.5
MOVING_MPS: Final = 1.0
"""Below this the direction of motion is noise, and the heading is what there is."""
LED_M: Final = 0.4
LED_SHARE: Final = 0.5
"""A motion has a direction if within a second around it leads 0.4 m on, and half as far as its speed says."""
REVERSING_MPS: Final = 8.0
"""Nobody reverses faster than this (29 km/h),"""
FAST_REVERSING_MPS: Final = 20.0
STARTING_MPS: Final = 3.0
"""unless it is seen to stop and to set off backwards: at its first moving sample it is no faster than 3 m/s, and never than 72 km/h."""
BACKWARDS_RAD: Final = np.deg2rad(150.0)
SIDEWAYS_RAD: Final = np.deg2rad(30.0)
SIDEWAYS_MPS: Final = 3.0
"""A heading this far off the motion is that of a slide, or wrong; slip angles of a car stay below 10 degrees."""
TURN_RAD: Final = np.deg2rad(90.0)
SPIN_RAD: Final = np.deg2rad(45.0)
"""No heading turns round between two samples; and no vehicle spins further than this, which is 450 degrees/s at 10 Hz."""
LONG_KINDS: Final = frozenset((*MOTOR_VEHICLES, "trailer", "bicycle", None))
"""Actors whose heading is that of their motion; people and animals face where they like, things have no front."""
HALF_BOX_M: Final = 6.0
"""No box reaches further than this from its middle, where its size is not known."""
VELOCITY: Final = ("vx_mps", "vy_mps", "ax_mps2", "ay_mps2")
STATE: Final = ("x_m", "y_m", "z_m", "yaw_rad", *VELOCITY)


@dataclass(frozen=True)
class Refused:
    """Places that the log gives and that are not believed: parallel arrays, `actor_ids` those of the finished drive."""

    actor_ids: NDArray[np.str_]
    t_ns: NDArray[np.int64]
    x_m: Numbers
    y_m: Numbers

    @classmethod
    def of(cls, states: States, rows: Mask) -> Refused:
        """Take the places of these rows."""
        names = np.array(states.ids, dtype=np.str_)[states.actor[rows]]
        return cls(names, states.t_ns[rows], states.numbers["x_m"][rows], states.numbers["y_m"][rows])

    def with_more(self, more: Refused) -> Refused:
        """Return these places and those."""
        pairs = ((getattr(self, name), getattr(more, name)) for name in ("actor_ids", "t_ns", "x_m", "y_m"))
        return Refused(*map(np.concatenate, pairs))


@dataclass(frozen=True)
class Parted:
    """`alias`: new actor id -> the id in the log, where a track goes on elsewhere after a jump."""

    findings: list[Finding]
    alias: dict[str, str]
    refused: Refused | None = None


UNPARTED: Final = Parted([], {})


def part(states: States, step: Steps, *, whole: Collection[str]) -> Parted:
    """Make what lies at jumps unknown and give what goes on elsewhere an id of its own, in place (states in order).

    `whole`: actors that keep their id (the egos that are named).
    """
    if len(states) < 3 or not {"x_m", "y_m"} <= states.numbers.keys():
        return UNPARTED
    jump = jumps(states, step)
    findings: list[Finding] = []
    alias: dict[str, str] = {}
    unknown, pieces = _around_jumps(states, jump)
    if jump.any():
        findings = _report(states, unknown, "teleport", "the position jumps: they are unknown around it")
        alias = _renamed(states, pieces, whole, findings)
    refused = Refused.of(states, unknown)
    _forget(states, unknown)
    beside = off_track(states, step)
    if beside.any():
        text = "the position is beside its track, for a sample or by a step that nobody drives: they are unknown there"
        findings += _report(states, beside, "teleport", text)
        refused = refused.with_more(Refused.of(states, beside))
        _forget(states, beside)
    return Parted(findings, alias, refused) if findings else UNPARTED


def resolve(states: States, step: Steps, actors: Actors, *, derived: bool, parted: Parted = UNPARTED) -> list[Finding]:
    """Make what contradicts the motion unknown, in place (states in order, velocities complete).

    `derived`: velocities come from the positions, and contradict nobody. `parted`: what was not believed before.
    """
    if len(states) < 3:
        return []
    findings: list[Finding] = []
    places = [parted.refused] if parted.refused else []
    if not derived:
        frozen = _frozen(states, step)
        if frozen.any():
            places.append(Refused.of(states, frozen))
        findings += _report(
            states, frozen, "motion_unknown", "position and velocity contradict each other: they are unknown"
        )
        _forget(states, frozen)
        astray = contrary(states, step)
        text = "for half a second and longer the velocity leads elsewhere than the positions: it is unknown"
        findings += _report(states, astray, "velocity_unknown", text)
        _forget(states, astray, VELOCITY)
    for each in places:
        findings += _upon_others(states, step, actors, each, parted.alias)
    turned, sideways = _headings(states, step, actors)
    yaw = states.numbers["yaw_rad"]
    if turned.any():
        text = "the heading is turned round, the motion is not: the motion counts"
        findings += _report(states, turned, "heading_turned", text)
        yaw = np.where(turned, wrapped(yaw + np.pi), yaw)
    if sideways.any():
        findings += _report(states, sideways, "heading_unknown", "the heading is across the motion: it is unknown")
        yaw = np.where(sideways, np.nan, yaw)
    states.numbers["yaw_rad"] = yaw
    return findings


def _forget(states: States, rows: Mask, what: tuple[str, ...] = STATE) -> None:
    if rows.any():
        for name in set(what) & states.numbers.keys():
            states.numbers[name] = np.where(rows, np.nan, states.numbers[name])


def _upon_others(
    states: States, step: Steps, actors: Actors, refused: Refused, alias: Mapping[str, str]
) -> list[Finding]:
    """Report the actors of whose refused places one is so near to another actor's place that their boxes may overlap."""
    index = {name: i for i, name in enumerate(actors.ids)}
    half = np.hypot(actors.sizes["length_m"], actors.sizes["width_m"]) / 2
    half = np.where(np.isfinite(half), half, HALF_BOX_M)
    half_of = half[[index[name] for name in states.ids]][states.actor]
    placed = np.flatnonzero(np.isfinite(states.numbers["x_m"]) & np.isfinite(states.numbers["y_m"]))
    placed = placed[np.argsort(states.t_ns[placed], kind="stable")]
    t_ns, beside = states.t_ns[placed], max(step.period_ns, 1)
    first = np.searchsorted(t_ns, refused.t_ns - beside)
    n = np.searchsorted(t_ns, refused.t_ns + beside, side="right") - first
    place = np.repeat(np.arange(len(n)), n)
    other = placed[np.arange(len(place)) - np.repeat(np.cumsum(n) - n, n) + first[place]]
    away = np.hypot(
        refused.x_m[place] - states.numbers["x_m"][other], refused.y_m[place] - states.numbers["y_m"][other]
    )
    own = half[[index[name] for name in refused.actor_ids.tolist()]][place] if len(n) else np.zeros(0)
    names = np.array(states.ids, dtype=np.str_)
    # the track that goes on after the jump is the same actor's in the log
    in_log = np.array([alias.get(name, name) for name in states.ids], dtype=np.str_)
    own_in_log = np.array([alias.get(name, name) for name in refused.actor_ids.tolist()], dtype=np.str_)
    upon = (away <= own + half_of[other]) & (in_log[states.actor[other]] != own_in_log[place])
    findings = []
    for name in np.unique(refused.actor_ids[place[upon]]).tolist():
        rows = upon & (refused.actor_ids[place] == name)
        others = np.unique(names[states.actor[other[rows]]]).tolist()
        times = np.unique(refused.t_ns[place[rows]])
        message = (
            f"a place of {name} that is not believed lies upon {listed(others)}: whether they met there is unknown"
        )
        findings.append(Finding("jumps_onto", "warning", message, len(times), int(times[0]), name))
    return findings


def _report(states: States, rows: Mask, check: str, text: str) -> list[Finding]:
    n = int(rows.sum())
    if not n:
        return []
    ids = [states.ids[i] for i in np.unique(states.actor[rows])]
    message = f"{n} of {len(states)} states ({listed(ids)}): {text}"
    only = ids[0] if len(ids) == 1 else None
    return [Finding(check, "warning", message, n, int(states.t_ns[rows].min()), only)]


def jumps(states: States, step: Steps) -> Mask:
    """Return per step (n - 1) whether it is a jump: longer than the step before it and the one after it foretell.

    At a track's ends, and beside a hole, the only neighbour decides.
    """
    dx, dy = np.diff(states.numbers["x_m"]), np.diff(states.numbers["y_m"])
    dt = np.where(step.dt_s > 0.0, step.dt_s, np.nan)
    limit = JUMP_M + JUMP_MPS2 * dt**2
    with np.errstate(invalid="ignore"):
        far: Mask = step.continuous & (np.hypot(dx, dy) > limit)
    rows = np.flatnonzero(far)
    if not len(rows):
        return far
    told, against = np.zeros(len(rows), np.int8), np.zeros(len(rows), np.int8)
    for side in (-1, 1):
        beside = np.clip(rows + side, 0, len(dx) - 1)
        known = (beside == rows + side) & step.continuous[beside] & np.isfinite(dx[beside])
        scale = dt[rows] / dt[beside]
        with np.errstate(invalid="ignore"):
            off = np.hypot(dx[rows] - scale * dx[beside], dy[rows] - scale * dy[beside]) > limit[rows]
        told += known
        against += known & off
    far[rows] = (told > 0) & (against == told)
    return far


def _around_jumps(states: States, jump: Mask) -> tuple[Mask, NDArray[np.int32]]:
    """Return which samples jumps make unknown, and the number of each sample's piece of its track."""
    n = len(states)
    unknown, pieces = np.zeros(n, np.bool_), np.zeros(n, np.int32)
    if not jump.any():
        return unknown, pieces
    unknown[:-1] |= jump
    unknown[1:] |= jump
    for actor in np.unique(states.actor[:-1][jump]):
        span = slice(*np.searchsorted(states.actor, [actor, actor + 1]))
        cuts = np.flatnonzero(jump[span.start : span.stop - 1]) + span.start + 1
        bounds = [span.start, *cuts.tolist(), span.stop]
        number, last = 0, None
        for first, end in pairwise(bounds):
            if (states.t_ns[end - 1] - states.t_ns[first]) * 1e-9 < SHORT_S and len(bounds) > 2:
                unknown[first:end] = True
                pieces[first:end] = number
                continue
            if last is not None and not _goes_on(states, last, first):
                number += 1
            pieces[first:end] = number
            last = end - 1
    return unknown, pieces


def _goes_on(states: States, last: int, first: int) -> bool:
    """Say whether the track that ends at row `last` can be that which begins at row `first`, at the velocities it had there.

    Either it can have got there, or its place is put right along its lane, as maps and filters do, and it moves on as before.
    """
    x, y, t_s = states.numbers["x_m"], states.numbers["y_m"], states.t_ns * 1e-9
    gap = t_s[first] - t_s[last]
    if gap > 2 * SHORT_S:
        return False
    before, after = (np.array([x[i] - x[i - 1], y[i] - y[i - 1]]) / (t_s[i] - t_s[i - 1]) for i in (last, first + 1))
    way = np.array([x[first] - x[last], y[first] - y[last]])
    fastest = np.nan_to_num(np.hypot(*np.transpose([before, after]))).max()
    if np.hypot(*way) <= JUMP_M + fastest * gap + JUMP_MPS2 * gap**2 / 2:
        return True
    speed = float(np.hypot(*before))
    if not speed > MOVING_MPS or not np.hypot(*(after - before)) <= JUMP_MPS2 * gap + CORRECTED_MPS:
        return False
    ahead, left = before / speed @ way - speed * gap, (before[0] * way[1] - before[1] * way[0]) / speed
    return bool(abs(ahead) <= CORRECTED_M and abs(left) <= CORRECTED_LEFT_M)


def _frozen(states: States, step: Steps) -> Mask:
    """Return the samples at which positions and velocities contradict each other.

    A sample is one if both steps beside it do, or one of them by far, or if half a second before and after it they lead elsewhere
    without such steps.
    """
    numbers, n = states.numbers, len(states)
    usable = step.continuous.copy()
    for name in ("x_m", "y_m", "vx_mps", "vy_mps"):
        usable &= np.isfinite(numbers[name][1:]) & np.isfinite(numbers[name][:-1])
    went, led, slack = np.zeros((2, n - 1)), np.zeros((2, n - 1)), np.zeros(n - 1)
    for i, (place, rate_of) in enumerate((("x_m", "vx_mps"), ("y_m", "vy_mps"))):
        v = numbers[rate_of]
        went[i] = np.where(usable, np.diff(numbers[place]), 0.0)
        led[i] = np.where(usable, 0.5 * (v[1:] + v[:-1]) * step.dt_s, 0.0)
        # what the velocity did between two samples is not known
        slack = np.hypot(slack, np.where(usable, 0.5 * np.abs(np.diff(v)) * step.dt_s, 0.0))

    def contradict(way: Numbers, told: Numbers, either: Numbers) -> Mask:
        fastest = np.maximum(np.hypot(*way), np.hypot(*told))
        wrong: Mask = np.hypot(*(way - told)) > FROZEN_M + FROZEN_SHARE * fastest + either
        return wrong

    alone = contradict(went, led, slack)
    if not alone.any() and not _drifts(went - led, step):
        return np.zeros(n, np.bool_)
    ends = np.ones(n + 1, np.bool_)  # beyond a track's end nothing vouches for its last sample
    ends[1:-1] = alone | ~usable
    both = ends[:-1] & ends[1:] & (np.r_[alone, False] | np.r_[False, alone])
    moved = contradict(went, led, slack + SHIFT_M - FROZEN_M)
    beside = both | np.r_[moved, False] | np.r_[False, moved]
    went, led, slack = (np.where(alone, 0.0, values) for values in (went, led, slack))
    first, last = _around(states, np.cumsum(np.r_[False, ~usable]), np.arange(n))
    sums = {
        name: np.concatenate([np.zeros((2, 1)), np.cumsum(values, axis=1)], axis=1)
        for name, values in (("went", went), ("led", led))
    }
    loose = np.r_[0.0, np.cumsum(slack)]
    around = contradict(
        sums["went"][:, last] - sums["went"][:, first],
        sums["led"][:, last] - sums["led"][:, first],
        loose[last] - loose[first],
    )
    frozen: Mask = beside | around
    return frozen


def _drifts(rest: Numbers, step: Steps) -> bool:
    """Look at every half second only: whether anybody's velocities may lead away from its positions at all."""
    stride = max(1, round(WINDOW_S * 1e9 / step.period_ns)) if step.period_ns else 1
    way = np.cumsum(rest, axis=1)[:, ::stride]
    # a window of a second lies in three strides at the most: one of them has a third of what it has
    return bool((np.hypot(*np.diff(way, axis=1)) > FROZEN_M / 3).any())


def _around(
    states: States, pieces: NDArray[np.integer], rows: NDArray[np.intp]
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return for each of these rows the first and the last row of its piece within half a second of it."""
    key = pieces.astype(np.int64) * (int(np.ptp(states.t_ns)) + int(4e9)) + (states.t_ns - states.t_ns.min())
    half = int(WINDOW_S * 1e9)
    return np.searchsorted(key, key[rows] - half), np.searchsorted(key, key[rows] + half, side="right") - 1


def _leads(states: States, rows: Mask) -> Mask:
    """Keep those rows around which the positions lead on as the speed says: what trembles on the spot has no direction."""
    found = np.flatnonzero(rows)
    first, last = _around(states, states.actor, found)
    numbers = states.numbers
    speed = np.hypot(numbers["vx_mps"][found], numbers["vy_mps"][found])
    way = np.hypot(numbers["x_m"][last] - numbers["x_m"][first], numbers["y_m"][last] - numbers["y_m"][first])
    span = (states.t_ns[last] - states.t_ns[first]) * 1e-9
    kept = rows.copy()
    kept[found] = way > np.maximum(LED_M, LED_SHARE * speed * span)
    return kept


def _headings(states: States, step: Steps, actors: Actors) -> tuple[Mask, Mask]:
    """Return the samples whose heading is turned round against the motion, and those at which it lies across it.

    A stretch in which a vehicle moves backwards is reversing if it is entered and left by a standstill or with the log, without a
    turn of the heading, and is slow throughout, or the vehicle is seen to go forwards with that heading before or after, and to
    gain speed from the standstill between; a stretch across the motion is a slide if the heading turns into it and out of it
    as far as a vehicle can.
    """
    n, numbers = len(states), states.numbers
    kinds = dict(zip(actors.ids, actors.classes, strict=True))
    long_kind = np.array([kinds.get(name) in LONG_KINDS for name in states.ids], np.bool_)[states.actor]
    yaw, speed = numbers["yaw_rad"], np.hypot(numbers["vx_mps"], numbers["vy_mps"])
    with np.errstate(invalid="ignore"):
        off = np.abs(wrapped(yaw - np.arctan2(numbers["vy_mps"], numbers["vx_mps"])))
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
    turns_until = np.r_[0, np.cumsum(turn > TURN_RAD)]

    def shown(end: int, forth: int) -> bool:
        return bool(
            0 <= forth < n
            and states.actor[forth] == states.actor[end]
            and turns_until[forth] == turns_until[end]
            and speed[end] < STARTING_MPS
        )

    for rows, out, most in ((backwards, turned, TURN_RAD), (across, sideways, SPIN_RAD)):
        turns = turn > most
        for first, last in _runs(states, rows):
            seam = (first > 0 and step.same[first - 1]), (last < n - 1 and step.same[last])
            broken = (seam[0] and turns[first - 1]) or (seam[1] and turns[last])
            beside = (seam[0] and forwards[first - 1]) or (seam[1] and forwards[last + 1])
            if out is turned:
                fastest = FAST_REVERSING_MPS if shown(first, went[first]) or shown(last, goes[last]) else REVERSING_MPS
                real = speed[first : last + 1].max() < fastest and not broken and not beside
            else:
                real = beside and not broken and not turns[first:last].any()
            if not real:
                out[first : last + 1] = True
    return turned, sideways


def _runs(states: States, rows: Mask) -> list[tuple[int, int]]:
    """Return the first and the last row of each stretch of marked rows of one actor."""
    if not rows.any():
        return []
    same = np.r_[False, (states.actor[1:] == states.actor[:-1]) & rows[:-1] & rows[1:]]
    first = np.flatnonzero(rows & ~same)
    last = np.flatnonzero(rows & ~np.r_[same[1:], False])
    return list(zip(first.tolist(), last.tolist(), strict=True))


def _renamed(
    states: States, pieces: NDArray[np.int32], whole: Collection[str], findings: list[Finding]
) -> dict[str, str]:
    """Give each later piece of a track that jumped an id of its own, in place; return new id -> old id."""
    alias: dict[str, str] = {}
    if not pieces.any():
        return alias
    kept = {i for i, name in enumerate(states.ids) if name in whole}
    keys = np.where(np.isin(states.actor, list(kept)), 0, pieces)
    ids, actor = list(states.ids), states.actor.copy()
    for i in np.unique(states.actor[keys > 0]):
        for number in range(1, int(keys[states.actor == i].max()) + 1):
            name = f"{states.ids[i]}#{number + 1}"
            while name in ids:
                name += "'"
            actor[(states.actor == i) & (keys == number)] = len(ids)
            ids.append(name)
            alias[name] = states.ids[i]
    if alias:
        message = (
            f"the track goes on elsewhere after a jump: from there on it is another actor's ({listed(sorted(alias))})"
        )
        findings.append(Finding("track_parted", "warning", message, len(alias), actor_id=None))
    states.ids, states.actor = ids, actor
    return alias
