#!/usr/bin/env bash
# pybag-sdk 0.13.0: a ROS 2 message with an empty `float64[]` before smaller fields, in an MCAP file whose messages rosbags 0.11.9 wrote.
#
# Expected: the values that were written, as mcap-ros2-support 0.6.0 gives them.
# Seen: pybag skips to the next multiple of eight behind the length, also if no element follows that would need it. The fields behind an empty sequence
# are read four bytes too late: the lane is the number of vehicles, the number of vehicles is 0. With one
# element all is right. Where fewer bytes follow, it raises an error about the size of the buffer.
# Why it matters: a list is empty just when nobody is near. The drive's messages with traffic are right, and those on a free road have the wrong lane.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile pybag-sdk==0.13.0 mcap==1.6.0 mcap-ros2-support==0.6.0 rosbags==0.11.9 numpy==2.4.6

venv/bin/python - <<'PY'
import sys

import numpy as np
from mcap.reader import make_reader
from mcap.writer import Writer
from mcap_ros2.decoder import DecoderFactory
from pybag.mcap_reader import McapFileReader
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

KIND = "drive_msgs/msg/Traffic"
TEXT = "float64[] gaps\nint32 lane\nint32 vehicles\nfloat64 speed"
store = get_typestore(Stores.ROS2_HUMBLE)
store.register(get_types_from_msg(TEXT, KIND))
written = [([12.5], 2, 1, 20.0), ([], 2, 7, 20.0)]
with open("drive.mcap", "wb") as stream:
    writer = Writer(stream)
    writer.start(profile="ros2")
    channel = writer.register_channel("/traffic", "cdr", writer.register_schema(KIND, "ros2msg", TEXT.encode()))
    for t_ns, (gaps, lane, vehicles, speed) in enumerate(written):
        message = store.types[KIND](gaps=np.array(gaps, dtype=np.float64), lane=lane, vehicles=vehicles, speed=speed)
        writer.add_message(channel, t_ns, bytes(store.serialize_cdr(message, KIND)), t_ns)
    writer.finish()


def values(message):
    return [float(gap) for gap in message.gaps], message.lane, message.vehicles, message.speed


with open("drive.mcap", "rb") as stream:
    by_mcap = [values(message) for *_, message in make_reader(stream, decoder_factories=[DecoderFactory()]).iter_decoded_messages()]
with McapFileReader.from_file("drive.mcap") as reader:
    by_pybag = [values(message.data) for message in reader.messages("/traffic")]
print("gaps, lane, vehicles, speed")
for name, messages in (("written", written), ("mcap-ros2-support", by_mcap), ("pybag", by_pybag)):
    print(f"  {name:18}", messages)
late = by_pybag == [written[0], ([], 7, 0, 20.0)]
print("pybag reads the fields behind an empty sequence four bytes late:", late)
sys.exit(0 if late and by_mcap == written else 1)
PY
