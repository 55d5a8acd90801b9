"""JUnit: what a CI server shows of verdicts."""

from __future__ import annotations

from typing import Any

import pytest
from lxml import etree

from drivelint.report import junit
from drivelint.result.model import Result
from tests.report.synthetic import drive, finding, result, rule, verdict
from tests.shared_data import shared


def parsed(run: Result) -> etree._Element:
    return etree.fromstring(junit.render(run))


def outcomes(run: Result) -> dict[str, str]:
    """Test case -> name of what it holds, or passed."""
    return {case.get("name", ""): case[0].tag if len(case) else "passed" for case in parsed(run).iter("testcase")}


MIXED = [
    verdict("pass", profile="aggressive"),
    verdict("fail", profile="nominal"),
    verdict("unknown", profile="observed", reason="the oncoming vehicle was lost"),
    verdict("not_applicable", profile="relaxed"),
    verdict("error", profile="zz"),
]


def test_the_report_is_valid_junit() -> None:
    schema = etree.XMLSchema(etree.parse(shared("standards/junit-10.xsd")))
    drives = [drive(), drive("d2", status="not_judged", status_reason="no ego"), drive("d3")]
    hostile = verdict("unknown", drive_id="d3", reason='<b>"&\x00\x0b\ud7ff</b>', profile="<x>")
    run = result([*MIXED, hostile], [finding()], drives=drives)
    schema.assertValid(parsed(run))
    schema.assertValid(parsed(result([])))


def test_each_verdict_has_its_place() -> None:
    name = "ukhc.r162.safe-distance-ahead"
    assert outcomes(result(MIXED, [finding()])) == {
        f"{name} [aggressive]": "passed",
        f"{name} [nominal]": "failure",
        f"{name} [observed]": "skipped",
        f"{name} [relaxed]": "skipped",
        f"{name} [zz]": "error",
    }


@pytest.mark.parametrize(
    ("said", "strict", "shown"),
    [
        (["pass", "not_applicable"], False, "passed"),
        (["not_applicable"], False, "skipped"),
        (["not_applicable"], True, "skipped"),
        (["pass", "unknown"], False, "skipped"),
        (["pass", "unknown"], True, "error"),
        (["pass", "unknown", "fail"], True, "failure"),
        (["pass", "unknown", "fail", "error"], False, "error"),
    ],
)
def test_a_case_gathers_its_verdict_rows_by_the_worst(said: list[str], strict: bool, shown: str) -> None:
    run = result([verdict(v, occurrence=n) for n, v in enumerate(said)], strict=strict)
    assert list(outcomes(run).values()) == [shown]


def test_a_failure_lists_its_findings_and_a_skip_its_reasons() -> None:
    rows = [
        verdict("fail"),
        verdict("unknown", profile="relaxed", reason="lost"),
        verdict("unknown", profile="relaxed", occurrence=1, reason="lost"),
        verdict("unknown", profile="relaxed", occurrence=2, reason="log ends"),
    ]
    found = [finding(reason="first"), finding(reason="second", occurrence=1, t_worst_ns=109_500_000_000)]
    failure = parsed(result(rows, found)).find(".//failure")
    skipped = parsed(result(rows, found)).find(".//skipped")
    assert failure is not None
    assert skipped is not None
    assert (failure.text or "").splitlines() == [
        "8.00 s: ego 1, object 3; observed 58.00 m, required 64.00 m, margin -6.00 m; first",
        "9.50 s: ego 1, object 3; observed 58.00 m, required 64.00 m, margin -6.00 m; second",
    ]
    assert (skipped.text or "").splitlines() == ["unknown: lost (2 times)", "unknown: log ends"]


@pytest.mark.parametrize("status", ["draft", "deprecated"])
def test_a_draft_never_fails_a_suite(status: str) -> None:
    run = result([verdict("fail")], [finding()], rules=[rule(status=status)])
    assert list(outcomes(run).values()) == ["skipped"]
    assert "does not gate" in (parsed(run).findtext(".//skipped") or "")


def test_a_drive_that_was_not_judged_is_an_error_with_its_reason() -> None:
    run = result([], drives=[drive(status="not_judged", status_reason="d1.csv: no ego")])
    assert parsed(run).findtext(".//error") == "d1.csv: no ego"


def test_counts_add_up() -> None:
    root = parsed(result([*MIXED, verdict("fail", drive_id="d2")], drives=[drive(), drive("d2")]))
    suites: list[Any] = root.findall("testsuite")
    assert [suite.get("name") for suite in suites] == ["d1", "d2"]
    assert [int(suites[0].get(key)) for key in ("tests", "failures", "errors", "skipped")] == [5, 1, 1, 2]
    for key in ("tests", "failures", "errors"):
        assert int(root.get(key, "")) == sum(int(suite.get(key)) for suite in suites)


def test_a_flood_of_findings_is_cut_and_says_so() -> None:
    many = [finding(occurrence=n) for n in range(junit.MAX_LINES + 3)]
    text = parsed(result([verdict("fail")], many)).findtext(".//failure") or ""
    assert text.splitlines()[-1].startswith("... and 3 more")
