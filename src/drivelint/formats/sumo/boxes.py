"""Classes, sizes and box centres of SUMO's road users: a position is the middle of the front bumper, the centre half a length behind it.

A track has only one reference point. Without a length, the box centre is not known. An actor without a length in the whole log is placed
at its bumper, and a finding reports it. An actor whose length is missing or different in a part of the log has no place there.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from drivelint.drive.ego import ALL_EGOS
from drivelint.drive.trace import ACTOR_CLASSES, MOTOR_VEHICLES, QualityFinding
from drivelint.formats.sumo.rows import CONTAINER, PERSON
from drivelint.formats.sumo.vehicle_types import type_and_original
from drivelint.phrases import name_list

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from drivelint.arrays import Codes, Floats, Mask
    from drivelint.drive.trace import IngestOptions
    from drivelint.formats.sumo.vehicle_types import VehicleType


class RowActors(NamedTuple):
    """The actor, type and kind of each row (n): `actor` indexes `ids`, `type_code` indexes `type_names`, `kind` as in `rows`."""

    ids: list[str]
    actor: NDArray[np.int32]
    type_names: list[str]
    type_code: NDArray[np.int32]
    kind: Codes


class Boxes(NamedTuple):
    """For each row (n): class (index of `ACTOR_CLASSES`, -1: not known), size in metres (NaN: not known), and how far ahead of the box
    centre the recorded point is, in metres (NaN: not known)."""

    actor_class: Codes
    length_m: Floats
    width_m: Floats
    bumper_ahead_m: Floats
    findings: list[QualityFinding]


def boxes_of(row_actors: RowActors, types: Mapping[str, VehicleType], options: IngestOptions) -> Boxes:
    """Return the boxes, from the known `types` and the user's size of the ego."""
    types_with_originals = [type_and_original(name, types, frozenset(row_actors.ids)) for name in row_actors.type_names]
    vehicle_types = [kind for kind, _ in types_with_originals]
    classes = np.array(
        [-1 if t.actor_class is None else ACTOR_CLASSES.index(t.actor_class) for t in vehicle_types], np.int8
    )
    actor_class = classes[row_actors.type_code]
    for kind, word in ((PERSON, "pedestrian"), (CONTAINER, "object")):
        actor_class[row_actors.kind == kind] = ACTOR_CLASSES.index(word)
    length, width = (
        np.array([getattr(t, side) for t in vehicle_types], np.float64)[row_actors.type_code]
        for side in ("length_m", "width_m")
    )
    changing = _has_length_unlike_track(row_actors, length)
    length[changing] = width[changing] = np.nan
    sizeless = np.isnan(length) & ~changing
    ahead = np.where(changing, np.nan, np.nan_to_num(length) / 2)
    if options.ego_size is not None:
        ahead[sizeless & _is_ego(row_actors, actor_class, options.ego)] = options.ego_size.length_m / 2
    findings = _size_findings(row_actors, changing, sizeless)
    original_by_copy = {
        name: base
        for name, (_, base) in zip(row_actors.type_names, types_with_originals, strict=True)
        if base is not None
    }
    if original_by_copy:
        findings.append(_copied_types_finding(row_actors, original_by_copy))
    return Boxes(actor_class, length, width, ahead, findings)


def _has_length_unlike_track(row_actors: RowActors, length: Floats) -> Mask:
    """Return which rows have no length, or another length than most rows of their track, if any row of the track has a length."""
    some = np.zeros(len(row_actors.ids), row_actors.type_code.dtype)
    some[row_actors.actor] = row_actors.type_code
    if (some[row_actors.actor] == row_actors.type_code).all():
        return np.zeros(len(length), np.bool_)
    n_types = len(row_actors.type_names)
    pairs, row, count = np.unique(
        row_actors.actor.astype(np.int64) * n_types + row_actors.type_code, return_inverse=True, return_counts=True
    )
    differs = np.zeros(len(pairs), np.bool_)
    lengths = np.full(len(pairs), np.nan)
    lengths[row] = length
    actors = pairs // n_types
    for actor in np.unique(actors[1:][actors[1:] == actors[:-1]]):
        of_actor = np.flatnonzero(actors == actor)
        track_lengths, at = np.unique(lengths[of_actor][np.isfinite(lengths[of_actor])], return_inverse=True)
        if len(track_lengths):
            usual_length = track_lengths[np.argmax(np.bincount(at, count[of_actor][np.isfinite(lengths[of_actor])]))]
            differs[of_actor] = lengths[of_actor] != usual_length
    is_unlike: Mask = differs[row]
    return is_unlike


def _is_ego(row_actors: RowActors, actor_class: Codes, ego: str | None) -> Mask:
    if ego == ALL_EGOS and ego not in row_actors.ids:
        return np.isin(actor_class, [ACTOR_CLASSES.index(word) for word in MOTOR_VEHICLES])
    of_ego: Mask = row_actors.actor == (row_actors.ids.index(ego) if ego in row_actors.ids else -1)
    return of_ego


def _size_findings(row_actors: RowActors, changing: Mask, sizeless: Mask) -> list[QualityFinding]:
    findings = []
    if sizeless.any():
        message = (
            f"the sizes of the vehicle types {_type_names_text(row_actors, sizeless)} are not known: give the route file "
            "with their vType elements with --mapping; until then their positions are those of the front bumper"
        )
        findings.append(QualityFinding("bumper_position", "warning", message, int(sizeless.sum())))
    if changing.any():
        ids = [row_actors.ids[i] for i in np.unique(row_actors.actor[changing])]
        message = (
            f"the type of {name_list(ids)} changes to {_type_names_text(row_actors, changing)}, whose length is different or not known: "
            "the log has their front bumper, so the place of their box is then not known"
        )
        findings.append(QualityFinding("size_changes", "warning", message, int(changing.sum())))
    return findings


def _type_names_text(row_actors: RowActors, rows: Mask) -> str:
    names = {row_actors.type_names[i] for i in np.unique(row_actors.type_code[rows])}
    return name_list(sorted(name or "without a name" for name in names))


def _copied_types_finding(row_actors: RowActors, original_by_copy: Mapping[str, str]) -> QualityFinding:
    rows = np.isin(
        row_actors.type_code, [i for i, name in enumerate(row_actors.type_names) if name in original_by_copy]
    )
    ids = [row_actors.ids[i] for i in np.unique(row_actors.actor[rows])]
    message = f"types that were changed for one vehicle have the size of the original type: {name_list(sorted(original_by_copy))}"
    return QualityFinding.of_actors("copied_type", "info", message, ids)
