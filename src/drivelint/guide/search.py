"""Makes the search index of the site, as a script: browsers do not let a page that was opened from a file fetch other data."""

from __future__ import annotations

import json
import re
from itertools import pairwise
from typing import TYPE_CHECKING, Final, NamedTuple

from drivelint.guide import html

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from markdown_it.token import Token

SCRIPT_FILE: Final = "search.js"
INDEX_FILE: Final = "search-index.js"
_WORD_PATTERN: Final = re.compile(r"\w+(?:[.\-]+\w+)*")


class Section(NamedTuple):
    """A section of a page: its heading and the words below it. `words`: distinct words in lower case, separated by spaces."""

    anchor: str
    heading: str
    words: str


def index_script(pages: Mapping[str, Sequence[Token]]) -> bytes:
    """Return the script that `search.js` loads: the (name, sections) of every page. `pages`: name -> tokens from `html.parse`."""
    entries = [[name, list(sections(tokens))] for name, tokens in pages.items()]
    return f"drivelintPages({json.dumps(entries, ensure_ascii=False, separators=(',', ':'))});\n".encode()


def sections(tokens: Sequence[Token]) -> Iterator[Section]:
    """Yield the sections of a page in order."""
    anchor, heading = "", ""
    texts: list[str] = []
    for before, token in pairwise(tokens):
        if before.type == "heading_open":
            if heading:
                yield _section(anchor, heading, texts)
            anchor, heading, texts = str(before.attrGet("id")), html.plain_text(token), []
        if token.type == "inline":
            texts.append(html.plain_text(token))
        elif token.type in {"fence", "code_block"}:
            texts.append(token.content)
    yield _section(anchor, heading, texts)


def _section(anchor: str, heading: str, texts: Sequence[str]) -> Section:
    return Section(anchor, heading, " ".join(sorted(set(_WORD_PATTERN.findall(" ".join(texts).lower())))))
