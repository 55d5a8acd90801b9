"""Finds the ego in a log without odometry: by the transforms of its frame, at the transforms' own times."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from drivelint.drive.trace import ACTOR_CLASSES
from drivelint.formats.coordinate_frames import (
    FIXED_FRAME_NAMES,
    MAX_INTERPOLATED_GAP_NS,
    Poses,
    clean_frame_name,
    unit_quaternions,
)
from drivelint.formats.ros2.ego import rows_by_frames
from drivelint.formats.ros2.objects import stamps, vectors
from drivelint.formats.ros2.recorded_poses import recorded_poses
from drivelint.formats.ros2.vehicle import is_axle_frame
from drivelint.phrases import name_list

if TYPE_CHECKING:
    from collections.abc import Iterable

    from drivelint.arrays import Mask, Times
    from drivelint.formats.coordinate_frames import TransformTree
    from drivelint.formats.ros2.cdr import Table
    from drivelint.formats.ros2.recorded_poses import RecordedPoses
    from drivelint.formats.ros2.vehicle import VehicleBox

EGO_FRAMES: Final = ("base_link", "base_footprint")
"""The names of the vehicle's own frame by REP 105, best first; a prefix such as `ego/` may precede them."""
_MOST_LISTED_NAMES: Final = 4
_MOST_DROPPED_PERIODS_AT_EACH_END: Final = 2.5
"""The recordings of two topics that go on to the end end at most so many periods of the slower one apart."""


class EgoRows(NamedTuple):
    """The ego's poses: the topic of their transforms, the ego's frame, and the rows, each in the parent of the moving frame.

    `has_box_centre`: whether the rows were moved to the centre that the vehicle's box states.
    """

    topic: str
    frame: str
    rows: RecordedPoses
    has_box_centre: bool


class _Transforms(NamedTuple):
    """All transforms to one frame, in the order of the log. `topics`: those that have them."""

    topics: tuple[str, ...]
    parent: str
    static: bool
    stamp_ns: Times
    stamped: Mask
    log_ns: Times
    poses: Poses


def ego_rows_or_reason(
    tables: Iterable[tuple[str, tuple[Table, Times]]],
    box: VehicleBox | None,
    option_ahead_m: float,
    static_suffix: str,
    ego_name: str | None,
) -> EgoRows | str:
    """Return the ego's rows, moved to the centre of its box, or why there are none.

    `tables`: topic -> transforms and log times of each batch. Only static transforms lie between the ego's frame and the moving frame
    whose transforms give the times; transforms above that frame place it later. `box`, `option_ahead_m`: as for odometry.
    `ego_name`: the frame that the user chose; one that the log does not have is the id of another actor.
    """
    transforms, ambiguous = _transforms_by_child(tables, static_suffix)
    ego_frame = None if ego_name is None else clean_frame_name(ego_name)
    names = (
        [ego_frame]
        if ego_frame in transforms
        else [name for last in EGO_FRAMES for name in sorted(transforms) if _name_without_prefix(name) == last]
    )
    if not names:
        child_frames = name_list(sorted(transforms), _MOST_LISTED_NAMES) or "none"
        return (
            f"no transform leads to {' or '.join(EGO_FRAMES)} (child frames: {child_frames}; --ego FRAME chooses one)"
        )
    frame = names[0]
    if sum(_name_without_prefix(name) == _name_without_prefix(frame) for name in names) > 1:
        return f"several frames may be the ego's, and --ego FRAME chooses one: {name_list(names, _MOST_LISTED_NAMES)}"
    chain = _chain_or_reason(frame, transforms, ambiguous)
    if isinstance(chain, str):
        return chain
    moving = chain[-1]
    above = [moving.parent]
    while above[-1] in transforms and transforms[above[-1]].parent not in above:
        above.append(transforms[above[-1]].parent)
    if not {_name_without_prefix(name) for name in above} & set(FIXED_FRAME_NAMES):
        return f"the chain from {frame!r} ends at {above[-1]!r}, without {' or '.join(FIXED_FRAME_NAMES)}"
    is_axle = bool(is_axle_frame(np.array([frame.encode()]))[0])
    centre = box.centre if box is not None and is_axle else (option_ahead_m, 0.0, 0.0)
    rows = _ego_poses_of_chain(chain, centre)
    if box is not None:
        rows.size[:] = box.size
    return EgoRows(moving.topics[0], frame, rows, has_box_centre=box is not None and is_axle)


def drop_unplaced_ends(rows: RecordedPoses, frames: TransformTree, fixed: str, most_dropped_ns: int) -> RecordedPoses:
    """Return the rows without those at the ends for which a transform above is not recorded yet or any more.

    The transforms of a chain are sent at different rates, so that their recordings begin and end at different times. Longer ends than
    that explains, or than `most_dropped_ns` or `MAX_INTERPOLATED_GAP_NS`, stay: there the ego drives on, but is not placed.
    """
    if not len(rows):
        return rows
    frame = clean_frame_name(rows.frames[0].decode("utf-8", "replace"))
    t_ns = rows.t_ns
    placed_ns = t_ns[np.isfinite(frames.frame_poses(fixed, frame, t_ns).place[:, 0])]
    if not len(placed_ns):
        return rows
    above = [transform for transform in frames.chain(frame, fixed) or () if not transform.static]
    period_ns = max(
        (float(np.median(np.diff(transform.t_ns))) for transform in above if len(transform.t_ns) > 1), default=0.0
    )
    most_ns = min(most_dropped_ns, MAX_INTERPOLATED_GAP_NS, _MOST_DROPPED_PERIODS_AT_EACH_END * period_ns)
    first, last = placed_ns.min(), placed_ns.max()
    is_kept = np.ones(len(rows), np.bool_)
    if first - t_ns.min() <= most_ns:
        is_kept &= t_ns >= first
    if t_ns.max() - last <= most_ns:
        is_kept &= t_ns <= last
    return rows.take(is_kept)


def _chain_or_reason(
    frame: str, transforms_by_child: dict[str, _Transforms], ambiguous: set[str]
) -> list[_Transforms] | str:
    """Return the transforms from a frame up to the first that changes, or why there are none."""
    chain: list[_Transforms] = []
    at = frame
    while True:
        if at in ambiguous:
            return f"several frames have the child frame {at!r}"
        if at not in transforms_by_child or len(chain) > len(transforms_by_child):
            way = "" if at == frame else f" (the chain from it ends at {at!r})"
            return f"no transform that changes leads to {frame!r}{way}"
        chain.append(transforms_by_child[at])
        if not transforms_by_child[at].static:
            break
        at = transforms_by_child[at].parent
    if len(topics := chain[-1].topics) > 1:
        return f"several topics have transforms to {at!r}, and --topic chooses one: {name_list(topics, _MOST_LISTED_NAMES)}"
    return chain


def _ego_poses_of_chain(chain: list[_Transforms], centre: tuple[float, float, float]) -> RecordedPoses:
    moving = chain[-1]
    _, last = np.unique(moving.stamp_ns[::-1], return_index=True)  # relays repeat transforms
    rows = np.sort(len(moving.stamp_ns) - 1 - last) if len(last) > 1 else np.arange(len(moving.stamp_ns))
    n = len(rows)
    poses = Poses(*(column[rows] for column in moving.poses))
    for transform in reversed(chain[:-1]):
        poses = poses.compose(Poses(*(np.repeat(column[-1:], n, axis=0) for column in transform.poses)))
    centre_poses = poses.compose(Poses(np.tile(centre, (n, 1)), np.tile([0.0, 0.0, 0.0, 1.0], (n, 1))))
    return recorded_poses(
        (moving.stamp_ns[rows], moving.stamped[rows]), (centre_poses.place, poses.turn), log_ns=moving.log_ns[rows],
        ids=np.full(n, b"ego"), frames=np.full(n, moving.parent.encode()), classes=np.full(n, ACTOR_CLASSES.index("vehicle"), np.int8),
    )  # fmt: skip


def _transforms_by_child(
    tables: Iterable[tuple[str, tuple[Table, Times]]], static_suffix: str
) -> tuple[dict[str, _Transforms], set[str]]:
    """Return child frame -> its transforms, and the child frames with several parents."""
    parts: dict[str, list[_Transforms]] = {}
    for topic, (table, log_ns) in tables:
        items = table.items("transforms")
        if not items.n:
            continue
        stamp_ns, stamped = stamps(items, "header.stamp")
        places, turns = (
            vectors(items, "transform.translation"),
            unit_quaternions(vectors(items, "transform.rotation", "xyzw")),
        )
        for child, parent, rows in rows_by_frames(items):
            transforms = _Transforms(
                (topic,), parent, topic.endswith(static_suffix), stamp_ns[rows], stamped[rows],
                log_ns[items.parent[rows]], Poses(places[rows], turns[rows]),
            )  # fmt: skip
            parts.setdefault(child, []).append(transforms)
    ambiguous = {child for child, of_child in parts.items() if len({transforms.parent for transforms in of_child}) > 1}
    return {child: _join_batches(of_child) for child, of_child in parts.items()}, ambiguous


def _join_batches(parts: list[_Transforms]) -> _Transforms:
    moving = [part for part in parts if not part.static] or parts
    first = moving[0]
    return first._replace(
        topics=tuple(sorted({topic for part in moving for topic in part.topics})),
        stamp_ns=np.concatenate([part.stamp_ns for part in moving]),
        stamped=np.concatenate([part.stamped for part in moving]),
        log_ns=np.concatenate([part.log_ns for part in moving]),
        poses=Poses(*(np.concatenate([part.poses[k] for part in moving]) for k in (0, 1))),
    )


def _name_without_prefix(name: str) -> str:
    return name.rsplit("/", maxsplit=1)[-1]
