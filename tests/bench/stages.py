"""`check` by stage: the reference drive, and many short ones. Alone: `python -m tests.bench.stages`."""

from __future__ import annotations

import sys
from functools import partial
from typing import TYPE_CHECKING

from drivelint import catalogue, run
from drivelint.annotate import Annotator
from drivelint.drive.trace import IngestOptions
from drivelint.engine import batch
from drivelint.engine import session as judge
from drivelint.engine.map_library import MapLibrary
from drivelint.engine.robustness import judging as copies
from drivelint.formats import read_trace
from drivelint.report import html, junit, outputs
from drivelint.report.progress import Silent
from drivelint.result import evidence
from drivelint.sql import store
from tests.bench import traffic
from tests.bench.clock import Span, Stages, alone, by_stage, now, repeat
from tests.bench.table import Bar, Row

if TYPE_CHECKING:
    from pathlib import Path

    from tests.bench.place import Place

WATCHED = (
    (store, "connect", "database opened"),
    (catalogue, "load_rules", "catalogue read"),
    (batch, "_drive_when_read", "ingest"),  # waiting for the threads that read
    (MapLibrary, "find", "map"),
    (judge.JudgingSession, "_load_drives", "tables filled"),
    (judge, "derive", "derive"),
    (judge, "evaluate", "rules"),
    (copies, "derive", "copies"),  # but for their tables, which are filled as those of drives
    (copies, "evaluate", "copies"),
    (copies.RobustnessJudge, "judge", "copies"),
    (evidence, "gather", "report"),
    (html, "render", "report"),
    (junit, "render", "report"),
    (outputs, "write", "output files"),
    (Annotator, "__call__", "annotate"),
)
EXTRA = ("report", "annotate")


def check(traces: list[str], road: Path, out: Path, *, annotate: bool = True) -> dict[str, Span]:
    """Check drives, write everything, and return the time of each stage and of the whole."""
    settings = run.CheckOptions(
        traces=tuple(traces), map=road, out=out, rules=("ukhc",), fail_on="never", annotate=annotate
    )
    stages = Stages()
    begin = now()
    with stages.watch(*WATCHED):
        outputs.write(run.check(settings, Silent()), out)
    whole = now() - begin
    spent = {**{stage: Span() for _, _, stage in WATCHED}, **stages.spent}
    spent["the rest"] = whole - sum(spent.values(), Span())
    spent["whole"] = whole
    return spent


def reference(place: Place) -> list[Row]:
    """Measure the reference drive: stages, then what the bars ask for."""
    shape, runs = place.sizes.reference, place.sizes.runs
    trace = place.reference
    note = f"{place.states(shape):,} states, {trace.stat().st_size / 1e6:.0f} MB of OSI MCAP, median of {runs}"
    reading = repeat(partial(read_trace, trace, IngestOptions()), runs)
    spent = by_stage(partial(check, [str(trace)], place.road, place.home / "out"), runs)
    extra = sum((spent[stage] for stage in EXTRA), Span())
    verdicts = spent["whole"] - extra
    bars = {"ingest": Bar(0.5), "derive": Bar(0.6), "rules": Bar(0.7)}
    row = partial(Row, "reference drive")
    return [
        row("reading alone", reading.wall, cpu=reading.cpu, note=note),
        *(row(s, v.wall, cpu=v.cpu, bar=bars.get(s)) for s, v in spent.items() if s != "whole"),
        row(
            "to the verdict tables", verdicts.wall, cpu=verdicts.cpu, bar=Bar(2.0), note="without report, annotated log"
        ),
        row("real time", shape.seconds / verdicts.wall, "x", bar=Bar(300.0, at_least=True)),
        row("report and annotated log on top", extra.wall / verdicts.wall, "of it", bar=Bar(0.5)),
    ]


def short(place: Place) -> list[Row]:
    """Measure many short drives in a process of its own."""
    sizes = place.sizes
    folder = place.home / "short"
    for n in range(sizes.drives):
        traffic.write_folder(folder / f"s{n:04d}", sizes.short, n)
    spent, peak = alone(_short, folder, place.road, place.home / "short_out", sizes.slow_runs)
    whole = spent["whole"]
    row = partial(Row, "short drives")
    return [
        *(row(s, v.wall, cpu=v.cpu) for s, v in spent.items() if s not in {"whole", "annotate"}),
        row(
            f"{sizes.drives} drives",
            sizes.drives / whole.wall,
            "drives/s",
            cpu=whole.cpu,
            bar=Bar(90.0, at_least=True),
            note=f"Parquet, no annotated logs, median of {sizes.slow_runs}; {sizes.drives / whole.cpu:.0f} a CPU second",
        ),
        row("peak memory", peak / 1e9, "GB", bar=Bar(1.0)),
    ]


def _short(folder: Path, road: Path, out: Path, runs: int) -> dict[str, Span]:
    return by_stage(partial(check, [str(folder)], road, out, annotate=False), runs)


if __name__ == "__main__":
    from tests.bench.__main__ import main

    main(["reference", "short", *sys.argv[1:]])
