#!/usr/bin/env bash
# trackintel 1.4.2: speeds of a track (`get_speed_positionfixes`) and lengths of its lines (`calculate_haversine_length`) of positions in degrees, at the rate at which a
# vehicle records them.
#
# Expected: a car that drives straight on at a steady speed has this speed at each rate. `point_haversine_dist` is named after the haversine formula and cites it, which is
# there for short distances: written as such, it gives each of these steps to a nanometre on the same sphere.
# Seen, without a word:
#   1. It takes the arc cosine of a number just below 1 instead, where numbers are 1.1e-16 apart: there is no distance between 0 and 9.5 cm, and the next ones are 13.4,
#      16.4, 19.0 and 21.2 cm. At 100 Hz a car at 5 m/s stands still, and its way of 300 m is 0 m long; 15 m/s are 13.4 m/s to the north and 16.4 m/s to the east. At 1 Hz
#      all is right.
#   2. A car that goes faster by 2 m/s each second leaps: 0 m/s, then 9.5 m/s within 10 ms, or 949 m/s^2.
#   3. The first speed of a second `user_id` is that from the last place of the first: two cars, recorded together, bring -3 m/s into the column.
# Why it matters: 15 m/s in a zone of 50 km/h (13.9 m/s) breaks the limit, and 13.4 m/s keep it. Who creeps over a stop line stands. It is no noise: all the speeds
# of a track are wrong alike, so neither a mean nor a filter helps. pynmeagps 1.1.8 has the same formula, and says that it is not for less than 50 m.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile --no-deps trackintel==1.4.2 geopandas==1.2.0 pandas==3.1.1 numpy==2.4.6 shapely==2.2.0 pyproj==3.7.2 \
  certifi==2026.10.19.post1 charset-normalizer==3.5.3 contourpy==1.3.3 cycler==0.12.1 cloudpickle==3.1.3 fonttools==4.68.0 GeoAlchemy2==0.20.0 idna==3.20 \
  joblib==1.6.0 kiwisolver==1.5.1 matplotlib==3.11.2 narwhals==2.29.0 networkx==3.6.1 osmnx==2.1.1 packaging==26.4 pillow==13.0.0 pyogrio==0.13.0 \
  pyparsing==3.3.3 python-dateutil==4.0.0 requests==2.34.2 scikit-learn==1.9.1 scipy==1.17.1 similaritymeasures==1.5.0 SQLAlchemy==2.1.9 threadpoolctl==3.8.0 \
  tqdm==4.70.1 typing_extensions==4.16.0 tzdata==2026.6 urllib3==2.8.0 six==1.17.0

cat >seen.py <<'PY'
import sys

import geopandas
import numpy as np
import pandas as pd
from pyproj import Geod
from shapely import LineString
from trackintel import Positionfixes
from trackintel.geogr import calculate_haversine_length, get_speed_positionfixes

SECONDS, RADIUS, LIMIT = 60, 6_371_000.0, 50 / 3.6
SPHERE = Geod(a=RADIUS, b=RADIUS)
BEGIN = pd.Timestamp("2026-11-01T12:00:00Z")


def track(way, hertz, course=0.0, user=0, begin=BEGIN, latitude=49.0):
    """Positions of a car that has driven so many metres along a great circle at each sample."""
    count = len(way)
    east, north, _ = SPHERE.fwd(np.full(count, 8.4), np.full(count, latitude), np.full(count, course), way)
    times = begin + pd.to_timedelta(np.arange(count) * (1_000_000 // hertz), unit="us")
    places = geopandas.points_from_xy(east, north)
    return geopandas.GeoDataFrame({"user_id": user, "tracked_at": times}, geometry=places, crs="EPSG:4326")


def steady(speed, hertz):
    return np.arange(SECONDS * hertz + 1) * speed / hertz


def haversine(places):
    """The formula that the package names, for the steps between places."""
    east, north = np.radians(places.x.to_numpy()), np.radians(places.y.to_numpy())
    height = np.sin(np.diff(north) / 2) ** 2 + np.cos(north[1:]) * np.cos(north[:-1]) * np.sin(np.diff(east) / 2) ** 2
    return 2 * RADIUS * np.arcsin(np.sqrt(height))


def speeds(table):
    return get_speed_positionfixes(Positionfixes(table))["speed"].to_numpy()


same = True
print("m/s   Hz   haversine by trackintel: m/s, and metres of the way")
for speed, hertz, seen, length in (
    (20.0, 1, 20.0, 1200.0),
    (20.0, 10, 20.0, 1200.2),
    (2.0, 10, 1.9, 113.9),
    (20.0, 100, 19.0, 1139.2),
    (15.0, 100, 13.4, 805.6),
    (5.0, 100, 0.0, 0.0),
):
    table = track(steady(speed, hertz), hertz)
    right = haversine(table.geometry) * hertz
    found = speeds(table)
    line = geopandas.GeoDataFrame(geometry=[LineString(table.geometry.tolist())], crs="EPSG:4326")
    metres = float(calculate_haversine_length(line)[0])
    print(f"{speed:4.0f} {hertz:4d}   {right.mean():7.3f}   {found.min():5.2f} to {found.max():5.2f}   {metres:6.1f} of {speed * SECONDS:6.1f}")
    same &= bool(np.abs(right - speed).max() < 1e-5)
    same &= round(float(found.min()), 1) == round(float(found.max()), 1) == seen and round(metres, 1) == length

north, east = (speeds(track(steady(15.0, 100), 100, course=course)) for course in (0.0, 90.0))
print(f"15 m/s at 100 Hz: to the north {north.min():.2f} to {north.max():.2f} m/s, to the east {east.min():.2f} to {east.max():.2f} m/s; limit {LIMIT:.1f} m/s")
same &= bool(north.max() < LIMIT) and round(float(east.min()), 1) == round(float(east.max()), 1) == 16.4

time = np.arange(SECONDS * 20) / 100
faster = speeds(track(time**2, 100))
leap = float(np.diff(faster).max())
truth = haversine(track(time**2, 100).geometry) * 100
print(f"from 0 to {truth.max():.1f} m/s at 2 m/s^2: leaps of up to {leap:.1f} m/s in 10 ms; by the formula {np.diff(truth).max():.2f} m/s")
print("  its first speeds above 0:", *(f"{speed:.1f}" for speed in np.unique(np.round(faster[faster > 0], 1))[:5]))
same &= round(leap, 1) == 9.5 and round(float(np.diff(truth).max()), 2) == 0.02

cars = [track(steady(20.0, 10), 10), track(steady(20.0, 10), 10, user=1, begin=BEGIN + pd.Timedelta(seconds=30), latitude=49.01)]
both = speeds(pd.concat(cars, ignore_index=True))
print(f"two cars at 20 m/s: {both.min():.1f} to {both.max():.1f} m/s, first of the second {both[len(cars[0])]:.1f} m/s")
same &= round(float(both[len(cars[0])]), 1) == -2.9
sys.exit(0 if same else "changed: speeds and lengths of short steps")
PY
venv/bin/python seen.py
