"""The case study's road and its three logs: left-hand traffic that nobody wrote down."""

from __future__ import annotations

import csv
import math
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import shapely

from drivelint.formats import load_map, read_source
from tests.formats.opendrive.xodr import checks, lanelets, points
from tests.shared_data import shared

if TYPE_CHECKING:
    from drivelint.road.map_reader import MapTables

REGISTRATION = (2.618, 3.113)
Bounds = dict[str, np.ndarray]


@cache
def road(offset: tuple[float, float] = (0.0, 0.0)) -> MapTables:
    return load_map(read_source(shared("overtake_case_study/t_junction.xodr")), offset=offset)


@cache
def areas(offset: tuple[float, float] = (0.0, 0.0)) -> dict[str, shapely.Polygon]:
    drivable = {name for name, lane in lanelets(road(offset)).items() if lane["drivable"]}
    return {
        name: shapely.Polygon(
            [(p["left_x_m"], p["left_y_m"]) for p in line] + [(p["right_x_m"], p["right_y_m"]) for p in line[::-1]]
        )
        for name, line in points(road(offset)).items()
        if name in drivable
    }


@cache
def authors() -> dict[str, Bounds]:
    found: dict[str, dict[str, list[tuple[float, float]]]] = {}
    with shared("overtake_case_study/lanelet_bounds.csv").open(encoding="utf-8") as file:
        for name, side, x, y in list(csv.reader(file, skipinitialspace=True))[1:]:
            found.setdefault(name, {}).setdefault(side, []).append((float(x), float(y)))
    return {name: {side: np.array(line) for side, line in sides.items()} for name, sides in found.items()}


def like(name: str) -> str:
    """Return our lanelet that covers most of one of the authors'."""
    bounds = authors()[name]
    theirs = shapely.Polygon(np.concatenate([bounds["leftBound"], bounds["rightBound"][::-1]]))
    return max(areas(), key=lambda i: areas()[i].intersection(theirs).area)


def log(run: str, agent: int) -> list[tuple[float, float, float, float, float]]:
    """Return time, x, y, yaw, speed in the map's right-handed frame."""
    found = []
    with shared(f"overtake_case_study/{run}.csv").open(encoding="utf-8") as file:
        reader: Any = csv.reader(file, skipinitialspace=True)
        head = [column.strip() for column in next(reader)]
        for row in reader:
            values = dict(zip(head, row, strict=False))
            if values.get("agentNo", "").strip() == str(agent):
                t, x, y, yaw, speed = (float(values[k]) for k in ("time", "x", "y", "yaw", "speed"))
                found.append((t, x, -y, -yaw, speed))
    return found


def test_left_hand_traffic_is_voted_by_the_junctions() -> None:
    assert (road().handedness, road().handedness_source) == ("lht", "junctions")
    assert "handedness_disagrees" not in checks(road())


@pytest.mark.parametrize(("theirs", "ours"), [("117", "3.0.1"), ("114", "3.0.-1")])
def test_bounds_are_those_that_the_authors_derived(theirs: str, ours: str) -> None:
    assert like(theirs) == ours
    sides = authors()[theirs]
    line = points(road())[ours]
    mine = {s: shapely.LineString([(p[f"{s}_x_m"], p[f"{s}_y_m"]) for p in line]) for s in ("left", "right")}
    # the authors' bounds run against the direction of travel, so their left is the driver's right
    for side, other in (("leftBound", "right"), ("rightBound", "left")):
        assert np.max(mine[other].distance(shapely.points(sides[side]))) < 0.02
        start, end = shapely.Point(sides[side][0]), shapely.Point(sides[side][-1])
        assert mine[other].project(start) > mine[other].project(end)


@pytest.mark.ci
@pytest.mark.parametrize("run", ["safe", "near_miss", "collision"])
def test_logs_drive_on_lanes_in_their_direction(run: str) -> None:
    lines = points(road(REGISTRATION))
    judged = {1: 0, 3: 0}
    for agent in judged:
        for _, x, y, yaw, speed in log(run, agent):
            here = [
                name for name, area in areas(REGISTRATION).items() if area.buffer(1e-6).contains(shapely.Point(x, y))
            ]
            assert here, (run, agent, x, y)
            if speed < 3.0:
                continue
            judged[agent] += 1
            cosines = []
            for name in here:
                p = min(lines[name], key=lambda q: math.hypot(q["x_m"] - x, q["y_m"] - y))
                cosines.append(p["tx"] * math.cos(yaw) + p["ty"] * math.sin(yaw))
            # the ego overtakes on the lane of the other direction; whoever is on its own side goes with it
            if agent == 3 or like("114") not in here:
                assert max(cosines) > 0.7
            else:
                assert min(cosines) < -0.7
    assert min(judged.values()) > 50


@pytest.mark.parametrize("run", ["safe", "near_miss", "collision"])
def test_the_ego_starts_in_117_and_pulls_out_into_114(run: str) -> None:
    own, other = areas(REGISTRATION)[like("117")], areas(REGISTRATION)[like("114")]
    inside = [
        (t, own.contains(shapely.Point(x, y)), other.contains(shapely.Point(x, y))) for t, x, y, _, _ in log(run, 1)
    ]
    assert all(own_lane for t, own_lane, _ in inside if t < 8.0)
    assert any(overtaking for t, _, overtaking in inside if 8.3 < t < 14.0)
    assert own.contains(shapely.Point(*log(run, 2)[-1][1:3]))  # the parked vehicle's centre stands in it
