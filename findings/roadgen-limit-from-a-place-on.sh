#!/usr/bin/env bash
# roadgen 0.41.2: an OpenDRIVE map by `read_opendrive`, written as Lanelet2, SUMO and OpenDRIVE: limits of a lane that begin at a place, and lanes for some only.
#
# Expected: OpenDRIVE's `<speed sOffset="100">` holds from 100 m on. A lane of 300 m with 120 km/h, and 30 km/h from 100 m on, has both limits in what is written,
# or a line of `read_warnings` says what is lost, as its documentation promises and as it is done for a marking, a width or a type of road that changes on the way.
# Seen, with not one line of this:
#   1. The first `<speed>` of a lane holds all along: in the zone of 30 km/h the limit is 120 km/h; where a zone of 30 km/h ends at 100 m, it goes on for 200 m.
#   2. So does one that begins at 100 m: with 120 km/h of the road's type before it, the lane has 30 km/h from its beginning.
#   3. `<access>` is dropped: a lane for buses alone, or with trucks forbidden, is open to each vehicle in Lanelet2 ("participant:vehicle" = "yes") and in SUMO.
#      A lane of the type "bus", which is the older way, becomes a driving lane too, but with a line that says so.
#   With the same limits in three lane sections all is right.
# Why it matters: a drive at 100 km/h through the zone of 30 keeps the limit of the map in each of these formats, and a lawful 120 km/h breaks the one of case 2 by
# 25 m/s. Which of the two ways a map uses is the choice of its editor, and a map without a line of warning seems to be whole.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile --no-deps roadgen==0.41.2

cat >seen.py <<'PY'
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import roadgen

GEO = "<geoReference><![CDATA[+proj=tmerc +lat_0=49 +lon_0=8.4 +k=1 +x_0=0 +y_0=0 +datum=WGS84 +units=m +no_defs]]></geoReference>"


def speed(s, km_h):
    return f'<speed sOffset="{s}" max="{km_h}" unit="km/h"/>'


def lane(content, link="", kind="driving"):
    return f'<lane id="-1" type="{kind}" level="false"><link>{link}</link><width sOffset="0" a="3.5" b="0" c="0" d="0"/>{content}</lane>'


def section(s, lanes):
    return f'<laneSection s="{s}"><center><lane id="0" type="none" level="false"/></center><right>{lanes}</right></laneSection>'


def read(sections, of_type=""):
    """A straight road to the east of 300 m with one lane, as the library reads it."""
    header = f'<header revMajor="1" revMinor="6" name="" version="1" date="" north="0" south="0" east="0" west="0">{GEO}</header>'
    line = '<geometry s="0" x="0" y="0" hdg="0" length="300"><line/></geometry>'
    kind = f'<type s="0" type="town">{of_type}</type>'
    Path("road.xodr").write_text(
        f'<OpenDRIVE>{header}<road name="" length="300" id="1" junction="-1">{kind}<planView>{line}</planView><lanes>{sections}</lanes></road></OpenDRIVE>'
    )
    return roadgen.read_opendrive("road.xodr")


def notes(road_map):
    """What the library says to have lost, but for what it says of any road: a PROJ string has no altitude, SUMO no markings."""
    return [each for each in road_map.read_warnings() + road_map.sumo_warnings() if "altitude" not in each and "lane markings" not in each]


def tags(element):
    return {tag.get("k"): tag.get("v") for tag in element.iter("tag")}


def lanelets(road_map):
    """Begin and end of each lanelet in metres, with its tags."""
    road_map.export_lanelet2("road.osm")
    root = ElementTree.parse("road.osm").getroot()
    x = {node.get("id"): float(tags(node)["local_x"]) for node in root.iter("node")}
    ways = {way.get("id"): [x[node.get("ref")] for node in way.iter("nd")] for way in root.iter("way")}
    found = []
    for relation in root.iter("relation"):
        if tags(relation).get("type") == "lanelet":
            (left,) = (ways[member.get("ref")] for member in relation.iter("member") if member.get("role") == "left")
            found.append((min(left) - min(x.values()), max(left) - min(x.values()), tags(relation)))
    return sorted(found, key=lambda each: each[0])


def limits(road_map):
    """Limits in km/h at 50, 150 and 250 m in Lanelet2, and all those of SUMO's lanes and of OpenDRIVE as written again."""
    parts = lanelets(road_map)
    lanelet2 = [next(float(tag["speed_limit"]) for begin, end, tag in parts if begin < place < end) for place in (50, 150, 250)]
    sumo = [round(float(each.get("speed")) * 3.6) for each in sumo_lanes(road_map)]
    road_map.export_opendrive("again.xodr")
    again = [(float(each.get("sOffset")), round(float(each.get("max")) * 3.6)) for each in ElementTree.parse("again.xodr").iter("speed") if each.get("sOffset")]
    return lanelet2, sumo, again


def sumo_lanes(road_map):
    road_map.export_sumo("sumo")
    edges = ElementTree.parse(next(Path("sumo").glob("*.edg.xml"))).getroot().iter("edge")
    return [each for edge in edges for each in (list(edge.iter("lane")) or [edge])]


FORWARD, BACK = '<successor id="-1"/>', '<predecessor id="-1"/>'
CASES = {
    "three lane sections: 120, 30, 50": (
        section(0, lane(speed(0, 120), FORWARD)) + section(100, lane(speed(0, 30), BACK + FORWARD)) + section(200, lane(speed(0, 50), BACK)),
        "",
    ),
    "1. one section: 120, from 100 m 30, from 200 m 50": (section(0, lane(speed(0, 120) + speed(100, 30) + speed(200, 50))), ""),
    "1. one section: 30, from 100 m 120": (section(0, lane(speed(0, 30) + speed(100, 120))), ""),
    "2. road 120, lane from 100 m 30": (section(0, lane(speed(100, 30))), '<speed max="120" unit="km/h"/>'),
}
EXPECTED = [[120, 30, 50], [120, 120, 120], [30, 30, 30], [30, 30, 30]]
same = True
for (title, (sections, of_type)), expected in zip(CASES.items(), EXPECTED):
    road_map = read(sections, of_type)
    lanelet2, sumo, again = limits(road_map)
    print(f"{title}: Lanelet2 at 50, 150 and 250 m {lanelet2} km/h; SUMO {sumo}; OpenDRIVE (from m, km/h) {again}; warnings {notes(road_map)}")
    same &= lanelet2 == expected and notes(road_map) == []
    same &= [km_h for _, km_h in again] == sumo == (expected if "three" in title else expected[:1]) and all(s == 0 for s, _ in again)

for title, content, kind, warned in (
    ("3. buses alone", '<access sOffset="0" rule="allow" restriction="bus"/>', "driving", False),
    ("3. no trucks", '<access sOffset="0" rule="deny" restriction="trucks"/>', "driving", False),
    ("type bus", "", "bus", True),
):
    road_map = read(section(0, lane(content + speed(0, 50), kind=kind)))
    ((_, _, tag),) = lanelets(road_map)
    participants = {name: value for name, value in tag.items() if name.startswith("participant")}
    only = [(each.get("allow"), each.get("disallow")) for each in sumo_lanes(road_map)]
    print(f"{title}: Lanelet2 {participants}, SUMO allow and disallow {only}; warnings {notes(road_map)}")
    same &= participants == {"participant:vehicle": "yes"} and only == [(None, "pedestrian")] and bool(notes(road_map)) == warned
sys.exit(0 if same else "changed: limits and restrictions of lanes from OpenDRIVE")
PY
venv/bin/python seen.py
