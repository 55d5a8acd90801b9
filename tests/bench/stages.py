"""Seconds per stage: `python -m tests.bench.stages [--runs N]`, from the repository's root.

Makes its drives in a temporary folder, then runs each set N times in this process (after one run to warm up) and prints medians.
Shared machines are noisy: compare lines of one run, not numbers of two.
"""

from __future__ import annotations

import argparse
import resource
import statistics
import tempfile
import time
from collections import defaultdict
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from drivelint import batch, judge, run
from drivelint.ingest import IngestOptions, read_trace
from drivelint.report.progress import Silent
from drivelint.report.outputs import write
from tests.bench import traffic

if TYPE_CHECKING:
    from collections.abc import Iterator

_clock: dict[str, float] = defaultdict(float)


@contextmanager
def _timed(owner: Any, name: str, stage: str) -> Iterator[None]:
    """Add the time spent in `owner.name` to a stage while the block runs."""
    plain = getattr(owner, name)

    def timed(*args: Any, **options: Any) -> Any:
        begin = time.perf_counter()
        try:
            return plain(*args, **options)
        finally:
            _clock[stage] += time.perf_counter() - begin

    setattr(owner, name, timed)
    try:
        yield
    finally:
        setattr(owner, name, plain)


def measure(traces: list[str], road: Path, out: Path, runs: int) -> dict[str, float]:
    """Return the median seconds of each stage of `check` over these traces, and of the whole."""
    settings = run.Settings(traces=tuple(traces), map=road, rules=("ukhc",), fail_on="never")
    taken: dict[str, list[float]] = defaultdict(list)
    for n in range(runs + 1):
        _clock.clear()
        begin = time.perf_counter()
        with (
            _timed(judge.Bench, "_load", "map, tables"),
            _timed(judge, "derive", "derive"),
            _timed(judge, "evaluate", "rules"),
            _timed(batch, "_drive", "ingest (waited for)"),
        ):
            result = run.check(settings, Silent())
        _clock["to the verdicts"] = time.perf_counter() - begin
        begin = time.perf_counter()
        write(result, out)
        _clock["written"] = time.perf_counter() - begin
        _clock["whole"] = _clock["to the verdicts"] + _clock["written"]
        if n:
            for stage, seconds in _clock.items():
                taken[stage].append(seconds)
    return {stage: statistics.median(values) for stage, values in taken.items()}


def _alone(path: Path, runs: int) -> float:
    """Return the median seconds of reading one trace."""
    taken = []
    for _ in range(runs + 1):
        begin = time.perf_counter()
        read_trace(path, IngestOptions())
        taken.append(time.perf_counter() - begin)
    return statistics.median(taken[1:])


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--short", type=int, default=1000, help="how many short drives")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        home = Path(name)
        road = home / "ring.xodr"
        road.write_text(traffic.ring(), encoding="utf-8")
        reference = traffic.write_osi(home / "reference.mcap", traffic.REFERENCE)
        print(f"reference drive: OSI MCAP, {reference.stat().st_size / 1e6:.0f} MB, 600,000 states")
        print(f"  {'ingest alone':24s} {_alone(reference, options.runs):8.2f} s")
        _print(measure([str(reference)], road, home / "out", options.runs), 1)
        short = home / "short"
        for n in range(options.short):
            traffic.write_folder(short / f"s{n:04d}", traffic.SHORT, n)
        print(f"{options.short} short drives: Parquet, 20 s, 10 Hz, 20 actors")
        _print(measure([str(short)], road, home / "out", max(1, options.runs // 3)), options.short)
    print(f"peak memory {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6:.2f} GB")


def _print(stages: dict[str, float], drives: int) -> None:
    for stage, seconds in stages.items():
        print(f"  {stage:24s} {seconds:8.2f} s")
    if drives > 1:
        print(f"  {'drives a second':24s} {drives / stages['whole']:8.1f}")


if __name__ == "__main__":
    main()
