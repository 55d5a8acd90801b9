"""An overtake under two profiles is one finding wherever findings are counted; a table that has more rows says why."""

from __future__ import annotations

import io
import re
from datetime import date
from typing import Any

import pytest
from lxml import html
from rich.console import Console

from drivelint.gate import GateInputs, compare_results, descriptions
from drivelint.report import markdown, terminal
from drivelint.result.counts import extra_rows_sentence, one_finding_per_event
from drivelint.result.model import Result, exit_status
from tests.report.pages import page
from tests.report.synthetic import SECOND, finding, result, rule, verdict

TWICE = [finding(), finding(profile="observed", margin=-3.0)]
LATE = finding(finding_id="late", occurrence=1, t_start_ns=115 * SECOND, t_end_ns=115 * SECOND, t_worst_ns=115 * SECOND)
WHY = "3 rows, 2 findings: an overtake under two profiles counts once"


def run(*findings: dict[str, object]) -> Result:
    rows = [verdict("fail", profile=profile) for profile in ("nominal", "observed")]
    return result(rows, list(findings), rules=[rule(profiles=["nominal", "observed"])])


UNKNOWN = result(
    [verdict("unknown", profile=profile) for profile in ("nominal", "observed")],
    rules=[rule(profiles=["nominal", "observed"])],
)
BOTH = run(*TWICE, LATE)


def parsed(text: str) -> Any:
    return html.fromstring(text)


def words(element: Any) -> str:
    return " ".join(element.text_content().split())


def test_the_page_counts_as_its_headline_does() -> None:
    tree = parsed(page(BOTH))
    assert "2 critical findings in 1 of 1 drive" in words(tree.find(".//h1"))
    assert words(tree.get_element_by_id("findings")) == "Worst first: findings 2"
    assert WHY + "." in [words(p) for p in tree.xpath("//section[@aria-labelledby='findings']/p")]
    headings = [words(each) for each in tree.xpath("//section[@aria-labelledby='short']/h3")]
    assert "Findings by severity 2" in headings
    by_severity, broken = tree.xpath("//section[@aria-labelledby='short']//table")[:2]
    assert [words(cell) for cell in by_severity.xpath(".//td[@data-label='findings']")] == ["2"]
    assert [words(cell) for cell in broken.xpath(".//td[@data-label='findings']")] == ["2"]


def test_a_page_without_such_rows_does_not_speak_of_them() -> None:
    assert "counts once" not in page(run(TWICE[0], LATE))
    assert "counts once" not in markdown.render(run(TWICE[0], LATE)).decode()


def test_the_comment_of_a_pull_request_counts_as_its_exit_line_does() -> None:
    text = markdown.render(BOTH).decode()
    assert exit_status(BOTH).why == "2 findings at or above severity critical"
    assert f"### Findings (2)\n\n{WHY}.\n\n| severity" in text


def test_the_comment_of_a_flood_says_how_many_rows_it_has() -> None:
    many = [
        finding(finding_id=f"{profile}{n}", profile=profile, object_id=str(n))
        for n in range(30)
        for profile in ("nominal", "observed")
    ]
    text = markdown.render(run(*many)).decode()
    why = "60 rows, 30 findings: an overtake under two profiles counts once; the first 40 rows."
    assert f"### Findings (30)\n\n{why}\n\n| severity" in text


def test_the_tables_of_a_terminal_count_as_its_verdict_does() -> None:
    console = Console(file=io.StringIO(), width=120, force_terminal=False)
    console.print(terminal.render(BOTH, "out", 120, verbose=True))
    text = console.file.getvalue()  # type: ignore[attr-defined]
    assert "Findings (2)" in text
    assert WHY in text


def test_what_is_known_is_as_many_as_what_is_unchanged() -> None:
    of = GateInputs(date(2026, 11, 29), BOTH, "main").apply_to(BOTH)
    text = markdown.render(of).decode()
    assert "no new finding; 2 known (2 critical) in 1 of 1 drive" in text
    assert "2 unchanged" in text
    assert f"Findings that do not gate (2)</summary>\n\n{WHY}." in text
    (chips,) = parsed(page(of)).xpath("//p[@class='gate-counts']")
    assert words(chips).startswith("0 new, 2 known.")


def test_an_event_that_changed_under_one_profile_has_changed() -> None:
    now = run(TWICE[0], finding(profile="observed", margin=-9.0))
    of = GateInputs(date(2026, 11, 29), run(*TWICE), "main").apply_to(now)
    assert of.gate is not None
    assert of.gate.baseline is not None
    n = of.gate.baseline.event_counts()
    assert (n["changed"], n["unchanged"]) == (1, 0)
    assert of.gate.baseline.counts()["unchanged"] == 1, "as plain data every row is one"
    assert "1 known finding is worse" in markdown.render(of).decode()


def test_a_difference_counts_new_and_gone_findings_once() -> None:
    difference, failing = compare_results(run(), run(*TWICE), ("base", "new"), "critical")
    text = descriptions.difference_text(difference, failing, "critical")
    assert "New (1)\n  2 rows, 1 finding: an overtake under two profiles counts once\n" in text
    assert "exit 1: 1 new finding at or above severity critical" in text
    difference, failing = compare_results(run(*TWICE), UNKNOWN, ("base", "new"), "critical")
    text = descriptions.difference_text(difference, failing, "critical")
    assert re.search(r"exit 4: no new finding .*, but 1 earlier finding gone but not fixed", text)


def test_gone_findings_are_counted_once_in_the_gate() -> None:
    of = GateInputs(date(2026, 11, 29), run(*TWICE), "main").apply_to(UNKNOWN)
    why = "1 finding of the baseline at or above severity critical is gone but not fixed: 1 unknown now"
    assert exit_status(of).why == why


@pytest.mark.parametrize(
    ("rows", "why"),
    [
        (TWICE, "2 rows, 1 finding: an overtake under two profiles counts once"),
        (
            [finding(profile=None, finding_id="a"), finding(profile=None, finding_id="b", ego_id="3", object_id="1")],
            "2 rows, 1 finding: a touch of two egos counts once",
        ),
        (TWICE[:1], ""),
    ],
)
def test_a_table_says_why_it_has_more_rows(rows: list[dict[str, object]], why: str) -> None:
    filled = run(*rows).findings.to_pylist()
    assert extra_rows_sentence(filled, one_finding_per_event(filled)) == why
