"""Reference pages made from the sources: every reason code with its words, and every macro that SQL can call."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from drivelint.catalogue import load_rules
from drivelint.reasons.reason_text import shared_texts
from drivelint.report.catalogue_page import table
from drivelint.resources import folder

if TYPE_CHECKING:
    from collections.abc import Iterable

    from drivelint.reasons.reason_text import ReasonText

_REASONS: Final = """# Reason codes

Every code of the column `cause_code`, with its sentence and the advice. `{name}` is an argument of `cause_args`; what stands in `[...]`
is left out where an argument in it is NULL.
"""
_MACROS: Final = """# Macros

The macros that the SQL of a rule can call.
"""
_MACRO = re.compile(r"((?:^--.*\n)*)^CREATE OR REPLACE MACRO (\w+\([^)]*\))", re.MULTILINE)


def reasons_page() -> str:
    """Return every reason code as Markdown: those of all rules, then those of one rule each."""
    parts = [_REASONS, _codes(shared_texts().items())]
    for rule_id, rule in sorted(load_rules(()).items()):
        if rule.reasons:
            parts.append(f"## {rule_id}\n\n{_codes(rule.reasons.items())}")
    return "\n".join(parts)


def macros_page() -> str:
    """Return every macro as Markdown, by file: its parameters and the comment above it, which may be about several."""
    parts = [_MACROS]
    for file in sorted((folder("queries") / "macros").glob("*.sql")):
        rows, about = [], ""
        for comment, signature in _MACRO.findall(file.read_text(encoding="utf-8")):
            about = " ".join(line.removeprefix("--").strip() for line in comment.splitlines()) or about
            rows.append((f"`{signature}`", _cell(about)))
        if rows:
            parts.append(
                f"## {file.stem.replace('_', ' ').capitalize()}\n\n{table(('macro', 'what it returns'), rows)}"
            )
    return "\n".join(parts)


def _codes(texts: Iterable[tuple[str, ReasonText]]) -> str:
    rows = [(f"`{code}`", _cell(text.says), _cell(text.advice)) for code, text in texts]
    return table(("cause_code", "sentence", "advice"), rows)


def _cell(text: str) -> str:
    """A bar would end the cell; nothing else in these texts is a mark of Markdown that is not meant."""
    return text.replace("|", "\\|")
