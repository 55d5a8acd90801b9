#!/usr/bin/env bash
# geopandas 1.2.0 with shapely 2.2.0: lines whose points have a height and a measure (LINESTRING ZM), as road axes with stations and tracks with times are delivered,
# brought to the coordinates of a log.
#
# Expected: `to_crs`, `translate` and `affine_transform` change x and y; height and measure stay, as with lines that have a height only. `force_3d` adds a height where
# there is none, by its documentation.
# Seen, without a word:
#   1. `to_crs`, `translate`, `rotate` and `affine_transform` make height and measure of every point NaN. The line stays valid, `has_z` and `has_m` stay true, its length
#      is right. Of a line with a measure only, the measure is gone.
#   2. `force_3d` sets every height to 0, and the measure is gone: a bridge at 112 m lies on the ground, below the road at 106 m that it crosses.
# Why it matters: whether two lanes meet or one is a bridge is decided by their heights. With NaN each comparison is false, "more than 4 m apart" as well, so the
# bridge meets the road. The same axes without measures are right, as are those of a file that was written and read in its own coordinates.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile geopandas==1.2.0 shapely==2.2.0 pyproj==3.7.2 pandas==3.1.1 numpy==2.4.6 pyarrow==26.0.1

cat >seen.py <<'PY'
import math
import sys
import warnings

import geopandas
import shapely

warnings.simplefilter("error")
AXES = {  # longitude, latitude, height above the sea; the measure is the station
    "road": [(8.400, 49.0, 106), (8.402, 49.0, 106)],
    "bridge": [(8.401, 48.999, 112), (8.401, 49.001, 112)],
}


def text(kind, points):
    """WKT of a line, with the station as measure where the kind has one."""
    numbers = [(x, y) + ((z,) if "Z" in kind else ()) + ((1000 + 100 * k,) if "M" in kind else ()) for k, (x, y, z) in enumerate(points)]
    return f"LINESTRING {kind} ({', '.join(' '.join(map(str, point)) for point in numbers)})"


def axes(kind):
    """The axes, written to GeoParquet and read again."""
    lines = [shapely.from_wkt(text(kind, points)) for points in AXES.values()]
    geopandas.GeoDataFrame({"name": list(AXES)}, geometry=lines, crs=4326).to_parquet(f"{kind}.parquet")
    return geopandas.read_parquet(f"{kind}.parquet").geometry


def heights_and_measures(series):
    """Of each line, the heights and the measures of its points: None where it has none."""
    rows = []
    for line in series:
        numbers = shapely.get_coordinates(line, include_z=True, include_m=True)
        rows.append((numbers[:, 2].tolist() if line.has_z else None, numbers[:, 3].tolist() if line.has_m else None))
    return rows


STEPS = {
    "read": lambda series: series,
    "to_crs": lambda series: series.to_crs(25832),
    "translate": lambda series: series.translate(0.1, 0.1),
    "rotate": lambda series: series.rotate(1, origin=(0, 0)),
    "affine_transform": lambda series: series.affine_transform([1, 0, 0, 1, 0.1, 0.1]),
    "force_3d": lambda series: series.force_3d(),
}
seen = {}
for kind in ("Z", "ZM", "M"):
    for name, step in STEPS.items():
        result = step(axes(kind))
        seen[kind, name] = heights_and_measures(result)
        print(f"{kind}, {name}: heights and measures of the bridge {seen[kind, name][1]}; valid {result.is_valid.all()}, has_z {result.has_z.all()}")
metric = axes("ZM").to_crs(25832)
length, plain = metric.length.tolist(), axes("Z").to_crs(25832).length.tolist()
gap = seen["ZM", "to_crs"][1][0][0] - seen["ZM", "to_crs"][0][0][0]
print(f"lengths {length}, of the axes without measures {plain}; they cross: {metric.iloc[0].crosses(metric.iloc[1])}; more than 4 m apart in height: {gap > 4}")
MOVES = ("to_crs", "translate", "rotate", "affine_transform")
stations = [1000.0, 1100.0]
lost = all(math.isnan(number) for name in MOVES for row in seen["ZM", name] for numbers in row for number in numbers)
flags = all(result.is_valid.all() and result.has_z.all() and result.has_m.all() for result in (STEPS[name](axes("ZM")) for name in MOVES))
flat = seen["ZM", "force_3d"] == [([0.0, 0.0], None)] * 2
without = all(seen["M", name] == [(None, None)] * 2 for name in MOVES)
right = all(seen["Z", name] == [([106.0, 106.0], None), ([112.0, 112.0], None)] for name in STEPS)
read = seen["ZM", "read"] == [([106.0, 106.0], stations), ([112.0, 112.0], stations)]
sys.exit(0 if lost and flags and flat and without and right and read and length == plain and not gap > 4 else "changed: heights and measures of moved lines")
PY
venv/bin/python seen.py
