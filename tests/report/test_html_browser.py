"""The page in Chromium: opens without a word on the console or a request; links, filters, folding and printing work."""

from __future__ import annotations

import base64
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from drivelint.report.result import Result
from tests.report import test_evidence
from tests.report.browser import CHROMIUM, Page
from tests.report.test_html import nasty, page

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="chromium is not installed")


@pytest.fixture(scope="module")
def overtakes(tmp_path_factory: pytest.TempPathFactory) -> Result:
    return test_evidence.run(tmp_path_factory.mktemp("overtakes"))


@pytest.fixture(scope="module")
def opened(overtakes: Result, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    folder = tmp_path_factory.mktemp("page")
    (folder / "report.html").write_text(page(overtakes), encoding="utf-8")
    with Page(folder / "profile", (folder / "report.html").as_uri()) as shown:
        yield shown


def test_it_opens_without_complaints_and_asks_for_nothing(opened: Page) -> None:
    assert opened.value("document.querySelectorAll('svg.plan').length") > 3
    assert opened.value("getComputedStyle(document.body).margin") == "0px"  # the policy let our style in
    assert opened.value("!document.querySelector('.filters').hidden")  # and our script
    assert opened.complaints() == []
    outside = [url for url in opened.requests() if not url.startswith(("file:", "data:"))]
    assert outside == []
    assert sum(url.startswith("file:") for url in opened.requests()) == 1


def test_filters_show_only_what_is_asked_for(opened: Page, overtakes: Result) -> None:
    rows = overtakes.findings.to_pylist()
    shown = "[...document.querySelectorAll('#findings-table tbody tr')].filter(r => r.offsetHeight > 0).length"
    choose = (
        "(() => {{ const s = document.querySelector('select[name={}]'); s.value = {!r};"
        " s.dispatchEvent(new Event('change', {{bubbles: true}})); }})()"
    )
    assert opened.value(shown) == len(rows)
    opened.value(choose.format("severity", "minor"))
    minor = sum(row["severity"] == "minor" for row in rows)
    assert 0 < minor < len(rows)
    assert opened.value(shown) == minor
    opened.value(choose.format("drive", rows[0]["drive_id"]))
    both = sum(row["severity"] == "minor" and row["drive_id"] == rows[0]["drive_id"] for row in rows)
    assert opened.value(shown) == both
    assert opened.value("document.querySelector('.filters output').textContent") == f"{both} of {len(rows)} shown"
    opened.value("new Promise(done => { document.querySelector('.filters').reset(); setTimeout(done, 20); })")
    assert opened.value(shown) == len(rows)


def test_a_findings_link_lands_on_it_though_its_drive_is_folded(opened: Page, overtakes: Result) -> None:
    anchor = f"finding-{overtakes.findings['finding_id'][-1].as_py()}"
    opened.value("document.querySelectorAll('details').forEach(d => { d.open = false; })")
    assert not opened.value(f"document.getElementById('{anchor}').checkVisibility()")
    opened.value(f"new Promise(done => {{ location.hash = '{anchor}'; setTimeout(done, 700); }})")
    assert opened.value(f"document.getElementById('{anchor}').checkVisibility()")
    box = opened.value(f"document.getElementById('{anchor}').getBoundingClientRect().toJSON()")
    assert box["height"] > 10
    assert -1 <= box["top"] < 900


def test_everything_can_be_reached_by_keyboard(opened: Page) -> None:
    reachable = "document.querySelectorAll('a[href], summary, select, button').length"
    negative = "document.querySelectorAll('[tabindex=\"-1\"]').length"
    assert opened.value(reachable) > 20
    assert opened.value(negative) == 0
    named = "[...document.querySelectorAll('svg a')].every(a => a.getAttribute('aria-label'))"
    assert opened.value(named)


@pytest.mark.parametrize("width", [390, 1280])
def test_nothing_sticks_out_to_the_side(overtakes: Result, tmp_path: Path, width: int) -> None:
    file = tmp_path / "report.html"
    file.write_text(page(overtakes), encoding="utf-8")
    with Page(tmp_path / "profile", file.as_uri(), width) as shown:
        shown.call(
            "Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=width < 500
        )
        assert shown.value("document.documentElement.scrollWidth") <= width


def test_it_is_dark_where_the_reader_wants_it_dark(overtakes: Result, tmp_path: Path, opened: Page) -> None:
    file = tmp_path / "report.html"
    file.write_text(page(overtakes), encoding="utf-8")
    background = "getComputedStyle(document.body).backgroundColor.match(/\\d+/g).map(Number)[0]"
    with Page(tmp_path / "profile", file.as_uri(), dark=True) as dark:
        assert dark.value(background) < 64
    assert opened.value(background) > 192


def test_it_prints_whole_though_folded(opened: Page) -> None:
    opened.value("document.querySelectorAll('details').forEach(d => { d.open = false; })")
    pdf = base64.b64decode(opened.call("Page.printToPDF", printBackground=True)["data"])
    assert pdf.startswith(b"%PDF")
    assert len(re.findall(rb"/Type\s*/Page\b", pdf)) >= 4
    assert opened.value("document.querySelectorAll('.drive[open]').length") == 0  # folded again


def test_markup_in_names_does_nothing(tmp_path: Path) -> None:
    file = tmp_path / "a 'quoted' & <odd> name.html"
    file.write_text(page(nasty()), encoding="utf-8")
    with Page(tmp_path / "profile", file.as_uri()) as shown:
        assert shown.complaints() == []
        assert shown.value("document.querySelectorAll('script').length") == 1
        assert shown.value("document.querySelectorAll('svg.plan .name').length") > 1
