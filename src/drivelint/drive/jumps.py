"""Makes states around a position jump unknown; a track that continues elsewhere becomes another actor.

It also ends the tracks of actors that a simulator removed but still writes, all at one position: CARLA leaves destroyed actors at the
origin. Two bodies are never at the same position.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING, Final

import numpy as np

from drivelint.drive.outliers import outlier_samples
from drivelint.drive.trace import STATE_COLUMNS, QualityFinding
from drivelint.phrases import name_list

if TYPE_CHECKING:
    from collections.abc import Collection

    from numpy.typing import NDArray

    from drivelint.arrays import Floats, Mask
    from drivelint.drive.order import Steps
    from drivelint.drive.trace import States


LEAST_JUMP_M: Final = 3.0
JUMP_ACCELERATION_MPS2: Final = 10.0
"""A step is a jump if it differs by more than 3 m + 10 m/s2 dt2 from what the step before and the step after it predict. No tyre does
that; a simulated full stop within one sample of 0.1 s does it only from more than 30 m/s."""
LONGEST_OUTLIER_PIECE_S: Final = 2.0
"""Pieces of a track between two jumps are outliers if they are shorter than this; longer pieces are tracks of actors."""
LARGEST_CORRECTION_ALONG_MOTION_M: Final = 10.0
LARGEST_SIDE_CORRECTION_M: Final = 1.5
LARGEST_VELOCITY_CHANGE_AT_CORRECTION_MPS: Final = 3.0
"""A jump corrects the track if it is at most 10 m along the motion and 1.5 m to the side (not to another lane), and the velocity changes
by at most 3 m/s + `JUMP_ACCELERATION_MPS2` times the gap."""
LEAST_SPEED_WITH_MOTION_DIRECTION_MPS: Final = 1.0
"""Below this speed the direction of motion is noise, and the heading is used."""
MOTION_COLUMNS: Final = ("vx_mps", "vy_mps", "ax_mps2", "ay_mps2")
SAME_POSITION_TOLERANCE_M: Final = 0.01
"""Centres no further apart than this are at the same position."""
COUNT_OF_STATES_PREFIX: Final = "{n} of {of} states ({ids}): "


@dataclass(frozen=True)
class SplitTracks:
    """The result of `split_tracks`.

    `old_id_by_id`: new actor id -> id in the log, for tracks that continue elsewhere after a jump. `rejected_states`: the states that were
    made unknown, with their recorded values and the new actor ids.
    """

    findings: list[QualityFinding]
    old_id_by_id: dict[str, str]
    rejected_states: States | None = None


NO_SPLIT: Final = SplitTracks([], {})


def split_tracks(states: States, step: Steps, *, kept_ids: Collection[str]) -> SplitTracks:
    """Make states at jumps unknown, and give a track that continues elsewhere a new id, in place (states in order).

    `kept_ids`: actors that keep their id (the named egos).
    """
    if len(states) < 3 or not {"x_m", "y_m"} <= states.numbers.keys():
        return NO_SPLIT
    unknown, pieces = _unknown_samples_and_pieces(states, jump_steps(states, step))
    text = COUNT_OF_STATES_PREFIX + "the position jumps: the states around the jump are unknown"
    findings = states.findings(unknown, "teleport", "warning", text)
    alias = _give_ids_to_pieces_and_return_old_ids(states, pieces, kept_ids, findings)
    recorded = replace(states, numbers=dict(states.numbers))
    set_unknown(states, unknown)
    beside = outlier_samples(states, step)
    text = (
        "the position is off the track, for one sample or by a step that no vehicle can drive: these states are unknown"
    )
    findings += states.findings(beside, "teleport", "warning", COUNT_OF_STATES_PREFIX + text)
    set_unknown(states, beside)
    return SplitTracks(findings, alias, recorded.take(unknown | beside)) if findings else NO_SPLIT


def set_unknown(states: States, rows: Mask, columns: tuple[str, ...] = STATE_COLUMNS) -> None:
    """Set the given columns to NaN in the given rows, in place."""
    if rows.any():
        for name in set(columns) & states.numbers.keys():
            states.numbers[name] = np.where(rows, np.nan, states.numbers[name])


def jump_steps(states: States, step: Steps) -> Mask:
    """Return for each step (n - 1) whether it is a jump: it differs from what the steps before and after it predict.

    At the end of a track or beside a hole, the only neighbour decides.
    """
    way = np.diff(states.place)
    dt = np.where(step.dt_s > 0.0, step.dt_s, np.nan)
    limit = LEAST_JUMP_M + JUMP_ACCELERATION_MPS2 * dt**2
    far: Mask = step.continuous & (np.hypot(*way) > limit)
    rows = np.flatnonzero(far)
    if not len(rows):
        return far
    n_neighbours, n_against = np.zeros(len(rows), np.int8), np.zeros(len(rows), np.int8)
    for side in (-1, 1):
        beside = np.clip(rows + side, 0, len(dt) - 1)
        has_neighbour = (beside == rows + side) & step.continuous[beside] & np.isfinite(way[0, beside])
        scale = dt[rows] / dt[beside]
        off = np.hypot(*(way[:, rows] - scale * way[:, beside])) > limit[rows]
        n_neighbours += has_neighbour
        n_against += has_neighbour & off
    far[rows] = (n_neighbours > 0) & (n_against == n_neighbours)
    return far


def _unknown_samples_and_pieces(states: States, jump: Mask) -> tuple[Mask, NDArray[np.int32]]:
    """Return the mask of samples that are unknown because of jumps, and for each sample the number of its piece of the track."""
    n = len(states)
    unknown, pieces = np.zeros(n, np.bool_), np.zeros(n, np.int32)
    unknown[:-1] |= jump
    unknown[1:] |= jump
    for actor in np.unique(states.actor[:-1][jump]):
        span = slice(*np.searchsorted(states.actor, [actor, actor + 1]))
        cuts = np.flatnonzero(jump[span.start : span.stop - 1]) + span.start + 1
        bounds = [span.start, *cuts.tolist(), span.stop]
        number, last = 0, None
        for first, end in pairwise(bounds):
            if (states.t_ns[end - 1] - states.t_ns[first]) * 1e-9 < LONGEST_OUTLIER_PIECE_S and len(bounds) > 2:
                unknown[first:end] = True
                pieces[first:end] = number
                continue
            if last is not None and not _can_be_one_track(states, last, first):
                number += 1
            pieces[first:end] = number
            last = end - 1
    return unknown, pieces


def _can_be_one_track(states: States, last: int, first: int) -> bool:
    """Return whether the piece that ends at row `last` and the piece that starts at row `first` can be one track.

    They can if an actor at these velocities can cover the distance, or if the position was only corrected, as map matching and filters
    do, and the velocity is nearly unchanged.
    """
    place, t_s = states.place, states.t_ns * 1e-9
    gap = t_s[first] - t_s[last]
    if gap > 2 * LONGEST_OUTLIER_PIECE_S:
        return False
    before, after = ((place[:, i] - place[:, i - 1]) / (t_s[i] - t_s[i - 1]) for i in (last, first + 1))
    way = place[:, first] - place[:, last]
    fastest = np.nan_to_num(np.hypot(*np.transpose([before, after]))).max()
    if np.hypot(*way) <= LEAST_JUMP_M + fastest * gap + JUMP_ACCELERATION_MPS2 * gap**2 / 2:
        return True
    speed = float(np.hypot(*before))
    if (
        not speed > LEAST_SPEED_WITH_MOTION_DIRECTION_MPS
        or not np.hypot(*(after - before)) <= JUMP_ACCELERATION_MPS2 * gap + LARGEST_VELOCITY_CHANGE_AT_CORRECTION_MPS
    ):
        return False
    ahead, left = before / speed @ way - speed * gap, (before[0] * way[1] - before[1] * way[0]) / speed
    return bool(abs(ahead) <= LARGEST_CORRECTION_ALONG_MOTION_M and abs(left) <= LARGEST_SIDE_CORRECTION_M)


def _give_ids_to_pieces_and_return_old_ids(
    states: States, pieces: NDArray[np.int32], kept_ids: Collection[str], findings: list[QualityFinding]
) -> dict[str, str]:
    """Give each piece of a track but the first an id of its own, in place; return new id -> old id."""
    alias: dict[str, str] = {}
    if not pieces.any():
        return alias
    whole_tracks = {i for i, name in enumerate(states.ids) if name in kept_ids}
    keys = np.where(np.isin(states.actor, list(whole_tracks)), 0, pieces)
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
            "the track continues at another place after a jump: from there on it counts as another actor "
            f"({name_list(sorted(alias))})"
        )
        findings.append(QualityFinding("track_parted", "warning", message, len(alias), actor_id=None))
    states.ids, states.actor = ids, actor
    return alias


def cut_tracks_of_destroyed_actors(
    states: States, step: Steps, *, kept_ids: Collection[str]
) -> tuple[States, list[QualityFinding]]:
    """Leave out the states of actors that jump to a common position and stand there until their tracks end (states in order).

    An actor that stands at its position alone is kept. `kept_ids`: actors that are kept anyway (the named egos).
    """
    if len(states) < 3 or not {"x_m", "y_m"} <= states.numbers.keys():
        return states, []
    jump = np.flatnonzero(jump_steps(states, step))
    place = states.place
    # actor -> the row after its last jump
    last = {int(states.actor[row]): int(row) + 1 for row in jump if states.ids[states.actor[row]] not in kept_ids}
    parked = []
    for actor, first in last.items():
        end = int(np.searchsorted(states.actor, actor, side="right"))
        spread = np.ptp(place[:, first:end], axis=1).max()
        if spread <= SAME_POSITION_TOLERANCE_M and end - first > 1:
            parked.append((first, end))
    tracks = [a for a in parked if any(b != a and _stand_together(states, place, a, b) for b in parked)]
    if not tracks:
        return states, []
    out = np.zeros(len(states), np.bool_)
    for first, end in tracks:
        out[first:end] = True
    text = "after a jump, several actors stand at the same position: they count as removed from the scene, and their tracks end at the jump"
    return states.take(~out), states.findings(out, "removed", "warning", COUNT_OF_STATES_PREFIX + text)


def _stand_together(
    states: States, place: Floats, first_stretch: tuple[int, int], second_stretch: tuple[int, int]
) -> bool:
    """Return whether two stretches at a standstill (first row, end row) are at the same position and overlap in time."""
    (a, a_end), (b, b_end) = first_stretch, second_stretch
    apart = np.hypot(*(place[:, a] - place[:, b]))
    return bool(
        apart <= SAME_POSITION_TOLERANCE_M
        and states.t_ns[a] <= states.t_ns[b_end - 1]
        and states.t_ns[b] <= states.t_ns[a_end - 1]
    )
