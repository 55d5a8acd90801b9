#!/usr/bin/env bash
# trajectopy 5.1.2 (trajectories and their comparison): the speeds that it gives to recorded places, `velocity_xyz` and `absolute_velocity`, also columns of
# `to_dataframe` and of its files.
#
# Expected: metres per second, as its path lengths are metres, whatever the places are given in; and a vector that belongs to its pose, before and after `transform`, by
# which one trajectory is brought into the frame of another.
# Seen, without a word:
#   1. Of places in degrees (EPSG:4326) the speed is in degrees per second: 20 m/s are 0.000231. It stays so when `positions.to_epsg` has brought the places to metres in
#      UTM, and in a file written then, whose header says UTM. The path length is right all the time: 1200 m in 60 s.
#   2. `transform` turns places and headings, and not the speeds. Turned by 90 degrees, a car that drives straight on slides sideways at 20 m/s, all along.
#   3. Each trajectory ends at 0 m/s: the last place has no next one. Interpolated from 10 to 100 Hz, the car brakes from 20 m/s to a standstill within 0.1 s.
# Why it matters: a limit is kept by whoever drives at 0.0002 m/s. After `align`, which lays an estimate over the ground truth, each object's course is beside its
# heading, so side and closing speed are of another encounter; the places fit to the last bit. Each log that is read ends with a full stop.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile --no-deps trajectopy==5.1.2 numpy==2.4.6 pandas==3.1.1 scipy==1.17.1 pyproj==3.7.2 certifi==2026.10.19.post1 \
  autograd==1.9.1 rosbags==0.11.9 apsw==3.54.1.0 backports.zstd==1.8.0 lz4==4.4.5 ruamel.yaml==0.19.1 python-dateutil==4.0.0 typing_extensions==4.16.0 tzdata==2026.6

cat >seen.py <<'PY'
import sys

import numpy as np
from pyproj import Geod, Transformer
from trajectopy import Trajectory
from trajectopy.processing.interpolation import interpolate

SPEED, HERTZ, SECONDS, COURSE, UTM = 20.0, 10, 60, 45.0, 25832
time = np.arange(SECONDS * HERTZ + 1) / HERTZ
count = len(time)
EARTH = Geod(ellps="GRS80")
east, north, _ = EARTH.fwd(np.full(count, 8.4), np.full(count, 49.0), np.full(count, COURSE), SPEED * time)
degrees = np.column_stack([north, east, np.full(count, 110.0)])
x, y = Transformer.from_crs(4258, UTM).transform(north, east)
metres = np.column_stack([x, y, np.full(count, 110.0)])


def show(title, trajectory):
    speeds = trajectory.absolute_velocity[:-1]
    print(f"{title:38} {trajectory.total_length:7.1f} m, {speeds.min():.6f} to {speeds.max():.6f} m/s, EPSG {trajectory.positions.epsg}")
    return speeds.mean()


same = True
written = show("places in UTM", Trajectory.from_arrays(metres, epsg=UTM, timestamps=time))
track = Trajectory.from_arrays(degrees, epsg=4326, timestamps=time)
found = [show("places in degrees", track)]
track.positions.to_epsg(UTM)
apart = float(np.abs(track.xyz - metres).max())
found.append(show("the same, brought to UTM", track))
track.to_file("track.traj")
found.append(show("the same, written and read again", Trajectory.from_file("track.traj")))
print(f"  the places in UTM are {apart:.3f} m from those by pyproj")
same &= abs(written - SPEED) < 0.01 and all(0.00022 < speed < 0.00024 for speed in found) and apart < 0.01 and abs(track.total_length - 1200) < 0.1


def slip(trajectory):
    """The angle between where a car heads and where its speed leads, in degrees, and what the places say of it."""
    heading = trajectory.rpy[:-1, 2]
    speed = np.arctan2(trajectory.velocity_xyz[:-1, 1], trajectory.velocity_xyz[:-1, 0])
    step = np.diff(trajectory.xyz[:, :2], axis=0)
    ways = (np.rad2deg(angle - heading) for angle in (speed, np.arctan2(step[:, 1], step[:, 0])))
    return [round(float(np.abs((way + 180) % 360 - 180).max()), 3) for way in ways]


straight = np.column_stack([SPEED * time, np.zeros(count), np.zeros(count)])
car = Trajectory.from_arrays(straight, rpy=np.zeros((count, 3)), timestamps=time)
quarter = np.array([[0.0, -1.0, 0.0, 100.0], [1.0, 0.0, 0.0, 50.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]])
before, after = slip(car), slip(car.transform(quarter, inplace=False))
print(f"angle of speed and heading {before[0]} degrees, of way and heading {before[1]}; after a turn of the frame by 90 degrees {after[0]} and {after[1]}")
same &= before == [0.0, 0.0] and after == [90.0, 0.0]

fine = interpolate(car, np.arange(SECONDS * 100 + 1) / 100, inplace=False)
speeds = fine.absolute_velocity
least = np.diff(speeds).min() * 100
step = fine.xyz[-1, 0] - fine.xyz[-2, 0]
print(f"at 100 Hz the last speeds are {', '.join(f'{speed:.0f}' for speed in speeds[-12:])} m/s, {least:.0f} m/s^2; the last step is {step:.2f} m")
same &= speeds[-1] == 0.0 and abs(speeds[-11] - SPEED) < 1e-6 and round(least) == -200 and abs(step - 0.2) < 1e-6
sys.exit(0 if same else "changed: speeds of trajectories")
PY
venv/bin/python seen.py
