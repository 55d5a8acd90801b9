"""The process that reads damaged files: it is warm, it has a memory limit, and it may die."""

from __future__ import annotations

import os
import resource
import sys
import traceback
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from tests.fuzz import judging, traces
from tests.fuzz.inputs import INPUTS, Input, use_case
from tests.fuzz.mutations import generator
from tests.fuzz.outcome import Outcome
from tests.fuzz.sources import Source, remove_folder, scratch

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from multiprocessing.connection import Connection
    from random import Random

    from tests.fuzz.traces import Changed, DamagedTrace

REWRITTEN: Final[dict[str, tuple[tuple[str, ...], Callable[[Source, Random], Changed]]]] = {
    "messages": (("osi-mcap", "foxglove", "ros"), traces.with_other_messages),
    "cells": (("parquet",), traces.with_other_cells),
}
"""Kind -> the kinds of which it takes the sources, and how their content is changed before new checksums are made."""
KINDS: Final = (*traces.DAMAGED, *REWRITTEN, *INPUTS)
MORE_MEMORY_BYTES: Final = 3 * 2**30
"""What a process may take beside what it has when it is warm: a small file needs a few megabytes."""


class Job(NamedTuple):
    """Some cases of one kind: their seed, the first number, how many, and whether those that can be read are judged."""

    kind: str
    seed: int
    first: int
    n: int
    is_judged: bool
    save: str | None = None


@dataclass
class Bench:
    """The valid files of each kind and what they say, made when they are needed."""

    home: Path = field(default_factory=scratch)
    sources: dict[str, list[Any]] = field(default_factory=dict)
    whole: dict[tuple[str, str], Any] = field(default_factory=dict)
    verdicts: dict[str, list[dict[str, Any]]] = field(default_factory=dict)

    def of(self, kind: str) -> list[Any]:
        """Return the sources of a kind."""
        if kind not in self.sources:
            makers: list[Callable[[Path], Sequence[Source | Input]]] = [
                INPUTS[each] if each in INPUTS else traces.DAMAGED[each]
                for each in (REWRITTEN[kind][0] if kind in REWRITTEN else (kind,))
            ]
            home = self.home / f"of-{kind}"
            self.sources[kind] = []
            for i, make in enumerate(makers):
                (home / str(i)).mkdir(parents=True)
                self.sources[kind] += make(home / str(i))
        return self.sources[kind]

    def whole_content(self, kind: str, source: Any) -> Any:
        """Return what the undamaged files say."""
        key = kind, source.name
        if key not in self.whole:
            place = source.write(self.home / f"whole-{kind}-{source.name}")
            if isinstance(source, Input):
                self.whole[key] = source.use(place, 1)
            else:
                self.whole[key] = traces.content_of(traces.read(place, source))
        return self.whole[key]

    def whole_verdicts(self, source: Source) -> list[dict[str, Any]]:
        """Return the verdicts of an undamaged trace."""
        if source.name not in self.verdicts:
            _, found = judging.judge([source.write(self.home / f"judged-{source.name}")], source.options)
            (self.verdicts[source.name],) = found.values()
        return self.verdicts[source.name]

    def run(self, job: Job) -> Iterator[Outcome | int]:
        """Yield each number before it is tried, and its outcome; then those that judging found to be worse."""
        readable: dict[str, dict[int, DamagedTrace]] = {}
        told: dict[int, str] = {}
        place = scratch()
        try:
            for number in range(job.first, job.first + job.n):
                yield number
                outcome, read = self._case(job, number, place / f"{job.kind}-{number}")
                yield outcome
                told[number] = outcome.source
                if read is not None and job.is_judged:
                    readable.setdefault(outcome.source, {})[number] = read
            for name, cases in readable.items():
                yield next(iter(cases))
                whole = self.whole_verdicts(next(iter(cases.values())).source)
                for number, (worse, detail) in judging.problems(cases, whole).items():
                    yield Outcome(job.kind, number, name, worse, detail)
        finally:
            remove_folder(place)

    def _case(self, job: Job, number: int, place: Path) -> tuple[Outcome, DamagedTrace | None]:
        rng = generator(f"{job.seed}/{job.kind}/{number}")
        source = rng.choice(self.of(job.kind))
        whole = self.whole_content(job.kind, source)
        rewritten = job.kind in REWRITTEN
        change = REWRITTEN[job.kind][1] if rewritten else traces.damaged
        changed = source.damaged(rng) if isinstance(source, Input) else change(source, rng)
        path = source.write(Path(job.save) if job.save else place, changed)
        if isinstance(source, Input):
            return Outcome(job.kind, number, source.name, *use_case(source, path, number, whole)), None
        outcome, detail, read = traces.read_case(path, source, whole, rewritten=rewritten)
        return Outcome(job.kind, number, source.name, outcome, detail), read


def serve(connection: Connection, log: str) -> None:
    """Run jobs from a connection until it says None; what the process prints goes to a file."""
    with open(log, "ab", buffering=0) as file:  # noqa: PTH123 - a file descriptor is needed
        os.dup2(file.fileno(), 1)
        os.dup2(file.fileno(), 2)
    sys.setrecursionlimit(1000)  # pytest raises it in its own process
    bench = Bench()
    try:
        while (job := connection.recv()) is not None:
            try:
                resource.setrlimit(
                    resource.RLIMIT_AS, (resource.RLIM_INFINITY, resource.RLIM_INFINITY)
                )  # of the last job
                for source in bench.of(job.kind):
                    bench.whole_content(job.kind, source)
                _limit_memory()
                for told in bench.run(job):
                    connection.send(told)
            except Exception:  # noqa: BLE001 - raised again where somebody sees it
                connection.send(traceback.format_exc())
                return
            connection.send(None)
    finally:
        remove_folder(bench.home)


def _limit_memory() -> None:
    """Set the limit anew for each job: libraries keep addresses that they do not use."""
    now = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (now + MORE_MEMORY_BYTES, resource.RLIM_INFINITY))
