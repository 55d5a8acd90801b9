"""What a state costs as drives get longer, and the memory of a very long one."""

from __future__ import annotations

import shutil
from typing import TYPE_CHECKING

from tests.bench import stages, traffic
from tests.bench.clock import Span, alone, median
from tests.bench.table import Bar, Row

if TYPE_CHECKING:
    from pathlib import Path

    from tests.bench.place import Place

NOTE_STAGES = ("derive", "rules", "report")


def growth(place: Place) -> list[Row]:
    """Measure the cost per state at each length, by CPU seconds: the lengths take turns, so that noise meets them all."""
    sizes = place.sizes
    unit = sizes.unit
    shapes = {n: unit._replace(seconds=unit.seconds * n) for n in sizes.lengths}
    folders = {n: traffic.write_folder(place.home / f"long{n}", shape) for n, shape in shapes.items()}
    out = place.home / "long_out"
    if sizes.slow_runs > 1:  # warm up
        stages.check([str(folders[sizes.lengths[0]])], place.road, out, annotate=False)
    taken: dict[int, list[dict[str, Span]]] = {n: [] for n in sizes.lengths}
    for _ in range(sizes.slow_runs):
        for n, folder in folders.items():
            taken[n].append(stages.check([str(folder)], place.road, out, annotate=False))
    for folder in folders.values():
        shutil.rmtree(folder)
    cost = {n: {stage: median([t[stage] for t in runs]) for stage in runs[0]} for n, runs in taken.items()}
    first = cost[sizes.lengths[0]]
    rows = []
    for n, spent in cost.items():
        each = place.states(shapes[n])
        rows.append(
            Row(
                "growth",
                f"a state at {n}x",
                1e6 * spent["whole"].wall / each,
                "us",
                cpu=spent["whole"].cpu,
                note=f"{each:,} states, median of {sizes.slow_runs}",
            )
        )
        if n == sizes.lengths[0]:
            continue
        rows.append(
            Row(
                "growth",
                f"CPU of a state, {n}x against {sizes.lengths[0]}x",
                _grown(spent, first, "whole", n),
                "x",
                bar=Bar(1.15),
                note=", ".join(f"{s} {_grown(spent, first, s, n):.2f}" for s in NOTE_STAGES)
                + f"; wall {spent['whole'].wall / first['whole'].wall * sizes.lengths[0] / n:.2f}",
            )
        )
    return rows


def _grown(spent: dict[str, Span], first: dict[str, Span], stage: str, n: int) -> float:
    return spent[stage].cpu / max(first[stage].cpu, 1e-9) / n


def long(place: Place) -> list[Row]:
    """Measure one very long drive in a process of its own."""
    shape = place.sizes.reference._replace(seconds=place.sizes.hours * 3600)
    folder = traffic.write_folder(place.home / "hours", shape)
    spent, peak = alone(_long, folder, place.road, place.home / "hours_out")
    shutil.rmtree(folder)
    note = f"{place.states(shape):,} states, once"
    return [
        Row("long drive", f"{place.sizes.hours:g} h", spent["whole"].wall, cpu=spent["whole"].cpu, note=note),
        Row("long drive", "peak memory", peak / 2**30, "GiB", bar=Bar(2.0)),
    ]


def _long(folder: Path, road: Path, out: Path) -> dict[str, Span]:
    return stages.check([str(folder)], road, out, annotate=False)
