"""A rule file's text, cut into its header and its sections."""

from __future__ import annotations

import re
from typing import NamedTuple

from drivelint.errors import RuleError
from drivelint.phrases import hint

NAMES = ("applies", "reference", "condition", "anchor")
_MARK = re.compile(r"^--\s*@(\S+)\s*$")


class Section(NamedTuple):
    """One section of a rule: its SELECT, the line of its `@` mark, and the line on which the SELECT begins."""

    sql: str
    line: int
    sql_line: int


def split(text: str, where: str) -> tuple[str, dict[str, Section]]:
    """Return the header's TOML (line n of it is line n of the file) and the sections by name.

    Errors: `RuleError` for SQL before the first section, an unknown, repeated or empty section.
    """
    lines = text.splitlines()
    marks = [(n, match[1]) for n, line in enumerate(lines) if (match := _MARK.match(line))]
    header_end = marks[0][0] if marks else len(lines)
    header = [_uncomment(line, n, where) for n, line in enumerate(lines[:header_end], 1)]
    sections: dict[str, Section] = {}
    ends = [n for n, _ in marks[1:]] + [len(lines)]
    for (start, name), end in zip(marks, ends, strict=False):
        if name not in NAMES:
            raise RuleError(f"{where}:{start + 1}: unknown section @{name}; {hint(name, NAMES, sign='@')}")
        if name in sections:
            raise RuleError(f"{where}:{start + 1}: section @{name} stands twice")
        below = lines[start + 1 : end]
        body = "\n".join(below).strip()
        if not body:
            raise RuleError(f"{where}:{start + 1}: section @{name} is empty")
        blank = next(n for n, line in enumerate(below) if line.strip())
        sections[name] = Section(body, start + 1, start + 2 + blank)
    if "condition" not in sections:
        raise RuleError(f"{where}:{len(lines)}: section '-- @condition' is missing")
    return "\n".join(header), sections


def _uncomment(line: str, n: int, where: str) -> str:
    if not line.strip():
        return ""
    if not line.startswith("--"):
        raise RuleError(
            f"{where}:{n}: only '-- ' comment lines (the header) may stand before the first '-- @section' line"
        )
    return line[2:].removeprefix(" ")
