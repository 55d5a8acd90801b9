#!/usr/bin/env bash
# rerun-sdk 0.41.0, `ParquetReader` (experimental): a drive at 10 Hz and 20 m/s that DuckDB 1.5.5 wrote as Parquet, its time column as the timeline of a recording.
#
# Expected: the column is a timestamp and says its unit (TIMESTAMP of DuckDB: microseconds), so `IndexColumn.timestamp("t")` takes the times as they are, or refuses another
# unit. `input_unit`, "ns" by default, is for plain numbers, and has to be said for those.
# Seen, without a word:
#   1. The type's unit is ignored, `input_unit` alone counts. With the default, noon of 1 November 2026 is 21 January 1970, and the samples lie 0.1 ms apart: 20 000 m/s.
#      Only TIMESTAMP_NS is right. TIMESTAMP_MS is 30 minutes after the epoch.
#   2. Parquet has no seconds, so TIMESTAMP_S is written in microseconds. With `input_unit="s"`, the unit of the column that was written, the product is too large for 64 bits
#      and wraps: the drive is in the year 1791, and its steps of 1 s are 1 000 000 s.
#   3. A sample without a time (NULL) gets one: that of another sample or the epoch, and moves there, as rows are sorted by time.
# Why it matters: TIMESTAMP in microseconds is what DuckDB, pandas 3 and polars write by default. All tables of one writer shift together, so they fit each other; the trouble
# begins beside an MCAP file, whose times are nanoseconds, and with speeds by differences. `input_unit="us"` is right, until somebody writes nanoseconds.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile --no-deps rerun-sdk==0.41.0 duckdb==1.5.5 pyarrow==26.0.1 numpy==2.4.6 attrs==26.1.0 pillow==13.0.0 psutil==7.2.2 \
  typing-extensions==4.16.0

cat >seen.py <<'PY'
import sys
import warnings
from datetime import UTC, datetime, timedelta

import duckdb
import pyarrow

warnings.simplefilter("ignore")  # the reader says that it is experimental
from rerun.chunk import IndexColumn  # noqa: E402
from rerun.experimental import ParquetReader  # noqa: E402

NOON = datetime(2026, 11, 1, 12, tzinfo=UTC)
EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
SPEED = 20.0
duckdb.sql("SET TimeZone = 'UTC'")


def write(type_name, step, without=None):
    """A drive of four samples, `step` seconds apart; the sample `without` has no time."""
    time = f"CASE WHEN i IS DISTINCT FROM {'NULL' if without is None else without} THEN TIMESTAMP '2026-11-01 12:00:00' + to_milliseconds(CAST({step * 1000} * i AS BIGINT)) END"
    rows = f"SELECT CAST({time} AS {type_name}) AS t, CAST({SPEED * step} * i AS DOUBLE) AS pos_x FROM range(4) AS row(i)"
    duckdb.sql(f"COPY ({rows}) TO 'drive.parquet' (FORMAT parquet)")


def read(**unit):
    """Nanoseconds since the epoch, and places."""
    for chunk in ParquetReader("drive.parquet").stream(index_columns=[IndexColumn.timestamp("t", **unit)]):
        batch = chunk.to_record_batch()
        if "t" in batch.schema.names:
            place = next(column.to_pylist() for name, column in zip(batch.schema.names, batch.columns, strict=True) if name not in ("t", "rerun.controls.RowId"))
            return batch.column("t").cast(pyarrow.int64()).to_pylist(), [number for part in place for number in part]
    raise SystemExit("no chunk with the timeline t")


def shown(nanoseconds):
    return (EPOCH + timedelta(microseconds=nanoseconds / 1000)).strftime("%Y-%m-%d %H:%M:%S")


def drive(type_name, step, **unit):
    write(type_name, step)
    times, places = read(**unit)
    seconds = (times[1] - times[0]) / 1e9
    speed = (places[1] - places[0]) / seconds
    said = unit.get("input_unit", "default")
    print(f"{type_name:12} input_unit {said:7}: begins {shown(times[0])}, a step of {step} s is {seconds:g} s, {speed:g} m/s")
    return shown(times[0]), round(seconds, 9), round(speed, 4)


RIGHT = (NOON.strftime("%Y-%m-%d %H:%M:%S"), 0.1, 20.0)
same = drive("TIMESTAMP", 0.1) == ("1970-01-21 18:12:14", 0.0001, 20_000.0)
same &= drive("TIMESTAMPTZ", 0.1) == ("1970-01-21 18:12:14", 0.0001, 20_000.0)
same &= drive("TIMESTAMP_MS", 0.1)[0] == "1970-01-01 00:29:53"
same &= drive("TIMESTAMP_NS", 0.1) == drive("TIMESTAMP", 0.1, input_unit="us") == drive("TIMESTAMP_MS", 0.1, input_unit="ms") == RIGHT
begin, step, _ = drive("TIMESTAMP_S", 1.0, input_unit="s")
same &= (begin[:4], step) == ("1791", 1_000_000.0)

write("TIMESTAMP", 0.1, without=2)
times, places = read(input_unit="us")
begin = int((NOON - EPOCH).total_seconds() * 1e9)
print("the sample at 4 m has no time:", *(f"{place:g} m at {(time - begin) / 1e9:g} s" for time, place in zip(times, places, strict=True)))
same &= len(times) == 4 and None not in times and 4.0 in places
sys.exit(0 if same else "changed: times of a Parquet file")
PY
venv/bin/python seen.py
