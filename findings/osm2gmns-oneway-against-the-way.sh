#!/usr/bin/env bash
# osm2gmns 1.0.1 (OpenStreetMap to GMNS, which traffic models and map matchers read): one-way streets, lanes and limits of a small town.
#
# Expected: `oneway=-1` is a street that is open against the direction in which its nodes are listed, as OpenStreetMap documents it. `lanes=3` of a street for both
# directions is three lanes in all. `maxspeed:forward` and `maxspeed:backward` are the limits of its two directions.
# Seen, without a word:
#   1. `oneway=-1` is open in the direction of its nodes, and only there: the closed direction is the open one. Its link is the same as that of `oneway=yes`.
#   2. `lanes=3` is one lane in each direction: a lane is lost. With `lanes:forward=2` besides it is right.
#   3. Limits by direction (100 and 50 km/h) are no limit; with the defaults filled in, both have 80 km/h. "30 MPH" is 30 km/h, "30 mph" is 48.
# Why it matters: a matched drive through the street goes the wrong way, or round the block, and a router sends traffic into it. Streets that are drawn against their
# traffic are few among the others, so the network looks right. How many lanes there are decides whether an overtake is in the lane of oncoming traffic.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile osm2gmns==1.0.1

cat >seen.py <<'PY'
import csv
import sys

import osm2gmns

STREETS = {
    "oneway=yes": {"oneway": "yes"},
    "oneway=-1": {"oneway": "-1"},
    "both ways": {},
    "lanes=3": {"lanes": "3"},
    "lanes=3 with lanes:forward": {"lanes": "3", "lanes:forward": "2"},
    "limits by direction": {"maxspeed:forward": "100", "maxspeed:backward": "50"},
    "30 mph": {"maxspeed": "30 mph"},
    "30 MPH": {"maxspeed": "30 MPH"},
}
nodes, ways = [], []
for row, (name, tags) in enumerate(STREETS.items()):
    west, east = 10 * row + 1, 10 * row + 2
    nodes += [f'<node id="{number}" lat="{49 + row / 100:.2f}" lon="{longitude}"/>' for number, longitude in ((west, 8.40), (east, 8.41))]
    texts = "".join(f'<tag k="{key}" v="{value}"/>' for key, value in {"highway": "primary", **tags}.items())
    ways.append(f'<way id="{row + 100}"><nd ref="{west}"/><nd ref="{east}"/>{texts}</way>')
with open("town.osm", "w") as file:
    file.write(f"<?xml version='1.0' encoding='UTF-8'?><osm version='0.6'>{''.join(nodes)}{''.join(ways)}</osm>")


def links(fill):
    """Per street its links: the direction in which they are open, lanes and limit in km/h."""
    network = osm2gmns.getNetFromFile("town.osm")
    if fill:
        osm2gmns.fillLinkAttributesWithDefaultValues(network, default_lanes=True, default_speed=True)
    osm2gmns.outputNetToCSV(network)
    with open("node.csv") as file:
        places = {node["node_id"]: float(node["x_coord"]) for node in csv.DictReader(file)}
    by_street = {}
    with open("link.csv") as file:
        for link in csv.DictReader(file):
            course = "east" if places[link["to_node_id"]] > places[link["from_node_id"]] else "west"
            by_street.setdefault(list(STREETS)[int(link["osm_way_id"]) - 100], {})[course] = (link["lanes"], link["free_speed"])
    return by_street


read, filled = links(False), links(True)
for name in STREETS:
    print(f"{name}: {read[name]}; with defaults {filled[name]}")
direction = set(read["oneway=yes"]) == set(read["oneway=-1"]) == {"east"} and set(read["both ways"]) == {"east", "west"}
lanes = [sorted(int(lane) for lane, _ in read[name].values()) for name in ("lanes=3", "lanes=3 with lanes:forward")]
limits = {name: {limit for _, limit in read[name].values()} for name in STREETS if "mph" in name.lower()}
by_direction = [{limit for _, limit in network["limits by direction"].values()} for network in (read, filled)]
print(f"lanes {lanes}, limits {limits}, by direction {by_direction}")
wrong = direction and lanes == [[1, 1], [1, 2]] and limits == {"30 mph": {"48"}, "30 MPH": {"30"}} and by_direction == [{""}, {"80"}]
sys.exit(0 if wrong else "changed: direction, lanes or limits of the network")
PY
venv/bin/python seen.py 2>log.txt || { grep -v "\.cpp:" log.txt; exit 1; }
