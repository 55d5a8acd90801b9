#!/usr/bin/env bash
# canmatrix 1.3.3 (`canconvert`), which brings the description of a vehicle's CAN bus from one format to another; cantools 45.1.0 reads the DBC file for comparison.
#
# Expected: a message whose content depends on a page (a multiplexor: page 0 has the indicators, page 1 a temperature) has pages after a conversion, and a position of
# 32-bit floats is one; or canmatrix says what the format loses. It writes and reads each of these formats itself.
# Seen, without a word:
#   1. By way of JSON and YAML the pages are gone: all signals are in each message. A temperature of 20.5 degrees is "left indicator on, right one off", and the
#      indicators of the next message are a temperature of -39.5 degrees. It is so with `jsonExportAll`, which writes the pages: they are not read.
#   2. By way of SYM, 49.01 degrees of latitude are 1111755325: the float is read as an integer. Pages are right there, also in KCD, where the floats are, too.
# Why it matters: indicators, brake and speed of a recorded drive come from the CAN bus by such a description. The left indicator flickers with the temperature, page by
# page, so a rule finds it on at each lane change, or intermittent at each. Messages without pages are right in each format. cantools decodes the pages.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile canmatrix==1.3.3 cantools==45.1.0 lxml==6.1.3 PyYAML==6.0.4 attrs==26.1.0 click==8.5.1 bitstruct==8.24.0 \
  python-can==4.6.1

cat >bus.dbc <<'DBC'
VERSION ""
NS_ :
BS_:
BU_: ESP BCM GW
BO_ 256 Motion: 8 ESP
 SG_ Speed : 0|16@1+ (0.01,0) [0|655.35] "km/h" GW
 SG_ YawRate : 23|16@0- (0.01,0) [-327.68|327.67] "deg/s" GW
BO_ 512 Body: 8 BCM
 SG_ Page M : 0|8@1+ (1,0) [0|255] "" GW
 SG_ Left m0 : 8|1@1+ (1,0) [0|1] "" GW
 SG_ Right m0 : 9|1@1+ (1,0) [0|1] "" GW
 SG_ Temperature m1 : 8|8@1+ (0.5,-40) [-40|87] "C" GW
BO_ 768 Position: 8 GW
 SG_ Latitude : 0|32@1- (1,0) [0|0] "deg" ESP
 SG_ Longitude : 32|32@1- (1,0) [0|0] "deg" ESP
SIG_VALTYPE_ 768 Latitude : 1;
SIG_VALTYPE_ 768 Longitude : 1;
DBC
for kind in kcd json yaml sym; do
  venv/bin/canconvert bus.dbc "bus.$kind" >"$kind.log" 2>&1
done
venv/bin/canconvert --jsonExportAll bus.dbc all.json >all.log 2>&1

cat >seen.py <<'PY'
import struct
import sys

import canmatrix.formats
import cantools

FRAMES = {
    "indicators": ("Body", bytes([0, 1, 0, 0, 0, 0, 0, 0])),  # page 0, left on
    "temperature": ("Body", bytes([1, 121, 0, 0, 0, 0, 0, 0])),  # page 1, 20.5 degrees
    "position": ("Position", struct.pack("<ff", 49.01, 8.4)),
    "motion": ("Motion", bytes([0x39, 0x30, 0xFB, 0x2E, 0, 0, 0, 0])),  # 123.45 km/h, -12.34 degrees a second
}
bus = cantools.database.load_file("bus.dbc")
truth = {title: {name: round(float(value), 4) for name, value in bus.decode_message(*frame).items()} for title, frame in FRAMES.items()}
print("cantools, bus.dbc:", truth)


def decoded(path):
    """What canmatrix decodes by a description, per frame: the name of the page apart, as SYM has none for it."""
    (matrix,) = canmatrix.formats.loadp(path).values()
    values = {}
    for title, (name, data) in FRAMES.items():
        signals = matrix.frame_by_name(name).decode(data).items()
        values[title] = {("Page" if signal == "Body_MUX" else signal): round(float(value.phys_value), 4) for signal, value in signals}
    return values


seen = {path: decoded(path) for path in ("bus.dbc", "bus.kcd", "bus.json", "all.json", "bus.yaml", "bus.sym")}
for path, values in seen.items():
    print(f"canmatrix, {path}:", {title: value for title, value in values.items() if value != truth[title]} or "as cantools")
both = {
    "indicators": truth["indicators"] | {"Temperature": -39.5},
    "temperature": truth["temperature"] | {"Left": 1.0, "Right": 0.0},
}
with open("all.json") as file:
    written = '"multiplex"' in file.read()
print("all.json has the pages:", written)
pages = all(seen[path] == truth | both for path in ("bus.json", "all.json", "bus.yaml"))
floats = seen["bus.sym"] == truth | {"position": {"Latitude": 1111755325.0, "Longitude": 1090938470.0}}
right = seen["bus.dbc"] == seen["bus.kcd"] == truth
sys.exit(0 if pages and floats and right and written else "changed: pages or floats of a converted bus")
PY
venv/bin/python -W ignore seen.py
