"""Evaluates STL formulas with rtamt: `python rtamt_script.py FILE.json RUNS`. Runs where rtamt is installed.

The file holds `signals` (name -> samples), `period_ms` and `formulas`. Only `evaluate` is timed: not the parsing of formulas.
"""

import json
import sys
import time
from pathlib import Path
from typing import Any

import rtamt  # type: ignore[import-not-found, import-untyped, unused-ignore]

job = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
n = len(next(iter(job["signals"].values())))
samples = {"time": [i * job["period_ms"] / 1000 for i in range(n)], **job["signals"]}
out = []


def spec_of(formula: str) -> Any:
    spec = rtamt.StlDiscreteTimeOfflineSpecification()
    for name in job["signals"]:
        spec.declare_var(name, "float")
    spec.declare_var("out", "float")
    spec.set_sampling_period(job["period_ms"], "ms", 0.1)
    spec.spec = f"out = {formula}"
    spec.parse()
    return spec


spans = []
for _ in range(int(sys.argv[2])):
    specs = [spec_of(formula) for formula in job["formulas"]]  # a specification keeps state
    begin, cpu = time.perf_counter(), time.process_time()
    out = [spec.evaluate(samples) for spec in specs]
    spans.append([time.perf_counter() - begin, time.process_time() - cpu])
print(json.dumps({"taken": spans, "robustness": [[value for _, value in each] for each in out]}))
