#!/usr/bin/env bash
# Lanelet2 1.2.3 (PyPI), its own traffic rules on the attribute `speed_limit` with a unit; beside it simple-lanelet2 1.2.3, the drop-in written in Rust.
#
# Expected: "50 km/h", "50 Km/h" and "50 kmph" are 50 km/h, or the library says that it does not know the unit.
# Seen: "50 Km/h" and "50 kmph" are 80.467 km/h, as "50 mph" is. "50 KM/H" and "50 MPH" are 0. simple-lanelet2 says 0 for all four.
# Why it matters: the limit of a town is 80 km/h in one library, 0 in its drop-in and 50 on the sign, for two spellings that people write.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip lanelet2
python3 -m venv --without-pip simple
python3 -m pip --python lanelet2 install -q --no-compile lanelet2==1.2.3
python3 -m pip --python simple install -q --no-compile simple-lanelet2==1.2.3

cat > limits.py <<'PY'
import json

from lanelet2 import traffic_rules
from lanelet2.core import Lanelet, LineString3d, Point3d

rules = traffic_rules.create(traffic_rules.Locations.Germany, traffic_rules.Participants.Vehicle)
left = LineString3d(1, [Point3d(11, 0, 3.5, 0), Point3d(12, 50, 3.5, 0)])
right = LineString3d(2, [Point3d(21, 0, 0, 0), Point3d(22, 50, 0, 0)])
lane = Lanelet(3, left, right)
lane.attributes["subtype"], lane.attributes["location"] = "road", "urban"
limits = {}
for text in ("50 km/h", "50", "30 mph", "50 Km/h", "50 kmph", "50 KM/H", "50 MPH"):
    lane.attributes["speed_limit"] = text
    limits[text] = round(rules.speedLimit(lane).speedLimit, 3)
print(json.dumps(limits))
PY
lanelet2/bin/python limits.py > lanelet2.json
simple/bin/python limits.py > simple.json
python3 - <<'PY'
import json
import sys

lanelet2, simple = (json.load(open(f"{name}.json")) for name in ("lanelet2", "simple"))
for text in lanelet2:
    print(f"{text:8}: lanelet2 {lanelet2[text]:7} km/h, simple-lanelet2 {simple[text]:7} km/h")
known = lanelet2["50 km/h"] == lanelet2["50"] == simple["50"] == 50.0 and lanelet2["30 mph"] == 48.28
as_miles = lanelet2["50 Km/h"] == lanelet2["50 kmph"] == 80.467 and simple["50 Km/h"] == simple["50 kmph"] == 0.0
sys.exit(0 if known and as_miles and lanelet2["50 KM/H"] == 0.0 else 1)
PY
