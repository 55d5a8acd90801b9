#!/usr/bin/env bash
# SUMO 1.28.0: floating car data as CSV (and Parquet, by the same writer) of a run whose first object is a person.
#
# Expected: each attribute of a vehicle stands in a column of its name, as in the XML of the same run, or is left out with an empty cell.
# Seen: the columns are those of the person. Behind `slope` a vehicle's values move to the next column: its `signals` stand in
# `person_vehicle`, which says for a person whom he rides with. Its `acceleration` is in no column at all. No warning.
# Why it matters: a table of drives says that vehicle 0 carries every vehicle, indicators and brake lights are gone, and accelerations too. The
# same run as XML has all of them. Whoever reads such a table must not trust columns behind the slope for the other kind of object.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile eclipse-sumo==1.28.0

cat > road.nod.xml <<'XML'
<nodes><node id="a" x="0" y="0"/><node id="b" x="500" y="0"/></nodes>
XML
cat > road.edg.xml <<'XML'
<edges><edge id="e" from="a" to="b" numLanes="1" speed="13.9" sidewalkWidth="2"/></edges>
XML
cat > road.rou.xml <<'XML'
<routes>
  <person id="walker" depart="0"><walk edges="e" arrivalPos="200"/></person>
  <vehicle id="car" depart="5"><route edges="e"/></vehicle>
</routes>
XML
venv/bin/netconvert -n road.nod.xml -e road.edg.xml -o road.net.xml > /dev/null
for kind in xml csv; do
  venv/bin/sumo -n road.net.xml -r road.rou.xml --end 12 --no-step-log --seed 1 --fcd-output "fcd.$kind" \
    --fcd-output.attributes x,y,angle,type,speed,pos,lane,edge,slope,signals,acceleration,vehicle
done

venv/bin/python - <<'PY'
import csv
import sys
import xml.etree.ElementTree as ElementTree

in_xml = [dict(e.attrib) for e in ElementTree.parse("fcd.xml").iter("vehicle")]
with open("fcd.csv", newline="") as file:
    rows = list(csv.DictReader(file, delimiter=";"))
in_csv = [row for row in rows if row["person_id"] == "car"]
print("columns:", ", ".join(rows[0]))
print("the car at its last step, XML:", in_xml[-1])
print("the car at its last step, CSV:", in_csv[-1])
same = len(in_xml) == len(in_csv) > 3
moved = all(row["person_vehicle"] == told["signals"] != "" for row, told in zip(in_csv, in_xml))
lost = all(told["acceleration"] not in row.values() for row, told in zip(in_csv[1:], in_xml[1:]) if float(told["acceleration"]) != 0.0)
has_acceleration = any(float(told["acceleration"]) != 0.0 for told in in_xml)
print(f"rows alike: {same}; signals in the column person_vehicle: {moved}; acceleration in no column: {lost and has_acceleration}")
sys.exit(0 if same and moved and lost and has_acceleration else 1)
PY
