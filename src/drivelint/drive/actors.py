"""Collects the class and box of each actor, from its states or from the log's own actor table."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from drivelint.arrays import wrap_angles
from drivelint.drive.order import track_starts
from drivelint.drive.trace import ACTOR_CLASSES, SIZE_COLUMNS, Doubt, QualityFinding
from drivelint.phrases import name_list

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pyarrow as pa

    from drivelint.arrays import Floats, Mask
    from drivelint.drive.trace import States

ELONGATED_CLASSES: Final = frozenset({"car", "van", "truck", "bus", "vehicle", "trailer"})
"""Classes whose boxes are longer than wide. Two-wheelers are not among them: the box may be that of the rider's body alone."""
SLIM_CLASSES: Final = frozenset({"bicycle", "motorcycle", "animal"})
MOST_SLIM_WIDTH_M: Final = 1.2
"""A two-wheeler or a horse that is wider than this, and wider than long, is not the box of a rider's body: its sides are exchanged. A body
of unknown class that moves may also be a car of which the detector saw the rear alone: its sizes are unknown."""
MOST_WIDTH_PER_LENGTH: Final = 1.1
"""A detector may make the box of a small car a little wider than long; a box wider by more than a tenth is turned or wrong."""
LEAST_SPEED_WITH_DIRECTION_MPS: Final = 2.0
"""Above this speed, the velocity of a box shows its direction of motion."""
LEAST_SPEED_OF_DOUBT_MPS: Final = 1.0
"""Above this speed, a body of unknown class shows its direction of motion well enough to doubt its box."""
LEAST_MOVING_SAMPLES: Final = 5
MOST_ANGLE_ALONG_HEADING_RAD: Final = np.deg2rad(30.0)
"""A box moves along its heading if, in most of its moving samples, the angle between the two is smaller than this."""
LEAST_LENGTH_AND_WIDTH_M: Final = {
    "car": (1.5, 0.8),
    "van": (2.0, 1.0),
    "truck": (2.5, 1.2),
    "bus": (4.0, 1.5),
    "motorcycle": (1.0, 0.2),
    "bicycle": (0.5, 0.1),
    "vehicle": (0.8, 0.3),
}
"""Class -> the least length and width (m) of such a vehicle: those of the smallest models, minus a detector's error of decimetres. There
is no upper limit per class: a lorry that is recorded as a car has the right size."""
MOST_LENGTH_AND_WIDTH_M: Final = (60.0, 8.0)
"""Length and width (m) that no road user exceeds."""
LEAST_SHARE_OF_CLASS: Final = 0.9
"""If a log changes its mind about the class of an actor, the class is known that at least this share of its samples has."""
NO_VEHICLES: Final = frozenset({"pedestrian", "animal", "object"})
LARGEST_SIZE_SPREAD_M = 0.05
"""If the sizes of a track differ by more than this, they are estimates, and a finding reports it."""


@dataclass
class Actors:
    """Actors sorted by id: class (None: unknown) and sizes in metres (NaN: unknown)."""

    ids: list[str]
    classes: list[str | None]
    sizes: dict[str, Floats]


def from_states(states: States) -> tuple[Actors, list[QualityFinding]]:
    """Return each actor's class (see `_classes`) and sizes (the median of the known ones), and findings. `states` in order."""
    starts = track_starts(states.actor)
    classes, findings = _classes(states)
    sizes, varying = {}, set()
    for name in SIZE_COLUMNS:
        values = states.numbers.get(name)
        if values is None or not len(states):
            sizes[name] = np.full(len(states.ids), np.nan)
            continue
        positive = np.where(values > 0.0, values, np.nan)  # size 0 means that the size was not written
        low, high = np.fmin.reduceat(positive, starts), np.fmax.reduceat(positive, starts)
        ends = np.r_[starts[1:], len(states)]
        for i in np.flatnonzero(high - low > 0.0):
            track = np.sort(positive[starts[i] : ends[i]])
            track = track[~np.isnan(track)]
            if high[i] - low[i] > LARGEST_SIZE_SPREAD_M:
                varying.add(states.ids[i])
            low[i] = track[(len(track) - 1) // 2]
        sizes[name] = low
    if varying:
        ids = sorted(varying)
        message = f"box size changes over the log ({name_list(ids)}): the median is used throughout"
        findings.append(QualityFinding.of_actors("size_varies", "warning", message, ids))
    return Actors(states.ids, classes, sizes), findings


def _classes(states: States) -> tuple[list[str | None], list[QualityFinding]]:
    """Return each actor's class, and a finding for the actors whose class changes.

    Such an actor has the class of nearly all its samples; without one, it is a vehicle of unknown kind or of unknown class (None).
    """
    classes: list[str | None] = [None] * len(states.ids)
    codes = states.codes.get("actor_class")
    if codes is None or not len(states):
        return classes, []
    with_class = np.flatnonzero(codes >= 0)
    actor, code = states.actor[with_class], codes[with_class]
    first = np.full(len(states.ids), -1)
    actors, rows = np.unique(actor, return_index=True)
    first[actors] = code[rows]
    for number in actors:
        classes[number] = ACTOR_CLASSES[first[number]]
    changing = np.unique(actor[code != first[actor]])
    for number in changing:
        counts = np.bincount(code[actor == number], minlength=len(ACTOR_CLASSES))
        commonest = int(counts.argmax())
        if counts[commonest] >= LEAST_SHARE_OF_CLASS * counts.sum():
            classes[number] = ACTOR_CLASSES[commonest]
        else:
            words = {ACTOR_CLASSES[i] for i in np.flatnonzero(counts)}
            classes[number] = None if words & NO_VEHICLES else "vehicle"
    if not len(changing):
        return classes, []
    ids = [states.ids[number] for number in changing]
    message = (
        f"the class changes over the log ({name_list(ids)}): if no class has nine tenths of the samples, it is unknown"
    )
    return classes, [QualityFinding.of_actors("class_varies", "warning", message, ids)]


def from_table(table: pa.Table, states: States, old_id_by_id: Mapping[str, str]) -> Actors:
    """Return the actors of the log's own table (first row of each id), and those that only have states, with unknown class and size.

    `old_id_by_id`: new id of a split track -> the id whose row in the table describes it (see `jumps`).
    """
    rows = {str(row["actor_id"]): row for row in reversed(table.to_pylist()) if row["actor_id"] not in {None, ""}}
    rows |= {new: rows[old] for new, old in old_id_by_id.items() if old in rows}
    ids = sorted({*rows, *states.ids})
    no_row: dict[str, object] = {}
    classes = [str(value) if (value := rows.get(i, no_row).get("actor_class")) else None for i in ids]
    sizes = {}
    for name in SIZE_COLUMNS:
        raw = np.array([np.nan if (value := rows.get(i, no_row).get(name)) is None else value for i in ids], np.float64)
        sizes[name] = np.where(np.isfinite(raw) & (raw > 0.0), raw, np.nan)
    return Actors(ids, classes, sizes)


def correct_sizes(states: States, actors: Actors) -> list[QualityFinding]:
    """Swap or drop the sizes of boxes that are wider than long, in place; return findings on these and on impossible sizes.

    `states` in order.
    """
    length, width = actors.sizes["length_m"], actors.sizes["width_m"]
    long_kind = np.array([kind in ELONGATED_CLASSES for kind in actors.classes], np.bool_)
    slim_kind = np.array([kind in SLIM_CLASSES for kind in actors.classes], np.bool_)
    unnamed = np.array([kind is None or kind == "object" for kind in actors.classes], np.bool_)
    too_wide = (long_kind | (slim_kind | unnamed) & (width > MOST_SLIM_WIDTH_M)) & (
        width > MOST_WIDTH_PER_LENGTH * length
    )
    turned, dropped_sizes = too_wide.copy(), too_wide.copy()
    if too_wide.any():
        along = np.isin(actors.ids, _actors_moving_along_heading(states, LEAST_SPEED_WITH_DIRECTION_MPS))
        # A body of unknown class that does not move along its heading may be a barrier.
        in_doubt = np.isin(actors.ids, _actors_moving_along_heading(states, LEAST_SPEED_OF_DOUBT_MPS))
        turned &= along & ~unnamed
        dropped_sizes &= np.where(unnamed, in_doubt, ~along)
    actors.sizes["length_m"] = np.where(turned, width, np.where(dropped_sizes, np.nan, length))
    actors.sizes["width_m"] = np.where(turned, length, np.where(dropped_sizes, np.nan, width))
    findings = []
    for check, rows, text in (
        ("size_turned", turned, "wider than long, and moving along the short side: {}: length and width are exchanged"),
        (
            "size_unknown",
            dropped_sizes,
            "wider than long, and it is not known which side is the front: {}: length and width are unknown",
        ),
    ):
        if ids := _actor_ids(actors, rows):
            findings.append(QualityFinding.of_actors(check, "warning", text.format(name_list(ids)), ids))
    return findings + _implausible_size_findings(states, actors)


def _actors_moving_along_heading(states: States, least_mps: float) -> list[str]:
    """Return the ids of the actors that move along their heading, forwards or backwards, at this speed or more."""
    vx, vy = states.velocity
    moving = np.isfinite(states.numbers["yaw_rad"]) & (np.hypot(vx, vy) > least_mps)
    off = np.abs(wrap_angles(2.0 * (states.numbers["yaw_rad"] - np.arctan2(vy, vx)))) / 2.0
    n, n_along = (
        np.bincount(states.actor[rows], minlength=len(states.ids))
        for rows in (moving, moving & (off < MOST_ANGLE_ALONG_HEADING_RAD))
    )
    return [states.ids[i] for i in np.flatnonzero((n >= LEAST_MOVING_SAMPLES) & (2 * n_along > n))]


def _implausible_size_findings(states: States, actors: Actors) -> list[QualityFinding]:
    bad = np.zeros(len(actors.ids), np.bool_)
    least = np.array([LEAST_LENGTH_AND_WIDTH_M.get(kind or "", (0.0, 0.0)) for kind in actors.classes])
    has_limits = np.array([kind in LEAST_LENGTH_AND_WIDTH_M for kind in actors.classes], np.bool_)
    for axis, name in enumerate(("length_m", "width_m")):
        bad |= has_limits & (
            (actors.sizes[name] < least[:, axis]) | (actors.sizes[name] > MOST_LENGTH_AND_WIDTH_M[axis])
        )
    ids = _actor_ids(actors, bad)
    if not ids:
        return []
    starts = track_starts(states.actor)
    ends = np.r_[starts[1:], len(states)] - 1
    message = (
        f"size that no {'vehicle' if len(ids) > 1 else actors.classes[actors.ids.index(ids[0])]} has: {name_list(ids)}"
    )
    doubts = tuple(
        Doubt(name, "size", int(states.t_ns[first]), int(states.t_ns[last]))
        for first, last in zip(starts, ends, strict=True)
        if (name := states.ids[states.actor[first]]) in ids
    )
    only = ids[0] if len(ids) == 1 else None
    return [QualityFinding("size_implausible", "warning", message, len(ids), actor_id=only, doubts=doubts)]


def _actor_ids(actors: Actors, rows: Mask) -> list[str]:
    return [actors.ids[i] for i in np.flatnonzero(rows)]
