"""Reads the files of facts, TOML beside the modules that use them; what they say is kept, as Python reads TOML slowly."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any, Final

from drivelint.memo import Memo

_TOML: Final = Memo[dict[str, Any]]("toml", dict[str, Any])


@cache
def toml_beside(module_file: str, name: str) -> dict[str, Any]:
    """Return what the TOML file `name` beside a module or file (its `__file__`) says."""
    return toml_facts(Path(module_file).parent / name)


def toml_facts(file: Path) -> dict[str, Any]:
    """Return what a TOML file of ours says."""

    def read() -> dict[str, Any]:
        import tomllib

        return tomllib.loads(text)

    text = file.read_text(encoding="utf-8")
    return _TOML.of(text, read)
