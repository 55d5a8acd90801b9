"""Finds the folders `schemas`, `queries` and `fixtures`, in the repository or in the installed wheel, and reads files of facts."""

from __future__ import annotations

import tomllib
from functools import cache
from pathlib import Path
from typing import Any

from drivelint.errors import DriveLintError


@cache
def folder(name: str) -> Path:
    """Return the folder `schemas`, `queries` or `fixtures` (installed: what `drivelint demo` writes of it)."""
    package = Path(__file__).parent
    for root in (package / "_data", package.parent.parent):
        if (root / name).is_dir():
            return root / name
    raise DriveLintError(f"folder {name!r} is missing from the installation at {package}: reinstall drivelint")


@cache
def toml_beside(module_file: str, name: str) -> dict[str, Any]:
    """Return what the TOML file `name` beside a module or file (its `__file__`) says."""
    return tomllib.loads((Path(module_file).parent / name).read_text(encoding="utf-8"))
