"""Limits the memory of a run. If memory is short, it judges less at once or raises the database's limit. Verdicts do not depend on it.

A drive that runs out of memory is judged again with fewer egos at once, down to a single ego; only then the limit is lifted.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Final, TypeVar

import duckdb

from drivelint.engine import batch
from drivelint.sql import store

if TYPE_CHECKING:
    from collections.abc import Callable

T = TypeVar("T")

DEFAULT_MEMORY_BYTES: Final = 1_200_000_000
"""The default limit in bytes. Measured: no slower for a drive of 600,000 states; 2.3 GB instead of 13.7 GB for 4.8 million states."""
LEAST_MEMORY_BYTES: Final = 100_000_000
"""The least limit in bytes with which a database can be opened and a small drive judged."""


class MemoryLimit:
    """The memory limit of the database `con` (`limit` in bytes, None: 80 % of the machine's memory), and how much is judged at once.

    With a lower limit, parts are smaller from the start, so that fewer run out of memory. A halved part size or a lifted limit stays so for
    the run. `note` receives a message when the limit is lifted.
    """

    def __init__(
        self, con: duckdb.DuckDBPyConnection, limit: int | None, note: Callable[[str], None] = lambda _text: None
    ) -> None:
        self._con = con
        self._limit = limit
        self._note = note
        self.limited = limit is not None
        share = 1.0 if limit is None else min(1.0, limit / DEFAULT_MEMORY_BYTES)
        self.pairs_per_part = max(1, int(batch.EGO_ACTOR_PAIRS_PER_PART * share))
        """The most pairs of a part of a drive: see `batch.egos_to_skip_by_part`."""

    def halve_parts(self, n_pairs: int) -> None:
        """Limit parts to half the pairs of the part that ran out of memory."""
        self.pairs_per_part = max(1, n_pairs // 2)

    def raise_to_machine_limit(self) -> bool:
        """Raise the database's memory limit to what the machine allows; return False if it was raised before."""
        if not self.limited or self._limit is None:
            return False
        self.limited = False
        machine_limit = store.set_and_return_default_memory_limit(self._con)
        self._note(
            f"{format_bytes(self._limit)} of memory are not enough (--memory): the database may use up to {machine_limit}"
        )
        return True

    def release_unused_memory(self) -> None:
        """Return unused memory to the system, without changing the limits. Call it between statements."""
        try:
            store.release_memory_and_leave_limit_of_1_byte(self._con)
        finally:  # an interrupt must not leave the database without memory
            if self.limited:
                self._con.execute("SET memory_limit=?", [f"{self._limit}B"])
            else:
                store.set_and_return_default_memory_limit(self._con)

    def most_growth_bytes(self) -> int | None:
        """Return by how many bytes the process may grow while a rule runs.

        None: the system does not report free memory, or logs are being read, so growth says nothing about the rule. This limit is needed
        because the database counts the memory of its tables, but not that of functions on huge values.
        """
        free = free_bytes()
        if free is None or batch.are_logs_being_read():
            return None
        return min(2 * self._limit, free) if self.limited and self._limit is not None else int(0.8 * free)

    def execute(self, sql: str) -> None:
        """Run one statement; if memory is short, repeat it with a raised limit."""
        self.run_job(lambda con: con.execute(sql))

    def run_job(self, job: Callable[[duckdb.DuckDBPyConnection], T]) -> T:
        """Run a job on the database and return its result; if memory is short, repeat it with a raised limit."""
        try:
            with store.uniform_memory_errors():
                return job(self._con)
        except duckdb.OutOfMemoryException:
            if not self.raise_to_machine_limit():
                raise
            return job(self._con)


def peak_bytes() -> int | None:
    """Return the peak memory of this process in bytes; None if the system does not report it."""
    try:
        import resource
    except ImportError:  # Windows
        return None
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak if sys.platform == "darwin" else peak * 1024


def free_bytes() -> int | None:
    """Return the available memory in bytes; None if the system does not report it."""
    try:
        line = re.search(r"^MemAvailable:\s*(\d+) kB", Path("/proc/meminfo").read_text(encoding="ascii"), re.MULTILINE)
    except OSError:  # not Linux
        return None
    return int(line[1]) * 1024 if line else None


def format_bytes(n_bytes: int) -> str:
    """Return a number of bytes as text in MB or GB."""
    return f"{n_bytes / 1e9:.1f} GB" if n_bytes >= 1e9 else f"{n_bytes / 1e6:.0f} MB"
