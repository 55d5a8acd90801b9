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
from tests.formats.osi.osi_road import AHEAD, BACK, BOTH, Road, table, two_way
from tests.shared_data import shared


def lanes(environment: MapTables) -> dict[str, dict[str, Any]]:
    return {row["lanelet_id"]: row for row in table(environment, "lanelet")}


def links(environment: MapTables) -> set[tuple[str, str]]:
    return {(row["from_id"], row["to_id"]) for row in table(environment, "lane_link")}


def problems(environment: MapTables) -> dict[str | None, str]:
    return {r["lanelet_id"]: r["message"] for r in table(environment, "map_quality") if r["severity"] == "error"}


def points(environment: MapTables, lane: str) -> list[dict[str, Any]]:
    return [row for row in table(environment, "lane_point") if row["lanelet_id"] == lane]


def test_lanes_run_in_the_direction_of_travel() -> None:
    environment = two_way(z=7.0).load(offset=(1000.0, 0.0))
    rows = lanes(environment)
    assert {k: (r["lane_type"], r["drivable"], round(r["width_m"], 3), round(r["length_m"], 3)) for k, r in rows.items()} == {
        "1": ("driving", True, 3.5, 100.0),
        "2": ("driving", True, 3.5, 100.0),
        "3": ("sidewalk", False, 1.5, 100.0),
    }  # fmt: skip
    assert [rows["1"][c] for c in ("left_id", "left_against", "right_id", "right_against")] == ["2", True, "3", False]
    assert [rows["2"][c] for c in ("left_id", "left_against", "right_id", "right_against")] == ["1", True, None, None]
    assert (environment.handedness, environment.handedness_source) == ("rht", "lanes")
    first, second = points(environment, "1")[0], points(environment, "2")[0]
    assert [first[c] for c in ("x_m", "y_m", "z_m", "tx", "left_y_m", "right_y_m")] == [
        1000.0,
        -1.75,
        7.0,
        1.0,
        0.0,
        -3.5,
    ]
    assert [second[c] for c in ("x_m", "y_m", "z_m", "tx", "left_y_m", "right_y_m")] == [
        1100.0,
        1.75,
        7.0,
        -1.0,
        0.0,
        3.5,
    ]
    assert not problems(environment)


def test_the_nearer_line_of_a_double_one_is_named_first() -> None:
    """Between the lanes there is a broken line on the right of the reference line and a solid one on its left."""
    marks = {
        (r["lanelet_id"], r["side"]): (r["marking"], r["lane_change"]) for r in table(two_way().load(), "lane_boundary")
    }
    assert marks == {
        ("1", "left"): ("broken_solid", "decrease"),
        ("1", "right"): ("curb", "none"),
        ("2", "left"): ("solid_broken", "decrease"),
        ("2", "right"): ("solid", None),
        ("3", "left"): ("curb", "none"),
        ("3", "right"): ("none", None),
    }


@pytest.mark.parametrize(("physical", "expected"), [((), None), ((5,), None), ((61,), "solid"), ((61, 5), None)])
def test_a_marking_that_is_not_in_the_log_is_not_known(physical: tuple[int, ...], expected: str | None) -> None:
    """A road without any reference to markings says nothing of them."""
    road = Road()
    road.bound(61, [(0.0, 0.0), (100.0, 0.0)], 3)
    road.edge(11, 1.75, physical=physical)
    road.edge(12, -1.75, physical=physical)
    road.logical(1, [11], [12])
    assert {r["marking"] for r in table(road.load(), "lane_boundary")} == {expected}


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
    assert lanes(environment)["1"]["length_m"] == pytest.approx(50.0)
    assert points(environment, "1")[0]["x_m"] == pytest.approx(20.0 if way == AHEAD else 70.0)
    marks = {(r["side"], r["marking"]): (r["s_start_m"], r["s_end_m"]) for r in table(environment, "lane_boundary")}
    changing, whole = ("left", "right") if way == AHEAD else ("right", "left")
    assert marks[whole, "solid"] == pytest.approx((0.0, 50.0))
    assert marks[changing, "solid"] == pytest.approx((0.0, 20.0) if way == AHEAD else (30.0, 50.0))
    assert marks[changing, "broken"] == pytest.approx((20.0, 50.0) if way == AHEAD else (0.0, 30.0))


@pytest.mark.parametrize("by", ["the first", "the second"])
@pytest.mark.parametrize("way", [AHEAD, BACK])
def test_a_link_is_said_by_either_lane(way: int, by: str) -> None:
    road = Road()
    for k, span in enumerate(((0.0, 100.0), (100.0, 200.0))):
        road.edge(11 + 10 * k, 1.75, *span)
        road.edge(12 + 10 * k, -1.75, *span)
    road.logical(1, [11], [12], way, after=[2] if by == "the first" else [])
    road.logical(2, [21], [22], way, span=(100.0, 200.0), before=[1] if by == "the second" else [])
    assert links(road.load()) == ({("1", "2")} if way == AHEAD else {("2", "1")})


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
    assert links(environment) == {("1", "2")}
    assert points(environment, "2")[0]["x_m"] == pytest.approx(100.0)
    assert points(environment, "2")[0]["left_y_m"] == pytest.approx(1.75)


def test_lanes_on_the_area_of_an_intersection_are_in_its_junction() -> None:
    road = two_way()
    road.lane(77, [], kind=4)
    road.truth.logical_lane[0].physical_lane_reference.add().physical_lane_id.value = 77
    rows = lanes(road.load())
    assert (rows["1"]["junction_id"], rows["2"]["junction_id"]) == ("j77", None)


@pytest.mark.parametrize("way", [0, 1])
def test_a_lane_that_says_no_direction_is_left_out_and_named(way: int) -> None:
    road = two_way()
    road.truth.logical_lane[1].move_direction = way
    environment = road.load()
    assert set(lanes(environment)) == {"1", "3"}
    assert "move_direction" in problems(environment)["2"]
    assert lanes(environment)["1"]["left_id"] is None


def test_a_lane_driven_both_ways() -> None:
    road = two_way()
    road.truth.logical_lane[1].move_direction = BOTH
    rows = lanes(road.load())
    assert (rows["2"]["bidirectional"], rows["1"]["bidirectional"], rows["1"]["left_against"]) == (True, False, True)


@pytest.mark.parametrize(
    ("spoil", "what"),
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
def test_a_lane_without_a_shape_is_left_out_and_named(spoil: Any, what: str) -> None:
    road = two_way()
    spoil(road)
    environment = road.load(handedness="rht")
    assert what in problems(environment)["1"]
    assert "1" not in lanes(environment)


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
    assert "4" not in lanes(environment)


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
    found = [tuple(r.values()) for r in table(road.load(), "speed_limit")]
    assert found == [
        ("1", 0.0, pytest.approx(60.0), pytest.approx(50 / 3.6), "lane"),
        ("1", pytest.approx(60.0), 100.0, pytest.approx(13.4112), "lane"),
        ("2", pytest.approx(75.0), pytest.approx(100.0), pytest.approx(80 / 3.6), "lane"),
    ]


@pytest.mark.parametrize("above", [0.0, 4.0])
@pytest.mark.parametrize("named", [True, False])
def test_a_physical_lane_in_the_place_of_a_logical_one_is_no_second_lane(above: float, named: bool) -> None:
    """Above it, it is another road; but not where the logical lane says that it lies on it."""
    road = two_way()
    road.bound(64, [(10.0, 0.0), (90.0, 0.0)])
    road.bound(65, [(10.0, -3.5), (90.0, -3.5)])
    road.lane(70, [(10.0, -1.75), (90.0, -1.75)], left=64, right=65)
    for point in road.truth.lane[0].classification.centerline:
        point.z = above
    if named:
        road.truth.logical_lane[0].physical_lane_reference.add().physical_lane_id.value = 70
    assert set(lanes(road.load())) == ({"1", "2", "3", "70"} if above and not named else {"1", "2", "3"})


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
    row = lanes(road.load())["1"]
    assert (row["width_m"], row["length_m"]) == (pytest.approx(3.5, abs=0.01), pytest.approx(60.0, abs=0.05))


def test_the_road_and_stop_lines_of_a_real_log() -> None:
    """Three logical lanes that the host drives on, and twelve short lanes with a stop line each, most of them above."""
    trace = read_trace(shared("osi/MovingHostWithStopLineVariations.mcap"), IngestOptions())
    assert trace.embedded_map is not None
    environment = load_map(MapSource("embedded", trace.embedded_map))
    rows = lanes(environment)
    assert list(rows) == ["14", "15", "16", *(str(7000 + k) for k in range(12))]
    assert [(rows[i]["left_id"], rows[i]["right_id"], round(rows[i]["width_m"], 3)) for i in ("14", "15", "16")] == [
        (None, "15", 3.5), ("14", "16", 3.5), ("15", None, 3.5),
    ]  # fmt: skip
    shapes = {}
    for name in rows:
        way = points(environment, name)
        ring = [(p["left_x_m"], p["left_y_m"]) for p in way] + [(p["right_x_m"], p["right_y_m"]) for p in way[::-1]]
        shapes[name] = shapely.Polygon(ring)
    states = trace.tables["actor_state"].to_pylist()
    assert all(shapes["15"].contains(shapely.Point(r["x_m"], r["y_m"])) for r in states)
    stops = {r["stop_line_id"]: (r["lanelet_id"], r["lane_s_m"]) for r in table(environment, "stop_line")}
    assert stops == {
        str(4000 + k): (str(7000 + k), pytest.approx(rows[str(7000 + k)]["length_m"] / 2, abs=0.01)) for k in range(12)
    }
    assert {round(p["z_m"], 3) for p in points(environment, "15")} == {0.0}
    assert points(environment, "7006")[-1]["z_m"] == pytest.approx(7.6, abs=0.1)
