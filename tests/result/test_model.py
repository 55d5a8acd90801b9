"""The exit code follows DESIGN.md's meanings and precedence."""

from __future__ import annotations

import io
from dataclasses import replace
from typing import Any

import pytest
from rich.console import Console

from drivelint.errors import DriveLintError, ExitCode
from drivelint.report import junit, terminal_summary
from drivelint.result.model import Result, exit_status
from drivelint.result.schemas import empty_table
from tests.report.synthetic import SDA, drive, result, rule, verdict

UNJUDGED_DRIVE = drive("d2", status="not_judged", status_reason="d2.csv: no ego")
LOSSY = drive(lossy=True)


@pytest.mark.parametrize(
    ("verdicts", "drives", "settings", "code"),
    [
        pytest.param(["pass"], None, {}, ExitCode.OK, id="all kept"),
        pytest.param(["not_applicable", "unknown"], None, {}, ExitCode.OK, id="unknown does not gate by default"),
        pytest.param(["pass", "fail"], None, {}, ExitCode.FAILED, id="one failed"),
        pytest.param(["fail"], None, {"fail_on": "never"}, ExitCode.OK, id="failures never gate"),
        pytest.param(["pass", "unknown"], None, {"strict": True}, ExitCode.NOT_JUDGED, id="strict: unknown"),
        pytest.param(["pass"], None, {"strict": True}, ExitCode.OK, id="strict: all kept"),
        pytest.param(["pass"], [drive(), UNJUDGED_DRIVE], {}, ExitCode.NOT_JUDGED, id="a drive was not judged"),
        pytest.param(["pass"], [LOSSY], {}, ExitCode.LOSSY, id="lossy input"),
        pytest.param(["pass"], [LOSSY, UNJUDGED_DRIVE], {}, ExitCode.NOT_JUDGED, id="4 before 3"),
        pytest.param(["fail"], [LOSSY, UNJUDGED_DRIVE], {}, ExitCode.FAILED, id="1 before 4"),
        pytest.param(["fail", "error"], [LOSSY, UNJUDGED_DRIVE], {}, ExitCode.USAGE, id="2 before 1"),
        pytest.param(["unknown"], [LOSSY], {"strict": True}, ExitCode.NOT_JUDGED, id="strict unknown before 3"),
        pytest.param([], [drive(), UNJUDGED_DRIVE], {}, ExitCode.NOT_JUDGED, id="no verdict at all"),
        pytest.param(["pass", "unknown"], None, {"required": (SDA,)}, ExitCode.NOT_JUDGED, id="required: unknown"),
        pytest.param(["pass", "unknown"], None, {"required": ("ukhc.other",)}, ExitCode.OK, id="another is required"),
        pytest.param(["fail", "unknown"], None, {"required": (SDA,)}, ExitCode.FAILED, id="1 before required unknown"),
        pytest.param(
            ["error"], [drive(), UNJUDGED_DRIVE], {"interrupted": True}, ExitCode.INTERRUPTED, id="130 before all"
        ),
    ],
)
def test_exit_code(
    verdicts: list[str], drives: list[dict[str, Any]] | None, settings: dict[str, Any], code: ExitCode
) -> None:
    run = result([verdict(said, occurrence=n) for n, said in enumerate(verdicts)], drives=drives, **settings)
    assert exit_status(run).code is code
    assert exit_status(run).why


def test_what_is_unknown_and_may_not_be_is_counted_by_rule() -> None:
    rows = [verdict("unknown", rule_id=name, occurrence=n) for n, name in enumerate(("b", "a", "b", "free"))]
    run = result(rows, rules=[rule("a"), rule("b"), rule("free")], required=("a", "b"))
    assert exit_status(run).why == "3 verdicts of required rules unknown (--require): 1 of a, 2 of b"


@pytest.mark.parametrize(
    ("drives", "settings", "also"),
    [
        (None, {"required": (SDA,)}, f"1 verdict of required rules unknown (--require): 1 of {SDA}"),
        ([drive(), UNJUDGED_DRIVE], {}, "1 of 2 drives could not be judged"),
    ],
)
def test_a_failure_does_not_hide_what_was_not_judged(
    drives: list[dict[str, Any]] | None, settings: dict[str, Any], also: str
) -> None:
    run = result([verdict("fail"), verdict("unknown", occurrence=1)], drives=drives, **settings)
    assert exit_status(run).code is ExitCode.FAILED
    assert exit_status(run).why.endswith(f"; also {also}")
    alone = result([verdict("fail"), verdict("unknown", occurrence=1)])
    assert "also" not in exit_status(alone).why


def test_an_interrupted_run_says_how_far_it_came() -> None:
    run = result([verdict("fail")], drives=[drive(), UNJUDGED_DRIVE, drive("d3")], interrupted=True)
    assert exit_status(run).why == "partial: 2 of 3 drives judged, interrupted"


def test_a_run_that_decided_nothing_is_no_success() -> None:
    """A green tick for a gate that looked at nothing would be a pass that came from not looking."""
    nothing = result([verdict("unknown")])
    assert exit_status(nothing).code is ExitCode.NOT_JUDGED
    assert "nothing could be decided" in exit_status(nothing).why
    assert exit_status(replace(nothing, fail_on="never")).code is ExitCode.NOT_JUDGED
    for said in ("pass", "not_applicable"):
        assert exit_status(result([verdict("unknown"), verdict(said, occurrence=1)])).code is ExitCode.OK
    assert exit_status(result([])).code is ExitCode.OK
    drafts = result([verdict("unknown")], rules=[rule(status="draft")])
    assert exit_status(drafts).code is ExitCode.OK
    assert "nothing could be decided" in exit_status(drafts).why


@pytest.mark.parametrize(("least", "code"), [(0.5, ExitCode.OK), (0.51, ExitCode.NOT_JUDGED), (None, ExitCode.OK)])
def test_a_share_of_the_rules_must_be_decided_if_it_is_asked_for(least: float | None, code: ExitCode) -> None:
    """A rule that was decided in one of two episodes is decided, an unknown one is not, and one that never applied does not count."""
    rows = [
        verdict("pass"), verdict("unknown", occurrence=1), verdict("unknown", rule_id="ukhc.b"),
        verdict("not_applicable", rule_id="ukhc.c", object_id=None),
    ]  # fmt: skip
    run = replace(result(rows, rules=[rule(), rule("ukhc.b"), rule("ukhc.c")]), min_judged=least)
    assert exit_status(run).code is code
    if code is ExitCode.NOT_JUDGED:
        assert "50 % of the rules that may apply were decided, fewer than 51 % (--min-judged)" in exit_status(run).why
        assert b'errors="1"' in junit.render(run)


def test_a_failure_counts_before_too_little_that_was_decided() -> None:
    run = replace(
        result([verdict("fail"), verdict("unknown", rule_id="ukhc.b")], rules=[rule(), rule("ukhc.b")]), min_judged=0.9
    )
    assert exit_status(run).code is ExitCode.FAILED
    assert exit_status(run).why.endswith("fewer than 90 % (--min-judged)")


@pytest.mark.parametrize("severity", ["critical", "major", "minor"])
@pytest.mark.parametrize("fail_on", ["critical", "major", "minor", "never"])
def test_only_failures_at_or_above_the_threshold_gate(severity: str, fail_on: str) -> None:
    weight = {"critical": 3, "major": 2, "minor": 1, "never": 4}
    run = result([verdict("fail", severity=severity)], rules=[rule(severity=severity)], fail_on=fail_on)
    assert (exit_status(run).code is ExitCode.FAILED) == (weight[severity] >= weight[fail_on])


@pytest.mark.parametrize("status", ["draft", "deprecated"])
def test_only_stable_rules_gate(status: str) -> None:
    rows = [verdict("fail"), verdict("unknown", occurrence=1)]
    assert exit_status(result(rows, rules=[rule(status=status)], strict=True)).code is ExitCode.OK


def test_an_error_of_a_draft_is_still_an_error() -> None:
    assert exit_status(result([verdict("error")], rules=[rule(status="draft")])).code is ExitCode.USAGE


def test_a_lossy_drive_that_was_not_judged_is_no_lossy_verdict() -> None:
    run = result([verdict("pass")], drives=[drive(), drive("d2", lossy=True, status="not_judged", status_reason="cut")])
    assert not run.is_lossy


def test_a_table_without_its_columns_is_refused() -> None:
    short = empty_table("verdict").drop_columns(["margin"])
    with pytest.raises(DriveLintError, match=r"verdict.*missing.*margin"):
        Result(short, empty_table("finding"), empty_table("drive"), empty_table("rule"))


def test_a_table_with_a_stray_column_is_refused() -> None:
    rows = empty_table("finding")
    stray = rows.append_column("mood", rows["rule_id"])
    with pytest.raises(DriveLintError, match=r"finding.*excess.*mood"):
        Result(empty_table("verdict"), stray, empty_table("drive"), empty_table("rule"))


HEADLIGHTS = {"reason_code": "unrecorded_headlights", "reason": "The log has nothing of the headlights."}
HORN = {"reason_code": "unrecorded_horn", "reason": "The log has nothing of the horn."}
UNRECORDED = [
    verdict("pass"),
    verdict("not_applicable", rule_id="a", **HEADLIGHTS),
    verdict("not_applicable", rule_id="b", **HEADLIGHTS),
    verdict("not_applicable", rule_id="c", **HORN),
]
RULES = [rule(), rule("a"), rule("b"), rule("c")]


@pytest.mark.parametrize(
    ("settings", "why", "column", "not_judged"),
    [
        (
            {"strict": True},
            "3 verdicts unknown: headlights (2 rules), horn (1 rule) (--strict)",
            "3",
            "2 rules without headlights, 1 rule without horn",
        ),
        (
            {"required": ("a",)},
            "1 verdict of required rules unknown (--require): 1 of a",
            "1",
            "1 rule without headlights",
        ),
        ({}, "nothing failed at or above severity critical", "·", "nothing"),
    ],
)
def test_what_makes_exit_code_4_is_counted_as_unknown_and_named(
    settings: dict[str, Any], why: str, column: str, not_judged: str
) -> None:
    run = result(UNRECORDED, rules=RULES, **settings)
    assert exit_status(run).why == why
    console = Console(file=io.StringIO(), width=120, force_terminal=False)
    console.print(terminal_summary.render(run, None, 120))
    lines = console.file.getvalue().splitlines()  # type: ignore[attr-defined]
    assert [line.split()[-1] for line in lines if line.startswith("d1 ")] == [column]
    assert f"not judged: {not_judged}" in lines
