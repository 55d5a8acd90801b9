"""Keeps a fault to the drive that has it: a drive that cannot be read or judged is refused, and the others are judged."""

from __future__ import annotations

import traceback
from dataclasses import dataclass
from typing import TYPE_CHECKING

import duckdb

from drivelint.errors import DriveLintError, InternalError, MemoryShortError, TraceError

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from drivelint.engine.batch import Drive
    from drivelint.engine.session import JudgingSession


@dataclass(frozen=True)
class RefusedLog:
    """One log that cannot be judged, and why."""

    path: Path
    error: DriveLintError


def judge_apart(session: JudgingSession, drives: Sequence[Drive]) -> list[RefusedLog]:
    """Judge a batch; if it fails, drive by drive, so that one bad drive harms no other. Return what could not be judged.

    Errors: those whose fault is no drive's, such as a folder that cannot be written (`exit_code` 75).
    """
    try:
        session.judge(drives)
    except Exception as error:
        if isinstance(error, DriveLintError) and error.is_of_the_run:
            raise
        if len(drives) == 1:
            return [refused(drives[0].trace.path, error)]
        # in the order of a batch's rows: files that grow with the batches have the same rows in the same order however they are cut
        drives = sorted(drives, key=lambda drive: drive.trace.drive_id)
        many = len(drives) // 2 if isinstance(error, duckdb.OutOfMemoryException) else 1
        pieces = [drives[at : at + many] for at in range(0, len(drives), many)]
        return [each for piece in pieces for each in judge_apart(session, piece)]
    return []


def refused(path: Path, error: BaseException) -> RefusedLog:
    """Return the refusal of a log for an error in reading or judging it.

    Errors: the error itself, where it is no drive's: a wish to stop, or a fault of the run.
    """
    if isinstance(error, DriveLintError):
        if error.is_of_the_run:
            raise error
        return RefusedLog(path, error)
    if isinstance(error, duckdb.OutOfMemoryException | MemoryError):
        return RefusedLog(path, MemoryShortError(str(path)))
    if isinstance(error, duckdb.Error):
        return RefusedLog(path, TraceError(f"{path}: {str(error).splitlines()[0]}"))
    if isinstance(error, KeyboardInterrupt | SystemExit | GeneratorExit):
        raise error
    return RefusedLog(path, InternalError(f"{path}: {_told(error)}"))


def _told(error: BaseException) -> str:
    """Return what an unexpected error says, and where it was raised."""
    frames = traceback.extract_tb(error.__traceback__)
    where = f" ({frames[-1].filename.rpartition('drivelint/')[2]}:{frames[-1].lineno})" if frames else ""
    words = (str(error).splitlines() or [""])[0][:200]
    return f"internal error: {type(error).__name__}: {words}{where}: please report it with the log"
