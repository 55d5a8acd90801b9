"""Isolates errors: a drive that cannot be judged is refused, and the other drives of its batch are judged."""

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


def judge_and_refuse_faulty(session: JudgingSession, drives: Sequence[Drive], refusals: list[RefusedLog]) -> None:
    """Judge a batch; if it fails, judge its drives separately (after a lack of memory: its halves), and add those that fail to `refusals`.

    Errors: those that no drive causes, such as a folder that cannot be written (`exit_code` 75).
    """
    try:
        session.judge(drives)
    except InterruptedRunError:
        raise
    except Exception as error:
        if isinstance(error, DriveLintError) and error.is_about_whole_run:
            raise
        if len(drives) == 1:
            refusals.append(refusal_of(drives[0].trace.path, error))
            return
        # sorted like the rows of a batch, so that files that grow with the batches do not depend on the split
        drives = sorted(drives, key=lambda drive: drive.trace.drive_id)
        part_size = len(drives) // 2 if isinstance(error, duckdb.OutOfMemoryException) else 1
        for at in range(0, len(drives), part_size):
            judge_and_refuse_faulty(session, drives[at : at + part_size], refusals)
