"""Converts messages for Python callers: they name keywords instead of command line options."""

from __future__ import annotations

import re
from contextlib import contextmanager
from typing import TYPE_CHECKING, Final

from drivelint.errors import DriveLintError
from drivelint.options.arguments import CheckArguments
from drivelint.options.declaration import declared_options

if TYPE_CHECKING:
    from collections.abc import Iterator

_OPTION: Final = re.compile(
    r"(?<![\w-])(?P<command>check )?(?P<flag>--[a-z][a-z-]*)(?: (?P<metavar>[A-Z][A-Z|,]*)\b| (?=['\"\d]))?"
)
_KEYWORD_OF_FLAG: Final = {
    flag: (
        option.name,
        str(not flag.startswith("--no-")) if option.type.command_line_type in {bool, bool | None} else None,
    )
    for option in declared_options(CheckArguments)
    for flag in option.flags[0].split("/")
}
"""Flag of the command line -> keyword in Python, and the keyword's value if the flag has none."""


@contextmanager
def rewrite_options_in_errors() -> Iterator[None]:
    """Rewrite options in the message of an error inside the block as keywords: `--overwrite` becomes `overwrite=True`."""
    try:
        yield
    except DriveLintError as error:
        error.args = tuple(replace_options_by_keywords(part) if isinstance(part, str) else part for part in error.args)
        raise


def replace_options_by_keywords(text: str) -> str:
    """Return a message with options changed to keywords, but not options that Python lacks, or after their command (`check --out`)."""
    return _OPTION.sub(_keyword_text, text)


def _keyword_text(option: re.Match[str]) -> str:
    if option["command"] or option["flag"] not in _KEYWORD_OF_FLAG:
        return option[0]
    name, value = _KEYWORD_OF_FLAG[option["flag"]]
    return f"{name}={value or option['metavar'] or ''}"
