#!/usr/bin/env bash
# commonroad-dataset-converter 2025.1.0, `crconvert ... highd`: a recording in highD's format (25 Hz) as CommonRoad scenarios.
#
# Expected: each car is where the recording has it, at that time. highD records no indicators, so the scenarios say nothing about them. By the help, the upper
# carriageway, on which cars drive to the left, is turned by 180 degrees, and `--keep-direction` prevents that.
# Seen, without a word:
#   1. `--keep-direction` writes an indicator state for every car and step, all off, also while a car changes lanes. Its value is taken for the option that infers
#      indicators from bends of less than 50 m radius, which a motorway has not.
#   2. The upper carriageway is turned in neither case.
#   3. `--downsample 5`: a car that comes into view between two of the new steps is put at the earlier one, where it was not yet. First seen at 30 m/s four steps of
#      0.04 s later it is 4.8 m too far on, and 1.2 m are its way in the first 0.2 s: 6 m/s, beside a recorded velocity of 30 m/s. From then on it is right.
# Why it matters: in highD nearly all cars come into view during the recording, so four of five begin with a false place, and by differences of places they speed up by
# up to 24 m/s in one step. With `--keep-direction` every lane change of the data set was made without an indicator: a rule about them fails for all.
# Only what the converter imports, by --no-deps, and without its command line, whose options go to the class used here: the whole has matplotlib, Arrow and more besides.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3.11 -m venv --without-pip venv 2>/dev/null || python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile --no-deps commonroad-dataset-converter==2025.1.0 commonroad-io==2024.3 commonroad-route-planner==2025.1.0 \
  numpy==1.26.4 pandas==3.0.6 scipy==1.17.1 shapely==2.2.0 networkx==3.6.1 lxml==6.1.3 protobuf==3.20.2 iso3166==3.0.0 omegaconf==2.4.0 PyYAML==6.0.4 \
  python-dateutil==2.9.0.post0 six==1.17.0 pydantic==2.14.4 pydantic_core==2.50.5 annotated-types==0.8.0 typing-inspection==0.4.5 typing_extensions==4.16.0 \
  ruamel.yaml==0.19.1 tqdm==4.70.1 2>pip.log || { cat pip.log; exit 1; }

cat >recording.py <<'PY'
"""A recording of 4 s in highD's format: x and y of the upper left corner of a box, y downwards. Car 1 drives to the left, 2 changes lanes, 3 comes into view in frame 5."""

import math
import pathlib

FRAMES, RATE, LENGTH, WIDTH = 100, 25, 4.5, 1.8
COLUMNS = (
    "frame,id,x,y,width,height,xVelocity,yVelocity,xAcceleration,yAcceleration,frontSightDistance,backSightDistance,dhw,thw,ttc,precedingXVelocity,precedingId,"
    "followingId,leftPrecedingId,leftAlongsideId,leftFollowingId,rightPrecedingId,rightAlongsideId,rightFollowingId,laneId"
)
META = "id,width,height,initialFrame,finalFrame,numFrames,class,drivingDirection,traveledDistance,minXVelocity,maxXVelocity,meanXVelocity,minDHW,minTHW,minTTC,numLaneChanges"
cars = {1: (1, 400.0, 10.0, -30.0, 0.0), 2: (1, 10.0, 22.0, 30.0, 4.0), 3: (5, 0.0, 26.0, 30.0, 0.0)}  # first frame, x, y, velocity along x, metres sideways
rows, meta = [COLUMNS], [META]
for car, (first, x, y, velocity, sideways) in cars.items():
    for frame in range(first, FRAMES + 1):
        share = (frame - first) / (FRAMES - 1)
        along, across = x + velocity * (frame - first) / RATE, y + sideways * (1 - math.cos(math.pi * share)) / 2
        rate = sideways * math.pi / 2 * math.sin(math.pi * share) / ((FRAMES - 1) / RATE)
        rows.append(f"{frame},{car},{along - LENGTH / 2},{across - WIDTH / 2},{LENGTH},{WIDTH},{velocity},{rate}" + ",0" * 16 + f",{2 if velocity < 0 else 5}")
    count, direction = FRAMES - first + 1, 1 if velocity < 0 else 2
    meta.append(f"{car},{LENGTH},{WIDTH},{first},{FRAMES},{count},Car,{direction},{30 * (count - 1) / RATE},30,30,30,-1,-1,-1,{int(sideways > 0)}")
folder = pathlib.Path("data")
folder.mkdir()
(folder / "01_tracks.csv").write_text("\n".join(rows) + "\n")
(folder / "01_tracksMeta.csv").write_text("\n".join(meta) + "\n")
(folder / "01_recordingMeta.csv").write_text(
    "id,frameRate,locationId,speedLimit,month,weekDay,startTime,duration,totalDrivenDistance,totalDrivenTime,numVehicles,numCars,numTrucks,upperLaneMarkings,lowerLaneMarkings\n"
    f"1,{RATE},2,33.33,9.2026,Tue,08:38,4.0,355,12,3,3,0,8.00;12.00;16.00,20.00;24.00;28.00\n"
)
PY
python3 recording.py

cat >seen.py <<'PY'
import pathlib
import sys
import xml.etree.ElementTree as ElementTree

from crdata.datasets.highD import HighdConverterFactory


def cars(name, **options):
    """Per car of the converted recording its states (step, x, y, velocity) and its indicator states, and the length of a step."""
    by_car, folder = {}, pathlib.Path(name)
    folder.mkdir()
    HighdConverterFactory(input_dir="data", output_dir=folder, keep_ego=True, **options).build_runner().run()
    for path in sorted(folder.glob("*.xml")):
        root = ElementTree.parse(path).getroot()
        for obstacle in root.iter("dynamicObstacle"):
            states = [obstacle.find("initialState"), *obstacle.find("trajectory")]
            numbers = [[float(state.findtext(name)) for name in ("time/exact", "position/point/x", "position/point/y", "velocity/exact")] for state in states]
            lights = [(signal.findtext("indicatorLeft"), signal.findtext("indicatorRight")) for signal in obstacle.iter("signalState")]
            by_car[int(obstacle.get("id")) - 10000] = (numbers, lights, float(root.get("timeStepSize")))
    return by_car


plain, kept, coarse = cars("plain"), cars("kept", keep_direction=True), cars("coarse", downsample=5)
for name, seen in (("plain", plain), ("--keep-direction", kept)):
    states, lights, _ = seen[2]
    print(f"{name}: car 2 goes from y {states[0][2]:.2f} m to {states[-1][2]:.2f} m; its indicator states: {len(lights)}, of them on: {sum('true' in light for light in lights)}")
    states = seen[1][0]
    print(f"{name}: car 1 of the upper carriageway goes from x {states[0][1]:.1f} m to {states[-1][1]:.1f} m")
lane_change = abs(kept[2][0][0][2] - kept[2][0][-1][2]) > 3.9
invented = lane_change and not plain[2][1] and len(kept[2][1]) > 90 and set(kept[2][1]) == {("false", "false")}
same_way = plain[1][0] == kept[1][0] and plain[1][0][0][1] > plain[1][0][-1][1]
speeds = {}
for car, (states, _, step) in coarse.items():
    speeds[car] = [abs(b[1] - a[1]) / ((b[0] - a[0]) * step) for a, b in zip(states, states[1:])]
    print(f"--downsample 5, step {step} s: car {car} speeds by places {[round(value, 2) for value in speeds[car][:4]]} m/s, recorded {states[0][3]:.1f} m/s at x {states[0][1]:.2f} m")
first = coarse[3][0][0]
moved = first[0] == 0 and abs(first[1]) < 0.01 and abs(speeds[3][0] - 6) < 0.05 and all(abs(value - 30) < 0.05 for value in speeds[3][1:] + speeds[2] + speeds[1])
sys.exit(0 if invented and same_way and moved else "changed: indicators, direction or first places of the converted recording")
PY
venv/bin/python -W ignore seen.py 2>seen.log || { tail -n 5 seen.log; exit 1; }
