"""JUnit: what a CI server shows of verdicts."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree

from drivelint.errors import ExitCode
from drivelint.report import junit
from drivelint.result.gate import Gate, Waiver
from drivelint.result.model import Result, exit_status
from tests.report.synthetic import SDA, drive, finding, result, rule, verdict
from tests.shared_data import shared


def parsed(run: Result) -> etree._Element:
    return etree.fromstring(junit.render(run))


def outcomes(run: Result) -> dict[str, str]:
    """Test case -> name of what it holds, or passed."""
    return {case.get("name", ""): case[0].tag if len(case) else "passed" for case in parsed(run).iter("testcase")}


WAIVER = Waiver("w.toml:1", "ukhc.*", "prop", "jo", "2027-03-31")
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
    ("verdicts", "strict", "outcome"),
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
def test_a_case_gathers_its_verdict_rows_by_the_worst(verdicts: list[str], strict: bool, outcome: str) -> None:
    run = result([verdict(v, occurrence=n) for n, v in enumerate(verdicts)], strict=strict)
    assert list(outcomes(run).values()) == [outcome]


VERDICTS = ("pass", "fail", "unknown", "not_applicable", "unrecorded", "error")
OFF_MAP = {
    "exposure": [{"ego_id": "1", "km": 0.1, "duration_s": 25.0}],
    "not_judged": [
        {"ego_id": "1", "signal": "registration", "reason_code": "seldom_on_lane", "reason": "3 of 90 steps on a lane"}
    ],
}
DRIVES = [{}, {"lossy": True}, {"status": "not_judged", "status_reason": "no ego"}, OFF_MAP]


@given(
    rows=st.lists(
        st.tuples(st.sampled_from(VERDICTS), st.sampled_from(["nominal", "observed"]), st.booleans()), max_size=4
    ),
    severity=st.sampled_from(["critical", "major", "minor"]),
    fail_on=st.sampled_from(["critical", "major", "minor", "never"]),
    status=st.sampled_from(["stable", "draft"]),
    waives=st.booleans(),
    unknown_is=st.sampled_from(["fine", "strict", "required"]),
    about=st.sampled_from(DRIVES),
)
def test_junit_counts_what_the_exit_code_counts(
    *,
    rows: list[tuple[str, str, bool]],
    severity: str,
    fail_on: str,
    status: str,
    waives: bool,
    unknown_is: str,
    about: dict[str, Any],
) -> None:
    """Failures are exit code 1, errors 2, 3 and 4; a green suite is exit code 0. Some failed verdicts have a finding, some none."""
    verdicts = [
        verdict("not_applicable", reason_code="unrecorded_indicator", profile=p, severity=severity, occurrence=n)
        if v == "unrecorded"
        else verdict(v, profile=p, severity=severity, occurrence=n)
        for n, (v, p, _) in enumerate(rows)
    ]
    found = [
        finding(profile=p, severity=severity, occurrence=n) for n, (v, p, has) in enumerate(rows) if v == "fail" and has
    ]
    run = result(
        verdicts,
        found,
        drives=[drive(**about)],
        rules=[rule(status=status, severity=severity)],
        fail_on=fail_on,
        strict=unknown_is == "strict",
        required=(SDA,) if unknown_is == "required" else (),
        gate=Gate(waived={row["finding_id"]: 0 for row in found}, waivers=(WAIVER,)) if waives else None,
    )
    code, root = exit_status(run).code, parsed(run)
    failures, errors = (len(list(root.iter(tag))) for tag in ("failure", "error"))
    assert (int(root.get("failures", "")), int(root.get("errors", ""))) == (failures, errors)
    if code == ExitCode.FAILED:
        assert failures
    elif code == ExitCode.OK:
        assert (failures, errors) == (0, 0)
    elif code in {ExitCode.NOT_JUDGED, ExitCode.LOSSY}:
        assert (failures > 0, errors > 0) == (False, True)
    else:
        assert code == ExitCode.USAGE
        assert errors


def test_what_is_shown_and_does_not_gate_is_no_failure() -> None:
    rows = [verdict("fail"), verdict("unknown", occurrence=1, reason="lost")]
    found = [finding(), finding(finding_id="known", occurrence=1)]
    run = result(rows, found, gate=Gate(waived={"known": 0}, waivers=(WAIVER,)))
    case = parsed(run).find(".//testcase")
    assert case is not None
    assert [child.tag for child in case] == ["failure", "system-out"]
    assert (case.findtext("failure") or "").count("8.00 s") == 1
    notes = (case.findtext("system-out") or "").splitlines()
    assert notes[0].startswith("does not gate (waived until 2027-03-31 by jo: prop): 8.00 s")
    assert notes[1:] == ["unknown: lost"]
    minor = result([verdict("fail", severity="minor")], [finding(severity="minor")], rules=[rule(severity="minor")])
    assert (parsed(minor).findtext(".//skipped") or "").startswith("does not gate (below --fail-on critical): 8.00 s")


def test_only_what_is_required_may_not_be_unknown() -> None:
    rows = [verdict("unknown"), verdict("pass", occurrence=1), verdict("unknown", rule_id="ukhc.other")]
    run = result(rows, rules=[rule(), rule("ukhc.other")], required=("ukhc.other",))
    assert outcomes(run) == {f"{SDA} [nominal]": "skipped", "ukhc.other [nominal]": "error"}


@pytest.mark.parametrize(("strict", "outcome"), [(True, "error"), (False, "skipped")])
@pytest.mark.parametrize("other_verdicts", [(), ("pass",)])
def test_a_signal_that_the_log_lacks_is_an_error_only_if_it_causes_the_exit_code(
    strict: bool, outcome: str, other_verdicts: tuple[str, ...]
) -> None:
    lacking = verdict("not_applicable", reason_code="unrecorded_indicator", reason="the log has no indicators")
    run = result([lacking, *(verdict(v, occurrence=1) for v in other_verdicts)], strict=strict)
    case = parsed(run).find(".//testcase")
    assert case is not None
    if strict or not other_verdicts:
        assert [child.tag for child in case] == [outcome]
        assert "the log has no indicators" in (case[0].text or "")
    assert exit_status(run).code == (ExitCode.NOT_JUDGED if strict or not other_verdicts else ExitCode.OK)


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
