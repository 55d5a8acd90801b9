"""The fleet page and a drive page in Chromium: no complaint, no request, sorting works, nothing wider than the window."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from lxml import html

from tests.fleet_report import lake
from tests.fleet_report.command import ran
from tests.report.browser import CHROMIUM, Page

pytestmark = [pytest.mark.ci, pytest.mark.skipif(CHROMIUM is None, reason="chromium is not installed")]


@pytest.fixture(scope="module", params=[1280, 400])
def browser_page(
    request: pytest.FixtureRequest, filled: lake.Lake, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Page]:
    assert ran("report", filled.folder, "--by", "release", "--baseline", filled.folder).code == 0
    page = tmp_path_factory.mktemp("page")
    with Page(
        page / "profile", (filled.folder / "fleet.html").as_uri(), width=request.param, dark=request.param == 400
    ) as shown:
        yield shown


def test_it_opens_without_complaints_and_asks_for_nothing(browser_page: Page) -> None:
    assert browser_page.value("getComputedStyle(document.body).margin") == "0px", "the policy let our style in"
    assert browser_page.value("document.querySelectorAll('.rate-bar').length") > 30
    assert browser_page.complaints() == []
    assert all(url.startswith(("file:", "data:")) for url in browser_page.requests())


def test_nothing_is_wider_than_the_window(browser_page: Page) -> None:
    assert browser_page.value("document.documentElement.scrollWidth <= document.documentElement.clientWidth")


def test_no_text_runs_out_of_the_window_where_it_is_cut_off(browser_page: Page) -> None:
    """The page clips what is wider than itself, so that its own width does not tell."""
    beyond = "e => e.getBoundingClientRect().right > innerWidth + 1"
    assert (
        browser_page.value(
            f"[...document.querySelectorAll('.tied, .command, h1, p')].filter({beyond}).map(e => e.className)"
        )
        == []
    )


def test_a_click_on_a_head_sorts_by_numbers(browser_page: Page) -> None:
    column = "[...document.querySelectorAll('.rate-table tbody tr')].map(r => Number(r.cells[2].dataset.v))"
    browser_page.value("document.querySelectorAll('.rate-table thead th button')[2].click()")
    rising = browser_page.value(column)
    assert rising == sorted(rising)
    browser_page.value("document.querySelectorAll('.rate-table thead th button')[2].click()")
    falling = browser_page.value(column)
    assert falling == sorted(rising, reverse=True)
    assert falling[0] > 0


def test_bars_lie_where_their_rates_are(browser_page: Page) -> None:
    """A higher rate lies further to the right."""
    told = browser_page.value(
        "[...document.querySelectorAll('.rate-table tbody tr')].filter(r => r.querySelector('.rate'))"
        ".map(r => [Number(r.cells[3].dataset.v), r.querySelector('.rate').getBoundingClientRect().left])"
    )
    assert len(told) > 10
    assert [x for _, x in sorted(told)] == sorted(x for _, x in told)


def test_every_column_of_the_rates_is_seen(browser_page: Page) -> None:
    assert browser_page.value(
        "[...document.querySelectorAll('.rate-table, .by-tag')].every(e => e.scrollWidth <= e.clientWidth)"
    )


def test_rates_without_findings_are_folded(browser_page: Page) -> None:
    seen = "[...document.querySelectorAll('.rate-table .idle')].filter(e => e.offsetHeight).length"
    assert browser_page.value("document.querySelectorAll('.rate-table .idle').length") > 10
    assert browser_page.value(seen) == 0
    browser_page.value("document.querySelector('.idle-switch summary').click()")
    assert browser_page.value(seen) == browser_page.value("document.querySelectorAll('.rate-table .idle').length")
    browser_page.value("document.querySelector('.idle-switch summary').click()")


def test_no_list_of_the_page_is_a_box_that_scrolls(browser_page: Page) -> None:
    boxes = "e => /auto|scroll/.test(getComputedStyle(e).overflowY) && e.scrollHeight > e.clientHeight + 1"
    assert browser_page.value(f"[...document.body.querySelectorAll('*')].filter({boxes}).length") == 0


def test_the_worst_drives_stand_on_the_page_the_first_ten_of_any_order(browser_page: Page) -> None:
    assert browser_page.value("getComputedStyle(document.querySelector('.worst-table')).overflow") == "visible"
    assert browser_page.value(
        "document.querySelector('.worst-table table').getBoundingClientRect().right <= document.documentElement.clientWidth"
    )
    seen = "[...document.querySelectorAll('.worst-table tbody tr')].filter(e => e.offsetHeight).length"
    assert browser_page.value(seen) == 10
    browser_page.value("document.querySelectorAll('.worst-table thead th button')[4].click()")
    assert browser_page.value(seen) == 10
    browser_page.value("document.querySelector('.more-switch summary').click()")
    assert (
        browser_page.value(seen) == browser_page.value("document.querySelectorAll('.worst-table tbody tr').length") > 10
    )
    browser_page.value("document.querySelector('.more-switch summary').click()")


def test_folded_lists_are_open_on_paper_and_tables_are_not_cut(browser_page: Page) -> None:
    folds = "[...document.querySelectorAll('.on-paper')]"
    browser_page.value(f"{folds}.forEach(e => {{ e.open = false; }})")
    browser_page.value("dispatchEvent(new Event('beforeprint'))")
    browser_page.call("Emulation.setEmulatedMedia", media="print")
    assert browser_page.value(f"{folds}.length && {folds}.every(e => e.open)")
    assert browser_page.value("getComputedStyle(document.querySelector('.by-tag')).display") == "block"
    assert browser_page.value("getComputedStyle(document.querySelector('.by-tag table')).breakInside") == "avoid"
    browser_page.call("Emulation.setEmulatedMedia", media="")
    browser_page.value("dispatchEvent(new Event('afterprint'))")
    assert browser_page.value(f"{folds}.every(e => !e.open)")


@pytest.fixture(scope="module", params=[1440, 390])
def drive_page(
    request: pytest.FixtureRequest, filled: lake.Lake, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Page]:
    """Return the page of the worst drive."""
    assert ran("report", filled.folder).code == 0
    fleet_page: Any = html.fromstring((filled.folder / "fleet.html").read_bytes())
    link = fleet_page.xpath("//*[@class='worst-table']//th/a/@href")[0]
    home = tmp_path_factory.mktemp("drive")
    with Page(
        home / "profile", (filled.folder / link).as_uri(), width=request.param, dark=request.param == 390
    ) as shown:
        yield shown


def test_a_drive_page_opens_without_complaints_and_asks_for_nothing(drive_page: Page) -> None:
    assert drive_page.value("getComputedStyle(document.body).margin") == "0px", "the policy let our style in"
    assert drive_page.value("document.querySelectorAll('.drive-findings tbody tr').length") >= lake.WORST
    assert drive_page.complaints() == []
    assert all(url.startswith(("file:", "data:")) for url in drive_page.requests())


def test_a_drive_page_is_not_wider_than_the_window_and_has_no_box_that_scrolls(drive_page: Page) -> None:
    assert drive_page.value("document.documentElement.scrollWidth <= document.documentElement.clientWidth")
    boxes = "[...document.querySelectorAll('main *')].filter(e => /auto|scroll/.test(getComputedStyle(e).overflow))"
    assert drive_page.value(f"{boxes}.length") == 0


def test_findings_of_a_drive_are_sorted_by_a_click(drive_page: Page) -> None:
    times = "[...document.querySelectorAll('.drive-findings tbody tr')].map(r => Number(r.cells[2].dataset.v))"
    drive_page.value("document.querySelectorAll('.drive-findings thead th button')[2].click()")
    rising = drive_page.value(times)
    assert rising == sorted(rising)
    assert rising[-1] > rising[0]


def test_paper_has_the_whole_drive_page_within_its_width(drive_page: Page) -> None:
    drive_page.call("Emulation.setEmulatedMedia", media="print")
    drive_page.call("Emulation.setDeviceMetricsOverride", width=703, height=1000, deviceScaleFactor=1, mobile=False)
    assert drive_page.value("document.documentElement.scrollWidth <= 703")
    assert drive_page.value("getComputedStyle(document.querySelector('.drive-findings tr')).breakInside") == "avoid"
    drive_page.call("Emulation.clearDeviceMetricsOverride")
    drive_page.call("Emulation.setEmulatedMedia", media="")


@pytest.mark.slow
def test_its_link_leads_back_to_the_fleet_page(drive_page: Page) -> None:
    """The last test of the page, as it leaves it."""
    assert drive_page.value("document.querySelector('header a').offsetHeight > 0")
    drive_page.events.clear()
    drive_page.value("document.querySelector('header a').click()")
    drive_page._until("Page.loadEventFired")
    assert (
        drive_page.value(
            "location.pathname.endsWith('/fleet.html') && document.querySelectorAll('.worst-table').length"
        )
        == 1
    )
