#!/usr/bin/env bash
# MDF 4.10 file of asammdf 8.8.28 read by asammdf 8.8.28, mdfreader 4.3, mdfr 0.7.3 and mf4-rs 3.7.0: samples with the invalidation bit set.
#
# Expected: each reader leaves such samples out, or says for each that it is not valid.
# Seen: asammdf leaves them out, so the signal is shorter than its time; mf4-rs gives NaN; mdfreader and mdfr give what stood in the
# record, 327.67 m/s, as a number like all others. None of them warns.
# Why it matters: "not available" of a CAN signal is a large number. Through two of four readers the same drive breaks every speed limit.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile asammdf==8.8.28 mf4-rs==3.7.0 numpy==2.4.6 pandas==3.1.1
# Without polars, matplotlib and sympy, which are for their exports and formulas.
python3 -m pip --python venv install -q --no-compile --no-deps mdfreader==4.3 mdfr==0.7.3

venv/bin/python - <<'PY'
import sys

import mdfr
import mdfreader
import mf4_rs
import numpy as np
from asammdf import MDF, Signal

speed = 10.0 + np.arange(10)
invalid = np.zeros(10, dtype=bool)
invalid[3:6] = True
speed[invalid] = 327.67
with MDF(version="4.10") as recording:
    recording.append([Signal(speed, np.arange(10) / 10, name="speed", unit="m/s", invalidation_bits=invalid)])
    recording.save("drive.mf4")

with MDF("drive.mf4") as recording:
    by_asammdf = np.asarray(recording.get("speed").samples)
by_mdfreader = np.asarray(mdfreader.Mdf("drive.mf4").get_channel_data("speed"))
other = mdfr.Mdfr("drive.mf4")
other.load_all_channels_data_in_memory()
by_mdfr = np.asarray(other.get_channel_data("speed"))
by_mf4_rs = np.asarray(mf4_rs.Mdf("drive.mf4").values("speed"))
for name, values in (("asammdf", by_asammdf), ("mdfreader", by_mdfreader), ("mdfr", by_mdfr), ("mf4-rs", by_mf4_rs)):
    print(f"{name:10}", values.tolist())
left_out = len(by_asammdf) == 7
as_numbers = by_mdfreader[3] == by_mdfr[3] == 327.67
as_nan = bool(np.isnan(by_mf4_rs[3:6]).all()) and not np.isnan(by_mf4_rs[:3]).any()
print(f"left out by asammdf: {left_out}; numbers by mdfreader and mdfr: {as_numbers}; NaN by mf4-rs: {as_nan}")
sys.exit(0 if left_out and as_numbers and as_nan else 1)
PY
