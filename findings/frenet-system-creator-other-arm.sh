#!/usr/bin/env bash
# frenet-system-creator 0.3.0: a car on a road with two hairpin bends, in the coordinates of the road: `cartesian2ds_frame` gives d (to the left) and s (along it).
#
# Expected: a car that drives along the reference path at 20 m/s has d = 0 everywhere and an s that grows by 20 m in each second. On a straight road, in one bend or in one
# hairpin it has, to a tenth of a millimetre.
# Seen, without a word: on a path of 394 m with a hairpin to the left and one to the right, of 15 m radius and 100 m apart, the car that begins to drive is 245 m along
# the road and 29.9 m to the left, and goes backwards at 20 m/s for its first 60 m. Then s jumps by 143 m to the right place. For its last 40 m it is on the middle arm
# again, backwards and 29.9 m to the right. The nearest point is sought by one descent over the whole path (scipy's `minimize_scalar`, "bounded"), which can end at the
# next best place, here on the middle arm. `ds_frame2cartesian` brings the car back to within 4 mm, so a test of there and back passes.
# Why it matters: a rule sees a car that drives 20 m/s against its lane, 30 m beside the road, and changes its place by 163 m in a second. Of two cars, one 20 m behind the
# other, the one behind is ahead. A straight, a bend or one hairpin, as in a test, is right to a tenth of a millimetre.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile --no-deps frenet-system-creator==0.3.0 numpy==2.2.6 scipy==1.16.3

cat >seen.py <<'PY'
import math
import sys

from frenet_system_creator import FrenetSystem

ARM, RADIUS, SPEED = 100, 15, 20


def road(*turns):
    """Points of a road, a metre from each other: arms of 100 m, with half circles to the left (1) or to the right (-1) between them."""
    x = y = course = 0.0
    points = [(x, y)]
    steps = round(math.pi * RADIUS)
    for turn in (*turns, None):
        bends = [0.0] * ARM + ([turn * math.pi / steps] * steps if turn else [])
        for bend in bends:
            course += bend / 2
            x, y = x + math.cos(course), y + math.sin(course)
            course += bend / 2
            points.append((x, y))
    return points


def drive(points, offset=0.0):
    """(s, d) of the truth and of the library in each second of a drive at 20 m/s, and how far from its place it is after there and back."""
    system = FrenetSystem(points)
    rows = []
    for second, index in enumerate(range(2, len(points) - 2, SPEED)):
        (x0, y0), (x1, y1) = points[index - 1], points[index + 1]
        course = math.atan2(y1 - y0, x1 - x0)
        car = points[index][0] - offset * math.sin(course), points[index][1] + offset * math.cos(course)
        (d, s), _ = system.cartesian2ds_frame(car)
        back = system.ds_frame2cartesian((d, s))
        rows.append((second, float(index), float(s), float(d), math.dist(car, back)))
    return rows


same = True
for title, turns in (("straight", ()), ("one hairpin", (1,)), ("two hairpins", (1, -1))):
    points = road(*turns)
    rows = drive(points)
    lost = [second for second, truth, s, *_ in rows if abs(s - truth) > 1]
    print(f"{title}, {len(points) - 1} m: wrong in {len(lost)} of {len(rows)} seconds, at most {max(abs(s - truth) for _, truth, s, *_ in rows):.4f} m along the road", end="")
    print(f"; there and back within {max(row[-1] for row in rows):.4f} m")
    same &= bool(lost) == (title == "two hairpins") and max(row[-1] for row in rows) < 0.004

before = None
for second, truth, s, d, _ in rows:
    speed = "" if before is None else f", speed {s - before:7.2f} m/s instead of {SPEED}"
    print(f"  {second:2} s: s {s:6.2f} m instead of {truth:3.0f}, d {d:6.2f} m instead of 0{speed}")
    before = s
first, last = rows[:3], rows[-2:]
same &= all(abs(abs(d) - 2 * RADIUS) < 0.2 and abs(s - truth) > 100 for _, truth, s, d, _ in first + last)
same &= all(abs(later[2] - row[2] + SPEED) < 0.1 for part in (first, last) for row, later in zip(part, part[1:]))
same &= all(abs(s - truth) < 0.01 and abs(d) < 0.01 for _, truth, s, d, _ in rows[3:-2])
for offset in (1.0, -1.0):
    _, truth, s, d, _ = drive(points, offset)[0]
    print(f"a car {abs(offset)} m to the {'left' if offset > 0 else 'right'} at {truth:.0f} m: s {s:.2f} m, d {d:.2f} m")
    same &= abs(d - (2 * RADIUS - offset)) < 0.2
sys.exit(0 if same else "changed: the place of a car on a road with two hairpins")
PY
venv/bin/python -W ignore seen.py
