"""`junit.xml`: a test suite per drive, a test case per rule and profile."""

from __future__ import annotations

from collections import Counter, defaultdict
from operator import itemgetter
from typing import TYPE_CHECKING, Final, NamedTuple

import pyarrow.compute as pc
from lxml import etree

from drivelint.gate import descriptions
from drivelint.reasons.signals import UNRECORDED_PREFIX
from drivelint.report.outcome import events_by_status
from drivelint.report.worst_first import when
from drivelint.report.xml import add_element, replace_non_xml, xml_bytes
from drivelint.result import counts
from drivelint.result.model import (
    ego_absence_texts,
    failures_without_finding,
    gating_unfixed_findings,
    gating_unknowns,
    map_misfit_reason,
    why_too_little_decided,
)
from drivelint.result.text import rule_name, verdict_or_finding_line, with_count

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import pyarrow as pa

    from drivelint.result.gate import ComparedFinding
    from drivelint.result.model import Result
    from drivelint.result.text import Row

MAX_LINES: Final = 50
"""A test case lists this many findings or reasons; the tables contain all."""

CaseKey = tuple[str, str, str | None]
"""drive_id, rule_id, profile."""
_case_key = itemgetter("drive_id", "rule_id", "profile")


class Case(NamedTuple):
    """A test case. `outcome`: its element's name (failure, error, skipped), None: passed; `notes`: the lines of its system-out."""

    name: str
    outcome: str | None
    kind: str
    lines: list[str]
    notes: Sequence[str] = ()


def render(result: Result) -> bytes:
    """Return the report as UTF-8 XML; failures and errors are consistent with the exit code.

    A failure is a drive, rule and profile with a finding that causes exit code 1. A finding under several profiles fails one case, and the
    cases of the other profiles are skipped and name it. An error is anything that causes exit code 2, 3 or 4: a rule in error, a forbidden
    unknown verdict or one that lacks a signal of the log, a drive that was not judged, a map that does not fit, or a lossy log. A finding
    of the baseline that is gone but not fixed, and a run with too few decisions, are errors too. A case is skipped if it is not applicable,
    has other unknown verdicts, or has only findings that do not gate. Other cases list these in their system-out.
    """
    root = etree.Element("testsuites", name="drivelint")
    cases = _cases_by_drive(result)
    totals = dict.fromkeys(("tests", "failures", "errors"), 0)
    suites = [
        (drive["drive_id"], [*_cases_of_drive_problems(drive), *cases.get(drive["drive_id"], ())])
        for drive in result.drives.to_pylist()
    ]
    if too_little := why_too_little_decided(result):
        suites.append(("judged", [Case("enough could be judged", "error", "undecided", [too_little])]))
    if unfixed_findings := gating_unfixed_findings(result):
        events = counts.group_rows(unfixed_findings, lambda entry: entry.event_key)
        suites.append(("baseline", list(map(_unfixed_case, events.values()))))
    for name, suite_cases in suites:
        suite_counts = _append_suite_and_return_counts(root, name, suite_cases)
        totals = {name: n + suite_counts[name] for name, n in totals.items()}
    for name, n in totals.items():
        root.set(name, str(n))
    return xml_bytes(root)


def _cases_of_drive_problems(drive: Row) -> Iterator[Case]:
    """Yield test cases for the problems of a drive as a whole."""
    if drive["status"] == "not_judged":
        yield Case("the drive can be judged", "error", "not_judged", [drive["status_reason"] or ""])
    elif drive["lossy"]:
        yield Case("the log is complete", "error", "lossy", ["parts of the log were lost", *ego_absence_texts(drive)])
    if (reason := map_misfit_reason(drive)) is not None:
        yield Case("the map fits the drive", "error", "map", [reason])


def _unfixed_case(event: Sequence[ComparedFinding]) -> Case:
    """Return the test case of a baseline finding that this result does not have, but that is not known to be fixed.

    `event`: its entry under each profile.
    """
    first = event[0]
    name = rule_name({"rule_id": first.rule_id, "profile": first.profile})
    lines = [f"gone, but not fixed: {descriptions.finding_line(entry)}" for entry in event]
    return Case(f"{name} of {first.drive_id}", "error", first.standing, lines)


class _CaseLines(NamedTuple):
    """The lines of a test case, by kind."""

    erred: list[str]
    stopping: list[str]
    counted_elsewhere: list[str]
    not_gating: list[str]
    unknown: list[str]
    lacking_signal: list[str]
    not_applicable: list[str]
    passed: list[str]


def _cases_by_drive(result: Result) -> dict[str, list[Case]]:
    """Return the test cases of each drive by `drive_id`, in the order of the verdict table."""
    lines_by_case: dict[CaseKey, _CaseLines] = defaultdict(lambda: _CaseLines(*([] for _ in _CaseLines._fields)))
    rules = {rule["rule_id"]: rule for rule in result.rules.to_pylist()}

    def add_failure(row: Row, text: str, counted_as: Row | None = None) -> None:
        reason = descriptions.why_not_gating(result, row, rules.get(row["rule_id"]))
        lines = lines_by_case[_case_key(row)]
        if reason:
            lines.not_gating.append(f"does not gate ({reason}): {text}")
        elif counted_as is not None:
            lines.counted_elsewhere.append(f"fails too, counted in {rule_name(counted_as)}: {text}")
        else:
            lines.stopping.append(text)

    def line(row: Row) -> str:
        return verdict_or_finding_line(row, when(row, rules, starts.get(row["drive_id"])))

    starts = result.start_times
    of_verdict = {"error": "erred", "unknown": "unknown", "not_applicable": "not_applicable", "pass": "passed"}
    for row in _distinct_reasons(result.verdicts):
        lines = lines_by_case[_case_key(row)]  # creates the case, in the order of the verdicts
        kind = "lacking_signal" if row["lacks_signal"] else of_verdict.get(row["verdict"])
        if kind:
            getattr(lines, kind).append(with_count(row["reason"], row["count_all"]))
    for event in events_by_status(result.gate, result.findings.to_pylist()):
        also = f" ({event.other_rows_words})" if event.other_rows else ""
        add_failure(event.finding, f"{line(event.finding)}{also}")
        for row in event.other_rows:
            if _case_key(row) != _case_key(event.finding):
                add_failure(row, line(row), event.finding)
    for row in _distinct_reasons(failures_without_finding(result)):
        add_failure(row, with_count(row["reason"], row["count_all"]))
    required = set(_test_case_keys(gating_unknowns(result)))
    cases: dict[str, list[Case]] = defaultdict(list)
    for key, lines in lines_by_case.items():
        cases[key[0]].append(_test_case(key, lines, is_required=key in required))
    return cases


def _distinct_reasons(verdicts: pa.Table) -> Sequence[Row]:
    """Return each distinct verdict and reason of a drive, rule and profile with its count; the reason of a pass is ''."""
    reason = pc.if_else(pc.equal(verdicts["verdict"], "pass"), "", verdicts["reason"])
    columns = ["drive_id", "rule_id", "profile", "severity", "verdict"]
    lacks = pc.starts_with(verdicts["reason_code"], UNRECORDED_PREFIX)
    rows = verdicts.select(columns).append_column("reason", reason).append_column("lacks_signal", lacks)
    return counts.distinct_rows(rows, rows.column_names)


def _test_case_keys(rows: pa.Table) -> Iterator[CaseKey]:
    return map(_case_key, rows.select(["drive_id", "rule_id", "profile"]).to_pylist())


def _test_case(key: CaseKey, lines: _CaseLines, *, is_required: bool) -> Case:
    """Return the test case of a drive, rule and profile; `is_required`: an unknown verdict, or one that lacks a signal, is an error."""
    _, rule_id, profile = key
    name = f"{rule_id} [{profile}]" if profile is not None else rule_id
    unknown = [f"unknown: {x}" for x in lines.unknown]
    not_applicable = [f"not applicable: {x}" for x in [*lines.lacking_signal, *lines.not_applicable]]
    if is_required:
        unknown += [f"not recorded: {x}" for x in lines.lacking_signal]
    other_lines = [*lines.counted_elsewhere, *lines.not_gating]
    if lines.erred:
        return Case(name, "error", "error", lines.erred, [*lines.stopping, *other_lines, *unknown])
    if lines.stopping:
        return Case(name, "failure", "fail", lines.stopping, [*other_lines, *unknown])
    if unknown and is_required:
        return Case(name, "error", "unknown", unknown, other_lines)
    if other_lines or unknown:
        kind = "counted_elsewhere" if lines.counted_elsewhere else "unknown" if unknown else "does_not_gate"
        return Case(name, "skipped", kind, [*lines.counted_elsewhere, *unknown, *lines.not_gating])
    if lines.passed:
        return Case(name, None, "pass", [])
    return Case(name, "skipped", "not_applicable", not_applicable)


def _append_suite_and_return_counts(root: etree._Element, drive_id: str, cases: list[Case]) -> dict[str, int]:
    """Append a drive's suite to the document and return its counts."""
    outcomes = Counter(case.outcome for case in cases)
    suite_counts = {"tests": len(cases), "failures": outcomes["failure"], "errors": outcomes["error"]}
    suite_counts["skipped"] = outcomes["skipped"]
    suite = add_element(root, "testsuite", name=drive_id, **{name: str(n) for name, n in suite_counts.items()})
    for case in cases:
        element = add_element(suite, "testcase", name=case.name, classname=drive_id)
        if case.outcome:
            lines = _shown_lines(case.lines)
            detail = add_element(element, case.outcome, type=case.kind, message=lines[0] if lines else case.kind)
            detail.text = replace_non_xml("\n".join(lines))
        if case.notes:
            add_element(element, "system-out").text = replace_non_xml("\n".join(_shown_lines(case.notes)))
    return suite_counts


def _shown_lines(lines: Sequence[str]) -> list[str]:
    """Return the lines that are shown, and a line with the number of further lines."""
    more = len(lines) - MAX_LINES
    return [
        *lines[:MAX_LINES],
        *([f"... and {more} more: see findings.parquet and verdicts.parquet"] if more > 0 else []),
    ]
