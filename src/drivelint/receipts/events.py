"""The messages of a run to the recorder of its inputs: audit events of Python, which also include its opening of files."""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from pathlib import Path

LOOKED_FOR: Final = "drivelint.looked_for"
MACHINE_BOUND: Final = "drivelint.machine_bound"


def looked_for(path: Path) -> Path:
    """Report that the run depends on whether there is a file at a path, outside of the folders that it lists; return the path."""
    sys.audit(LOOKED_FOR, os.fspath(path))
    return path


def machine_bound(why: str) -> None:
    """Report that the result depends on more than the inputs, such as the time that a rule took."""
    sys.audit(MACHINE_BOUND, why)
