"""The fleet page in Chromium: no complaint, no request, sorting works, nothing wider than the window."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.fleet_report import lake
from tests.fleet_report.command import ran
from tests.report.browser import CHROMIUM, Page

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="chromium is not installed")


@pytest.fixture(scope="module", params=[1280, 400])
def opened(
    request: pytest.FixtureRequest, filled: lake.Lake, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Page]:
    assert ran("report", filled.folder, "--by", "release", "--baseline", filled.folder).code == 0
    page = tmp_path_factory.mktemp("page")
    with Page(
        page / "profile", (filled.folder / "fleet.html").as_uri(), width=request.param, dark=request.param == 400
    ) as shown:
        yield shown


def test_it_opens_without_complaints_and_asks_for_nothing(opened: Page) -> None:
    assert opened.value("getComputedStyle(document.body).margin") == "0px", "the policy let our style in"
    assert opened.value("document.querySelectorAll('.rate-bar').length") > 30
    assert opened.complaints() == []
    assert all(url.startswith(("file:", "data:")) for url in opened.requests())


def test_nothing_is_wider_than_the_window(opened: Page) -> None:
    assert opened.value("document.documentElement.scrollWidth <= document.documentElement.clientWidth")


def test_a_click_on_a_head_sorts_by_numbers(opened: Page) -> None:
    column = "[...document.querySelectorAll('.rate-table tbody tr')].map(r => Number(r.cells[2].dataset.v))"
    opened.value("document.querySelectorAll('.rate-table thead th button')[2].click()")
    rising = opened.value(column)
    assert rising == sorted(rising)
    opened.value("document.querySelectorAll('.rate-table thead th button')[2].click()")
    falling = opened.value(column)
    assert falling == sorted(rising, reverse=True)
    assert falling[0] > 0


def test_bars_lie_where_their_rates_are(opened: Page) -> None:
    """A higher rate lies further to the right."""
    told = opened.value(
        "[...document.querySelectorAll('.rate-table tbody tr')].filter(r => r.querySelector('.rate'))"
        ".map(r => [Number(r.cells[3].dataset.v), r.querySelector('.rate').getBoundingClientRect().left])"
    )
    assert len(told) > 10
    assert [x for _, x in sorted(told)] == sorted(x for _, x in told)


def test_every_column_of_the_rates_is_seen(opened: Page) -> None:
    assert opened.value(
        "[...document.querySelectorAll('.rate-table, .by-tag')].every(e => e.scrollWidth <= e.clientWidth)"
    )


def test_rates_without_findings_are_folded(opened: Page) -> None:
    seen = "[...document.querySelectorAll('.rate-table .idle')].filter(e => e.offsetHeight).length"
    assert opened.value("document.querySelectorAll('.rate-table .idle').length") > 10
    assert opened.value(seen) == 0
    opened.value("document.querySelector('.idle-switch summary').click()")
    assert opened.value(seen) == opened.value("document.querySelectorAll('.rate-table .idle').length")
    opened.value("document.querySelector('.idle-switch summary').click()")


def test_no_list_of_the_page_is_a_box_that_scrolls(opened: Page) -> None:
    boxes = ".rate-table, .changes"
    scrolling = f"[...document.querySelectorAll('{boxes}')].filter(e => e.scrollHeight > e.clientHeight + 1).length"
    assert opened.value(scrolling) == 0


def test_folded_lists_are_open_on_paper_and_tables_are_not_cut(opened: Page) -> None:
    folds = "[...document.querySelectorAll('.on-paper')]"
    opened.value(f"{folds}.forEach(e => {{ e.open = false; }})")
    opened.value("dispatchEvent(new Event('beforeprint'))")
    opened.call("Emulation.setEmulatedMedia", media="print")
    assert opened.value(f"{folds}.length && {folds}.every(e => e.open)")
    assert opened.value("getComputedStyle(document.querySelector('.by-tag')).display") == "block"
    assert opened.value("getComputedStyle(document.querySelector('.by-tag table')).breakInside") == "avoid"
    opened.call("Emulation.setEmulatedMedia", media="")
    opened.value("dispatchEvent(new Event('afterprint'))")
    assert opened.value(f"{folds}.every(e => !e.open)")
