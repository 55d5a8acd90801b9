"""Hands cases to a process, waits for each answer, and starts another process where one hangs or dies."""

from __future__ import annotations

import multiprocessing
import signal
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final, Self

from tests.fuzz.outcome import Outcome
from tests.fuzz.sources import removed, scratch
from tests.fuzz.worker import Job, serve

if TYPE_CHECKING:
    from collections.abc import Iterator
    from multiprocessing.connection import Connection
    from multiprocessing.process import BaseProcess
    from pathlib import Path

TIME_LIMIT_S: Final = 60.0
START_LIMIT_S: Final = 180.0
"""The first answer of a process may take longer: it loads libraries and makes the valid files."""
CASES_PER_PROCESS: Final = 4000
"""What a process may keep is bounded by ending it."""


@dataclass
class Driver:
    """One process at a time; a context manager."""

    time_limit_s: float = TIME_LIMIT_S
    _home: Path = field(default_factory=scratch)
    _process: BaseProcess | None = None
    _connection: Connection | None = None
    _n: int = 0

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._stop()
        removed(self._home)

    def run(self, job: Job) -> Iterator[Outcome]:
        """Yield an outcome per case, and a second one for a case that judging found to be worse."""
        end = job.first + job.n
        while job.first < end:
            at = job.first
            connection, limit = self._started()
            connection.send(job)
            try:
                while True:
                    if not connection.poll(limit):
                        self._stop()
                        yield Outcome(job.kind, at, "", "hang", f"no answer within {limit:g} s")
                        break
                    told = connection.recv()
                    limit = self.time_limit_s
                    if told is None:
                        self._n += job.n
                        return
                    if isinstance(told, str):
                        raise RuntimeError(f"the fuzzer itself failed in {job.kind} {at}: {told}")  # noqa: TRY004 - no type is wrong
                    if isinstance(told, Outcome):
                        yield told
                    else:
                        at = told
            except EOFError:
                yield Outcome(job.kind, at, "", "died", self._ending())
                self._stop()
            job = job._replace(first=at + 1, n=end - at - 1)

    def _started(self) -> tuple[Connection, float]:
        if self._n >= CASES_PER_PROCESS:
            self._stop()
        if self._connection is not None:
            return self._connection, max(self.time_limit_s, START_LIMIT_S)
        context = multiprocessing.get_context("spawn")  # threads of compiled libraries do not survive a fork
        self._connection, other = context.Pipe()
        (self._home / "output").touch()
        self._process = context.Process(target=serve, args=(other, str(self._home / "output")), daemon=True)
        self._process.start()
        other.close()
        return self._connection, START_LIMIT_S

    def _ending(self) -> str:
        assert self._process is not None
        self._process.join(10)
        code = self._process.exitcode
        how = signal.Signals(-code).name if code is not None and code < 0 else f"exit code {code}"
        output = (self._home / "output").read_bytes()[-600:].decode(errors="replace")
        return f"{how}: {output}"

    def _stop(self) -> None:
        if self._process is not None and self._process.is_alive():
            self._process.kill()
            self._process.join()
        if self._connection is not None:
            self._connection.close()
        self._process = self._connection = None
        self._n = 0
