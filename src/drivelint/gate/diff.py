"""Compares two results: which findings are new, fixed, changed, unchanged, failing elsewhere, unknown or lost in the second one."""

from __future__ import annotations

from collections import Counter, defaultdict
from dataclasses import replace
from operator import itemgetter
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import pyarrow as pa

from drivelint.gate import match
from drivelint.reasons.signals import UNRECORDED_PREFIX
from drivelint.result import counts
from drivelint.result.gate import ComparedFinding, Difference, NewUnknowns
from drivelint.result.text import ego_name, number

if TYPE_CHECKING:
    from collections.abc import Mapping

    from drivelint.gate.match import TimedFinding
    from drivelint.result.model import Result

    Row = Mapping[str, Any]

MARGIN_TOLERANCE: Final = 0.01
"""A margin counts as changed if it differs by more than this in its unit, and by more than this fraction of the required value."""
INTERVAL_TOLERANCE_S: Final = 0.1
"""A failing stretch counts as changed if its start or end moved by more than this, in seconds."""

LEAST_DURATION_SHARE: Final = 0.9
"""A drive may have been cut off if it lasts less than this fraction of its duration in the base result."""

_WEIGHT = ("error", "fail", "unknown", "pass")
"""If several verdicts apply at the same time, the first of this order is reported."""
_WHERE = ("drive_id", "ego_id", "rule_id", "profile")
_FIXED_VERDICTS = ("pass", "not_applicable")


def compare(base: Result, new: Result, base_name: str = "base", name: str = "new") -> Difference:
    """Return the difference of two results. `base_name` and `name` are shown to the reader.

    `match.match_drives` finds the drives that both results have. Findings of `new` come first, in its order, then findings that only `base`
    has.
    """
    had, has = ResultLookup(base), ResultLookup(new)
    same = match.match_drives(list(had.drives.values()), list(has.drives.values()))
    entries: list[ComparedFinding] = []
    gone: list[ComparedFinding] = []
    for drive_id in dict.fromkeys([*has.findings, *same]):
        found, left = _drive(had, has, same.get(drive_id), drive_id)
        entries += found
        gone += left
    both = [(has.drives[now], had.drives[was]) for now, was in same.items()]
    known = set(same.values())
    for drive_id, stretches in had.findings.items():
        if drive_id not in known:
            gone += [_base_only_finding(each, drive_id, has.verdict_at(None, each), had) for each in stretches]
    return Difference(
        entries=(*entries, *gone),
        new_unknowns=tuple(_new_unknowns(base, new, same, has)),
        base_verdicts=counts.verdict_counts(base.verdicts),
        verdicts=counts.verdict_counts(new.verdicts),
        base_only=tuple(sorted(drive for drive in had.drives if drive not in known)),
        new_only=tuple(sorted(drive for drive in has.drives if drive not in same)),
        base_name=base_name,
        name=name,
        undecided=_undecided(base, new, same, had),
        rules_not_run=tuple(sorted(had.rules.keys() - has.rules.keys())),
        n_both=len(same),
        other_maps=tuple(sorted(now["drive_id"] for now, was in both if now["map_sha256"] != was["map_sha256"])),
        shorter=tuple(sorted(now["drive_id"] for now, was in both if _is_much_shorter(now, was))),
    )


def _is_much_shorter(now: Row, was: Row) -> bool:
    lasts, lasted = now["duration_s"], was["duration_s"]
    return lasts is not None and lasted is not None and bool(lasts < LEAST_DURATION_SHARE * lasted)


def _drive(
    had: ResultLookup, has: ResultLookup, base_id: str | None, drive_id: str
) -> tuple[list[ComparedFinding], list[ComparedFinding]]:
    """Return the entries of one drive: for the findings of the new result, and for the findings that only the base result has."""
    theirs = [] if base_id is None else had.findings.get(base_id, [])
    ours = has.findings.get(drive_id, [])
    same_log = base_id is not None and had.drives[base_id]["sha256"] == has.drives[drive_id]["sha256"]
    pairs = match.match_findings(theirs, ours, same_log=same_log)
    told = set(pairs.values())
    entries: list[ComparedFinding] = []
    for i, now in enumerate(ours):
        if i in pairs:
            entries.append(_matched_finding(now, theirs[pairs[i]], has))
        elif wholes := [j for j, each in enumerate(theirs) if match.is_part_of(now, each, same_log=same_log)]:
            told.add(wholes[0])
            was = theirs[wholes[0]]
            said = LookupResult("fail", f"the finding {was.row['finding_id']} was split; this is a part of it")
            entries.append(_entry("changed", now, was, has, said))
        else:
            said = had.verdict_at(base_id, now)
            entries.append(_entry("new", now, None, has, _noting_rule(said, now, had, has)))
    gone: list[ComparedFinding] = []
    for was in (each for j, each in enumerate(theirs) if j not in told):
        wholes = [i for i in sorted(pairs) if match.is_part_of(was, ours[i], same_log=same_log)]
        if wholes:
            said = LookupResult("fail", f"it now contains the earlier finding {was.row['finding_id']}")
            gone.append(_entry("changed", ours[wholes[0]], was, has, said))
        else:
            said = _noting_rule(has.verdict_at(drive_id, was), was, had, has)
            gone.append(_base_only_finding(was, drive_id, said, had))
    return entries, gone


def _noting_rule(outcome: LookupResult, at: TimedFinding, had: ResultLookup, has: ResultLookup) -> LookupResult:
    """Return the outcome, with a note added if the rule or its parameters differ between the results."""
    a, b = (lookup.rules.get(at.row["rule_id"]) for lookup in (had, has))
    if a is None or b is None or (a["rule_version"], a["params"]) == (b["rule_version"], b["params"]):
        return outcome
    return outcome._replace(why=f"{outcome.why} The rule or its parameters changed.")


def _matched_finding(now: TimedFinding, was: TimedFinding, has: ResultLookup) -> ComparedFinding:
    """Return the entry of a finding that both results have, with notes on how it changed."""
    notes = []
    if now.row["severity"] != was.row["severity"]:
        notes.append(f"severity {now.row['severity']}, was {was.row['severity']}")
    if _differs(now.row, was.row):
        unit = now.row["unit"]
        notes.append(f"margin {number(now.row['margin'], unit)}, was {number(was.row['margin'], unit)}")
    if max(abs(now.start - was.start), abs(now.end - was.end)) > INTERVAL_TOLERANCE_S:
        notes.append(f"{now.start:.2f} s to {now.end:.2f} s, was {was.start:.2f} s to {was.end:.2f} s")
    return _entry("changed" if notes else "unchanged", now, was, has, LookupResult("fail", "; ".join(notes)))


def _differs(now: Row, was: Row) -> bool:
    """Return whether two margins differ by more than the tolerance."""
    a, b = now["margin"], was["margin"]
    if a is None or b is None or a == b:
        return bool(a != b)
    allowed = max(MARGIN_TOLERANCE, MARGIN_TOLERANCE * max(abs(row["required"] or 0.0) for row in (now, was)))
    return not abs(a - b) <= allowed


def _is_less(now: float | None, was: float | None) -> bool:
    return now is not None and was is not None and now < was


def _base_only_finding(was: TimedFinding, drive_id: str, outcome: LookupResult, had: ResultLookup) -> ComparedFinding:
    """Return the entry of a finding that only the base result has. Its status is `fixed` only if the new result judged the rule there as
    kept or not applicable."""
    standing = {"pass": "fixed", "not_applicable": "fixed", "none": "lost", "fail": "elsewhere"}.get(
        outcome.verdict, "unknown"
    )
    return replace(_entry(standing, was, was, had, outcome), drive_id=drive_id)


def _entry(
    standing: str, at: TimedFinding, was: TimedFinding | None, lookup: ResultLookup, outcome: LookupResult
) -> ComparedFinding:
    same = ("finding_id", "drive_id", "ego_id", "rule_id", "profile", "object_id", "severity", "margin", "unit")
    return ComparedFinding(
        standing=standing,
        **{name: at.row[name] for name in same},
        base_id=None if was is None else was.row["finding_id"],
        stable=lookup.is_stable(at.row["rule_id"]),
        t_s=round(at.worst, 3),
        base_margin=None if was is None else was.row["margin"],
        there=outcome.verdict,
        why=outcome.why,
        worse=was is not None and _is_less(at.row["margin"], was.row["margin"]) and _differs(at.row, was.row),
        event=lookup.counted_ids[at.row["finding_id"]],
    )


def _new_unknowns(base: Result, new: Result, same: Mapping[str, str], has: ResultLookup) -> list[NewUnknowns]:
    """Return where the new result has more verdicts that are unknown or in error than the base result, for drives that both have."""
    was, now = _unknown(base), _unknown(new)
    new_unknowns = []
    for (drive_id, ego_id, rule_id, profile), (n, reason) in now.items():
        if drive_id not in same:
            continue
        before, _ = was.get((same[drive_id], ego_id, rule_id, profile), (0, ""))
        if n > before:
            new_unknowns.append(
                NewUnknowns(drive_id, ego_id, rule_id, profile, has.is_stable(rule_id), n, before, reason)
            )
    return sorted(new_unknowns, key=lambda each: (each.drive_id, each.ego_id, each.rule_id, each.profile or ""))


def _unknown(result: Result) -> dict[Any, tuple[int, str]]:
    """Return (drive, ego, rule, profile) -> number of rows that are unknown or in error, and their most frequent reason."""
    open_rows = pa.concat_tables(
        [counts.undecided_verdicts(result.verdicts), counts.verdicts_lacking_signal(result.verdicts)]
    )
    rows = counts.distinct_rows(open_rows, [*_WHERE, "reason"])
    return {
        at: (sum(row["count_all"] for row in told), min((-row["count_all"], row["reason"]) for row in told)[1])
        for at, told in counts.group_rows(rows, itemgetter(*_WHERE)).items()
    }


def _undecided(base: Result, new: Result, same: Mapping[str, str], had: ResultLookup) -> dict[str, int]:
    """Return severity -> number of verdicts that changed from pass or fail to unknown or error, in drives that both have."""
    was, now = _verdict_counts(base), _verdict_counts(new)
    found: Counter[str] = Counter()
    for (drive_id, ego_id, rule_id, profile), here in now.items():
        before = was.get((same.get(drive_id), ego_id, rule_id, profile), Counter[str]())
        opened = here["unknown"] + here["error"] - before["unknown"] - before["error"]
        gone = before["pass"] + before["fail"] - here["pass"] - here["fail"]
        if min(opened, gone) > 0:
            found[had.rules[rule_id]["severity"]] += min(opened, gone)
    return {severity: found[severity] for severity in counts.SEVERITIES if found[severity]}


def _verdict_counts(result: Result) -> dict[Any, Counter[str]]:
    """Return (drive, ego, rule, profile) -> verdict -> number of rows."""
    verdict_counts: dict[Any, Counter[str]] = defaultdict(Counter)
    for row in counts.distinct_rows(result.verdicts, [*_WHERE, "verdict", "reason_code"]):
        verdict = "unknown" if row["reason_code"].startswith(UNRECORDED_PREFIX) else row["verdict"]
        verdict_counts[itemgetter(*_WHERE)(row)][verdict] += row["count_all"]
    return verdict_counts


class LookupResult(NamedTuple):
    """The verdict of a result at a time, and its reason. The verdict is `none` if the rule was not judged there."""

    verdict: str
    why: str


class ResultLookup:
    """Looks up verdicts and findings of one result by drive, ego and rule."""

    def __init__(self, result: Result) -> None:
        self.drives: dict[str, Row] = {}
        for drive in result.drives.to_pylist():
            self.drives.setdefault(drive["drive_id"], drive)
        self.rules: dict[str, Row] = {rule["rule_id"]: rule for rule in result.rules.to_pylist()}
        self._rows: dict[tuple[str, str, str], list[Row]] = defaultdict(list)
        self._egos: dict[str, set[str]] = defaultdict(set)
        self._objects: dict[str, set[str]] = defaultdict(set)
        self._recorded: dict[tuple[str, str], list[tuple[float, float]]] = defaultdict(list)
        for drive in self.drives.values():
            for each in drive["recorded"] or ():
                start, end = (match.seconds_since_start(each[name], drive) for name in ("t_from_ns", "t_to_ns"))
                self._recorded[drive["drive_id"], each["actor_id"]].append((start, end))
        columns = (
            "drive_id", "ego_id", "rule_id", "profile", "object_id", "verdict", "reason_code", "reason",
            "t_ref_ns", "t_start_ns", "t_end_ns", "t_worst_ns", "n_expected", "n_judged",
        )  # fmt: skip
        for row in result.verdicts.select(columns).to_pylist():
            self._rows[row["drive_id"], row["ego_id"], row["rule_id"]].append(row)
            self._egos[row["drive_id"]].add(row["ego_id"])
            self._objects[row["drive_id"]].add(row["object_id"])
        self.findings: dict[str, list[TimedFinding]] = defaultdict(list)
        rows = result.findings.to_pylist()
        self.counted_ids = {
            row["finding_id"]: rows[place]["finding_id"]
            for row, place in zip(rows, counts.representative_indices(rows), strict=True)
        }
        for row in rows:
            drive, ends = self.drives[row["drive_id"]], ("t_start_ns", "t_end_ns", "t_worst_ns")
            times = (match.seconds_since_start(row[name], drive) for name in ends)
            self.findings[row["drive_id"]].append(match.TimedFinding(row, *times))

    def is_stable(self, rule_id: str) -> bool:
        """Return whether a rule is stable in this result."""
        return rule_id in self.rules and self.rules[rule_id]["status"] == "stable"

    def verdict_at(self, drive_id: str | None, at: TimedFinding) -> LookupResult:
        """Return the verdict of this result at the time and place of the finding `at` of another result. `drive_id`: the drive's id in this
        result.

        The verdicts pass and not applicable count only where ego and object are recorded.
        """
        row = at.row
        if gap := self._why_not_judged(drive_id, row):
            return gap
        assert drive_id is not None  # noqa: S101 - for the type checker: without a drive, _why_not_judged has returned a result
        drive = self.drives[drive_id]
        if drive["duration_s"] is not None and at.worst > drive["duration_s"] + match.NEAR_S:
            return LookupResult("none", "the log ends before the finding")
        rows = self._rows.get((drive_id, row["ego_id"], row["rule_id"]), [])
        rows = [each for each in rows if each["profile"] in {row["profile"], None}]
        if not rows:
            return LookupResult("none", "the rule has no verdict")
        there = [each for each in rows if self._about(each, row, drive_id) and _overlaps(each, at, drive)]
        said = [judged for each in there if (judged := self._outcome_of(each, at)).verdict in _WEIGHT]
        not_applicable = LookupResult(
            "not_applicable", there[0]["reason"] if there else "The rule does not apply there."
        )
        found = min(said, key=lambda each: _WEIGHT.index(each.verdict), default=not_applicable)
        if found.verdict in _FIXED_VERDICTS and (missing := self._not_recorded(drive_id, at)):
            return missing
        return found

    def _not_recorded(self, drive_id: str, at: TimedFinding) -> LookupResult | None:
        """Return an outcome if the ego or the object is not recorded at the finding; None: both are recorded."""
        for what in ("ego", "object"):
            actor = at.row[f"{what}_id"]
            stretches = self._recorded.get((drive_id, actor), ())
            if actor is None or match.is_recorded(stretches, at):
                continue
            if not stretches:
                return LookupResult("none", f"{what} {actor} is not in this log, or has another id")
            times = ", ".join(f"{start:.2f} s to {end:.2f} s" for start, end in stretches[:3])
            more = f" and {len(stretches) - 3} more times" if len(stretches) > 3 else ""
            return LookupResult("unknown", f"{what} {actor} is recorded only from {times}{more}")
        return None

    def _outcome_of(self, verdict: Row, at: TimedFinding) -> LookupResult:
        """Return what a verdict means at the time of the finding. A verdict `fail` means a failure only in its failing stretches."""
        if verdict["reason_code"].startswith(UNRECORDED_PREFIX):
            return LookupResult("unknown", verdict["reason"])
        if verdict["verdict"] != "fail":
            return LookupResult(verdict["verdict"], verdict["reason"])
        mine = self.findings.get(verdict["drive_id"], ())
        alike = [other for other in mine if match.finding_key(other.row) == match.finding_key(at.row)]
        if any(match.gap_s(other, at) <= match.NEAR_S for other in alike):
            return LookupResult("fail", "the rule still fails, at another step or place")
        if verdict["n_judged"] == verdict["n_expected"]:
            return LookupResult("pass", "the rule is kept at this time, but broken at another time of the same verdict")
        missing = verdict["n_expected"] - verdict["n_judged"]
        why = f"the rule fails at another time, and {missing} of {verdict['n_expected']} steps were not judged"
        return LookupResult("unknown", why)

    def _why_not_judged(self, drive_id: str | None, row: Row) -> LookupResult | None:
        """Return the reason why the rule was not judged in the drive, as the result of a lookup; None: it was judged."""
        if drive_id is None:
            return LookupResult("none", "the drive was not checked")
        drive, rule = self.drives[drive_id], self.rules.get(row["rule_id"])
        if drive["status"] == "not_judged":
            why = f"the drive could not be judged: {drive['status_reason'] or 'no reason given'}"
            return LookupResult("unknown", why)
        if rule is None:
            return LookupResult("none", "the rule was not run")
        if row["profile"] is not None and row["profile"] not in rule["profiles"]:
            return LookupResult("none", f"the profile {row['profile']} was not run")
        if row["ego_id"] not in self._egos[drive_id]:
            return LookupResult("none", f"{ego_name(row['ego_id'])} was not judged")
        return None

    def _about(self, verdict: Row, row: Row, drive_id: str) -> bool:
        """Return whether a verdict concerns the object of a finding. If this result lacks the object, an undecided verdict about any object
        counts."""
        if verdict["object_id"] is None or row["object_id"] is None or verdict["object_id"] == row["object_id"]:
            return True
        return verdict["verdict"] in {"unknown", "error"} and row["object_id"] not in self._objects[drive_id]


def _overlaps(verdict: Row, at: TimedFinding, drive: Row) -> bool:
    """Return whether a verdict covers a finding's time. A verdict without times covers the whole drive."""
    times = [t for name in ("t_ref_ns", "t_start_ns", "t_end_ns", "t_worst_ns") if (t := verdict[name]) is not None]
    if not times:
        return True
    start, end = match.seconds_since_start(min(times), drive), match.seconds_since_start(max(times), drive)
    return start - match.NEAR_S <= at.end and at.start <= end + match.NEAR_S
