#!/usr/bin/env bash
# rtamt 0.4.10, monitors of signal temporal logic in dense time (each sample has its own time): the width of the window of a timed operator.
#
# Expected: `[0:800ms]`, `[0:0.8s]` and `[0:0.8]` are one window, as in rtamt's discrete time. A monitor that is fed as the messages arrive says what it says if
# it gets them five at a time, or all at the end.
# Seen, without a word:
#   1. Units are converted by the inverse factor: with times in seconds `[0:800ms]` is 800 000 s, with times in milliseconds (`unit = 'ms'`) `[0:2s]` is 2 microseconds.
#   2. `update` with one sample per call, as a stream has them, has no window at all: `once[0:3]` and `historically[0:3]` are of the sample in hand. With five samples
#      per call, and by `evaluate`, they are right.
# Why it matters: a brake 5 s after the emergency is within 800 ms, one after 1 s is not within 2 s. Live, whoever indicated a second before a change of lane has not
# indicated, and a road that was free for one sample was free for 3 s. A formula that was tried in discrete time, or on a log, is another one in dense time and live.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3.11 -m venv --without-pip venv 2>/dev/null || python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile rtamt==0.4.10

cat >seen.py <<'PY'
import sys

import rtamt

END_S, STEP_S = 20.0, 0.1


def declared(specification, formula, names):
    for name in names:
        specification.declare_var(name, "float")
    specification.spec = formula
    specification.parse()
    return specification


def first(rows):
    return rows[0][1]


def dense(formula, unit, brake_s):
    """Robustness at the begin: the emergency is at 0 s, the brake at `brake_s`; times are in `unit`."""
    per_second = {"s": 1.0, "ms": 1000.0}[unit]
    specification = rtamt.StlDenseTimeSpecification()
    specification.unit = unit
    declared(specification, formula, ["brake"])
    return first(specification.evaluate(["brake", [[0.0, -1.0], [brake_s * per_second, 1.0], [END_S * per_second, 1.0]]]))


def discrete(formula, unit, brake_s):
    specification = rtamt.StlDiscreteTimeSpecification()
    specification.unit = unit
    specification.set_sampling_period(100, "ms", 0.1)
    declared(specification, formula, ["brake"])
    steps = range(round(END_S / STEP_S) + 1)
    per_step = {"s": STEP_S, "ms": 100.0}[unit]
    return first(specification.evaluate({"time": [k * per_step for k in steps], "brake": [1.0 if k * STEP_S >= brake_s else -1.0 for k in steps]}))


windows = {}
for unit, brake_s, bounds in (("s", 5.0, ("[0:0.8]", "[0:0.8s]", "[0:800ms]")), ("ms", 1.0, ("[0:2000]", "[0:2000ms]", "[0:2s]"))):
    for bound in bounds:
        formula = f"eventually{bound}(brake > 0)"
        windows[bound] = discrete(formula, unit, brake_s), dense(formula, unit, brake_s)
        kept = ["kept" if value > 0 else "broken" for value in windows[bound]]
        print(f"1. times in {unit}, brake after {brake_s} s, {formula}: {kept[0]} in discrete time, {kept[1]} in dense time")


def live(formula, signals, per_call):
    """Time to robustness, as `update` gives it for calls of so many samples."""
    specification = declared(rtamt.StlDenseTimeSpecification(), formula, signals)
    specification.pastify()
    seen = {}
    for begin in range(0, int(END_S), per_call):
        batch = [[name, [[float(t), values[t]] for t in range(begin, begin + per_call)]] for name, values in signals.items()]
        seen.update((time, value) for time, value in specification.update(*batch))
    return seen


def at(seen, time):
    """The value that holds at a time: the last one given until then."""
    return seen[max(known for known in seen if known <= time)]


# At 1 Hz: the indicator is on at 6 s and 7 s, the change of lane at 8 s. The road is free from 15 s on, and the car starts at once.
seconds = range(int(END_S))
indicator = {"indicator": [1.0 if t in (6, 7) else -1.0 for t in seconds], "change": [1.0 if t == 8 else -1.0 for t in seconds]}
free = {"free": [1.0 if t >= 15 else -1.0 for t in seconds], "start": [1.0 if t == 15 else -1.0 for t in seconds]}
answers = {}
for title, formula, signals, time in (
    ("indicated within 3 s before", "(change > 0) implies once[0:3](indicator > 0)", indicator, 8.0),
    ("free for 3 s before", "(start > 0) implies historically[0:3](free > 0)", free, 15.0),
):
    for per_call in (1, 5, int(END_S)):
        answers[title, per_call] = at(live(formula, signals, per_call), time)
        print(f"2. {title}, {formula} at {time} s, {per_call} samples per call: {answers[title, per_call]:+.0f}")
    whole = declared(rtamt.StlDenseTimeSpecification(), formula, signals)
    answers[title, "log"] = at(dict(whole.evaluate(*[[name, [[float(t), v] for t, v in enumerate(values)]] for name, values in signals.items()])), time)
    print(f"2. {title}, the whole log by evaluate: {answers[title, 'log']:+.0f}")

units = windows == {
    "[0:0.8]": (-1, -1), "[0:0.8s]": (-1, -1), "[0:800ms]": (-1, 1),
    "[0:2000]": (1, 1), "[0:2000ms]": (1, 1), "[0:2s]": (1, -1),
}  # fmt: skip
streams = [answers["indicated within 3 s before", n] for n in (1, 5, 20, "log")] == [-1, 1, 1, 1]
streams &= [answers["free for 3 s before", n] for n in (1, 5, 20, "log")] == [1, -1, -1, -1]
sys.exit(0 if units and streams else "changed: the windows of dense time")
PY
venv/bin/python seen.py
