"""Distinguishes errors of one log, which is then refused, from errors that end the whole run."""

from __future__ import annotations

import traceback
from dataclasses import dataclass
from typing import TYPE_CHECKING

import duckdb

from drivelint.errors import DriveLintError, InternalError, MemoryShortError, TraceError

if TYPE_CHECKING:
    from pathlib import Path


@dataclass(frozen=True)
class RefusedLog:
    """One log that cannot be judged, and the error."""

    path: Path
    error: DriveLintError


def refusal_of(path: Path, error: BaseException) -> RefusedLog:
    """Return the refusal of a log for an error in reading or judging it.

    Errors: the error itself, if it is an interruption or an error of the whole run.
    """
    if isinstance(error, DriveLintError):
        if error.is_about_whole_run:
            raise error
        return RefusedLog(path, error)
    if isinstance(error, duckdb.OutOfMemoryException | MemoryError):
        return RefusedLog(path, MemoryShortError(str(path)))
    if isinstance(error, duckdb.Error):
        return RefusedLog(path, TraceError(f"{path}: {str(error).splitlines()[0]}"))
    if isinstance(error, KeyboardInterrupt | SystemExit | GeneratorExit):
        raise error
    return RefusedLog(path, InternalError(f"{path}: {_error_text(error)}"))


def _error_text(error: BaseException) -> str:
    """Return a message with the type and text of an unexpected error, and where it was raised."""
    frames = traceback.extract_tb(error.__traceback__)
    where = f" ({frames[-1].filename.rpartition('drivelint/')[2]}:{frames[-1].lineno})" if frames else ""
    words = (str(error).splitlines() or [""])[0][:200]
    return f"internal error: {type(error).__name__}: {words}{where}: please report it with the log"
