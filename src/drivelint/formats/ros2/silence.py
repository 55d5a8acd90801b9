"""Finds the time in which a topic of road users is silent while the ego's odometry continues: the actors in that time are not known."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from drivelint.drive.order import MAX_GAP_PERIODS
from drivelint.drive.trace import LostTime

if TYPE_CHECKING:
    from drivelint.arrays import Times

SENT_WHERE_NOBODY_IS: Final = frozenset({
    "autoware_perception_msgs/PredictedObjects", "autoware_perception_msgs/TrackedObjects", "derived_object_msgs/ObjectArray",
})  # fmt: skip
"""Messages that come all the time, without objects if no actor is there. A detector may send nothing if it sees no actor."""
LEAST_SILENCE_NS: Final = 1_000_000_000
"""Topics of one recording begin and end within a second of each other."""


def silences(topic: str, sent_ns: Times, odometry_ns: Times) -> list[LostTime]:
    """Return when a topic is silent, by the log times of its messages and of those of the odometry."""
    sent, others = np.unique(sent_ns), np.sort(odometry_ns)
    if len(sent) < 2 or not len(others):
        return []
    least = max(int(MAX_GAP_PERIODS * np.median(np.diff(sent))), LEAST_SILENCE_NS)
    edges = np.r_[min(sent[0], others[0]), sent, max(sent[-1], others[-1])]
    goes_on = np.searchsorted(others, edges[1:]) - np.searchsorted(others, edges[:-1], side="right") > 1
    silent = np.flatnonzero((np.diff(edges) > least) & goes_on)
    begins, ends = (edges[side].tolist() for side in (silent, silent + 1))
    what = f"{topic} is silent while the odometry goes on"
    return [
        LostTime(None if k == 0 else since, None if k == len(sent) else until, what)
        for k, since, until in zip(silent.tolist(), begins, ends, strict=True)
    ]
