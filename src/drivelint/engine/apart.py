"""Keeps a fault to the drive that has it: a drive that cannot be judged is refused, and the others are judged."""

from __future__ import annotations

from typing import TYPE_CHECKING

import duckdb

from drivelint.engine.barrier import RefusedLog, refusal_of
from drivelint.engine.interruption import InterruptedRunError
from drivelint.errors import DriveLintError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.engine.batch import Drive
    from drivelint.engine.session import JudgingSession


def judge_apart(session: JudgingSession, drives: Sequence[Drive], refusals: list[RefusedLog]) -> None:
    """Judge a batch; if it fails, drive by drive, so that one bad drive harms no other. What could not be judged is added to `refusals`.

    Errors: those whose fault is no drive's, such as a folder that cannot be written (`exit_code` 75).
    """
    try:
        session.judge(drives)
    except InterruptedRunError:
        raise
    except Exception as error:
        if isinstance(error, DriveLintError) and error.is_of_the_run:
            raise
        if len(drives) == 1:
            refusals.append(refusal_of(drives[0].trace.path, error))
            return
        # in the order of a batch's rows: files that grow with the batches have the same rows in the same order however they are cut
        drives = sorted(drives, key=lambda drive: drive.trace.drive_id)
        many = len(drives) // 2 if isinstance(error, duckdb.OutOfMemoryException) else 1
        for at in range(0, len(drives), many):
            judge_apart(session, drives[at : at + many], refusals)
