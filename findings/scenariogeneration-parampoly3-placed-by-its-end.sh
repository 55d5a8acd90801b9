#!/usr/bin/env bash
# scenariogeneration 0.16.7: OpenDRIVE roads of ParamPoly3 that `adjust_roads_and_lanes` places by their end, that is before the road whose place is known.
#
# Expected: road 1 is the predecessor of road 2, with contactPoint "end": its reference line ends where that of road 2 begins. It does for a road of lines, arcs
# and spirals, and for ParamPoly3 where road 1 itself is the one with a known place.
# Seen: a ParamPoly3 of 50 m begins 50 m beyond the joint instead of 50 m before it, on top of road 2 for a straight one, and ends 100 m from it. The file says
# nothing but "predecessor", the curve keeps its form and length, and there is no warning. A road of several such curves is also torn apart within itself.
# Why it matters: which roads are placed by their end follows from the order and from the one with a start point (a junction that was surveyed, say), so one and
# the same map is right or wrong by the order of `add_road`. A recorded drive on such an approach is on no lane, and one behind the joint is on two lanes.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3.11 -m venv --without-pip venv 2>/dev/null || python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile --no-deps scenariogeneration==0.16.7 numpy==2.4.6 scipy==1.17.1 pyclothoids==0.2.0 \
  xmlschema==4.3.2 elementpath==5.1.4 lxml==6.1.3

cat >seen.py <<'PY'
import math
import sys
import xml.etree.ElementTree as ElementTree

from scenariogeneration import xodr

CURVES = {
    "line": lambda: [xodr.Line(50)],
    "spiral and arc": lambda: [xodr.Spiral(0, 0.02, length=20), xodr.Arc(0.02, length=30)],
    "ParamPoly3, straight": lambda: [xodr.ParamPoly3(0, 50, 0, 0, 0, 0, 0, 0)],
    "ParamPoly3, 4 m to the left": lambda: [xodr.ParamPoly3(0, 50, 0, 0, 0, 0, 12, -8)],
    "ParamPoly3, by arc length": lambda: [xodr.ParamPoly3(0, 1, 0, 0, 0, 0, 0, 0, prange="arcLength", length=50)],
    "ParamPoly3, two of them": lambda: [xodr.ParamPoly3(0, 25, 0, 0, 0, 0, 6, -4), xodr.ParamPoly3(0, 25, 0, 0, 0, 0, 6, -4)],
}


def written(curves, known):
    """The roads 1 (these curves) and 2 (100 m straight behind it) of a file, with the place of one of them known."""
    roads = [xodr.create_road(curves(), 1, 1, 1), xodr.create_road(xodr.Line(100), 2, 1, 1)]
    roads[0].add_successor(xodr.ElementType.road, 2, xodr.ContactPoint.start)
    roads[1].add_predecessor(xodr.ElementType.road, 1, xodr.ContactPoint.end)
    roads[known - 1].planview.set_start_point(1000, 2000, 0.5)
    file = xodr.OpenDrive("roads")
    for road in roads:
        file.add_road(road)
    file.adjust_roads_and_lanes()
    file.write_xml("roads.xodr")
    return {road.get("id"): list(road.iter("geometry")) for road in ElementTree.parse("roads.xodr").iter("road")}


def place(geometry):
    return float(geometry.get("x")), float(geometry.get("y"))


def end(geometry):
    """Where a geometry of the file ends, by its own record: x, y, hdg, and the curve in the frame of these."""
    (curve,) = list(geometry)
    hdg, length = float(geometry.get("hdg")), float(geometry.get("length"))
    number = {name: float(value) for name, value in curve.attrib.items() if name != "pRange"}
    if curve.tag == "paramPoly3":
        p = 1.0 if curve.get("pRange") == "normalized" else length
        u, v = (sum(number[letter + axis] * p**power for power, letter in enumerate("abcd")) for axis in "UV")
    else:
        begin = number.get("curvStart", number.get("curvature", 0.0))
        rate = (number.get("curvEnd", begin) - begin) / length
        steps = [length * (k + 0.5) / 5000 for k in range(5000)]
        angles = [begin * s + rate * s * s / 2 for s in steps]
        u, v = (length / 5000 * sum(map(function, angles)) for function in (math.cos, math.sin))
    x, y = place(geometry)
    return x + u * math.cos(hdg) - v * math.sin(hdg), y + u * math.sin(hdg) + v * math.cos(hdg)


gaps = {}
for title, curves in CURVES.items():
    for known in (1, 2):
        roads = written(curves, known)
        (second,) = roads["2"]
        within = max((math.dist(end(a), place(b)) for a, b in zip(roads["1"], roads["1"][1:])), default=0.0)
        gaps[title, known] = (math.dist(end(roads["1"][-1]), place(second)), within)
        begin = math.dist(place(roads["1"][0]), place(second))
        print(f"{title}; road {known} known: gap at the joint {gaps[title, known][0]:.2f} m, within road 1 {within:.2f} m; road 1 begins {begin:.2f} m from the joint")
right = all(max(gap) < 0.01 for (title, known), gap in gaps.items() if known == 1 or "Param" not in title)
wrong = {title: gap for (title, known), gap in gaps.items() if known == 2 and "Param" in title}
torn = wrong["ParamPoly3, two of them"][1] > 45
sys.exit(0 if right and torn and all(gap > 45 for gap, _ in wrong.values()) else "changed: where roads of ParamPoly3 end")
PY
venv/bin/python -W always seen.py
