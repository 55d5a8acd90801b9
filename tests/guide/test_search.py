"""The search of `drivelint docs --html`: what the index has, and what somebody who types sees in a browser."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from drivelint import guide
from drivelint.guide import html, search, site
from tests.report.browser import CHROMIUM, Page

HITS = "[...document.querySelectorAll('#hits a')].map(a => [a.getAttribute('href'), a.firstChild.data])"


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a site."""
    return site.write(tmp_path_factory.mktemp("site"), ()).parent


def entries(script: bytes) -> list[Any]:
    text = script.decode().strip()
    assert text.startswith("drivelintPages(")
    assert text.endswith(");")
    return list(json.loads(text.removeprefix("drivelintPages(").removesuffix(");")))


def test_a_section_has_each_word_under_its_heading_once() -> None:
    text = "# One *two*\n\nThe `--map-offset` word, a word.\n\n## Next\n\n| a.b | c |\n|---|---|\n| d | e_f |\n\n```sh\nls x.mcap\n```\n"
    assert list(search.sections(html.parse(text))) == [
        ("one-two", "One two", "a map-offset one the two word"),
        ("next", "Next", "a.b c d e_f ls next x.mcap"),
    ]


def test_the_index_has_every_page_with_its_title_first(pages: Path) -> None:
    script = (pages / search.INDEX_FILE).read_bytes()
    found = dict(entries(script))
    assert found.keys() == {file.stem for file in pages.glob("*.html")}
    assert {topic.name: topic.title for topic in guide.topics()}.items() <= {
        n: p[0][1] for n, p in found.items()
    }.items()
    assert len(script) < 600_000
    assert search.index_script(
        {name: html.parse(guide.text(name)) for name in guide.TOPICS[:2]}
    ) == search.index_script({name: html.parse(guide.text(name)) for name in guide.TOPICS[:2]})


@pytest.fixture(params=[(1280, False), (390, True)], ids=["wide and light", "narrow and dark"])
def page(request: pytest.FixtureRequest, pages: Path, tmp_path: Path) -> Iterator[Page]:
    """Return the guide to CI in a browser."""
    if CHROMIUM is None:
        pytest.skip("chromium is not installed")
    width, dark = request.param
    with Page(tmp_path / "profile", (pages / "ci.html").as_uri(), width, dark=dark) as opened:
        opened.call(
            "Emulation.setDeviceMetricsOverride", width=width, height=800, deviceScaleFactor=1, mobile=width < 500
        )
        yield opened
        assert opened.complaints() == []
        assert all(url.startswith("file://") for url in opened.requests())


def typed(page: Page, words: str) -> list[list[str]]:
    """Type into the field, as a keyboard does; return (address, heading) of what is listed."""
    page.value("document.querySelector('header input').select()")
    page.call("Input.insertText", text=words)
    page.value("new Promise(done => { const wait = () => sections ? done() : setTimeout(wait, 10); wait(); })")
    return list(page.value(HITS))


def press(page: Page, key: str) -> None:
    text = {"text": "\r"} if key == "Enter" else {}
    code = {"Enter": 13, "Escape": 27, "ArrowDown": 40, "ArrowUp": 38}[key]
    page.call("Input.dispatchKeyEvent", type="keyDown", key=key, windowsVirtualKeyCode=code, **text)
    page.call("Input.dispatchKeyEvent", type="keyUp", key=key, windowsVirtualKeyCode=code)


def visible_part(page: Page) -> bool:
    """Whether the list is within the screen, over what is beside it."""
    corners = (
        "(() => { const b = document.getElementById('hits').getBoundingClientRect();"
        " const at = document.elementFromPoint(b.left + b.width / 2, b.top + 20);"
        " return b.left >= 0 && b.right <= innerWidth && b.bottom <= innerHeight && !!at.closest('#hits'); })()"
    )
    return bool(page.value(corners))


@pytest.mark.ci
def test_typing_lists_pages_before_headings_before_text_and_enter_opens_the_first(page: Page, pages: Path) -> None:
    assert page.value("document.getElementById('hits').hidden")
    hits = typed(page, "Waivers")
    assert hits[0] == ["ci.html#waivers", "Waivers"]
    assert 1 < len(hits) <= 12
    assert typed(page, "maps")[0] == ["maps.html", guide.topics()[guide.TOPICS.index("maps")].title]
    assert typed(page, "--map-offset"), "an option is found in the text"
    hits = typed(page, "exit codes strict")
    assert ["ci.html#exit-codes", "Exit codes"] in hits, "each word is there"
    assert visible_part(page)
    assert page.value("document.documentElement.scrollWidth <= innerWidth")
    assert typed(page, "nobodywroteaboutthis") == []
    assert page.value("document.getElementById('hits').innerText") == "Nothing was found."
    assert typed(page, "time stamp evidence pack")[0][0].startswith("evidence-pack.html")
    page.events.clear()
    press(page, "Enter")
    page._until("Page.loadEventFired")
    assert page.value("location.pathname").endswith("/evidence-pack.html")


@pytest.mark.ci
def test_arrows_walk_through_the_list_and_escape_closes_it(page: Page) -> None:
    page.value("document.dispatchEvent(new KeyboardEvent('keydown', {key: '/'}))")
    assert page.value("document.activeElement.type") == "search"
    (_, second, *_) = typed(page, "waivers")
    press(page, "ArrowDown")
    press(page, "ArrowDown")
    assert page.value("document.activeElement.getAttribute('href')") == second[0]
    press(page, "ArrowUp")
    press(page, "ArrowUp")
    assert page.value("document.activeElement.type") == "search"
    press(page, "Escape")
    assert page.value("document.getElementById('hits').hidden")
