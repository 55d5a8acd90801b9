#!/usr/bin/env bash
# tactics2d 0.1.9: `LevelXParser("highD")` on a car that goes 30 m/s along the road and 1 m/s to its left, in highD's format (y downwards in the picture).
#
# Expected: a state whose y, vy and heading agree: the car moves 1 m/s to the left in all three.
# Seen: position and heading are turned upwards, vy is not: the heading is 0.033 rad to the left and y grows, while vy is -1 m/s, to the right. And y is
# stretched to the bounds of the site while x stays: with these lane markings the car moves 0.84 m sideways each second, and lanes are 16 % narrower.
# Why it matters: a lane change has the wrong sign in vy, which is what cut-in and lateral distance rules read; sides of length and distances
# across the lanes are no metres. Nothing warns; x, vx and the heading are right.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
# Only what the parser needs, by --no-deps: the whole is a gigabyte. Its package would import the parsers of all other data sets, too.
python3 -m pip --python venv install -q --no-compile --no-deps tactics2d==0.1.9 numpy==2.2.6 pandas==2.3.3 polars==1.44.1 polars-runtime-32==1.44.1 \
  pyproj==3.7.1 certifi==2026.10.19.post1 shapely==2.0.7 tabulate==0.10.0 python-dateutil==2.9.0.post0 six==1.17.0 pytz==2026.6 tzdata==2026.6

cat > 01_recordingMeta.csv <<'CSV'
id,frameRate,locationId,speedLimit,upperLaneMarkings,lowerLaneMarkings
1,25,2,-1,8.51;12.59;16.43,24.96;28.80;32.85
CSV
cat > 01_tracksMeta.csv <<'CSV'
id,width,height,initialFrame,finalFrame,numFrames,class,drivingDirection
1,4.85,2.12,1,100,100,Car,2
CSV
venv/bin/python -W ignore - <<'PY'
import importlib.util
import sys
import types
from pathlib import Path

parsers = types.ModuleType("tactics2d.dataset_parser")
parsers.__path__ = [f"{importlib.util.find_spec('tactics2d').submodule_search_locations[0]}/dataset_parser"]
sys.modules[parsers.__name__] = parsers
from tactics2d.dataset_parser.parse_levelx import LevelXParser

rows = ["frame,id,x,y,width,height,xVelocity,yVelocity,xAcceleration,yAcceleration,laneId"]
for frame in range(1, 101):
    t_s = (frame - 1) / 25
    # The upper left corner of the box. Left of a car on the lower road is up in the picture: y falls.
    rows.append(f"{frame},1,{100 + 30 * t_s:.2f},{28.94 - 1.0 * t_s:.2f},4.85,2.12,30.0,-1.0,0.0,0.0,6")
Path("01_tracks.csv").write_text("\n".join(rows) + "\n")
participants, _ = LevelXParser("highD").parse_trajectory(1, ".")
trajectory = participants[1].trajectory
early, late = (trajectory.get_state(frame) for frame in (400, 3400))
moved_x, moved_y = (late.x - early.x) / 3.0, (late.y - early.y) / 3.0
print(f"moved by positions: {moved_x:.3f} m/s along, {moved_y:+.3f} m/s sideways (left is +)")
print(f"velocity of the state: {early.vx:.3f} m/s along, {early.vy:+.3f} m/s sideways; heading {early.heading:+.4f} rad")
opposed = moved_y > 0.5 and early.heading > 0.03 and early.vy == -1.0
squeezed = abs(moved_x - 30.0) < 0.01 and abs(moved_y - 0.837) < 0.01
print(f"vy against position and heading: {opposed}; sideways metres stretched, along not: {squeezed}")
sys.exit(0 if opposed and squeezed else 1)
PY
