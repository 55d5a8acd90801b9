"""The maps of scenarios: widths from outlines, lines, neighbours and ends; links, junctions, markings, limits and what stands on lanes."""

from __future__ import annotations

import pickle
import re
from typing import Any

import numpy as np
import pytest

from drivelint.errors import MapError
from drivelint.formats import load_map
from drivelint.road.map_reader import MapSource, MapTables
from tests.formats.scenarionet.scenario_file import boundary, lane, light, line, scenario, straight, track

EAST = np.column_stack([np.arange(0.0, 101.0, 10.0), np.zeros(11)])


def shifted(points: Any, x: float = 0.0, y: float = 0.0) -> np.ndarray:
    moved: np.ndarray = np.asarray(points, np.float64) + np.array([x, y])
    return moved


def load(
    features: dict[str, Any], *, dataset: str = "waymo", lights: dict[str, Any] | None = None, **options: Any
) -> MapTables:
    place = options.pop("place", "")
    content = scenario({"ego": track(straight(3, 1.0))}, dataset=dataset, features=features, lights=lights, map=place)
    return load_map(MapSource("sd_made_1.pkl", pickle.dumps(content, 4)), **options)


def rows(found: MapTables, table: str) -> list[dict[str, Any]]:
    return [{k: v for k, v in row.items() if k != "environment_id"} for row in found.tables[table].to_pylist()]


def lanelets(found: MapTables) -> dict[str, dict[str, Any]]:
    return {row["lanelet_id"]: row for row in rows(found, "lanelet")}


def points(found: MapTables, name: str) -> dict[str, np.ndarray]:
    mine = [row for row in rows(found, "lane_point") if row["lanelet_id"] == name]
    return {key: np.array([row[key] for row in mine], np.float64) for key in mine[0] if key != "lanelet_id"}


def checks(found: MapTables, check: str) -> list[str]:
    return [row["message"] for row in rows(found, "map_quality") if row["check_id"] == check]


def bounded(y: float = 0.0, half: float = 1.75, kind: str = "LANE_SURFACE_STREET", **more: Any) -> dict[str, Any]:
    """Return a lane to the east with its outline, as nuScenes and nuPlan have them."""
    outline = [[-1.0, y - half], [101.0, y - half], [101.0, y + half], [-1.0, y + half], [-1.0, y - half]]
    return lane(shifted(EAST, y=y), kind, polygon=outline, **more)


# ---- widths


def test_the_outline_of_a_lane_gives_its_bounds() -> None:
    found = load({"a": bounded(half=1.6)}, dataset="nuscenes", place="boston-seaport")
    a = points(found, "a")
    assert a["half_width_m"] == pytest.approx(np.full(len(a["k"]), 1.6), abs=1e-5)
    assert a["left_y_m"] == pytest.approx(1.6, abs=1e-5)
    assert a["right_y_m"] == pytest.approx(-1.6, abs=1e-5)
    assert (a["x_m"][0], a["x_m"][-1]) == pytest.approx((0.0, 100.0))
    assert found.tables["environment"]["format"].to_pylist() == ["scenarionet"]
    assert rows(found, "map_quality") == []


def test_an_outline_that_widens_and_is_cut_aslant() -> None:
    outline = [[-3.0, -1.5], [101.5, -1.5], [99.0, 3.0], [-1.0, 1.5]]
    found = load({"a": lane(EAST, polygon=outline)}, dataset="nuplan", place="us-ma-boston")
    a = points(found, "a")
    assert a["left_y_m"] == pytest.approx(1.5 + 1.5 * (a["left_x_m"] + 1.0) / 100.0, abs=0.1)
    assert a["right_y_m"] == pytest.approx(-1.5, abs=1e-5)


def test_the_lines_that_a_lane_refers_to_give_its_bounds() -> None:
    """Each on its part of the lane; where the right line ends, the width goes on as it was there."""
    features = {
        "a": lane(EAST, left_boundaries=[boundary("l", 10)], right_boundaries=[boundary("r", 4)]),
        "l": line(shifted(EAST, y=1.8)),
        "r": line(shifted(EAST, y=-1.6), "ROAD_EDGE_BOUNDARY"),
    }
    found = load(features)
    a = points(found, "a")
    assert a["left_y_m"] == pytest.approx(1.8, abs=1e-5)
    assert a["right_y_m"] == pytest.approx(-1.6, abs=1e-5)
    (message,) = checks(found, "assumed_width")
    assert re.match(r"along (29|30)% of the lanes' sides \(1 of 1 lanes\) the edge of the lane is not known", message)


def test_a_far_edge_is_no_bound() -> None:
    """Parked cars stand between a lane and the edge: what is left is a lane of which the middle is nearly the line of its middle."""
    features = {
        "a": lane(EAST, left_boundaries=[boundary("l", 10)], right_boundaries=[boundary("r", 10)]),
        "l": line(shifted(EAST, y=1.75)),
        "r": line(shifted(EAST, y=-3.6), "ROAD_EDGE_BOUNDARY"),
    }
    assert points(load(features), "a")["right_y_m"] == pytest.approx(-2.35, abs=1e-5)
    features["r"] = line(shifted(EAST, y=-9.0), "ROAD_EDGE_BOUNDARY")
    assert points(load(features), "a")["right_y_m"] == pytest.approx(-1.75, abs=1e-5)


def test_lines_beside_a_lane_count_where_no_lane_refers_to_any() -> None:
    """So in JSON of Waymo; a line in the middle of the lane is another's."""
    features = {
        "a": lane(EAST),
        "l": line(shifted(EAST, y=1.7)),
        "farther": line(shifted(EAST, y=2.5)),
        "r": line(shifted(EAST, y=-1.9), "ROAD_EDGE_MEDIAN"),
        "within": line(shifted(EAST, y=0.3)),
    }
    a = points(load(features), "a")
    assert (a["left_y_m"][0], a["right_y_m"][0]) == pytest.approx((1.7, -1.9), abs=1e-5)


def test_the_middle_between_two_lanes_is_a_bound() -> None:
    west = shifted(EAST, y=3.6)[::-1]
    features = {"a": lane(EAST), "b": lane(west), "e": line(shifted(EAST, y=-1.7), "ROAD_EDGE_BOUNDARY")}
    found = load(features)
    assert points(found, "a")["left_y_m"] == pytest.approx(1.8, abs=1e-5)
    assert lanelets(found)["a"]["left_id"] == "b"
    assert lanelets(found)["a"]["left_against"] is True
    assert found.handedness == "rht"


def test_a_lane_without_bounds_is_as_wide_as_what_it_joins() -> None:
    """As nuScenes has its connecting lanes: it widens evenly from the one to the other."""
    wide = shifted(EAST, x=120.0)
    features = {
        "a": bounded(half=1.5),
        "between": lane([[100.0, 0.0], [110.0, 0.0], [120.0, 0.0]], speed_limit_kmh=100),
        "b": lane(wide, polygon=[[119.0, -2.0], [221.0, -2.0], [221.0, 2.0], [119.0, 2.0]]),
    }
    found = load(features, dataset="nuscenes")
    between = points(found, "between")
    assert between["half_width_m"] == pytest.approx(1.5 + 0.5 * (between["x_m"] - 100.0) / 20.0, abs=1e-4)
    assert [(row["from_id"], row["to_id"]) for row in rows(found, "lane_link")] == [("a", "between"), ("between", "b")]
    assert len(checks(found, "assumed_width")) == 1
    assert rows(found, "speed_limit") == []  # it is a constant of ScenarioNet


def test_a_lane_of_which_nobody_gives_the_width_is_left_out() -> None:
    found = load({"a": bounded(), "alone": lane(shifted(EAST, y=50.0))})
    assert set(lanelets(found)) == {"a"}
    assert checks(found, "invalid_lane") == [
        "lane alone is left out: neither it nor the lanes that it joins have bounds, so its width is unknown"
    ]


@pytest.mark.parametrize(
    "polyline", [[[0.0, 0.0]], [[1.0, 1.0], [1.0, 1.0]], [[0.0, np.nan], [1.0, 1.0]], "text", None, [[1.0], [2.0]]]
)
def test_a_lane_without_a_line_is_left_out(polyline: Any) -> None:
    found = load({"a": bounded(), "bad": {"type": "LANE_FREEWAY", "polyline": polyline}})
    assert set(lanelets(found)) == {"a"}
    (message,) = checks(found, "invalid_lane")
    assert message.startswith("lane bad is left out: ")


# ---- what lanes are, and how they lie


@pytest.mark.parametrize(
    ("kind", "lane_type", "drivable", "road_type"),
    [
        ("LANE_SURFACE_STREET", "driving", True, None),
        ("LANE_SURFACE_UNSTRUCTURE", "driving", True, None),
        ("LANE_FREEWAY", "driving", True, "motorway"),
        ("LANE_BIKE_LANE", "biking", False, None),
        ("LANE_UNKNOWN", "driving", True, None),
    ],
)
def test_kinds_of_lanes(kind: str, lane_type: str, drivable: bool, road_type: str | None) -> None:
    found = load({"a": bounded(y=20.0), "b": bounded(kind=kind)})
    row = lanelets(found)["b"]
    assert (row["lane_type"], row["drivable"], row["road_type"]) == (lane_type, drivable, road_type)


def test_links_that_the_scenario_gives() -> None:
    """Ids are numbers in Waymo's lanes; entry and exit lanes say the same, and one of them is enough."""
    features = {
        "1": bounded(exit_lanes=[2], entry_lanes=[]),
        "2": lane(
            shifted(EAST, x=100.0), polygon=[[99, -2], [201, -2], [201, 2], [99, 2]], exit_lanes=[], entry_lanes=[1]
        ),
        "3": lane(
            shifted(EAST, x=200.0), polygon=[[199, -2], [301, -2], [301, 2], [199, 2]], exit_lanes=[99], entry_lanes=[2]
        ),
    }
    found = load(features)
    assert [(row["from_id"], row["to_id"]) for row in rows(found, "lane_link")] == [("1", "2"), ("2", "3")]
    assert checks(found, "missing_link") == ["lanelet 3 leads to 99, which the map does not contain"]


def test_lanes_that_meet_at_their_ends_are_linked_but_not_backwards() -> None:
    features = {
        "a": bounded(),
        "on": lane(shifted(EAST, x=100.1), polygon=[[99, -2], [201, -2], [201, 2], [99, 2]]),
        "back": lane(shifted(EAST, y=0.0)[::-1], polygon=[[-1, -2], [101, -2], [101, 2], [-1, 2]]),
        "apart": lane(shifted(EAST, x=101.0), polygon=[[100, -2], [202, -2], [202, 2], [100, 2]]),
    }
    assert [(row["from_id"], row["to_id"]) for row in rows(load(features, dataset="nuplan"), "lane_link")] == [
        ("a", "on")
    ]


def test_neighbours() -> None:
    """Lanes side by side, also where one is shorter; one 3 m higher, and one that runs across, are none."""
    features = {
        "1": bounded(y=0.0),
        "2": bounded(y=3.5),
        "3": lane(shifted(EAST, y=7.0)[::-1], polygon=[[-1, 5.25], [101, 5.25], [101, 8.75], [-1, 8.75]]),
    }
    found = lanelets(load(features, dataset="nuplan", place="us-pa-pittsburgh"))
    assert [(found[i]["left_id"], found[i]["left_against"]) for i in "123"] == [("2", False), ("3", True), ("2", True)]
    assert [(found[i]["right_id"], found[i]["right_against"]) for i in "123"] == [
        (None, None),
        ("1", False),
        (None, None),
    ]
    assert len({found[i]["road_id"] for i in "123"}) == 1


def waymo_lane(line_points: Any, z: float, **more: Any) -> dict[str, Any]:
    flat = np.asarray(line_points, np.float64)
    return {"type": "LANE_SURFACE_STREET", "polyline": np.column_stack([flat, np.full(len(flat), z)]), **more}


@pytest.mark.parametrize(("height", "crosses"), [(0.0, True), (2.0, True), (6.0, False)])
def test_lanes_that_lie_across_each_other_are_a_junction(height: float, crosses: bool) -> None:
    north = np.column_stack([np.full(5, 50.0), np.linspace(-15.0, 15.0, 5)])
    features = {
        "a": waymo_lane(np.linspace((35.0, 0.0), (65.0, 0.0), 4), 0.0, polygon=[[34, -2], [66, -2], [66, 2], [34, 2]]),
        "b": waymo_lane(north, height, polygon=[[48, -16], [52, -16], [52, 16], [48, 16]]),
    }
    found = lanelets(load(features))
    assert [found[i]["junction_id"] for i in "ab"] == (["ja", "ja"] if crosses else [None, None])


@pytest.mark.parametrize(("x", "y", "is_junction"), [(40.0, 3.5, False), (12.0, -12.0, True)])
def test_a_split_is_no_junction_and_a_turning_off_is_one(x: float, y: float, is_junction: bool) -> None:
    """Two lanes begin together: the other stays beside the one, or leads elsewhere."""
    t = np.linspace(0.0, 1.0, 11)
    across = t if is_junction else np.sin(t * np.pi / 2)
    middle = np.column_stack(
        [x * (np.sin(t * np.pi / 2) if is_junction else t), y * (1.0 - np.cos(across * np.pi / 2))]
    )
    way = np.gradient(middle, axis=0)
    side = 1.7 * np.column_stack([-way[:, 1], way[:, 0]]) / np.hypot(*way.T)[:, None]
    features = {
        "on": lane(np.column_stack([40.0 * t, 0.0 * t]), polygon=[[-1, -1.7], [41, -1.7], [41, 1.7], [-1, 1.7]]),
        "off": lane(middle, polygon=np.vstack([middle + side, (middle - side)[::-1]])),
    }
    found = lanelets(load(features, dataset="nuplan"))
    assert [found[i]["junction_id"] for i in ("on", "off")] == ["joff" if is_junction else None] * 2


def test_heights_are_those_of_the_lines_but_not_where_the_third_number_is_another() -> None:
    """nuScenes gives headings there."""
    feature = {"a": waymo_lane(EAST, -24.0, polygon=bounded()["polygon"])}
    assert points(load(feature), "a")["z_m"] == pytest.approx(-24.0)
    assert np.isnan(points(load(feature, dataset="nuscenes"), "a")["z_m"]).all()


# ---- markings and limits


@pytest.mark.parametrize(
    ("kind", "marking"),
    [
        ("ROAD_LINE_BROKEN_SINGLE_WHITE", "broken"),
        ("ROAD_LINE_BROKEN_SINGLE_YELLOW", "broken"),
        ("ROAD_LINE_SOLID_SINGLE_WHITE", "solid"),
        ("ROAD_LINE_SOLID_SINGLE_YELLOW", "solid"),
        ("ROAD_LINE_SOLID_DOUBLE_WHITE", "solid_solid"),
        ("ROAD_LINE_SOLID_DOUBLE_YELLOW", "solid_solid"),
        ("ROAD_LINE_BROKEN_DOUBLE_YELLOW", "broken_broken"),
        ("ROAD_LINE_PASSING_DOUBLE_YELLOW", None),  # which of the two is broken is not said
        ("ROAD_EDGE_BOUNDARY", None),
        ("ROAD_EDGE_MEDIAN", None),
        ("UNKNOWN_LINE", None),
    ],
)
def test_markings(kind: str, marking: str | None) -> None:
    features = {
        "a": lane(EAST, left_boundaries=[boundary("l", 10)], right_boundaries=[boundary("r", 10)]),
        "l": line(shifted(EAST, y=1.8), kind),
        "r": line(shifted(EAST, y=-1.8), "ROAD_LINE_SOLID_SINGLE_WHITE"),
    }
    found = rows(load(features), "lane_boundary")
    assert [(row["side"], row["marking"]) for row in found] == [("left", marking), ("right", "solid")]
    assert [(row["s_start_m"], row["s_end_m"]) for row in found] == [(0.0, 100.0)] * 2


def test_a_marking_that_changes_along_the_lane() -> None:
    features = {
        "a": lane(EAST, left_boundaries=[boundary("l1", 4), boundary("l2", 10, 4)], right_boundaries=[]),
        "l1": line(shifted(EAST, y=1.8), "ROAD_LINE_SOLID_SINGLE_WHITE"),
        "l2": line(shifted(EAST, y=1.8), "ROAD_LINE_BROKEN_SINGLE_WHITE"),
    }
    found = [
        (row["side"], row["marking"], row["s_start_m"], row["s_end_m"]) for row in rows(load(features), "lane_boundary")
    ]
    assert found == [
        ("left", "solid", 0.0, pytest.approx(40.0)),
        ("left", "broken", pytest.approx(40.0), 100.0),
        ("right", None, 0.0, 100.0),
    ]


@pytest.mark.parametrize("dataset", ["nuscenes", "nuplan"])
def test_markings_that_are_constants_of_the_converter_are_unknown(dataset: str) -> None:
    features = {
        "a": lane(EAST, polygon=bounded()["polygon"], left_boundaries=[boundary("l", 10)]),
        "l": line(shifted(EAST, y=1.75), "ROAD_LINE_SOLID_SINGLE_WHITE"),
    }
    assert [row["marking"] for row in rows(load(features, dataset=dataset), "lane_boundary")] == [None, None]


@pytest.mark.parametrize(
    ("dataset", "more", "limit"),
    [
        ("waymo", {"speed_limit_mph": 40.0, "speed_limit_kmh": 64.37376}, 17.8816),
        ("waymo", {"speed_limit_kmh": 50.0}, 50.0 / 3.6),
        ("waymo", {"speed_limit_mph": 0.0, "speed_limit_kmh": 0.0}, None),
        ("waymo", {"speed_limit_mph": None}, None),
        ("waymo", {}, None),
        ("av2", {"speed_limit_mph": 85.0}, None),
        ("nuscenes", {"speed_limit_kmh": 100}, None),
    ],
)
def test_speed_limits(dataset: str, more: dict[str, Any], limit: float | None) -> None:
    found = rows(load({"a": bounded(**more)}, dataset=dataset), "speed_limit")
    assert [(row["limit_mps"], row["source"]) for row in found] == (
        [] if limit is None else [(pytest.approx(limit), "lane")]
    )


# ---- sides


@pytest.mark.parametrize(
    ("dataset", "place", "side"),
    [
        ("nuscenes", "singapore-onenorth", "lht"),
        ("nuscenes", "singapore-hollandvillage", "lht"),
        ("nuscenes", "boston-seaport", "rht"),
        ("nuplan", "sg-one-north", "lht"),
        ("nuplan", "us-nv-las-vegas-strip", "rht"),
        ("waymo", "", "rht"),
    ],
)
def test_the_place_tells_the_side_that_is_driven_on(dataset: str, place: str, side: str) -> None:
    found = load({"a": bounded()}, dataset=dataset, place=place)
    assert (found.handedness, found.handedness_source) == (side, "attribute")


def test_without_a_place_the_lanes_tell_the_side() -> None:
    west = lane(shifted(EAST, y=-3.5)[::-1], polygon=[[-1, -5.25], [101, -5.25], [101, -1.75], [-1, -1.75]])
    found = load({"a": bounded(), "b": west}, dataset="mine")
    assert (found.handedness, found.handedness_source) == ("lht", "lanes")
    assert load({"a": bounded()}, dataset="mine").handedness_source == "default"
    assert load({"a": bounded(), "b": west}, dataset="mine", handedness="rht").handedness_source == "option"


# ---- lights, stop signs, crossings


def test_lights_stand_at_their_stop_points_on_the_lanes_that_they_hold_for() -> None:
    lights = {
        "1": light(["LANE_STATE_GO"] * 3, 1, (40.0, 0.3, 0.0)),
        "gone": light(["LANE_STATE_GO"] * 3, 99, (40.0, 0.3, 0.0)),
    }
    found = load({"1": bounded()}, lights=lights)
    (row,) = rows(found, "traffic_signal")
    assert (row["signal_id"], row["lanelet_id"], row["kind"], row["dynamic"], row["turns"]) == (
        "1",
        "1",
        "traffic_light",
        True,
        None,
    )
    assert (row["lane_s_m"], row["x_m"], row["y_m"]) == pytest.approx((40.0, 40.0, 0.3))
    assert checks(found, "signal_without_lane") == [
        "lights that apply to no lane of the map, or have no position: gone"
    ]


def test_the_lights_of_nuplan_hold_from_the_begin_of_the_lane() -> None:
    lights = {"1": light(["TRAFFIC_LIGHT_RED"] * 3, "1", (8.0, 0.0, 0.0))}
    (row,) = rows(load({"1": bounded()}, dataset="nuplan", lights=lights), "traffic_signal")
    assert (row["lane_s_m"], row["x_m"]) == pytest.approx((0.0, 0.0))


def test_stop_signs() -> None:
    features = {
        "1": bounded(),
        "2": bounded(y=3.5),
        "s": {"type": "STOP_SIGN", "lane": [1, 2, 77], "position": np.array([90.0, -4.0, 1.0], np.float32)},
        "far": {"type": "STOP_SIGN", "lane": [1], "position": np.array([90.0, -400.0, 1.0], np.float32)},
        "none": {"type": "STOP_SIGN", "lane": [], "position": np.array([90.0, 0.0, 1.0], np.float32)},
    }
    found = load(features)
    assert [(row["signal_id"], row["lanelet_id"], row["kind"], row["dynamic"]) for row in rows(found, "traffic_signal")] == [
        ("s", "1", "stop", False), ("s", "2", "stop", False),
    ]  # fmt: skip
    assert [row["lane_s_m"] for row in rows(found, "traffic_signal")] == pytest.approx([90.0, 90.0])
    assert checks(found, "signal_without_lane") == [
        "stop signs that apply to no lane of the map, or have no position: far, none"
    ]


def test_crossings() -> None:
    outline = np.array([[50.0, -3.0, 0.0], [54.0, -3.0, 0.0], [54.0, 6.0, 0.0], [50.0, 6.0, 0.0]], np.float32)
    features = {
        "1": bounded(),
        "2": bounded(y=3.5),
        "bike": bounded(y=-3.5, kind="LANE_BIKE_LANE"),
        "c": {"type": "CROSSWALK", "polygon": outline},
        "beside": {"type": "CROSSWALK", "polygon": np.add(outline, (0.0, 50.0, 0.0))},
        "bad": {"type": "CROSSWALK", "polygon": outline[:2]},
    }
    found = load(features)
    assert [(row["crossing_id"], row["lanelet_id"], row["kind"]) for row in rows(found, "crossing")] == [
        ("c", "1", None),
        ("c", "2", None),
    ]
    assert [(row["s_start_m"], row["s_end_m"]) for row in rows(found, "crossing")] == [pytest.approx((50.0, 54.0))] * 2
    assert checks(found, "object_without_lane") == ["crossing beside lies across no lane that vehicles drive on"]
    assert checks(found, "invalid_lane") == ["crossing bad is left out: it has no outline"]


def test_what_else_stands_there_is_not_in_the_way() -> None:
    square = np.array([[0.0, 5.0, 0.0], [4.0, 5.0, 0.0], [4.0, 9.0, 0.0]], np.float32)
    features = {
        "1": bounded(),
        **{kind: {"type": kind, "polygon": square} for kind in ("DRIVEWAY", "SPEED_BUMP", "ROAD_EDGE_SIDEWALK")},
    }
    assert set(lanelets(load(features))) == {"1"}


def test_an_offset_moves_everything() -> None:
    features = {"1": bounded(), "s": {"type": "STOP_SIGN", "lane": [1], "position": np.array([90.0, -4.0, 1.0])}}
    lights = {"1": light(["LANE_STATE_GO"] * 3, 1, (40.0, 0.3, 0.0))}
    here, there = load(features, lights=lights), load(features, lights=lights, offset=(1000.0, -500.0))
    for table, x, y in (
        ("lane_point", "x_m", "y_m"),
        ("lane_point", "left_x_m", "left_y_m"),
        ("traffic_signal", "x_m", "y_m"),
    ):
        moved = [(b[x] - a[x], b[y] - a[y]) for a, b in zip(rows(here, table), rows(there, table), strict=True)]
        assert np.array(moved) == pytest.approx(np.tile([1000.0, -500.0], (len(moved), 1)), abs=1e-3)
    assert [row["lane_s_m"] for row in rows(there, "traffic_signal")] == pytest.approx([40.0, 90.0])


# ---- what is no map


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"\x80\x04}\x94.", "is not a scenario of ScenarioNet"),
        (b"\x80\x04\x95", "cut off or damaged"),
        (
            pickle.dumps(scenario({"ego": track(straight(3, 1.0))}), 4),
            "has no lane for driving that can be built: it has none: give --map",
        ),
        (
            pickle.dumps(scenario({"ego": track(straight(3, 1.0))}, features={"1": lane(EAST)}), 4),
            "its width is unknown: give --map",
        ),
    ],
)
def test_what_is_no_map(content: bytes, says: str) -> None:
    with pytest.raises(MapError) as error:
        load_map(MapSource("some.pkl", content))
    assert says in str(error.value)
    assert "some.pkl" in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("where", ["left_boundaries", "exit_lanes", "entry_lanes"])
@pytest.mark.parametrize(
    "value",
    [5, "text", [None], [[1]], [{"lane_start_index": "x"}], [{"lane_start_index": "5", "lane_end_index": "999"}], {}],
)
def test_what_is_not_as_it_should_be_is_left_out(where: str, value: Any) -> None:
    assert set(lanelets(load({"a": bounded(**{where: value})}))) == {"a"}
