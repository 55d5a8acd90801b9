#!/usr/bin/env bash
# pykitti 0.3.1: the ego's pose `T_w_imu` of KITTI's raw drives.
#
# Expected: metres. A place 1000 m away (on the WGS 84 ellipsoid, of which KITTI's GPS speaks) is 1000 m away in the poses.
# Seen: the poses are a Mercator map of a sphere, scaled at the first frame. At 49 degrees north 1000 m to the east are 998.09 m, and 1000 m
# to the north are 1001.08 m; a drive back to the south is shorter than the drive there.
# Why it matters: positions and speeds from poses are wrong by up to 1.9 m per kilometre, another way for each course (0.2 % less to the east,
# 0.1 % more to the north): after two kilometres to the east the ego is 3.8 m from where it was. kitti2mcap 0.1.1 writes these poses to /tf.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile pykitti==0.3.1 opencv-python-headless==5.0.0.93 numpy==2.4.6 pandas==3.1.1 matplotlib==3.11.2 pillow==13.0.0 pyproj==3.7.2

venv/bin/python - <<'PY'
import sys
from pathlib import Path

from pykitti.utils import load_oxts_packets_and_poses
from pyproj import Geod

ellipsoid = Geod(ellps="WGS84")
start = (8.4, 49.0)
courses = {"north": 0.0, "east": 90.0, "south": 180.0, "west": 270.0}


def packet(lon, lat):
    """A line of KITTI's `oxts/data`: 25 numbers and 5 counts, all at rest but for the place."""
    return " ".join([f"{lat:.15f}", f"{lon:.15f}", "100.0"] + ["0.0"] * 22 + ["0"] * 5) + "\n"


files = [Path("0000.txt")]
files[0].write_text(packet(*start))
for name, course in courses.items():
    lon, lat, _ = ellipsoid.fwd(*start, course, 1000.0)
    files.append(Path(f"{name}.txt"))
    files[-1].write_text(packet(lon, lat))
poses = [packet_and_pose.T_w_imu for packet_and_pose in load_oxts_packets_and_poses([str(file) for file in files])]
away = {name: float(((pose[:2, 3] - poses[0][:2, 3]) ** 2).sum() ** 0.5) for name, pose in zip(courses, poses[1:])}
for name, distance in away.items():
    print(f"1000 m to the {name:5}: {distance:8.2f} m in T_w_imu")
expected = {"north": 1001.08, "east": 998.09, "south": 1000.90, "west": 998.09}
sys.exit(0 if all(abs(away[name] - distance) < 0.02 for name, distance in expected.items()) else 1)
PY
