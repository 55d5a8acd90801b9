"""Finds the folders `schemas`, `queries` and `fixtures`, in the repository or in the installed wheel."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from drivelint.errors import DriveLintError


@cache
def folder(name: str) -> Path:
    """Return the folder `schemas`, `queries` or `fixtures`; an installed `fixtures` has only the files of `drivelint demo`."""
    package = Path(__file__).parent
    for root in (package / "_data", package.parent.parent):
        if (root / name).is_dir():
            return root / name
    raise DriveLintError(f"folder {name!r} is missing from the installation at {package}: reinstall drivelint")
