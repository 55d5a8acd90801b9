"""Hands cases to a process, waits for each answer, and starts another process where one hangs or dies."""

from __future__ import annotations

import multiprocessing
import signal
from dataclasses import dataclass, field
from time import monotonic
from typing import TYPE_CHECKING, Final, Self

from drivelint.audit.executors.local import processor_seconds
from drivelint.computing import resident_bytes
from tests.fuzz.outcome import Outcome
from tests.fuzz.sources import remove_folder, scratch
from tests.fuzz.worker import Job, serve

if TYPE_CHECKING:
    from collections.abc import Iterator
    from multiprocessing.connection import Connection
    from multiprocessing.process import BaseProcess
    from pathlib import Path

TIME_LIMIT_S: Final = 60.0
START_LIMIT_S: Final = 180.0
"""The first answer of a process may take longer: it loads libraries and makes the valid files."""
BUSY: Final = 30
"""So many times a limit of computing is waited for: what else the machine does is no fault of a file."""
MOST_BYTES: Final = 2**30
"""Resident memory that a process may take for a file of some kilobytes."""
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
    _kind: str = ""
    _warm_bytes: int = 0
    """What it had at its first answer, when libraries are loaded and the valid files of a kind are made."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._stop()
        remove_folder(self._home)

    def run(self, job: Job) -> Iterator[Outcome]:
        """Yield an outcome per case, and a second one for a case that judging found to be worse."""
        end = job.first + job.n
        while job.first < end:
            at = job.first
            connection, limit = self._started(job.kind)
            connection.send(job)
            try:
                while True:
                    if (excess := self._excess(connection, limit)) is not None:
                        self._stop()
                        yield Outcome(job.kind, at, "", *excess)
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

    def _started(self, kind: str) -> tuple[Connection, float]:
        if (
            self._n >= CASES_PER_PROCESS or kind != self._kind
        ):  # another kind: its valid files are no memory of a damaged one
            self._stop()
        self._kind = kind
        if self._connection is not None:
            return self._connection, max(self.time_limit_s, START_LIMIT_S)
        context = multiprocessing.get_context("spawn")  # threads of compiled libraries do not survive a fork
        self._connection, other = context.Pipe()
        (self._home / "output").touch()
        self._process = context.Process(target=serve, args=(other, str(self._home / "output")), daemon=True)
        self._process.start()
        self._warm_bytes = 0
        other.close()
        return self._connection, START_LIMIT_S

    def _excess(self, connection: Connection, limit_s: float) -> tuple[str, str] | None:
        """Wait for an answer. Return outcome and detail where the process computes, or stands still, for too long, or takes too much."""
        assert self._process is not None
        began_s, began_at = processor_seconds(self._process.pid), monotonic()
        while not connection.poll(0.1):
            took_s = processor_seconds(self._process.pid) - began_s
            if took_s > limit_s or monotonic() - began_at > BUSY * limit_s:
                return "hang", f"no answer within {limit_s:g} s of computing"
            if self._warm_bytes and (taken := resident_bytes(self._process.pid) - self._warm_bytes) > MOST_BYTES:
                return "memory", f"{taken >> 20} MiB more than the process has for valid files"
        self._warm_bytes = self._warm_bytes or resident_bytes(self._process.pid)
        return None

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
