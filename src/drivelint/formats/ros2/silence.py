"""Finds the times in which a topic of road users has no messages while the odometry continues: the actors are unknown then."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from drivelint.drive.order import MAX_GAP_PERIODS
from drivelint.drive.trace import LostTime

if TYPE_CHECKING:
    from drivelint.arrays import Times

MESSAGE_TYPES_SENT_EVEN_WITHOUT_OBJECTS: Final = frozenset({
    "autoware_perception_msgs/PredictedObjects", "autoware_perception_msgs/TrackedObjects", "derived_object_msgs/ObjectArray",
})  # fmt: skip
"""Message types whose senders also send messages without objects. A sender of detections may send nothing if there is no actor."""
LEAST_SILENCE_NS: Final = 1_000_000_000
"""Shorter times are not reported: topics of one recording begin and end up to a second apart."""


def silences(topic: str, sent_ns: Times, odometry_ns: Times) -> list[LostTime]:
    """Return the times in which a topic has no messages while the odometry continues.

    `sent_ns`, `odometry_ns`: log times of the topic's and of the odometry's messages.
    """
    sent, continuing = np.unique(sent_ns), np.sort(odometry_ns)
    if len(sent) < 2 or not len(continuing):
        return []
    least = max(int(MAX_GAP_PERIODS * np.median(np.diff(sent))), LEAST_SILENCE_NS)
    edges = np.r_[min(sent[0], continuing[0]), sent, max(sent[-1], continuing[-1])]
    goes_on = np.searchsorted(continuing, edges[1:]) - np.searchsorted(continuing, edges[:-1], side="right") > 1
    silent = np.flatnonzero((np.diff(edges) > least) & goes_on)
    begins, ends = (edges[side].tolist() for side in (silent, silent + 1))
    cause = f"{topic} has no messages while the odometry continues"
    return [
        LostTime(None if k == 0 else since, None if k == len(sent) else until, cause)
        for k, since, until in zip(silent.tolist(), begins, ends, strict=True)
    ]
