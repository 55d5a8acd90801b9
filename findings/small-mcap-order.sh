#!/usr/bin/env bash
# small-mcap 0.16.0 and mcap 1.6.0: the same MCAP file, whose recorder wrote some messages after later ones, as recorders of several sensors do.
#
# Expected: messages by log time, as `mcap` gives them, or in the order of the file.
# Seen: small-mcap's `read_message` gives neither: it merges the channels of a chunk by time but takes each channel's messages as they lie, so that times go
# backwards within a topic. Where the file has the messages in order both agree.
# Why it matters: a time step of successive poses is negative, a speed by differences is nonsense, and a search "as of" a time in the rows
# fails. pymcap-cli 0.34.0 is built on small-mcap.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile mcap==1.6.0 small-mcap==0.16.0

venv/bin/python - <<'PY'
import io
import sys

import small_mcap
from mcap.reader import make_reader
from mcap.writer import Writer

BEGIN_NS, STEP_NS = 1_700_000_000_000_000_000, 100_000_000


def recording(order):
    file = io.BytesIO()
    writer = Writer(file)
    writer.start()
    channels = [writer.register_channel(topic, "json", 0) for topic in ("/lidar", "/pose")]
    for step in order:
        t_ns = BEGIN_NS + step * STEP_NS
        writer.add_message(channels[step % 2], t_ns, b'{"x": %d}' % (10 * step) + b" " * 50, t_ns)
    writer.finish()
    return file


def steps(messages):
    return [(message.log_time - BEGIN_NS) // STEP_NS for _, _, message in messages]


seen = []
for order in ([0, 3, 1, 2, 5, 4], [0, 1, 2, 3, 4, 5]):
    file = recording(order)
    file.seek(0)
    by_mcap = steps(make_reader(file).iter_messages())
    file.seek(0)
    by_small = steps(small_mcap.read_message(file))
    seen.append((by_mcap, by_small))
    print(f"written {order}: mcap {by_mcap}, small-mcap {by_small}; /pose of small-mcap: {[step for step in by_small if step % 2]}")
sorted_steps = [0, 1, 2, 3, 4, 5]
by_mcap_always = all(by_mcap == sorted_steps for by_mcap, _ in seen)
disordered = seen[0][1] == [0, 2, 3, 1, 4, 5]
in_order = seen[1][1] == sorted_steps
print(f"mcap by time: {by_mcap_always}; small-mcap backwards: {disordered}; in order where the file is: {in_order}")
sys.exit(0 if by_mcap_always and disordered and in_order else 1)
PY
