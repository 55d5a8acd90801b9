"""A converted log keeps the projection of its coordinates, and can be judged on maps of other projections."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from drivelint.convert import ConvertRequest, convert
from drivelint.drive.trace import IngestOptions
from drivelint.errors import TraceError
from drivelint.formats import read_trace
from tests.engine.frames import FRAMES, LOG, drive_on_map, in_frame, numbers, plain, road

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.drive.trace import Trace

Target = Literal["mcap", "parquet"]
TO: tuple[Target, ...] = ("mcap", "parquet")
REFERENCE, OFFSET = FRAMES[3]


def converted(to: Target, out: Path, monkeypatch: pytest.MonkeyPatch, map_file: Path | None = None) -> Trace:
    monkeypatch.setattr("drivelint.convert.read_trace", lambda *_: in_frame(REFERENCE, OFFSET))
    return read_trace(convert(ConvertRequest(str(LOG), to, out, map=map_file)).path, IngestOptions())


@pytest.mark.parametrize("to", TO)
def test_it_is_kept(tmp_path: Path, to: Target, monkeypatch: pytest.MonkeyPatch) -> None:
    again = converted(to, tmp_path / "out", monkeypatch)
    assert (again.geo_reference, again.geo_offset) == (REFERENCE, OFFSET)
    drive = drive_on_map(again, road(tmp_path))
    np.testing.assert_allclose(numbers(drive.trace)["x_m"], numbers(plain())["x_m"], atol=1e-3)


@pytest.mark.sample(1, ci=1)
@pytest.mark.parametrize("to", TO)
def test_on_a_given_map_it_is_the_maps(tmp_path: Path, to: Target, monkeypatch: pytest.MonkeyPatch) -> None:
    map_file = road(tmp_path)
    on_it = drive_on_map(in_frame(REFERENCE, OFFSET), map_file).trace
    again = converted(to, tmp_path / "out", monkeypatch, map_file)
    assert (again.geo_reference, again.geo_offset) == (on_it.geo_reference, on_it.geo_offset) != (REFERENCE, OFFSET)
    assert numbers(drive_on_map(again, map_file).trace)["x_m"].tolist() == numbers(on_it)["x_m"].tolist()


def test_a_projection_that_is_none_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    converted("parquet", tmp_path, monkeypatch)
    file = tmp_path / "data_log.parquet"
    log = pq.read_table(file)
    at = log.schema.get_field_index("geo_x_m")
    pq.write_table(log.set_column(at, "geo_x_m", pa.array(["west"])), file)
    with pytest.raises(TraceError, match=r"data_log\.parquet: column 'geo_x_m' is string, not double"):
        read_trace(tmp_path, IngestOptions())
