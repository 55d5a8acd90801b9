"""The sheet in a browser: two A4 pages with everything on them, and the same as PDF."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from drivelint.incident import pdf, render
from tests.report.browser import CHROMIUM, Page

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.incident.case import Case
    from tests.incident.conftest import CaseOf

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="chromium is not installed")
A4_PX = (794, 1123)
NAMES = ("no-collision@collision", "safe-distance-ahead@collision")


def fits(page: Page) -> None:
    """Check that both pages are A4, and that nothing on one runs into its foot or over its edge."""
    shown = page.value(
        "[...document.querySelectorAll('.page')].map(p => [p.offsetWidth, p.offsetHeight, p.scrollWidth, p.scrollHeight,"
        " Math.max(...[...p.children].filter(c => c.className != 'foot').map(c => c.getBoundingClientRect().bottom))"
        " - p.querySelector('.foot').getBoundingClientRect().top])"
    )
    assert len(shown) == 2
    for width, height, inner_width, inner_height, beyond in shown:
        assert (width, height) == pytest.approx(A4_PX, abs=1)
        assert inner_width <= width
        assert inner_height <= height
        assert beyond < 0


@pytest.mark.sample(1)
@pytest.mark.parametrize("name", NAMES)
def test_everything_is_on_two_pages(case_of: CaseOf, tmp_path: Path, name: str) -> None:
    html = tmp_path / "sheet.html"
    html.write_bytes(render(case_of(name)))
    with Page(tmp_path / "profile", html.as_uri()) as page:
        fits(page)
        assert page.complaints() == []
        assert page.requests() == [html.as_uri()]


def crowded(case: Case) -> Case:
    """Return a case in which every rule was broken, or is not decided, by both parties, each for a long reason of its own."""
    finding = case.again.findings[0]
    reason = "a reason of many words, as a rule may write it about one of many objects " * 3
    rules = case.result.rules.to_pylist()
    findings = [{**finding, "rule_id": rule["rule_id"], "reason": reason} for rule in rules[::2]]
    verdicts = [
        {**case.again.verdicts[0], "rule_id": rule["rule_id"], "verdict": "unknown", "t_start_ns": None,
         "reason_code": f"code_{n}", "reason": reason, "near_miss": False}
        for n, rule in enumerate(rules[1::2])
    ]  # fmt: skip
    judged = replace(case.again, verdicts=verdicts, findings=[*case.again.findings, *findings])
    asked = replace(case.asked, env=("weather=wet", "light=night", "nation=gb-eng"), map_offset=(1.25, -3.5))
    return replace(case, again=judged, others=judged, asked=asked)


def test_a_crowded_case_fits(case_of: CaseOf, tmp_path: Path) -> None:
    html = tmp_path / "sheet.html"
    page_bytes = render(crowded(case_of(NAMES[0])))
    html.write_bytes(page_bytes)
    assert re.search(rb"and \d+ more: check the drive", page_bytes)
    assert re.search(rb"and \d+ more reasons", page_bytes)
    with Page(tmp_path / "profile", html.as_uri()) as page:
        fits(page)


def test_pdf_has_two_pages_and_no_clock(case_of: CaseOf) -> None:
    html = render(case_of(NAMES[0]))
    browser = pdf.find_browser()
    printed = pdf.print_page(html, browser)
    assert printed.startswith(b"%PDF")
    assert len(re.findall(rb"/Type\s*/Page\b(?!s)", printed)) == 2
    assert re.findall(rb"/MediaBox\s*\[0 0 (\d+)", printed)[0] in {b"595", b"594", b"596"}
    assert pdf.print_page(html, browser) == printed
