#!/usr/bin/env bash
# PyMEOS 1.3.0 (MobilityDB's types for moving objects): a drive at 20 m/s that is asked for its place at a Python `datetime`.
#
# Expected: `value_at_timestamp` 3.9 s after the begin is 78 m; what the type knows is microseconds, and text such as '00:00:03.9' has them.
# Seen, without a word:
#   1. Every `datetime` is cut to its whole second on the way in: 3.9 s gives 60 m, and so do 3.0 s and 3.3 s. `at` and `TsTzSpan` do the same: the stretch from 0.5 s to
#      3.5 s has the way from 0 to 3 s.
#   2. What comes out is exact, so a drive does not have its own samples: asked for the time of a sample at 1.25 s, `at` gives the place at 1.0 s, and for the first, at 0.25 s,
#      nothing, as the drive has not begun at 0 s.
#   3. Text has its microseconds, also as `TGeomPointInst(point=...)`. A speed, `TFloatInst(value=..., timestamp=...)`, is cut: one value per second is up to one second early.
#   4. A `timedelta` keeps its microseconds: `shift_time` by half a second and `scale_time` are right.
# Why it matters: a pose that is looked up for a detection lies up to a second, 20 m, behind, and 10 m in the mean; a test with whole seconds passes. Steps of 0.1 s raise an
# error when they are put together, steps of 1 s do not. Its issue 76 has the case that raises.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile --no-deps pymeos==1.3.0 pymeos-cffi==1.3.0 cffi==2.1.1 pycparser==3.12 python-dateutil==4.0.0 shapely==2.2.0 numpy==2.4.6

cat >seen.py <<'PY'
import sys
from datetime import UTC, datetime, timedelta

from pymeos import TFloatInst, TFloatSeq, TGeomPointInst, TGeomPointSeq, TsTzSpan, pymeos_initialize
from pymeos_cffi import MeosInvalidArgValueError

pymeos_initialize()
BEGIN = datetime(2026, 11, 1, tzinfo=UTC)
SPEED = 20.0


def after(seconds):
    return BEGIN + timedelta(seconds=seconds)


def second(moment):
    return round((moment - BEGIN).total_seconds(), 6)


drive = TGeomPointSeq(f"[POINT(0 0)@{after(0).isoformat(sep=' ')}, POINT(200 0)@{after(10).isoformat(sep=' ')}]")
places = {}
for seconds in (3.0, 3.3, 3.9, 4.0):
    places[seconds] = (drive.value_at_timestamp(after(seconds)).x, drive.at(after(seconds)).start_value().x)
    print(f"{seconds} s: value_at_timestamp {places[seconds][0]:.0f} m, at {places[seconds][1]:.0f} m, by the speed {SPEED * seconds:.0f} m")
span = TsTzSpan(lower=after(0.5), upper=after(3.5))
stretch = drive.at(span)
way = (stretch.start_value().x, stretch.end_value().x)
print(f"span from 0.5 s to 3.5 s: {second(span.lower())} s to {second(span.upper())} s, {way[0]:.0f} m to {way[1]:.0f} m")

bend = TGeomPointSeq("[" + ", ".join(f"POINT({20 * n} {n % 2})@{after(0.25 + n).isoformat(sep=' ')}" for n in range(4)) + "]")
sample = bend.timestamps()[1]
back = bend.at(sample)
print(f"a drive with a sample at {second(sample)} s of (20, 1) m, asked for it: {back}")
begin = bend.at(bend.timestamps()[0])
print(f"asked for its first sample, at {second(bend.timestamps()[0])} s: {begin}")

exact = second(TGeomPointInst(point="POINT(1 2)", timestamp=after(0.75)).timestamp())
cut = second(TFloatInst(value=20.0, timestamp=after(0.75)).timestamp())
print(f"an instant at 0.75 s: {exact} s of a point as text, {cut} s of a speed")
slow = TFloatSeq(instant_list=[TFloatInst(value=float(n % 2), timestamp=after(0.9 + n)) for n in range(3)])
moved = [second(moment) for moment in slow.timestamps()]
print(f"speeds at 0.9 s, 1.9 s and 2.9 s are at {moved}")
try:
    TFloatSeq(instant_list=[TFloatInst(value=float(n), timestamp=after(0.1 * n)) for n in range(3)])
    raises = False
except MeosInvalidArgValueError as error:
    raises = True
    print(f"speeds at 0 s, 0.1 s and 0.2 s: {error}")
shifted, scaled = drive.shift_time(timedelta(seconds=0.5)), drive.scale_time(timedelta(seconds=2.5))
lengths = (second(shifted.start_timestamp()), second(scaled.end_timestamp()))
print(f"moved by 0.5 s it begins at {lengths[0]} s; scaled to 2.5 s it ends at {lengths[1]} s")

same = places == {3.0: (60.0, 60.0), 3.3: (60.0, 60.0), 3.9: (60.0, 60.0), 4.0: (80.0, 80.0)}
same &= (second(span.lower()), second(span.upper())) == (0.0, 3.0) and way == (0.0, 60.0)
same &= second(sample) == 1.25 and second(back.start_timestamp()) == 1.0 and begin is None
same &= (exact, cut, moved, raises, lengths) == (0.75, 0.0, [0.0, 1.0, 2.0], True, (0.5, 2.5))
sys.exit(0 if same else "changed: times between whole seconds")
PY
venv/bin/python seen.py
