"""Tells which findings of a window are new, and keeps those that were said.

Windows overlap, so a finding is seen again and again. It is the same where rule, profile, ego and object are, and its failing steps
follow those that were said. A reference point that moved a little is the same, too.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

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
    finding_ids: list[str] = field(default_factory=list)
    """The findings of the whole log that it is of, once they are known."""

    @property
    def latency_s(self) -> float:
        """Seconds of log time from the first failing step to the step with which it was said."""
        return float((self.said_ns - self.row["t_start_ns"]) / 1e9)

    def is_seen_in(self, row: Row, gap_ns: int) -> bool:
        """Whether a finding of another window, or of the whole log, is this one or goes on with it."""
        mine = self.row
        if mine["t_ref_ns"] is not None or row["t_ref_ns"] is not None:
            refs = mine["t_ref_ns"], row["t_ref_ns"]
            return None not in refs and abs(refs[0] - refs[1]) <= SAME_REFERENCE_NS
        return bool(row["t_start_ns"] <= self.t_end_ns + gap_ns and row["t_end_ns"] >= mine["t_start_ns"] - gap_ns)


def key_of(row: Row) -> Key:
    """Return what two findings must have in common to be one."""
    return row["rule_id"], row["ego_id"], row["profile"], row["object_id"]


class AlarmLog:
    """The alarms of a watch.

    `gaps_ns`: rule -> within how much time failing steps are one finding. `profiles`: those whose findings are alarms.
    """

    def __init__(self, gaps_ns: Mapping[str, int], profiles: Sequence[str]) -> None:
        self._gaps_ns = gaps_ns
        self._profiles = frozenset(profiles)
        self.alarms: list[Alarm] = []
        self._open: list[Alarm] = []
        self._by_key: dict[Key, list[Alarm]] = {}

    def take(
        self, window: JudgedWindow, judged_until_ns: int | None, *, is_whole: bool
    ) -> tuple[list[Alarm], list[Alarm]]:
        """Take the findings of a window; return the alarms that are new, and those that are over.

        `judged_until_ns`: the last step of the window before; None: this is the first. `is_whole`: it begins where the log does.
        """
        refs = {
            (v["rule_id"], v["ego_id"], v["ref_id"]): v["t_ref_ns"]
            for v in window.verdicts.select(["rule_id", "ego_id", "ref_id", "t_ref_ns"]).to_pylist()
            if v["ref_id"] is not None
        }
        new: list[Alarm] = []
        for row in window.findings.to_pylist():
            row["t_ref_ns"] = refs.get((row["rule_id"], row["ego_id"], row["ref_id"]))
            if row["profile"] is not None and row["profile"] not in self._profiles:
                continue
            mine = self._by_key.setdefault(key_of(row), [])
            same = next((a for a in mine if a.is_seen_in(row, self._gap_ns(row))), None)
            if same is not None:
                same.t_end_ns = max(same.t_end_ns, row["t_end_ns"])
                continue
            at = row["t_start_ns"] if row["t_ref_ns"] is None else min(row["t_ref_ns"], row["t_start_ns"])
            fails_now = judged_until_ns is None or row["t_end_ns"] > judged_until_ns
            if not is_whole and at < window.t_start_ns + WARM_UP_NS and not fails_now:
                continue
            alarm = Alarm(len(self.alarms), row, window.t_end_ns, row["t_end_ns"])
            self.alarms.append(alarm)
            self._open.append(alarm)
            mine.append(alarm)
            new.append(alarm)
        return new, self._ended(window.t_end_ns)

    def _ended(self, now_ns: int) -> list[Alarm]:
        over = [each for each in self._open if now_ns > each.t_end_ns + self._gap_ns(each.row)]
        self._open = [each for each in self._open if each not in over]
        return over

    def _gap_ns(self, row: Row) -> int:
        return self._gaps_ns[row["rule_id"]]

    def hold_against(self, findings: Sequence[dict[str, Any]], verdicts: Sequence[Row]) -> list[dict[str, Any]]:
        """Tell each alarm of which findings of the whole log it is; return the findings that no alarm is of."""
        refs = {(v["rule_id"], v["ego_id"], v["ref_id"]): v["t_ref_ns"] for v in verdicts if v["ref_id"] is not None}
        left: list[dict[str, Any]] = []
        for row in findings:
            row["t_ref_ns"] = refs.get((row["rule_id"], row["ego_id"], row["ref_id"]))
            mine = [a for a in self._by_key.get(key_of(row), []) if a.is_seen_in(row, self._gap_ns(row))]
            for alarm in mine:
                alarm.finding_ids.append(row["finding_id"])
            if not mine:
                left.append(row)
        return left
