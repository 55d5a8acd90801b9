"""Converts Markdown to HTML pages that open offline. Their stylesheet and search scripts are in the same folder."""

from __future__ import annotations

import re
from collections import Counter
from itertools import pairwise
from typing import TYPE_CHECKING, Final

from markdown_it import MarkdownIt

from drivelint.result.text_templates import text_template

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from markdown_it.token import Token

STYLESHEET: Final = "style.css"
_MARKDOWN: Final = MarkdownIt("commonmark", {"html": False}).enable("table")
_LONG_CELL_LENGTH: Final = 60
"""Number of characters above which a table cell counts as long, and gets a larger least width."""
_SITE_PAGE_BY_PREFIX: Final = (
    ("../../../queries/README.md", "catalogue.html"),
    ("../../../schemas/", "dictionary.html"),
)
"""(Prefix of a link target in the repository, page of the site with its content)."""


def parse(markdown: str) -> list[Token]:
    """Return the tokens of a page, with ids for its headings and with links to pages of the site."""
    tokens = _MARKDOWN.parse(markdown)
    _set_heading_ids(tokens)
    _redirect_links_to_site_pages(tokens)
    _set_cell_attributes(tokens)
    return tokens


def page(
    tokens: Sequence[Token], *, name: str, pages: Iterable[tuple[str, Sequence[tuple[str, str]]]], footer: str
) -> str:
    """Return the page `name` of a site as HTML. `pages`: for the navigation, headings with the (name, title) of their pages."""
    body = str(_MARKDOWN.renderer.render(tokens, _MARKDOWN.options, {}))
    body = body.replace("&lt;br&gt;", "<br>")  # the only HTML in the catalogue's cells
    body = body.replace("<table>", '<div class="wide"><table>').replace("</table>", "</table></div>")
    titles = (plain_text(inline) for opening, inline in pairwise(tokens) if opening.tag == "h1")
    return text_template(__file__, "page.html.j2").render(
        title=next(titles, name), stylesheet=STYLESHEET, body=body, name=name, pages=pages, footer=footer
    )


def plain_text(inline: Token) -> str:
    """Return the text of a heading, a paragraph or a cell, without its markup."""
    return "".join(" " if child.type.endswith("break") else child.content for child in inline.children or ())


def _set_heading_ids(tokens: Sequence[Token]) -> None:
    """Give every heading the same id as GitHub does."""
    count_by_slug: Counter[str] = Counter()
    for opening, inline in pairwise(tokens):
        if opening.type == "heading_open":
            slug = re.sub(r"[^\w\- ]", "", "".join(child.content for child in inline.children or ()).lower()).replace(
                " ", "-"
            )
            opening.attrSet("id", f"{slug}-{count_by_slug[slug]}" if count_by_slug[slug] else slug)
            count_by_slug[slug] += 1


def _redirect_links_to_site_pages(tokens: Sequence[Token]) -> None:
    """Change links to files of the repository to links to pages of the site."""
    for token in tokens:
        for child in token.children or ():
            if child.type == "link_open":
                child.attrSet("href", _site_href(str(child.attrGet("href"))))


def _set_cell_attributes(tokens: Sequence[Token]) -> None:
    """Set attributes of table cells for the stylesheet: the column's heading, for narrow screens, and a class for long text."""
    head: list[str] = []
    column = 0
    for opening, inline in pairwise(tokens):
        if opening.type == "table_open":
            head = []
        elif opening.type == "tr_open":
            column = 0
        elif opening.type == "th_open":
            head.append(inline.content)
        elif opening.type == "td_open":
            if column and len(head) > 2 and inline.content:
                opening.attrSet("data-column", head[column])
            if len(inline.content) > _LONG_CELL_LENGTH:
                opening.attrSet("class", "long")
            column += 1


def _site_href(target: str) -> str:
    for prefix, name in _SITE_PAGE_BY_PREFIX:
        if target.startswith(prefix):
            _, mark, anchor = target.partition("#")
            return f"{name}{mark}{anchor}"
    return re.sub(r"^([\w-]+)\.md(?=$|#)", r"\1.html", target)
