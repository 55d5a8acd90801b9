#!/usr/bin/env bash
# asammdf 8.8.28, `extract_bus_logging`, which makes signals of the CAN frames of a measurement by a DBC file; python-can 4.6.1 records the frames, cantools 45.1.0 decodes
# them for comparison.
#
# Expected: as cantools has it. A radar sends one message for all its objects, whose first byte is the number of the object; the DBC file gives their common layout once, as
# Vector's editor writes it: `Distance m0`, and the line `SG_MUL_VAL_ 768 Distance Index 0-31;`, by which it holds for the objects 0 to 31.
# Seen, without a word:
#   1. Of four objects only number 0 has distances: `m0` alone decides, though canmatrix, by which asammdf reads the file, has the range. The distances of the others are
#      in no signal, while the signal `Index` has all their numbers.
#   2. A frame that is shorter than the DBC file says has the value 0 for what it has not: 20, 0, 20 m/s. cantools raises for such a frame. That the length of each
#      frame is recorded beside it changes nothing.
# Why it matters: whoever is not object 0 is not there. The car ahead at 12 m is lost, the nearest is 60 m away, and each rule on distance or time to collision is kept by a
# drive that closes in at 5 m/s. A speed that falls to 0 within 10 ms is an emergency brake.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile --no-deps asammdf==8.8.28 canmatrix==1.2 cantools==45.1.0 python-can==4.6.1 numpy==2.4.6 pandas==3.1.1 attrs==26.1.0 \
  bitstruct==8.24.0 chardet==7.7.0 click==8.5.1 crccheck==1.3.1 deflate==0.9.0 isal==1.9.1 lxml==6.1.3 lz4==4.4.5 numexpr==2.14.2 packaging==26.4 \
  python-dateutil==4.0.0 textparser==0.26.2 typing_extensions==4.16.0 tzdata==2026.6 wrapt==1.17.3 zstd==1.5.7.2 argparse-addons==0.12.0

cat >seen.py <<'PY'
import sys
from pathlib import Path

import can
import cantools
import numpy as np
from asammdf import MDF

FRAMES, STEP, BEGIN = 100, 0.05, 1_793_534_400.0
# Number of the object, its distance at the begin, and its speed towards the car.
OBJECTS = ((0, 60.0, 0.0), (1, 12.0, 0.5), (2, 45.0, 5.0), (3, 80.0, -2.0))


BOOK = """VERSION ""
NS_ :
BS_:
BU_: RADAR GW
BO_ 768 Object: 8 RADAR
 SG_ Index M : 0|8@1+ (1,0) [0|255] "" GW
 SG_ Distance m0 : 8|16@1+ (0.01,0) [0|655.35] "m" GW
 SG_ Closing m0 : 24|16@1- (0.01,0) [-327.68|327.67] "m/s" GW
BO_ 256 Motion: 8 GW
 SG_ YawRate : 0|16@1- (0.01,0) [-327.68|327.67] "deg/s" GW
 SG_ Speed : 32|16@1+ (0.01,0) [0|655.35] "m/s" GW
SG_MUL_VAL_ 768 Distance Index 0-31;
SG_MUL_VAL_ 768 Closing Index 0-31;
"""


def record(frames, name):
    with can.MF4Writer(name) as log:
        for time, number, data in frames:
            log.on_message_received(can.Message(timestamp=time, arbitration_id=number, is_extended_id=False, data=data, channel=0))


def signals(name):
    with MDF(name) as log:
        found = log.extract_bus_logging({"CAN": [("bus.dbc", 0)]})
        return {channel.name: found.get(channel.name) for channel in found.iter_channels()}


Path("bus.dbc").write_text(BOOK)
bus = cantools.database.load_file("bus.dbc")
message, motion = bus.get_message_by_name("Object"), bus.get_message_by_name("Motion")

frames = []
for step in range(FRAMES):
    for number, distance, closing in OBJECTS:
        values = {"Index": number, "Distance": distance - closing * step * STEP, "Closing": closing}
        frames.append((BEGIN + step * STEP + number * 0.001, 768, message.encode(values)))
record(frames, "radar.mf4")
decoded = [message.decode(data) for *_, data in frames]
found = signals("radar.mf4")
index, distances, closing = (found[name].samples for name in ("Index", "Distance", "Closing"))
print(f"objects {np.unique(index).astype(int).tolist()} in {len(index)} frames")
print(f"  cantools {len(decoded)} distances, the least {min(row['Distance'] for row in decoded):.2f} m, {max(row['Closing'] for row in decoded)} m/s at most")
print(f"  asammdf  {len(distances)} distances, the least {distances.min():.2f} m, {closing.max()} m/s at most")
same = len(decoded) == len(index) == 400 and len(distances) == 100 and set(distances) == {60.0}

whole = motion.encode({"YawRate": 1.0, "Speed": 20.0})
record([(BEGIN + step * 0.01, 256, whole[:2] if step == 2 else whole) for step in range(5)], "motion.mf4")
lengths = [message.dlc for message in can.MF4Reader("motion.mf4")]
speeds = signals("motion.mf4")["Speed"]
try:
    motion.decode(whole[:2])
    raised = "nothing"
except cantools.database.errors.DecodeError as error:
    raised = str(error)
print(f"frames of {lengths} bytes: {speeds.samples.tolist()} m/s, marked as invalid: {speeds.invalidation_bits}; cantools: {raised}")
same &= speeds.samples.tolist() == [20.0, 20.0, 0.0, 20.0, 20.0] and speeds.invalidation_bits is None and lengths == [8, 8, 2, 8, 8] and raised != "nothing"
sys.exit(0 if same else "changed: signals of frames with a range of pages, or short ones")
PY
venv/bin/python seen.py
