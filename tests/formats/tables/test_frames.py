"""Tables whose time column counts frames."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from drivelint.errors import UsageError
from drivelint.formats.tables.mapping import load
from tests.formats.logs import LONG, mapping, read, states, table

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.parametrize(("rate", "first"), [("25", 40_000_000), ("29.97", 33_366_700)])
@pytest.mark.parametrize("is_parquet", [False, True])
def test_a_column_that_counts_frames_is_a_time(tmp_path: Path, rate: str, first: int, is_parquet: bool) -> None:
    step = 10.0 / float(rate)
    lines = ["t,id,x,y,yaw,vx,vy", *(f"{i},a,{i * step},0,0,10,0" for i in range(20))]
    name = mapping(tmp_path, LONG.replace('column = "t"', f'column = "t"\nunit = "frames"\nrate_hz = {rate}'))
    path = table(tmp_path / "d.csv", lines)
    if is_parquet:
        path = tmp_path / "d.parquet"
        x = [i * step for i in range(20)]
        still = dict.fromkeys(("y", "yaw", "vy"), [0.0] * 20)
        pq.write_table(pa.table({"t": range(20), "id": ["a"] * 20, "x": x, "vx": [10.0] * 20, **still}), path)
    found = [row["t_ns"] for row in states(read(path, mapping=name))]
    assert found[:2] == [0, first]
    assert found == [round(i * 1e9 / float(rate)) for i in range(20)]


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ('unit = "frames"', "time.unit = 'frames' needs time.rate_hz"),
        ("rate_hz = 25", "no other unit takes it"),
        ('unit = "frames"\nrate_hz = 0', "time.rate_hz must be more than 0"),
    ],
)
def test_a_rate_belongs_to_frames(tmp_path: Path, lines: str, message: str) -> None:
    with pytest.raises(UsageError, match=message):
        load(mapping(tmp_path, LONG.replace('column = "t"', f'column = "t"\n{lines}')))
