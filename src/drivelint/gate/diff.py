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

UNCHANGED_MARGIN_TOLERANCE: Final = 0.01
"""A margin counts as changed if it differs by more than this in its unit, and by more than this fraction of the required value."""
UNCHANGED_INTERVAL_TOLERANCE_S: Final = 0.1
"""A failing stretch counts as changed if its start or end moved by more than this, in seconds."""

LEAST_DURATION_SHARE_OF_BASE_DRIVE: Final = 0.9
"""A drive may have been cut off if it lasts less than this fraction of its duration in the base result."""

_VERDICTS_BY_WEIGHT = ("error", "fail", "unknown", "pass")
"""If several verdicts apply at the same time, the first of this order is reported."""
_PLACE_COLUMNS = ("drive_id", "ego_id", "rule_id", "profile")
_FIXED_VERDICTS = ("pass", "not_applicable")


def compare(base: Result, new: Result, base_name: str = "base", name: str = "new") -> Difference:
    """Return the difference of two results. `base_name` and `name` are shown to the reader.

    `match.base_drive_by_new_drive` finds the drives that both results have. Findings of `new` come first, in its order, then findings that
    only `base` has.
    """
    base_lookup, new_lookup = ResultLookup(base), ResultLookup(new)
    base_id_by_new_id = match.base_drive_by_new_drive(
        list(base_lookup.drives.values()), list(new_lookup.drives.values())
    )
    entries: list[ComparedFinding] = []
    base_only_entries: list[ComparedFinding] = []
    for drive_id in dict.fromkeys([*new_lookup.findings, *base_id_by_new_id]):
        new_entries, left = _entries_of_drive(base_lookup, new_lookup, base_id_by_new_id.get(drive_id), drive_id)
        entries += new_entries
        base_only_entries += left
    pairs = [(new_lookup.drives[now], base_lookup.drives[was]) for now, was in base_id_by_new_id.items()]
    matched_drives = set(base_id_by_new_id.values())
    for drive_id, stretches in base_lookup.findings.items():
        if drive_id not in matched_drives:
            base_only_entries += [
                _base_only_finding(was, drive_id, new_lookup.verdict_at(None, was), base_lookup) for was in stretches
            ]
    return Difference(
        entries=(*entries, *base_only_entries),
        new_unknowns=tuple(_new_unknowns(base, new, base_id_by_new_id, new_lookup)),
        base_verdicts=counts.verdict_counts(base.verdicts),
        verdicts=counts.verdict_counts(new.verdicts),
        base_only=tuple(sorted(drive for drive in base_lookup.drives if drive not in matched_drives)),
        new_only=tuple(sorted(drive for drive in new_lookup.drives if drive not in base_id_by_new_id)),
        base_name=base_name,
        name=name,
        undecided=_newly_undecided_counts(base, new, base_id_by_new_id, base_lookup),
        rules_not_run=tuple(sorted(base_lookup.rules.keys() - new_lookup.rules.keys())),
        n_both=len(base_id_by_new_id),
        other_maps=tuple(sorted(now["drive_id"] for now, was in pairs if now["map_sha256"] != was["map_sha256"])),
        shorter=tuple(sorted(now["drive_id"] for now, was in pairs if _is_drive_much_shorter(now, was))),
        changed_rules=tuple(name for name in sorted(new_lookup.rules) if _is_changed(name, base_lookup, new_lookup)),
    )


def _is_drive_much_shorter(now: Row, was: Row) -> bool:
    lasts, lasted = now["duration_s"], was["duration_s"]
    return lasts is not None and lasted is not None and bool(lasts < LEAST_DURATION_SHARE_OF_BASE_DRIVE * lasted)


def _entries_of_drive(
    base_lookup: ResultLookup, new_lookup: ResultLookup, base_id: str | None, drive_id: str
) -> tuple[list[ComparedFinding], list[ComparedFinding]]:
    """Return the entries of one drive: for the findings of the new result, and for the findings that only the base result has."""
    base_findings = [] if base_id is None else base_lookup.findings.get(base_id, [])
    new_findings = new_lookup.findings.get(drive_id, [])
    same_log = base_id is not None and base_lookup.drives[base_id]["sha256"] == new_lookup.drives[drive_id]["sha256"]
    pairs = match.match_findings(base_findings, new_findings, same_log=same_log)
    matched = set(pairs.values())
    entries: list[ComparedFinding] = []
    for i, now in enumerate(new_findings):
        if i in pairs:
            entries.append(_matched_finding(now, base_findings[pairs[i]], new_lookup))
        elif wholes := [j for j, was in enumerate(base_findings) if match.is_part_of(now, was, same_log=same_log)]:
            matched.add(wholes[0])
            was = base_findings[wholes[0]]
            outcome = VerdictAndReason("fail", f"the finding {was.row['finding_id']} was split; this is a part of it")
            entries.append(_compared_finding("changed", now, was, new_lookup, outcome))
        else:
            outcome = base_lookup.verdict_at(base_id, now)
            entries.append(
                _compared_finding(
                    "new", now, None, new_lookup, _outcome_with_rule_note(outcome, now, base_lookup, new_lookup)
                )
            )
    base_only: list[ComparedFinding] = []
    for was in (finding for j, finding in enumerate(base_findings) if j not in matched):
        wholes = [i for i in sorted(pairs) if match.is_part_of(was, new_findings[i], same_log=same_log)]
        if wholes:
            outcome = VerdictAndReason("fail", f"it now contains the earlier finding {was.row['finding_id']}")
            base_only.append(_compared_finding("changed", new_findings[wholes[0]], was, new_lookup, outcome))
        else:
            outcome = _outcome_with_rule_note(new_lookup.verdict_at(drive_id, was), was, base_lookup, new_lookup)
            base_only.append(_base_only_finding(was, drive_id, outcome, base_lookup))
    return entries, base_only


def _outcome_with_rule_note(
    outcome: VerdictAndReason, finding: TimedFinding, base_lookup: ResultLookup, new_lookup: ResultLookup
) -> VerdictAndReason:
    """Return the outcome, with a note added if the rule or its parameters differ between the results."""
    if not _is_changed(finding.row["rule_id"], base_lookup, new_lookup):
        return outcome
    return outcome._replace(why=f"{outcome.why} The rule or its parameters changed.")


def _is_changed(rule_id: str, base_lookup: ResultLookup, new_lookup: ResultLookup) -> bool:
    a, b = (lookup.rules.get(rule_id) for lookup in (base_lookup, new_lookup))
    return a is not None and b is not None and (a["rule_version"], a["params"]) != (b["rule_version"], b["params"])


def _matched_finding(now: TimedFinding, was: TimedFinding, new_lookup: ResultLookup) -> ComparedFinding:
    """Return the entry of a finding that both results have, with notes on how it changed."""
    notes = []
    if now.row["severity"] != was.row["severity"]:
        notes.append(f"severity {now.row['severity']}, was {was.row['severity']}")
    if _margins_differ(now.row, was.row):
        unit = now.row["unit"]
        notes.append(f"margin {number(now.row['margin'], unit)}, was {number(was.row['margin'], unit)}")
    if max(abs(now.start_s - was.start_s), abs(now.end_s - was.end_s)) > UNCHANGED_INTERVAL_TOLERANCE_S:
        notes.append(f"{now.start_s:.2f} s to {now.end_s:.2f} s, was {was.start_s:.2f} s to {was.end_s:.2f} s")
    return _compared_finding(
        "changed" if notes else "unchanged", now, was, new_lookup, VerdictAndReason("fail", "; ".join(notes))
    )


def _margins_differ(now: Row, was: Row) -> bool:
    """Return whether two margins differ by more than the tolerance."""
    a, b = now["margin"], was["margin"]
    if a is None or b is None or a == b:
        return bool(a != b)
    tolerance = max(
        UNCHANGED_MARGIN_TOLERANCE, UNCHANGED_MARGIN_TOLERANCE * max(abs(row["required"] or 0.0) for row in (now, was))
    )
    return not abs(a - b) <= tolerance


def _is_less(now: float | None, was: float | None) -> bool:
    return now is not None and was is not None and now < was


def _base_only_finding(
    was: TimedFinding, drive_id: str, outcome: VerdictAndReason, base_lookup: ResultLookup
) -> ComparedFinding:
    """Return the entry of a finding that only the base result has. Its status is `fixed` only if the new result judged the rule there as
    kept or not applicable."""
    standing = {"pass": "fixed", "not_applicable": "fixed", "none": "lost", "fail": "elsewhere"}.get(
        outcome.verdict, "unknown"
    )
    return replace(_compared_finding(standing, was, was, base_lookup, outcome), drive_id=drive_id)


def _compared_finding(
    standing: str,
    finding: TimedFinding,
    base_finding: TimedFinding | None,
    lookup: ResultLookup,
    outcome: VerdictAndReason,
) -> ComparedFinding:
    same = ("finding_id", "drive_id", "ego_id", "rule_id", "profile", "object_id", "severity", "margin", "unit")
    return ComparedFinding(
        standing=standing,
        **{name: finding.row[name] for name in same},
        base_id=None if base_finding is None else base_finding.row["finding_id"],
        stable=lookup.is_stable(finding.row["rule_id"]),
        t_s=round(finding.worst_s, 3),
        base_margin=None if base_finding is None else base_finding.row["margin"],
        there=outcome.verdict,
        why=outcome.why,
        worse=base_finding is not None
        and _is_less(finding.row["margin"], base_finding.row["margin"])
        and _margins_differ(finding.row, base_finding.row),
        event=lookup.counted_ids[finding.row["finding_id"]],
    )


def _new_unknowns(
    base: Result, new: Result, base_id_by_new_id: Mapping[str, str], new_lookup: ResultLookup
) -> list[NewUnknowns]:
    """Return where the new result has more verdicts that are unknown or in error than the base result, for drives that both have."""
    was, now = _unknown_counts_and_reasons(base), _unknown_counts_and_reasons(new)
    new_unknowns = []
    for (drive_id, ego_id, rule_id, profile), (n, reason) in now.items():
        if drive_id not in base_id_by_new_id:
            continue
        before, _ = was.get((base_id_by_new_id[drive_id], ego_id, rule_id, profile), (0, ""))
        if n > before:
            new_unknowns.append(
                NewUnknowns(drive_id, ego_id, rule_id, profile, new_lookup.is_stable(rule_id), n, before, reason)
            )
    return sorted(new_unknowns, key=lambda row: (row.drive_id, row.ego_id, row.rule_id, row.profile or ""))


def _unknown_counts_and_reasons(result: Result) -> dict[Any, tuple[int, str]]:
    """Return (drive, ego, rule, profile) -> number of rows that are unknown or in error, and their most frequent reason."""
    open_rows = pa.concat_tables(
        [counts.undecided_verdicts(result.verdicts), counts.verdicts_lacking_signal(result.verdicts)]
    )
    rows = counts.distinct_rows(open_rows, [*_PLACE_COLUMNS, "reason"])
    return {
        at: (sum(row["count_all"] for row in reasons), min((-row["count_all"], row["reason"]) for row in reasons)[1])
        for at, reasons in counts.group_rows(rows, itemgetter(*_PLACE_COLUMNS)).items()
    }


def _newly_undecided_counts(
    base: Result, new: Result, base_id_by_new_id: Mapping[str, str], base_lookup: ResultLookup
) -> dict[str, int]:
    """Return severity -> number of verdicts that changed from pass or fail to unknown or error, in drives that both have."""
    was, now = _verdict_counts(base), _verdict_counts(new)
    n_by_severity: Counter[str] = Counter()
    for (drive_id, ego_id, rule_id, profile), here in now.items():
        before = was.get((base_id_by_new_id.get(drive_id), ego_id, rule_id, profile), Counter[str]())
        n_more_unknown = here["unknown"] + here["error"] - before["unknown"] - before["error"]
        n_less_decided = before["pass"] + before["fail"] - here["pass"] - here["fail"]
        if min(n_more_unknown, n_less_decided) > 0:
            n_by_severity[base_lookup.rules[rule_id]["severity"]] += min(n_more_unknown, n_less_decided)
    return {severity: n_by_severity[severity] for severity in counts.SEVERITIES if n_by_severity[severity]}


def _verdict_counts(result: Result) -> dict[Any, Counter[str]]:
    """Return (drive, ego, rule, profile) -> verdict -> number of rows."""
    verdict_counts: dict[Any, Counter[str]] = defaultdict(Counter)
    for row in counts.distinct_rows(result.verdicts, [*_PLACE_COLUMNS, "verdict", "reason_code"]):
        verdict = "unknown" if row["reason_code"].startswith(UNRECORDED_PREFIX) else row["verdict"]
        verdict_counts[itemgetter(*_PLACE_COLUMNS)(row)][verdict] += row["count_all"]
    return verdict_counts


class VerdictAndReason(NamedTuple):
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
            for span in drive["recorded"] or ():
                start, end = (match.seconds_since_start(span[name], drive) for name in ("t_from_ns", "t_to_ns"))
                self._recorded[drive["drive_id"], span["actor_id"]].append((start, end))
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

    def verdict_at(self, drive_id: str | None, finding: TimedFinding) -> VerdictAndReason:
        """Return the verdict of this result at the time and place of a finding of another result.

        `drive_id`: the drive's id in this result. The verdicts pass and not applicable count only where ego and object are recorded.
        """
        row = finding.row
        if gap := self._outcome_if_not_judged(drive_id, row):
            return gap
        assert drive_id is not None  # noqa: S101 - for the type checker: without a drive, _outcome_if_not_judged has returned a result
        drive = self.drives[drive_id]
        if (
            drive["duration_s"] is not None
            and finding.worst_s > drive["duration_s"] + match.MOST_TIME_BETWEEN_MATCHED_FINDINGS_S
        ):
            return VerdictAndReason("none", "the log ends before the finding")
        rows = self._rows.get((drive_id, row["ego_id"], row["rule_id"]), [])
        rows = [verdict for verdict in rows if verdict["profile"] in {row["profile"], None}]
        if not rows:
            return VerdictAndReason("none", "the rule has no verdict")
        there = [v for v in rows if self._concerns_object(v, row, drive_id) and _covers_time(v, finding, drive)]
        outcomes = [
            outcome
            for verdict in there
            if (outcome := self._outcome_at_finding(verdict, finding)).verdict in _VERDICTS_BY_WEIGHT
        ]
        not_applicable = VerdictAndReason(
            "not_applicable", there[0]["reason"] if there else "The rule does not apply there."
        )
        gravest = min(outcomes, key=lambda verdict: _VERDICTS_BY_WEIGHT.index(verdict.verdict), default=not_applicable)
        if gravest.verdict in _FIXED_VERDICTS and (not_recorded := self._outcome_if_not_recorded(drive_id, finding)):
            return not_recorded
        return gravest

    def _outcome_if_not_recorded(self, drive_id: str, finding: TimedFinding) -> VerdictAndReason | None:
        """Return an outcome if the ego or the object is not recorded at the finding; None: both are recorded."""
        for role in ("ego", "object"):
            actor = finding.row[f"{role}_id"]
            stretches = self._recorded.get((drive_id, actor), ())
            if actor is None or match.is_recorded_during(stretches, finding):
                continue
            if not stretches:
                return VerdictAndReason("none", f"{role} {actor} is not in this log, or has another id")
            times = ", ".join(f"{start:.2f} s to {end:.2f} s" for start, end in stretches[:3])
            more = f" and {len(stretches) - 3} more times" if len(stretches) > 3 else ""
            return VerdictAndReason("unknown", f"{role} {actor} is recorded only from {times}{more}")
        return None

    def _outcome_at_finding(self, verdict: Row, finding: TimedFinding) -> VerdictAndReason:
        """Return what a verdict means at the time of the finding. A verdict `fail` means a failure only in its failing stretches."""
        if verdict["reason_code"].startswith(UNRECORDED_PREFIX):
            return VerdictAndReason("unknown", verdict["reason"])
        if verdict["verdict"] != "fail":
            return VerdictAndReason(verdict["verdict"], verdict["reason"])
        findings = self.findings.get(verdict["drive_id"], ())
        alike = [earlier for earlier in findings if match.finding_key(earlier.row) == match.finding_key(finding.row)]
        if any(match.gap_s(earlier, finding) <= match.MOST_TIME_BETWEEN_MATCHED_FINDINGS_S for earlier in alike):
            return VerdictAndReason("fail", "the rule still fails, at another step or place")
        if verdict["n_judged"] == verdict["n_expected"]:
            return VerdictAndReason(
                "pass", "the rule is kept at this time, but broken at another time of the same verdict"
            )
        n_missing = verdict["n_expected"] - verdict["n_judged"]
        why = f"the rule fails at another time, and {n_missing} of {verdict['n_expected']} steps were not judged"
        return VerdictAndReason("unknown", why)

    def _outcome_if_not_judged(self, drive_id: str | None, finding: Row) -> VerdictAndReason | None:
        """Return the reason why the rule was not judged in the drive, as the result of a lookup; None: it was judged."""
        if drive_id is None:
            return VerdictAndReason("none", "the drive was not checked")
        drive, rule = self.drives[drive_id], self.rules.get(finding["rule_id"])
        if drive["status"] == "not_judged":
            why = f"the drive could not be judged: {drive['status_reason'] or 'no reason given'}"
            return VerdictAndReason("unknown", why)
        if rule is None:
            return VerdictAndReason("none", "the rule was not run")
        if finding["profile"] is not None and finding["profile"] not in rule["profiles"]:
            return VerdictAndReason("none", f"the profile {finding['profile']} was not run")
        if finding["ego_id"] not in self._egos[drive_id]:
            return VerdictAndReason("none", f"{ego_name(finding['ego_id'])} was not judged")
        return None

    def _concerns_object(self, verdict: Row, finding: Row, drive_id: str) -> bool:
        """Return whether a verdict concerns the object of a finding. If this result lacks the object, an undecided verdict about any object
        counts."""
        if verdict["object_id"] is None or finding["object_id"] is None or verdict["object_id"] == finding["object_id"]:
            return True
        return verdict["verdict"] in {"unknown", "error"} and finding["object_id"] not in self._objects[drive_id]


def _covers_time(verdict: Row, finding: TimedFinding, drive: Row) -> bool:
    """Return whether a verdict covers a finding's time. A verdict without times covers the whole drive."""
    times = [t for name in ("t_ref_ns", "t_start_ns", "t_end_ns", "t_worst_ns") if (t := verdict[name]) is not None]
    if not times:
        return True
    start, end = match.seconds_since_start(min(times), drive), match.seconds_since_start(max(times), drive)
    slack_s = match.MOST_TIME_BETWEEN_MATCHED_FINDINGS_S
    return start - slack_s <= finding.end_s and finding.start_s <= end + slack_s
