"""The command line as a page: what `--help` says, in tables that fit a narrow screen."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final, NamedTuple

from drivelint.guide.dictionary import escaped
from drivelint.report.catalogue_page import table

if TYPE_CHECKING:
    from collections.abc import Iterable

INTRODUCTION: Final = """# The command line

Every command of drivelint with its arguments and options, as in `--help`.

Data goes to stdout; progress, notes and errors go to stderr.
"""


class Command(NamedTuple):
    """One command: how it is called, what it does, and (name, meaning) of its arguments and options."""

    usage: str
    about: str
    arguments: tuple[tuple[str, str], ...]
    options: tuple[tuple[str, str], ...]

    @property
    def name(self) -> str:
        """The words before the arguments, such as `drivelint rules list`."""
        return self.usage.partition(" [")[0].partition(" {")[0]


def page(commands: Iterable[Command]) -> str:
    """Return the page as Markdown, a section per command."""
    return "\n".join([INTRODUCTION, *(_section(command) for command in commands)])


def _section(command: Command) -> str:
    parts = [f"## {command.name}\n", f"```text\n{command.usage}\n```\n", f"{_shown(command.about)}\n"]
    for heading, rows in (("argument", command.arguments), ("option", command.options)):
        if rows:
            parts.append(table((heading, "meaning"), [(f"`{name}`", _shown(meaning)) for name, meaning in rows]))
    return "\n".join(parts)


def _shown(text: str) -> str:
    """Return help text as Markdown, the options in it as code."""
    return re.sub(r"(?<![\w-])(--[a-z][\w-]*)", r"`\1`", escaped(text))
