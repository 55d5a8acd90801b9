"""Maps of 123D: lanes, neighbours, junctions, limits, crossings, the side that is driven on."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pytest

from drivelint.errors import MapError
from drivelint.formats.map_registry import load_map, read_source
from drivelint.road.map_reader import MapSource, MapTables
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


def lanelets(environment: MapTables) -> dict[str, dict[str, Any]]:
    return {row["lanelet_id"]: row for row in environment.tables["lanelet"].to_pylist()}


def problems(environment: MapTables, check: str) -> list[str]:
    return [row["message"] for row in environment.tables["map_quality"].to_pylist() if row["check_id"] == check]


def test_a_lane_lies_between_its_bounds(tmp_path: Path) -> None:
    """It rises from 3 m to 5 m and grows wider; its middle is resampled, its bounds are as they were."""
    environment = load(
        tmp_path,
        [lane(4, [(0, 2, 3), (40, 2, 5)], [(0, -2, 3), (20, -2, 4), (40, -4, 5)])],
        options={"offset": (100, 0)},
    )
    points = environment.tables["lane_point"].to_pylist()
    assert (points[0]["x_m"], points[-1]["x_m"]) == (100.0, 140.0)
    for p in points:
        x = p["left_x_m"] - 100
        assert p["left_y_m"] == pytest.approx(2.0)
        assert p["right_y_m"] == pytest.approx(np.interp(p["right_x_m"] - 100, [0, 20, 40], [-2, -2, -4]), abs=1e-6)
        assert p["z_m"] == pytest.approx(3.0 + x * 0.05, abs=0.06)
    assert {p["half_width_m"] for p in points[:3]} == {2.0}
    about = environment.tables["environment"].to_pylist()[0]
    assert (about["format"], about["geo_reference"], about["signs_mapped"]) == ("123d", None, False)


def test_a_map_without_heights(tmp_path: Path) -> None:
    environment = load(tmp_path, [straight(1, 0, 50, 0.0)], has_z=False)
    assert environment.tables["lane_point"]["z_m"].null_count == environment.tables["lane_point"].num_rows


def test_kinds_of_lanes(tmp_path: Path) -> None:
    lanes = [straight(kind, 0, 50, 4.0 * kind, kind=kind) for kind in range(6)]
    environment = load(tmp_path, lanes)
    found = {
        int(name): (row["lane_type"], row["drivable"], row["road_type"]) for name, row in lanelets(environment).items()
    }
    assert found == {
        0: ("driving", True, None), 1: ("driving", True, "motorway"), 2: ("driving", True, None), 3: ("biking", False, None),
        4: ("bus", True, None), 5: ("driving", True, None),
    }  # fmt: skip
    assert problems(environment, "unknown_word") == [
        "type 5 of lanelet 5 is not known: it is treated as a lane for vehicles"
    ]


def test_neighbours_and_which_way_they_are_driven(tmp_path: Path) -> None:
    """Lane 0 has lane 2 on its right, and the oncoming lane 1 on its left, which has it on its own left."""
    lanes = [
        straight(0, 0, 50, 0.0, left_lane_id=1, right_lane_id=2),
        straight(1, 0, 50, 3.5, back=True, left_lane_id=0, right_lane_id=77),
        straight(2, 0, 50, -3.5, left_lane_id=0),
    ]
    environment = load(tmp_path, lanes)
    names = ("left_id", "left_against", "right_id", "right_against", "road_id")
    found = {name: tuple(row[column] for column in names) for name, row in lanelets(environment).items()}
    assert found == {
        "0": ("1", True, "2", False, "r0"), "1": ("0", True, None, None, "r0"), "2": ("0", False, None, None, "r0"),
    }  # fmt: skip
    assert (environment.handedness, environment.handedness_source) == ("rht", "lanes")


def test_ways_on(tmp_path: Path) -> None:
    """Named by the lane before or by the lane after; one that the map does not have is reported."""
    lanes = [
        straight(1, 0, 50, 0.0, successor_ids=[2, 9]),
        straight(2, 50, 90, 0.0),
        straight(3, 90, 120, 0.0, predecessor_ids=[2]),
    ]
    environment = load(tmp_path, lanes)
    links = {(row["from_id"], row["to_id"]) for row in environment.tables["lane_link"].to_pylist()}
    assert links == {("1", "2"), ("2", "3")}
    assert problems(environment, "missing_link") == ["lanelet 1 leads to 9, which the map does not contain"]


def test_limits(tmp_path: Path) -> None:
    given = {1: 13.4, 2: None, 3: float("nan"), 4: 0.0, 5: 88.0}
    environment = load(tmp_path, [straight(k, 0, 50, 4.0 * k, speed_limit_mps=v) for k, v in given.items()])
    rows = {
        row["lanelet_id"]: (row["limit_mps"], row["source"]) for row in environment.tables["speed_limit"].to_pylist()
    }
    assert rows == {"1": (13.4, "lane"), "4": (None, "unread"), "5": (None, "unread")}
    assert len(problems(environment, "invalid_speed")) == 2


def test_junctions_are_those_of_the_map(tmp_path: Path) -> None:
    """A group names its intersection, or the intersection its groups."""
    objects = [
        straight(1, 0, 50, 0.0, lane_group_id=10), straight(2, 50, 80, 0.0, lane_group_id=11),
        straight(3, 50, 80, 3.5, lane_group_id=12), group(10, [1], None), group(11, [2], 5), group(12, [3], None),
        intersection(5, [11]), intersection(6, [12]),
    ]  # fmt: skip
    assert {n: row["junction_id"] for n, row in lanelets(load(tmp_path, objects)).items()} == {
        "1": None,
        "2": "5",
        "3": "6",
    }


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
    rows = environment.tables["crossing"].to_pylist()
    found = [(r["crossing_id"], r["lanelet_id"], r["s_start_m"], r["s_end_m"], r["kind"]) for r in rows]
    assert found == ([("7", "1", 20.0, 24.0, None)] if height == 0.0 else [])
    assert problems(environment, "object_without_lane") == ["crossing 8 lies across no lane that vehicles drive on"]


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
    assert (environment.handedness, environment.handedness_source) == (side, source)
    given = load(tmp_path, [straight(1, 0, 50, 0.0)], dataset=dataset, location=location, options={"handedness": "lht"})
    assert (given.handedness, given.handedness_source) == ("lht", "option")


def test_lanes_that_disagree_with_the_place(tmp_path: Path) -> None:
    lanes = [straight(1, 0, 50, 0.0, left_lane_id=2), straight(2, 0, 50, 3.5, back=True, left_lane_id=1)]
    environment = load(tmp_path, lanes, dataset="nuscenes", location="singapore-onenorth")
    assert environment.handedness == "lht"
    assert len(problems(environment, "handedness_disagrees")) == 1


def test_what_is_not_read_is_said(tmp_path: Path) -> None:
    shape = crosswalk(1, 0, 0, 1, 1).shape
    more = [
        Object(LAYERS["walkway"], 1, {}, shape),
        Object(LAYERS["stop_zone"], 2, {}, shape),
        Object(55, 3, {}, shape),
    ]
    environment = load(tmp_path, [straight(1, 0, 50, 0.0), *more], dataset="nuscenes", location="boston-seaport")
    assert problems(environment, "layers_unread") == [
        "objects of layers that are not read: 1 of walkway, 1 of stop zone"
    ]
    assert problems(environment, "unknown_word") == ["layers that 123D does not define: 55: their objects are not read"]
    assert "of lanes through intersections" in problems(environment, "estimated_bounds")[0]
    assert len(problems(environment, "signs_unmapped")) == 1


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
    rows = environment.tables["map_quality"].to_pylist()
    assert {row["lanelet_id"] for row in rows if row["check_id"] == "invalid_lane"} == set("12345678")
    assert "lanelet 1 is left out: another has the same number" in problems(environment, "invalid_lane")


def test_what_is_no_map_of_123d_is_refused(tmp_path: Path) -> None:
    with pytest.raises(MapError, match="has no lane for vehicles that can be built: it has no lane"):
        load(tmp_path, [crosswalk(1, 0, 0, 1, 1)])
    with pytest.raises(MapError, match=r"py123d 0\.9\.0 wrote the file"):
        load(tmp_path, [straight(1, 0, 50, 0.0)], version="0.9.0")
    other = read_source(arrow(tmp_path / "other.arrow", {"a": pa.array([1])}, {}))
    with pytest.raises(MapError, match="no column object_id, map_layer, features, wkb: this is not a map of 123D"):
        load_map(other)
    nameless = {
        name: pa.array([None], kind)
        for name, kind in zip(("object_id", "map_layer"), (pa.int64(), pa.int8()), strict=True)
    }
    blank = {name: pa.array([b""]) for name in ("features", "wkb")}
    with pytest.raises(MapError, match="an object has no number or no layer"):
        load_map(read_source(arrow(tmp_path / "null.arrow", {**nameless, **blank}, {"version": "0.7.0"})))
    whole = read_source(write_map(tmp_path / "map.arrow", [straight(1, 0, 50, 0.0)]))
    with pytest.raises(MapError, match="not readable in Arrow's file format"):
        load_map(MapSource("map.arrow", whole.content[:-100]))
