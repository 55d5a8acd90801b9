"""Files that others open: each is read by a reader of its format, and nothing of a stranger's is more than text in it."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import msgspec
import pyarrow.parquet as pq
import pytest
from lxml import etree
from markdown_it import MarkdownIt
from mcap.reader import make_reader

import drivelint
from tests.fleet_report.command import ran
from tests.hostile.drive import SCENE, write_mcap
from tests.hostile.readers import STEERING, assert_markdown_is_ours, assert_page_is_ours
from tests.hostile.words import EGO, EVIL, MARK, ONCOMING
from tests.report.browser import CHROMIUM, Page

if TYPE_CHECKING:
    from pathlib import Path

    from tests.hostile.conftest import Nasty


def pages(nasty: Nasty) -> list[Path]:
    if not (nasty.result / "incidents").exists():
        for words in (
            ("report", nasty.result, "--incident", "ukhc.no-collision"),
            ("report", nasty.audit, "--by", EVIL.replace("\0", "")),
        ):
            done = ran(*words)
            assert done.code == 0, done.err
    (sheet,) = (nasty.result / "incidents").iterdir()
    of_the_drive = sorted((nasty.audit / "drives").glob("*.html"))
    assert len(of_the_drive) == 2, "its page, and its moments"
    return [nasty.result / "report.html", sheet, nasty.audit / "fleet.html", *of_the_drive]


@pytest.mark.slow
def test_every_element_of_a_page_is_ours(nasty: Nasty) -> None:
    for file in pages(nasty):
        page = assert_page_is_ours(file.read_text(encoding="utf-8"))
        assert sum(MARK in text for text in page.texts) > 2, file.name


@pytest.mark.ci
@pytest.mark.skipif(CHROMIUM is None, reason="chromium is not installed")
def test_nothing_runs_in_a_browser(nasty: Nasty, tmp_path: Path) -> None:
    for no, file in enumerate(pages(nasty)):
        plain = tmp_path / f"{no}.html"
        plain.write_bytes(file.read_bytes())
        with Page(tmp_path / f"profile-{no}", plain.as_uri()) as shown:
            assert shown.complaints() == []
            assert [url for url in shown.requests() if not url.startswith(("file:", "data:"))] == []
            assert shown.value("document.querySelectorAll('img, iframe, object, embed, form[action]').length") == 0
            links = shown.value("[...document.querySelectorAll('a')].map(a => a.protocol || a.href.baseVal)")
            assert {link for link in links if link and not link.startswith("#")} <= {"file:"}
            assert "forged" in shown.value("document.documentElement.textContent")


def test_a_notebook_shows_text(nasty: Nasty) -> None:
    html = drivelint.open(nasty.result)._repr_html_()
    page = assert_page_is_ours(f"<html><head><title></title></head><body>{html}</body></html>")
    assert any(MARK in text for text in page.texts)


def test_markdown(nasty: Nasty) -> None:
    for words, file in (
        (("report", nasty.result, "--to", "markdown"), nasty.result / "report.md"),
        (("report", nasty.audit, "--to", "markdown", "--by", EVIL.replace("\0", "")), nasty.audit / "fleet.md"),
    ):
        done = ran(*words)
        assert done.code == 0, done.err
        said = assert_markdown_is_ours(file.read_text(encoding="utf-8"))
        assert any(MARK in each for each in said)
    said = assert_markdown_is_ours(ran("diff", nasty.result, nasty.result, "--format", "markdown").out)
    assert said
    page = ran("rules", "page", nasty.files.rules)
    assert page.code == 0, page.err
    shown = MarkdownIt("commonmark", {"html": True}).enable("table").render(page.out)
    assert {match[0] for match in STEERING.finditer(page.out)} == set()
    for mark in ("<script", "<img", '<a href="javascript', "<a href='javascript", 'evil.example/p.png"'):
        assert mark not in shown


def test_a_command_in_markdown_is_the_command() -> None:
    """A backtick that became an apostrophe ended the quotes of a name, and ran what stood behind it."""
    from drivelint.report.markdown import markdown_code

    command = "drivelint check 'a`;touch pwned;`.csv'"
    (inline,) = [token for token in MarkdownIt().parse(markdown_code(command)) if token.type == "inline"]
    assert [(child.type, child.content) for child in inline.children or []] == [("code_inline", command)]


def test_xml(nasty: Nasty) -> None:
    for format_, name in (("junit", "junit.xml"), ("xqar", "report.xqar")):
        assert ran("report", nasty.result, "--to", format_).code == 0
        content = (nasty.result / name).read_bytes()
        root = etree.fromstring(content, etree.XMLParser(resolve_entities=False))
        assert {match[0] for match in STEERING.finditer(content.decode().replace("&#13;", "\r"))} == set()
        words = [*root.itertext(), *(value for each in root.iter() for value in each.attrib.values())]
        assert sum("<script>alert(1)</script>" in word for word in words) > 2
        assert not {"script", "img", "a"} & {each.tag for each in root.iter()}


def test_sarif_and_json(nasty: Nasty) -> None:
    assert ran("report", nasty.result, "--to", "sarif").code == 0
    told = json.loads((nasty.result / "report.sarif").read_bytes())
    assert {STEERING.search((nasty.result / "report.sarif").read_text("utf-8"))} == {None}
    texts = [found["message"] for found in told["runs"][0]["results"]]
    assert any(ONCOMING in message["text"] for message in texts)
    assert all(message.keys() == {"text"} for message in texts)  # no Markdown, no arguments of placeholders
    summary = json.loads((nasty.result / "summary.json").read_bytes())
    assert MARK in json.dumps(summary)


def test_tables_have_the_words_as_they_are(nasty: Nasty) -> None:
    rows = pq.read_table(nasty.result / "findings.parquet").to_pydict()
    assert set(rows["ego_id"]) == {EGO}
    assert ONCOMING in rows["object_id"]


def messages(path: Path) -> list[tuple[str, str, bytes]]:
    with path.open("rb") as file:
        return [
            (c.topic, c.message_encoding, m.data) for _, c, m in make_reader(file, validate_crcs=True).iter_messages()
        ]


@pytest.mark.ci
def test_an_annotated_log_is_read_by_others(nasty: Nasty, tmp_path: Path) -> None:
    (log,) = (nasty.result / "annotated").glob("*.mcap")
    found = [json.loads(data.decode()) for topic, encoding, data in messages(log) if encoding == "json"]
    assert EGO in {told.get("ego_id") for told in found}
    copied = tmp_path / "topics.mcap"
    write_mcap(copied)
    road = SCENE.with_name("overtake-road.xodr")
    done = ran(
        "check", copied, "--map", road, "--rules", "ukhc.no-collision", "--no-robustness", "--out", tmp_path / "out"
    )
    assert done.code == 1, done.err
    (log,) = (tmp_path / "out" / "annotated").glob("*.mcap")
    told = messages(log)
    assert [data for topic, _, data in told if topic == f"/{EVIL}"] == [EVIL.encode()]
    assert any(topic.startswith("/drivelint/") for topic, *_ in told)
    with log.open("rb") as file:
        reader: Any = make_reader(file)
        names = {record.name: record.metadata for record in reader.iter_metadata()}
    assert names[EVIL] == {EVIL: EVIL}
    for topic, encoding, data in told:
        if topic.startswith("/drivelint/") and encoding == "json":
            msgspec.json.decode(data)
