"""The site of `drivelint docs --html`: every page, no dead link, every table, the same bytes, readable on a phone."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterator
from html import unescape
from pathlib import Path

import lxml.html
import pytest
from typer.main import get_command

from drivelint import cli, guide
from drivelint.errors import UsageError
from drivelint.guide import dictionary, html, search, site
from drivelint.sql.declarations import column_comments
from drivelint.sql.derivations import derivations
from tests.report.browser import CHROMIUM, Page
from tests.shared_data import ROOT


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a site that the command wrote."""
    folder = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "drivelint", "docs", "--html", str(folder)]
    done = subprocess.run(command, check=False, capture_output=True, text=True, env={"PYTHONPATH": str(ROOT / "src")})
    assert (done.returncode, done.stdout, done.stderr) == (0, f"{folder / 'index.html'}\n", "")
    return folder


def tree(file: Path) -> lxml.html.HtmlElement:
    return lxml.html.fromstring(file.read_text(encoding="utf-8"))


@pytest.mark.ci
def test_a_page_per_topic_and_the_reference(pages: Path) -> None:
    names = {*guide.TOPICS, *site.REFERENCE_PAGES, "index"}
    beside = {html.STYLESHEET, search.SCRIPT_FILE, search.INDEX_FILE, *site.SITE_PICTURE_FILES}
    assert {file.name for file in pages.iterdir()} == {f"{n}.html" for n in names} | beside
    for topic in guide.topics():
        assert tree(pages / f"{topic.name}.html").findtext(".//h1") == topic.title
    index = tree(pages / "index.html")
    assert {f"{n}.html" for n in names} - {"index.html"} <= set(index.xpath("//main//a/@href"))


def test_no_dead_links(pages: Path) -> None:
    trees = {file.name: tree(file) for file in pages.glob("*.html")}
    ids = {name: set(page.xpath("//@id")) for name, page in trees.items()}
    for name, page in trees.items():
        for target in [*page.xpath("//a/@href"), *page.xpath("//img/@src"), *page.xpath("//link/@href")]:
            if target.startswith("https://"):
                continue
            file, _, anchor = target.partition("#")
            assert (pages / (file or name)).is_file(), f"{name}: {target}"
            assert not anchor or anchor in ids[file or name], f"{name}: {target}"


def test_nothing_is_fetched_and_the_search_is_the_only_script(pages: Path) -> None:
    for file in pages.glob("*.html"):
        page = tree(file)
        assert [dict(script.attrib) for script in page.xpath("//script")] == [
            {"src": search.SCRIPT_FILE, "defer": "defer"}
        ]
        assert page.xpath("//*/@*[starts-with(name(), 'on')]") == []
        assert page.xpath("//script/text()") == []
        assert [src for src in page.xpath("//*/@src | //link/@href") if ":" in src] == []
        assert page.xpath("//@id") == list(dict.fromkeys(page.xpath("//@id"))), f"{file.name}: an id twice"
    assert "url(" not in (pages / html.STYLESHEET).read_text(encoding="utf-8")
    assert "@import" not in (pages / html.STYLESHEET).read_text(encoding="utf-8")
    script = (pages / search.SCRIPT_FILE).read_text(encoding="utf-8")
    assert not re.search(r"\b(?:fetch|import|XMLHttpRequest|WebSocket|eval|innerHTML)\b|://", script)


@pytest.mark.ci
def test_the_same_bytes_twice(pages: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "50")
    monkeypatch.setattr(sys, "argv", ["drivelint", "docs", "--html", str(tmp_path / "again")])
    with pytest.raises(SystemExit):
        cli.main()
    assert {f.name: f.read_bytes() for f in (tmp_path / "again").iterdir()} == {
        f.name: f.read_bytes() for f in pages.iterdir()
    }


def test_the_dictionary_names_every_table_and_column(pages: Path) -> None:
    page = tree(pages / "dictionary.html")
    headings = {h.get("id"): h for h in page.xpath("//h3")}
    assert set(headings) == set(column_comments())
    for name, columns in column_comments().items():
        (rows,) = headings[name].xpath("following::table[1]")
        cells = [[cell.text_content() for cell in row.xpath("td")] for row in rows.xpath(".//tr[td]")]
        assert {column: meaning for column, _, meaning in cells} == columns, name
        assert all(kind for _, kind, _ in cells), name


def test_the_graph_names_every_derived_table_and_all_that_it_reads(pages: Path) -> None:
    page = tree(pages / "dictionary.html")
    (start,) = page.xpath("//h2[@id='how-the-tables-are-derived']")
    (levels,) = start.xpath("following-sibling::ul[1]")
    named = {}
    for item in levels.xpath("./li/ul/li"):
        first, *reads = item.xpath(".//a/text()")
        named[first] = frozenset(reads)
    assert named.keys() == derivations().keys()
    for name, derivation in derivations().items():
        assert derivation.reads <= named[name], name


def test_a_table_reads_only_lower_levels() -> None:
    level = {
        name: n
        for n, names in enumerate(dictionary.derivation_levels(dictionary.sources_of_derived_tables()), 1)
        for name in names
    }
    for name, tables in dictionary.sources_of_derived_tables().items():
        assert all(level.get(table, 0) < level[name] for table in tables), name


def test_cells_of_wide_tables_name_their_column(pages: Path) -> None:
    """On a narrow screen a row is a block, without the table's head."""
    page = tree(pages / "catalogue.html")
    (row, *_) = page.xpath("//h2[@id='ukhc']/following::table[1]//tr[td]")
    assert [cell.get("data-column") for cell in row.xpath("td")] == [
        None,
        "question",
        "kind",
        "required signals",
        "parameters",
        "source",
    ]


def commands(group: object, words: str = "drivelint") -> Iterator[tuple[str, list[str]]]:
    for name, command in group.commands.items():  # type: ignore[attr-defined]
        if hasattr(command, "commands"):
            yield from commands(command, f"{words} {name}")
        else:
            options = [p.opts[0] for p in command.params if p.param_type_name == "option"]
            yield f"{words} {name}", options


def test_the_command_line_has_every_command_and_option(pages: Path) -> None:
    text = (pages / "commands.html").read_text(encoding="utf-8")
    sections = {unescape(part.partition("<")[0]): part for part in re.split(r'<h2 id="[\w-]+">', text)[1:]}
    known = dict(commands(get_command(cli.app)))
    assert sections.keys() == known.keys()
    for name, options in known.items():
        for option in [*options, "--help"]:
            assert option in sections[name], f"{name} {option}"


def test_a_folder_that_is_a_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(UsageError, match="is a file"):
        site.write(tmp_path / "file", ())


@pytest.mark.slow
@pytest.mark.sample(0, ci=1)
@pytest.mark.skipif(CHROMIUM is None, reason="chromium is not installed")
@pytest.mark.parametrize("width", [390, 1280])
def test_pages_fit_the_screen(pages: Path, tmp_path: Path, width: int) -> None:
    for n, name in enumerate(
        ("index", "ci", "writing-a-rule", "rule-reference", "dictionary", "catalogue", "commands", "viewer")
    ):
        with Page(tmp_path / str(n), (pages / f"{name}.html").as_uri(), width) as page:
            page.call("Emulation.setDeviceMetricsOverride", width=width, height=800, deviceScaleFactor=1, mobile=True)
            assert page.value("document.documentElement.scrollWidth") <= width, name
            assert page.value("getComputedStyle(document.querySelector('h1')).fontSize") == "27.2px", (
                "the style is there"
            )
            assert page.value("[...document.images].every(i => i.naturalWidth > 0)"), name
            assert [e for e in page.events if e["method"] in {"Runtime.exceptionThrown", "Network.loadingFailed"}] == []
