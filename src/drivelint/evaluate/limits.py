"""Limits the computing time and the memory of each rule.

The time is CPU time, so that verdicts do not depend on other programs of the machine. A statement that exceeds its limit is interrupted.
DuckDB reacts to an interrupt only between two vectors of rows: a function that works on huge values continues.
`UnstoppableRuleHandler` decides what to do about such an unstoppable rule.
"""

from __future__ import annotations

import threading
from collections import Counter
from contextlib import contextmanager
from threading import Event, Lock, Thread
from typing import TYPE_CHECKING, Final, Literal, NoReturn, Protocol

from drivelint.computing import ProcessorClock, resident_bytes
from drivelint.receipts.events import report_not_repeatable

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    import duckdb

DEFAULT_TIMEOUT_S: Final = 30.0
"""The default limit of CPU seconds per rule and batch."""
LIMIT_EXCESSES_BEFORE_RULE_REFUSAL: Final = 3
"""A rule that exceeded its limits this many times does not run again; else it would run for each drive of a failed batch."""
_RULE_LIMIT_CHECK_PERIOD_S: Final = 0.1
_GRACE_AFTER_MEMORY_EXCESS_S: Final = 0.5
"""CPU seconds within which a rule must react to an interrupt because of its memory, unless `_MOST_MULTIPLE_OF_MEMORY_LIMIT` is
reached before."""
_MOST_MULTIPLE_OF_MEMORY_LIMIT: Final = 1.25
"""If a rule has used this multiple of its memory limit, it gets no more time to react to the interrupt."""

Excess = Literal["rule_timeout", "out_of_memory"]
"""The limit that a rule exceeded, as the reason code of its verdicts."""


class RunningRule:
    """The current run of a rule, and the limit that it exceeded, if any. `end_event` is set at its end."""

    def __init__(self) -> None:
        self.excess: Excess | None = None
        self.end_event = Event()
        self.lock = Lock()
        """Locked while the rule is interrupted, because an interrupt after its end would hit the next rule."""


class UnstoppableRuleHandler(Protocol):
    """The interface to handle unstoppable rules: rules that do not react to an interrupt. `task`: whether drives or copies are judged."""

    def exceeded_limits(self, task: str) -> Mapping[str, Excess]:
        """Return rule id -> exceeded limit, for the unstoppable rules of a task. They must not run."""
        ...

    def restart_without(self, task: str, rule_id: str, excess: Excess) -> NoReturn:
        """End this process, or replace it by a new one without this rule; called from the watching thread."""
        ...


class RuleLimits:
    """The limits of every rule of a run, and the rules that must not run again.

    `seconds`: CPU seconds per rule and batch, None: no limit. `unstoppable_rule_handler`: handles a rule that has not reacted to an
    interrupt for another `seconds`; None: the interrupt is repeated until the rule ends.
    """

    def __init__(
        self,
        seconds: float | None = DEFAULT_TIMEOUT_S,
        *,
        task: str = "drives",
        unstoppable_rule_handler: UnstoppableRuleHandler | None = None,
    ) -> None:
        self.seconds = seconds
        self.batches = 1.0
        """The size of the judged drives in batches; over 1 for a long drive, which is not split and gets more time."""
        self.memory: Callable[[], int | None] = lambda: None
        """Returns by how many bytes the process may grow while a rule runs alone; None: no limit."""
        self._task = task
        self._unstoppable_rule_handler = unstoppable_rule_handler
        self._lost: dict[str, Excess] = {}
        self._excesses: Counter[str] = Counter()
        self.forget_excesses()

    @property
    def allowed_cpu_s(self) -> float | None:
        """The CPU seconds of a rule for the current drives; None: no limit."""
        return None if self.seconds is None else self.seconds * max(1.0, self.batches)

    def exceeded_limit(self, rule_id: str) -> Excess | None:
        """Return the limit because of which a rule must not run; None: it may run."""
        return self._lost.get(rule_id)

    def forget_excesses(self) -> None:
        """Allow every rule to run again, except the unstoppable ones."""
        self._lost = (
            {}
            if self._unstoppable_rule_handler is None
            else dict(self._unstoppable_rule_handler.exceeded_limits(self._task))
        )
        self._excesses.clear()

    @contextmanager
    def limit_statements(self, con: duckdb.DuckDBPyConnection, rule_id: str, *, alone: bool) -> Iterator[RunningRule]:
        """Apply the limits to the statements on `con` inside the block.

        `alone`: no other rule runs at the same time, so that this rule causes the growth of the process's memory.
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
                rule_run.end_event.set()
            if rule_run.excess is not None:
                self._excesses[rule_id] += 1
                if self._excesses[rule_id] >= LIMIT_EXCESSES_BEFORE_RULE_REFUSAL:
                    self._lost[rule_id] = rule_run.excess

    def _watch(
        self, con: duckdb.DuckDBPyConnection, rule_id: str, rule_run: RunningRule, alone: bool, thread: int
    ) -> None:
        seconds = self.allowed_cpu_s or 0.0
        work, before = ProcessorClock(thread), resident_bytes()
        patience = 0.0
        most_bytes: int | None = None  # the memory of the process above which the rule gets no more time to react
        while not rule_run.end_event.wait(min(_RULE_LIMIT_CHECK_PERIOD_S, seconds)):
            now, resident = work.seconds(), resident_bytes()
            excess = rule_run.excess
            if excess is None:
                memory = self.memory() if alone else None
                if memory is None:
                    before = resident
                most_bytes = None if memory is None else before + int(_MOST_MULTIPLE_OF_MEMORY_LIMIT * memory)
                if memory is not None and resident - before > memory:
                    excess, patience = "out_of_memory", now + min(_GRACE_AFTER_MEMORY_EXCESS_S, seconds)
                elif now >= seconds:
                    excess, patience = "rule_timeout", now + seconds
                else:
                    continue
            elif most_bytes is not None and resident > most_bytes:
                patience = now  # also for a rule that was interrupted because of its time, and continues to grow
            with rule_run.lock:
                if rule_run.end_event.is_set():
                    return
                rule_run.excess = excess
                report_not_repeatable(f"rule {rule_id} exceeded its limits")
                con.interrupt()
                if now >= patience and self._unstoppable_rule_handler is not None:
                    self._unstoppable_rule_handler.restart_without(self._task, rule_id, excess)
