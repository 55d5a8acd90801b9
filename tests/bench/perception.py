"""Perception logs of public data sets: the CPU per state of their readers beside that of drivelint's own Parquet, from the same drive."""

from __future__ import annotations

from typing import TYPE_CHECKING

from drivelint.convert import ConvertRequest, convert
from drivelint.drive.trace import IngestOptions
from drivelint.formats import read_trace
from tests.bench.clock import median, now
from tests.bench.table import Bar, Row, Skipped
from tests.shared_data import DATA

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from tests.bench.clock import Span
    from tests.bench.place import Place

MOST_TIMES_PARQUET = 1.3
OPTIONS = IngestOptions(need_ego=False)


def perception(place: Place) -> list[Row]:
    """Read each log and its twin in turn: both meet the same load of the machine."""
    rows = []
    for log in _logs():
        twin = place.home / "twins" / log.name
        convert(ConvertRequest(trace=str(log), to="parquet", out=twin))
        n = read_trace(log, OPTIONS).tables["actor_state"].num_rows
        if read_trace(twin, OPTIONS).tables["actor_state"].num_rows != n:
            raise AssertionError(f"{log.name}: its twin has other states")
        spans = [(_reading(log), _reading(twin)) for _ in range(place.sizes.runs)]
        log_span, twin_span = (median(side) for side in zip(*spans, strict=True))
        note = f"{n} states; Parquet {twin_span.cpu:.3f} CPU s"
        rows.append(
            Row(
                "perception",
                log.name,
                log_span.cpu / twin_span.cpu,
                "times Parquet",
                log_span.cpu,
                Bar(MOST_TIMES_PARQUET),
                note=note,
            )
        )
    return rows


def _logs() -> Iterator[Path]:
    folder = DATA / "perception"
    if not folder.is_dir():
        raise Skipped("the perception logs are not beside this checkout")
    yield from sorted(folder.glob("av2/*"))
    yield from sorted(folder.glob("av2_forecasting/*.parquet"))
    yield from sorted(folder.glob("d123/*/*"))
    yield from sorted(folder.glob("scenarionet/*.pkl"))


def _reading(path: Path) -> Span:
    begin = now()
    read_trace(path, OPTIONS)
    return now() - begin
