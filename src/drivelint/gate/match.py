"""Matches the drives and findings of two results."""

from __future__ import annotations

from collections import defaultdict
from operator import itemgetter
from pathlib import PurePath
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from drivelint.result import counts

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    Row = Mapping[str, Any]

MOST_TIME_BETWEEN_MATCHED_FINDINGS_S: Final = 1.0
"""Failing stretches at most this far apart in time are the same if their place agrees."""
MOST_DISTANCE_BETWEEN_MATCHED_FINDINGS_M: Final = 5.0
"""In different logs, the ego's positions at the worst steps of the same finding may be this far apart."""

FindingKey = tuple[str, str, str | None, str | None]
finding_key: Final[Callable[[Row], FindingKey]] = itemgetter("ego_id", "rule_id", "profile", "object_id")
"""Return the columns of a finding that must be equal for a match. They identify a rule's violation within a drive."""


class TimedFinding(NamedTuple):
    """A finding with its times in seconds since the drive's first time stamp."""

    row: Row
    start_s: float
    end_s: float
    worst_s: float


def seconds_since_start(t_ns: int, drive: Row) -> float:
    """Return a time stamp of a drive as seconds since the drive's first time stamp."""
    return (t_ns - (drive["t_start_ns"] or 0)) / 1e9


def base_drive_by_new_drive(base: Sequence[Row], new: Sequence[Row]) -> dict[str, str]:
    """Return drive_id in `new` -> drive_id in `base`. Drives match by the same id, else by content, else by a file stem that is unique in
    both.

    If several drives have the same content, they match in the order of their ids.
    """
    ids = {row["drive_id"] for row in base}
    same = {row["drive_id"]: row["drive_id"] for row in new if row["drive_id"] in ids}
    for content in ("sha256", None):
        matched = {*same.values()}
        left = _drive_ids_by_column_value((row for row in base if row["drive_id"] not in matched), content)
        right = _drive_ids_by_column_value((row for row in new if row["drive_id"] not in same), content)
        for key, new_ids in right.items():
            base_ids = left.get(key, [])
            if content is not None or len(new_ids) == len(base_ids) == 1:
                same |= zip(new_ids, base_ids, strict=False)
    return same


def _drive_ids_by_column_value(drives: Iterable[Row], column: str | None) -> dict[str, list[str]]:
    """Return value of a column, or file stem -> sorted ids of the drives with that value."""
    groups = counts.group_rows(drives, lambda row: row[column] if column else PurePath(row["file_name"]).stem)
    return {key: sorted(row["drive_id"] for row in rows) for key, rows in groups.items() if key is not None}


def match_findings(base: Sequence[TimedFinding], new: Sequence[TimedFinding], *, same_log: bool) -> dict[int, int]:
    """Return index in `new` -> index in `base` for the findings of one drive that are the same. Each finding is matched at most once.

    Two findings can match if ego, rule, profile and object are equal and `may_match` agrees. Pairs with equal ids go first, then the
    closest in time. The id alone is not enough: ids number the findings of a drive, so an additional earlier finding changes all later ids.
    """
    groups: dict[FindingKey, list[int]] = defaultdict(list)
    for j, had in enumerate(base):
        groups[finding_key(had.row)].append(j)
    pairs = [
        (had.row["finding_id"] != now.row["finding_id"], abs(had.worst_s - now.worst_s), gap_s(had, now), i, j)
        for i, now in enumerate(new)
        for j in groups.get(finding_key(now.row), ())
        for had in (base[j],)
        if may_match(had, now, same_log=same_log)
    ]
    base_by_new: dict[int, int] = {}
    left = set(range(len(base)))
    for _, _, _, i, j in sorted(pairs):
        if i not in base_by_new and j in left:
            base_by_new[i] = j
            left.remove(j)
    return base_by_new


def may_match(base: TimedFinding, new: TimedFinding, *, same_log: bool) -> bool:
    """Return whether two findings are close enough in time and place to be the same.

    In the same log: at most `MOST_TIME_BETWEEN_MATCHED_FINDINGS_S` apart. In another log, such as a repeated run: the worst steps are at
    most `MOST_TIME_BETWEEN_MATCHED_FINDINGS_S` and `MOST_DISTANCE_BETWEEN_MATCHED_FINDINGS_M`
    apart, or the findings share at least half of their total time. The worst step can be anywhere in a long stretch.
    """
    if same_log:
        return gap_s(base, new) <= MOST_TIME_BETWEEN_MATCHED_FINDINGS_S
    if (
        abs(base.worst_s - new.worst_s) <= MOST_TIME_BETWEEN_MATCHED_FINDINGS_S
        and _distance_m(base.row, new.row) <= MOST_DISTANCE_BETWEEN_MATCHED_FINDINGS_M
    ):
        return True
    common = min(base.end_s, new.end_s) - max(base.start_s, new.start_s)
    whole = max(base.end_s, new.end_s) - min(base.start_s, new.start_s)
    return 0 < whole <= 2 * common


def is_part_of(part: TimedFinding, whole: TimedFinding, *, same_log: bool) -> bool:
    """Return whether a finding is a part of a longer finding of the other result."""
    slack = MOST_TIME_BETWEEN_MATCHED_FINDINGS_S if same_log else 0.0
    longer = finding_key(part.row) == finding_key(whole.row) and part.end_s - part.start_s < whole.end_s - whole.start_s
    return longer and part.start_s >= whole.start_s - slack and part.end_s <= whole.end_s + slack


def is_recorded_during(recorded_spans: Iterable[tuple[float, float]], finding: TimedFinding) -> bool:
    """Return whether an actor is recorded at a finding: at its worst step, and without a gap of more than
    `MOST_TIME_BETWEEN_MATCHED_FINDINGS_S` during the finding.

    `recorded_spans`: (start, end) in seconds, in time order.
    """
    seen_to, at_worst = finding.start_s, False
    for start, end in recorded_spans:
        at_worst |= start <= finding.worst_s <= end
        if end >= finding.start_s and start <= finding.end_s:
            if start - seen_to > MOST_TIME_BETWEEN_MATCHED_FINDINGS_S:
                return False
            seen_to = end
    return at_worst and finding.end_s - seen_to <= MOST_TIME_BETWEEN_MATCHED_FINDINGS_S


def gap_s(a: TimedFinding, b: TimedFinding) -> float:
    """Return the seconds between two findings; 0 if they overlap."""
    return max(0.0, max(a.start_s, b.start_s) - min(a.end_s, b.end_s))


def _distance_m(a: Row, b: Row) -> float:
    """Return the distance in metres between two findings; 0 if one has no place, so that only the time decides."""
    if None in {a["x_m"], a["y_m"], b["x_m"], b["y_m"]}:
        return 0.0
    return float(((a["x_m"] - b["x_m"]) ** 2 + (a["y_m"] - b["y_m"]) ** 2) ** 0.5)
