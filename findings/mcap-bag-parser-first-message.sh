#!/usr/bin/env bash
# mcap-bag-parser 0.3.1: a topic with a list of objects, as a pandas table.
#
# Expected: every object of every message is in the table, or the loss is said.
# Seen: `topic_to_dataframe` makes the columns of the first message's objects: whoever comes later in the list is in no row. If the first list is empty,
# the table has no objects at all. `parse_mcap_file` (and `to_dataframe`) has them, but of a list of more than 100 objects it has none,
# while the row and its other values are there.
# Why it matters: a recording mostly begins before anybody comes near. The pedestrian 8 m ahead is not in the table, and a crowded square is empty.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile mcap-bag-parser==0.3.1 mcap==1.6.0 mcap-ros2-support==0.6.0 pandas==3.1.1 numpy==2.4.6 rosbags==0.11.9

venv/bin/python - <<'PY'
import contextlib
import io
import sys

from mcap.writer import Writer
from mcap_bag import BagFileParser, parse_mcap_file
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

KIND, TEXT, OBJECT = "drive_msgs/msg/Objects", "drive_msgs/Object[] objects\nfloat64 ego_speed", "int32 id\nfloat64 distance"
store = get_typestore(Stores.ROS2_HUMBLE)
store.register(get_types_from_msg(OBJECT, "drive_msgs/msg/Object"))
store.register(get_types_from_msg(TEXT, KIND))
schema_text = f"{TEXT}\n{'=' * 80}\nMSG: drive_msgs/Object\n{OBJECT}"


def write(path, frames):
    with open(path, "wb") as stream:
        writer = Writer(stream)
        writer.start(profile="ros2")
        channel = writer.register_channel("/objects", "cdr", writer.register_schema(KIND, "ros2msg", schema_text.encode()))
        for step, distances in enumerate(frames):
            objects = [store.types["drive_msgs/msg/Object"](id=n, distance=distance) for n, distance in enumerate(distances)]
            message = store.types[KIND](objects=objects, ego_speed=10.0)
            writer.add_message(channel, step, bytes(store.serialize_cdr(message, KIND)), step)
        writer.finish()


def objects_by_row(table):
    columns = [name for name in table.columns if name.endswith(".distance")]
    return [int(n) for n in table[columns].notna().sum(axis=1)]


def seen(path):
    with contextlib.redirect_stdout(io.StringIO()):
        return objects_by_row(BagFileParser(path).topic_to_dataframe("/objects")), objects_by_row(parse_mcap_file(path)["/objects"])


write("far.mcap", [[80.0], [78.0, 8.0], [76.0, 4.0]])
write("nobody.mcap", [[], [8.0], [4.0]])
write("square.mcap", [[float(n) for n in range(100)], [float(n) for n in range(101)]])
far, nobody, square = seen("far.mcap"), seen("nobody.mcap"), seen("square.mcap")
print("objects in each row: written, topic_to_dataframe, parse_mcap_file")
print("  [1, 2, 2]", *far)
print("  [0, 1, 1]", *nobody)
print("  [100, 101]", *square)
lost = far[0] == [1, 1, 1] and nobody[0] == [0, 0, 0] and far[1] == [1, 2, 2] and nobody[1] == [0, 1, 1] and square[1] == [100, 0]
print("lost without a word:", lost)
sys.exit(0 if lost else 1)
PY
