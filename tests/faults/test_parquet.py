"""Parquet files that lie about their content: damaged pages, and few bytes that unpack to many."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from drivelint.errors import TraceError
from drivelint.formats.tables import parquet
from tests.faults import drives
from tests.formats.logs import read

if TYPE_CHECKING:
    from pathlib import Path


def test_checksums_of_pages_are_checked(tmp_path: Path) -> None:
    path = tmp_path / "log.parquet"
    pq.write_table(
        drives.table(drives.drive()), path, compression="NONE", use_dictionary=False, write_page_checksum=True
    )
    data = bytearray(path.read_bytes())
    column = pq.read_metadata(path).row_group(0).column(2)
    data[column.data_page_offset + column.total_compressed_size - 8] ^= 1
    path.write_bytes(data)
    with pytest.raises(TraceError, match=r"log\.parquet: not readable as Parquet: .*CRC"):
        read(path, ego="0")


def test_a_bomb_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "log.parquet"
    rows = pa.table({name: pa.repeat(pa.scalar(0.0), 2_000_000) for name in ("x_m", "y_m", "yaw_rad")})
    ids = pa.repeat(pa.scalar("a"), 2_000_000).dictionary_encode()
    pq.write_table(rows.append_column("t_ns", pa.repeat(pa.scalar(0), 2_000_000)).append_column("actor_id", ids), path)
    monkeypatch.setattr(parquet, "UNPACKED_BYTES_ALLOWED_FOR_ANY_FILE", 64 << 20)
    with pytest.raises(TraceError, match=r"2000000 rows in a file of \d+ bytes would unpack to 76 MiB: write it again"):
        read(path)


def test_a_long_log_of_parked_cars_is_no_bomb(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = drives.parquet(tmp_path / "log", drives.drive(400))
    monkeypatch.setattr(parquet, "UNPACKED_BYTES_ALLOWED_FOR_ANY_FILE", 0)
    assert read(path, ego="0").tables["actor_state"].num_rows == 1200
