#!/usr/bin/env bash
# nuscenes-devkit 1.2.0: `project_pose_to_lane` of its map expansion, which gives the pose on a lane that is nearest to a car and how far along the lane it is, on a
# lane of several arcline paths, as `get_arcline_path` gives them.
#
# Expected: the distance is that of the closest pose, at most half of `resolution_meters` off, and at the end of the lane it is `length_of_lane`.
# Seen: the pose is right, the distance too long by up to two steps of the resolution for each path: it is the number of points until there times the resolution, but
# each path has a first and a last point of its own, and its points lie nearer to each other than that. At the end of a lane of 83.05 m in ten paths the
# distance is 90 m with the default of 0.5 m, 98 m with 1 m, 114 m with 2 m. On a lane of the same length in one path it is right.
# Why it matters: bends and connectors have many short paths. Over this one, cars 30 m apart are 34.5 m apart, and one that drives 10 m/s has 11.5 m/s.
# `get_curvature_at_distance_along_lane` says "straight" at this distance while the car is in the bend. Whoever checks it on a lane of one path finds it right.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3.11 -m venv --without-pip venv 2>/dev/null || python3 -m venv --without-pip venv
# The module of the lanes needs numpy alone; it is loaded without the rest of the package (pictures, evaluation), which has no part in it.
python3 -m pip --python venv install -q --no-compile --no-deps nuscenes-devkit==1.2.0 numpy==1.26.4

cat >seen.py <<'PY'
import math
import runpy
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy

(module,) = Path(sys.prefix).rglob("nuscenes/map_expansion/arcline_path_utils.py")
lanes = SimpleNamespace(**runpy.run_path(str(module)))
RADIUS = 12.0
# A street, a left turn of 90 degrees with 12 m, a street: straight paths are (0, length, 0), arcs (length, 0, 0), of the shape "LSL".
STREET, TURN, AFTER = [20.4, 6.1, 8.2], [2.9, 3.3, 2.6, 3.7, 6.35], [12.3, 17.2]


def lane(pieces):
    pose, paths = (100.0, 200.0, 0.3), []
    for lengths in pieces:
        path = {"start_pose": pose, "shape": "LSL", "radius": RADIUS, "segment_length": lengths}
        pose = lanes.pose_at_length(path, sum(lengths))
        paths.append(path | {"end_pose": pose})
    return paths


def at(paths, distance):
    for path in paths:
        length = sum(path["segment_length"])
        if distance <= length:
            return lanes.pose_at_length(path, max(distance, 1e-6))
        distance -= length
    return paths[-1]["end_pose"]


def straight(lengths):
    return [[0.0, length, 0.0] for length in lengths]


many = lane(straight(STREET) + [[length, 0.0, 0.0] for length in TURN] + straight(AFTER))
one = lane([[sum(STREET) / 2, 0.0, sum(STREET) + sum(TURN) + sum(AFTER) - sum(STREET) / 2]])
total = lanes.length_of_lane(many)
assert abs(total - lanes.length_of_lane(one)) < 1e-9


def projected(paths, distance, resolution=0.5):
    pose = at(paths, distance)
    closest, along = lanes.project_pose_to_lane(pose, paths, resolution)
    return float(along), math.dist(pose[:2], closest[:2])


print(f"lane of {len(many)} paths, {total:.2f} m")
ends = {}
for resolution in (0.1, 0.5, 1.0, 2.0):
    ends[resolution] = [projected(paths, total, resolution)[0] for paths in (many, one)]
    print(f"at its end, resolution {resolution} m: {ends[resolution][0]:.2f} m; in one path of this length: {ends[resolution][1]:.2f} m")
off = max(projected(many, step)[1] for step in numpy.arange(0.05, total, 0.1))
print(f"closest pose: at most {off:.2f} m from the car")
first, second = projected(many, 30.0)[0], projected(many, 60.0)[0]
speed = 10.0 * (second - first) / 30.0
print(f"from 30 m to 60 m along the lane: {second - first:.1f} m; a car that takes 3 s for it has {speed:.1f} m/s, not 10")
bend = sum(STREET) + 16.0
curvature = [lanes.get_curvature_at_distance_along_lane(distance, many) for distance in (bend, projected(many, bend)[0])]
print(f"curvature {bend:.1f} m along the lane: {curvature[0]:.4f}, at the distance of the projected pose: {curvature[1]:.4f}")
too_long = all(resolution < ends[resolution][0] - total and abs(ends[resolution][1] - total) <= resolution for resolution in (0.1, 0.5, 1.0, 2.0))
faster = ends[0.5][0] - total > 6 and speed > 11 and off <= 0.26 and curvature[0] > 0.08 and curvature[1] == 0
sys.exit(0 if too_long and faster else "changed: the distance along the lane")
PY
venv/bin/python seen.py
