#!/usr/bin/env bash
# python-can 4.6.1: the begin of a log in Vector's text format (ASC), as `Logger` and `can_logconvert` write it and `LogReader` reads it with `relative_timestamp=False`.
#
# Expected: the same times. The writer notes the begin of the log to the millisecond and each frame's time from there on; the reader adds both.
# Seen, without a word:
#   1. The writer leaves out the zeros in front of the milliseconds (`FORMAT_DATE.format(msec)` in can/io/asc.py): a begin at 12:00:00.099 is written as "12:00:00.99", which
#      the reader takes for 0.990 s, as any reader of a fraction would. All frames are 0.891 s late. One begin in ten is wrong, by 0.09 to 0.891 s, 0.49 s in the mean.
#   2. A log whose header says "timestamps relative" has the time since the line before in each line (asc2log of can-utils sums them up). The reader knows the word, keeps it in
#      `timestamps_format` and does not use it: one second of a drive at 100 frames a second lasts 10 ms, all frames but the first at one time.
# Why it matters: two buses recorded side by side, begun 1 ms apart, can be 0.89 s apart; at 20 m/s the radar's object is 18 m from where the camera has it. Within each log
# all differences are right, and nine of ten logs are right, so a test with one file finds nothing.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile --no-deps python-can==4.6.1 packaging==26.4 typing_extensions==4.16.0 wrapt==1.17.3

cat >seen.py <<'PY'
import subprocess
import sys
from pathlib import Path

import can

BEGIN, COUNT, STEP, SPEED = 1_793_534_400, 101, 0.01, 20.0


def record(name, milliseconds):
    with can.Logger(name) as log:
        for number in range(COUNT):
            time = BEGIN + milliseconds / 1000 + number * STEP
            log(can.Message(timestamp=time, arbitration_id=0x100, is_extended_id=False, data=bytes(8), channel=0))


def times(name):
    with can.LogReader(name, relative_timestamp=False) as log:
        return [message.timestamp for message in log]


def late(name, milliseconds):
    errors = [time - BEGIN - milliseconds / 1000 - number * STEP for number, time in enumerate(times(name))]
    assert len(errors) == COUNT and max(errors) - min(errors) < 1e-5
    return round(errors[0], 3) + 0.0


same = True
for milliseconds, error in ((0, 0.0), (5, 0.495), (23, 0.207), (99, 0.891), (100, 0.0), (437, 0.0)):
    record("bus.asc", milliseconds)
    line = Path("bus.asc").read_text().splitlines()[3]
    delay = late("bus.asc", milliseconds)
    print(f"begun at {milliseconds / 1000:.3f} s: {line!r}, all frames {delay:.3f} s late, {delay * SPEED:.1f} m at {SPEED:.0f} m/s")
    same &= abs(delay - error) < 0.002

record("bus.blf", 23)
subprocess.run([sys.executable, "-m", "can.logconvert", "bus.blf", "converted.asc"], check=True)
delay = late("converted.asc", 23)
print(f"a BLF log of {times('bus.blf')[0] - BEGIN:.3f} s, converted: {delay:.3f} s late")
same &= abs(delay - 0.207) < 0.002

record("left.asc", 99)
record("right.asc", 100)
apart = times("left.asc")[0] - times("right.asc")[0]
print(f"two buses, the left begun 0.001 s before the right: {apart:.3f} s behind it")
same &= abs(apart - 0.89) < 0.002

errors = []
for milliseconds in range(1000):
    fraction = str(milliseconds)
    errors.append(int(fraction.ljust(3, "0")) - milliseconds)
wrong = [error for error in errors if error]
print(f"of 1000 begins {len(wrong)} are wrong, by {min(wrong)} to {max(wrong)} ms, {sum(wrong) / len(wrong):.0f} ms in the mean")
same &= len(wrong) == 99 and min(wrong) == 90 and max(wrong) == 891

lines = ["date Sun Nov 1 12:00:00.437 2026", "base hex  timestamps relative", "no internal events logged", "Begin Triggerblock Sun Nov 1 12:00:00.437 2026"]
lines += [f"   {STEP if number else 0:.6f} 1  100             Rx   d 8 00 00 00 00 00 00 00 00" for number in range(COUNT)]
Path("steps.asc").write_text("\n".join([*lines, "End TriggerBlock", ""]))
reader = can.ASCReader("steps.asc")
stamps = [message.timestamp for message in reader]
print(f"timestamps {reader.timestamps_format}: {len(stamps)} frames over {(COUNT - 1) * STEP:.2f} s in {max(stamps) - min(stamps):.2f} s, at {len(set(stamps))} times")
same &= reader.timestamps_format == "relative" and len(stamps) == COUNT and set(stamps) == {0.0, STEP}
sys.exit(0 if same else "changed: times of ASC logs")
PY
TZ=UTC venv/bin/python seen.py
