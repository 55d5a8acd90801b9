#!/usr/bin/env bash
# ibis-framework 12.0.0 on DuckDB 1.5.5: the ego's pose for each detection, `detections.asof_join(poses, "time", tolerance=...)`.
#
# Expected: one row per detection, as without a tolerance and as `merge_asof` of pandas gives it; the pose is null where none is near enough.
# Seen, without a word: a frame of 8 objects has 64 rows, a frame of one has one. The result is joined with the detections once more, by the time alone, so each object
# of a frame meets the pose of each other one there. Every row is right by itself. If the two time columns have different names, no detection has a pose at all
# (ibis issue 11780).
# Why it matters: whoever counts rows counts the crowd twice over: a pedestrian who is within 2 m for 0.5 s in a crowd of 8 was there for 4 s, and a rate per detection
# weighs the full frames most. It shows only with several objects at one time; a test with one has the right rows.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3.11 -m venv --without-pip venv 2>/dev/null || python3 -m venv --without-pip venv
# Only what DuckDB needs; tables for the terminal are left out.
python3 -m pip --python venv install -q --no-compile --no-deps ibis-framework==12.0.0 duckdb==1.5.5 sqlglot==28.10.1 pandas==3.1.1 pyarrow==26.0.1 numpy==2.4.6 \
  pyarrow-hotfix==0.7 atpublic==9.0.0 parsy==2.2 toolz==1.2.0 python-dateutil==4.0.0 packaging==26.4 typing-extensions==4.16.0

cat >seen.py <<'PY'
import sys
import warnings

import ibis
import pandas as pd

warnings.simplefilter("ignore")
BEGIN = pd.Timestamp("2026-11-30 12:00:00")
FRAMES, CROWD, STEP_MS, NEAR_M = 20, 8, 100, 2.0


def time(milliseconds):
    return BEGIN + pd.Timedelta(milliseconds, "ms")


# 10 Hz: the walker is alone for a second and in a crowd for a second, and within 2 m of the ego's side for the last 0.5 s. Poses come 20 ms before, but not in the 12th frame.
rows = []
for frame in range(FRAMES):
    rows += [(time(frame * STEP_MS), "walker", 1.5 if frame >= FRAMES - 5 else 6.0)]
    rows += [(time(frame * STEP_MS), f"other {n}", 9.0 + n) for n in range(1, CROWD) if frame >= FRAMES // 2]
detections = pd.DataFrame(rows, columns=["time", "object", "side_m"])
poses = pd.DataFrame([(time(frame * STEP_MS - 20), 10.0 * frame) for frame in range(FRAMES) if frame != 12], columns=["time", "x_m"])


def counts(table):
    """Rows, the most rows per detection, how long the walker was near, and detections without a pose."""
    per_detection = table.groupby(["time", "object"])
    near = table[(table["object"] == "walker") & (table["side_m"] < NEAR_M)]
    missing = per_detection["x_m"].count() == 0
    return len(table), int(per_detection.size().max()), round(len(near) * STEP_MS / 1000, 1), int(missing.sum())


asked = pd.merge_asof(detections, poses, on="time", tolerance=pd.Timedelta(50, "ms"))
connection = ibis.duckdb.connect()
left = connection.create_table("detection", detections)
right = connection.create_table("pose", poses)
renamed = connection.create_table("stamped", poses.rename(columns={"time": "stamp"}))
interval = ibis.interval(milliseconds=50)
given = left.asof_join(right, "time", tolerance=interval).execute()
seen = {
    "pandas": counts(asked),
    "ibis, no tolerance": counts(left.asof_join(right, "time").execute()),
    "ibis": counts(given),
    "ibis, names differ": counts(left.asof_join(renamed, left.time >= renamed.stamp, tolerance=interval).execute()),
}
columns = ["time", "object", "x_m"]
alike = set(map(tuple, given[columns].dropna().values)) == set(map(tuple, asked[columns].dropna().values))
for title, (total, most, near_s, missing) in seen.items():
    print(f"{title:19} {total:4} rows for {len(detections)} detections, at most {most} for one; walker near for {near_s} s; {missing} detections without a pose")

expected = {"pandas": (90, 1, 0.5, 8), "ibis, no tolerance": (90, 1, 0.5, 0), "ibis": (594, 8, 4.0, 8), "ibis, names differ": (90, 1, 0.5, 90)}
sys.exit(0 if seen == expected and alike else "changed: rows of a join as of a time with a tolerance")
PY
venv/bin/python seen.py
