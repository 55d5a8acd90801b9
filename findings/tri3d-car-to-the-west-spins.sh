#!/usr/bin/env bash
# tri3d 0.2.2 (one interface for nuScenes, Argoverse 2, Waymo, ZOD and others): `boxes(sequence, frame, sensor)` between two key frames of a nuScenes log. Its guide
# says that it interpolates the boxes to the time of the sensor.
#
# Expected: an oncoming car whose course goes from 179 to 181 degrees has 180 degrees half way, as `Quaternion.slerp` of pyquaternion has it, by which nuscenes-devkit
# does this.
# Seen: half way it has 0 degrees, and a quarter of the way it stands across the road: it turns by 358 degrees the other way round. The centre is right, and so is each
# key frame. A quaternion and its negative are one rotation, and tri3d takes the way between the two as they are: the sign changes at 180 degrees, and it may change
# anywhere, as in a parked car at 30 degrees. In the axes of a camera, `heading` is by its convention at the very microsecond of a key frame, and else 0, 90 or 180.
# Why it matters: nuScenes has key frames at 2 Hz and lidar at 20 Hz, so nine of ten frames are interpolated. Whoever drives west sweeps a lane on each side, has a
# yaw rate of 12.5 rad/s and collides with those beside; to the east, north and south all is right.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3.11 -m venv --without-pip venv 2>/dev/null || python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile --no-deps tri3d==0.2.2 numba==0.68.1 llvmlite==0.50.0 numpy==2.3.5 pyarrow==26.0.1 pillow==13.0.0 pyquaternion==0.9.9

cat >seen.py <<'PY'
import json
import math
import sys
from pathlib import Path

from pyquaternion import Quaternion
from tri3d.datasets import NuScenes

FRAMES, STEP_US, BEGIN_US = 10, 50_000, 1_500_000_000_000_000
LENGTH, WIDTH = 4.6, 1.9
# A car's course at the two key frames in degrees, and the sign of its quaternions there.
CARS = {
    "to the west": ((179.0, 1), (-179.0, 1)),
    "to the north": ((89.0, 1), (91.0, 1)),
    "parked": ((30.0, 1), (30.5, -1)),
}
NAMES = ("attribute", "calibrated_sensor", "category", "ego_pose", "instance", "sample", "sample_annotation", "sample_data", "scene", "sensor", "visibility")


def rotation(degrees, sign=1):
    return [sign * math.cos(math.radians(degrees) / 2), 0.0, 0.0, sign * math.sin(math.radians(degrees) / 2)]


def write(folder):
    """A log of 0.5 s: the ego stands and looks to the east; lidar and camera have the axes of nuScenes."""
    tables = {name: [] for name in NAMES}
    tables["category"].append({"token": "car", "name": "vehicle.car"})
    tables["scene"].append({"token": "scene", "first_sample_token": "key0"})
    for number, following in ((0, "key1"), (1, "")):
        tables["sample"].append({"token": f"key{number}", "timestamp": BEGIN_US + number * FRAMES * STEP_US, "next": following, "scene_token": "scene"})
    sensors = (("LIDAR_TOP", "lidar", rotation(-90.0)), ("CAM_FRONT", "camera", [0.5, -0.5, 0.5, -0.5]))
    for channel, modality, axes in sensors:
        tables["sensor"].append({"token": channel, "channel": channel, "modality": modality})
        lens = [[1000.0, 0.0, 800.0], [0.0, 1000.0, 450.0], [0.0, 0.0, 1.0]]
        mounting = {"translation": [0.0, 0.0, 0.0], "rotation": axes, "camera_intrinsic": lens}
        tables["calibrated_sensor"].append({"token": channel, "sensor_token": channel} | mounting)
    for frame in range(FRAMES + 1):
        time = {"timestamp": BEGIN_US + frame * STEP_US}
        tables["ego_pose"].append({"token": f"pose{frame}", "translation": [0.0, 0.0, 0.0], "rotation": [1.0, 0.0, 0.0, 0.0]} | time)
        for channel, *_ in sensors:
            row = {"token": f"{channel}{frame}", "sample_token": f"key{frame // FRAMES}", "ego_pose_token": f"pose{frame}", "calibrated_sensor_token": channel}
            tables["sample_data"].append(row | time | {"is_key_frame": frame % FRAMES == 0, "filename": f"{channel}{frame}"})
    for name, courses in CARS.items():
        tables["instance"].append({"token": name, "category_token": "car"})
        for number, (degrees, sign) in enumerate(courses):
            row = {"sample_token": f"key{number}", "instance_token": name, "attribute_tokens": [], "num_lidar_pts": 9, "num_radar_pts": 0}
            box = {"translation": [30.0 - 5.0 * number, 3.0, 0.0], "size": [WIDTH, LENGTH, 1.5], "rotation": rotation(degrees, sign)}
            tables["sample_annotation"].append(row | box)
    for name, rows in tables.items():
        (folder / f"{name}.json").write_text(json.dumps(rows))


def course(degrees):
    return round(degrees % 360, 1) % 360


def course_of(transform):
    """The direction of the box's own x axis: what is drawn, and what overlaps."""
    begin, front = transform.apply([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
    return course(math.degrees(math.atan2(front[1] - begin[1], front[0] - begin[0])))


folder = Path("log/v1.0-mini")
folder.mkdir(parents=True)
write(folder)
log = NuScenes("log", "v1.0-mini")
lidar = {name: [] for name in CARS}
camera = {name: [] for name in CARS}
for frame in range(FRAMES + 1):
    for box in log.boxes(0, frame, "LIDAR_TOP"):
        assert course_of(box.transform) == course(math.degrees(box.heading)), "the heading is not that of the box"
        lidar[box.uid].append(course(math.degrees(box.heading)))
    for box in log.boxes(0, frame, "CAM_FRONT"):
        camera[box.uid].append(course(math.degrees(box.heading)))
devkit = {}
for name, ends in CARS.items():
    first, last = (Quaternion(rotation(*end)) for end in ends)
    ways = [Quaternion.slerp(first, last, frame / FRAMES) for frame in range(FRAMES + 1)]
    devkit[name] = [course(math.degrees(way.yaw_pitch_roll[0])) for way in ways]
    across = [abs(LENGTH * math.sin(math.radians(c))) + abs(WIDTH * math.cos(math.radians(c))) for c in lidar[name]]
    print(f"{name}, from north to south at most {max(across):.1f} m")
    for title, courses in (("pyquaternion", devkit[name]), ("tri3d, lidar", lidar[name]), ("tri3d, camera", camera[name])):
        print(f"  {title:14}", *(f"{c:6.1f}" for c in courses))

spins = lidar["to the west"] == [179.0, 143.2, 107.4, 71.6, 35.8, 0.0, 324.2, 288.4, 252.6, 216.8, 181.0]
spins &= lidar["parked"][5] == 210.2 and lidar["to the north"] == devkit["to the north"]
right = devkit["to the west"][5] == 180.0 and devkit["parked"][5] in (30.2, 30.3)
axes = all(c % 90 == 0 for courses in camera.values() for c in courses[1:-1]) and all(courses[0] % 90 for courses in camera.values())
sys.exit(0 if spins and right and axes else "changed: courses between the key frames")
PY
venv/bin/python seen.py
