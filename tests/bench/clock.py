"""Time by stage, wall and CPU, and the memory of a process of its own."""

from __future__ import annotations

import multiprocessing
import re
import statistics
import time
from collections import defaultdict
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, ParamSpec, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

P = ParamSpec("P")
T = TypeVar("T")


class Span(NamedTuple):
    """Seconds by the clock, and of CPU in all threads of this process."""

    wall: float = 0.0
    cpu: float = 0.0

    def __add__(self, span: tuple[Any, ...]) -> Span:
        return Span(self.wall + span[0], self.cpu + span[1])

    def __sub__(self, span: Span) -> Span:
        return Span(self.wall - span.wall, self.cpu - span.cpu)


def now() -> Span:
    """Return the clocks."""
    return Span(time.perf_counter(), time.process_time())


class Stages:
    """Time spent in functions while the block of `watch` runs, each without the watched functions that it calls.

    Only functions that run in the main thread can be watched.
    """

    def __init__(self) -> None:
        self.spent: dict[str, Span] = defaultdict(Span)
        self._inner: list[Span] = [Span()]

    @contextmanager
    def watch(self, *watched: tuple[Any, str, str]) -> Iterator[None]:
        """Watch (owner, name of the function, stage). Errors: `TypeError` for what is no function, such as a module of that name."""
        plain = [(owner, name, getattr(owner, name)) for owner, name, _ in watched]
        for owner, name, found in plain:
            if not callable(found):
                raise TypeError(f"{owner.__name__}.{name} is no function")
        for (owner, name, stage), (_, _, function) in zip(watched, plain, strict=True):
            setattr(owner, name, self._timed(function, stage))
        try:
            yield
        finally:
            for owner, name, function in plain:
                setattr(owner, name, function)

    def _timed(self, function: Callable[P, T], stage: str) -> Callable[P, T]:
        def timed(*args: P.args, **options: P.kwargs) -> T:
            begin = now()
            self._inner.append(Span())
            try:
                return function(*args, **options)
            finally:
                took = now() - begin
                self.spent[stage] += took - self._inner.pop()
                self._inner[-1] += took

        return timed


def median(spans: Sequence[Span]) -> Span:
    """Return the medians of wall and CPU seconds."""
    return Span(statistics.median(s.wall for s in spans), statistics.median(s.cpu for s in spans))


def repeat(function: Callable[[], object], runs: int) -> Span:
    """Return the median over `runs` calls, after one that does not count; a single one is not warmed up for."""
    spans = []
    for _ in range(runs + (runs > 1)):
        begin = now()
        function()
        spans.append(now() - begin)
    return median(spans[-runs:])


def by_stage(once: Callable[[], dict[str, Span]], runs: int) -> dict[str, Span]:
    """Return the median of each stage over `runs` calls, after one that does not count; a single one is not warmed up for."""
    taken = [once() for _ in range(runs + (runs > 1))][-runs:]
    return {stage: median([spans.get(stage, Span()) for spans in taken]) for stage in taken[0]}


def alone(function: Callable[..., T], *args: object) -> tuple[T, float]:
    """Return what a function of a module returns in a fresh process, and the most memory that process had, in bytes."""
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        return pool.submit(_with_peak, function, args).result()


def _with_peak(function: Callable[..., T], args: tuple[object, ...]) -> tuple[T, float]:
    result = function(*args)
    # not ru_maxrss: that one is inherited from the process that started this one
    found = re.search(r"VmHWM:\s+(\d+) kB", Path("/proc/self/status").read_text(encoding="ascii"))
    return result, float(found.group(1)) * 1024 if found else float("nan")
