"""Reads an MCAP trace with omega-prime: `python omega_script.py TRACE RUNS`. Runs where omega-prime is installed."""

import json
import sys
import time
import warnings

import omega_prime  # type: ignore[import-not-found, import-untyped, unused-ignore]

warnings.simplefilter("ignore")  # that no map comes with the trace
spans = []
for _ in range(int(sys.argv[2])):
    begin, cpu = time.perf_counter(), time.process_time()
    recording = omega_prime.Recording.from_file(sys.argv[1])
    spans.append([time.perf_counter() - begin, time.process_time() - cpu])
states = recording.df
print(json.dumps({"taken": spans, "rows": states.height, "x": states["x"].sum(), "y": states["y"].sum()}))
