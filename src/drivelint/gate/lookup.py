"""Looks up the verdict of one result at the time of another result's finding."""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, Any, NamedTuple

from drivelint.gate import match

if TYPE_CHECKING:
    from collections.abc import Mapping

    from drivelint.gate.match import TimedFinding
    from drivelint.result.model import Result

    Row = Mapping[str, Any]

_WEIGHT = ("error", "fail", "unknown", "pass")
"""Of several verdicts at one moment the first of these is what is said."""


class LookupResult(NamedTuple):
    """The verdict of a result at a time, or `none` if the rule was not judged there, and the reason."""

    verdict: str
    why: str


class ResultLookup:
    """Verdicts and findings of one result, indexed by drive, ego and rule."""

    def __init__(self, result: Result) -> None:
        self.drives: dict[str, Row] = {}
        for drive in result.drives.to_pylist():
            self.drives.setdefault(drive["drive_id"], drive)
        self.rules: dict[str, Row] = {rule["rule_id"]: rule for rule in result.rules.to_pylist()}
        self._rows: dict[tuple[str, str, str], list[Row]] = defaultdict(list)
        self._egos: dict[str, set[str]] = defaultdict(set)
        self._objects: dict[str, set[str]] = defaultdict(set)
        columns = (
            "drive_id", "ego_id", "rule_id", "profile", "object_id", "verdict", "reason",
            "t_ref_ns", "t_start_ns", "t_end_ns", "t_worst_ns", "n_expected", "n_judged",
        )  # fmt: skip
        for row in result.verdicts.select(columns).to_pylist():
            self._rows[row["drive_id"], row["ego_id"], row["rule_id"]].append(row)
            self._egos[row["drive_id"]].add(row["ego_id"])
            self._objects[row["drive_id"]].add(row["object_id"])
        self.findings: dict[str, list[TimedFinding]] = defaultdict(list)
        for row in result.findings.to_pylist():
            self.findings[row["drive_id"]].append(match.timed_finding(row, self.drives[row["drive_id"]]))

    def is_stable(self, rule_id: str) -> bool:
        """Return whether this result's rule of that id is stable."""
        return rule_id in self.rules and self.rules[rule_id]["status"] == "stable"

    def verdict_at(self, drive_id: str | None, at: TimedFinding, *, same_log: bool) -> LookupResult:
        """Return the verdict of this result where another result has the finding `at`; `drive_id` is the drive's id in this result."""
        row = at.row
        if gap := self._not_looked(drive_id, row):
            return gap
        assert drive_id is not None  # noqa: S101 - for the type checker: else there is a gap
        drive = self.drives[drive_id]
        if drive["duration_s"] is not None and at.worst > drive["duration_s"] + match.NEAR_S:
            return LookupResult("none", "the log ends before it")
        rows = self._rows.get((drive_id, row["ego_id"], row["rule_id"]), [])
        rows = [each for each in rows if each["profile"] in {row["profile"], None}]
        if not rows:
            return LookupResult("none", "there is no verdict of this rule")
        there = [each for each in rows if self._about(each, row, drive_id) and _overlaps(each, at, drive)]
        said = [judged for each in there if (judged := self._judged(each, at)).verdict in _WEIGHT]
        if said:
            return min(said, key=lambda each: _WEIGHT.index(each.verdict))
        if not same_log and row["object_id"] not in self._objects[drive_id]:
            return LookupResult("none", f"object {row['object_id']} is not in this log, or has another id")
        return LookupResult("not_applicable", there[0]["reason"] if there else "The rule does not apply there.")

    def _judged(self, each: Row, at: TimedFinding) -> LookupResult:
        """Return what a verdict means for the moment: one that fails does so in its failing stretches only."""
        if each["verdict"] != "fail":
            return LookupResult(each["verdict"], each["reason"])
        mine = self.findings.get(each["drive_id"], ())
        alike = [other for other in mine if match.finding_key(other.row) == match.finding_key(at.row)]
        if any(match.gap_s(other, at) <= match.NEAR_S for other in alike):
            return LookupResult("fail", "the rule fails there still, at another step or place")
        if each["n_judged"] == each["n_expected"]:
            return LookupResult("pass", "kept there, though not at another time of the same stretch of driving")
        missing = each["n_expected"] - each["n_judged"]
        return LookupResult(
            "unknown", f"the rule fails at another time, and {missing} of {each['n_expected']} steps were not judged"
        )

    def _not_looked(self, drive_id: str | None, row: Row) -> LookupResult | None:
        """Return why the rule was not judged in the drive at all; None: it was."""
        if drive_id is None:
            return LookupResult("none", "the drive was not checked")
        drive, rule = self.drives[drive_id], self.rules.get(row["rule_id"])
        if drive["status"] == "not_judged":
            return LookupResult(
                "unknown", f"the drive could not be judged: {drive['status_reason'] or 'no reason given'}"
            )
        if rule is None:
            return LookupResult("none", "the rule was not run")
        if row["profile"] is not None and row["profile"] not in rule["profiles"]:
            return LookupResult("none", f"the profile {row['profile']} was not run")
        if row["ego_id"] not in self._egos[drive_id]:
            return LookupResult("none", f"ego {row['ego_id']} was not judged")
        return None

    def _about(self, each: Row, row: Row, drive_id: str) -> bool:
        """Return whether a verdict concerns the object of a finding; if that is gone here, any object that is not judged."""
        if each["object_id"] is None or row["object_id"] is None or each["object_id"] == row["object_id"]:
            return True
        return each["verdict"] in {"unknown", "error"} and row["object_id"] not in self._objects[drive_id]


def _overlaps(each: Row, at: TimedFinding, drive: Row) -> bool:
    """Return whether a verdict covers a finding's time; one without times covers the drive."""
    times = [t for name in ("t_ref_ns", "t_start_ns", "t_end_ns", "t_worst_ns") if (t := each[name]) is not None]
    if not times:
        return True
    start, end = match.seconds_since_start(min(times), drive), match.seconds_since_start(max(times), drive)
    return start - match.NEAR_S <= at.end and at.start <= end + match.NEAR_S
