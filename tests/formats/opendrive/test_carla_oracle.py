"""CARLA's own map reader as an oracle: centre lines, widths, directions, successors; only where it is installed."""

from __future__ import annotations

import math
from typing import Any

import pytest

from drivelint.formats import load_map
from drivelint.road.map_reader import MapSource
from tests.formats.opendrive.xodr import lanelets, points, rows
from tests.shared_data import shared

carla: Any = pytest.importorskip("carla", reason="the carla wheel is not installed")

# CARLA honours the rule attribute alone, so it has to be written into the case study's road
LHT = (b"<road name=", b'<road rule="LHT" name=')
MAPS = {
    "overtake_case_study/t_junction.xodr": LHT,
    "maps/Town10HD.xodr": (b"", b""),
    "maps/fabriksgatan_traffic_lights.xodr": (b"", b""),
    "maps/ut_lane_offset_intersection.xodr": (b"", b""),
    "maps/e6mini-lht.xodr": (b"", b""),
    "maps/ut_highway_exit.xodr": (b"", b""),
}


@pytest.mark.parametrize("file", MAPS)
def test_agrees_with_carla(file: str) -> None:
    content = shared(file).read_bytes()
    if MAPS[file][0]:
        content = content.replace(*MAPS[file])
    town = carla.Map("oracle", content.decode())
    environment = load_map(MapSource("oracle.xodr", content))
    lanes = lanelets(environment)
    successors: dict[str, set[str]] = {}
    for row in rows(environment, "lane_link"):
        successors.setdefault(row["from_id"], set()).add(row["to_id"])
    compared = 0
    for name, line in points(environment).items():
        lane = lanes[name]
        if lane["lane_type"] != "driving":
            continue
        for p in line[1:-1]:
            waypoint = town.get_waypoint_xodr(int(lane["road_id"]), lane["lane_no"], p["road_s_m"])
            if waypoint is None or p["half_width_m"] < 0.1:
                continue
            compared += 1
            place, yaw = waypoint.transform.location, -math.radians(waypoint.transform.rotation.yaw)
            assert math.hypot(place.x - p["x_m"], -place.y - p["y_m"]) < 0.01
            assert waypoint.lane_width == pytest.approx(2 * p["half_width_m"], abs=1e-3)
            assert math.cos(yaw) * p["tx"] + math.sin(yaw) * p["ty"] > math.cos(math.radians(8))
        if lane["length_m"] > 1.0:
            s = line[-1]["road_s_m"] - math.copysign(0.05, line[-1]["road_s_m"] - line[0]["road_s_m"])
            waypoint = town.get_waypoint_xodr(int(lane["road_id"]), lane["lane_no"], s)
            following = {f"{w.road_id}.{w.section_id}.{w.lane_id}" for w in waypoint.next(0.15)} - {name}
            assert following == {to for to in successors.get(name, set()) if lanes[to]["lane_type"] == "driving"}
    assert compared > 50
