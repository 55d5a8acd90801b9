#!/usr/bin/env bash
# asammdf 8.8.28: `MDF.cut` of a measurement whose speed has samples that the recorder marked as invalid (invalidation bits of MDF 4).
#
# Expected: the cut file begins at the cut; its first sample is a valid one that was recorded, or one that is marked as invalid.
# Seen: at the cut, `cut` adds a sample that nobody recorded: the mean of the last valid value and of the invalid one behind it (with 327.67, as
# a signal of 16 bits has it for "not available", 169.835 m/s). It is marked as valid, also after the file was written and read again.
# `to_dataframe` fills the invalid rows on a line, and goes on with the last value behind a signal's end.
# Why it matters: vehicle measurements are cut to scenes before anybody looks at them. A drive at 12 m/s then begins with 169.8 m/s.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile asammdf==8.8.28 numpy==2.4.6 pandas==3.1.1

venv/bin/python - <<'PY'
import sys

import numpy as np
from asammdf import MDF, Signal

t_s = np.arange(10) / 10
speed = 10.0 + np.arange(10)
invalid = np.zeros(10, dtype=bool)
invalid[3:6] = True
speed[invalid] = 327.67
yaw_t_s = np.arange(0.5, 1.6, 0.25)
with MDF(version="4.10") as recording:
    recording.append([Signal(speed, t_s, name="speed", unit="m/s", invalidation_bits=invalid)])
    recording.append([Signal(np.zeros(5), yaw_t_s, name="yaw_rate", unit="rad/s")])
    recording.save("drive.mf4")

with MDF("drive.mf4") as recording:
    valid = recording.get("speed").samples.tolist()
    recording.cut(start=0.25, stop=0.85).save("scene.mf4")
    table = recording.to_dataframe()
with MDF("scene.mf4") as scene:
    first = scene.get("speed")
print("valid samples of the drive, m/s:", valid)
print("the scene from 0.25 s on: t =", first.timestamps.tolist(), "speed =", first.samples.tolist())
invented = first.timestamps[0] == 0.25 and abs(first.samples[0] - (12.0 + 327.67) / 2) < 1e-9 and max(valid) < 20
filled = table.loc[0.3, "speed"] == 13.0 and bool((table.loc[1.0:, "speed"] == 19.0).all()) and len(table.loc[1.0:]) == 3
print("table, speed of the invalid 0.3 s and behind the end at 0.9 s:", table.loc[0.3, "speed"], table.loc[1.0:, "speed"].tolist())
print(f"a speed that nobody recorded: {invented}; invalid and missing samples filled in the table: {filled}")
sys.exit(0 if invented and filled else 1)
PY
