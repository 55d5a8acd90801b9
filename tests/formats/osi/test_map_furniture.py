"""Signs, lights, stop lines and crossings of OSI traces, and the lanes for which they hold."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import pytest

from tests.formats.maps import rows, values
from tests.formats.osi.osi_road import Road, two_way

if TYPE_CHECKING:
    from drivelint.road.map_reader import MapTables


def stops(environment: MapTables) -> list[Any]:
    return values(environment, "stop_line", "stop_line_id lanelet_id lane_s_m", digits=2)


def warned(environment: MapTables) -> list[str]:
    return values(environment, "map_quality", "check_id")


@pytest.mark.parametrize(("y", "yaw", "expected"), [(-1.75, 0.0, ("1", 80.0)), (1.75, math.pi, ("2", 20.0))])
def test_a_stop_line_lies_across_its_lane(y: float, yaw: float, expected: tuple[str, float]) -> None:
    road = two_way()
    road.marking(50, (80.0, y, 0.0), yaw)
    environment = road.load()
    assert stops(environment) == [("50", *expected)]
    assert not warned(environment)


@pytest.mark.parametrize(("yaw", "lane", "s"), [(0.0, "1", 80.0), (math.pi, "2", 20.0)])
def test_a_line_over_both_lanes_is_for_whom_its_picture_stands_upright(yaw: float, lane: str, s: float) -> None:
    road = two_way()
    road.marking(50, (80.0, 0.0, 0.0), yaw, width=7.0)
    assert stops(road.load()) == [("50", lane, s)]


def test_a_line_over_two_lanes_holds_for_those_that_it_is_assigned_to() -> None:
    road = two_way()
    road.marking(50, (80.0, 0.0, 0.0), 0.0, width=7.0, logical=[2])
    road.marking(51, (30.0, 0.0, 0.0), 0.0, width=7.0, logical=[1, 2])
    assert stops(road.load()) == [("50", "2", 20.0), ("51", "1", 30.0), ("51", "2", 70.0)]


@pytest.mark.parametrize(
    ("changes", "lies"),
    [
        ({"at": (80.0, -1.75, 5.0)}, False),  # on the bridge above
        ({"at": (80.0, -1.75, 0.3)}, True),
        ({"at": (80.0, -60.0, 0.0)}, False),
        ({"yaw": math.pi / 2}, False),  # along the lane
        ({"yaw": 0.3}, True),
        ({"width": 0.8}, True),  # a short line on one side of the lane
        ({"at": (80.0, -0.2, 0.0), "width": 1.0}, True),
        ({"at": (80.0, -4.0, 0.0), "width": 1.0}, False),  # most of it on the footway
        ({"width": 0.0, "length": 0.0}, False),  # a point
        ({"kind": 4}, False),  # the word STOP
        ({"sign": 16}, False),  # a triangle
    ],
)
def test_where_a_stop_line_lies(changes: dict[str, Any], lies: bool) -> None:
    road = two_way()
    road.marking(50, **{"at": (80.0, -1.75, 0.0), **changes})
    environment = road.load()
    assert [lane for _, lane, _ in stops(environment)] == (["1"] if lies else [])
    told = changes.keys() <= {"at", "yaw", "width", "length"}
    assert warned(environment) == ([] if lies or not told else ["stop_line_without_lane"])


@pytest.mark.parametrize("absent_field", ["position", "yaw"])
def test_a_marking_that_lies_nobody_knows_where_is_told(absent_field: str) -> None:
    road = two_way()
    base = road.marking(50, (80.0, -1.75, 0.0)).base
    if absent_field == "yaw":
        base.orientation.yaw = math.nan
    else:
        base.ClearField("position")
    environment = road.load()
    assert (stops(environment), warned(environment)) == ([], ["road_marking_without_place"])


def test_what_is_out_of_service_does_not_hold() -> None:
    road = two_way()
    road.marking(50, (80.0, -1.75, 0.0)).classification.is_out_of_service = True
    road.sign(51, (80.0, -5.0, 2.0), 17, logical=[1]).main_sign.classification.is_out_of_service = True
    road.bulb(52, (80.0, -5.0, 5.0), logical=[1]).classification.is_out_of_service = True
    environment = road.load()
    assert not [*stops(environment), *rows(environment, "traffic_signal"), *warned(environment)]


def test_signs() -> None:
    road = two_way()
    road.sign(51, (60.0, -5.5, 2.0), 17, logical=[1])
    road.sign(52, (40.0, 4.5, 2.0), 52, logical=[2], value=50.0, unit=3)
    coded = road.sign(53, (20.0, -5.5, 2.0), 1, logical=[1]).main_sign.classification
    coded.country, coded.code, coded.variability = "DE", "276", 3
    road.sign(54, (10.0, -5.5, 2.0), 210, logical=[1, 2])
    environment = road.load()
    columns = "signal_id kind country type value unit dynamic lanelet_id lane_s_m"
    assert values(environment, "traffic_signal", columns) == [
        ("51", "stop", "osi", "17", None, None, False, "1", 60.0),
        ("52", "speed_limit", "osi", "52", 50.0, "km/h", False, "2", 60.0),
        ("53", "no_overtaking", "de", "276", None, None, True, "1", 20.0),
        ("54", None, "osi", "210", None, None, False, "1", 10.0),
        ("54", None, "osi", "210", None, None, False, "2", 90.0),
    ]
    assert values(environment, "traffic_signal", "x_m y_m")[:2] == [(60.0, -5.5), (40.0, 4.5)]


def test_lanes_of_a_ban_on_overtaking_with_a_plate_are_named() -> None:
    road = two_way()
    for name, kind in ((51, 56), (52, 17)):
        plate = road.sign(name, (60.0, -5.5, 2.0), kind, logical=[1]).supplementary_sign.add()
        plate.classification.type = 5
    opposite = road.sign(53, (60.0, 5.5, 2.0), 56, logical=[2])
    opposite.supplementary_sign.add().classification.type = 2
    off = opposite.supplementary_sign.add().classification
    off.type, off.is_out_of_service = 5, True
    environment = road.load()
    assert values(environment, "map_quality", "check_id lanelet_id message") == [
        (
            "sign_condition_unread",
            "1",
            "traffic sign 51 applies only as its plates state (type 5): when it applies is not known",
        )
    ]


def test_a_sign_without_a_lane_is_told() -> None:
    road = two_way()
    road.sign(51, (60.0, -5.5, 2.0), 17)
    road.sign(52, (60.0, -5.5, 2.0), 17, lanes=[99])
    road.bulb(53, (60.0, -5.5, 5.0))
    environment = road.load()
    assert not rows(environment, "traffic_signal")
    assert warned(environment) == ["signal_without_lane"] * 3


@pytest.mark.parametrize(("yaw", "lane"), [(math.pi, "1"), (0.0, "2")])
def test_a_sign_of_a_physical_lane_holds_for_the_logical_one_that_it_faces(yaw: float, lane: str) -> None:
    """A road without a line in its middle is one lane and two logical ones."""
    road = two_way()
    for logical in road.truth.logical_lane[:2]:
        logical.physical_lane_reference.add().physical_lane_id.value = 70
    road.sign(51, (60.0, -5.5, 2.0), 17, lanes=[70], yaw=yaw)
    assert values(road.load(), "traffic_signal", "lanelet_id") == [lane]


def test_of_the_logical_lanes_one_after_another_on_a_physical_one_that_beside_the_sign_is_meant() -> None:
    road = Road()
    for k, span in enumerate(((0.0, 100.0), (100.0, 200.0))):
        road.edge(11 + 10 * k, 1.75, *span)
        road.edge(12 + 10 * k, -1.75, *span)
        road.logical(1 + k, [11 + 10 * k], [12 + 10 * k], span=span, on=[70])
    for number, x in ((51, 60.0), (52, 160.0), (53, 215.0)):
        road.sign(number, (x, -5.5, 2.0), 17, lanes=[70])
    found = values(road.load(), "traffic_signal", "signal_id lanelet_id lane_s_m")
    assert found == [("51", "1", 60.0), ("52", "2", 60.0), ("53", "2", 100.0)]


@pytest.mark.parametrize(
    ("icons", "kind", "turns"),
    [
        ((2, 2, 2), "traffic_light", {"left", "straight", "right", "u_turn"}),
        ((2, 2, 4), "traffic_light", {"left"}),
        ((9,), "traffic_light", {"straight", "right"}),
        ((0,), "traffic_light", None),
        ((15, 15), "pedestrian_light", None),
        ((18,), "bicycle_light", None),
        ((22,), None, None),  # of trams
    ],
)
def test_the_bulbs_of_a_light_are_one_signal(icons: tuple[int, ...], kind: str | None, turns: set[str] | None) -> None:
    road = two_way()
    for k, icon in enumerate(icons):
        road.bulb(60 + k, (95.0, -5.0, 5.0 - 0.3 * k), icon, logical=[1], reference=("net.asam.opendrive", "sig 7"))
    (found,) = rows(road.load(), "traffic_signal")
    assert (found["signal_id"], found["kind"], found["dynamic"], found["lanelet_id"]) == ("sig 7", kind, True, "1")
    assert (None if found["turns"] is None else set(found["turns"])) == turns


def test_a_zebra_crossing() -> None:
    road = two_way()
    road.marking(50, (40.0, 0.0, 0.0), sign=87, width=7.0, length=4.0)
    assert values(road.load(), "crossing", "crossing_id lanelet_id s_start_m s_end_m kind") == [
        ("50", "1", 38.0, 42.0, "zebra"), ("50", "2", 58.0, 62.0, "zebra"),
    ]  # fmt: skip
