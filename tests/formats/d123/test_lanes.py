"""Maps of 123D: lanes, neighbours, junctions, limits, crossings, the side that is driven on."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyarrow as pa
import pytest

from drivelint.errors import MapError
from drivelint.formats.map_registry import load_map, read_source
from drivelint.road.map_reader import MapSource
from tests.formats.d123.files import (
    LAYERS,
    Object,
    array_of,
    arrow,
    crosswalk,
    group,
    intersection,
    lane,
    load,
    straight,
    write_map,
)
from tests.formats.maps import checks, hand, lanelets, links, messages, rows, values


def test_a_lane_lies_between_its_bounds(tmp_path: Path) -> None:
    """It rises from 3 m to 5 m and grows wider; its middle is resampled, its bounds are as they were."""
    widening = lane(4, [(0, 2, 3), (40, 2, 5)], [(0, -2, 3), (20, -2, 4), (40, -4, 5)])
    environment = load(tmp_path, [widening], options={"offset": (100, 0)})
    points = rows(environment, "lane_point")
    assert (points[0]["x_m"], points[-1]["x_m"]) == (100.0, 140.0)
    for p in points:
        x = p["left_x_m"] - 100
        assert p["left_y_m"] == pytest.approx(2.0)
        assert p["right_y_m"] == pytest.approx(np.interp(p["right_x_m"] - 100, [0, 20, 40], [-2, -2, -4]), abs=1e-6)
        assert p["z_m"] == pytest.approx(3.0 + x * 0.05, abs=0.06)
    assert {p["half_width_m"] for p in points[:3]} == {2.0}
    assert values(environment, "environment", "format geo_reference signs_mapped") == [("123d", None, False)]


def test_a_map_without_heights(tmp_path: Path) -> None:
    environment = load(tmp_path, [straight(1, 0, 50, 0.0)], has_z=False)
    assert environment.tables["lane_point"]["z_m"].null_count == environment.tables["lane_point"].num_rows


def test_kinds_of_lanes(tmp_path: Path) -> None:
    lanes = [straight(kind, 0, 50, 4.0 * kind, kind=kind) for kind in range(6)]
    environment = load(tmp_path, lanes)
    assert sorted(values(environment, "lanelet", "lanelet_id lane_type drivable road_type")) == [
        ("0", "driving", True, None), ("1", "driving", True, "motorway"), ("2", "driving", True, None), ("3", "biking", False, None),
        ("4", "bus", True, None), ("5", "driving", True, None),
    ]  # fmt: skip
    message = "type 5 of lanelet 5 is not known: it is treated as a lane for vehicles"
    assert messages(environment, "unknown_word") == [message]


def test_neighbours_and_which_way_they_are_driven(tmp_path: Path) -> None:
    """Lane 0 has lane 2 on its right, and the oncoming lane 1 on its left, which has it on its own left."""
    lanes = [
        straight(0, 0, 50, 0.0, left_lane_id=1, right_lane_id=2),
        straight(1, 0, 50, 3.5, back=True, left_lane_id=0, right_lane_id=77),
        straight(2, 0, 50, -3.5, left_lane_id=0),
    ]
    environment = load(tmp_path, lanes)
    assert sorted(values(environment, "lanelet", "lanelet_id left_id left_against right_id right_against road_id")) == [
        ("0", "1", True, "2", False, "r0"), ("1", "0", True, None, None, "r0"), ("2", "0", False, None, None, "r0"),
    ]  # fmt: skip
    assert hand(environment) == ("rht", "lanes")


def test_ways_on(tmp_path: Path) -> None:
    """Named by the lane before or by the lane after; one that the map does not have is reported."""
    lanes = [
        straight(1, 0, 50, 0.0, successor_ids=[2, 9]),
        straight(2, 50, 90, 0.0),
        straight(3, 90, 120, 0.0, predecessor_ids=[2]),
    ]
    environment = load(tmp_path, lanes)
    assert set(links(environment)) == {("1", "2"), ("2", "3")}
    assert messages(environment, "missing_link") == ["lanelet 1 leads to 9, which the map does not contain"]


def test_limits(tmp_path: Path) -> None:
    given = {1: 13.4, 2: None, 3: float("nan"), 4: 0.0, 5: 88.0}
    environment = load(tmp_path, [straight(k, 0, 50, 4.0 * k, speed_limit_mps=v) for k, v in given.items()])
    assert sorted(values(environment, "speed_limit", "lanelet_id limit_mps source")) == [
        ("1", 13.4, "lane"), ("4", None, "unread"), ("5", None, "unread"),
    ]  # fmt: skip
    assert len(messages(environment, "invalid_speed")) == 2


def test_junctions_are_those_of_the_map(tmp_path: Path) -> None:
    """A group names its intersection, or the intersection its groups."""
    objects = [
        straight(1, 0, 50, 0.0, lane_group_id=10), straight(2, 50, 80, 0.0, lane_group_id=11),
        straight(3, 50, 80, 3.5, lane_group_id=12), group(10, [1], None), group(11, [2], 5), group(12, [3], None),
        intersection(5, [11]), intersection(6, [12]),
    ]  # fmt: skip
    found = values(load(tmp_path, objects), "lanelet", "lanelet_id junction_id")
    assert dict(found) == {"1": None, "2": "5", "3": "6"}


@pytest.mark.parametrize(("height", "junction"), [(0.0, "j1"), (6.0, None)])
def test_junctions_of_a_map_without_any_are_where_lanes_overlap(
    tmp_path: Path, height: float, junction: str | None
) -> None:
    """Not where one crosses the other on a bridge."""
    across = lane(2, [(20, -30, height), (20, 30, height)], [(23.5, -30, height), (23.5, 30, height)])
    found = lanelets(load(tmp_path, [straight(1, 0, 50, 0.0), across, straight(3, 0, 50, 20.0, width=3.0)]))
    assert [found[n]["junction_id"] for n in "123"] == [junction, junction, "j1" if height == 0.0 else None]


@pytest.mark.parametrize("height", [0.0, 6.0])
def test_crossings(tmp_path: Path, height: float) -> None:
    """One over the road on a bridge is none of the road's."""
    environment = load(
        tmp_path, [straight(1, 0, 50, 0.0), crosswalk(7, 20, -4, 24, 4, z=height), crosswalk(8, 20, 50, 24, 60)]
    )
    found = values(environment, "crossing", "crossing_id lanelet_id s_start_m s_end_m kind")
    assert found == ([("7", "1", 20.0, 24.0, None)] if height == 0.0 else [])
    assert messages(environment, "object_without_lane") == ["crossing 8 lies across no lane that vehicles drive on"]


@pytest.mark.parametrize(
    ("dataset", "location", "side", "source"),
    [
        ("nuscenes", "singapore-onenorth", "lht", "attribute"),
        ("nuscenes", "boston-seaport", "rht", "attribute"),
        ("nuplan", "sg-one-north", "lht", "attribute"),
        ("av2-sensor", "PIT", "rht", "attribute"),
        ("nuscenes", "elsewhere", "rht", "default"),
        ("carla", "Town01", "rht", "default"),
    ],
)
def test_the_side_by_the_place(tmp_path: Path, dataset: str, location: str, side: str, source: str) -> None:
    environment = load(tmp_path, [straight(1, 0, 50, 0.0)], dataset=dataset, location=location)
    assert hand(environment) == (side, source)
    given = load(tmp_path, [straight(1, 0, 50, 0.0)], dataset=dataset, location=location, options={"handedness": "lht"})
    assert hand(given) == ("lht", "option")


def test_lanes_that_disagree_with_the_place(tmp_path: Path) -> None:
    lanes = [straight(1, 0, 50, 0.0, left_lane_id=2), straight(2, 0, 50, 3.5, back=True, left_lane_id=1)]
    environment = load(tmp_path, lanes, dataset="nuscenes", location="singapore-onenorth")
    assert environment.handedness == "lht"
    assert len(messages(environment, "handedness_disagrees")) == 1


def test_what_is_not_read_is_said(tmp_path: Path) -> None:
    shape = crosswalk(1, 0, 0, 1, 1).shape
    layers = LAYERS["walkway"], LAYERS["stop_zone"], 55
    more = [Object(layer, number, {}, shape) for number, layer in enumerate(layers, 1)]
    environment = load(tmp_path, [straight(1, 0, 50, 0.0), *more], dataset="nuscenes", location="boston-seaport")
    unread = "objects of layers that are not read: 1 of walkway, 1 of stop zone"
    assert messages(environment, "layers_unread") == [unread]
    assert messages(environment, "unknown_word") == ["layers that 123D does not define: 55: their objects are not read"]
    assert "of lanes through intersections" in messages(environment, "estimated_bounds")[0]
    assert len(messages(environment, "signs_unmapped")) == 1


def test_a_lane_that_cannot_be_read_is_reported(tmp_path: Path) -> None:
    good = straight(1, 0, 50, 0.0)
    features = dict(good.features)
    left, right = features["left_boundary"], features["right_boundary"]
    broken = [
        good._replace(number=2, features={**features, "left_boundary": 3}),
        good._replace(number=3, features={**features, "left_boundary": {b"dtype": "O", b"shape": [1, 3], b"data": b""}}),
        good._replace(number=4, features={**features, "left_boundary": {**features["left_boundary"], b"shape": [7, 3]}}),
        good._replace(number=5, features={"lane_type": 2}),
        good._replace(number=7, features={**features, "left_boundary": array_of([(0, 2, 0), (float("nan"), 2, 0)])}),
        good._replace(number=8, features={**features, "left_boundary": array_of([(0, 2, 0), (1e9, 2, 0)])}),
        good._replace(number=6, features={**features, "right_boundary": left, "left_boundary": right}),
    ]  # fmt: skip
    environment = load(tmp_path, [good, *broken, straight(1, 0, 60, 9.0)])
    assert {name: row["length_m"] for name, row in lanelets(environment).items()} == {"1": 50.0}
    assert set(checks(environment)["invalid_lane"]) == set("12345678")
    assert "lanelet 1 is left out: another has the same number" in messages(environment, "invalid_lane")


def test_what_is_no_map_of_123d_is_refused(tmp_path: Path) -> None:
    with pytest.raises(MapError, match="has no lane for vehicles that can be built: it has no lane"):
        load(tmp_path, [crosswalk(1, 0, 0, 1, 1)])
    with pytest.raises(MapError, match=r"py123d 0\.9\.0 wrote the file"):
        load(tmp_path, [straight(1, 0, 50, 0.0)], version="0.9.0")
    other = read_source(arrow(tmp_path / "other.arrow", {"a": pa.array([1])}, {}))
    with pytest.raises(MapError, match="no column object_id, map_layer, features, wkb: this is not a map of 123D"):
        load_map(other)
    nameless = {"object_id": pa.array([None], pa.int64()), "map_layer": pa.array([None], pa.int8())}
    blank = {name: pa.array([b""]) for name in ("features", "wkb")}
    with pytest.raises(MapError, match="an object has no number or no layer"):
        load_map(read_source(arrow(tmp_path / "null.arrow", {**nameless, **blank}, {"version": "0.7.0"})))
    whole = read_source(write_map(tmp_path / "map.arrow", [straight(1, 0, 50, 0.0)]))
    with pytest.raises(MapError, match="not readable in Arrow's file format"):
        load_map(MapSource("map.arrow", whole.content[:-100]))
