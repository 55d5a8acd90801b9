#!/usr/bin/env bash
# SedonaDB 0.5.0: the lane that is nearest to a car, `ST_KNN(car, lane, 1, use_spheroid)`, on a map in longitude and latitude.
#
# Expected: with `use_spheroid` true the same lane as without, or a better one: distances are in metres on the earth instead of degrees, as those of its type geography are.
# Seen, without a word:
#   1. With true, a lane is as far as its middle. A car that drives within a main road of 1000 m, 300 m from its middle, has for its nearest lane a side street of 10 m that is
#      105 m away; lines and areas alike. At 0, 100 and 200 m from its middle it is right, as that is nearer than the middle of the side street.
#   2. With false, the distance is of the shapes, a car within a lane has that lane, but it counts in degrees: at 49 degrees north a lane 14 m to the north is nearer than
#      one 10 m to the east. With true that is right.
# Why it matters: a drive changes to the side streets as soon as it leaves the middle of a long road, and the lane's limit, direction and neighbours are those of another
# street. Lanes of equal length pass, and so do places of signs and detections, which are points. Sedona for Spark says of its own ST_KNN that it takes
# the centroid; here false does not. `ST_Distance` of geographies measures the shapes in metres, but ST_KNN does not take geographies (its issue 1086).
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile --no-deps sedonadb==0.5.0 pyarrow==26.0.1 geoarrow-pyarrow==0.3.0 \
  geoarrow-types==0.4.1 geoarrow-c==0.4.0 pyproj==3.7.2 certifi==2026.10.19.post1 numpy==2.4.6

cat >seen.py <<'PY'
import math
import sys
import warnings

import sedonadb

warnings.simplefilter("ignore")  # it looks for GDAL, of which nothing here has need
connection = sedonadb.connect()
EAST, NORTH = 8.4, 49.0
PER_EAST, PER_NORTH = 1 / (111_320 * math.cos(math.radians(NORTH))), 1 / 111_210  # degrees of a metre, to a part in a thousand


def text(kind, *places):
    """Well-known text of places that are metres to the east and to the north."""
    inner = ", ".join(f"{EAST + x * PER_EAST:.9f} {NORTH + y * PER_NORTH:.9f}" for x, y in places)
    return {"car": f"POINT({inner})", "line": f"LINESTRING({inner})", "area": f"POLYGON(({inner}))"}[kind]


def road(kind, begin, end, y):
    """A lane of 3.5 m to the east, as its middle line or as its area."""
    if kind == "line":
        return text(kind, (begin, y), (end, y))
    return text(kind, (begin, y - 1.75), (end, y - 1.75), (end, y + 1.75), (begin, y + 1.75), (begin, y - 1.75))


def view(name, rows):
    values = ", ".join(f"('{title}', '{shape}')" for title, shape in rows)
    connection.sql(f"SELECT column1 AS title, ST_SetSRID(ST_GeomFromText(column2), 4326) AS shape FROM (VALUES {values})").to_view(name, overwrite=True)


def nearest(spheroid):
    query = f"SELECT car.title AS car, lane.title AS lane FROM car JOIN lane ON ST_KNN(car.shape, lane.shape, 1, {spheroid})"
    return {row["car"]: row["lane"] for row in connection.sql(query).to_arrow_table().to_pylist()}


def metres():
    """Distances on the earth, by the geographies of the same shapes."""
    parts = [f"ST_GeogFromWKB(ST_AsBinary({name}.shape))" for name in ("car", "lane")]
    query = f"SELECT car.title AS car, lane.title AS lane, ST_Distance({', '.join(parts)}) AS metres FROM car CROSS JOIN lane"
    return {(row["car"], row["lane"]): row["metres"] for row in connection.sql(query).to_arrow_table().to_pylist()}


same = True
CARS = [0, 100, 200, 300, 400]
for kind in ("line", "area"):
    view("car", [(f"{x} m", text("car", (x, 1.0))) for x in CARS])
    view("lane", [("main road", road(kind, -500, 500, 0.0)), ("side street", road(kind, 400, 410, 35.0))])
    seen, flat, away = nearest("true"), nearest("false"), metres()
    print(f"lanes as {kind}s")
    for x in CARS:
        far = {lane: away[f"{x} m", lane] for lane in ("main road", "side street")}
        print(f"  car {x:3} m from the middle: main road {far['main road']:3.1f} m, side street {far['side street']:5.1f} m; true: {seen[f'{x} m']}, false: {flat[f'{x} m']}")
    same &= [seen[f"{x} m"] for x in CARS] == ["main road"] * 3 + ["side street"] * 2 and set(flat.values()) == {"main road"}
    same &= all(away[f"{x} m", "main road"] < 1.1 for x in CARS) and 100 < away["300 m", "side street"] < 110

view("car", [("car", text("car", (0.0, 0.0)))])
view("lane", [("10 m to the east", text("line", (10.0, -5.0), (10.0, 5.0))), ("14 m to the north", text("line", (-5.0, 14.0), (5.0, 14.0)))])
seen, flat = nearest("true")["car"], nearest("false")["car"]
print(f"two short lanes: true: {seen}, false: {flat}")
same &= (seen, flat) == ("10 m to the east", "14 m to the north")
sys.exit(0 if same else "changed: the nearest lanes of ST_KNN")
PY
venv/bin/python seen.py
