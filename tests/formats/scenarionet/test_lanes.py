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
from tests.formats.maps import hand, lanelet, lanelets, links, messages, rows, values
from tests.formats.scenarionet.scenario_file import boundary, lane, light, line, scenario, straight, track

EAST = np.column_stack([np.arange(0.0, 101.0, 10.0), np.zeros(11)])
EGO = {"ego": track(straight(3, 1.0))}


def shifted(points: Any, x: float = 0.0, y: float = 0.0) -> np.ndarray:
    moved: np.ndarray = np.asarray(points, np.float64) + np.array([x, y])
    return moved


def load(
    features: dict[str, Any], *, dataset: str = "waymo", lights: dict[str, Any] | None = None, **options: Any
) -> MapTables:
    place = options.pop("place", "")
    content = scenario(EGO, dataset=dataset, features=features, lights=lights, map=place)
    return load_map(MapSource("sd_made_1.pkl", pickle.dumps(content, 4)), **options)


def columns(environment: MapTables, name: str) -> dict[str, np.ndarray]:
    mine = rows(environment, "lane_point", lanelet_id=name)
    return {key: np.array([row[key] for row in mine], np.float64) for key in mine[0] if key != "lanelet_id"}


def around(x0: float, x1: float, y0: float = -2, y1: float = 2) -> list[list[float]]:
    return [[x0, y0], [x1, y0], [x1, y1], [x0, y1]]


def bounded(y: float = 0.0, half: float = 1.75, kind: str = "LANE_SURFACE_STREET", **more: Any) -> dict[str, Any]:
    """Return a lane to the east with its outline, as nuScenes and nuPlan have them."""
    outline = [[-1.0, y - half], [101.0, y - half], [101.0, y + half], [-1.0, y + half], [-1.0, y - half]]
    return lane(shifted(EAST, y=y), kind, polygon=outline, **more)


# ---- widths


def test_the_outline_of_a_lane_gives_its_bounds() -> None:
    found = load({"a": bounded(half=1.6)}, dataset="nuscenes", place="boston-seaport")
    a = columns(found, "a")
    assert a["half_width_m"] == pytest.approx(np.full(len(a["k"]), 1.6), abs=1e-5)
    assert a["left_y_m"] == pytest.approx(1.6, abs=1e-5)
    assert a["right_y_m"] == pytest.approx(-1.6, abs=1e-5)
    assert (a["x_m"][0], a["x_m"][-1]) == pytest.approx((0.0, 100.0))
    assert found.tables["environment"]["format"].to_pylist() == ["scenarionet"]
    assert rows(found, "map_quality") == []


def test_an_outline_that_widens_and_is_cut_aslant() -> None:
    outline = [[-3.0, -1.5], [101.5, -1.5], [99.0, 3.0], [-1.0, 1.5]]
    found = load({"a": lane(EAST, polygon=outline)}, dataset="nuplan", place="us-ma-boston")
    a = columns(found, "a")
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
    a = columns(found, "a")
    assert a["left_y_m"] == pytest.approx(1.8, abs=1e-5)
    assert a["right_y_m"] == pytest.approx(-1.6, abs=1e-5)
    (message,) = messages(found, "assumed_width")
    assert re.match(r"along (29|30)% of the lanes' sides \(1 of 1 lanes\) the edge of the lane is not known", message)


def test_a_far_edge_is_no_bound() -> None:
    """Parked cars stand between a lane and the edge: what is left is a lane of which the middle is nearly the line of its middle."""
    features = {
        "a": lane(EAST, left_boundaries=[boundary("l", 10)], right_boundaries=[boundary("r", 10)]),
        "l": line(shifted(EAST, y=1.75)),
        "r": line(shifted(EAST, y=-3.6), "ROAD_EDGE_BOUNDARY"),
    }
    assert columns(load(features), "a")["right_y_m"] == pytest.approx(-2.35, abs=1e-5)
    features["r"] = line(shifted(EAST, y=-9.0), "ROAD_EDGE_BOUNDARY")
    assert columns(load(features), "a")["right_y_m"] == pytest.approx(-1.75, abs=1e-5)


def test_lines_beside_a_lane_count_where_no_lane_refers_to_any() -> None:
    """So in JSON of Waymo; a line in the middle of the lane is another's."""
    features = {
        "a": lane(EAST),
        "l": line(shifted(EAST, y=1.7)),
        "farther": line(shifted(EAST, y=2.5)),
        "r": line(shifted(EAST, y=-1.9), "ROAD_EDGE_MEDIAN"),
        "within": line(shifted(EAST, y=0.3)),
    }
    a = columns(load(features), "a")
    assert (a["left_y_m"][0], a["right_y_m"][0]) == pytest.approx((1.7, -1.9), abs=1e-5)


def test_the_middle_between_two_lanes_is_a_bound() -> None:
    west = shifted(EAST, y=3.6)[::-1]
    features = {"a": lane(EAST), "b": lane(west), "e": line(shifted(EAST, y=-1.7), "ROAD_EDGE_BOUNDARY")}
    found = load(features)
    assert columns(found, "a")["left_y_m"] == pytest.approx(1.8, abs=1e-5)
    assert lanelets(found)["a"]["left_id"] == "b"
    assert lanelets(found)["a"]["left_against"] is True
    assert found.handedness == "rht"


def test_a_lane_without_bounds_is_as_wide_as_what_it_joins() -> None:
    """As nuScenes has its connecting lanes: it widens evenly from the one to the other."""
    wide = shifted(EAST, x=120.0)
    features = {
        "a": bounded(half=1.5),
        "between": lane([[100.0, 0.0], [110.0, 0.0], [120.0, 0.0]], speed_limit_kmh=100),
        "b": lane(wide, polygon=around(119, 221)),
    }
    found = load(features, dataset="nuscenes")
    between = columns(found, "between")
    assert between["half_width_m"] == pytest.approx(1.5 + 0.5 * (between["x_m"] - 100.0) / 20.0, abs=1e-4)
    assert links(found) == [("a", "between"), ("between", "b")]
    assert len(messages(found, "assumed_width")) == 1
    assert rows(found, "speed_limit") == []  # it is a constant of ScenarioNet


def test_a_lane_of_which_nobody_gives_the_width_is_left_out() -> None:
    found = load({"a": bounded(), "alone": lane(shifted(EAST, y=50.0))})
    assert set(lanelets(found)) == {"a"}
    assert messages(found, "invalid_lane") == [
        "lane alone is left out: neither it nor the lanes that it joins have bounds, so its width is unknown"
    ]


@pytest.mark.parametrize(
    "polyline", [[[0.0, 0.0]], [[1.0, 1.0], [1.0, 1.0]], [[0.0, np.nan], [1.0, 1.0]], "text", None, [[1.0], [2.0]]]
)
def test_a_lane_without_a_line_is_left_out(polyline: Any) -> None:
    found = load({"a": bounded(), "bad": {"type": "LANE_FREEWAY", "polyline": polyline}})
    assert set(lanelets(found)) == {"a"}
    (message,) = messages(found, "invalid_lane")
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
    assert lanelet(found, "b", "lane_type drivable road_type") == (lane_type, drivable, road_type)


def test_links_that_the_scenario_gives() -> None:
    """Ids are numbers in Waymo's lanes; entry and exit lanes say the same, and one of them is enough."""
    features = {
        "1": bounded(exit_lanes=[2], entry_lanes=[]),
        "2": lane(shifted(EAST, x=100.0), polygon=around(99, 201), exit_lanes=[], entry_lanes=[1]),
        "3": lane(shifted(EAST, x=200.0), polygon=around(199, 301), exit_lanes=[99], entry_lanes=[2]),
    }
    found = load(features)
    assert links(found) == [("1", "2"), ("2", "3")]
    assert messages(found, "missing_link") == ["lanelet 3 leads to 99, which the map does not contain"]


def test_lanes_that_meet_at_their_ends_are_linked_but_not_backwards() -> None:
    features = {
        "a": bounded(),
        "on": lane(shifted(EAST, x=100.1), polygon=around(99, 201)),
        "back": lane(shifted(EAST, y=0.0)[::-1], polygon=around(-1, 101)),
        "apart": lane(shifted(EAST, x=101.0), polygon=around(100, 202)),
    }
    assert links(load(features, dataset="nuplan")) == [("a", "on")]


def test_neighbours() -> None:
    """Lanes side by side, also where one is shorter; one 3 m higher, and one that runs across, are none."""
    features = {
        "1": bounded(y=0.0),
        "2": bounded(y=3.5),
        "3": lane(shifted(EAST, y=7.0)[::-1], polygon=around(-1, 101, 5.25, 8.75)),
    }
    found = load(features, dataset="nuplan", place="us-pa-pittsburgh")
    assert sorted(values(found, "lanelet", "lanelet_id left_id left_against right_id right_against")) == [
        ("1", "2", False, None, None), ("2", "3", True, "1", False), ("3", "2", True, None, None),
    ]  # fmt: skip
    assert len(set(values(found, "lanelet", "road_id"))) == 1


def waymo_lane(line_points: Any, z: float, **more: Any) -> dict[str, Any]:
    flat = np.asarray(line_points, np.float64)
    return {"type": "LANE_SURFACE_STREET", "polyline": np.column_stack([flat, np.full(len(flat), z)]), **more}


@pytest.mark.parametrize(("height", "crosses"), [(0.0, True), (2.0, True), (6.0, False)])
def test_lanes_that_lie_across_each_other_are_a_junction(height: float, crosses: bool) -> None:
    north = np.column_stack([np.full(5, 50.0), np.linspace(-15.0, 15.0, 5)])
    features = {
        "a": waymo_lane(np.linspace((35.0, 0.0), (65.0, 0.0), 4), 0.0, polygon=around(34, 66)),
        "b": waymo_lane(north, height, polygon=around(48, 52, -16, 16)),
    }
    assert values(load(features), "lanelet", "junction_id") == (["ja", "ja"] if crosses else [None, None])


@pytest.mark.parametrize(("x", "y", "is_junction"), [(40.0, 3.5, False), (12.0, -12.0, True)])
def test_a_split_is_no_junction_and_a_turning_off_is_one(x: float, y: float, is_junction: bool) -> None:
    """Two lanes begin together: the other stays beside the one, or leads elsewhere."""
    t = np.linspace(0.0, 1.0, 11)
    across = t if is_junction else np.sin(t * np.pi / 2)
    along = np.sin(t * np.pi / 2) if is_junction else t
    middle = np.column_stack([x * along, y * (1.0 - np.cos(across * np.pi / 2))])
    way = np.gradient(middle, axis=0)
    side = 1.7 * np.column_stack([-way[:, 1], way[:, 0]]) / np.hypot(*way.T)[:, None]
    features = {
        "on": lane(np.column_stack([40.0 * t, 0.0 * t]), polygon=around(-1, 41, -1.7, 1.7)),
        "off": lane(middle, polygon=np.vstack([middle + side, (middle - side)[::-1]])),
    }
    found = load(features, dataset="nuplan")
    assert values(found, "lanelet", "junction_id") == ["joff" if is_junction else None] * 2


def test_heights_are_those_of_the_lines_but_not_where_the_third_number_is_another() -> None:
    """nuScenes gives headings there."""
    feature = {"a": waymo_lane(EAST, -24.0, polygon=bounded()["polygon"])}
    assert columns(load(feature), "a")["z_m"] == pytest.approx(-24.0)
    assert np.isnan(columns(load(feature, dataset="nuscenes"), "a")["z_m"]).all()


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
    found = values(load(features), "lane_boundary", "side marking s_start_m s_end_m")
    assert found == [("left", marking, 0.0, 100.0), ("right", "solid", 0.0, 100.0)]


def test_a_marking_that_changes_along_the_lane() -> None:
    features = {
        "a": lane(EAST, left_boundaries=[boundary("l1", 4), boundary("l2", 10, 4)], right_boundaries=[]),
        "l1": line(shifted(EAST, y=1.8), "ROAD_LINE_SOLID_SINGLE_WHITE"),
        "l2": line(shifted(EAST, y=1.8), "ROAD_LINE_BROKEN_SINGLE_WHITE"),
    }
    assert values(load(features), "lane_boundary", "side marking s_start_m s_end_m") == [
        ("left", "solid", 0.0, 40.0), ("left", "broken", 40.0, 100.0), ("right", None, 0.0, 100.0),
    ]  # fmt: skip


@pytest.mark.parametrize("dataset", ["nuscenes", "nuplan"])
def test_markings_that_are_constants_of_the_converter_are_unknown(dataset: str) -> None:
    features = {
        "a": lane(EAST, polygon=bounded()["polygon"], left_boundaries=[boundary("l", 10)]),
        "l": line(shifted(EAST, y=1.75), "ROAD_LINE_SOLID_SINGLE_WHITE"),
    }
    assert values(load(features, dataset=dataset), "lane_boundary", "marking") == [None, None]


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
    found = values(load({"a": bounded(**more)}, dataset=dataset), "speed_limit", "limit_mps source")
    assert found == ([] if limit is None else [(pytest.approx(limit, abs=1e-6), "lane")])


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
    assert hand(found) == (side, "attribute")


def test_without_a_place_the_lanes_tell_the_side() -> None:
    west = lane(shifted(EAST, y=-3.5)[::-1], polygon=around(-1, 101, -5.25, -1.75))
    found = load({"a": bounded(), "b": west}, dataset="mine")
    assert hand(found) == ("lht", "lanes")
    assert load({"a": bounded()}, dataset="mine").handedness_source == "default"
    assert load({"a": bounded(), "b": west}, dataset="mine", handedness="rht").handedness_source == "option"


# ---- lights, stop signs, crossings


def test_lights_stand_at_their_stop_points_on_the_lanes_that_they_hold_for() -> None:
    lights = {
        "1": light(["LANE_STATE_GO"] * 3, 1, (40.0, 0.3, 0.0)),
        "gone": light(["LANE_STATE_GO"] * 3, 99, (40.0, 0.3, 0.0)),
    }
    found = load({"1": bounded()}, lights=lights)
    assert values(found, "traffic_signal", "signal_id lanelet_id kind dynamic turns lane_s_m x_m y_m") == [
        ("1", "1", "traffic_light", True, None, 40.0, 40.0, 0.3)
    ]
    message = "lights that apply to no lane of the map, or have no position: gone"
    assert messages(found, "signal_without_lane") == [message]


def test_the_lights_of_nuplan_hold_from_the_begin_of_the_lane() -> None:
    lights = {"1": light(["TRAFFIC_LIGHT_RED"] * 3, "1", (8.0, 0.0, 0.0))}
    found = load({"1": bounded()}, dataset="nuplan", lights=lights)
    assert values(found, "traffic_signal", "lane_s_m x_m") == [(0.0, 0.0)]


def test_stop_signs() -> None:
    features = {
        "1": bounded(),
        "2": bounded(y=3.5),
        "s": {"type": "STOP_SIGN", "lane": [1, 2, 77], "position": np.array([90.0, -4.0, 1.0], np.float32)},
        "far": {"type": "STOP_SIGN", "lane": [1], "position": np.array([90.0, -400.0, 1.0], np.float32)},
        "none": {"type": "STOP_SIGN", "lane": [], "position": np.array([90.0, 0.0, 1.0], np.float32)},
    }
    found = load(features)
    assert values(found, "traffic_signal", "signal_id lanelet_id kind dynamic lane_s_m") == [
        ("s", "1", "stop", False, 90.0), ("s", "2", "stop", False, 90.0),
    ]  # fmt: skip
    message = "stop signs that apply to no lane of the map, or have no position: far, none"
    assert messages(found, "signal_without_lane") == [message]


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
    assert values(found, "crossing", "crossing_id lanelet_id kind s_start_m s_end_m") == [
        ("c", "1", None, 50.0, 54.0), ("c", "2", None, 50.0, 54.0),
    ]  # fmt: skip
    assert messages(found, "object_without_lane") == ["crossing beside lies across no lane that vehicles drive on"]
    assert messages(found, "invalid_lane") == ["crossing bad is left out: it has no outline"]


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
    for table, names in (("lane_point", "x_m y_m"), ("lane_point", "left_x_m left_y_m"), ("traffic_signal", "x_m y_m")):
        moved = np.array(values(there, table, names)) - np.array(values(here, table, names))
        assert moved == pytest.approx(np.tile([1000.0, -500.0], (len(moved), 1)), abs=1e-3)
    assert values(there, "traffic_signal", "lane_s_m") == [40.0, 90.0]


# ---- what is no map


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"\x80\x04}\x94.", "is not a scenario of ScenarioNet"),
        (b"\x80\x04\x95", "cut off or damaged"),
        (pickle.dumps(scenario(EGO), 4), "has no lane for driving that can be built: it has none: give --map"),
        (pickle.dumps(scenario(EGO, features={"1": lane(EAST)}), 4), "its width is unknown: give --map"),
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
