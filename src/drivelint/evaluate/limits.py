"""Holds each rule to an amount of computing time and of memory.

The time is that of the processor, so that verdicts do not depend on other programs of the machine. A statement beyond its limit is
interrupted. DuckDB heeds an interrupt between two vectors of rows, not inside one: a function that works on one huge value, or many of
them, continues. The maker of the limits decides what to do about such a rule (`DeafRules`).
"""

from __future__ import annotations

import threading
from collections import Counter
from contextlib import contextmanager
from threading import Event, Lock, Thread
from typing import TYPE_CHECKING, Final, Literal, NoReturn, Protocol

from drivelint.computing import Work, resident_bytes
from drivelint.receipts.events import machine_bound

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    import duckdb

DEFAULT_TIMEOUT_S: Final = 30.0
"""Seconds of computing per rule and batch."""
MOST_EXCESSES: Final = 3
"""A rule that exceeded its limits so often is not tried again: every drive of a batch is judged alone after a rule failed on it."""
_LOOK_S: Final = 0.1
_MEMORY_GRACE_S: Final = 0.5
"""How long a rule may compute before it heeds an interrupt for its memory, unless it takes too much more meanwhile."""
_MOST_EXCESS: Final = 1.25
"""A rule that has taken this many times its memory limit is not waited for any longer."""

Excess = Literal["rule_timeout", "out_of_memory"]
"""The limit that a rule went beyond, as the reason code of its verdicts."""


class RunningRule:
    """A rule that runs, and the limit that it went beyond, if any."""

    def __init__(self) -> None:
        self.excess: Excess | None = None
        self.over = Event()
        self.lock = Lock()
        """Held while it is interrupted: an interrupt after its end would meet the next rule."""


class DeafRules(Protocol):
    """What to do about rules that do not heed an interrupt, and which ones are known. `task`: what was judged, drives or copies."""

    def excesses(self, task: str) -> Mapping[str, Excess]:
        """Return the rules that are not to be tried, and the limit that they went beyond."""
        ...

    def restart_without(self, task: str, rule_id: str, excess: Excess) -> NoReturn:
        """End this process, or let another program take its place; called from the thread that watches."""
        ...


class RuleLimits:
    """The limits of every rule of a run, and which rules have lost their turn.

    `seconds`: of computing per rule and batch, None: no limit. `deaf_rules`: for rules that did not heed the interrupt within the same time
    again; None: the interrupt is repeated until the rule ends.
    """

    def __init__(
        self,
        seconds: float | None = DEFAULT_TIMEOUT_S,
        *,
        task: str = "drives",
        deaf_rules: DeafRules | None = None,
    ) -> None:
        self.seconds = seconds
        self.batches = 1.0
        """The number of batches that the judged drive makes, if more than one: a long drive is not cut."""
        self.memory: Callable[[], int | None] = lambda: None
        """Bytes by which the process may grow while a rule runs alone, at present; None: any number."""
        self._task = task
        self._deaf = deaf_rules
        self._lost: dict[str, Excess] = {}
        self._excesses: Counter[str] = Counter()
        self.forget()

    @property
    def allowed_s(self) -> float | None:
        """Seconds that a rule may compute on the present drives."""
        return None if self.seconds is None else self.seconds * max(1.0, self.batches)

    def excess_of(self, rule_id: str) -> Excess | None:
        """Return the limit because of which a rule is not tried any more; None: it is tried."""
        return self._lost.get(rule_id)

    def forget(self) -> None:
        """Try every rule again but those that are known to be deaf."""
        self._lost = {} if self._deaf is None else dict(self._deaf.excesses(self._task))
        self._excesses.clear()

    @contextmanager
    def hold(self, con: duckdb.DuckDBPyConnection, rule_id: str, *, alone: bool) -> Iterator[RunningRule]:
        """Hold the statements on `con` inside the block to the limits.

        `alone`: no other rule runs meanwhile, so that the memory that the process takes is this rule's.
        """
        rule_run = RunningRule()
        if self.seconds is None:
            yield rule_run
            return
        args = (con, rule_id, rule_run, alone, threading.get_native_id())
        watch = Thread(target=self._watch, args=args, daemon=True, name=f"limits of {rule_id}")
        watch.start()
        try:
            yield rule_run
        finally:
            with rule_run.lock:
                rule_run.over.set()
            if rule_run.excess is not None:
                self._excesses[rule_id] += 1
                if self._excesses[rule_id] >= MOST_EXCESSES:
                    self._lost[rule_id] = rule_run.excess

    def _watch(
        self, con: duckdb.DuckDBPyConnection, rule_id: str, rule_run: RunningRule, alone: bool, thread: int
    ) -> None:
        seconds = self.allowed_s or 0.0
        work, before = Work(thread), resident_bytes()
        patience = 0.0
        most: int | None = None  # what the process may have at most before the rule is not waited for
        while not rule_run.over.wait(min(_LOOK_S, seconds)):
            now, resident = work.seconds(), resident_bytes()
            excess = rule_run.excess
            if excess is None:
                memory = self.memory() if alone else None
                if memory is None:
                    before = resident
                most = None if memory is None else before + int(_MOST_EXCESS * memory)
                if memory is not None and resident - before > memory:
                    excess, patience = "out_of_memory", now + min(_MEMORY_GRACE_S, seconds)
                elif now >= seconds:
                    excess, patience = "rule_timeout", now + seconds
                else:
                    continue
            elif most is not None and resident > most:
                patience = now  # also of a rule that is interrupted for its time, and goes on growing
            with rule_run.lock:
                if rule_run.over.is_set():
                    return
                rule_run.excess = excess
                machine_bound(f"rule {rule_id} exceeded its limits")
                con.interrupt()
                if now >= patience and self._deaf is not None:
                    self._deaf.restart_without(self._task, rule_id, excess)
