"""Converts messages for Python callers: they name keywords instead of command line options."""

from __future__ import annotations

import re
from contextlib import contextmanager
from typing import TYPE_CHECKING, Final

from drivelint.errors import DriveLintError

if TYPE_CHECKING:
    from collections.abc import Iterator

_FLAGS: Final = frozenset({"strict", "overwrite", "margins", "keep-db", "annotate", "pictures", "robustness"})
_OPTION: Final = re.compile(
    r"(?<![\w-])(?P<command>check )?--(?P<no>no-)?(?P<name>[a-z][a-z-]*)(?: (?P<metavar>[A-Z][A-Z|,]*)\b| (?=['\"\d]))?"
)


@contextmanager
def rewrite_options_in_errors() -> Iterator[None]:
    """Rewrite options in the message of an error inside the block as keywords: `--overwrite` becomes `overwrite=True`."""
    try:
        yield
    except DriveLintError as error:
        error.args = tuple(replace_options_by_keywords(part) if isinstance(part, str) else part for part in error.args)
        raise


def replace_options_by_keywords(text: str) -> str:
    """Return a message with options changed to keywords; an option after its command (`check --out`) is not changed."""
    return _OPTION.sub(_keyword_text, text)


def _keyword_text(option: re.Match[str]) -> str:
    if option["command"]:
        return option[0]
    name = option["name"].replace("-", "_")
    value = str(not option["no"]) if option["name"] in _FLAGS else option["metavar"]
    return f"{name}={value or ''}"
