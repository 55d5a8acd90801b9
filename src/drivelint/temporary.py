"""Temporary folders that are removed when this process ends.

A process that is ended while one of its threads computes runs no clean-up: code that ends or replaces it in this way calls `remove_all`.
"""

from __future__ import annotations

import shutil
from contextlib import contextmanager
from pathlib import Path
from tempfile import mkdtemp
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Iterator

PREFIX: Final = "drivelint-"
_existing_folders: Final[set[Path]] = set()
_REMOVAL_ATTEMPTS: Final = 3
"""How often a removal is repeated: a running thread may write into the folder meanwhile."""


@contextmanager
def temporary_folder() -> Iterator[Path]:
    """Create an empty folder, which is removed after the block unless `exclude_from_removal` was called."""
    folder = Path(mkdtemp(prefix=PREFIX))
    _existing_folders.add(folder)
    try:
        yield folder
    finally:
        if folder in _existing_folders:
            shutil.rmtree(folder, ignore_errors=True)
            _existing_folders.discard(folder)


def exclude_from_removal(folder: Path) -> None:
    """Exclude a folder from the removal: its content belongs to the user."""
    _existing_folders.discard(folder)


def remove_all() -> None:
    """Remove the temporary folders of this process that still exist."""
    for folder in list(_existing_folders):
        for _ in range(_REMOVAL_ATTEMPTS):
            shutil.rmtree(folder, ignore_errors=True)
