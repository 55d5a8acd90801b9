"""Parses TOML that a user gives: rules, mappings, settings, waivers."""

from __future__ import annotations

import re
import tomllib
from typing import Any, Final

MAX_KEY_PARTS: Final = 64
"""The most parts of a dotted key. The memory of tomllib grows with the square of their number: 30 kB of `a.a.a` take a GiB."""
_KEY_PART: Final = r"""(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')"""
_LONG_KEY: Final = re.compile(rf"(?<![\w.-]){_KEY_PART}(?:[ \t]*+\.[ \t]*+{_KEY_PART}){{{MAX_KEY_PARTS}}}")


def parse_toml(text: str) -> dict[str, Any]:
    """Return the content of a TOML document. Errors: `tomllib.TOMLDecodeError`, `RecursionError`."""
    if key := _LONG_KEY.search(text):
        line = text.count("\n", 0, key.start()) + 1
        raise tomllib.TOMLDecodeError(f"A key of more than {MAX_KEY_PARTS} parts (at line {line})")
    return tomllib.loads(text)
