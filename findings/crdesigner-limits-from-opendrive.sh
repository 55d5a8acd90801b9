#!/usr/bin/env bash
# commonroad-scenario-designer 0.8.5: an OpenDRIVE road of three stretches of 100 m, with the limits 120, 30 and 50 km/h, as a CommonRoad map.
#
# Expected: commonroad-io's `TrafficSignInterpreter` finds 120, 30 and 50 km/h in the map, whether the limit stands at the road's type or at the lane, in km/h or in
# m/s, the unit that OpenDRIVE takes where none is given. A lane's own limit comes before the road's.
# Seen, without a word: one lanelet of 300 m with the limit of its first stretch.
#   1. By the road's type: 119.66 km/h all along (km/h times 0.277). After a stretch with "no limit" there are no limits at all.
#   2. By the lane in km/h: 120 km/h all along, and none at all if the first stretch has none. Where another lane begins at 100 m, the stretches stay apart and it is right.
#   3. By the lane in m/s, with or without the unit: none. If the road's type has 120 km/h besides, the lane of 30 km/h gets 119.66 km/h.
#   4. With 50 km/h on all three stretches and another lane beside the middle one, the second and the third have no limit: a lanelet gets a sign only if the limit is not
#      that of the lanelet before it, and none refers to the sign there. A circuit has none at all.
# Why it matters: this is the way from OpenDRIVE to CommonRoad and on to Lanelet2. Whoever drives 100 km/h through the zone of 30 keeps the limit of the converted map, and
# most lanelets of a town with one limit have none. A map of one road with one limit in km/h looks right.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3.11 -m venv --without-pip venv 2>/dev/null || python3 -m venv --without-pip venv
# Only what this way needs; windows (PyQt6) and downloads (requests) are replaced by empty modules below.
python3 -m pip --python venv install -q --no-compile --no-deps commonroad-scenario-designer==0.8.5 commonroad-io==2024.3 commonroad-clcs==2025.2.0 numpy==1.26.4 \
  scipy==1.17.1 shapely==2.0.7 lxml==6.1.3 pyproj==3.7.2 certifi omegaconf==2.4.0 antlr4-python3-runtime==4.9.3 pyyaml==6.0.4 iso3166==3.0.0 mgrs==1.6.0 pyclothoids==0.2.0

cat >seen.py <<'PY'
import math
import sys
from pathlib import Path
from types import ModuleType

for name in ("PyQt6", "PyQt6.QtCore", "requests"):
    sys.modules[name] = ModuleType(name)
for word in ("QObject", "pyqtSignal"):
    setattr(sys.modules["PyQt6.QtCore"], word, type(word, (), {"__init__": lambda self, *_, **__: None, "emit": lambda self, *_: None}))

from commonroad.scenario.traffic_sign import SupportedTrafficSignCountry
from commonroad.scenario.traffic_sign_interpreter import TrafficSignInterpreter
from crdesigner.map_conversion.opendrive.odr2cr.opendrive_conversion.network import Network
from crdesigner.map_conversion.opendrive.odr2cr.opendrive_parser.parser import parse_opendrive

STRETCHES_M = (0, 100, 200)
WIDTH = '<width sOffset="0" a="3.5" b="0" c="0" d="0"/>'


def opendrive(*roads):
    header = '<header revMajor="1" revMinor="6" name="" version="1" date="" north="0" south="0" east="0" west="0"/>'
    return f"<OpenDRIVE>{header}{''.join(roads)}</OpenDRIVE>"


def lane(number, speed, link=""):
    return f'<lane id="{number}" type="driving" level="false"><link>{link}</link>{WIDTH}{speed}</lane>'


def section(s, lanes):
    return f'<laneSection s="{s}"><center><lane id="0" type="none" level="false"/></center><right>{lanes}</right></laneSection>'


def road(types, lanes, exit_lane=False):
    """OpenDRIVE 1.6: a straight road to the east, with a lane beside the middle stretch if asked for."""
    kinds = "".join(f'<type s="{s}" type="town">{speed}</type>' for s, speed in zip(STRETCHES_M, types) if speed)
    sections = ""
    for s, speed in zip(STRETCHES_M, lanes):
        link = ('<predecessor id="-1"/>' if s else "") + ('<successor id="-1"/>' if s < STRETCHES_M[-1] else "")
        beside = lane(-2, speed) if exit_lane and s == STRETCHES_M[1] else ""
        sections += section(s, lane(-1, speed, link) + beside)
    line = '<geometry s="0" x="0" y="0" hdg="0" length="300"><line/></geometry>'
    return opendrive(f'<road name="" length="300" id="1" junction="-1">{kinds}<planView>{line}</planView><lanes>{sections}</lanes></road>')


def circuit(speed):
    """Two half circles of 150 m to the right, one behind the other."""
    radius, roads = 150 / math.pi, []
    for number, neighbour, y, course in ((1, 2, radius, 0), (2, 1, -radius, math.pi)):
        link = "".join(f'<{word} elementType="road" elementId="{neighbour}" contactPoint="{end}"/>' for word, end in (("predecessor", "end"), ("successor", "start")))
        line = f'<geometry s="0" x="0" y="{y}" hdg="{course}" length="150"><arc curvature="{-1 / radius}"/></geometry>'
        lanes = section(0, lane(-1, speed, '<predecessor id="-1"/><successor id="-1"/>'))
        roads.append(
            f'<road name="" length="150" id="{number}" junction="-1"><link>{link}</link><planView>{line}</planView><lanes>{lanes}</lanes></road>'
        )
    return opendrive(*roads)


def converted(text):
    """The map, and what says the limits of its lanelets; these are the calls of `opendrive_to_commonroad`."""
    Path("road.xodr").write_text(text)
    converter = Network()
    converter.load_opendrive(parse_opendrive(Path("road.xodr")))
    network = converter.export_commonroad_scenario().lanelet_network
    return network, TrafficSignInterpreter(SupportedTrafficSignCountry.ZAMUNDA, network)


def km_h_of(interpreter, lanelet):
    limit = interpreter.speed_limit(frozenset([lanelet.lanelet_id]))
    return None if limit is None else round(limit * 3.6, 1)


def limits(text):
    """Limit in km/h in the middle of each third of the straight road's lane, or None."""
    network, interpreter = converted(text)
    found = []
    for s in STRETCHES_M:
        (lanelet,) = (
            each for each in network.lanelets
            if each.center_vertices[0][0] < s + 50 + 1e-3 < each.center_vertices[-1][0] and abs(each.center_vertices[:, 1] + 1.75).max() < 0.1
        )  # fmt: skip
        found.append(km_h_of(interpreter, lanelet))
    return found


def limits_of_all(text):
    network, interpreter = converted(text)
    return [km_h_of(interpreter, lanelet) for lanelet in network.lanelets]


def km_h(value):
    return f'<speed sOffset="0" max="{value}" unit="km/h"/>'


def m_s(value, unit=' unit="m/s"'):
    return f'<speed sOffset="0" max="{value / 3.6:.3f}"{unit}/>'


def of_type(value):
    return f'<speed max="{value}" unit="km/h"/>' if value != "no limit" else '<speed max="no limit"/>'


NONE = ("", "", "")
LIMITS = (120, 30, 50)
seen = {
    "1. road's type, km/h": limits(road(map(of_type, LIMITS), NONE)),
    "1. no limit, 30, 50": limits(road(map(of_type, ("no limit", 30, 50)), NONE)),
    "2. lane, km/h": limits(road(NONE, map(km_h, LIMITS))),
    "2. with an exit lane": limits(road(NONE, map(km_h, LIMITS), exit_lane=True)),
    "2. none, 30, 50": limits(road(NONE, ("", km_h(30), km_h(50)))),
    "3. lane, m/s": limits(road(NONE, map(m_s, LIMITS))),
    "3. lane, no unit": limits(road(NONE, (m_s(value, "") for value in LIMITS))),
    "3. type 120, lane 30 in m/s": limits(road((of_type(120), "", ""), [m_s(30)] * 3)),
    "4. 50 all along, exit lane": limits(road(NONE, [km_h(50)] * 3, exit_lane=True)),
    "4. circuit of 50, lane": limits_of_all(circuit(km_h(50))),
    "one limit of 30, lane, km/h": limits(road((of_type(120), "", ""), [km_h(30)] * 3)),
}
for title, found in seen.items():
    print(f"{title:28}", *found)
sys.exit(
    0
    if seen
    == {
        "1. road's type, km/h": [119.7, 119.7, 119.7],
        "1. no limit, 30, 50": [None, None, None],
        "2. lane, km/h": [120.0, 120.0, 120.0],
        "2. with an exit lane": [120.0, 30.0, 50.0],
        "2. none, 30, 50": [None, None, None],
        "3. lane, m/s": [None, None, None],
        "3. lane, no unit": [None, None, None],
        "3. type 120, lane 30 in m/s": [119.7, 119.7, 119.7],
        "4. 50 all along, exit lane": [50.0, None, None],
        "4. circuit of 50, lane": [None],
        "one limit of 30, lane, km/h": [30.0, 30.0, 30.0],
    }
    else "changed: limits of the converted map"
)
PY
venv/bin/python -W ignore seen.py
