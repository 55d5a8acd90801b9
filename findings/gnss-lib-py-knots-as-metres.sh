#!/usr/bin/env bash
# gnss-lib-py 1.1.0, `Nmea`, which makes a table of a receiver's GGA and RMC sentences; pynmea2 1.19.0, by which it reads them, and pyproj 3.7.2 for comparison.
#
# Expected: what its reference says of these names ("Standard Naming Conventions"): `vx_rx_mps` is the velocity along x of the earth's frame in m/s, `alt_rx_m` the height above
# the WGS-84 ellipsoid in metres.
# Seen, without a word:
#   1. `vx_rx_mps` is the speed over ground of RMC as it stands there, in knots: 20 m/s are 38.9, to whichever point of the compass. Places and times beside it give 20.
#   2. `alt_rx_m` is the height above the sea of GGA, though the geoid's height above the ellipsoid is in the same sentence and in the column `geo_sep`. The places in the
#      earth's frame, which it makes of them with `include_ecef=True`, lie 48 m below the road.
# Why it matters: 13 m/s in a zone of 50 km/h (13.9 m/s) read as 25.3 m/s, and braking at 4 m/s^2 as 7.8. Beside lidar, ground truth or satellites, whose heights are of the
# ellipsoid, each place is 48 m too low. The unit is in the name of the column, so nobody looks it up.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile --no-deps gnss-lib-py==1.1.0 pynmea2==1.19.0 numpy==2.4.6 pandas==2.3.3 scipy==1.17.1 pyproj==3.7.2 certifi==2026.10.19.post1 \
  cycler==0.12.1 fonttools==4.68.0 georinex==1.16.1 hatanaka==2.8.1 importlib_resources==7.1.0 kiwisolver==1.5.1 \
  matplotlib==3.11.2 ncompress==1.0.2 packaging==26.4 pillow==13.0.0 plotly==5.24.1 pyparsing==3.3.3 python-dateutil==4.0.0 pytz==2026.6 \
  tzdata==2026.6 unlzw3==0.2.3 xarray==2024.7.0 six==1.17.0

cat >seen.py <<'PY'
import sys
import warnings
from functools import reduce
from pathlib import Path

import numpy as np
import pynmea2
from gnss_lib_py.parsers.nmea import Nmea
from pyproj import Geod, Transformer

# It says of each time that it has no zone and is taken for UTC, which is right.
warnings.filterwarnings("ignore", message="No time zone info")
SPEED, COUNT, KNOT, SEA, GEOID = 20.0, 11, 1852 / 3600, 112.0, 48.0
EARTH = Geod(ellps="WGS84")


def sentence(body):
    return f"${body}*{reduce(lambda rest, letter: rest ^ ord(letter), body, 0):02X}"


def minutes(degrees, width):
    return f"{int(degrees):0{width}d}{degrees % 1 * 60:010.7f}"


def drive(course):
    """Sentences of a car at a steady speed, ten times a second, and its places."""
    east, north, _ = EARTH.fwd(np.full(COUNT, 8.4), np.full(COUNT, 49.0), np.full(COUNT, course), SPEED * np.arange(COUNT) / 10)
    lines = []
    for number, (longitude, latitude) in enumerate(zip(east, north)):
        time, place = f"12000{number // 10}.{number % 10}0", f"{minutes(latitude, 2)},N,{minutes(longitude, 3)},E"
        lines.append(sentence(f"GNGGA,{time},{place},4,12,0.6,{SEA:.3f},M,{GEOID:.3f},M,1.0,0001"))
        lines.append(sentence(f"GNRMC,{time},A,{place},{SPEED / KNOT:.3f},{course:.1f},011126,,,R"))
    return lines, east, north


def steps(rows):
    """Speed by the places and times of the table, in m/s."""
    _, _, metres = EARTH.inv(rows["lon_rx_deg"][:-1], rows["lat_rx_deg"][:-1], rows["lon_rx_deg"][1:], rows["lat_rx_deg"][1:])
    return metres / np.diff(rows["gps_millis"]) * 1000


same = True
for course in (0.0, 90.0, 225.0):
    lines, east, north = drive(course)
    Path("drive.nmea").write_text("\n".join(lines) + "\n")
    rows = Nmea("drive.nmea", include_ecef=True)
    speed, way = rows["vx_rx_mps"], steps(rows)
    knots = pynmea2.parse(lines[1]).spd_over_grnd
    print(f"course {course:5.1f}: vx_rx_mps {speed.min():.2f} to {speed.max():.2f}; by places and times {way.min():.2f} to {way.max():.2f} m/s; RMC has {knots} knots")
    same &= bool(np.allclose(speed, SPEED / KNOT, atol=0.01) and np.allclose(way, SPEED, atol=0.01)) and abs(knots * KNOT - SPEED) < 0.001

earth = np.array(Transformer.from_crs(4979, 4978, always_xy=True).transform(east, north, np.full(COUNT, SEA + GEOID)))
apart = np.linalg.norm(rows[["x_rx_m", "y_rx_m", "z_rx_m"]] - earth, axis=0)
print(f"alt_rx_m {rows['alt_rx_m'][0]:.1f}, geo_sep {rows['geo_sep'][0]:.1f}; {SEA + GEOID:.1f} m above the ellipsoid; places in the earth's frame off by {apart.max():.2f} m")
same &= bool(np.allclose(rows["alt_rx_m"], SEA) and np.allclose(apart, GEOID, atol=0.01))

sys.exit(0 if same else "changed: units and heights of NMEA")
PY
venv/bin/python seen.py
