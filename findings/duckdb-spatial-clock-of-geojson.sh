#!/usr/bin/env bash
# DuckDB 1.5.5 with its spatial extension: `ST_Read` of places with times that have an offset from UTC, as 2026-07-01T12:00:00+02:00; geopandas 1.2.0 with pyogrio
# 0.13.0 reads the same files, by the same library (GDAL).
#
# Expected: 12:00+02:00 is 10:00 UTC, in a column that is TIMESTAMP WITH TIME ZONE at least. geopandas and DuckDB's own cast of the text say so.
# Seen, without a word:
#   1. GeoJSON: the column is TIMESTAMP WITH TIME ZONE, and the time is 12:00 UTC, two hours late; with -05:00 it is five hours early. Times with Z are right.
#   2. Once two offsets are in the file, all of them are right: one more place with Z moves all others by two hours.
#   3. GPX, FlatGeobuf and GML: the time is 12:00 without a zone. GeoPackage is right.
# Why it matters: events, tolls and tracks of phones come as GeoJSON or GPX in the time of the place, a vehicle's log in UTC. A join by time puts each event two hours, or
# 100 km, further on. A drive through the night in which the clocks change has two offsets and is right; so is a test file in UTC.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile duckdb==1.5.5 duckdb-extension-spatial==1.5.5 duckdb-extensions==1.5.5 geopandas==1.2.0 pyogrio==0.13.0 \
  pyproj==3.7.2 shapely==2.2.0 pandas==3.1.1 numpy==2.4.6

cat >seen.py <<'PY'
import json
import sys
import warnings

import duckdb
import geopandas
from duckdb_extensions import import_extension

warnings.simplefilter("ignore")  # a GeoPackage of geopandas has times with an offset, which GDAL says
import_extension("spatial")
connection = duckdb.connect()
connection.execute("LOAD spatial")
connection.execute("SET TimeZone = 'UTC'")
SUMMER, UTC, WEST = "2026-07-01T12:00:00+02:00", "2026-07-01T10:00:00Z", "2026-07-01T05:00:00-05:00"  # one and the same moment
TRUTH = connection.execute("SELECT epoch_ms(?::TIMESTAMPTZ)", [SUMMER]).fetchone()[0]


def geojson(*times):
    features = [{"type": "Feature", "properties": {"time": time}, "geometry": {"type": "Point", "coordinates": [8.4, 49]}} for time in times]
    with open("places.geojson", "w") as file:
        json.dump({"type": "FeatureCollection", "features": features}, file)
    return "places.geojson"


def gpx(time):
    with open("places.gpx", "w") as file:
        file.write(
            '<?xml version="1.0"?><gpx version="1.1" creator="nobody" xmlns="http://www.topografix.com/GPX/1/1">'
            f'<wpt lat="49" lon="8.4"><time>{time}</time></wpt></gpx>'
        )
    return "places.gpx"


def written(ending, time):
    """A file of geopandas with the time of a GeoJSON file."""
    places = geopandas.read_file(geojson(time))
    places.to_file(f"places.{ending}", layer="places")
    return f"places.{ending}"


def hours_off(path):
    """The type of DuckDB's column, and by how many hours DuckDB and geopandas are off at each place, a time without a zone taken for UTC."""
    layer = "waypoints" if path.endswith("gpx") else "places"
    rows = connection.execute(f"SELECT typeof(time), epoch_ms(time) FROM ST_Read('{path}', layer = '{layer}')").fetchall()
    times = [time.timestamp() * 1000 for time in geopandas.read_file(path, layer=layer)["time"]]
    return rows[0][0], [(moment - TRUTH) / 3_600_000 for _, moment in rows], [(moment - TRUTH) / 3_600_000 for moment in times]


ZONED, PLAIN = "TIMESTAMP WITH TIME ZONE", "TIMESTAMP_MS"
expected = {
    "GeoJSON, +02:00": (geojson, (SUMMER, SUMMER), ZONED, [2, 2]),
    "GeoJSON, -05:00": (geojson, (WEST,), ZONED, [-5]),
    "GeoJSON, Z": (geojson, (UTC,), ZONED, [0]),
    "GeoJSON, +02:00 and Z": (geojson, (SUMMER, SUMMER, UTC), ZONED, [0, 0, 0]),
    "GPX, +02:00": (gpx, (SUMMER,), PLAIN, [2]),
    "FlatGeobuf, +02:00": (lambda time: written("fgb", time), (SUMMER,), PLAIN, [2]),
    "GML, +02:00": (lambda time: written("gml", time), (SUMMER,), PLAIN, [2]),
    "GeoPackage, +02:00": (lambda time: written("gpkg", time), (SUMMER,), ZONED, [0]),
}
same = True
for title, (write, times, kind, hours) in expected.items():
    column, by_duckdb, by_geopandas = hours_off(write(*times))
    print(f"{title}: DuckDB {column}, hours off {by_duckdb}; geopandas, hours off {by_geopandas}")
    same = same and column == kind and by_duckdb == hours and not any(by_geopandas)
sys.exit(0 if same else "changed: times that ST_Read reads")
PY
HOME=$folder venv/bin/python seen.py
