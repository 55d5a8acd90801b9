#!/usr/bin/env bash
# PyMEOS 1.3.0 (MobilityDB's types for moving objects, with the library MEOS in its wheel): the distance of a car to a place beside its road, and to an oncoming car.
#
# Expected: `car.distance(place)` is small while the car passes the place. It agrees with `nearest_approach_distance` and `within_distance`, and does not depend on how often
# the drive was sampled.
# Seen, without a word:
#   1. A car that passes a sign at 3.5 m, at steady 20 m/s from 100 m before it to 100 m behind it, has a distance of 100.06 m all the time, the least included. The
#      nearest approach is missing among the instants of the distance. So it is with heights, and with longitude and latitude.
#   2. Whether the drive has 2 samples or 101 does not matter: samples on a straight line at steady speed are dropped as the sequence is made. With a sway of 1 cm they are
#      kept, and the least distance is 3.5 m.
#   3. A place on the line itself, and a car that stands for the whole drive in the place of the sign, are met: 0 m and 3.5 m. Between its instants the distance is a straight
#      line there: 22.8 m instead of 20.3 m at 20 m before, and below 10 m for 0.67 s, where `within_distance` has 0.94 s.
# Why it matters: "never within 10 m of the crossing, the stop line, the pedestrian who stands" is true of each steady drive by, and false of one that sways or brakes. The
# better the log is smoothed, the farther are the signs.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile --no-deps pymeos==1.3.0 pymeos-cffi==1.3.0 cffi==2.1.1 pycparser==3.12 python-dateutil==4.0.0 shapely==2.2.0 numpy==2.4.6

cat >seen.py <<'PY'
import sys
from datetime import UTC, datetime, timedelta

from pymeos import FloatSpan, TGeogPointSeq, TGeomPointSeq, pymeos_initialize
from shapely import Point

pymeos_initialize()
BEGIN = datetime(2026, 11, 1, tzinfo=UTC)
WAY, SECONDS = 200.0, 10.0  # from 100 m before the sign to 100 m behind it


def drive(samples, sway=0.0, height=""):
    """A sequence of points along x with as many steps of equal length, every second point `sway` to the left."""
    parts = []
    for number in range(samples + 1):
        time = BEGIN + timedelta(seconds=number * SECONDS / samples)
        place = f"{-WAY / 2 + number * WAY / samples} {sway * (number % 2)}{height}"
        parts.append(f"POINT{' Z' if height else ''}({place})@{time.isoformat(sep=' ')}")
    return TGeomPointSeq(f"[{', '.join(parts)}]")


def numbers(car, place):
    """The least distance that the sequence of distances has, the nearest approach, and for how many seconds the car is within 10 m by either."""
    distance = car.distance(place)
    near = distance.at(FloatSpan(lower=0.0, upper=10.0, lower_inc=True, upper_inc=True))
    within = car.within_distance(place, 10.0).at(True)
    seconds = [0.0 if part is None else part.duration().total_seconds() for part in (near, within)]
    return [round(number, 2) + 0.0 for number in (distance.min_value(), car.nearest_approach_distance(place), *seconds)]


SIGN = Point(0.0, 3.5)
steady, often, sways = drive(1), drive(100), drive(100, sway=0.01)
standing = TGeomPointSeq(f"[POINT(0 3.5)@{BEGIN.isoformat(sep=' ')}, POINT(0 3.5)@{(BEGIN + timedelta(seconds=SECONDS)).isoformat(sep=' ')}]")
seen = {
    "sign, 2 samples": numbers(steady, SIGN),
    "sign, 101 samples": numbers(often, SIGN),
    "sign, 101 samples that sway by 1 cm": numbers(sways, SIGN),
    "place on the line": numbers(steady, Point(0.0, 0.0)),
    "car that stands in the place of the sign": numbers(steady, standing),
}
for title, (least, approach, near, within) in seen.items():
    print(f"{title:42} least distance {least:6.2f} m, nearest approach {approach:5.2f} m; within 10 m for {near:.2f} s by distance, {within:.2f} s by within_distance")
print("samples that are left of 2, 101, 101 with sway:", steady.num_instants(), often.num_instants(), sways.num_instants())
before = steady.distance(standing).value_at_timestamp(BEGIN + timedelta(seconds=4))
print(f"car that stands, 20 m before: {before:.2f} m, by Pythagoras {(20**2 + 3.5**2) ** 0.5:.2f} m")
high = drive(1, height=" 0").distance(Point(0.0, 3.5, 0.0)).min_value()
times = [(BEGIN + timedelta(seconds=second)).isoformat(sep=" ") for second in (0, 10)]
globe = TGeogPointSeq(f"[POINT(8.4 49)@{times[0]}, POINT(8.41 49)@{times[1]}]")
far, near = globe.distance(Point(8.405, 49.0001)).min_value(), globe.nearest_approach_distance(Point(8.405, 49.0001))
print(f"with heights {high:.2f} m; with longitude and latitude {far:.1f} m, nearest approach {near:.1f} m")

same = seen["sign, 2 samples"] == seen["sign, 101 samples"] == [100.06, 3.5, 0.0, 0.94]
same &= seen["sign, 101 samples that sway by 1 cm"][:2] == [3.5, 3.5] and abs(seen["sign, 101 samples that sway by 1 cm"][2] - 0.94) < 0.03
same &= seen["place on the line"][:2] == [0.0, 0.0] and seen["car that stands in the place of the sign"] == [3.5, 3.5, 0.67, 0.94]
same &= (steady.num_instants(), often.num_instants(), sways.num_instants()) == (2, 2, 101) and round(before, 1) == 22.8
same &= round(high, 2) == 100.06 and far > 300 and near < 12
sys.exit(0 if same else "changed: distances of a car that passes a place")
PY
venv/bin/python seen.py
