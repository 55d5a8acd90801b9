#!/usr/bin/env bash
# PyAV 18.1.0: a camera topic of an MCAP file (`foxglove.CompressedVideo`, H.264, one picture per message) that foxglove-sdk 0.30.3 wrote.
#
# Expected: a loop over the messages with `codec.decode(packet) for packet in codec.parse(message.data)`, as one reads an H.264 stream, gives the picture of
# the message in hand: each message is a whole access unit, the stream has no B pictures.
# Seen: `parse` knows that a picture is whole when the next one begins. Each message yields the picture of the message before it, and the
# last picture never comes. `av.Packet(message.data)` without `parse` yields each at its own message.
# Why it matters: every picture gets the next message's time: 100 ms late at 10 Hz, 3 m at 30 m/s, constant, so no check of the rate sees it.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile av==18.1.0 foxglove-sdk==0.30.3 mcap==1.6.0 mcap-protobuf-support==0.6.0 numpy==2.4.6

venv/bin/python - <<'PY'
import sys
from fractions import Fraction

import av
import foxglove
import numpy as np
from foxglove.channels import CompressedVideoChannel
from foxglove.messages import CompressedVideo, Timestamp
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

BEGIN_NS, STEP_NS, COUNT = 1_700_000_000_000_000_000, 100_000_000, 20
encoder = av.CodecContext.create("libx264", "w")
encoder.width, encoder.height, encoder.pix_fmt = 64, 64, "yuv420p"
encoder.time_base, encoder.framerate = Fraction(1, 10), 10
encoder.options = {"tune": "zerolatency", "preset": "veryfast", "x264-params": "repeat-headers=1"}
units = []
for number in range(COUNT):
    picture = av.VideoFrame.from_ndarray(np.full((64, 64, 3), 20 + 10 * number, np.uint8), format="rgb24")
    picture.pts = number
    units += [bytes(packet) for packet in encoder.encode(picture)]
assert len(units) == COUNT
writer = foxglove.open_mcap("drive.mcap")
channel = CompressedVideoChannel("/camera")
for number, unit in enumerate(units):
    t_ns = BEGIN_NS + number * STEP_NS
    stamp = Timestamp(t_ns // 10**9, t_ns % 10**9)
    channel.log(CompressedVideo(timestamp=stamp, frame_id="camera", data=unit, format="h264"), log_time=t_ns)
writer.close()


def pictures(with_parse):
    """(number of the message in hand, number of the picture by its grey) of each picture."""
    decoder, pairs = av.CodecContext.create("h264", "r"), []
    with open("drive.mcap", "rb") as file:
        for schema, channel, message, video in make_reader(file, decoder_factories=[DecoderFactory()]).iter_decoded_messages():
            packets = decoder.parse(video.data) if with_parse else [av.Packet(video.data)]
            for packet in packets:
                for frame in decoder.decode(packet):
                    grey = frame.to_ndarray(format="rgb24").mean()
                    pairs.append(((message.log_time - BEGIN_NS) // STEP_NS, round((grey - 20) / 10)))
    return pairs


parsed, whole = pictures(with_parse=True), pictures(with_parse=False)
print("with parse, (message, picture):", parsed[:3], "...", parsed[-1], f"{len(parsed)} of {COUNT}")
print("one packet per message:        ", whole[:3], "...", whole[-1], f"{len(whole)} of {COUNT}")
late = parsed == [(number + 1, number) for number in range(COUNT - 1)]
sys.exit(0 if late and whole == [(number, number) for number in range(COUNT)] else 1)
PY
