"""Heights of OSI objects that are copies of their widths: omega-prime 0.3.7 writes such an MCAP file of its own Parquet, which is right."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from tests.formats.logs import actors, quality, read, states
from tests.formats.osi import osi_log
from tests.formats.osi.bulbs import write

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.drive.trace import Trace

Size = tuple[float, float, float]
CAR, VAN, WALKER = (4.5, 1.8, 1.5), (6.5, 2.1, 2.8), (0.5, 0.5, 1.8)


def log_of(tmp_path: Path, *sizes: Size) -> Trace:
    """Return a log with an object of each size (length, width, height)."""
    frames = []
    for i in range(30):
        truth = osi_log.frame(i * 100_000_000)
        for number, size in enumerate(sizes):
            osi_log.moving(truth, number, float(i), 5.0 * number, size=size)
        frames.append(truth)
    return read(write(tmp_path, frames))


def copied(size: Size) -> Size:
    length, width, _ = size
    return length, width, width


@pytest.mark.parametrize("sizes", [(CAR,), (CAR, VAN, WALKER)])
def test_heights_that_all_are_widths_are_unknown(sizes: tuple[Size, ...], tmp_path: Path) -> None:
    trace = log_of(tmp_path, *map(copied, sizes))
    found = quality(trace)["copied_height"]
    assert (found["severity"], found["n"]) == ("warning", 30 * len(sizes))
    assert "omega-prime 0.3.7" in found["message"]
    for number, (length, width, _) in enumerate(sizes):
        row = actors(trace)[str(number)]
        assert (row["length_m"], row["width_m"], row["height_m"]) == (length, width, None)
    assert {row["z_m"] for row in states(trace)} == {0.75}


def test_one_object_that_is_as_high_as_wide_says_nothing(tmp_path: Path) -> None:
    trace = log_of(tmp_path, CAR, copied(VAN))
    assert "copied_height" not in quality(trace)
    assert [actors(trace)[name]["height_m"] for name in "01"] == [1.5, 2.1]


def test_the_heights_of_omega_primes_parquet_are_its_own(tmp_path: Path) -> None:
    rows = [
        {
            "total_nanos": 100_000_000 * i, "idx": idx, "x": float(i), "y": 9.0 * idx, "z": 0.75, "vel_x": 10.0, "vel_y": 0.0, "vel_z": 0.0,
            "acc_x": 0.0, "acc_y": 0.0, "acc_z": 0.0, "length": size[0], "width": size[1], "height": size[2], "roll": 0.0, "pitch": 0.0,
            "yaw": 0.0, "type": 2, "role": 0, "subtype": 4,
        }
        for i in range(30)
        for idx, size in enumerate((CAR, VAN))
    ]  # fmt: skip
    pq.write_table(pa.Table.from_pylist(rows), tmp_path / "a.parquet")
    trace = read(tmp_path / "a.parquet", ego="0")
    assert {name: row["height_m"] for name, row in actors(trace).items()} == {"0": 1.5, "1": 2.8}
    assert "copied_height" not in quality(trace)
