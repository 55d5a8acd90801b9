"""Logical lanes of OSI traces: turned into the direction of travel, cut to their span, beside and after each other."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import shapely

from drivelint.drive.trace import IngestOptions
from drivelint.errors import MapError
from drivelint.formats import load_map, read_trace
from drivelint.road.map_reader import MapSource, MapTables
from tests.formats.maps import hand, lanelet, lanelets, links, points, values
from tests.formats.osi.osi_road import AHEAD, BACK, BOTH, Road, two_way
from tests.shared_data import shared


def problems(environment: MapTables) -> dict[str, str]:
    return dict(values(environment, "map_quality", "lanelet_id message", severity="error"))


def test_lanes_run_in_the_direction_of_travel() -> None:
    environment = two_way(z=7.0).load(offset=(1000.0, 0.0))
    assert values(environment, "lanelet", "lanelet_id lane_type drivable width_m length_m", digits=3) == [
        ("1", "driving", True, 3.5, 100.0), ("2", "driving", True, 3.5, 100.0), ("3", "sidewalk", False, 1.5, 100.0),
    ]  # fmt: skip
    beside = "left_id left_against right_id right_against"
    assert lanelet(environment, "1", beside) == ("2", True, "3", False)
    assert lanelet(environment, "2", beside) == ("1", True, None, None)
    assert hand(environment) == ("rht", "lanes")
    first = values(environment, "lane_point", "lanelet_id x_m y_m z_m tx left_y_m right_y_m", k=0)
    assert first[:2] == [("1", 1000.0, -1.75, 7.0, 1.0, 0.0, -3.5), ("2", 1100.0, 1.75, 7.0, -1.0, 0.0, 3.5)]
    assert not problems(environment)


def test_the_nearer_line_of_a_double_one_is_named_first() -> None:
    """Between the lanes there is a broken line on the right of the reference line and a solid one on its left."""
    assert values(two_way().load(), "lane_boundary", "lanelet_id side marking lane_change") == [
        ("1", "left", "broken_solid", "decrease"), ("1", "right", "curb", "none"), ("2", "left", "solid_broken", "decrease"),
        ("2", "right", "solid", None), ("3", "left", "curb", "none"), ("3", "right", "none", None),
    ]  # fmt: skip


@pytest.mark.parametrize(("physical", "expected"), [((), None), ((5,), None), ((61,), "solid"), ((61, 5), None)])
def test_a_marking_that_is_not_in_the_log_is_not_known(physical: tuple[int, ...], expected: str | None) -> None:
    """A road without any reference to markings says nothing of them."""
    road = Road()
    road.bound(61, [(0.0, 0.0), (100.0, 0.0)], 3)
    road.edge(11, 1.75, physical=physical)
    road.edge(12, -1.75, physical=physical)
    road.logical(1, [11], [12])
    assert set(values(road.load(), "lane_boundary", "marking")) == {expected}


@pytest.mark.parametrize("way", [AHEAD, BACK])
def test_lanes_are_cut_to_their_span_and_markings_change_on_the_way(way: int) -> None:
    road = Road()
    road.bound(61, [(0.0, 0.0), (100.0, 0.0)], 3)
    road.bound(62, [(0.0, 0.0), (100.0, 0.0)], 4)
    road.edge(11, 1.75, 0.0, 40.0, physical=[61])
    road.edge(12, 1.75, 40.0, 100.0, physical=[62])
    road.edge(13, -1.75, physical=[61])
    road.logical(1, [11, 12], [13], way, span=(20.0, 70.0))
    environment = road.load(handedness="rht")
    assert values(environment, "lanelet", "length_m") == [50.0]
    assert values(environment, "lane_point", "x_m", k=0) == [20.0 if way == AHEAD else 70.0]
    assert sorted(values(environment, "lane_boundary", "side marking s_start_m s_end_m")) == (
        [("left", "broken", 20.0, 50.0), ("left", "solid", 0.0, 20.0), ("right", "solid", 0.0, 50.0)]
        if way == AHEAD
        else [("left", "solid", 0.0, 50.0), ("right", "broken", 0.0, 30.0), ("right", "solid", 30.0, 50.0)]
    )


@pytest.mark.parametrize("by", ["the first", "the second"])
@pytest.mark.parametrize("way", [AHEAD, BACK])
def test_a_link_is_said_by_either_lane(way: int, by: str) -> None:
    road = Road()
    for k, span in enumerate(((0.0, 100.0), (100.0, 200.0))):
        road.edge(11 + 10 * k, 1.75, *span)
        road.edge(12 + 10 * k, -1.75, *span)
    road.logical(1, [11], [12], way, after=[2] if by == "the first" else [])
    road.logical(2, [21], [22], way, span=(100.0, 200.0), before=[1] if by == "the second" else [])
    assert links(road.load()) == [("1", "2") if way == AHEAD else ("2", "1")]


def test_lanes_whose_reference_lines_run_towards_each_other_are_linked() -> None:
    """The second lane's stations count from its far end: OSI calls both lanes the other's successor."""
    road = Road()
    road.edge(11, 1.75)
    road.edge(12, -1.75)
    road.logical(1, [11], [12], AHEAD, after=[2])
    road.place = lambda s, t: (200.0 - s, -t)
    road.edge(21, 1.75)
    road.edge(22, -1.75)
    road.logical(2, [21], [22], BACK, after=[1])
    environment = road.load()
    assert links(environment) == [("1", "2")]
    assert values(environment, "lane_point", "x_m left_y_m", k=0, lanelet_id="2") == [(100.0, 1.75)]


def test_lanes_on_the_area_of_an_intersection_are_in_its_junction() -> None:
    road = two_way()
    road.lane(77, [], kind=4)
    road.truth.logical_lane[0].physical_lane_reference.add().physical_lane_id.value = 77
    assert values(road.load(), "lanelet", "junction_id") == ["j77", None, None]


@pytest.mark.parametrize("way", [0, 1])
def test_a_lane_that_says_no_direction_is_left_out_and_named(way: int) -> None:
    road = two_way()
    road.truth.logical_lane[1].move_direction = way
    environment = road.load()
    assert set(lanelets(environment)) == {"1", "3"}
    assert "move_direction" in problems(environment)["2"]
    assert lanelets(environment)["1"]["left_id"] is None


def test_a_lane_driven_both_ways() -> None:
    road = two_way()
    road.truth.logical_lane[1].move_direction = BOTH
    environment = road.load()
    assert lanelet(environment, "1", "bidirectional left_against") == (False, True)
    assert lanelet(environment, "2", "bidirectional") == (True,)


@pytest.mark.parametrize(
    ("spoil", "phrase"),
    [
        (lambda road: road.truth.logical_lane[0].left_boundary_id.add(value=99), "the log lacks its left boundary 99"),
        (lambda road: road.truth.logical_lane[0].ClearField("right_boundary_id"), "no right boundary"),
        (lambda road: setattr(road.truth.logical_lane[0], "end_s", 130.0), "its boundaries extend from 0 to 100 m"),
        (lambda road: setattr(road.truth.logical_lane[0], "end_s", 0.0), "it ends at 0 m"),
        (
            lambda road: setattr(road.truth.logical_lane_boundary[2].boundary_line[2], "s_position", 1.0),
            "do not ascend",
        ),
        (lambda road: setattr(road.truth.logical_lane_boundary[2].boundary_line[2].position, "x", math.nan), "finite"),
    ],
)
def test_a_lane_without_a_shape_is_left_out_and_named(spoil: Any, phrase: str) -> None:
    road = two_way()
    spoil(road)
    environment = road.load(handedness="rht")
    assert phrase in problems(environment)["1"]
    assert "1" not in lanelets(environment)


def test_where_no_lane_can_be_driven_on_the_reason_is_told() -> None:
    road = two_way()
    for lane in road.truth.logical_lane:
        lane.move_direction = 0
    with pytest.raises(MapError, match=r"none .* 3 lanes .*; 2 of them fail because its move_direction does not state"):
        road.load()


def test_a_kerb_stone_is_no_lane() -> None:
    road = two_way()
    road.logical(4, [13], [13], 0, kind=16)
    environment = road.load()
    assert not problems(environment)
    assert "4" not in lanelets(environment)


def test_speed_limits_for_all_vehicles() -> None:
    road = two_way()
    for lane, value, unit, span, kinds in (
        (0, 50.0, 3, (0.0, 60.0), ()), (0, 30.0, 4, (60.0, 100.0), ((2, None),)), (1, 80.0, 3, (0.0, 25.0), ()),
        (1, 20.0, 3, (0.0, 100.0), ((2, 7),)),
    ):  # fmt: skip
        rule = road.truth.logical_lane[lane].traffic_rule.add()
        rule.speed_limit.speed_limit_value.value, rule.speed_limit.speed_limit_value.value_unit = value, unit
        rule.traffic_rule_validity.start_s, rule.traffic_rule_validity.end_s = span
        for kind, vehicle in kinds:
            valid = rule.traffic_rule_validity.valid_for_type.add()
            valid.type = kind
            if vehicle is not None:
                valid.vehicle_type = vehicle
    assert values(road.load(), "speed_limit", "lanelet_id s_start_m s_end_m limit_mps source") == [
        ("1", 0.0, 60.0, 13.888889, "lane"), ("1", 60.0, 100.0, 13.4112, "lane"), ("2", 75.0, 100.0, 22.222222, "lane"),
    ]  # fmt: skip


@pytest.mark.parametrize("above", [0.0, 4.0])
@pytest.mark.parametrize("has_reference", [True, False])
def test_a_physical_lane_in_the_place_of_a_logical_one_is_no_second_lane(above: float, has_reference: bool) -> None:
    """Above it, it is another road; but not where the logical lane says that it lies on it."""
    road = two_way()
    road.bound(64, [(10.0, 0.0), (90.0, 0.0)])
    road.bound(65, [(10.0, -3.5), (90.0, -3.5)])
    road.lane(70, [(10.0, -1.75), (90.0, -1.75)], left=64, right=65)
    for point in road.truth.lane[0].classification.centerline:
        point.z = above
    if has_reference:
        road.truth.logical_lane[0].physical_lane_reference.add().physical_lane_id.value = 70
    assert set(lanelets(road.load())) == ({"1", "2", "3", "70"} if above and not has_reference else {"1", "2", "3"})


def test_a_bend_keeps_its_width() -> None:
    def bend(s: float, t: float) -> tuple[float, float]:
        return (40.0 - t) * math.sin(s / 40.0), 40.0 - (40.0 - t) * math.cos(s / 40.0)

    road = Road(place=bend)
    for name, t in ((11, 1.75), (12, -1.75)):
        bound = road.truth.logical_lane_boundary.add()
        bound.id.value = name
        for s in np.linspace(0.0, 60.0, 61).tolist():
            point = bound.boundary_line.add()
            point.s_position = s
            point.position.x, point.position.y = bend(s, t)
    road.logical(1, [11], [12], span=(0.0, 60.0))
    row = lanelets(road.load())["1"]
    assert (row["width_m"], row["length_m"]) == (pytest.approx(3.5, abs=0.01), pytest.approx(60.0, abs=0.05))


def test_the_road_and_stop_lines_of_a_real_log() -> None:
    """Three logical lanes that the host drives on, and twelve short lanes with a stop line each, most of them above."""
    trace = read_trace(shared("osi/MovingHostWithStopLineVariations.mcap"), IngestOptions())
    assert trace.embedded_map is not None
    environment = load_map(MapSource("embedded", trace.embedded_map))
    rows = lanelets(environment)
    assert list(rows) == ["14", "15", "16", *(str(7000 + k) for k in range(12))]
    assert values(environment, "lanelet", "left_id right_id width_m", digits=3)[:3] == [
        (None, "15", 3.5), ("14", "16", 3.5), ("15", None, 3.5),
    ]  # fmt: skip
    shapes, ways = {}, points(environment)
    for name, way in ways.items():
        ring = [(p["left_x_m"], p["left_y_m"]) for p in way] + [(p["right_x_m"], p["right_y_m"]) for p in way[::-1]]
        shapes[name] = shapely.Polygon(ring)
    states = trace.tables["actor_state"].to_pylist()
    assert all(shapes["15"].contains(shapely.Point(r["x_m"], r["y_m"])) for r in states)
    assert values(environment, "stop_line", "stop_line_id lanelet_id lane_s_m") == [
        (str(4000 + k), str(7000 + k), pytest.approx(rows[str(7000 + k)]["length_m"] / 2, abs=0.01)) for k in range(12)
    ]
    assert {round(p["z_m"], 3) for p in ways["15"]} == {0.0}
    assert ways["7006"][-1]["z_m"] == pytest.approx(7.6, abs=0.1)
