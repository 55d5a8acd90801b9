"""Restarts the command in place of this process, without a rule that cannot be interrupted.

DuckDB runs a rule in a thread. A thread that ignores interrupts ends only with its process. `exec` keeps the process id and the open
standard streams, so a program that waits for them is not affected.
"""

from __future__ import annotations

import json
import os
import shutil
import sys
from typing import TYPE_CHECKING, Final, NoReturn

from drivelint import temporary

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.evaluate.limits import Excess
    from drivelint.report.progress import Progress

UNSTOPPABLE_RULES_VARIABLE: Final = "DRIVELINT_DEAF_RULES"
"""The environment variable that passes the rules that cannot be interrupted to the next process: JSON, task -> rule -> limit."""
_EXCESS_TEXTS: Final[dict[Excess, str]] = {
    "rule_timeout": "takes longer than --rule-timeout",
    "out_of_memory": "takes more memory than is available",
}


class Restart:
    """The rules that could not be interrupted, and the restart without them.

    `work`: the folder with the files of this run, which is removed before a restart.
    """

    def __init__(self, progress: Progress, work: Path | None) -> None:
        self._known: dict[str, dict[str, Excess]] = json.loads(os.environ.get(UNSTOPPABLE_RULES_VARIABLE, "{}"))
        self._progress = progress
        self._work = work

    @classmethod
    def if_possible(cls, progress: Progress, work: Path | None) -> Restart | None:
        """Return a `Restart` on POSIX; None on Windows, where `exec` starts a second process instead of replacing this one."""
        return cls(progress, work) if os.name == "posix" else None

    def exceeded_limits(self, task: str) -> dict[str, Excess]:
        """Return rule id -> exceeded limit, for the rules of a task that an earlier process could not interrupt."""
        return self._known.get(task, {})

    def restart_without(self, task: str, rule_id: str, excess: Excess) -> NoReturn:
        """Replace this process by a new process that does not run this rule."""
        self._progress.note(
            f"rule {rule_id} {_EXCESS_TEXTS[excess]} and cannot be stopped: the run starts again without this rule"
        )
        temporary.remove_all()
        if self._work is not None:
            shutil.rmtree(self._work, ignore_errors=True)
        excesses = {**self._known, task: {**self.exceeded_limits(task), rule_id: excess}}
        self._progress.release_terminal()
        sys.stderr.flush()
        os.execve(  # noqa: S606 - the same command
            sys.executable,
            [sys.executable, *sys.orig_argv[1:]],
            {**os.environ, UNSTOPPABLE_RULES_VARIABLE: json.dumps(excesses)},
        )
