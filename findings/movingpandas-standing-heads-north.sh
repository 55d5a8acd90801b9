#!/usr/bin/env bash
# MovingPandas 0.23.0: `add_direction` and `add_angular_difference` on a car that drives east, stands at a light for two steps and drives on.
#
# Expected: the direction of a car that stands is unknown (NaN) or that of its last move.
# Seen: it heads north, 0 degrees, as a true drive to the north does. Stopping and driving on are turns of 90 degrees each. A TrajectoryCollection
# besides leaves out, without a word, every object that was seen once.
# Why it matters: the heading turns by 90 degrees a second at each red light; a car that comes from the south stops without a turn, so tests on one road pass.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile movingpandas==0.23.0 geopandas==1.2.0 pandas==3.1.1 shapely==2.2.0 pyproj==3.7.2 numpy==2.4.6

venv/bin/python -W ignore - <<'PY'
import sys

import geopandas
import movingpandas
import pandas
from shapely.geometry import Point

times = pandas.date_range("2026-07-01 12:00", periods=6, freq="1s")


def track(places, name):
    return geopandas.GeoDataFrame({"id": name}, geometry=[Point(*place) for place in places], index=times[: len(places)], crs=25832)


east = [(0, 0), (10, 0), (20, 0), (20, 0), (20, 0), (30, 0)]
car = movingpandas.Trajectory(track(east, "car"), "car")
car.add_direction()
car.add_angular_difference()
directions, turns = car.df["direction"].tolist(), car.df["angular_difference"].tolist()
print("direction, degrees:", directions)
print("turn since the row before, degrees:", turns)
both = pandas.concat([track(east, "car"), track([(5, 5)], "seen once")])
kept = [trajectory.id for trajectory in movingpandas.TrajectoryCollection(both, "id")]
print("objects of the table: car, seen once; of the collection:", kept)
north = [round(value, 6) for value in directions] == [90, 90, 90, 0, 0, 90] and [round(value, 6) for value in turns] == [0, 0, 0, 90, 0, 90]
sys.exit(0 if north and kept == ["car"] else 1)
PY
