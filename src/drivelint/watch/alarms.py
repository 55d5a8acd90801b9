"""Finds which findings of a window are new, and stores those that were reported.

Windows overlap, so a finding is seen again and again. It is the same finding if rule, profile, ego and object are the same, and its
failing steps follow those that were reported. A reference point that moved a little is the same, too.
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
"""In the first seconds of a window that is not the log's beginning the past is missing that some rules need."""
SAME_REFERENCE_NS: Final = 2_000_000_000
Key = tuple[str, str, str | None, str | None]


@dataclass(eq=False)
class Alarm:
    """A finding as it was when it was first seen: a row of `finding`, and until when it was seen to fail.

    `number`: 0.. in the order in which alarms were said. `said_ns`: the newest step that was known then.
    """

    number: int
    row: Row
    said_ns: int
    t_end_ns: int
    is_over: bool = False
    """Its rule is kept again."""
    withdrawn_ns: int | None = None
    """The newest step that was known when a window did not show it any more."""
    finding_ids: list[str] = field(default_factory=list)
    """The findings of the whole log that it is of, once they are known."""
    is_early: bool = False
    """It was seen in the newest frames, before a window with them was judged."""

    @property
    def from_ns(self) -> int:
        """The time from which on a window must know the drive to show it."""
        start, ref = int(self.row["t_start_ns"]), self.row["t_ref_ns"]
        return start if ref is None else min(start, int(ref))

    @property
    def latency_s(self) -> float:
        """Seconds of log time from the first failing step to the step at which it was reported."""
        return float((self.said_ns - self.row["t_start_ns"]) / 1e9)

    def is_seen_in(self, row: Row, gap_ns: int) -> bool:
        """Whether a finding of another window, or of the whole log, is this one or goes on with it."""
        mine = self.row
        if mine["t_ref_ns"] is not None or row["t_ref_ns"] is not None:
            refs = mine["t_ref_ns"], row["t_ref_ns"]
            return None not in refs and abs(refs[0] - refs[1]) <= SAME_REFERENCE_NS
        return bool(row["t_start_ns"] <= self.t_end_ns + gap_ns and row["t_end_ns"] >= mine["t_start_ns"] - gap_ns)


@dataclass(frozen=True)
class Change:
    """The changes of a window: new alarms, alarms whose rule is kept again, and alarms that it does not show any more."""

    new: list[Alarm]
    over: list[Alarm]
    withdrawn: list[Alarm]


def key_of(row: Row) -> Key:
    """Return the values that two findings must share to be one."""
    return row["rule_id"], row["ego_id"], row["profile"], row["object_id"]


class AlarmLog:
    """The alarms of a watch.

    `gaps_ns`: rule -> within how much time failing steps are one finding. `profiles`: those whose findings are alarms.
    """

    def __init__(self, gaps_ns: Mapping[str, int], profiles: Sequence[str]) -> None:
        self._gaps_ns = gaps_ns
        self._profiles = frozenset(profiles)
        self.alarms: list[Alarm] = []
        self._standing: list[Alarm] = []

    def look(self, rows: Sequence[Row], now_ns: int) -> list[Alarm]:
        """Take the contacts in the newest frames, up to the step at `now_ns`; return the new alarms."""
        new: list[Alarm] = []
        for row in rows:
            same = [each for each in self._standing if self._is_same(each, row)]
            if not same:
                same = [Alarm(len(self.alarms), row, now_ns, row["t_end_ns"], is_early=True)]
                new += same
                self.alarms += same
                self._standing += same
            for each in same:
                each.t_end_ns = max(each.t_end_ns, row["t_end_ns"])
        return new

    def take(self, window: JudgedWindow, judged_until_ns: int | None, from_ns: int | None) -> Change:
        """Take the findings of a window; return the changes.

        `judged_until_ns`: the last step of the window before; None: this is the first. `from_ns`: the window's own beginning, before which
        it may have single states that still hold; None: it begins where the log does.
        """
        known_from_ns = window.t_start_ns if from_ns is None else max(window.t_start_ns, from_ns) + WARM_UP_NS
        is_first = judged_until_ns is None and from_ns is None
        new: list[Alarm] = []
        shown_numbers: set[int] = set()
        for row in _with_reference_times(window.findings.to_pylist(), window.verdicts):
            if row["profile"] is not None and row["profile"] not in self._profiles:
                continue
            same = [each for each in self._standing if self._is_same(each, row)]
            if not same:
                alarm = Alarm(len(self.alarms), row, window.t_end_ns, row["t_end_ns"])
                fails_now = is_first or (judged_until_ns is not None and row["t_end_ns"] > judged_until_ns)
                if alarm.from_ns < known_from_ns and not fails_now:
                    continue
                for alarms in (self.alarms, self._standing, new):
                    alarms.append(alarm)
                same = [alarm]
            for each in same:
                each.t_end_ns = max(each.t_end_ns, row["t_end_ns"])
                shown_numbers.add(each.number)
        withdrawn = self._withdrawn(window, shown_numbers, known_from_ns)
        self._standing = [each for each in self._standing if each not in withdrawn]
        over = self._over(window.t_end_ns)
        self._standing = [
            each
            for each in self._standing
            if not each.is_over or each.t_end_ns + self._gap_ns(each) >= window.t_start_ns
        ]
        return Change(new, over, withdrawn)

    def _withdrawn(self, window: JudgedWindow, shown_numbers: Collection[int], known_from_ns: int) -> list[Alarm]:
        """Return the alarms that a window knows and does not show. A rule that says nothing in it withdraws none."""
        silent = {
            (row["rule_id"], row["ego_id"], row["profile"])
            for row in window.verdicts.select(["rule_id", "ego_id", "profile", "verdict"]).to_pylist()
            if row["verdict"] in {"error", "unknown"}
        }
        found = [
            each
            for each in self._standing
            if each.number not in shown_numbers
            and each.from_ns >= known_from_ns
            and each.row["t_start_ns"] <= window.t_end_ns
            and not {(*key_of(each.row)[:2], profile) for profile in (None, each.row["profile"])} & silent
        ]
        for alarm in found:
            alarm.withdrawn_ns = window.t_end_ns
        return found

    def _over(self, now_ns: int) -> list[Alarm]:
        """Return the alarms whose rule is kept again; one that goes on after all can be over once more."""
        found = []
        for each in self._standing:
            ended = now_ns > each.t_end_ns + self._gap_ns(each)
            if ended and not each.is_over:
                found.append(each)
            each.is_over = ended
        return found

    def _gap_ns(self, alarm: Alarm) -> int:
        return self._gaps_ns[alarm.row["rule_id"]]

    def _is_same(self, alarm: Alarm, row: Row) -> bool:
        return key_of(alarm.row) == key_of(row) and alarm.is_seen_in(row, self._gap_ns(alarm))

    def hold_against(self, findings: Sequence[Row], verdicts: pa.Table) -> list[Row]:
        """Assign to each alarm its findings of the whole log; return the findings without an alarm.

        Whether it was withdrawn does not matter here: what is a finding in the end was one.
        """
        by_key: dict[Key, list[Alarm]] = {}
        for alarm in self.alarms:
            by_key.setdefault(key_of(alarm.row), []).append(alarm)
        left = []
        for row in _with_reference_times(findings, verdicts):
            mine = [each for each in by_key.get(key_of(row), []) if self._is_same(each, row)]
            for alarm in mine:
                alarm.finding_ids.append(row["finding_id"])
            if not mine:
                left.append(row)
        return left


def _with_reference_times(findings: Sequence[Row], verdicts: pa.Table) -> list[Row]:
    """Return findings with the time of their reference point, `t_ref_ns`, None where they have none."""
    columns = ("drive_id", "rule_id", "ego_id", "ref_id")
    rows = verdicts.select([*columns, "t_ref_ns"]).to_pylist()
    times = {tuple(row[c] for c in columns): row["t_ref_ns"] for row in rows if row["ref_id"] is not None}
    return [{**row, "t_ref_ns": times.get(tuple(row[c] for c in columns))} for row in findings]
