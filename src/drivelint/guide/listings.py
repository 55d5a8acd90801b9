"""Reference pages made from the sources: every reason code with its words, and every macro that SQL can call."""

from __future__ import annotations

import re

from drivelint.catalogue import load_rules
from drivelint.reasons.reason_text import shared_texts
from drivelint.resources import folder
from drivelint.result.text_templates import text_template

_MACRO = re.compile(r"((?:^--.*\n)*)^CREATE OR REPLACE MACRO (\w+\([^)]*\))", re.MULTILINE)


def reasons_page() -> str:
    """Return every reason code as Markdown: those of all rules, then those of one rule each."""
    return text_template(__file__, "reasons.md.j2").render(shared=shared_texts(), rules=sorted(load_rules(()).items()))


def macros_page() -> str:
    """Return every macro as Markdown, by file: its parameters and the comment above it, which may be about several."""
    files: dict[str, list[tuple[str, str]]] = {}
    for file in sorted((folder("queries") / "macros").glob("*.sql")):
        about = ""
        for comment, signature in _MACRO.findall(file.read_text(encoding="utf-8")):
            about = " ".join(line.removeprefix("--").strip() for line in comment.splitlines()) or about
            files.setdefault(file.stem.replace("_", " ").capitalize(), []).append((signature, about))
    return text_template(__file__, "macros.md.j2").render(files=files)
