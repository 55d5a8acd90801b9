#!/usr/bin/env bash
# omega-prime 0.3.7 (pyxodr-omega-prime 0.1.5): a map in OpenDRIVE, its lanes' left and right boundaries, their markings and their neighbours.
#
# Expected: of a straight road to the east with two lanes to each side, in right-hand traffic, a driver has the outer edge line (solid) on the right of the outer lane, a
# broken line between the lanes of one direction, and the double solid line of lane 0 on the left of the inner lane. OpenDRIVE gives a lane's `roadMark` for its outer edge.
# Seen, without a word:
#   1. A lane's outer edge is called left and its inner edge right. To a driver in right-hand traffic each is the other one; in left-hand traffic they are right.
#   2. The marking of the outer edge is given to the inner one: the broken line between two lanes is solid to the outer lane, and the double solid line between the two
#      directions is broken from both sides. The outer edge gets the lane's second `roadMark`, which is the marking from some s on, or none.
#   3. The routing graph of `Locator` calls the lane on a driver's right the left neighbour, and, to the east, the lane of oncoming traffic the right neighbour.
#   4. Lanes to the west have a centre line to the east and the lane behind them as successor; `map_to_centerline_mcap` writes them to OSI with
#      centerline_is_driving_direction true.
# Why it matters: a car that moves to the left over a broken line crosses a solid line to the right, and overtaking over the double solid line is allowed. Who reads
# the OSI map finds that everybody on one half of the road drives against the traffic.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3.11 -m venv --without-pip venv 2>/dev/null || python3 -m venv --without-pip venv
# Only what maps need; pictures, files, converters and the command line are left out.
python3 -m pip --python venv install -q --no-compile --no-deps omega-prime==0.3.7 pyxodr-omega-prime==0.1.5 betterosi==0.9.0 polars==1.44.2 \
  polars-runtime-32==1.44.2 polars-st==0.11.0 numpy==2.4.6 scipy==1.17.1 shapely==2.2.0 lxml==6.1.3 networkx==3.6.1 protobuf-py==0.6.0 protobuf-py-ext==0.6.0 \
  pyproj==3.7.2 certifi==2026.10.19.post1 strenum==0.5.0 typing-extensions==4.16.0

cat >seen.py <<'PY'
import importlib.machinery
import sys
from pathlib import Path
from types import ModuleType

LEFT_OUT = set("altair filelock joblib loguru lxd_io matplotlib mcap mcap_protobuf pandas pandera pyarrow pyogrio rich tqdm typer".split())


class Word(type):
    def __getattr__(cls, word):
        if word.startswith("__"):
            raise AttributeError(word)
        return Word(word, (), {})

    def __call__(cls, *_, **__):
        return Word("word", (), {})

    def __or__(cls, _):
        return cls


class Empty(ModuleType):
    __getattr__ = Word.__getattr__


class Finder:
    def find_spec(self, name, path=None, target=None):
        return importlib.machinery.ModuleSpec(name, self, is_package=True) if name.split(".")[0] in LEFT_OUT else None

    def create_module(self, spec):
        return Empty(spec.name)

    def exec_module(self, module):
        pass


sys.meta_path.insert(0, Finder())
import shapely
from omega_prime.locator import LaneRelation, Locator
from omega_prime.map_odr import MapOdr

WIDTH, LENGTH = 3.5, 200
MARKS = {0: "solid solid", 1: "broken", 2: "solid"}  # of the centre line, between the lanes of a direction, at the edge of the road


def opendrive(rule):
    """A straight road to the east, two lanes to each side, in two sections of 100 m."""

    def mark(number):
        return f'<roadMark sOffset="0" type="{MARKS[abs(number)]}" weight="standard" color="standard" width="0.12"/>'

    def lane(number, s):
        link = f'<{"predecessor" if s else "successor"} id="{number}"/>'
        width = f'<width sOffset="0" a="{WIDTH}" b="0" c="0" d="0"/>'
        return f'<lane id="{number}" type="driving" level="false"><link>{link}</link>{width}{mark(number)}</lane>'

    def section(s):
        centre = f'<center><lane id="0" type="none" level="false">{mark(0)}</lane></center>'
        return f'<laneSection s="{s}"><left>{lane(2, s)}{lane(1, s)}</left>{centre}<right>{lane(-1, s)}{lane(-2, s)}</right></laneSection>'

    header = '<header revMajor="1" revMinor="6" name="" version="1" date="" north="0" south="0" east="0" west="0"/>'
    line = f'<geometry s="0" x="0" y="0" hdg="0" length="{LENGTH}"><line/></geometry>'
    return (
        f'<OpenDRIVE>{header}<road name="" length="{LENGTH}" id="1" junction="-1" rule="{rule}"><link/>'
        f"<planView>{line}</planView><lanes>{section(0)}{section(LENGTH // 2)}</lanes></road></OpenDRIVE>"
    )


def to_the_east(number, rule):
    return (number < 0) == (rule == "RHT")


def truth(number, rule):
    """Where a driver's left and right lines are (y), and their markings, by the definition of OpenDRIVE."""
    lines = [(y, MARKS[round(abs(y) / WIDTH)]) for y in sorted(WIDTH * (abs(number) - step) * (1 if number > 0 else -1) for step in (0, 1))]
    return tuple(reversed(lines)) if to_the_east(number, rule) else tuple(lines)


def seen(lane):
    """The same of a lane of the map."""
    return tuple((each.polyline.coords[0][1], each.type.name) for each in (lane.left_boundary, lane.right_boundary))


def relations(road_map):
    """The neighbours in the first section and all successors, as the locator's routing graph has them."""
    locator = Locator.from_map(road_map)
    names = [locator.internal2external_laneid[number] for number in range(len(locator.all_lanes))]
    return {(names[a].lane_id, names[a].section_id, data["label"]): (names[b].lane_id, names[b].section_id) for a, b, data in locator.g.edges(data=True)}


same = True
for rule in ("RHT", "LHT"):
    Path("road.xodr").write_text(opendrive(rule))
    road_map = MapOdr.from_file("road.xodr", step_size=0.5)
    lanes = {name.lane_id: lane for name, lane in road_map.lanes.items() if name.section_id == 0}
    graph = relations(road_map)
    print(f"rule {rule}")
    for number, lane in sorted(lanes.items(), reverse=True):
        (left, left_mark), (right, right_mark) = truth(number, rule)
        (seen_left, seen_left_mark), (seen_right, seen_right_mark) = seen(lane)
        print(f"  lane {number:2} to the {'east' if to_the_east(number, rule) else 'west'}: left {left:4} ({left_mark}), right {right:4} ({right_mark});", end=" ")
        print(f"map: left {seen_left:4} ({seen_left_mark}), right {seen_right:4} ({seen_right_mark})")
        sides = (seen_left, seen_right)
        same &= sides == ((right, left) if rule == "RHT" else (left, right))
        marks = (seen_left_mark, seen_right_mark)
        same &= marks == ("UNKNOWN", {1: "DASHED_LINE", 2: "SOLID_LINE"}[abs(number)])
    neighbours = {(number, label.value): graph.get((number, 0, label), (None,))[0] for number in lanes for label in (LaneRelation.neighbour_left, LaneRelation.neighbour_right)}
    print("  neighbours:", ", ".join(f"{label} of {number} is {other}" for (number, label), other in neighbours.items() if other))
    same &= neighbours[-1, "left neighbour"] == -2 and neighbours[-1, "right neighbour"] == 1
    written = road_map.map_to_centerline_mcap().lane[: len(lanes)]
    runs_east = {number: lane.centerline.coords[0][0] < lane.centerline.coords[-1][0] for number, lane in lanes.items()}
    against = [number for number in lanes if runs_east[number] != to_the_east(number, rule)]
    flags = {lane.classification.centerline_is_driving_direction for lane in written}
    followers = {number: graph.get((number, 0, LaneRelation.successor)) for number in lanes}
    print(f"  centre line against the traffic: lanes {against}, in OSI centerline_is_driving_direction is {flags}; successors in the first section: {followers}")
    same &= flags == {True} and against == [number for number in lanes if not to_the_east(number, rule)]
    same &= all(follower == (number, 1) for number, follower in followers.items())

    if rule == "RHT":
        car = shapely.Point(50, -1.5 * WIDTH + 1.0)
        (left, _), (right, _) = truth(-2, rule)
        far = [round(each.polyline.distance(car), 3) for each in (lanes[-2].left_boundary, lanes[-2].right_boundary)]
        print(f"  a car 1 m left of the middle of lane -2: left line {left - car.y} m, right line {car.y - right} m; map: left {far[0]} m, right {far[1]} m")
        same &= far == [car.y - right, left - car.y]

SECOND = '<roadMark sOffset="50" type="broken" weight="standard" color="standard" width="0.12"/></lane>'
first = opendrive("RHT").rindex("</lane></right>", 0, opendrive("RHT").index('<laneSection s="100"'))
Path("road.xodr").write_text(opendrive("RHT")[:first] + SECOND + opendrive("RHT")[first + len("</lane>") :])
marks = {(name.lane_id, name.section_id): seen(lane) for name, lane in MapOdr.from_file("road.xodr", step_size=0.5).lanes.items()}[-2, 0]
print(f"lane -2 with a solid edge line that is broken from s = 50 m on: {marks[0][0]} {marks[0][1]}, {marks[1][0]} {marks[1][1]}")
same &= marks == ((-2 * WIDTH, "DASHED_LINE"), (-WIDTH, "SOLID_LINE"))
sys.exit(0 if same else "changed: sides, markings or directions of lanes from OpenDRIVE")
PY
venv/bin/python -W ignore seen.py 2>&1
