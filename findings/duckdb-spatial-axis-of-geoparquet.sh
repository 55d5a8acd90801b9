#!/usr/bin/env bash
# DuckDB 1.5.5 with its spatial extension on a GeoParquet file that geopandas 1.2.0 wrote in EPSG:4326.
#
# Expected: GeoParquet has longitude first whatever its CRS says, and DuckDB reads the column as GEOMETRY('EPSG:4326'), so ST_Transform and
# ST_Distance_Sphere agree with geopandas.
# Seen: both take the first coordinate for the latitude. At 49 degrees north a step of 731.4 m is 1111.9 m long on the sphere and 1435.6 m in
# UTM 32, and the place lies thousands of kilometres away. No error: 8.4 is a latitude, too.
# Why it matters: distances and speeds from positions of a drive are wrong by half and by a factor of two, and still look like a drive.
# `always_xy := true` mends ST_Transform; ST_Distance_Sphere needs ST_FlipCoordinates.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile duckdb==1.5.5 duckdb-extension-spatial==1.5.5 duckdb-extensions==1.5.5 geopandas==1.2.0 pyarrow==26.0.1 \
  shapely==2.2.0 pyproj==3.7.2

HOME=$folder venv/bin/python - <<'PY'
import sys

import duckdb
import geopandas
from duckdb_extensions import import_extension
from shapely.geometry import Point

places = geopandas.GeoDataFrame({"step": [0, 1]}, geometry=[Point(8.40, 49.0), Point(8.41, 49.0)], crs=4326)
places.to_parquet("places.parquet")
metric = places.to_crs(25832)
by_geopandas = metric.geometry.iloc[0].distance(metric.geometry.iloc[1])

import_extension("spatial")
connection = duckdb.connect()
connection.execute("LOAD spatial")
kind = connection.sql("SELECT DISTINCT typeof(geometry) FROM 'places.parquet'").fetchall()


def of_pair(expression):
    return connection.sql(f"SELECT {expression} FROM 'places.parquet' a, 'places.parquet' b WHERE a.step = 0 AND b.step = 1").fetchone()[0]


in_utm = "ST_Transform({}.geometry, 'EPSG:4326', 'EPSG:25832'{})"
on_sphere = of_pair("ST_Distance_Sphere(a.geometry, b.geometry)")
by_default = of_pair(f"ST_Distance({in_utm.format('a', '')}, {in_utm.format('b', '')})")
longitude_first = of_pair(f"ST_Distance({in_utm.format('a', ', always_xy := true')}, {in_utm.format('b', ', always_xy := true')})")
print("column:", kind, "place by geopandas:", metric.geometry.iloc[0].wkt)
print("place by DuckDB:", of_pair("ST_AsText(ST_Transform(a.geometry, 'EPSG:4326', 'EPSG:25832'))"))
print(f"step in m: geopandas {by_geopandas:.1f}, DuckDB {by_default:.1f}, always_xy {longitude_first:.1f}, sphere {on_sphere:.1f}")
swapped = abs(by_default - 1435.57) < 1 and abs(on_sphere - 1111.95) < 1
sys.exit(0 if swapped and abs(by_geopandas - 731.3) < 2 and abs(longitude_first - by_geopandas) < 0.01 and "4326" in str(kind) else 1)
PY
