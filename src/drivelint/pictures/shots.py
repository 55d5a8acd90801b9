"""Chooses the pictures of a run: only those of the worst moments, so that their number and size are limited for any logs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import pyarrow as pa
import pyarrow.compute as pc

from drivelint.report.worst_first import worst_first

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from drivelint.result.model import Result

SHOT_OFFSET_NS: Final = {"before": -1_000_000_000, "at": 0, "after": 1_000_000_000}
"""Shot -> its time relative to the moment."""
_SHOT_ORDER: Final = ("at", "before", "after")
MOST_MOMENTS: Final = 30
MOST_CAMERAS: Final = 3
MOST_SHOTS: Final = 120
"""The most pictures of a run."""


class Shot(NamedTuple):
    """A picture to take: of a moment of a drive, by one of the drive's cameras."""

    drive_id: str
    t_ns: int
    camera_no: int
    shot: str


def planned_shots(result: Result, topics_by_drive: Mapping[str, Sequence[str]]) -> list[Shot]:
    """Return the pictures to take for a result, the most important first. `topics_by_drive`: drive_id -> topics of its cameras.

    The first camera shows every moment, then the other cameras show the worst moments. Every picture in the plan for all
    drives is also in the plan for each part of the drives that contains its drive. So pictures can be taken part by part, and those that
    are not in the plan for all drives are dropped later.
    """
    return shots_of_moments(_moments_worst_first(result, topics_by_drive), topics_by_drive)


def shots_of_moments(moments: Sequence[tuple[str, int]], topics_by_drive: Mapping[str, Sequence[str]]) -> list[Shot]:
    """Return the pictures to take of moments (drive and time), which are sorted, the worst first. All drives must have cameras."""
    moments = moments[:MOST_MOMENTS]
    first = [Shot(*moment, 0, shot) for shot in _SHOT_ORDER for moment in moments]
    later_shots = [
        Shot(drive_id, t_ns, no, shot)
        for drive_id, t_ns in moments
        for no in range(1, min(len(topics_by_drive[drive_id]), MOST_CAMERAS))
        for shot in _SHOT_ORDER
    ]
    return [*first, *later_shots][:MOST_SHOTS]


def rows_of_planned_shots(pictures: pa.Table, shots: Sequence[Shot]) -> pa.Table:
    """Return the rows of the table `picture` whose shots are planned."""
    planned_keys = set(shots)
    keys = zip(*(pictures[name].to_pylist() for name in Shot._fields), strict=True)
    return pictures.filter(pa.array([Shot(*key) in planned_keys for key in keys], pa.bool_()))


def _moments_worst_first(result: Result, topics_by_drive: Mapping[str, Sequence[str]]) -> list[tuple[str, int]]:
    """Return drive and time of the findings, then of the near misses, each with the worst first; only drives with cameras."""
    if not topics_by_drive:
        return []
    rules = {row["rule_id"]: row for row in result.rules.to_pylist()}
    near = result.verdicts.filter(pc.equal(result.verdicts["near_miss"], True))
    of_drives = pa.array(sorted(topics_by_drive), pa.string())
    moments: dict[tuple[str, int], None] = {}
    for rows in (result.findings, near):
        camera_rows = rows.filter(
            pc.and_(pc.is_in(rows["drive_id"], value_set=of_drives), pc.is_valid(rows["t_worst_ns"]))
        )
        ordered = worst_first(camera_rows, rules)
        moments |= dict.fromkeys(zip(ordered["drive_id"].to_pylist(), ordered["t_worst_ns"].to_pylist(), strict=True))
    return list(moments)
