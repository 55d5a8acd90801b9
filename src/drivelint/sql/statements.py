"""Reads the SQL statements in files of `queries`, except derivations and rules."""

from __future__ import annotations

import re
from functools import cache
from typing import Final

from drivelint.resources import folder

_FRAGMENT: Final = re.compile(r"\{(\w+)\}")


def statement(name: str, **fragments: str) -> str:
    """Return the text of `queries/<name>.sql` with each `{fragment}` replaced; SQL itself never has a single word in braces.

    Errors: `KeyError` if a fragment of the file is not given.
    """
    part, _, file = name.rpartition("/")
    return _FRAGMENT.sub(lambda match: fragments[match[1]], statement_texts(part)[file])


@cache
def statement_texts(subfolder: str) -> dict[str, str]:
    """Return file name -> text for every statement of `queries/<part>`."""
    files = sorted((folder("queries") / subfolder).glob("*.sql"))
    return {file.stem: file.read_text(encoding="utf-8") for file in files}
