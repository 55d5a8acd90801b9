#!/usr/bin/env bash
# deltalake 1.6.6: `write_deltalake` of a table of poses whose time is Arrow's timestamp[ns], read back, and joined with the Parquet file of the detections.
#
# Expected: an error as the Delta format has microseconds only, or nanoseconds back.
# Seen: the write succeeds without a warning and cuts the last three digits. Of 1001 rows with unique times two share one afterwards, and a join by time
# with the detections, which are at the very same nanoseconds, finds 9 rows of 1001.
# Why it matters: logs stamp poses and detections with one clock in nanoseconds, and tables are joined by it. Whoever puts one of two tables into Delta loses nearly
# all pairs.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile deltalake==1.6.6 pyarrow==26.0.1 duckdb==2.0.1

venv/bin/python -W error - <<'PY'
import sys

import duckdb
import pyarrow
from deltalake import DeltaTable, write_deltalake

begin_ns = 1_700_000_000_123_456_789
times_ns = [begin_ns + k * 10_000_000 + (k * k) % 777 for k in range(1000)]
times_ns += [times_ns[-1] + 333]
poses = pyarrow.table({"t": pyarrow.array(times_ns, pyarrow.timestamp("ns", "UTC")), "x": [float(k) for k in range(len(times_ns))]})
detections = poses.rename_columns(["t", "detected_x"])
write_deltalake("poses", poses)
back = DeltaTable("poses").to_pyarrow_table()
back_ns = back["t"].cast(pyarrow.int64()).to_pylist()
lost_ns = sorted(t - 1000 * u for t, u in zip(times_ns, sorted(back_ns)))
print("time of the poses:", poses.schema.field("t").type, "read back:", back.schema.field("t").type)
print(f"rows {len(times_ns)}, times before {len(set(times_ns))}, after {len(set(back_ns))}; shifted by {lost_ns[0]} to {lost_ns[-1]} ns, always to earlier")
joined = duckdb.sql("SELECT count(*) FROM detections JOIN back USING (t)").fetchall()[0][0]
before = duckdb.sql("SELECT count(*) FROM detections JOIN poses USING (t)").fetchall()[0][0]
print(f"rows of detections JOIN poses by time: {before} before, {joined} through Delta")
cut = back.schema.field("t").type == pyarrow.timestamp("us", "UTC") and 0 <= lost_ns[0] and lost_ns[-1] < 1000
sys.exit(0 if cut and before == len(times_ns) and joined < 10 and len(set(back_ns)) < len(set(times_ns)) else 1)
PY
