"""An overtake under two profiles is one finding wherever findings are counted; a table that has more rows says why."""

from __future__ import annotations

import io
import json
import re
from datetime import date
from typing import Any

import pytest
from lxml import etree, html
from rich.console import Console

from drivelint.gate import GateInputs, Waiver, compare_results, descriptions
from drivelint.report import junit, markdown, sarif, summary, terminal, xqar
from drivelint.result.counts import extra_rows_sentence, one_finding_per_event
from drivelint.result.model import Result, exit_status
from tests.report.pages import page
from tests.report.synthetic import SDA, SECOND, drive, finding, result, rule, verdict

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
TWO_EVENTS = run(*TWICE, LATE)


def parsed(text: str) -> Any:
    return html.fromstring(text)


def words(element: Any) -> str:
    return " ".join(element.text_content().split())


def test_the_page_counts_as_its_headline_does() -> None:
    tree = parsed(page(TWO_EVENTS))
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
    text = markdown.render(TWO_EVENTS).decode()
    assert exit_status(TWO_EVENTS).why == "2 findings at or above severity critical"
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
    console.print(terminal.render(TWO_EVENTS, "out", 120, verbose=True))
    text = console.file.getvalue()  # type: ignore[attr-defined]
    assert "Findings (2)" in text
    assert WHY in text


def test_what_is_known_is_as_many_as_what_is_unchanged() -> None:
    of = GateInputs(date(2026, 11, 29), TWO_EVENTS, "main").apply_to(TWO_EVENTS)
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
    told = json.loads(descriptions.to_json(difference, failing, "critical"))
    assert (told["events"]["new"], told["counts"]["new"]) == (1, 2)
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


def junit_cases(of: Result) -> dict[str, tuple[str, str]]:
    """Test case -> its outcome and that outcome's text."""
    cases = etree.fromstring(junit.render(of)).iter("testcase")
    return {case.get("name", ""): (case[0].tag, case[0].text or "") for case in cases if len(case)}


def sarif_results(of: Result) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = json.loads(sarif.render(of))["runs"][0]["results"]
    return found


def test_an_overtake_under_two_profiles_is_one_failure_everywhere() -> None:
    of = run(*TWICE)
    assert exit_status(of).why == "1 finding at or above severity critical"
    root = etree.fromstring(junit.render(of))
    assert (root.get("tests"), root.get("failures"), root.get("errors")) == ("2", "1", "0")
    cases = junit_cases(of)
    assert {name: tag for name, (tag, _) in cases.items()} == {
        f"{SDA} [nominal]": "failure",
        f"{SDA} [observed]": "skipped",
    }
    assert "also under the profile observed, margin -3.00 m" in cases[f"{SDA} [nominal]"][1]
    assert cases[f"{SDA} [observed]"][1].startswith(f"fails too, counted in {SDA} [nominal]: 8.00 s")
    (found,) = sarif_results(of)
    assert "also under the profile observed, margin -3.00 m" in found["message"]["text"]
    assert found["properties"]["profiles"] == ["nominal", "observed"]
    assert len(found["properties"]["findingIds"]) == 2
    assert len(list(etree.fromstring(xqar.render(of)).iter("Issue"))) == 1
    told = json.loads(summary.render(of))
    assert told["events"]["critical"] == told["rules"][0]["events"] == told["drives"][0]["events"] == 1
    assert told["findings"]["critical"] == 2, "as plain data every row is one"


def test_the_other_profile_fails_alone_if_the_first_is_let_through() -> None:
    """Only the nominal finding is waived: the observed one fails the run, and each report has both once."""
    waiver = Waiver("w:1", "*", "ticket 17", "jo", "2027-01-31", profile="nominal")
    of = GateInputs(date(2026, 11, 29), waivers=(waiver,)).apply_to(run(*TWICE))
    assert exit_status(of).why.startswith("1 finding at or above severity critical")
    assert {name: tag for name, (tag, _) in junit_cases(of).items()} == {
        f"{SDA} [nominal]": "skipped",
        f"{SDA} [observed]": "failure",
    }
    assert [(found["properties"]["profiles"], len(found["suppressions"])) for found in sarif_results(of)] == [
        (["nominal"], 1), (["observed"], 0),
    ]  # fmt: skip


def test_the_fingerprint_of_an_event_does_not_depend_on_which_row_is_shown() -> None:
    sure, doubtful = {"n_copies": 20, "n_stays": 20}, {"n_copies": 20, "n_stays": 3}
    prints = []
    for first, second in ((sure, sure), (doubtful, sure)):
        (found,) = sarif_results(run(TWICE[0] | first, TWICE[1] | second))
        prints.append(found["partialFingerprints"])
    assert prints[0] == prints[1]
    assert prints[0]["primaryLocationLineHash"] == TWICE[0]["finding_id"]
    assert found["properties"]["profile"] == "observed", "the sure row is shown"


def test_an_event_with_a_changed_profile_is_updated() -> None:
    now = run(TWICE[0], finding(profile="observed", margin=-9.0))
    of = GateInputs(date(2026, 11, 29), run(*TWICE), "main").apply_to(now)
    assert [found["baselineState"] for found in sarif_results(of)] == ["updated"]
    again = GateInputs(date(2026, 11, 29), run(*TWICE), "main").apply_to(run(*TWICE))
    assert [found["baselineState"] for found in sarif_results(again)] == ["unchanged"]
    fresh = GateInputs(date(2026, 11, 29), run(), "main").apply_to(run(*TWICE))
    assert [found["baselineState"] for found in sarif_results(fresh)] == ["new"]
    counted = json.loads(summary.render(fresh))["gate"]["baseline"]
    assert (counted["events"]["new"], counted["new"]) == (1, 2)


def test_a_touch_of_two_egos_is_one_result_that_names_both() -> None:
    both = [finding(profile=None, finding_id="a"), finding(profile=None, finding_id="b", ego_id="3", object_id="1")]
    of = result([verdict("fail", profile=None), verdict("fail", profile=None, ego_id="3", object_id="1")], both)
    (found,) = sarif_results(of)
    assert "also found for ego 3, object 1" in found["message"]["text"]
    ((tag, text),) = junit_cases(of).values()
    assert (tag, len(text.splitlines())) == ("failure", 1)
    assert text.endswith("(also found for ego 3, object 1)")


def test_a_gone_finding_is_one_error() -> None:
    of = GateInputs(date(2026, 11, 29), run(*TWICE), "main").apply_to(UNKNOWN)
    (suite,) = etree.fromstring(junit.render(of)).findall("testsuite[@name='baseline']")
    assert (suite.get("tests"), suite.get("errors")) == ("1", "1")
    (tag, text) = junit_cases(of)[f"{SDA} [nominal] of d1"]
    assert (tag, ["[observed]" in line for line in text.splitlines()]) == ("error", [False, True])


def test_findings_of_two_logs_with_the_same_content_are_two() -> None:
    """They have the same ids; one changed, the other not."""
    drives = [drive(), drive("d2", sha256="ab" * 32)]
    both = [TWICE[0], TWICE[0] | {"drive_id": "d2"}]
    rows = [verdict("fail"), verdict("fail", drive_id="d2")]
    base = result(rows, [both[0], both[1] | {"margin": -20.0}], drives=drives)
    of = GateInputs(date(2026, 11, 29), base, "main").apply_to(result(rows, both, drives=drives))
    assert of.gate is not None
    assert of.gate.baseline is not None
    n = of.gate.baseline.event_counts()
    assert (n["changed"], n["unchanged"]) == (1, 1)


def test_an_expired_waiver_counts_an_overtake_once() -> None:
    waiver = Waiver("w:1", "*", "ticket 17", "jo", "2026-01-31")
    of = GateInputs(date(2026, 11, 29), waivers=(waiver,)).apply_to(run(*TWICE))
    assert of.gate is not None
    (warning,) = descriptions.waiver_warnings(of.gate)
    assert warning.endswith("it has no effect; 1 finding matches it")
