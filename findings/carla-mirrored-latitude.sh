#!/usr/bin/env bash
# carla 0.9.16 (the Python package, without a simulator): longitude and latitude of a road of an OpenDRIVE map that leads 1000 m to the north.
#
# Expected: OpenDRIVE's y is the north, and CARLA's y is minus that (its world is left-handed, as documented). So the end of the road is 1000 m north of
# `lat_0`, and a way that bends to the left bends to the left on the earth.
# Seen: `Map.transform_to_geolocation` puts it 1000 m to the south, 2 km away: y is taken as the north there, with the wrong sign. East and west are right, so
# the world is mirrored. `geolocation_to_transform` has the same mirror: the way there and back agrees. x_0 and y_0 are ignored, and a map in UTM
# (`+proj=utm`) lies at 42 N, 2 E, with a line on standard error. Its pull request 1601 had negated y in 2019; the formula of 0.9.16 does not.
# Why it matters: positions on the earth join a simulated drive with another map, with OpenStreetMap, with weather or with a fleet's heat map. There the car
# turns left where it turned right and drives on the other side of the road, and a test of the round trip passes.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
# It has wheels for some versions of Python only.
python3.11 -m venv --without-pip venv 2>/dev/null || python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile --no-deps carla==0.9.16 pyproj==3.7.2 certifi==2026.10.19.post1

cat >seen.py <<'PY'
import math
import sys

import carla
import pyproj

LENGTH_M = 1000.0


def road(reference):
    """One road with one lane, from 0,0 to the north (heading 90 degrees), then to the left (west) on an arc with a radius of 50 m."""
    return f"""<?xml version="1.0"?>
<OpenDRIVE><header revMajor="1" revMinor="6" name="" version="1" north="0" south="0" east="0" west="0">
<geoReference><![CDATA[{reference}]]></geoReference></header>
<road name="" length="{LENGTH_M + 25 * math.pi}" id="1" junction="-1"><link/><planView>
<geometry s="0" x="0" y="0" hdg="{math.pi / 2}" length="{LENGTH_M}"><line/></geometry>
<geometry s="{LENGTH_M}" x="0" y="{LENGTH_M}" hdg="{math.pi / 2}" length="{25 * math.pi}"><arc curvature="0.02"/></geometry>
</planView><elevationProfile/><lateralProfile/><lanes><laneSection s="0"><center><lane id="0" type="none" level="false"><link/></lane></center>
<right><lane id="-1" type="driving" level="false"><link/><width sOffset="0" a="3.5" b="0" c="0" d="0"/></lane></right></laneSection></lanes>
<objects/><signals/></road></OpenDRIVE>"""


def places(reference, projection):
    """By CARLA and by PROJ, of three points of the lane: (latitude, longitude); and how far CARLA's way there and back is off."""
    town, by_carla, by_proj, off = carla.Map("road", road(reference)), [], [], 0.0
    for s in (0.0, LENGTH_M, LENGTH_M + 24.9 * math.pi):
        at = town.get_waypoint_xodr(1, -1, s).transform.location
        there = town.transform_to_geolocation(at)
        again = town.geolocation_to_transform(there)
        off = max(off, math.dist((at.x, at.y), (again.x, again.y)))
        by_carla.append((there.latitude, there.longitude))
        longitude, latitude = pyproj.Proj(projection)(at.x, -at.y, inverse=True)
        by_proj.append((latitude, longitude))
    return by_carla, by_proj, off


def turn(way):
    """The last change of direction, positive to the left."""
    (a, b, c), metres = way, math.cos(math.radians(way[0][0]))
    first, second = ((q[0] - p[0], (q[1] - p[1]) * metres) for p, q in ((a, b), (b, c)))
    return second[0] * first[1] - second[1] * first[0]


earth = pyproj.Geod(ellps="WGS84")
reference = "+proj=tmerc +lat_0=48 +lon_0=11 +k=1 +x_0=0 +y_0=0 +datum=WGS84 +units=m +no_defs"
by_carla, by_proj, off = places(reference, reference)
apart = [earth.inv(a[1], a[0], b[1], b[0])[2] for a, b in zip(by_carla, by_proj)]
for title, way in (("carla", by_carla), ("PROJ ", by_proj)):
    print(f"{title}: begin {way[0][0]:.5f} N, end of the line {way[1][0]:.5f} N {way[1][1]:.5f} E; turns", "left" if turn(way) > 0 else "right")
print(f"apart: {apart[0]:.1f} m, {apart[1]:.1f} m, {apart[2]:.1f} m; there and back in CARLA: {off:.3f} m off")
mirrored = apart[0] < 1 and 1990 < apart[1] < 2010 and turn(by_proj) > 0 > turn(by_carla) and off < 0.01

shifted = "+proj=tmerc +lat_0=48 +lon_0=11 +k=1 +x_0=500000 +y_0=100000 +datum=WGS84 +units=m +no_defs"
utm = "+proj=utm +zone=32 +datum=WGS84 +units=m +no_defs"
begin = places(shifted, shifted)[0][0]
begin_of_utm = places(utm, utm)[0][0]
print(f"x_0 of 500 km and y_0 of 100 km: begin {begin[0]:.5f} N {begin[1]:.5f} E; in UTM zone 32: {begin_of_utm[0]:.5f} N {begin_of_utm[1]:.5f} E")
ignored = math.dist(begin, by_carla[0]) < 1e-9 and math.dist(begin_of_utm, (42, 2)) < 1e-4
sys.exit(0 if mirrored and ignored else "changed: CARLA's longitude and latitude")
PY
venv/bin/python seen.py
