"""Lanes that an OSI trace carries: turned into the direction of travel, ways through intersections, against OpenDRIVE."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
import shapely

from drivelint.drive.trace import IngestOptions
from drivelint.errors import MapError
from drivelint.formats import load_map, read_source, read_trace
from drivelint.formats.osi.schema import message_class
from drivelint.road.map_reader import MapSource
from tests.formats.maps import hand, lanelet, lanelets, links, points, rows, values
from tests.formats.osi.map_trace import Trace
from tests.shared_data import shared


def row(y: float, *, x0: float = 0.0, x1: float = 40.0) -> list[tuple[float, float]]:
    return [(x0, y), ((x0 + x1) / 2, y), (x1, y)]


def two_way() -> Trace:
    """Lanes 1 (along +x) and 2 (along -x, though its centre line runs along +x), and a footway 3."""
    trace = Trace()
    trace.bound(11, row(3.5), 4)
    trace.bound(12, row(0.0)[::-1])  # drawn the other way round
    trace.bound(13, row(-3.5), 12)
    trace.bound(14, row(-5.0))
    trace.lane(1, row(-1.75), left=12, right=13, beside=(2, 3))
    trace.lane(2, row(1.75), left=11, right=12, ahead=False, beside=(0, 1))
    trace.lane(3, row(-4.25), left=13, right=14, kind=3, subtype=4, beside=(1, 0))
    return trace


def test_lanes_run_in_the_direction_of_travel() -> None:
    environment = two_way().load(offset=(100.0, 0.0))
    assert values(environment, "lanelet", "lanelet_id lane_type drivable width_m", digits=3) == [
        ("1", "driving", True, 3.5), ("2", "driving", True, 3.5), ("3", "sidewalk", False, 1.5),
    ]  # fmt: skip
    assert lanelet(environment, "1", "left_id left_against right_id right_against") == ("2", True, "3", False)
    assert lanelet(environment, "2", "left_id left_against right_id") == ("1", True, None)
    assert hand(environment) == ("rht", "lanes")
    first = values(environment, "lane_point", "lanelet_id x_m y_m tx", k=0)
    assert first[:2] == [("1", 100.0, -1.75, 1.0), ("2", 140.0, 1.75, -1.0)]
    marks = values(environment, "lane_boundary", "lanelet_id side marking")
    assert marks[:4] == [
        ("1", "left", "solid"), ("1", "right", "curb"), ("2", "left", "solid"), ("2", "right", "broken"),
    ]  # fmt: skip


def test_what_follows_is_turned_too() -> None:
    trace = two_way()
    for name, y in ((21, 3.5), (22, 0.0), (23, -3.5)):
        trace.bound(name, row(y, x0=40.0, x1=80.0))
    trace.lane(4, row(-1.75, x0=40.0, x1=80.0), left=22, right=23, pairs=((1, None),))
    trace.lane(5, row(1.75, x0=40.0, x1=80.0), left=21, right=22, ahead=False, pairs=((2, None),))
    for lane, after in ((trace.truth.lane[0], 4), (trace.truth.lane[1], 5)):
        lane.classification.lane_pairing.add().successor_lane_id.value = after
    assert links(trace.load()) == [("1", "4"), ("5", "2")]


@pytest.mark.parametrize(("ahead", "link"), [(True, ("1", "4")), (False, ("4", "1"))])
@pytest.mark.parametrize("by", ["the first along the line", "the second", "both"])
def test_a_link_is_said_by_either_lane(ahead: bool, link: tuple[str, str], by: str) -> None:
    """esmini's lane before a junction names another one as its successor; only the lane after it tells."""
    trace = Trace()
    for name, y in ((11, 1.75), (12, -1.75)):
        trace.bound(name, row(y, x1=80.0))
    trace.lane(1, row(0.0), left=11, right=12, ahead=ahead, pairs=((None, 9 if by == "the second" else 4),))
    later = row(0.0, x0=40.0, x1=80.0)
    before = None if by == "the first along the line" else 1
    trace.lane(4, later, left=11, right=12, ahead=ahead, pairs=((before, None),))
    assert links(trace.load(handedness="rht")) == [link]


def test_a_boundary_that_reaches_beyond_the_lane_is_cut() -> None:
    trace = Trace()
    trace.bound(11, [(-50.0, 9.0), *row(1.75), (90.0, 9.0)])
    trace.bound(12, row(-1.75))
    trace.lane(1, row(0.0), left=11, right=12)
    assert values(trace.load(handedness="rht"), "lanelet", "width_m length_m") == [(3.5, 40.0)]


def test_ways_through_an_intersection_are_drawn() -> None:
    trace = Trace()
    for name, y, x in ((11, 1.75, 58.25), (12, -1.75, 61.75)):
        trace.bound(name, row(y))
        trace.bound(name + 2, [(x, 20.0), (x, 60.0)])
    trace.lane(1, row(0.0), left=11, right=12, pairs=((None, 9),))
    trace.lane(2, [(60.0, 20.0), (60.0, 60.0)], left=13, right=14, pairs=((9, None),))
    trace.lane(9, [(40.0, 0.0), (60.0, 20.0)], kind=4, pairs=((1, 2), (2, 1)))
    environment = trace.load(handedness="rht")
    way = lanelets(environment)["9.1.2"]
    assert way["junction_id"] == "j9"
    assert 2.5 < way["width_m"] < 4.5
    assert {("1", "9.1.2"), ("9.1.2", "2")} <= set(links(environment))
    (turn,) = values(environment, "lane_link", "turn_rad", from_id="1", to_id="9.1.2")
    assert turn == pytest.approx(np.pi / 2, abs=0.2)


def test_lanes_without_boundaries_make_no_map() -> None:
    trace = Trace()
    trace.lane(1, row(0.0))
    with pytest.raises(MapError, match="no boundaries"):
        trace.load()


def bounded(ahead: bool | None = True) -> Trace:
    """A lane 1 that is wider from 300 to 310 m, beside it a lane 2 from there on, and a hard shoulder 3: all without centre lines."""
    trace = Trace()
    trace.bound(11, row(1.5, x0=0.0, x1=300.0))
    trace.bound(12, row(1.5, x0=303.0, x1=600.0), 4)  # from the first dash on
    trace.bound(13, row(-1.5, x0=-50.0, x1=600.0))
    trace.bound(14, [(300.0, 1.5), (310.0, 4.5)])
    trace.bound(15, row(4.5, x0=310.0, x1=600.0))
    trace.bound(16, row(-4.5, x0=0.0, x1=600.0), 12)
    trace.lane(1, [], left=(12, 11), right=13, ahead=ahead)
    trace.lane(2, [], left=(14, 15), right=12, ahead=ahead)
    trace.lane(3, [], left=13, right=16, ahead=None, kind=3, subtype=6)
    return trace


@pytest.mark.parametrize("ahead", [True, False])
def test_lanes_by_their_bounds_alone(ahead: bool) -> None:
    environment = bounded(ahead).load(handedness="rht")
    assert values(environment, "lanelet", "lanelet_id lane_type drivable") == [
        ("1", "driving", True), ("2", "driving", True), ("3", "stop", False),
    ]  # fmt: skip
    assert values(environment, "lanelet", "length_m") == pytest.approx([600.0, 297.0, 600.0], abs=1.0)
    assert values(environment, "lanelet", "width_m") == pytest.approx([3.0, 3.0, 3.0], abs=0.05)
    way = points(environment)
    first, last = way["1"][0], way["1"][-1]
    assert (first["x_m"], last["x_m"]) == pytest.approx((0.0, 600.0) if ahead else (600.0, 0.0))
    assert (first["left_y_m"], first["right_y_m"]) == pytest.approx((1.5, -1.5) if ahead else (-1.5, 1.5))
    assert max(p["half_width_m"] for p in way["2"]) == pytest.approx(1.5, abs=0.05)


def test_a_lane_without_centre_line_and_direction_is_not_guessed_at() -> None:
    with pytest.raises(
        MapError, match=r"3 lanes .* 2 of them fail because the direction in which it is driven is not known"
    ):
        bounded(None).load()
    trace = bounded()
    trace.truth.lane[0].classification.centerline_is_driving_direction = False
    trace.truth.lane[1].classification.ClearField("centerline_is_driving_direction")
    environment = trace.load(handedness="rht")
    assert list(lanelets(environment)) == ["1", "3"]
    ((name, message),) = values(environment, "map_quality", "lanelet_id message", severity="error")
    assert (name, "the direction in which" in message) == ("2", True)


def test_a_writer_that_leaves_out_what_is_false_means_false() -> None:
    """esmini: some lanes say true, none says false."""
    trace = two_way()
    trace.truth.lane[1].classification.ClearField("centerline_is_driving_direction")
    assert values(trace.load(), "lane_point", "tx", lanelet_id="2", k=0) == [-1.0]


def gap(trace: Trace) -> None:
    trace.truth.lane_boundary[0].boundary_line[2].position.x = 260.0


def move_start(trace: Trace, x: float) -> None:
    """Let the lane's right side and the first of its left one begin at `x`."""
    for k in (0, 2):
        trace.truth.lane_boundary[k].boundary_line[0].position.x = x


def reversed_side(trace: Trace) -> None:
    for point in trace.truth.lane_boundary[2].boundary_line:
        point.position.x = -point.position.x


@pytest.mark.parametrize(
    ("spoil", "phrase"),
    [
        (lambda trace: trace.truth.lane_boundary.pop(1), "not all of its boundaries"),
        (lambda trace: trace.truth.lane[0].classification.ClearField("left_lane_boundary_id"), "no left boundary"),
        (gap, "43 m between"),
        (reversed_side, "same order"),
        (lambda trace: move_start(trace, math.nan), "an impossible coordinate"),
        (lambda trace: move_start(trace, 1e300), "an impossible coordinate"),
        (lambda trace: move_start(trace, -1e9), "km long"),
    ],
)
def test_a_lane_whose_bounds_make_no_shape_is_left_out_and_named(spoil: Any, phrase: str) -> None:
    trace = bounded()
    trace.bound(21, row(50.0))
    trace.bound(22, row(46.5))
    trace.lane(9, row(48.25), left=21, right=22)
    spoil(trace)
    environment = trace.load(handedness="rht")
    assert phrase in dict(values(environment, "map_quality", "lanelet_id message", severity="error"))["1"]
    assert "1" not in lanelets(environment)


def test_the_lanes_of_a_real_log_have_boundaries_and_no_direction() -> None:
    trace = read_trace(shared("osi/sensorDataDetectedLaneBoundaries.mcap"), IngestOptions())
    assert trace.embedded_map is not None
    truth = message_class("GroundTruth").FromString(trace.embedded_map)
    assert (len(truth.lane), len(truth.lane_boundary)) == (4, 7)
    with pytest.raises(
        MapError, match=r"4 lanes .* 3 of them fail because the direction in which it is driven is not known"
    ):
        load_map(MapSource("embedded", trace.embedded_map))
    for lane in truth.lane:  # if it said that they are driven as their boundaries run, as the host drives
        lane.classification.centerline_is_driving_direction = True
    environment = load_map(MapSource("embedded", truth.SerializeToString(deterministic=True)))
    assert values(environment, "lanelet", "lanelet_id drivable length_m", digits=0) == [
        ("1", True, 800), ("2", True, 800), ("3", True, 300), ("4", False, 510),
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("name", "road"),
    [
        ("pedestrian", "osi/fabriksgatan.xodr"),
        ("alks_cut-in", "osi/straight_500m.xodr"),
        ("highway_merge", "osi/soderleden.xodr"),
    ],
)
def test_real_lanes_lie_on_the_real_road(name: str, road: str) -> None:
    """The trace's lanes for driving, outside intersections, against our own reading of the road's OpenDRIVE."""
    trace = read_trace(shared(f"osi/{name}.osi"), IngestOptions(ego="0"))
    assert trace.embedded_map is not None
    carried = load_map(MapSource("embedded", trace.embedded_map))
    own = load_map(read_source(shared(road)))
    lanes = values(carried, "lanelet", "lanelet_id", drivable=True, junction_id=None)
    drivable = set(values(own, "lanelet", "lanelet_id", drivable=True))
    theirs = [r for r in rows(own, "lane_point") if r["lanelet_id"] in drivable]
    tree = shapely.STRtree(shapely.points([(r["x_m"], r["y_m"]) for r in theirs]))
    mine = [r for r in rows(carried, "lane_point") if r["lanelet_id"] in lanes]
    near = tree.nearest(shapely.points([(r["x_m"], r["y_m"]) for r in mine]))
    pairs = [(r, theirs[i]) for r, i in zip(mine, near, strict=True)]
    across = np.array([abs((r["x_m"] - t["x_m"]) * t["ty"] - (r["y_m"] - t["y_m"]) * t["tx"]) for r, t in pairs])
    along = np.array([r["tx"] * t["tx"] + r["ty"] * t["ty"] for r, t in pairs])
    width = np.array([abs(r["half_width_m"] - t["half_width_m"]) for r, t in pairs])
    assert len(mine) > 20
    assert np.quantile(across, 0.9) < 0.3
    assert (along > 0.9).mean() > 0.97
    assert np.quantile(width, 0.9) < 0.2


def test_the_lanes_of_the_merge_are_joined_up() -> None:
    """Main carriageway 24, 31, 3, 11 and 25, 32, 4, 12; the slip road 18, 34, 5 runs into 12."""
    trace = read_trace(shared("osi/highway_merge.osi"), IngestOptions(ego="0"))
    assert trace.embedded_map is not None
    carried = load_map(MapSource("embedded", trace.embedded_map))
    for way in (("24", "31", "3", "11"), ("25", "32", "4", "12"), ("18", "34", "5", "12")):
        assert set(pairwise(way)) <= set(links(carried))


@pytest.mark.parametrize("ahead", [True, False])
@pytest.mark.parametrize("bend", [0.0, 0.02])
def test_a_side_that_ends_early_is_led_on_beside_the_middle(ahead: bool, bend: float) -> None:
    """The left side is drawn from 3 to 34 m of 40; the lane is as long and as wide as its middle line says."""

    def line(d: float, first: float, last: float) -> list[tuple[float, float]]:
        s = np.linspace(first, last, 40)
        x, y = (np.sin(bend * s) / bend, (1 - np.cos(bend * s)) / bend) if bend else (s, 0 * s)
        return list(zip(x - d * np.sin(bend * s), y + d * np.cos(bend * s), strict=True))

    trace = Trace()
    trace.bound(11, line(1.75, 3.0, 34.0))
    trace.bound(12, line(-1.75, 0.0, 40.0))
    trace.lane(1, line(0.0, 0.0, 40.0), left=11, right=12, ahead=ahead)
    environment = trace.load(handedness="rht")
    assert values(environment, "lanelet", "width_m length_m") == [pytest.approx((3.5, 40.0), abs=0.05)]
    places = values(environment, "lane_point", "x_m y_m")
    ends = [line(0.0, 0.0, 40.0)[k] for k in ((0, -1) if ahead else (-1, 0))]
    assert [places[0], places[-1]] == [pytest.approx(end, abs=0.05) for end in ends]
