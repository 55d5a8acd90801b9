#!/usr/bin/env bash
# omega-prime 0.3.7 with polars 1.44.2: time to collision (its metric `ttc_and_thw`, "TTC and THW between ego_id and all other objects").
#
# Expected: an ego that brakes from 20 m/s to a stop 2 m behind a car that stands has a time to collision in each step before, at least 0.71 s.
# Seen: it has no row at all, with any `time_buffer`. There is a row only for a step in which the other one is, within 2 s, where the ego is: one that
# stands never is there before the collision, and one at 8 m/s not in the first 6 of 8.5 s in which the ego approaches it. An ego that follows at 1 m/s more
# than the speed of the one ahead has 9 s of values. These are of distances between centres, not bumpers: 1.32 s instead of 0.71 s behind the one at 8 m/s.
# Why it matters: a count of short times to collision holds the steady following, and none of the approaches to the end of a queue, which end in
# rear-end collisions. A missing row is neither null nor an error: the recording seems to be harmless.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3.11 -m venv --without-pip venv 2>/dev/null || python3 -m venv --without-pip venv
# Only what recordings and metrics need; maps, pictures, files and the command line are left out. With all of it the values are the same.
python3 -m pip --python venv install -q --no-compile --no-deps omega-prime==0.3.7 betterosi==0.9.0 polars==1.44.2 polars-runtime-32==1.44.2 \
  polars-st==0.11.0 numpy==2.4.6 shapely==2.2.0 protobuf-py==0.6.0 protobuf-py-ext==0.6.0 pyproj==3.7.2 certifi==2026.10.19.post1 strenum==0.5.0 \
  typing-extensions==4.16.0

cat >seen.py <<'PY'
import importlib.machinery
import math
import sys
from types import ModuleType

LEFT_OUT = set(
    "altair filelock joblib loguru lxd_io lxml matplotlib mcap mcap_protobuf networkx pandas pandera pyarrow pyogrio pyxodr_omega_prime scipy tqdm typer".split()
)


class Word(type):
    def __getattr__(cls, word):
        if word.startswith("__"):
            raise AttributeError(word)
        return Word(word, (), {})

    def __call__(cls, *_, **__):
        return Word("word", (), {})

    def __or__(cls, _):
        return cls


class Empty(ModuleType):
    __getattr__ = Word.__getattr__


class Finder:
    def find_spec(self, name, path=None, target=None):
        return importlib.machinery.ModuleSpec(name, self, is_package=True) if name.split(".")[0] in LEFT_OUT else None

    def create_module(self, spec):
        return Empty(spec.name)

    def exec_module(self, module):
        pass


sys.meta_path.insert(0, Finder())
import numpy as np
import omega_prime
import polars as pl
from omega_prime.metrics import MetricManager, curvilinear_projection, distance_traveled, timegaps_and_min_timegaps, ttc_and_thw, vel

LENGTH_M, EGO_M_S, BRAKING_M_S2 = 5.0, 20.0, 8.0
T = np.arange(0, 10.001, 0.1)


def car(number, x, speed):
    still = np.zeros_like(T)
    columns = {name: still for name in ("y", "z", "vel_y", "vel_z", "acc_x", "acc_y", "acc_z", "roll", "pitch", "yaw")}
    sizes = {"length": still + LENGTH_M, "width": still + 2.0, "height": still + 1.5}
    kind = {
        "type": omega_prime.MovingObjectType.VEHICLE,
        "role": omega_prime.MovingObjectRole.CIVIL,
        "subtype": omega_prime.MovingObjectSubtype.CAR,
    }
    ids = {name: np.full(len(T), int(value)) for name, value in (kind | {"idx": number}).items()}
    return pl.DataFrame({"total_nanos": np.round(T * 1e9).astype(np.int64), "x": x, "vel_x": speed} | columns | sizes | ids)


def approach(other_m_s):
    """The ego at 20 m/s brakes at the last moment, to the speed of the other one and 2 m behind it."""
    other = 100.0 + other_m_s * T
    closing = EGO_M_S - other_m_s
    begin = (100.0 - LENGTH_M - 2.0 - closing**2 / 2 / BRAKING_M_S2) / closing
    braking = np.clip(T - begin, 0, closing / BRAKING_M_S2)
    speed = EGO_M_S - BRAKING_M_S2 * braking
    gap = np.where(T < begin, 95.0 - closing * T, 2.0 + (speed - other_m_s) ** 2 / 2 / BRAKING_M_S2)
    return other - LENGTH_M - gap, speed, other, np.full(len(T), float(other_m_s))


def behind():
    """At 20 m/s behind one of 19 m/s, 30 m from centre to centre."""
    return EGO_M_S * T, np.full(len(T), EGO_M_S), 30.0 + 19.0 * T, np.full(len(T), 19.0)


def seen(ego_x, ego_speed, x, speed, **options):
    """Steps with a time to collision, and the least of them: by bumpers and by omega-prime."""
    gap, closing = x - ego_x - LENGTH_M, ego_speed - speed
    right = gap[closing > 1e-6] / closing[closing > 1e-6]
    manager = MetricManager([vel, distance_traveled, curvilinear_projection, timegaps_and_min_timegaps, ttc_and_thw])
    recording = omega_prime.Recording(df=pl.concat([car(0, ego_x, ego_speed), car(1, x, speed)]))
    table = manager.compute(recording, ego_id=0, **options)[1]["ttc_and_thw"]
    found = table.filter(pl.col("TTC") < 1e6)["TTC"]  # two equal speeds close in in 1e15 s, by their last bits
    assert gap.min() > 1.99
    return len(right), right.min(), found.len(), found.min() if found.len() else math.inf, table.height


ways = {
    "a car that stands": (approach(0), {}),
    "a car that stands, time_buffer of 8 s": (approach(0), {"time_buffer": 8e9}),
    "a car of 8 m/s": (approach(8), {}),
    "steadily behind one of 19 m/s": (behind(), {}),
}
rows = {}
for title, (way, options) in ways.items():
    rows[title] = seen(*way, **options)
    n, least, found, of_these, height = rows[title]
    print(f"{title}: {n} steps with a time to collision, least {least:.2f} s; by omega-prime {found} steps ({height} rows), least {of_these:.2f} s")
standing, long, slow, steady = rows.values()
none_of_standing = standing[4] == long[4] == 0 and standing[0] > 50 and 0.7 < standing[1] < 0.75
some_of_slow = slow[2] < slow[0] / 2 and 0.7 < slow[1] < 0.75 and 1.3 < slow[3] < 1.35
sys.exit(0 if none_of_standing and some_of_slow and steady[2] > 80 else "changed: which steps have a time to collision")
PY
venv/bin/python seen.py
