"""How long the entities of a scene are there: until they are replaced, deleted or expired.

Who is still there without a message of its own has states too. One that stood still is where it was; of one that moved
nobody knows where it is now: it is there but not placed.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from drivelint.errors import TraceError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from drivelint.formats.coordinate_frames import Vectors
    from drivelint.formats.ros2.recorded_poses import RecordedPoses

MAX_PERSISTED: Final = 20_000_000
"""More states than this are not made up: nobody records so many road users that stand still."""
STALE_NS: Final = 500_000_000
"""An entity that moves and is not updated for so long is not placed: until then its last state speaks for it."""
_NEVER: Final = np.iinfo(np.int64).max


class Deletions(NamedTuple):
    """Times of deletion: of one actor (index), or of all (-1). Who was updated at that time or later stays."""

    actor: NDArray[np.int32]
    t_ns: NDArray[np.int64]


class PersistedStates(NamedTuple):
    """States between updates: which update each goes back to, its time, and whether the entity stood still."""

    row: NDArray[np.intp]
    t_ns: NDArray[np.int64]
    still: NDArray[np.bool_]


def persisted_states(
    updates: RecordedPoses, actor: NDArray[np.int32], deletions: Deletions, grid_ns: NDArray[np.int64]
) -> PersistedStates:
    """Return the states of entities at the messages that do not update them; `actor`: the index of each update's entity."""
    n = len(updates)
    order = np.lexsort((np.arange(n), updates.t_ns, actor))
    sorted_updates = updates.take(order)
    actor, t_ns, lifetime = actor[order], sorted_updates.t_ns, np.asarray(sorted_updates.lifetime_ns)
    box = np.concatenate([sorted_updates.place, sorted_updates.turn, sorted_updates.size], axis=1)
    same, alike = actor[1:] == actor[:-1], _alike(box)
    follows = np.r_[np.where(same, t_ns[1:], _NEVER), _NEVER]
    # a lifetime of centuries would overflow
    gone = np.where((lifetime > 0) & (lifetime < _NEVER - np.abs(t_ns)), t_ns + lifetime, _NEVER)
    gone = np.minimum(gone, _deleted(actor, t_ns, deletions))
    replaced = (follows <= gone) & (follows < _NEVER)
    # between two places the entity moved: the samples themselves say so, and nothing is put between them
    still = np.asarray(np.where(replaced, np.r_[same & alike, False], np.r_[True, alike | ~same]), np.bool_)
    first = np.searchsorted(grid_ns, t_ns + np.where(still, 0, STALE_NS), side="right")
    last = np.searchsorted(grid_ns, np.minimum(follows, gone), side="left")
    count = np.where(still | ~replaced, np.maximum(last - first, 0), 0)
    total = int(count.sum())
    if total > MAX_PERSISTED:
        raise TraceError(f"entities that are never deleted would have {total} states: record them with a lifetime")
    row = np.repeat(np.arange(n), count)
    step = np.arange(total) - np.repeat(np.cumsum(count) - count, count)
    return PersistedStates(order[row], grid_ns[first[row] + step], still[row])


def _alike(box: Vectors) -> NDArray[np.bool_]:
    """Say of each pair of neighbouring rows whether their boxes are the same."""
    before, after = box[:-1], box[1:]
    result: NDArray[np.bool_] = np.asarray(((before == after) | (np.isnan(before) & np.isnan(after))).all(axis=1))
    return result


def _deleted(actor: NDArray[np.int32], t_ns: NDArray[np.int64], deletions: Deletions) -> NDArray[np.int64]:
    """Return when each update is deleted: by the first deletion of its actor, or of all, with a later time."""
    result = np.full(len(t_ns), _NEVER)
    for whom in np.unique(deletions.actor):
        mine = np.flatnonzero((actor == whom) | (whom < 0))
        times = np.sort(deletions.t_ns[deletions.actor == whom])
        first_later = np.r_[times, _NEVER][np.searchsorted(times, t_ns[mine], side="right")]
        result[mine] = np.minimum(result[mine], first_later)
    return result
