"""Finds the new findings of a window, and stores the reported findings as alarms.

Windows overlap, so one finding appears in many windows. Two findings are the same if rule, profile, ego and object are equal and their
failing steps overlap or follow each other closely. Reference points are the same if their times differ by at most 2 s.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence

    import pyarrow as pa

    from drivelint.result.text import Row
    from drivelint.watch.judge import JudgedWindow

WARM_UP_NS: Final = 5_000_000_000
"""In the first seconds of a window that starts after the log's beginning, some rules lack the past that they need."""
SAME_REFERENCE_POINT_TOLERANCE_NS: Final = 2_000_000_000
Key = tuple[str, str, str | None, str | None]


@dataclass(eq=False)
class Alarm:
    """A reported finding: the row of `finding` when it was first seen, and the time of its last failing step so far.

    `number`: 0, 1, ... in the order of the reports. `said_ns`: the newest step that was known at the report.
    """

    number: int
    row: Row
    said_ns: int
    t_end_ns: int
    is_over: bool = False
    """The rule is kept again."""
    withdrawn_ns: int | None = None
    """The newest step when the alarm was withdrawn, since a window lacked the finding; None: it was not withdrawn."""
    finding_ids: list[str] = field(default_factory=list)
    """The findings of the whole log that match the alarm; empty before the whole log is checked."""
    is_early: bool = False
    """The finding was seen in the newest frames, before a window with these frames was judged."""

    @property
    def needed_from_ns(self) -> int:
        """The earliest time that a window must contain to show the finding."""
        start, ref = int(self.row["t_start_ns"]), self.row["t_ref_ns"]
        return start if ref is None else min(start, int(ref))

    @property
    def latency_s(self) -> float:
        """Seconds of log time from the first failing step to the newest step at the report."""
        return float((self.said_ns - self.row["t_start_ns"]) / 1e9)

    def is_continued_by(self, row: Row, gap_ns: int) -> bool:
        """Return whether a finding of another window, or of the whole log, is the finding of this alarm or continues it."""
        own_row = self.row
        if own_row["t_ref_ns"] is not None or row["t_ref_ns"] is not None:
            refs = own_row["t_ref_ns"], row["t_ref_ns"]
            return None not in refs and abs(refs[0] - refs[1]) <= SAME_REFERENCE_POINT_TOLERANCE_NS
        return bool(row["t_start_ns"] <= self.t_end_ns + gap_ns and row["t_end_ns"] >= own_row["t_start_ns"] - gap_ns)


@dataclass(frozen=True)
class AlarmChanges:
    """The changes that a window causes: new alarms, alarms whose rule is kept again, and withdrawn alarms."""

    new: list[Alarm]
    over: list[Alarm]
    withdrawn: list[Alarm]


def finding_key(row: Row) -> Key:
    """Return the values that are equal in two records of the same finding."""
    return row["rule_id"], row["ego_id"], row["profile"], row["object_id"]


class AlarmLog:
    """The alarms of a watch.

    `gaps_ns`: rule -> the longest gap between failing steps of one finding. `profiles`: the profiles whose findings are alarms.
    """

    def __init__(self, gaps_ns: Mapping[str, int], profiles: Sequence[str]) -> None:
        self._gaps_ns = gaps_ns
        self._profiles = frozenset(profiles)
        self.alarms: list[Alarm] = []
        self._standing: list[Alarm] = []

    def add_contacts_and_return_new_alarms(self, rows: Sequence[Row], now_ns: int) -> list[Alarm]:
        """Add the contacts in the newest frames, up to the step at `now_ns`, and return the new alarms."""
        new: list[Alarm] = []
        for row in rows:
            same = [alarm for alarm in self._standing if self._is_same_finding(alarm, row)]
            if not same:
                same = [Alarm(len(self.alarms), row, now_ns, row["t_end_ns"], is_early=True)]
                new += same
                self.alarms += same
                self._standing += same
            for alarm in same:
                alarm.t_end_ns = max(alarm.t_end_ns, row["t_end_ns"])
        return new

    def add_window(self, window: JudgedWindow, judged_until_ns: int | None, from_ns: int | None) -> AlarmChanges:
        """Add the findings of a window, and return the changes.

        `judged_until_ns`: the last step of the previous window; None: this is the first window. `from_ns`: the start of the window, which
        may also contain earlier states that are still valid; None: the window starts with the log.
        """
        known_from_ns = window.t_start_ns if from_ns is None else max(window.t_start_ns, from_ns) + WARM_UP_NS
        is_first = judged_until_ns is None and from_ns is None
        new: list[Alarm] = []
        shown_numbers: set[int] = set()
        for row in _findings_with_reference_times(window.findings.to_pylist(), window.verdicts):
            if row["profile"] is not None and row["profile"] not in self._profiles:
                continue
            same = [alarm for alarm in self._standing if self._is_same_finding(alarm, row)]
            if not same:
                alarm = Alarm(len(self.alarms), row, window.t_end_ns, row["t_end_ns"])
                fails_now = is_first or (judged_until_ns is not None and row["t_end_ns"] > judged_until_ns)
                if alarm.needed_from_ns < known_from_ns and not fails_now:
                    continue
                for alarms in (self.alarms, self._standing, new):
                    alarms.append(alarm)
                same = [alarm]
            for alarm in same:
                alarm.t_end_ns = max(alarm.t_end_ns, row["t_end_ns"])
                shown_numbers.add(alarm.number)
        withdrawn = self._withdraw_missing_alarms(window, shown_numbers, known_from_ns)
        self._standing = [alarm for alarm in self._standing if alarm not in withdrawn]
        over = self._mark_alarms_over(window.t_end_ns)
        self._standing = [
            alarm
            for alarm in self._standing
            if not alarm.is_over or alarm.t_end_ns + self._allowed_gap_ns(alarm) >= window.t_start_ns
        ]
        return AlarmChanges(new, over, withdrawn)

    def _withdraw_missing_alarms(
        self, window: JudgedWindow, shown_numbers: Collection[int], known_from_ns: int
    ) -> list[Alarm]:
        """Return the alarms whose finding is missing in a window that covers its time. An unknown verdict or an error withdraws none."""
        silent = {
            (row["rule_id"], row["ego_id"], row["profile"])
            for row in window.verdicts.select(["rule_id", "ego_id", "profile", "verdict"]).to_pylist()
            if row["verdict"] in {"error", "unknown"}
        }
        alarms = [
            alarm
            for alarm in self._standing
            if alarm.number not in shown_numbers
            and alarm.needed_from_ns >= known_from_ns
            and alarm.row["t_start_ns"] <= window.t_end_ns
            and not {(*finding_key(alarm.row)[:2], profile) for profile in (None, alarm.row["profile"])} & silent
        ]
        for alarm in alarms:
            alarm.withdrawn_ns = window.t_end_ns
        return alarms

    def _mark_alarms_over(self, now_ns: int) -> list[Alarm]:
        """Return the alarms whose rule is kept again; an alarm that continues later can be over a second time."""
        ending = []
        for alarm in self._standing:
            ended = now_ns > alarm.t_end_ns + self._allowed_gap_ns(alarm)
            if ended and not alarm.is_over:
                ending.append(alarm)
            alarm.is_over = ended
        return ending

    def _allowed_gap_ns(self, alarm: Alarm) -> int:
        return self._gaps_ns[alarm.row["rule_id"]]

    def _is_same_finding(self, alarm: Alarm, row: Row) -> bool:
        return finding_key(alarm.row) == finding_key(row) and alarm.is_continued_by(row, self._allowed_gap_ns(alarm))

    def assign_findings_and_return_unassigned(self, findings: Sequence[Row], verdicts: pa.Table) -> list[Row]:
        """Assign the findings of the whole log to the alarms, and return the findings without an alarm.

        Withdrawn alarms are included: the whole log may confirm their findings.
        """
        by_key: dict[Key, list[Alarm]] = {}
        for alarm in self.alarms:
            by_key.setdefault(finding_key(alarm.row), []).append(alarm)
        left = []
        for row in _findings_with_reference_times(findings, verdicts):
            alarms = [
                candidate for candidate in by_key.get(finding_key(row), []) if self._is_same_finding(candidate, row)
            ]
            for alarm in alarms:
                alarm.finding_ids.append(row["finding_id"])
            if not alarms:
                left.append(row)
        return left


def _findings_with_reference_times(findings: Sequence[Row], verdicts: pa.Table) -> list[Row]:
    """Return findings with the time of their reference point, `t_ref_ns`; None without a reference point."""
    columns = ("drive_id", "rule_id", "ego_id", "ref_id")
    rows = verdicts.select([*columns, "t_ref_ns"]).to_pylist()
    times = {tuple(row[c] for c in columns): row["t_ref_ns"] for row in rows if row["ref_id"] is not None}
    return [{**row, "t_ref_ns": times.get(tuple(row[c] for c in columns))} for row in findings]
