"""Messages of a run to the recorder of its inputs. They are audit events of Python, like the events for opened files."""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from pathlib import Path

LOOKED_FOR: Final = "drivelint.looked_for"
MACHINE_BOUND: Final = "drivelint.machine_bound"


def looked_for(path: Path) -> Path:
    """Report that the run depends on whether a file exists at a path outside the folders that it lists; return the path."""
    sys.audit(LOOKED_FOR, os.fspath(path))
    return path


def machine_bound(why: str) -> None:
    """Report that the result depends on more than the inputs, such as the computing time of a rule."""
    sys.audit(MACHINE_BOUND, why)
