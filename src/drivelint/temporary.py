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
_open: Final[set[Path]] = set()
_TRIES: Final = 3
"""How often a removal is repeated: a running thread may write into the folder meanwhile."""


@contextmanager
def temporary_folder() -> Iterator[Path]:
    """Create an empty folder, which is removed after the block unless `keep` was called."""
    folder = Path(mkdtemp(prefix=PREFIX))
    _open.add(folder)
    try:
        yield folder
    finally:
        if folder in _open:
            shutil.rmtree(folder, ignore_errors=True)
            _open.discard(folder)


def keep(folder: Path) -> None:
    """Exclude a folder from the removal: its content belongs to the user."""
    _open.discard(folder)


def remove_all() -> None:
    """Remove the temporary folders of this process that still exist."""
    for folder in list(_open):
        for _ in range(_TRIES):
            shutil.rmtree(folder, ignore_errors=True)
