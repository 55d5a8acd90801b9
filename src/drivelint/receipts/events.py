"""Messages of a run to the recorder of its inputs. They are audit events of Python, like the events for opened files."""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from pathlib import Path

SEARCHED_PATH_EVENT: Final = "drivelint.looked_for"
NOT_REPEATABLE_EVENT: Final = "drivelint.machine_bound"


def report_searched_path(path: Path) -> Path:
    """Report that the run depends on whether a file exists at a path outside the folders that it lists; return the path."""
    sys.audit(SEARCHED_PATH_EVENT, os.fspath(path))
    return path


def report_not_repeatable(why: str) -> None:
    """Report that the result depends on more than the inputs, such as the computing time of a rule."""
    sys.audit(NOT_REPEATABLE_EVENT, why)
