#!/usr/bin/env bash
# polars 2.1.0 and pandas 3.1.1: the nearest pose to each detection, `join_asof(strategy="nearest")` and `merge_asof(direction="nearest")`.
#
# Expected: the same rows.
# Seen: where two poses are equally near, polars takes the later one and pandas the earlier one.
# Why it matters: ties are no rare case: two sensors of 10 Hz that are triggered half a period apart tie in every row, and detections at twice the poses'
# rate in every second one.
# At 20 m/s the two tables then lie 2 m apart, a constant shift along the way, and each alone looks right.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile polars==2.1.0 pandas==3.1.1

venv/bin/python - <<'PY'
import sys

import pandas
import polars

SPEED = 20.0
begin_ns, period_ns = 1_700_000_000_000_000_000, 100_000_000
poses = {"t_ns": [begin_ns + k * period_ns for k in range(21)], "ego_x": [SPEED * k / 10 for k in range(21)]}
detections = {"t_ns": [begin_ns + k * period_ns + period_ns // 2 for k in range(20)]}
by_polars = polars.DataFrame(detections).join_asof(polars.DataFrame(poses), on="t_ns", strategy="nearest")["ego_x"].to_list()
by_pandas = pandas.merge_asof(pandas.DataFrame(detections), pandas.DataFrame(poses), on="t_ns", direction="nearest")["ego_x"].tolist()
apart = [a - b for a, b in zip(by_polars, by_pandas)]
print("ego x by polars:", by_polars[:4], "by pandas:", by_pandas[:4])
print(f"metres apart: {min(apart):.2f} to {max(apart):.2f} over {len(apart)} detections")
sys.exit(0 if all(abs(difference - 2.0) < 1e-9 for difference in apart) else 1)
PY
