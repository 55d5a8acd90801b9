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
