"""The boxes of a 123D log (`box_detections_se3.arrow`): one row per frame, a list of boxes in each."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from drivelint.drive.trace import SIZE_COLUMNS, STATE_COLUMNS, QualityFinding, States
from drivelint.formats.coordinate_frames import Poses, unit_quaternions
from drivelint.formats.d123 import facts
from drivelint.formats.d123.arrow_files import BOXES, integers, is_null, list_lengths, read_modality, vectors
from drivelint.formats.riders import join_riders_and_return_merged_rows_and_rider_tracks
from drivelint.phrases import name_list

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.arrays import Codes, Indices, Mask, Times
    from drivelint.formats.d123.arrow_files import ModalityFile

_COLUMNS: Final = {
    "bounding_box_se3": pa.list_(pa.list_(pa.float64(), 10)),  # centre, quaternion w x y z, length, width, height
    "track_token": pa.list_(pa.string()),
    "label": pa.list_(pa.int32()),
    "velocity_3d": pa.list_(pa.list_(pa.float64(), 3)),
}
_LEAST_MOVE_M: Final = 0.5
DERIVED_VELOCITY_TOLERANCE_MPS: Final = 1e-6
"""A velocity this near to the mean velocity between the boxes before and after was computed from these boxes, not measured."""
_LEAST_BOXES_TO_DETECT_DERIVED_VELOCITIES: Final = 20
"""With fewer boxes that have a box one frame before and after, velocities count as measured."""
_LEAST_DERIVED_VELOCITY_SHARE: Final = 0.99
"""If at least this share of the velocities is equal to the mean velocity, all were computed from the boxes."""


def read_boxes(folder: Path) -> ModalityFile | None:
    """Return the file of boxes, or None if the log has none. Errors: as `read_modality`."""
    return read_modality(folder, BOXES, _COLUMNS)


def malformed_rows(boxes: ModalityFile) -> Mask:
    """Return which rows are malformed: their lists differ in length, or a box has no track."""
    counts = [list_lengths(boxes.columns[name]) for name in _COLUMNS]
    bad = np.any([n != counts[0] for n in counts[1:]], axis=0) | (counts[0] < 0)
    tokens = boxes.columns["track_token"]
    nameless = pc.fill_null(pc.equal(tokens.flatten(), ""), True)
    if pc.any(nameless).as_py():
        parents = integers(pc.list_parent_indices(tokens))
        bad[parents[np.asarray(nameless.to_numpy(zero_copy_only=False), np.bool_)]] = True
    return np.asarray(bad, np.bool_)


def box_states(
    boxes: ModalityFile, rows: Indices, t_ns: Times, about: facts.DatasetFacts
) -> tuple[States, list[QualityFinding], list[str]]:
    """Return the boxes of these rows (none malformed) as states, with findings and notes. `t_ns`: the times of the rows (rows,)."""
    columns = {name: _lists_of_rows(boxes.columns[name], rows) for name in _COLUMNS}
    frame = np.repeat(np.arange(len(rows)), list_lengths(columns["track_token"]))
    flat = {name: lists.flatten() for name, lists in columns.items()}
    labels, findings, is_ego = _class_codes_and_is_ego(boxes, integers(flat["label"]))
    notes = []
    if is_ego.any():
        notes.append(
            f"{int(is_ego.sum())} boxes with the label {facts.EGO_LABEL} are left out: the ego has its own file of states"
        )
        keep = np.flatnonzero(~is_ego)
        flat, frame, labels = {name: values.take(keep) for name, values in flat.items()}, frame[keep], labels[keep]
    tracks = flat["track_token"].dictionary_encode()
    box, velocity = vectors(flat["bounding_box_se3"]), vectors(flat["velocity_3d"])
    has_velocity = ~is_null(flat["velocity_3d"])
    odd = ~np.isfinite(box).all(axis=1) | (has_velocity & ~np.isfinite(velocity).all(axis=1))
    if odd.any():
        box, velocity = (np.where(np.isfinite(values), values, np.nan) for values in (box, velocity))
    turn = unit_quaternions(box[:, [4, 5, 6, 3]])
    numbers = {name: box[:, k].copy() for k, name in enumerate(STATE_COLUMNS[:3])}
    numbers["yaw_rad"] = Poses(box[:, :3], turn).yaw
    numbers |= {"vx_mps": velocity[:, 0].copy(), "vy_mps": velocity[:, 1].copy()}
    numbers |= {name: np.where(box[:, 7 + k] > 0.0, box[:, 7 + k], np.nan) for k, name in enumerate(SIZE_COLUMNS)}
    riders, ridden = (
        np.isin(integers(flat["label"]), numbers_of)
        for numbers_of in facts.rider_and_ridden_label_numbers(_label_enumeration(boxes))
    )
    inside, on_something = join_riders_and_return_merged_rows_and_rider_tracks(
        t_ns[frame], integers(tracks.indices).astype(np.int32), riders, ridden, numbers
    )
    states = States(
        [str(token) for token in tracks.dictionary.to_pylist()],
        integers(tracks.indices).astype(np.int32),
        t_ns[frame],
        numbers,
        {"actor_class": labels},
        np.asarray(odd, np.bool_),
    )
    if on_something:
        rider_names = name_list([states.ids[i] for i in on_something])
        notes.append(f"each rider and the vehicle count as one road user, with a box around both: {rider_names}")
    if not about.box_velocities_global:
        _set_velocities_to_nan(states, np.ones(len(states), np.bool_))
        notes.append("velocities of boxes are not read: in this data set, 123D states them along the axes of the boxes")
    else:
        findings += _drop_unmeasured_velocities(states, frame)
    return (states.take(~inside) if inside.any() else states), findings, notes


def _label_enumeration(boxes: ModalityFile) -> str:
    """Return the enumeration of py123d to which the label numbers belong; '' if it is not known."""
    module, _, name = str(boxes.metadata.get("box_detection_label_class", "")).rpartition(".")
    return name if not module or module.startswith("py123d.") else ""


def _lists_of_rows(lists: pa.ListArray, rows: Indices) -> pa.ListArray:
    """Return the lists of these rows, without a copy if these are all rows in order."""
    if len(rows) == len(lists) and np.array_equal(rows, np.arange(len(lists))):
        return lists
    return lists.take(pa.array(rows))


def _class_codes_and_is_ego(boxes: ModalityFile, label_numbers: Any) -> tuple[Codes, list[QualityFinding], Mask]:
    """Return the class of each box, -1: not known; findings; and which boxes are the ego's own."""
    qualified = str(boxes.metadata.get("box_detection_label_class", ""))
    enumeration = _label_enumeration(boxes)
    codes, none_own = facts.class_code_by_label(enumeration), np.zeros(len(label_numbers), np.bool_)
    if codes is None:
        message = (
            f"the classes of {len(label_numbers)} boxes are not known: their labels are numbers of "
            f"{qualified or 'an enumeration without a name'}"
        )
        finding = (
            [QualityFinding("unknown_label", "warning", message, len(label_numbers))] if len(label_numbers) else []
        )
        return np.full(len(label_numbers), -1, np.int8), finding, none_own
    inside = (label_numbers >= 0) & (label_numbers < len(codes))
    class_codes = np.where(inside, codes[np.where(inside, label_numbers, 0)], -2).astype(np.int8)
    unknown = class_codes == -2
    findings = []
    if unknown.any():
        numbers_text = name_list([str(n) if n >= 0 else "NULL" for n in np.unique(label_numbers[unknown]).tolist()])
        message = (
            f"labels that {enumeration} does not define ({numbers_text}) at {int(unknown.sum())} boxes: "
            "the classes of these are not known"
        )
        findings.append(QualityFinding("unknown_label", "warning", message, int(unknown.sum())))
    ego_number = facts.LABELS_BY_ENUMERATION[enumeration].get(facts.EGO_LABEL, (-1, ""))[0]
    is_ego = (label_numbers == ego_number) & inside
    return np.maximum(class_codes, -1).astype(np.int8), findings, np.asarray(is_ego, np.bool_)


def _drop_unmeasured_velocities(states: States, frame: Indices) -> list[QualityFinding]:
    """Set velocities that were not measured to NaN, in place, and return findings on them.

    Converters write zero for "no velocity", in a whole log or for a track with a single box, and may compute velocities from the boxes
    before and after. The states are in the order of the frames.
    """
    v = states.velocity
    zero = (v == 0.0).all(axis=0)
    counts = np.bincount(states.actor, minlength=len(states.ids))
    alone = zero & (counts[states.actor] == 1)
    _set_velocities_to_nan(states, alone)
    has_velocity = ~np.isnan(v).any(axis=0) & ~alone
    if not has_velocity.any():
        return []
    if zero[has_velocity].all():
        if not _any_actor_moves(states):
            return []  # every recorded actor stands: zero is correct
        why = "velocity (0, 0, 0) of all {n} boxes, although they move: treated as not recorded"
    elif _has_derived_velocities(states, frame, has_velocity):
        why = (
            "velocities of {n} boxes were computed by the converter from the boxes before and after: they are not read"
        )
    else:
        return []
    findings = states.findings(has_velocity, "velocity_not_recorded", "info", why)
    _set_velocities_to_nan(states, has_velocity)
    return findings


def _set_velocities_to_nan(states: States, rows: Mask) -> None:
    for name in ("vx_mps", "vy_mps"):
        states.numbers[name] = np.where(rows, np.nan, states.numbers[name])


def _any_actor_moves(states: States) -> bool:
    """Return whether any actor moves by more than `_LEAST_MOVE_M` in x or y."""
    n = len(states.ids)
    for values in states.place:
        low, high = np.full(n, np.inf), np.full(n, -np.inf)
        np.fmin.at(low, states.actor, values)
        np.fmax.at(high, states.actor, values)
        if (high - low > _LEAST_MOVE_M).any():
            return True
    return False


def _has_derived_velocities(states: States, frame: Indices, has_velocity: Mask) -> bool:
    """Return whether nearly all velocities are the mean velocity from the box one frame before to the box one frame after."""
    order = np.lexsort((frame, states.actor))
    actor, at = states.actor[order], frame[order]
    in_row = (actor[:-2] == actor[2:]) & (at[2:] - at[1:-1] == 1) & (at[1:-1] - at[:-2] == 1)
    middle = np.flatnonzero(in_row & has_velocity[order[1:-1]]) + 1
    if len(middle) < _LEAST_BOXES_TO_DETECT_DERIVED_VELOCITIES:
        return False
    before, here, after = order[middle - 1], order[middle], order[middle + 1]
    span_s = (states.t_ns[after] - states.t_ns[before]) * 1e-9
    with np.errstate(divide="ignore", invalid="ignore"):
        way = np.asarray((states.place[:, after] - states.place[:, before]) / span_s, np.float64)
    off = np.hypot(*(way - states.velocity[:, here]))
    moving = np.hypot(*way) > DERIVED_VELOCITY_TOLERANCE_MPS
    return bool(
        moving.any()
        and (off[moving] <= DERIVED_VELOCITY_TOLERANCE_MPS * (1.0 + np.hypot(*way[:, moving]))).mean()
        >= _LEAST_DERIVED_VELOCITY_SHARE
    )
