"""`junit.xml`: a test suite per drive, a test case per rule and profile."""

from __future__ import annotations

from collections import Counter, defaultdict
from operator import itemgetter
from typing import TYPE_CHECKING, Final, NamedTuple

import pyarrow.compute as pc
from lxml import etree

from drivelint.gate import descriptions
from drivelint.report.xml import add, document, replace_non_xml
from drivelint.result import counts
from drivelint.result.text import line, with_count

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pyarrow as pa

    from drivelint.result.model import Result
    from drivelint.result.text import Row

MAX_LINES: Final = 50
"""Findings or reasons listed per test case; the tables hold them all."""

CaseKey = tuple[str, str, str | None]
"""drive_id, rule_id, profile."""
_key = itemgetter("drive_id", "rule_id", "profile")


class Case(NamedTuple):
    """A test case; `outcome` is the name of its element (failure, error, skipped), None: passed."""

    name: str
    outcome: str | None
    kind: str
    lines: list[str]


def render(result: Result) -> bytes:
    """Return the report as UTF-8 XML.

    A test case gathers the verdict rows of a drive, rule and profile: any error is an error, any fail a failure that
    lists its findings, any unknown is skipped with the reasons (an error under `--strict`). Not applicable is skipped.
    A draft never fails a suite: its failures are skipped, saying so; so are findings that the gate lets through, where a case
    has no others. A drive that could not be judged is an error.
    """
    root = etree.Element("testsuites", name="drivelint")
    cases = _cases(result)
    totals = dict.fromkeys(("tests", "failures", "errors"), 0)
    for drive in result.drives.select(["drive_id", "status", "status_reason"]).to_pylist():
        suite = list(cases.get(drive["drive_id"], ()))
        if drive["status"] == "not_judged":
            suite.insert(0, Case("the drive can be judged", "error", "not_judged", [drive["status_reason"] or ""]))
        counted = _suite(root, drive["drive_id"], suite)
        totals = {name: n + counted[name] for name, n in totals.items()}
    for name, n in totals.items():
        root.set(name, str(n))
    return document(root)


def _cases(result: Result) -> dict[str, list[Case]]:
    """Return drive_id -> its test cases, in the order of the verdict table."""
    starts = result.start_times
    drafts = set(result.rules.filter(pc.not_equal(result.rules["status"], "stable"))["rule_id"].to_pylist())
    found: dict[CaseKey, list[str]] = defaultdict(list)
    passed: dict[CaseKey, list[str]] = defaultdict(list)
    for row in result.findings.to_pylist():
        text = line(row, starts.get(row["drive_id"]))
        if reason_not_gating := descriptions.reason_not_gating(result.gate, row["finding_id"]):
            passed[_key(row)].append(f"{reason_not_gating}: {text}")
        else:
            found[_key(row)].append(text)
    reasons: dict[CaseKey, dict[str, list[str]]] = defaultdict(dict)
    for row in _reasons(result.verdicts):
        reasons[_key(row)].setdefault(row["verdict"], []).append(with_count(row["reason"], row["count_all"]))
    cases: dict[str, list[Case]] = defaultdict(list)
    for key, verdicts in reasons.items():
        if "fail" in verdicts and key in found:
            verdicts["fail"] = [*found[key], *passed[key]]
        elif "fail" in verdicts and key in passed:
            del verdicts["fail"]
            verdicts["let_through"] = passed[key]
        cases[key[0]].append(_case(key, verdicts, draft=key[1] in drafts, strict=result.strict))
    return cases


def _reasons(verdicts: pa.Table) -> Sequence[Row]:
    """Return each distinct verdict and reason of a drive, rule and profile with its count; passes need no reason."""
    reason = pc.if_else(pc.equal(verdicts["verdict"], "pass"), "", verdicts["reason"])
    columns = ["drive_id", "rule_id", "profile", "verdict"]
    return counts.distinct_rows(verdicts.select(columns).append_column("reason", reason), [*columns, "reason"])


def _case(key: CaseKey, verdicts: dict[str, list[str]], *, draft: bool, strict: bool) -> Case:
    _, rule_id, profile = key
    name = f"{rule_id} [{profile}]" if profile is not None else rule_id
    if "error" in verdicts:
        return Case(name, "error", "error", verdicts["error"])
    if "fail" in verdicts:
        lines = [f"draft, does not gate: {x}" for x in verdicts["fail"]]
        return Case(name, "skipped", "draft", lines) if draft else Case(name, "failure", "fail", verdicts["fail"])
    let_through = verdicts.get("let_through", [])
    if "unknown" in verdicts:
        lines = [*(f"unknown: {x}" for x in verdicts["unknown"]), *let_through]
        return Case(name, "error" if strict and not draft else "skipped", "unknown", lines)
    if let_through:
        return Case(name, "skipped", "let_through", let_through)
    if "pass" in verdicts:
        return Case(name, None, "pass", [])
    return Case(name, "skipped", "not_applicable", [f"not applicable: {x}" for x in verdicts.get("not_applicable", [])])


def _suite(root: etree._Element, drive_id: str, cases: list[Case]) -> dict[str, int]:
    """Append a drive's suite to the document and return its counts."""
    outcomes = Counter(case.outcome for case in cases)
    counted = {"tests": len(cases), "failures": outcomes["failure"], "errors": outcomes["error"]}
    counted["skipped"] = outcomes["skipped"]
    suite = add(root, "testsuite", name=drive_id, **{name: str(n) for name, n in counted.items()})
    for case in cases:
        element = add(suite, "testcase", name=case.name, classname=drive_id)
        if case.outcome:
            lines = case.lines[:MAX_LINES]
            if more := len(case.lines) - len(lines):
                lines.append(f"... and {more} more: see findings.parquet and verdicts.parquet")
            detail = add(element, case.outcome, type=case.kind, message=lines[0] if lines else case.kind)
            detail.text = replace_non_xml("\n".join(lines))
    return counted
