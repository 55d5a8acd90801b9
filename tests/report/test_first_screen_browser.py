"""The first screen in Chromium: one cursor over the strips, sorted tables, filters in the address, nothing too wide, pages in print."""

from __future__ import annotations

import base64
import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pyarrow as pa
import pytest

from drivelint.result.model import Result
from tests.report.browser import CHROMIUM, Page
from tests.report.pages import page

pytestmark = [pytest.mark.ci, pytest.mark.skipif(CHROMIUM is None, reason="chromium is not installed")]

TOO_WIDE = """[...document.querySelectorAll('table, .card *')].filter(e => {
  const box = e.getBoundingClientRect(), room = (e.closest('.card') || e.closest('section')).getBoundingClientRect();
  return box.width > 0 && box.right > room.right + 1 && !e.closest('svg, .scroll, .steps');
}).map(e => `${e.className} ${e.textContent.slice(0, 60)}`)"""
COLUMN = "[...document.querySelectorAll('#findings-table tbody tr')].map(r => r.cells[{}].textContent)"


@pytest.fixture(scope="module")
def file(overtakes: Result, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("page") / "report.html"
    path.write_text(page(overtakes), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def browser_page(file: Path) -> Iterator[Page]:
    with Page(file.parent / "profile", file.as_uri(), 1440) as shown:
        yield shown


def test_the_worst_moment_is_on_the_first_screen(browser_page: Page) -> None:
    for what in ("h1", ".inputs", ".gate-line", ".hero svg.plan", ".hero .replay", ".hero-facts .big"):
        box = browser_page.value(f"document.querySelector('{what}').getBoundingClientRect().toJSON()")
        assert 0 <= box["top"] < box["bottom"] <= 900, what
        assert box["width"] > 0


def test_one_cursor_runs_over_all_strips_with_the_scene(browser_page: Page) -> None:
    move = "(() => {{ const r = document.querySelector('.hero input'); r.value = {}; r.dispatchEvent(new Event('input')); }})()"
    cursor = "document.querySelector('.strips .cursor')"
    ego = "document.querySelector('.hero use.b-ego').getAttribute('transform')"
    start, end = (int(browser_page.value(f"document.querySelector('.strips').dataset.{n}")) for n in ("from", "to"))
    home = int(browser_page.value("document.querySelector('.hero .scene').dataset.t"))
    there = browser_page.value(ego)
    browser_page.value(move.format(home - 200))
    assert browser_page.value(ego) != there
    at = float(re.findall(r"[\d.]+", browser_page.value(f"{cursor}.getAttribute('transform')"))[0])
    assert at == pytest.approx(46 + 546 * (home - 200 - start) / (end - start), abs=0.1)
    assert browser_page.value(f"{cursor}.getAttribute('visibility')") == "visible"
    assert browser_page.value(f"{cursor}.getBoundingClientRect().height") > 100
    browser_page.value(move.format(home))
    assert browser_page.value(ego) == there


def test_a_click_sorts_and_the_address_remembers(browser_page: Page, file: Path) -> None:
    head = "[...document.querySelectorAll('#findings-table th')].findIndex(h => h.textContent.startsWith('when'))"
    n = browser_page.value(head)
    press = f"document.querySelectorAll('#findings-table thead th')[{n}].querySelector('button').click()"
    for direction, reverse in (("ascending", False), ("descending", True)):
        browser_page.value(press)
        times = [float(cell.split("\u00a0")[0]) for cell in browser_page.value(COLUMN.format(n))]
        assert times == sorted(times, reverse=reverse)
        assert len(set(times)) > 3
        assert browser_page.value(f"document.querySelectorAll('#findings-table thead th')[{n}].ariaSort") == direction
    browser_page.value(
        "(() => { const s = document.querySelector('select[name=severity]'); s.value = 'major';"
        " s.dispatchEvent(new Event('input', {bubbles: true})); })()"
    )
    address = browser_page.value("location.hash")
    assert address == f"#?severity=major&sort={n}-"
    with Page(file.parent / "again", f"{file.as_uri()}{address}", 1440) as again:
        assert again.value("document.querySelector('select[name=severity]').value") == "major"
        assert again.value(COLUMN.format(n)) == browser_page.value(COLUMN.format(n))
        assert again.value("document.querySelector('.filters output').textContent") == browser_page.value(
            "document.querySelector('.filters output').textContent"
        )
    browser_page.value("new Promise(done => { document.querySelector('.filters').reset(); setTimeout(done, 20); })")
    assert browser_page.value("location.hash") == ""
    assert browser_page.complaints() == []


@pytest.mark.parametrize("width", [390, 1280])
def test_nothing_is_too_wide_even_if_all_is_opened(file: Path, tmp_path: Path, width: int) -> None:
    with Page(tmp_path / "profile", file.as_uri(), width) as shown:
        shown.call(
            "Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=width < 500
        )
        shown.value("document.querySelectorAll('details').forEach(d => { d.open = true; })")
        assert shown.value("document.querySelectorAll('.clause-fold .param').length") > 0
        assert shown.value(TOO_WIDE) == []
        assert shown.value("document.documentElement.scrollWidth") <= width


def repeat_drives(run: Result, n: int) -> Result:
    """Return a result of `n` drives: those of `run` again and again under other ids; a third of them without findings."""
    parts = {}
    for name in (
        "verdicts",
        "findings",
        "drives",
        "scenes",
        "spaces",
        "courses",
        "tracks",
        "overtakes",
        "opportunities",
    ):
        rows = getattr(run, name)
        names = run.drives["drive_id"].to_pylist()
        copies = []
        for k in range(n // len(names)):
            for row in rows.to_pylist():
                if name == "findings" and (names.index(row["drive_id"]) + k) % 3 == 0:
                    continue
                again = row | {"drive_id": f"{row['drive_id']}-{k:03}"}
                if row.get("finding_id"):
                    again["finding_id"] = f"{row['finding_id']}{k:03}"
                copies.append(again)
        parts[name] = pa.Table.from_pylist(copies, schema=rows.schema)
    return replace(run, **parts)


@pytest.mark.slow
def test_three_hundred_drives_are_small_and_print_on_few_pages(overtakes: Result, tmp_path: Path) -> None:
    text = page(repeat_drives(overtakes, 300))
    assert len(text) < 4_000_000
    path = tmp_path / "report.html"
    path.write_text(text, encoding="utf-8")
    with Page(tmp_path / "profile", path.as_uri(), 1440) as shown:
        pdf = base64.b64decode(shown.call("Page.printToPDF", printBackground=True, preferCSSPageSize=True)["data"])
        assert 8 <= len(re.findall(rb"/Type\s*/Page\b", pdf)) < 20
        assert shown.value("document.querySelectorAll('.index li').length") == 300
        shown.call("Emulation.setEmulatedMedia", media="print")
        assert shown.value("getComputedStyle(document.querySelector('.index')).display") == "block"
        closed = "[...document.querySelectorAll('.drive:not(.telling)')]"
        assert shown.value(f"{closed}.every(d => getComputedStyle(d).display === 'none')")
        assert shown.value("getComputedStyle(document.querySelector('.drive')).breakBefore") == "page"
        assert shown.complaints() == []
