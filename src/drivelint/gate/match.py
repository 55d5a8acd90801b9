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

NEAR_S: Final = 1.0
"""Failing stretches so close in time are the same, where the place agrees."""
NEAR_M: Final = 5.0
"""So far may the ego have been elsewhere at the worst step, if the log is another."""

FindingKey = tuple[str, str, str | None, str | None]
finding_key: Final[Callable[[Row], FindingKey]] = itemgetter("ego_id", "rule_id", "profile", "object_id")
"""The columns that must agree: they identify a finding within a drive."""


class TimedFinding(NamedTuple):
    """A finding with its times in seconds since the drive's first time stamp."""

    row: Row
    start: float
    end: float
    worst: float


def seconds_since_start(t_ns: int, drive: Row) -> float:
    """Return a time of a drive as seconds since its first time stamp."""
    return (t_ns - (drive["t_start_ns"] or 0)) / 1e9


def match_drives(base: Sequence[Row], new: Sequence[Row]) -> dict[str, str]:
    """Return drive_id in NEW -> drive_id in BASE: the same id, else the same content, else the only one of both with that file stem.

    Of several drives with one content, the first is the same as the first, and so on.
    """
    ids = {row["drive_id"] for row in base}
    same = {row["drive_id"]: row["drive_id"] for row in new if row["drive_id"] in ids}
    for content in ("sha256", None):
        known = {*same.values()}
        left = _drive_ids_by_column((row for row in base if row["drive_id"] not in known), content)
        right = _drive_ids_by_column((row for row in new if row["drive_id"] not in same), content)
        for key, mine in right.items():
            others = left.get(key, [])
            if content is not None or len(mine) == len(others) == 1:
                same |= zip(mine, others, strict=False)
    return same


def _drive_ids_by_column(drives: Iterable[Row], column: str | None) -> dict[str, list[str]]:
    """Return value of a column, or file stem -> ids of the drives that have it, sorted."""
    groups = counts.group_rows(drives, lambda row: row[column] if column else PurePath(row["file_name"]).stem)
    return {key: sorted(row["drive_id"] for row in rows) for key, rows in groups.items() if key is not None}


def match_findings(base: Sequence[TimedFinding], new: Sequence[TimedFinding], *, same_log: bool) -> dict[int, int]:
    """Return index in `new` -> index in `base` of findings of one drive that are the same; each is taken once.

    The same: ego, rule, profile and object agree, and `may_match`. Equal ids go first, then the closest in time. An id alone
    does not do: ids number the findings of a drive, so an earlier one moves all that follow.
    """
    groups: dict[FindingKey, list[int]] = defaultdict(list)
    for j, had in enumerate(base):
        groups[finding_key(had.row)].append(j)
    pairs = [
        (had.row["finding_id"] != now.row["finding_id"], abs(had.worst - now.worst), gap_s(had, now), i, j)
        for i, now in enumerate(new)
        for j in groups.get(finding_key(now.row), ())
        for had in (base[j],)
        if may_match(had, now, same_log=same_log)
    ]
    taken: dict[int, int] = {}
    left = set(range(len(base)))
    for _, _, _, i, j in sorted(pairs):
        if i not in taken and j in left:
            taken[i] = j
            left.remove(j)
    return taken


def may_match(had: TimedFinding, now: TimedFinding, *, same_log: bool) -> bool:
    """Return whether two findings are close enough in time and place to be the same.

    In the same log: less than `NEAR_S` apart. In another one, a repetition: so close at their worst and less than `NEAR_M`
    apart in place; or, since the worst step of a long stretch may be anywhere in it, for at least half of the time the same.
    """
    if same_log:
        return gap_s(had, now) <= NEAR_S
    if abs(had.worst - now.worst) <= NEAR_S and _distance(had.row, now.row) <= NEAR_M:
        return True
    common = min(had.end, now.end) - max(had.start, now.start)
    whole = max(had.end, now.end) - min(had.start, now.start)
    return 0 < whole <= 2 * common


def is_part_of(part: TimedFinding, whole: TimedFinding, *, same_log: bool) -> bool:
    """Return whether a finding is a part of a longer one of the other result."""
    slack = NEAR_S if same_log else 0.0
    longer = finding_key(part.row) == finding_key(whole.row) and part.end - part.start < whole.end - whole.start
    return longer and part.start >= whole.start - slack and part.end <= whole.end + slack


def is_recorded(stretches: Iterable[tuple[float, float]], at: TimedFinding) -> bool:
    """Return whether an actor is recorded where a finding is: at its worst step, and nowhere in it missing for more than `NEAR_S`.

    `stretches`: in seconds, in time order.
    """
    seen_to, at_worst = at.start, False
    for start, end in stretches:
        at_worst |= start <= at.worst <= end
        if end >= at.start and start <= at.end:
            if start - seen_to > NEAR_S:
                return False
            seen_to = end
    return at_worst and at.end - seen_to <= NEAR_S


def gap_s(a: TimedFinding, b: TimedFinding) -> float:
    """Return the seconds between two stretches; 0 where they overlap."""
    return max(0.0, max(a.start, b.start) - min(a.end, b.end))


def _distance(a: Row, b: Row) -> float:
    """Return metres between the places of two findings; 0 where one of them has none: time must do."""
    if None in {a["x_m"], a["y_m"], b["x_m"], b["y_m"]}:
        return 0.0
    return float(((a["x_m"] - b["x_m"]) ** 2 + (a["y_m"] - b["y_m"]) ** 2) ** 0.5)
