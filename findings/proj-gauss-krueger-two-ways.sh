#!/usr/bin/env bash
# pyproj 3.7.2 (PROJ 9.5.1) and geopandas 1.2.0 as installed from PyPI: a road map in German Gauss-Krueger coordinates (EPSG:31466 to 31468) in UTM 32.
#
# Expected: the way does not matter; directly, or through WGS 84 as a log with GPS needs it, the same place to the millimetre.
# Seen: the two ways end 0.6 to 1.26 m apart, in a direction that differs from zone to zone. Without the grid BETA2007 (not in the wheel) PROJ takes for each pair
# of systems another set of seven parameters. `to_crs` is silent, and `only_best=True`, made to refuse that, gives the same numbers; only a
# TransformerGroup says that the best way is not available.
# Why it matters: the survey that made the lane borders is shifted against the ego's track by a third of a lane, depending on which tool put in
# the step through longitude and latitude.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile pyproj==3.7.2 geopandas==1.2.0 shapely==2.2.0

PROJ_NETWORK=OFF venv/bin/python - <<'PY'
import sys
import warnings

import geopandas
import pyproj
from shapely.geometry import Point

warnings.simplefilter("error")
places = {31466: Point(2556000, 5730000), 31467: Point(3456000, 5428000), 31468: Point(4468000, 5333000)}
print("PROJ", pyproj.proj_version_str, "network:", pyproj.network.is_network_enabled())
apart = {}
for zone, place in places.items():
    series = geopandas.GeoSeries([place], crs=zone)
    direct, through = series.to_crs(25832)[0], series.to_crs(4326).to_crs(25832)[0]
    apart[zone] = direct.distance(through)
    print(f"EPSG:{zone}: direct {direct.x:.2f} {direct.y:.2f}, through WGS 84 {through.x:.2f} {through.y:.2f}: {apart[zone]:.2f} m apart")
best = pyproj.Transformer.from_crs(31467, 25832, always_xy=True, only_best=True).transform(3456000, 5428000)
direct = geopandas.GeoSeries([places[31467]], crs=31467).to_crs(25832)[0]
not_refused = abs(best[0] - direct.x) + abs(best[1] - direct.y) < 1e-6
with warnings.catch_warnings(record=True) as caught:
    warnings.simplefilter("always")
    group = pyproj.transformer.TransformerGroup(31467, 25832, always_xy=True)
print("only_best=True:", best, "TransformerGroup.best_available:", group.best_available)
differ = abs(apart[31466] - 1.26) < 0.02 and abs(apart[31467] - 0.60) < 0.02 and abs(apart[31468] - 0.94) < 0.02
print(f"ways differ without a warning: {differ}; the same with only_best: {not_refused}")
sys.exit(0 if differ and not_refused and not group.best_available else 1)
PY
