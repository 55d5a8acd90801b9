"""The limit of globs that users write. To translate a glob, Python takes time by the square of the number of its opening brackets."""

from __future__ import annotations

from typing import Final

MAX_GLOB_CHARS: Final = 1000


def glob_length_problem(glob: str) -> str:
    """Return why a glob is too long to be matched; '' if it is not."""
    return f"{len(glob)} characters: use at most {MAX_GLOB_CHARS}" if len(glob) > MAX_GLOB_CHARS else ""
