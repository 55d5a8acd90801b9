"""The code blocks of README and of the guides, by the mark on the line above each."""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

from drivelint.guide import FOLDER
from tests.shared_data import ROOT

PAGES = [ROOT / "README.md", *sorted(FOLDER.glob("*.md"))]
_BLOCK = re.compile(
    r"(?:^<!-- (?P<mark>[^\n]+) -->\n)?^```(?P<language>\w*)\n(?P<body>.*?)^```$", re.MULTILINE | re.DOTALL
)


class Block(NamedTuple):
    """A code block: its mark ('' for none), its language, its lines."""

    mark: str
    language: str
    body: str

    @property
    def word(self) -> str:
        """What is to be done with it: run, prints, file, command, workflow; '' for nothing."""
        return re.split(r"[: ]", self.mark, maxsplit=1)[0]

    @property
    def argument(self) -> str:
        """What stands behind the word."""
        return self.mark[len(self.word) :].lstrip(": ")


def blocks(page: Path) -> list[Block]:
    """Return the code blocks of a page, in order."""
    text = page.read_text(encoding="utf-8")
    return [Block(found["mark"] or "", found["language"], found["body"]) for found in _BLOCK.finditer(text)]


def shell_lines(page: Path) -> list[str]:
    """Return every line of drivelint's that a page shows, whether it is run or not."""
    shown = [block.body for block in blocks(page) if block.language == "sh"]
    return [line for body in shown for line in body.splitlines() if line.startswith("drivelint ")]
