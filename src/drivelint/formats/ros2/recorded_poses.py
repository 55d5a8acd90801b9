"""Transforms recorded poses, each with its own frame and time, into one fixed frame."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa

from drivelint.drive.clock_restart import backward_step_findings
from drivelint.drive.order import steps, time_derivative
from drivelint.drive.trace import (
    EARLIEST_UTC_NS,
    LOG_TIME_CHECK,
    SIZE_COLUMNS,
    STATE_COLUMNS,
    FrameTimes,
    QualityFinding,
    States,
)
from drivelint.formats.coordinate_frames import Poses, clean_frame_name, rotated, unit_quaternions

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from drivelint.arrays import Codes, Indices, Mask, Times
    from drivelint.formats.coordinate_frames import TransformTree, Vectors

LEAST_MOVING_MPS = 2.0
"""Below this speed, noise of the positions hides in which frame a velocity is given."""
FIT_RATIO = 3.0
"""Velocities that should be along the actor's axes are read as along the frame's, or vice versa, if that fits this many times better."""
MAX_FIT_ERROR_MPS = 0.5
"""The largest median difference to the positions' changes in the frame that is then used."""
MOST_SAMPLED_ACTORS = 8
"""Only this many actors are compared: those that move most."""
MIN_SAMPLES = 20
"""The fewest moving samples that can show in which frame velocities are given."""


@dataclass
class RecordedPoses:
    """n poses in the order of the log. Vectors have three columns; NaN: unknown.

    `stamp_ns`: the message's own time, if it has one (`stamped`); `log_ns`: the time in the container. `ids` and `frames` are bytes.
    `along`: velocity and acceleration are along the actor's own axes, otherwise along those of its frame. `faces`: the front is
    known, not only the axis. `classes`: indices in `ACTOR_CLASSES`; -1: unknown. `set_times_and_return_are_own_times` sets `t_ns`.
    `at_ns`: the time at which a moving frame is looked up; None: `t_ns`. `outlined`: the size is that of the box around a
    polygon. For entities of a scene: `lifetime_ns` (0: unlimited); `locked`: the entity moves with its frame.
    """

    stamp_ns: Times
    stamped: Mask
    log_ns: Times
    ids: NDArray[Any]
    frames: NDArray[Any]
    place: Vectors
    turn: Vectors
    size: Vectors
    classes: Codes
    along: Mask
    faces: Mask
    velocity: Vectors
    acceleration: Vectors
    t_ns: Times
    at_ns: Times | None = None
    outlined: Mask | None = None
    lifetime_ns: Times | None = None
    locked: Mask | None = None

    def __len__(self) -> int:
        return len(self.stamp_ns)

    def take(self, rows: Indices | Mask) -> RecordedPoses:
        """Return only the given rows."""
        columns: dict[str, Any] = {name: None if v is None else v[rows] for name, v in vars(self).items()}
        return RecordedPoses(**columns)


def join_batches(parts: Sequence[RecordedPoses]) -> RecordedPoses:
    """Return the rows of all batches, concatenated."""
    lists = {name: [vars(part)[name] for part in parts] for name in vars(parts[0])}
    columns: dict[str, Any] = {name: None if v[0] is None else np.concatenate(v) for name, v in lists.items()}
    return RecordedPoses(**columns)


def recorded_poses(stamps: tuple[Times, Mask], poses: tuple[Vectors, Vectors], **columns: Any) -> RecordedPoses:
    """Return `RecordedPoses`. `stamps`: times, and whether they exist; `poses`: places and quaternions. Missing columns are unknown."""
    n = len(poses[0])
    unknown: dict[str, Any] = {
        **{name: np.full((n, 3), np.nan) for name in ("size", "velocity", "acceleration")},
        "classes": np.full(n, -1, np.int8), "along": np.zeros(n, np.bool_), "faces": np.ones(n, np.bool_),
    }  # fmt: skip
    (stamp_ns, stamped), (place, turn) = stamps, poses
    return RecordedPoses(stamp_ns=stamp_ns, stamped=stamped, t_ns=stamp_ns, place=place, turn=turn, **unknown | columns)


def distinct_values(values: NDArray[Any]) -> tuple[list[str], NDArray[np.int32]]:
    """Return the distinct values as text, in the order in which they first appear, and each row's index in them.

    Values of numpy's kind S are texts; values of kind V, with sixteen bytes, are UUIDs. Hashing is four times faster than sorting.
    """
    if not len(values):
        return [], np.zeros(0, np.int32)
    if values.dtype.kind in "SV":
        width = pa.binary(values.dtype.itemsize)
        column = pa.FixedSizeBinaryArray.from_buffers(
            width, len(values), [None, pa.py_buffer(np.ascontiguousarray(values))]
        )
    else:
        column = pa.array(values.astype(values.dtype.newbyteorder("="), copy=False))
    coded = column.dictionary_encode()
    words = coded.dictionary.to_pylist()
    if values.dtype.kind == "V":
        words = [f"{h[:8]}-{h[8:12]}-{h[12:16]}-{h[16:20]}-{h[20:]}" for h in (word.hex() for word in words)]
    elif values.dtype.kind == "S":
        words = [word.rstrip(b"\0").decode("utf-8", "backslashreplace") for word in words]
    return [str(word) for word in words], coded.indices.to_numpy(zero_copy_only=False)


def states_in_fixed_frame(
    rows: RecordedPoses, frames: TransformTree, fixed: str, topic: str
) -> tuple[States, list[QualityFinding]]:
    """Return states in the fixed frame, and findings that name the `topic`.

    A pose without a transform to the fixed frame at its time is kept as a state without a position.
    """
    ids, actor = distinct_values(rows.ids)
    place, turn = rows.place.copy(), unit_quaternions(rows.turn)
    along = rows.along[:, None]
    outward = rotated(turn, rows.velocity)
    velocity, swapped = np.where(along, outward, rows.velocity), np.where(along, rows.velocity, outward)
    acceleration = np.where(along, rotated(turn, rows.acceleration), rows.acceleration)
    findings: list[QualityFinding] = []
    names, frame_index = distinct_values(rows.frames)
    at_ns = rows.t_ns if rows.at_ns is None else rows.at_ns
    for i, frame in enumerate(map(clean_frame_name, names)):
        if frame == fixed:
            continue
        here = np.flatnonzero(frame_index == i)
        outer = frames.frame_poses(fixed, frame, at_ns[here])
        inner = outer.compose(Poses(place[here], turn[here]))
        place[here], turn[here] = inner.place, inner.turn
        for vectors in (velocity, acceleration, swapped):
            vectors[here] = rotated(outer.turn, vectors[here])
        is_lost = np.isnan(outer.place[:, 0])
        if is_lost.any():
            findings.append(_unresolved_frame_finding(topic, frame, fixed, frames, rows.t_ns[here[is_lost]]))
    states = States(
        ids,
        actor,
        rows.t_ns,
        {
            **dict(zip(STATE_COLUMNS[:3], place.T.copy(), strict=True)),
            "yaw_rad": np.where(rows.faces, Poses(place, turn).yaw, np.nan),
            "vx_mps": velocity[:, 0].copy(), "vy_mps": velocity[:, 1].copy(),
            "ax_mps2": acceleration[:, 0].copy(), "ay_mps2": acceleration[:, 1].copy(),
            **{name: rows.size[:, k].astype(np.float64) for k, name in enumerate(SIZE_COLUMNS)},
        },
        {"actor_class": rows.classes},
        np.asarray(np.isinf(np.hstack([rows.place, rows.velocity])).any(axis=1)),
    )  # fmt: skip
    for name, values in states.numbers.items():
        states.numbers[name] = np.where(np.isfinite(values), values, np.nan)
    findings += _correct_velocity_frame(states, swapped, rows.along, topic)
    return states, findings


def _unresolved_frame_finding(topic: str, frame: str, fixed: str, frames: TransformTree, t_ns: Times) -> QualityFinding:
    if frame in frames.ambiguous:
        why = f"several frames have the child frame {frame!r}"
    elif frames.chain(frame, fixed) is None:
        why = f"no transform leads from {frame!r} to {fixed!r}"
    else:
        why = f"the transform from {frame!r} to {fixed!r} is not recorded at their time"
    first = int(t_ns.min())
    message = f"{topic}: {len(t_ns)} poses cannot be placed, because {why}: the actors are present, but not placed"
    return QualityFinding("frame_unresolved", "error", message, len(t_ns), first)


def _correct_velocity_frame(states: States, swapped: Vectors, along: Mask, topic: str) -> list[QualityFinding]:
    """Replace velocities by `swapped` if only these fit the positions, and return the finding.

    `swapped`: the velocities under the assumption that the log gives them in the other frame.
    """
    vx, vy = states.numbers["vx_mps"], states.numbers["vy_mps"]
    fast = np.bincount(
        states.actor[np.hypot(swapped[:, 0], swapped[:, 1]) > LEAST_MOVING_MPS], minlength=len(states.ids)
    )
    is_sampled = np.zeros(len(states.ids), np.bool_)
    is_sampled[np.argsort(-fast, kind="stable")[:MOST_SAMPLED_ACTORS]] = True
    some = np.flatnonzero(is_sampled[states.actor])
    order = some[np.lexsort((states.t_ns[some], states.actor[some]))]
    track = states.take(order)
    if len(track) < MIN_SAMPLES:
        return []
    step = steps(track)
    dx, dy = time_derivative(track.numbers["x_m"], step), time_derivative(track.numbers["y_m"], step)
    moving = np.hypot(dx, dy) > LEAST_MOVING_MPS
    wrong = np.hypot(track.numbers["vx_mps"] - dx, track.numbers["vy_mps"] - dy)[moving]
    right = np.hypot(swapped[order, 0] - dx, swapped[order, 1] - dy)[moving]
    is_known = np.isfinite(wrong) & np.isfinite(right)
    if int(is_known.sum()) < MIN_SAMPLES:
        return []
    off, fit = float(np.median(wrong[is_known])), float(np.median(right[is_known]))
    if fit > MAX_FIT_ERROR_MPS or off < max(FIT_RATIO * fit, MAX_FIT_ERROR_MPS):
        return []
    states.numbers["vx_mps"] = np.where(np.isfinite(swapped[:, 0]), swapped[:, 0], vx)
    states.numbers["vy_mps"] = np.where(np.isfinite(swapped[:, 1]), swapped[:, 1], vy)
    ways = ("along the actor's axes", "in the frame of the positions")
    due, is_ = ways if bool(along[0]) else reversed(ways)
    message = (
        f"{topic}: velocities should be {due}, but then differ from the changes of position by {off:.2f} m/s "
        f"(median); {is_} they differ by {fit:.2f} m/s, and are read in this way"
    )
    return [QualityFinding("twist_frame", "warning", message, len(states), int(states.t_ns.min()))]


def set_times_and_return_are_own_times(parts: dict[str, RecordedPoses], findings: list[QualityFinding]) -> bool:
    """Set `t_ns` of the rows to the messages' own times or to log times; return whether own times are used.

    Own times are used if all messages have one, they advance, and the topics overlap. Otherwise a finding states the reason.
    """
    why = None
    ranges = []
    for topic, rows in parts.items():
        if not len(rows):
            continue
        # 0 can be the start of a simulation's clock; but if other stamps are in UTC, 0 means that there is no time
        lacks_stamp = ~rows.stamped | ((rows.stamp_ns == 0) & (rows.stamp_ns.max() >= EARLIEST_UTC_NS))
        if lacks_stamp.any():
            why = f"{topic}: {int(lacks_stamp.sum())} of {len(rows)} poses are without a time stamp"
        elif len(rows) > 1 and rows.stamp_ns.min() == rows.stamp_ns.max() and rows.log_ns.min() < rows.log_ns.max():
            why = f"the time stamps of {topic} do not advance"
        else:
            ranges.append((int(rows.stamp_ns.min()), int(rows.stamp_ns.max()), topic))
    if why is None and len(ranges) > 1:
        latest, earliest = max(ranges), min(ranges, key=lambda item: item[1])
        if latest[0] > earliest[1]:
            why = f"the time stamps of {latest[2]} and {earliest[2]} do not overlap: they come from two clocks"
    for topic, rows in parts.items():
        rows.t_ns = rows.stamp_ns if why is None else rows.log_ns
        if len(rows):
            messages = np.r_[0, np.flatnonzero(np.diff(rows.log_ns)) + 1]
            findings += backward_step_findings(np.maximum.reduceat(rows.t_ns, messages), topic)
    if why is not None:
        n = sum(len(rows) for rows in parts.values())
        first = min((int(rows.t_ns.min()) for rows in parts.values() if len(rows)), default=0)
        message = f"{why}: the log times of the container are used for all messages"
        findings.append(QualityFinding(LOG_TIME_CHECK, "warning", message, n, first))
    return why is None


def frame_times_and_start(parts: Sequence[RecordedPoses]) -> tuple[FrameTimes, int | None]:
    """Return the messages' own times and log times, sorted by log time, and the log's start in UTC (None: unknown)."""
    t_ns, log_ns = np.concatenate([part.t_ns for part in parts]), np.concatenate([part.log_ns for part in parts])
    new = np.r_[True, (t_ns[1:] != t_ns[:-1]) | (log_ns[1:] != log_ns[:-1])]
    pairs = np.unique(np.stack([log_ns[new], t_ns[new]]), axis=1)
    first = int(pairs[0, 0])
    return FrameTimes(pairs[1], pairs[0].astype(np.uint64)), first if first >= EARLIEST_UTC_NS else None


def ids_at_ego(ego: States, object_states: States) -> list[str]:
    """Return the ids of the objects that are within 0.5 m of the ego in at least 95 % of their states."""
    times, first = np.unique(ego.t_ns, return_index=True)
    if len(times) < 2 or not len(object_states):
        return []
    with np.errstate(invalid="ignore"):
        x = np.interp(object_states.t_ns, times, ego.numbers["x_m"][first], left=np.nan, right=np.nan)
        y = np.interp(object_states.t_ns, times, ego.numbers["y_m"][first], left=np.nan, right=np.nan)
        off = np.hypot(object_states.numbers["x_m"] - x, object_states.numbers["y_m"] - y)
    is_known = np.isfinite(off)
    n = np.bincount(object_states.actor[is_known], minlength=len(object_states.ids))
    near = np.bincount(object_states.actor[is_known & (off < 0.5)], minlength=len(object_states.ids))
    return [object_states.ids[i] for i in np.flatnonzero((n >= 2) & (near >= 0.95 * n))]
