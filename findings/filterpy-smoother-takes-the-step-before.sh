#!/usr/bin/env bash
# filterpy 2.0.0, and bayesian-filters 1.4.5 that goes on from it: a track whose samples have unequal steps, filtered forwards and smoothed backwards
# (Rauch-Tung-Striebel), as recorded positions become positions and speeds.
#
# Expected: a smoother that is handed what the filter was handed (the list of models `Fs` and `Qs`, or the list of steps `dts`) uses each for the same step. Of a car
# that drives 20 m/s by its model and whose positions are exact, filter and smoother have 20 m/s everywhere.
# Seen, without a word: the filter has, and so has the smoother `KalmanFilter.rts_smoother`.
#   1. The functions `batch_filter` and `rts_smoother` of `filterpy.kalman`: with one gap of 2 s at 10 Hz the smoothed speeds go from -1.7 to 35.9 m/s, and the car is
#      24.9 m beside its place. The smoother takes the step that led to a sample for the step that leads away from it.
#   2. `UnscentedKalmanFilter.rts_smoother` with `dts`: 13.3 to 28.7 m/s and 24.9 m. With the list moved by one it is right.
#   3. Its argument `Qs` changes nothing: noise a million times as large gives the same smoothed track to the last bit.
# Why it matters: with equal steps all is right. Steps that vary between 0.05 and 0.15 s already move the car by a metre. A gap in a recording becomes an emergency brake to
# a standstill and a leap to nearly twice the speed, made by the step that was to remove noise. Its issue 37 named this in 2016, and the class was corrected.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile --no-deps filterpy==2.0.0 bayesian-filters==1.4.5 scipy==1.17.1 numpy==2.4.6

cat >seen.py <<'PY'
import importlib
import random
import sys

import numpy as np

SPEED, NOISE = 20.0, 0.25
FIRST, SPREAD = np.array([0.0, SPEED]), np.diag([NOISE, 1.0])
MEASURED, DOUBT = np.array([[1.0, 0.0]]), np.array([[NOISE]])
chance = random.Random(1)
STEPS = {
    "equal steps": [0.1] * 61,
    "0.05 to 0.15 s": [chance.uniform(0.05, 0.15) for _ in range(61)],
    "a gap of 2 s": [0.1] * 30 + [2.0] + [0.1] * 30,
}


def tracks(package, steps):
    """What filters and smoothers make of exact positions, each handed the same list for the way there and back."""
    kalman = importlib.import_module(f"{package}.kalman")
    noise = importlib.import_module(f"{package}.common").Q_discrete_white_noise
    places = SPEED * np.cumsum(steps)
    models, noises = [np.array([[1.0, step], [0.0, 1.0]]) for step in steps], [noise(2, step, 1.0) for step in steps]

    one = kalman.KalmanFilter(2, 1)
    one.x, one.P, one.H, one.R = FIRST.reshape(2, 1).copy(), SPREAD.copy(), MEASURED, DOUBT
    mean, spread, _, _ = one.batch_filter(places, Fs=models, Qs=noises)
    yield "class, filter", mean[:, :, 0]
    yield "class", one.rts_smoother(mean, spread, Fs=models, Qs=noises)[0][:, :, 0]

    count = len(steps)
    mean, spread, _, _ = kalman.batch_filter(FIRST.copy(), SPREAD.copy(), places, models, noises, [MEASURED] * count, [DOUBT] * count)
    yield "functions, filter", mean
    yield "functions", kalman.rts_smoother(mean, spread, models, noises)[0]

    def drive(state, step):
        return np.array([state[0] + step * state[1], state[1]])

    points = kalman.MerweScaledSigmaPoints(2, alpha=0.1, beta=2.0, kappa=1.0)
    unscented = kalman.UnscentedKalmanFilter(2, 1, 0.1, hx=lambda state: state[:1], fx=drive, points=points)
    unscented.x, unscented.P, unscented.R, unscented.Q = FIRST.copy(), SPREAD.copy(), DOUBT, noise(2, 0.1, 1.0)
    mean, spread = unscented.batch_filter(places, dts=steps)
    yield "unscented, filter", mean
    yield "unscented", unscented.rts_smoother(mean, spread, dts=steps)[0]
    yield "unscented, list moved", unscented.rts_smoother(mean, spread, dts=[*steps[1:], 0.1])[0]
    loud = unscented.rts_smoother(mean, spread, dts=steps, Qs=[1e6 * unscented.Q] * count)[0]
    yield "unscented, loud Qs", loud


same = True
RIGHT = (0.0, 20.0, 20.0)
GAP = {"functions": (24.9, -1.7, 35.9), "unscented": (24.9, 13.3, 28.7), "unscented, loud Qs": (24.9, 13.3, 28.7)}
for package in ("filterpy", "bayesian_filters"):
    for name, steps in STEPS.items():
        seen, whole = {}, {}
        for title, track in tracks(package, steps):
            away = np.abs(track[:, 0] - SPEED * np.cumsum(steps)).max()
            seen[title] = tuple(round(float(number), 1) + 0.0 for number in (away, track[:, 1].min(), track[:, 1].max()))
            whole[title] = track
        print(f"{package}, {name}")
        for title, (away, least, most) in seen.items():
            print(f"  {title:22} {away:5.1f} m off, {least:5.1f} to {most:4.1f} m/s")
        same &= bool(np.array_equal(whole["unscented"], whole["unscented, loud Qs"]))
        for title, numbers in seen.items():
            if name == "0.05 to 0.15 s" and title in GAP:
                same &= numbers[0] > 0.5
            else:
                same &= numbers == (GAP.get(title, RIGHT) if name == "a gap of 2 s" else RIGHT)
sys.exit(0 if same else "changed: what the smoothers make of unequal steps")
PY
venv/bin/python seen.py
