"""The roads of the scenes as our reader reads them: nothing to complain about, every lane where the scene says."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from drivelint.formats import load_map
from drivelint.road.map_reader import MapSource
from tests.demo import scenes
from tests.demo.line import straight
from tests.demo.opendrive import opendrive
from tests.demo.road import LANE_WIDTH_M, MPH, Handedness, Road, Sign

if TYPE_CHECKING:
    from drivelint.road.map_reader import MapTables

ROADS = {"plain": Road((straight(400.0),)), "two lanes": scenes.TWO_LANE_ROAD, "bend": scenes.BEND_ROAD, "side road": scenes.SIDE_ROAD,
         "exit": scenes.EXIT_ROAD, "country": scenes.COUNTRY_ROAD}  # fmt: skip
HANDS: tuple[Handedness, ...] = ("left", "right")


def read(road: Road) -> MapTables:
    return load_map(MapSource("road.xodr", opendrive(road, "road").encode()))


def table(environment: MapTables, name: str) -> list[dict[str, Any]]:
    rows: list[dict[str, Any]] = environment.tables[name].to_pylist()
    return rows


@pytest.mark.parametrize("hand", HANDS)
@pytest.mark.parametrize("name", ROADS)
def test_a_road_is_read_without_complaint(name: str, hand: Handedness) -> None:
    environment = read(ROADS[name].driven_on_the(hand))
    assert table(environment, "map_quality") == []
    (row,) = table(environment, "environment")
    assert row["handedness"] == {"left": "lht", "right": "rht"}[hand]
    assert row["handedness_source"] == "attribute"


@pytest.mark.parametrize("hand", HANDS)
@pytest.mark.parametrize("name", ["plain", "two lanes", "bend", "country"])
def test_lanes_lie_where_actors_drive(name: str, hand: Handedness) -> None:
    road = ROADS[name].driven_on_the(hand)
    points: dict[str, list[dict[str, Any]]] = {}
    environment = read(road)
    for point in table(environment, "lane_point"):
        points.setdefault(point["lanelet_id"], []).append(point)
    for lanelet in table(environment, "lanelet"):
        if not lanelet["drivable"]:
            continue
        number = lanelet["lane_no"] * road.nearside_factor
        assert lanelet["along_road"] == (1 if number > 0 else -1)
        mine = points[lanelet["lanelet_id"]]
        x, y, _ = road.line.at([p["road_s_m"] for p in mine], road.lane_offset(number) * road.nearside_factor)
        assert np.hypot(x - [p["x_m"] for p in mine], y - [p["y_m"] for p in mine]).max() < 0.02
        assert {round(2 * p["half_width_m"], 2) for p in mine} == {LANE_WIDTH_M}


@pytest.mark.parametrize("hand", HANDS)
def test_every_lane_of_a_junction_leads_somewhere(hand: Handedness) -> None:
    for road in (scenes.SIDE_ROAD, scenes.EXIT_ROAD):
        environment = read(road.driven_on_the(hand))
        links = [(row["from_id"], row["to_id"]) for row in table(environment, "lane_link")]
        inside = [r["lanelet_id"] for r in table(environment, "lanelet") if r["junction_id"] and r["drivable"]]
        for lanelet in inside:
            assert sum(to == lanelet for _, to in links) == 1, lanelet
            assert sum(source == lanelet for source, _ in links) == 1, lanelet
    assert len(inside) == 3  # of the exit: on, against, off


def test_the_limit_the_marking_and_the_signs_hold_from_where_they_are_said() -> None:
    road = Road(
        (straight(300.0),),
        limits_mph=((0.0, 30.0), (120.0, 40.0)),
        centre=((0.0, "broken"), (90.0, "solid")),
        signs=(Sign("exit", 50.0), Sign("stop_line", 200.0), Sign("no_overtaking", 80.0)),
    )
    for hand in HANDS:
        environment = read(road.driven_on_the(hand))
        side = road.driven_on_the(hand).nearside_factor
        own = f"1.0.{side}"
        limits = [r for r in table(environment, "speed_limit") if r["lanelet_id"] == own]
        assert [(r["s_start_m"], round(r["limit_mps"] / MPH, 6)) for r in limits] == [(0.0, 30.0), (120.0, 40.0)]
        centre = [r for r in table(environment, "lane_boundary") if r["lanelet_id"] == own and r["side"] != hand]
        assert [(r["s_start_m"], r["marking"]) for r in centre] == [(0.0, "broken"), (90.0, "solid")]
        signs = {r["kind"]: (r["lanelet_id"], r["lane_s_m"]) for r in table(environment, "traffic_signal")}
        assert signs == {
            "exit": (own, pytest.approx(50.0)),
            "no_overtaking": (own, pytest.approx(80.0)),
            "stop_line": (own, pytest.approx(200.0)),
        }
        (line,) = table(environment, "stop_line")
        assert (line["lanelet_id"], line["lane_s_m"]) == (own, pytest.approx(200.0))


def test_limits_go_on_behind_a_fork() -> None:
    road = replace(scenes.SIDE_ROAD, limits_mph=((0.0, 30.0), (155.0, 40.0)))
    limits = {
        (r["lanelet_id"], round(r["s_start_m"])): round(r["limit_mps"] / MPH)
        for r in table(read(road), "speed_limit")
        if r["lanelet_id"] in {"1.0.1", "10.0.1", "2.0.1"}
    }
    assert limits == {("1.0.1", 0): 30, ("10.0.1", 0): 30, ("10.0.1", 5): 40, ("2.0.1", 0): 40}


def test_only_a_road_with_a_fork_can_be_left() -> None:
    with pytest.raises(ValueError, match="no fork"):
        Road((straight(10.0),)).path(branch=True)
