"""Reading a file is bounded by its size: a small one that describes a huge drive or map is refused with the reason and the place."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from drivelint.drive.trace import IngestOptions
from drivelint.errors import MapError, TraceError
from drivelint.formats import limits, load_map, read_trace
from drivelint.road.map_reader import MapSource
from tests.formats.logs import cars, mapping

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path


def for_ever(*_: Any) -> None:
    kept: list[int] = []
    while True:
        kept.append(len(kept))
        del kept[:-9]


def growing(*_: Any) -> None:
    kept: list[bytearray] = []
    while True:
        kept.append(bytearray(b"1" * 2**20))


@pytest.mark.parametrize(("reader", "why"), [(for_ever, "0 s of computing"), (growing, "64 MiB of memory")])
def test_reading_that_takes_too_much_is_a_sentence(
    reader: Callable[..., None], why: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(limits, "BASE_CPU_S", 0.2 if reader is for_ever else 60.0)
    monkeypatch.setattr(limits, "BASE_MEMORY_BYTES", 64 << 20 if reader is growing else 2 << 30)
    with pytest.raises(TraceError, match=f"^log: reading took more than {why}, too much for a file of 5 bytes"):
        limits.read_within_limits(reader, "log", 5, TraceError)


def test_an_interrupt_meets_nobody_else(monkeypatch: pytest.MonkeyPatch) -> None:
    """Neither another thread, nor what follows, whenever it comes."""
    monkeypatch.setattr(limits, "BASE_CPU_S", -1.0)
    monkeypatch.setattr(limits, "_READING_LIMIT_CHECK_PERIOD_S", 0.0001)

    def ends(n: int, times: int) -> set[int]:
        found = set()
        for _ in range(times):
            try:
                found.add(limits.read_within_limits(lambda: sum(i for i in range(n)), "log", 5, TraceError))
            except TraceError:
                found.add(-1)
        return found

    # those that end at once or are met while they end, and those that are surely met: the other thread has to get its turn
    assert ends(500, 300) <= {-1, sum(range(500))}
    assert ends(10_000_000, 2) == {-1}


def test_readers_of_logs_and_maps_are_bounded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Also where they take every `Exception` for a damaged file."""
    monkeypatch.setattr(limits, "BASE_CPU_S", 1.0)  # what is imported at the first reading takes less
    table = tmp_path / "cars.csv"
    table.write_text("\n".join(cars(3)), encoding="utf-8")
    monkeypatch.setattr("drivelint.drive.finish.finish_trace", for_ever)
    with pytest.raises(TraceError, match=r"cars\.csv: reading took.*\(in formats/"):
        read_trace(table, IngestOptions(mapping=str(mapping(tmp_path))))
    monkeypatch.setattr("drivelint.formats.opendrive.reader.read", for_ever)
    with pytest.raises(MapError, match=r"^map road: reading took"):
        load_map(MapSource("road", b"<OpenDRIVE/>"))
