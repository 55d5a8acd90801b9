#!/usr/bin/env bash
# av2 0.3.6 (Argoverse 2): the area of a lane from its centerline (`centerline_to_polygon`), and the two lines of a double marking (`get_double_polylines`), in the
# plane of the map (x east, y north) and in centimetres, 2 m apart, as the maps of the data set have the centerlines of their lanes.
#
# Expected: one side is left and the other right of the line, whatever its course; the area is that of a strip of 3.8 m, as the docstring says.
# Seen, without a word: the sides are found by the signs of dx and dy, and a step with dx = 0 or dy = 0 falls into neither case (`subtract_cond` and `neg_disp_cond` of
# polyline_utils.py).
#   1. To the east, north and south of the map "left" is right; 1 degree beside, and to the west, it is left.
#   2. Where a line comes out of such a course, its edges cross. A lane of 92 m that leads east and then turns north has 99 m^2 instead of 349 m^2; a lane 0.1 degrees
#      beside east has 137 m^2 instead of 380 m^2, as the centimetres make each step of it a plain or an oblique one. Of 40 bends of 500 m through east, 20 are crossed.
#   3. Of a car 1 m beside the middle of its lane, 33 % of the places on the lane 0.1 degrees beside east are in no lane.
# Why it matters: which lane a car is in, and how much of a box lies in a lane, are asked of such areas. The picture of a map (`rendering/map.py`) draws the solid and the
# dashed line of SOLID_DASH by these sides: who may cross it depends on the compass. Who tries one straight lane along an axis, or one oblique lane, finds a sound area;
# the tests of the package count its corners alone, also for a step with dy = 0.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile --no-deps av2==0.3.6 numpy==2.4.6 scipy==1.17.1 shapely==2.2.0 matplotlib==3.11.2 contourpy==1.3.3 cycler==0.12.1 \
  fonttools==4.68.0 kiwisolver==1.5.1 packaging==26.4 pillow==13.0.0 pyparsing==3.3.3 python-dateutil==4.0.0 universal-pathlib==0.3.10 fsspec==2026.9.0 \
  pathlib-abc==0.5.2

cat >seen.py <<'PY'
import sys

import numpy as np
import shapely
from av2.geometry.polyline_utils import centerline_to_polygon, get_double_polylines

WIDTH, STEP, BEGIN = 3.8, 2.0, np.array([1000.0, 2000.0])
same = True


def lane(curvature, length, course=0.0):
    """Points of a lane 2 m apart, exactly along an arc for each step, and the directions there; curvature(metres along the lane) in 1/m, course in degrees."""
    count = round(length / STEP) + 1
    turns = np.array([curvature((at + 0.5) * STEP) * STEP for at in range(count - 1)])
    heading = np.radians(course) + np.concatenate([[0.0], np.cumsum(turns)])
    middle = heading[:-1] + turns / 2
    steps = STEP * np.sinc(turns / 2 / np.pi)[:, None] * np.column_stack([np.cos(middle), np.sin(middle)])
    return BEGIN + np.concatenate([[[0.0, 0.0]], np.cumsum(steps, axis=0)]), heading


def beside(points, heading, metres):
    """The line so many metres to the left."""
    return points + metres * np.column_stack([-np.sin(heading), np.cos(heading)])


def inside(polygon, places):
    """Whether places are in a polygon: an odd number of its edges lies to the east of them."""
    (x0, y0), (x1, y1) = polygon[:-1].T, polygon[1:].T
    x, y = places[:, :1], places[:, 1:]
    with np.errstate(divide="ignore", invalid="ignore"):
        crossed = ((y0 > y) != (y1 > y)) & (x < x0 + (y - y0) * (x1 - x0) / (y1 - y0))
    return crossed.sum(axis=1) % 2 == 1


print("course: side of the line that is named left")
sides = {}
for course in (0, 1, 45, 89, 90, 91, 179, 180, 181, 269, 270, 271, 359):
    angle = np.radians(course)
    points = BEGIN + np.arange(11)[:, None] * STEP * np.round([np.cos(angle), np.sin(angle)], 12)
    left, right = get_double_polylines(points, 0.1)
    normal = np.array([-np.sin(angle), np.cos(angle)])
    offsets = (left - points) @ normal
    assert np.allclose(np.abs(offsets), WIDTH * 0.1 / 2) and np.allclose((right - points) @ normal, -offsets)
    sides[course] = "left" if (offsets > 0).all() else "right" if (offsets < 0).all() else "both"
print("  ", *(f"{course}: {side}," for course, side in sides.items()))
same &= [course for course, side in sides.items() if side != "left"] == [0, 90, 270] and set(sides.values()) == {"left", "right"}

straight, turn = 60.0, 20.0
lanes = {
    "oblique, 30 degrees": (lane(lambda _: 0.0, 100.0, 30.0), True),
    "0.1 degrees beside east": (lane(lambda _: 0.0, 100.0, 0.1), True),
    "0.1 degrees beside north": (lane(lambda _: 0.0, 100.0, 89.9), True),
    "60 m east, then a turn of 20 m": (lane(lambda along: 0.0 if along < straight else 1 / turn, 92.0), False),
}
print(f"{'lane':32} {'m^2':>6} {'right':>6}   crossed   car 1 m left of the middle, in the lane")
seen = {}
for name, ((points, heading), rounded) in lanes.items():
    recorded = np.round(points, 2) if rounded else points
    polygon = centerline_to_polygon(recorded)
    area = shapely.Polygon(polygon)
    edges = [beside(points, heading, side * WIDTH / 2) for side in (-1, 1)]
    right = shapely.Polygon(np.concatenate([edges[0], edges[1][::-1]]))
    fine = np.linspace(0, len(points) - 1, 20 * (len(points) - 1) + 1)[7:-7]
    car = np.column_stack([np.interp(fine, np.arange(len(points)), beside(points, heading, 1.0)[:, axis]) for axis in (0, 1)])
    assert right.is_valid and inside(np.array(right.exterior.coords), car).all()
    share = inside(polygon, car).mean()
    seen[name] = (round(area.area), round(right.area), area.is_valid, round(100 * share))
    print(f"{name:32} {area.area:6.0f} {right.area:6.0f}   {'no' if area.is_valid else 'yes':7}   {100 * share:.0f} %")
same &= seen == {
    "oblique, 30 degrees": (380, 380, True, 100),
    "0.1 degrees beside east": (137, 380, False, 67),
    "0.1 degrees beside north": (137, 380, False, 67),
    "60 m east, then a turn of 20 m": (99, 349, False, 99),
}
bends = [lane(lambda _: 1 / 500, 90.0, begin / 20)[0] for begin in range(-120, -80)]
crossed = sum(not shapely.Polygon(centerline_to_polygon(np.round(points, 2))).is_valid for points in bends)
print(f"bends of 500 m through east that begin at 6 to 4 degrees beside it: edges crossed in {crossed} of {len(bends)}")
same &= crossed == 20
sys.exit(0 if same else "changed: sides and areas of lanes by their course")
PY
venv/bin/python seen.py
