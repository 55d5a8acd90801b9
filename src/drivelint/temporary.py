"""Temporary folders that go with this process, however it ends.

A process that is left while a thread of it computes closes nothing: code that ends it in this way, or replaces it, calls `remove_all`.
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
"""A thread that still runs may write into a folder while it is removed."""


@contextmanager
def temporary_folder() -> Iterator[Path]:
    """Make an empty folder, which is removed afterwards unless it is kept."""
    folder = Path(mkdtemp(prefix=PREFIX))
    _open.add(folder)
    try:
        yield folder
    finally:
        if folder in _open:
            shutil.rmtree(folder, ignore_errors=True)
            _open.discard(folder)


def keep(folder: Path) -> None:
    """Leave a folder where it is: its content belongs to the user."""
    _open.discard(folder)


def remove_all() -> None:
    """Remove the folders of this process that are still open."""
    for folder in list(_open):
        for _ in range(_TRIES):
            shutil.rmtree(folder, ignore_errors=True)
