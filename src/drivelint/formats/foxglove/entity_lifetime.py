"""Adds states for entities of a scene that still exist without an update: they exist until they are replaced, deleted or expired.

An entity that stood still keeps its place. If it moved, its place is unknown: it is present but not placed.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from drivelint.drive.trace import QualityFinding
from drivelint.errors import TraceError
from drivelint.formats.ros2.recorded_poses import RecordedPoses, distinct_values, join_batches
from drivelint.phrases import name_list

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from drivelint.arrays import Indices, Mask, Times
    from drivelint.drive.trace import Severity

MAX_ADDED_STATES: Final = 20_000_000
"""If more states than this would be added, the log is refused: no log has so many road users that stand still."""
MOVING_ENTITY_STALE_AFTER_NS: Final = 500_000_000
"""A moving entity is present but not placed if its last update is older than this."""
_NEVER_NS: Final = np.iinfo(np.int64).max


def with_states_between_updates(
    rows: RecordedPoses, deletions: tuple[Times, list[str | None]], findings: list[QualityFinding], topic: str
) -> RecordedPoses:
    """Return `rows` with added states for entities that exist without an update: with a place only if they stood still.

    `deletions`: times, and the ids that are deleted (None: all). A deletion does not affect updates at the same time or later.
    """
    unique, actor = distinct_values(rows.ids)
    number = {name: i for i, name in enumerate(unique)}
    deleted_actor = np.array([-1 if name is None else number.get(name, len(unique)) for name in deletions[1]], np.int32)
    new = np.r_[True, rows.t_ns[1:] != rows.t_ns[:-1]]
    grid_ns = np.unique(np.concatenate([rows.t_ns[new], deletions[0]]))
    row, t_ns, stood_still = _states_between_updates(rows, actor, (deletions[0], deleted_actor), grid_ns)
    if not len(row):
        return rows
    extra = rows.take(row)
    extra.t_ns = t_ns
    extra.at_ns = np.where(np.asarray(extra.locked), t_ns, rows.t_ns[row])
    extra.place = np.where(stood_still[:, None], extra.place, np.nan)
    rows.at_ns = rows.t_ns
    kinds: tuple[tuple[Mask, str, Severity, str], ...] = (
        (stood_still, "entity_held", "info", "stood still and keep their positions"),
        (~stood_still, "entity_stale", "warning", "moved before: they are present, but their positions are unknown"),
    )
    for some, check, severity, effect in kinds:
        if some.any():
            n, names = int(some.sum()), sorted({unique[i] for i in np.unique(actor[row[some]])})
            message = f"{topic}: {n} states of entities that are neither updated nor deleted ({name_list(names)}): they {effect}"
            findings.append(QualityFinding(check, severity, message, n, int(t_ns[some].min())))
    return join_batches([rows, extra])


def _states_between_updates(
    updates: RecordedPoses, actor: NDArray[np.int32], deletions: tuple[Times, NDArray[np.int32]], grid_ns: Times
) -> tuple[Indices, Times, Mask]:
    """Return the states between updates: the row of the last update, the time, and whether the entity stood still.

    `actor`: the index of each update's entity; `deletions`: times, and indices of the deleted entities (-1: all).
    `grid_ns`: the times at which states are added.
    """
    n = len(updates)
    order = np.lexsort((np.arange(n), updates.t_ns, actor))
    sorted_updates = updates.take(order)
    actor, t_ns, lifetime = actor[order], sorted_updates.t_ns, np.asarray(sorted_updates.lifetime_ns)
    box = np.concatenate([sorted_updates.place, sorted_updates.turn, sorted_updates.size], axis=1)
    before, after = box[:-1], box[1:]
    alike = ((before == after) | (np.isnan(before) & np.isnan(after))).all(axis=1)
    same = actor[1:] == actor[:-1]
    follows = np.r_[np.where(same, t_ns[1:], _NEVER_NS), _NEVER_NS]
    # a lifetime of centuries would overflow
    gone_ns = np.where((lifetime > 0) & (lifetime < _NEVER_NS - np.abs(t_ns)), t_ns + lifetime, _NEVER_NS)
    gone_ns = np.minimum(gone_ns, _deletion_times(actor, t_ns, deletions))
    replaced = (follows <= gone_ns) & (follows < _NEVER_NS)
    # an entity whose next update has another place moved, and gets no states in between
    still = np.asarray(np.where(replaced, np.r_[same & alike, False], np.r_[True, alike | ~same]), np.bool_)
    first = np.searchsorted(grid_ns, t_ns + np.where(still, 0, MOVING_ENTITY_STALE_AFTER_NS), side="right")
    last = np.searchsorted(grid_ns, np.minimum(follows, gone_ns), side="left")
    count = np.where(still | ~replaced, np.maximum(last - first, 0), 0)
    total = int(count.sum())
    if total > MAX_ADDED_STATES:
        raise TraceError(f"entities that are never deleted would have {total} states: record them with a lifetime")
    row = np.repeat(np.arange(n), count)
    step = np.arange(total) - np.repeat(np.cumsum(count) - count, count)
    return order[row], grid_ns[first[row] + step], still[row]


def _deletion_times(actor: NDArray[np.int32], t_ns: Times, deletions: tuple[Times, NDArray[np.int32]]) -> Times:
    """Return the time at which each update is deleted: the first later deletion of its actor or of all actors."""
    when, deleted_actor = deletions
    result = np.full(len(t_ns), _NEVER_NS)
    for number in np.unique(deleted_actor):
        rows = np.flatnonzero((actor == number) | (number < 0))
        times = np.sort(when[deleted_actor == number])
        first_later = np.r_[times, _NEVER_NS][np.searchsorted(times, t_ns[rows], side="right")]
        result[rows] = np.minimum(result[rows], first_later)
    return result
