"""What a run tells whoever records its inputs, through the audit events of Python, in which its own opening of files stands, too."""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from pathlib import Path

LOOKED_FOR: Final = "drivelint.looked_for"
MACHINE_BOUND: Final = "drivelint.machine_bound"


def looked_for(path: Path) -> Path:
    """Tell that the run depends on whether there is a file at a path, outside of the folders that it lists; return the path."""
    sys.audit(LOOKED_FOR, os.fspath(path))
    return path


def machine_bound(why: str) -> None:
    """Tell that the result depends on more than the inputs, such as the time that a rule took."""
    sys.audit(MACHINE_BOUND, why)
