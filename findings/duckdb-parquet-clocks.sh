#!/usr/bin/env bash
# DuckDB 1.5.5 on Parquet files of pyarrow 26.0.1 and polars 2.1.0: the same nanosecond clock with and without UTC, and durations.
#
# Expected: times are equal where their nanoseconds are, and a duration is an interval, or at least has its unit.
# Seen: timestamp[ns] is TIMESTAMP_NS, exact; timestamp[ns, UTC] is TIMESTAMP WITH TIME ZONE, cut to microseconds without a word. A duration is a bare BIGINT:
# one of nanoseconds and one of microseconds are read alike.
# Why it matters: a join by time of a table with UTC and one without, of the same samples, finds only those on a whole microsecond. The step that polars
# made of two times, and divides a distance by, is a thousand times too long or too short.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile duckdb==1.5.5 pyarrow==26.0.1 polars==2.1.0

venv/bin/python - <<'PY'
import sys

import duckdb
import polars as pl
import pyarrow as pa
import pyarrow.parquet as pq

# 30 frames per second: of three steps one is a whole microsecond.
clock = [1_700_000_000_000_000_000 + (k * 1_000_000_000) // 30 for k in range(900)]
for name, zone in (("ego", None), ("detections", "UTC")):
    times = pa.array(clock, pa.timestamp("ns", zone))
    pq.write_table(pa.table({"t": times, "t_ns": clock}), f"{name}.parquet")
for unit in ("ns", "us"):
    pl.DataFrame({"step": pl.Series([33_333_333], dtype=pl.Duration(unit))}).write_parquet(f"{unit}.parquet")

con = duckdb.connect()
types = [con.sql(f"SELECT DISTINCT typeof(t) FROM '{name}.parquet'").fetchone()[0] for name in ("ego", "detections")]
lost = con.sql("SELECT max(t_ns - epoch_ns(t)) FROM 'detections.parquet'").fetchone()[0]
joined, same = (
    con.sql(f"SELECT count(*) FROM 'ego.parquet' e JOIN 'detections.parquet' d ON {condition}").fetchone()[0]
    for condition in ("epoch_ns(e.t) = epoch_ns(d.t)", "e.t_ns = d.t_ns")
)
steps = [con.sql(f"SELECT typeof(step), step FROM '{unit}.parquet'").fetchone() for unit in ("ns", "us")]
print(f"timestamp[ns] is {types[0]}, timestamp[ns, UTC] is {types[1]}; up to {lost} ns are lost")
print(f"joined by time: {joined} of {same} rows that are the same samples")
print(f"a duration of 33 ms in nanoseconds, and one of 33 s in microseconds: {steps[0]} and {steps[1]}")
expected = ["TIMESTAMP_NS", "TIMESTAMP WITH TIME ZONE"]
sys.exit(0 if types == expected and 0 < lost < 1000 and joined < same == 900 and steps[0] == steps[1] == ("BIGINT", 33_333_333) else 1)
PY
