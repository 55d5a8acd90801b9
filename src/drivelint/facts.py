"""Reads files of facts: TOML files beside the modules that use them. The content is cached, because Python parses TOML slowly."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any, Final

from drivelint.memo import Memo

_TOML_MEMO: Final = Memo[dict[str, Any]]("toml", dict[str, Any])


@cache
def toml_beside(module_file: str, name: str) -> dict[str, Any]:
    """Return the content of the TOML file `name` in the folder of `module_file`."""
    return toml_facts(Path(module_file).parent / name)


def toml_facts(file: Path) -> dict[str, Any]:
    """Return the content of a TOML file that is part of drivelint."""

    def parse_toml() -> dict[str, Any]:
        import tomllib

        return tomllib.loads(text)

    text = file.read_text(encoding="utf-8")
    return _TOML_MEMO.find_or_compute(text, parse_toml)
