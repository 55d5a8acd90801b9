#!/usr/bin/env bash
# SUMO 1.28.0, netconvert: OpenDRIVE roads whose limit stands at the road's type (<type><speed>), as ASAM OpenDRIVE 1.4 to 1.8 have it (road type, "speed"), and not
# at each lane once more.
#
# Expected: the lanes of a motorway with 120 km/h have 33.33 m/s, those of a zone with 30 km/h 8.33 m/s; a record of a lane comes before it.
# Seen: netconvert says "Success." and gives every such lane 13.89 m/s (50 km/h), the default of the lane type "driving": the motorway is slower by 70 km/h, the zone
# faster by 20 km/h. With `<lane><speed>` the same numbers arrive.
# Why it matters: a map may give the limit at the road's type only. Traffic that is simulated on such a network, and limits that are read from it for
# recorded drives, are those of no sign: a log at 100 km/h on that motorway breaks a limit, one at 45 km/h in that zone keeps it.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile eclipse-sumo==1.28.0

python3 - <<'PY'
def road(number, y, kind, limit, of_lane):
    of_road = "" if of_lane else f'<speed max="{limit}" unit="km/h"/>'
    lane = f'<speed sOffset="0" max="{limit}" unit="km/h"/>' if of_lane else ""
    return f"""<road name="{kind}" length="300" id="{number}" junction="-1">
<type s="0" type="{kind}">{of_road}</type>
<planView><geometry s="0" x="0" y="{y}" hdg="0" length="300"><line/></geometry></planView><elevationProfile/><lateralProfile/>
<lanes><laneSection s="0"><center><lane id="0" type="none" level="false"/></center><right><lane id="-1" type="driving" level="false">
<width sOffset="0" a="3.5" b="0" c="0" d="0"/>{lane}</lane></right></laneSection></lanes></road>"""

roads = [
    road(1, 0, "motorway", 120, False), road(2, 100, "lowSpeed", 30, False),
    road(3, 200, "motorway", 120, True), road(4, 300, "lowSpeed", 30, True),
]
head = '<?xml version="1.0"?><OpenDRIVE><header revMajor="1" revMinor="6" name="" version="1.00" north="0" south="0" east="0" west="0"/>'
with open("roads.xodr", "w") as file:
    file.write(head + "".join(roads) + "</OpenDRIVE>")
PY
venv/bin/netconvert --opendrive-files roads.xodr -o roads.net.xml

python3 - <<'PY'
import sys
import xml.etree.ElementTree as ElementTree

limits = {
    edge.get("id").lstrip("-").split("#")[0]: {float(lane.get("speed")) for lane in edge.iter("lane")}
    for edge in ElementTree.parse("roads.net.xml").iter("edge")
    if not edge.get("id").startswith(":")
}
for number, what in {"1": "motorway 120, of the road", "2": "zone 30, of the road", "3": "motorway 120, of the lane", "4": "zone 30, of the lane"}.items():
    print(what, "km/h:", sorted(limits[number]), "m/s")
sys.exit(0 if limits == {"1": {13.89}, "2": {13.89}, "3": {33.33}, "4": {8.33}} else 1)
PY
