#!/usr/bin/env bash
# kappe 0.25.0: `kappe convert --time_start T` with a T before the recording's first message.
#
# Expected: all messages are in the converted file, as none lies before T.
# Seen: the first message is missing from some files. The later of T and the recording's begin is held in seconds as a float64, whose steps are
# 238 ns today; where that rounds up, the first message counts as too early. Exit code 0, no warning.
# Why it matters: the first message is the one that comes once: /tf_static, the map, the robot's description. In two of six drives that differ
# only in their begin by nanoseconds, the lidar has no mounting place after the conversion.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile kappe==0.25.0 mcap==1.6.0 rosbags==0.11.9

cat > drive.py <<'PY'
import subprocess
import sys

from mcap.reader import make_reader
from mcap.writer import Writer
from rosbags.typesys import Stores, get_typestore

store = get_typestore(Stores.ROS2_HUMBLE)
types = store.types
TF = "tf2_msgs/msg/TFMessage"


def transform(t_ns, parent, child):
    header = types["std_msgs/msg/Header"](types["builtin_interfaces/msg/Time"](t_ns // 10**9, t_ns % 10**9), parent)
    place = types["geometry_msgs/msg/Transform"](
        types["geometry_msgs/msg/Vector3"](1.5, 0.0, 0.0), types["geometry_msgs/msg/Quaternion"](0.0, 0.0, 0.0, 1.0)
    )
    return store.serialize_cdr(types[TF]([types["geometry_msgs/msg/TransformStamped"](header, child, place)]), TF)


def topics_of(path):
    with open(path, "rb") as file:
        return [channel.topic for _, channel, _ in make_reader(file).iter_messages()]


seen = []
for shift_ns in (0, 37_124_458, 148_495_830, 334_114_116, 593_979_316, 720_000_077):
    begin_ns = 1_700_000_000_000_000_000 + shift_ns
    with open("drive.mcap", "wb") as file:
        writer = Writer(file)
        writer.start(profile="ros2")
        schema = writer.register_schema(TF, "ros2msg", store.generate_msgdef(TF, ros_version=2)[0].encode())
        static, moving = (writer.register_channel(topic, "cdr", schema) for topic in ("/tf_static", "/tf"))
        writer.add_message(static, begin_ns, bytes(transform(begin_ns, "base_link", "lidar")), begin_ns)
        for step in range(1, 5):
            t_ns = begin_ns + step * 100_000_000
            writer.add_message(moving, t_ns, bytes(transform(t_ns, "map", "base_link")), t_ns)
        writer.finish()
    convert = ["venv/bin/kappe", "convert", "drive.mcap", "converted", "--overwrite", "true", "--time_start", "1600000000"]
    subprocess.run(convert, check=True, capture_output=True)
    before, after = topics_of("drive.mcap"), topics_of("converted/drive.mcap")
    rounds_up = begin_ns / 1e9 * 1e9 > begin_ns
    seen.append((rounds_up, "/tf_static" not in after and len(after) == len(before) - 1, after == before))
    print(f"begin {begin_ns}: {len(before)} messages, {len(after)} converted; the float64 seconds lie later: {rounds_up}")
lost = [missing for rounds_up, missing, _ in seen if rounds_up]
kept = [whole for rounds_up, _, whole in seen if not rounds_up]
print(f"first message lost in {sum(lost)} of {len(seen)} drives")
sys.exit(0 if len(lost) >= 2 and all(lost) and len(kept) >= 2 and all(kept) else 1)
PY
venv/bin/python drive.py
