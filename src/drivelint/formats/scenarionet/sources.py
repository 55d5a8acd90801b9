"""Finds values of motion that are not measured, by the numbers themselves wherever possible, and corrects or drops them.

Velocities that are differences of successive positions are half a step too early or too late, and one of them is 0 at an end of the track.
Boxes that were annotated only at keyframes and interpolated between have no acceleration. A box whose length and width are exchanged moves
along its short side.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from drivelint.drive.trace import ACTOR_CLASSES, MOTOR_VEHICLES, QualityFinding
from drivelint.phrases import name_list

if TYPE_CHECKING:
    from drivelint.arrays import Floats, Mask
    from drivelint.formats.scenarionet.scenario import DatasetFacts
    from drivelint.formats.scenarionet.tracks import Tracks

_LONG_CLASSES: Final = frozenset(ACTOR_CLASSES.index(word) for word in (*MOTOR_VEHICLES, "trailer", "bicycle"))
_LEAST_MOVING_SPEED_MPS: Final = 1.0
_LEAST_DISTINCT_VELOCITY_DIFFERENCE_MPS: Final = 0.05
_SAME_VELOCITY_TOLERANCE_MPS: Final = 0.02
_SAME_VELOCITY_REL_TOLERANCE: Final = 0.01
"""A velocity equals a difference of positions if both differ by less than `_SAME_VELOCITY_TOLERANCE_MPS` plus this share. (Rounded times
change it by under 0.1 %.)"""
_LEAST_SHARE_OF_SAME_VELOCITIES: Final = 0.9
_LEAST_COMPARED_VELOCITIES: Final = 10
_INTERPOLATED_STEP_TOLERANCE_M: Final = 1e-4
_LEAST_WIDTH_TO_LENGTH: Final = 1.2
"""A box that is wider than long by this factor is not an inaccurate estimate of a square box."""
_LEAST_MOTION_M: Final = 2.0
_LEAST_COSINE_OF_MOTION_TO_HEADING: Final = np.cos(np.radians(30.0))


def drop_velocities_from_position_differences(tracks: Tracks) -> list[QualityFinding]:
    """Set velocities that are differences of the positions to NaN, in place: those of the ego, and those of all other actors.

    `finish_trace` derives better velocities, which are those at the step itself.
    """
    is_ego = np.arange(len(tracks.ids)) == tracks.ego
    findings = []
    for actors, owner in ((is_ego, "the ego"), (~is_ego, "the others")):
        if (when := _early_or_late_if_velocities_are_position_differences(tracks, actors)) is None:
            continue
        n = int((actors[:, None] & np.isfinite(tracks.velocity[..., 0])).sum())
        tracks.velocity[actors] = np.nan
        message = (
            f"velocities of {owner} are differences of the positions, half a step {when} and 0 or repeated at an end of the track: "
            "they are derived again"
        )
        findings.append(QualityFinding("velocity_dropped", "warning", message, n))
    return findings


def _early_or_late_if_velocities_are_position_differences(tracks: Tracks, actors: Mask) -> str | None:
    """Return early or late if the velocities of these actors are differences of the positions; None if they are not.

    This shows only where an actor accelerates, brakes or turns, so that the displacements before and after differ.
    """
    steps = tracks.displacements_m[actors] / np.diff(tracks.t_s)[:, None]
    before, after, velocity = steps[:, :-1], steps[:, 1:], tracks.velocity[actors][:, 1:-1]
    tells = np.hypot(*np.moveaxis(after - before, 2, 0)) > 2.0 * _LEAST_DISTINCT_VELOCITY_DIFFERENCE_MPS
    if tells.sum() < _LEAST_COMPARED_VELOCITIES:
        return None
    for when, step in (("early", after), ("late", before)):
        off = np.hypot(*np.moveaxis(velocity - step, 2, 0))
        same = off < _SAME_VELOCITY_TOLERANCE_MPS + _SAME_VELOCITY_REL_TOLERANCE * np.hypot(*np.moveaxis(step, 2, 0))
        if same[tells].mean() > _LEAST_SHARE_OF_SAME_VELOCITIES:
            return when
    return None


def drop_false_zero_last_velocities(tracks: Tracks) -> list[QualityFinding]:
    """Set the last velocity of a track to NaN, in place, if it is 0 although the actor moves."""
    ends = tracks.present.copy()
    ends[:, :-1] &= ~tracks.present[:, 1:]
    speed = np.zeros(ends.shape)
    speed[:, 1:] = np.nan_to_num(np.hypot(*np.moveaxis(tracks.displacements_m, 2, 0)) / np.diff(tracks.t_s))
    false = ends & (tracks.velocity == 0.0).all(axis=2) & (speed > _LEAST_MOVING_SPEED_MPS)
    if not false.any():
        return []
    tracks.velocity[false] = np.nan
    ids = [tracks.ids[i] for i in np.flatnonzero(false.any(axis=1))]
    message = f"the last velocity of {name_list(ids)} is 0 although the positions move: it is unknown"
    return [QualityFinding.of_actors("velocity_unknown", "warning", message, ids)]


def actors_with_interpolated_positions(tracks: Tracks, dataset: DatasetFacts) -> Mask:
    """Return for each actor (n,) whether its positions are interpolated between keyframes, that is, lie evenly on straight lines."""
    every = dataset.steps_per_keyframe
    if not every or len(tracks.t_s) < every + 1:
        return np.zeros(len(tracks.ids), np.bool_)
    off = np.abs(np.diff(tracks.displacements_m, axis=1)).max(axis=2)  # (n, T - 2), at the steps 1 ... T - 2
    between = np.arange(1, len(tracks.t_s) - 1) % every != 0
    even: Mask = ~(np.nan_to_num(off[:, between]) > _INTERPOLATED_STEP_TOLERANCE_M).any(axis=1)
    return even


def set_velocities_from_keyframes(tracks: Tracks, actors: Mask, steps_per_keyframe: int) -> list[QualityFinding]:
    """Give these actors the velocities of their keyframes, in place, and report that their accelerations are not known.

    The velocity at a keyframe is the mean from the keyframe before to the keyframe after, as in nuScenes' own `box_velocity`. Between two
    keyframes, it changes linearly.
    """
    key = np.arange(0, len(tracks.t_s), steps_per_keyframe)
    place, t_s = tracks.place[actors][:, key, :2], tracks.t_s[key]
    velocity = np.full(place.shape, np.nan)
    slope = np.diff(place, axis=1) / np.diff(t_s)[:, None]
    velocity[:, :-1] = slope
    velocity[:, 1:] = np.where(np.isfinite(velocity[:, 1:]), velocity[:, 1:], slope)
    velocity[:, 1:-1] = np.where(
        np.isfinite(slope[:, 1:] + slope[:, :-1]),
        (place[:, 2:] - place[:, :-2]) / (t_s[2:] - t_s[:-2])[:, None],
        velocity[:, 1:-1],
    )
    step = np.arange(len(tracks.t_s))
    before = np.minimum(step // steps_per_keyframe, len(key) - 1)
    after = np.minimum(before + 1, len(key) - 1)
    share = ((step % steps_per_keyframe) / steps_per_keyframe)[:, None]
    between = np.where(
        share > 0.0, velocity[:, before] * (1.0 - share) + velocity[:, after] * share, velocity[:, before]
    )
    between[~tracks.present[actors]] = np.nan
    tracks.velocity[actors] = between
    moving_ids = [tracks.ids[i] for i in np.flatnonzero(actors & (_track_extents_m(tracks) > _LEAST_MOTION_M))]
    if not moving_ids:
        return []
    period_s = float(np.median(np.diff(t_s)))
    text = (
        f"the positions of {{}} are known every {period_s:g} s and interpolated between: velocities are means over {2 * period_s:g} s, "
        "accelerations are not known"
    )
    # the finding velocity_filtered of an actor states that its acceleration is not known
    return [
        QualityFinding.of_actors("interpolated", "warning", text.format(name_list(moving_ids)), moving_ids),
        *(QualityFinding("velocity_filtered", "info", text.format(name), actor_id=name) for name in moving_ids),
    ]


def _track_extents_m(tracks: Tracks) -> Floats:
    """Return the extent in metres of each actor's places (n,), along x or y, whichever is larger."""
    place = np.where(tracks.present[..., None], tracks.place[..., :2], np.nan)
    with np.errstate(invalid="ignore"):
        spread = np.fmax.reduce(place, axis=1) - np.fmin.reduce(place, axis=1)
    return np.asarray(np.nan_to_num(spread).max(axis=1), np.float64)


def correct_swapped_length_and_width(tracks: Tracks, dataset: DatasetFacts) -> list[QualityFinding]:
    """Exchange length and width, in place, of vehicles that move along their short side.

    The ego's are also exchanged if the data set is known to exchange them. Without such evidence, length and width become NaN.
    """
    long_kind = np.isin(tracks.class_codes, list(_LONG_CLASSES))
    n = np.maximum(tracks.present.sum(axis=1), 1)
    length, width = (np.nansum(tracks.size[..., k], axis=1) / n for k in (0, 1))
    ids_by_reason: dict[str, list[str]] = {}
    for i in np.flatnonzero(long_kind & (width > _LEAST_WIDTH_TO_LENGTH * length)):
        if _moves_along_heading(tracks, int(i)):
            why = "length and width of {} are swapped in the log, as its motion along the short side shows: this is corrected"
        elif i == tracks.ego and np.allclose((width[i], length[i]), dataset.ego_box_m or (0.0, 0.0), atol=0.01):
            why = "length and width of {} are swapped in the log, as always in this data set: this is corrected"
        else:
            why = "wider than long, and no motion shows which side is the length: {}: the size is unknown"
        tracks.size[i, :, :2] = np.nan if why.endswith("unknown") else tracks.size[i, :, 1::-1]
        ids_by_reason.setdefault(why, []).append(tracks.ids[i])
    return [
        QualityFinding.of_actors("box_turned", "warning", why.format(name_list(ids)), ids)
        for why, ids in ids_by_reason.items()
    ]


def _moves_along_heading(tracks: Tracks, i: int) -> bool:
    """Return whether an actor moves along its heading, forwards or backwards."""
    steps = tracks.displacements_m[i]
    heading = tracks.heading[i, :-1]
    way = np.hypot(*steps.T)
    along = np.abs(steps[:, 0] * np.cos(heading) + steps[:, 1] * np.sin(heading))
    return bool(
        np.nansum(way) > _LEAST_MOTION_M and np.nansum(along) > _LEAST_COSINE_OF_MOTION_TO_HEADING * np.nansum(way)
    )
