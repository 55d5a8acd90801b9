#!/usr/bin/env bash
# SUMO 1.28.0, netconvert: a motorway of OpenStreetMap with `maxspeed=none` (Germany's usual one), written as a SUMO net and as OpenDRIVE.
#
# Expected: no limit: OpenDRIVE 1.4 and later has `<speed max="no limit"/>`, or the record is left out.
# Seen: each lane has a limit of 39.44 m/s (142 km/h) in both files, in OpenDRIVE as a `<speed max="39.44"/>` without a unit like any posted limit. A
# motorway without `maxspeed` has the same limit, and `maxspeed=walk` is 1.39 m/s: nothing in the file tells these from a sign.
# Why it matters: maps for recorded drives are made from OpenStreetMap by this tool (osm-to-xodr 0.3.0 calls it). Against such a map a car at 150 km/h on a German
# motorway without a limit breaks one.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile eclipse-sumo==1.28.0

cat > road.osm <<'XML'
<osm version="0.6" generator="by hand">
<node id="1" lat="49.0000" lon="8.4000" version="1"/><node id="2" lat="49.0005" lon="8.4060" version="1"/>
<node id="3" lat="49.0100" lon="8.4000" version="1"/><node id="4" lat="49.0105" lon="8.4060" version="1"/>
<node id="5" lat="49.0200" lon="8.4000" version="1"/><node id="6" lat="49.0205" lon="8.4060" version="1"/>
<node id="7" lat="49.0300" lon="8.4000" version="1"/><node id="8" lat="49.0305" lon="8.4060" version="1"/>
<way id="10" version="1"><nd ref="1"/><nd ref="2"/><tag k="highway" v="motorway"/><tag k="oneway" v="yes"/><tag k="lanes" v="2"/><tag k="maxspeed" v="none"/></way>
<way id="11" version="1"><nd ref="3"/><nd ref="4"/><tag k="highway" v="motorway"/><tag k="oneway" v="yes"/><tag k="lanes" v="2"/><tag k="maxspeed" v="120"/></way>
<way id="12" version="1"><nd ref="5"/><nd ref="6"/><tag k="highway" v="living_street"/><tag k="oneway" v="yes"/><tag k="lanes" v="1"/><tag k="maxspeed" v="walk"/></way>
<way id="13" version="1"><nd ref="7"/><nd ref="8"/><tag k="highway" v="motorway"/><tag k="oneway" v="yes"/><tag k="lanes" v="2"/></way>
</osm>
XML
venv/bin/netconvert --osm-files road.osm -o road.net.xml --opendrive-output road.xodr

python3 - <<'PY'
import sys
import xml.etree.ElementTree as ElementTree

net = {
    edge.get("id"): {lane.get("speed") for lane in edge.iter("lane")}
    for edge in ElementTree.parse("road.net.xml").iter("edge")
    if not edge.get("id").startswith(":")
}
opendrive = sorted({tuple(sorted(speed.attrib.items())) for speed in ElementTree.parse("road.xodr").iter("speed")})
print("limits of the net, m/s, by way:", net)
print("speed records of OpenDRIVE:", opendrive)
as_limit = net["10"] == {"39.44"} and net["11"] == {"33.33"} and net["12"] == {"1.39"} and net["13"] == {"39.44"}
in_opendrive = {dict(record)["max"] for record in opendrive} >= {"39.44", "33.33", "1.39"}
sys.exit(0 if as_limit and in_opendrive else 1)
PY
