"""The report of a busy recorded drive, every vehicle in turn as ego: small, quiet, fits a phone, prints, says whose each finding is."""

from __future__ import annotations

import base64
import re
from collections.abc import Iterator

import pytest

from drivelint.report.progress import Silent
from drivelint.result.model import Result
from drivelint.run import CheckOptions, check
from tests.report.browser import CHROMIUM, Page
from tests.report.pages import page
from tests.shared_data import shared

pytestmark = [pytest.mark.ci, pytest.mark.skipif(CHROMIUM is None, reason="chromium is not installed")]
TYPICAL = 3_000_000
"""Bytes that the page of one drive may have."""
BEYOND = """[...document.querySelectorAll('.card, table')].filter(e => {
  const box = e.getBoundingClientRect();
  return box.width > 0 && box.right > document.documentElement.clientWidth + 1 && !e.closest('.scroll');
}).map(e => e.textContent.slice(0, 60))"""
"""Cards and tables that end to the right of the window, where they are cut off."""
PAGES = range(5, 31)
"""Printed pages that somebody reads: not three hundred rows of a table."""


@pytest.fixture(
    scope="module",
    params=[pytest.param(True, id="with copies", marks=pytest.mark.slow), pytest.param(False, id="without")],
)
def busy(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Result:
    log = shared("commonroad/USA_US101-5_1_T-1.xml")
    out = tmp_path_factory.mktemp("busy")
    return check(
        CheckOptions((str(log),), rules=("all",), ego="all", annotate=False, robustness=request.param, out=out),
        Silent(),
    )


@pytest.fixture(scope="module")
def browser_page(busy: Result, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    folder = tmp_path_factory.mktemp("page")
    (folder / "report.html").write_text(page(busy), encoding="utf-8")
    with Page(folder / "profile", (folder / "report.html").as_uri()) as shown:
        yield shown


@pytest.mark.slow
def test_it_is_small_and_opens_without_a_word_or_a_request(busy: Result, browser_page: Page) -> None:
    assert busy.drives["n_egos"][0].as_py() > 20
    assert busy.findings.num_rows > 50
    assert len(page(busy).encode()) < TYPICAL
    assert browser_page.complaints() == []
    assert [url for url in browser_page.requests() if not url.startswith(("file:", "data:"))] == []


@pytest.mark.parametrize("width", [390, 1280])
def test_nothing_sticks_out_and_no_number_is_torn(browser_page: Page, width: int) -> None:
    browser_page.call(
        "Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=width < 500
    )
    assert browser_page.value("document.documentElement.scrollWidth") <= width
    assert browser_page.value(BEYOND) == []
    torn = """[...document.querySelectorAll('#findings-table td.actor, #findings-table td.num')].filter(cell => {
      const text = document.createRange();
      text.selectNodeContents(cell.querySelector('b') || cell);
      const lines = new Set([...text.getClientRects()].map(box => Math.round(box.top)));
      return cell.textContent.trim().length < 8 && lines.size > 1;
    }).length"""
    assert browser_page.value(torn) == 0


def test_each_finding_says_whose_it_is(busy: Result, browser_page: Page) -> None:
    told = browser_page.value(
        "[...document.querySelectorAll('#findings-table td[data-label=ego]')].map(c => c.textContent)"
    )
    shown = busy.findings.num_rows + sum(busy.verdicts["near_miss"].to_pylist())
    assert len(told) == shown
    assert set(told) >= set(busy.findings["ego_id"].to_pylist())


def test_it_prints_on_pages_that_somebody_reads(browser_page: Page) -> None:
    pdf = base64.b64decode(browser_page.call("Page.printToPDF", printBackground=True, preferCSSPageSize=True)["data"])
    assert len(re.findall(rb"/Type\s*/Page\b", pdf)) in PAGES
