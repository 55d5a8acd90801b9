#!/usr/bin/env bash
# mcap 1.6.0 with the decoders mcap-ros2-support 0.6.0, mcap-protobuf-support 0.6.0 and mcap-ros2idl-support 0.2.0: one decoder factory, two files.
#
# Expected: a message is decoded as the schema of its own file says, or refused.
# Seen: each factory keeps its decoders by the schema's number, which every file begins anew at 1. The first schema of the second file is decoded as
# that of the first, without a word: a gap of 42 m is a speed of 42 m/s, and a record that only changed the order of its fields has speed and
# acceleration exchanged. The schema that the reader returns beside the message is the right one.
# Why it matters: whoever makes the factory once, before the loop over a drive's split files or a fleet's, reads all but the first file wrongly as soon as
# topics began in another order. Types of the same layout raise no error.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile mcap==1.6.0 mcap-ros2-support==0.6.0 mcap-protobuf-support==0.6.0 mcap-ros2idl-support==0.2.0

venv/bin/python - <<'PY'
import io
import struct
import sys

from google.protobuf import descriptor_pb2, descriptor_pool, message_factory
from mcap.reader import make_reader
from mcap.writer import Writer
from mcap_protobuf.decoder import DecoderFactory as Protobuf
from mcap_protobuf.writer import Writer as ProtobufWriter
from mcap_ros2.decoder import DecoderFactory as Ros2
from mcap_ros2idl_support import Ros2DecodeFactory as Ros2Idl


def ros2_file(kind, fields, *values):
    stream = io.BytesIO()
    writer = Writer(stream)
    writer.start(profile="ros2")
    schema = writer.register_schema(f"drive_msgs/msg/{kind}", "ros2msg", "\n".join(f"float64 {name}" for name in fields).encode())
    channel = writer.register_channel("/ego", "cdr", schema)
    writer.add_message(channel, 1, b"\0\1\0\0" + struct.pack("<2d", *values), 1)
    writer.finish()
    return stream.getvalue()


def protobuf_file(kind, fields, *values):
    declared = descriptor_pb2.FileDescriptorProto(name=f"{kind}.proto", package="drive", syntax="proto3")
    message = declared.message_type.add(name=kind)
    for number, name in enumerate(fields, 1):
        message.field.add(name=name, number=number, type=1, label=1)
    pool = descriptor_pool.DescriptorPool()
    pool.Add(declared)
    made = message_factory.GetMessageClass(pool.FindMessageTypeByName(f"drive.{kind}"))(**dict(zip(fields, values)))
    stream = io.BytesIO()
    writer = ProtobufWriter(stream)
    writer.write_message("/ego", made, log_time=1, publish_time=1)
    writer.finish()
    return stream.getvalue()


def as_dict(message):
    if isinstance(message, dict):
        return message
    return {name: getattr(message, name) for name in ("speed", "acceleration", "gap", "rate") if hasattr(message, name)}


drives = [
    ("Speed", ("speed", "acceleration"), 13.5, 0.25),
    ("Gap", ("gap", "rate"), 42.0, -3.0),
    ("Speed", ("acceleration", "speed"), 0.25, 13.5),
]
wrong = {"speed": 42.0, "acceleration": -3.0}
changed = True
for name, make_factory, write in (("mcap-ros2", Ros2, ros2_file), ("mcap-ros2idl", Ros2Idl, ros2_file), ("mcap-protobuf", Protobuf, protobuf_file)):
    shared, seen, alone = make_factory(), [], []
    for drive in drives:
        file = write(*drive)
        for factory, messages in ((shared, seen), (make_factory(), alone)):
            for schema, _, _, message in make_reader(io.BytesIO(file), decoder_factories=[factory]).iter_decoded_messages():
                messages.append((schema.name, as_dict(message)))
    print(name, "one factory for all files:", seen, "a factory for each:", alone, sep="\n  ")
    right = [dict(zip(fields, values)) for _, fields, *values in drives]
    seen_right = seen[0][1] == right[0] and seen[1][0].endswith("Gap")
    changed &= [message for _, message in alone] == right and seen_right and seen[1][1] == wrong and seen[2][1] == {"speed": 0.25, "acceleration": 13.5}
print("the second file is decoded by the schema of the first:", changed)
sys.exit(0 if changed else 1)
PY
