"""Readers of the outputs that have nothing of drivelint: what each of them would act on."""

from __future__ import annotations

import re
from html.parser import HTMLParser

from markdown_it import MarkdownIt

STEERING = re.compile(r"[\x00-\x09\x0b-\x1f\x7f-\x9f\u061c\u200b-\u200f\u2028-\u202e\u2060-\u2069\ufeff\ud800-\udfff]")
"""What a terminal, an editor or a viewer obeys rather than shows."""
_STYLE = re.compile(r"\x1b\[[0-9;]*m")
_ALLOWED_TAGS = {
    "a",
    "b",
    "br",
    "code",
    "details",
    "em",
    "h1",
    "h2",
    "h3",
    "h4",
    "li",
    "ol",
    "p",
    "strong",
    "summary",
    "ul",
    "hr",
    "s",
}
_ALLOWED_TAGS |= {"table", "thead", "tbody", "tr", "th", "td"}


def assert_quiet(text: str, *, styled: bool = False, lines_are_ours: bool = True) -> None:
    """Assert that a text steers no terminal, gives a build server no command, and that no line of it is a stranger's.

    `styled`: colours are ours. `lines_are_ours`: False where the text holds cells in quotes.
    """
    if styled:
        text = _STYLE.sub("", text)
    assert {match[0] for match in STEERING.finditer(text)} == set()
    for line in text.split("\n"):
        assert not line.lstrip().startswith("::"), line[:80]
        assert not re.search(r"##\w*\[", line), line[:80]
        assert not (lines_are_ours and line.startswith(("exit 0: nothing failed", ".shell"))), line[:80]


class Page(HTMLParser):
    """What a browser would load, run or follow of a page, and its texts."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.scripts: list[str | None] = []
        self.texts: list[str] = []
        self._inside = ""
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self._inside = tag
        if tag == "script":
            self.scripts.append(dict(attrs).get("type"))
        for name, value in attrs:
            assert not name.startswith("on"), (tag, name)
            if name in {"href", "src", "action", "xlink:href", "data", "srcdoc"}:
                assert re.match(r"(?:#|data:,|annotated/|incidents/|[\w.%=+-]+(?:/|\.html|$))", value or "#"), (
                    tag,
                    name,
                    value,
                )
                assert not re.match(r"(?i)\s*(?:javascript|vbscript|https?):", value or ""), (tag, name, value)

    def handle_endtag(self, tag: str) -> None:  # noqa: ARG002 - the parser's interface
        self._inside = ""

    def handle_data(self, data: str) -> None:
        if self._inside not in {"script", "style"}:
            self.texts.append(data)


def assert_page_is_ours(text: str) -> Page:
    """Assert that every element of a page is ours, and that each text is as it will be read."""
    page = Page(text)
    assert not {"img", "iframe", "object", "embed", "base", "audio", "video"} & set(page.tags)
    assert [kind for kind in page.scripts if kind is None] in ([], [None])
    assert set(page.scripts) <= {None, "application/json"}
    assert set(page.tags) >= {"html", "head", "title", "body"}
    assert (
        page.tags.count("title") - page.tags[page.tags.index("body") :].count("title") == 1
    )  # the others are of pictures
    assert {match[0] for match in STEERING.finditer(text)} == set()
    return page


def assert_markdown_is_ours(text: str, links: int = 0) -> list[str]:
    """Assert that a Markdown text has no picture, no HTML of a stranger, so many links, and whole tables; return its words."""
    assert {match[0] for match in STEERING.finditer(text.replace("\u2060", ""))} == set()
    tokens = MarkdownIt("commonmark", {"html": True}).enable(["table", "strikethrough"]).parse(text)
    inline = [child for token in tokens for child in token.children or []]
    html = "".join(token.content for token in [*tokens, *inline] if token.type in {"html_block", "html_inline"})
    assert re.sub(r"</?(?:details|summary)>|<br>", "", html).count("<") == 0, html[:300]
    assert not [child for child in inline if child.type == "image"]
    assert sum(child.type == "link_open" for child in inline) == links
    assert not [child for child in inline if child.type in {"em_open", "s_open"}]
    cells, width = 0, 0
    for token in tokens:
        if token.type == "tr_open":
            cells = 0
        elif token.type in {"th_open", "td_open"}:
            cells += 1
        elif token.type == "thead_close":
            width = cells
        elif token.type == "tr_close" and width:
            assert cells == width
        elif token.type == "table_close":
            width = 0
    outside = [line for line in text.split("\n") if re.match(r"\s*(?:::|\.shell|exit 0: nothing failed)", line)]
    assert outside == []
    return [child.content for child in inline]
