"""The page in Chromium: opens without a word on the console or a request; links, filters, folding and printing work."""

from __future__ import annotations

import base64
import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from drivelint.result.model import Result
from tests.report.browser import CHROMIUM, Page
from tests.report.pages import nasty, page

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="chromium is not installed")


@pytest.fixture(scope="module")
def browser_page(overtakes: Result, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    folder = tmp_path_factory.mktemp("page")
    (folder / "report.html").write_text(page(overtakes), encoding="utf-8")
    with Page(folder / "profile", (folder / "report.html").as_uri()) as shown:
        yield shown


def test_it_opens_without_complaints_and_asks_for_nothing(browser_page: Page) -> None:
    assert browser_page.value("document.querySelectorAll('svg.plan').length") > 3
    assert browser_page.value("getComputedStyle(document.body).margin") == "0px"  # the policy let our style in
    assert browser_page.value("!document.querySelector('.filters').hidden")  # and our script
    assert browser_page.complaints() == []
    outside = [url for url in browser_page.requests() if not url.startswith(("file:", "data:"))]
    assert outside == []
    assert sum(url.startswith("file:") for url in browser_page.requests()) == 1


def test_filters_show_only_what_is_asked_for(browser_page: Page, overtakes: Result) -> None:
    near = [r for r in overtakes.verdicts.to_pylist() if r["near_miss"]]
    rows = overtakes.findings.to_pylist() + near
    shown = "[...document.querySelectorAll('#findings-table tbody tr')].filter(r => r.offsetHeight > 0).length"
    choose = (
        "(() => {{ const s = document.querySelector('select[name={}]'); s.value = {!r};"
        " s.dispatchEvent(new Event('change', {{bubbles: true}})); }})()"
    )
    assert browser_page.value(shown) == len(rows)
    browser_page.value(choose.format("verdict", "near"))
    assert browser_page.value(shown) == len(near) > 0
    browser_page.value(choose.format("verdict", ""))
    browser_page.value(choose.format("severity", "minor"))
    minor = sum(row["severity"] == "minor" for row in rows)
    assert 0 < minor < len(rows)
    assert browser_page.value(shown) == minor
    lines = "[...document.querySelectorAll('.timeline .tl[data-k]')].filter(r => !r.hidden)"
    assert browser_page.value(f"{lines}.length") > 0
    assert browser_page.value(f"{lines}.every(r => r.dataset.k.includes('minor'))")
    browser_page.value(choose.format("drive", rows[0]["drive_id"]))
    both = sum(row["severity"] == "minor" and row["drive_id"] == rows[0]["drive_id"] for row in rows)
    assert browser_page.value(shown) == both
    assert browser_page.value("document.querySelector('.filters output').textContent") == f"{both} of {len(rows)} shown"
    browser_page.value("new Promise(done => { document.querySelector('.filters').reset(); setTimeout(done, 20); })")
    assert browser_page.value(shown) == len(rows)


def test_rules_are_found_by_words_typed_on_the_keyboard(browser_page: Page, overtakes: Result) -> None:
    browser_page.value("document.querySelector('.filters input').focus()")
    for letter in "r162.safe":
        browser_page.call("Input.dispatchKeyEvent", type="keyDown", text=letter)
        browser_page.call("Input.dispatchKeyEvent", type="keyUp")
    rows = [row for row in overtakes.findings.to_pylist() if "r162.safe" in row["rule_id"]]
    near = [r for r in overtakes.verdicts.to_pylist() if r["near_miss"] and "r162.safe" in r["rule_id"]]
    shown = "[...document.querySelectorAll('#findings-table tbody tr')].filter(r => r.offsetHeight > 0).length"
    assert browser_page.value(shown) == len(rows) + len(near) > 0
    browser_page.value("new Promise(done => { document.querySelector('.filters').reset(); setTimeout(done, 20); })")


def test_the_arrow_keys_replay_a_scene(browser_page: Page, overtakes: Result) -> None:
    finding = next(r for r in overtakes.findings.to_pylist() if "r126.ds-" in r["rule_id"])
    browser_page.value(
        f"new Promise(done => {{ location.hash = 'finding-{finding['finding_id']}'; setTimeout(done, 500); }})"
    )
    browser_page.value(
        f"window.scene = document.getElementById('finding-{finding['finding_id']}').closest('.moment').querySelector('.scene'); 1"
    )
    ego = "scene.querySelector('use.b-ego').getAttribute('transform')"
    spaces = "[...scene.querySelectorAll('.spaces path')].map(p => p.getAttribute('d')).join()"
    before, rings, said = (
        browser_page.value(ego),
        browser_page.value(spaces),
        browser_page.value("scene.querySelector('output').textContent"),
    )
    browser_page.value("scene.querySelector('input').focus()")
    for _ in range(10):
        for kind in ("keyDown", "keyUp"):
            browser_page.call(
                "Input.dispatchKeyEvent", type=kind, key="ArrowLeft", code="ArrowLeft", windowsVirtualKeyCode=37
            )
    there = browser_page.value(ego)
    scene = next(
        s for s in overtakes.scenes.to_pylist()
        if (s["drive_id"], s["t_ns"]) == (finding["drive_id"], finding["t_worst_ns"])
    )  # fmt: skip
    path = scene["actors"][0]["path"]
    t = [finding["t_worst_ns"], finding["t_worst_ns"] - 1_000_000_000]
    moved = [[float(v) for v in re.findall(r"-?[\d.]+", text)[:2]] for text in (before, there)]
    for i, axis in enumerate(("x_m", "y_m")):
        here, back = np.interp(t, [p["t_ns"] for p in path], [p[axis] for p in path])
        assert (moved[1][i] - moved[0][i]) / 10 == pytest.approx(back - here, abs=0.02)
    assert browser_page.value(spaces) != rings != ""
    assert float(browser_page.value("scene.querySelector('output').textContent").split()[0]) == pytest.approx(
        float(said.split()[0]) - 1
    )
    browser_page.value(
        "(() => { const r = scene.querySelector('input'); r.value = scene.dataset.t; r.dispatchEvent(new Event('input')); })()"
    )
    assert browser_page.value(ego) == before
    assert browser_page.value(spaces) == rings
    assert browser_page.complaints() == []


def test_a_findings_link_lands_on_it_though_its_drive_is_folded(browser_page: Page, overtakes: Result) -> None:
    anchor = f"finding-{overtakes.findings['finding_id'][-1].as_py()}"
    browser_page.value("document.querySelectorAll('details').forEach(d => { d.open = false; })")
    assert not browser_page.value(f"document.getElementById('{anchor}').checkVisibility()")
    # hashchange, then whatever is laid out as it comes into sight
    frames = "requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done, 300)))"
    browser_page.value(
        f"new Promise(done => {{ addEventListener('hashchange', () => {frames}); location.hash = '{anchor}'; }})"
    )
    assert browser_page.value(f"document.getElementById('{anchor}').checkVisibility()")
    box = browser_page.value(f"document.getElementById('{anchor}').getBoundingClientRect().toJSON()")
    assert box["height"] > 10
    assert -1 <= box["top"] < 900


def test_everything_can_be_reached_by_keyboard(browser_page: Page) -> None:
    reachable = "document.querySelectorAll('a[href], summary, select, button, input').length"
    negative = "document.querySelectorAll('[tabindex=\"-1\"]').length"
    assert browser_page.value(reachable) > 20
    assert browser_page.value(negative) == 0
    named = "[...document.querySelectorAll('svg a')].every(a => a.getAttribute('aria-label'))"
    assert browser_page.value(named)


@pytest.mark.parametrize("width", [390, 1280])
def test_nothing_sticks_out_to_the_side(overtakes: Result, tmp_path: Path, width: int) -> None:
    file = tmp_path / "report.html"
    file.write_text(page(overtakes), encoding="utf-8")
    with Page(tmp_path / "profile", file.as_uri(), width) as shown:
        shown.call(
            "Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=width < 500
        )
        assert shown.value("document.documentElement.scrollWidth") <= width


def test_it_is_dark_where_the_reader_wants_it_dark(overtakes: Result, tmp_path: Path, browser_page: Page) -> None:
    file = tmp_path / "report.html"
    file.write_text(page(overtakes), encoding="utf-8")
    background = "getComputedStyle(document.body).backgroundColor.match(/\\d+/g).map(Number)[0]"
    with Page(tmp_path / "profile", file.as_uri(), dark=True) as dark:
        assert dark.value(background) < 64
    assert browser_page.value(background) > 192


@pytest.mark.ci
def test_it_prints_whole_though_folded(browser_page: Page) -> None:
    browser_page.value("document.querySelectorAll('details').forEach(d => { d.open = false; })")
    pdf = base64.b64decode(browser_page.call("Page.printToPDF", printBackground=True)["data"])
    assert pdf.startswith(b"%PDF")
    assert len(re.findall(rb"/Type\s*/Page\b", pdf)) >= 4
    assert browser_page.value("document.querySelectorAll('.drive[open]').length") == 0  # folded again


@pytest.mark.ci
def test_markup_in_names_does_nothing(tmp_path: Path) -> None:
    file = tmp_path / "a 'quoted' & <odd> name.html"
    file.write_text(page(nasty()), encoding="utf-8")
    with Page(tmp_path / "profile", file.as_uri()) as shown:
        assert shown.complaints() == []
        assert shown.value("document.querySelectorAll('script:not([type=\"application/json\"])').length") == 1
        assert shown.value("document.querySelectorAll('svg.plan .name').length") > 1
