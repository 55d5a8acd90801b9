"""Argoverse's maps: bounds, neighbours of both directions, links, junctions, markings, crossings, and what is broken."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import pytest
from pyproj import Transformer

from drivelint.errors import MapError
from drivelint.formats.argoverse2.cities import CITY_ORIGINS_IN_UTM, frame_of_city
from tests.formats.argoverse2.argoverse_log import load, points, road, segment, straight
from tests.formats.maps import checks, hand, lanelet, lanelets, links, messages, rows, values
from tests.formats.maps import points as lane_points


def two_ways(**more: Any) -> dict[str, Any]:
    """Return a road along x: 1 and 2 to the east, 2 on the right; 3 to the west, on the left of 1; 4 a bicycle lane, right of 2."""
    return road(
        straight(1, 2.0, right_neighbor_id=2, left_neighbor_id=3, left_lane_mark_type="DOUBLE_SOLID_YELLOW",
                 right_lane_mark_type="DASHED_WHITE", **more),
        straight(2, -2.0, left_neighbor_id=1, right_neighbor_id=4, left_lane_mark_type="DASHED_WHITE", lane_type="BUS"),
        straight(3, 6.0, 150.0, -50.0, left_neighbor_id=1, left_lane_mark_type="DOUBLE_SOLID_YELLOW"),
        straight(4, -5.0, width=2.0, left_neighbor_id=2, lane_type="BIKE", right_lane_mark_type="SOLID_WHITE"),
    )  # fmt: skip


def test_lanes_and_their_neighbours() -> None:
    """Which way a neighbour is driven, the file does not say."""
    environment = load(two_ways())
    columns = "lanelet_id left_id left_against right_id right_against lane_type drivable along_road"
    assert sorted(values(environment, "lanelet", columns)) == [
        ("1", "3", True, "2", False, "driving", True, 1), ("2", "1", False, "4", False, "bus", True, 1),
        ("3", "1", True, None, None, "driving", True, -1), ("4", "2", False, None, None, "biking", False, 1),
    ]  # fmt: skip
    assert len(set(values(environment, "lanelet", "road_id"))) == 1
    assert lanelet(environment, "1", "length_m width_m") == pytest.approx((200.0, 4.0))
    assert values(environment, "environment", "format handedness handedness_source") == [("argoverse2", "rht", "lanes")]
    assert {environment.tables[name].num_rows for name in ("speed_limit", "traffic_signal", "stop_line")} == {0}


def test_a_bound_is_shared_although_its_points_are_not() -> None:
    """The bound in the middle has other points on each side, and the neighbour's is a hand's breadth off."""
    first = segment(1, points((0, 2), (40, 2.5), (100, 2)), points((0, -2), (100, -2)), left_neighbor_id=2)
    second = segment(2, points((100, 2.2), (0, 2.2)), points((100, 6), (0, 6)), left_neighbor_id=1)
    assert values(load(road(first, second)), "lanelet", "left_against") == [True, True]


def test_one_way_streets_drive_on_the_right_as_argoverse_s_cities_do() -> None:
    assert hand(load(road(straight(1)))) == ("rht", "attribute")
    assert hand(load(road(straight(1)), handedness="lht")) == ("lht", "option")


MARKS = {
    "SOLID_WHITE": ("solid", "white"), "SOLID_YELLOW": ("solid", "yellow"), "SOLID_BLUE": ("solid", "blue"),
    "DASHED_WHITE": ("broken", "white"), "DASHED_YELLOW": ("broken", "yellow"),
    "DOUBLE_SOLID_YELLOW": ("solid_solid", "yellow"), "DOUBLE_SOLID_WHITE": ("solid_solid", "white"),
    "DOUBLE_DASH_YELLOW": ("broken_broken", "yellow"), "DOUBLE_DASH_WHITE": ("broken_broken", "white"),
    "SOLID_DASH_WHITE": ("solid_broken", "white"), "SOLID_DASH_YELLOW": ("solid_broken", "yellow"),
    "DASH_SOLID_WHITE": ("broken_solid", "white"), "DASH_SOLID_YELLOW": ("broken_solid", "yellow"),
    "NONE": ("none", None), "UNKNOWN": (None, None),
}  # fmt: skip


@pytest.mark.parametrize("word", MARKS)
def test_every_marking(word: str) -> None:
    """The fifteen of av2-api's `LaneMarkType`, which draws the line that is named first on the lane's side of a double one."""
    environment = load(road(straight(1, left_lane_mark_type=word)))
    marks = values(environment, "lane_boundary", "marking color s_start_m s_end_m", side="left")
    assert marks == [(*MARKS[word], 0.0, 200.0)]
    assert checks(environment) == {}


def test_words_that_are_not_known_are_named() -> None:
    environment = load(road(straight(1), straight(2, 9.0, lane_type="TRAM", left_lane_mark_type="DOTTED_PINK")))
    (message,) = messages(environment, "unknown_word")
    assert message.endswith("DOTTED_PINK (1), TRAM (1)")
    assert lanelet(environment, "2", "lane_type drivable") == ("none", False)


def test_a_map_that_is_cut_says_so() -> None:
    """Of a lane that goes on beyond the map nothing is claimed: it has no link, and no end of its own."""
    environment = load(road(straight(1, successors=[2, 99], left_neighbor_id=98), straight(2, begin=150.0, end=250.0)))
    assert links(environment) == [("1", "2")]
    assert lanelets(environment)["1"]["left_id"] is None
    (row,) = rows(environment, "map_quality")
    assert (row["check_id"], row["severity"], row["n"]) == ("missing_link", "info", 2)
    assert "1 lanes that follow its lanes and 1 lanes beside them" in row["message"]


def crossroads(z: float = 0.0) -> dict[str, Any]:
    """Return two one-way streets that cross, with a way to turn, and another junction 100 m on; z: the height of the second street."""
    inside = {"is_intersection": True}
    bend = [(10 * math.cos(a), 10 * math.sin(a)) for a in (math.pi, 0.75 * math.pi, 0.5 * math.pi)]
    return road(
        straight(1, begin=-50.0, end=-5.0, successors=[2, 4]),
        straight(2, begin=-5.0, end=5.0, successors=[3], **inside),
        straight(3, begin=5.0, end=105.0, successors=[7]),
        segment(4, points(*((x - 5, 12 - y) for x, y in bend)), points(*((x - 5, 8 - y) for x, y in bend)), **inside),
        segment(5, points((-2, -5), (-2, 5), z=z), points((2, -5), (2, 5), z=z), **inside),
        straight(7, begin=105.0, end=115.0, **inside),
    )  # fmt: skip


def test_lanes_inside_an_intersection_are_one_junction() -> None:
    """2 and 4 begin at the same lane, 5 lies across 2; 7 is another junction."""
    found = values(load(crossroads()), "lanelet", "lanelet_id junction_id")
    assert dict(found) == {"1": None, "2": "j2", "3": None, "4": "j2", "5": "j2", "7": "j7"}


def test_a_bridge_is_no_part_of_the_junction_below() -> None:
    found = dict(values(load(crossroads(z=6.0)), "lanelet", "lanelet_id junction_id"))
    assert (found["2"], found["5"]) == ("j2", "j5")


def test_lanes_have_heights() -> None:
    """A lane that climbs by a metre, its left bound 0.2 m above its right."""
    content = road(segment(1, points((0, 2, 5.2), (100, 2, 6.2)), points((0, -2, 5.0), (100, -2, 6.0))))
    for row in lane_points(load(content, offset=(1000.0, -500.0)))["1"]:
        assert row["z_m"] == pytest.approx(5.1 + row["s_m"] / 100)
        assert (row["left_y_m"], row["right_y_m"]) == (pytest.approx(-498.0), pytest.approx(-502.0))
    for point in content["lane_segments"]["1"]["left_lane_boundary"]:
        del point["z"]
    assert {row["z_m"] for row in lane_points(load(content))["1"]} == {None}


@pytest.mark.parametrize("turned", [False, True])
def test_crossings_lie_across_lanes(turned: bool) -> None:
    """The edges should point the same way; where they do not, the ground between them is the same."""
    edges = [points((10, 9), (10, -9)), points((14, 9), (14, -9))]
    crossing = {"id": 7, "edge1": edges[0], "edge2": edges[1][::-1] if turned else edges[1]}
    environment = load({**two_ways(), "pedestrian_crossings": {"7": crossing}})
    assert sorted(values(environment, "crossing", "crossing_id lanelet_id s_start_m s_end_m kind")) == [
        ("7", "1", 60.0, 64.0, None), ("7", "2", 60.0, 64.0, None), ("7", "3", 136.0, 140.0, None),
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"successors": None}, "not iterable"),
        ({"left_lane_boundary": []}, "fewer than two points"),
        ({"left_lane_boundary": points((0, 2), (math.nan, 2))}, "an impossible coordinate"),
        ({"left_lane_boundary": points((0, -6), (100, -6))}, "its left bound lies on the right"),
        ({"right_lane_boundary": [{"x": 1.0}, {"x": 2.0}]}, "it has no 'y'"),
        ({"id": "eleven"}, "eleven"),
        ({"id": 1}, "another segment has the same id"),
    ],
)
def test_a_lane_that_cannot_be_read_is_named_and_the_others_stay(change: dict[str, Any], says: str) -> None:
    content = two_ways()
    content["lane_segments"]["2"].update(change)
    environment = load(content)
    assert set(lanelets(environment)) == {"1", "3", "4"}
    (row,) = rows(environment, "map_quality", check_id="invalid_lane")
    assert (row["severity"], row["lanelet_id"]) == ("error", "2")
    assert says in row["message"]


def test_a_field_that_is_missing_is_named() -> None:
    content = road(straight(1), straight(2, 9.0))
    del content["lane_segments"]["2"]["is_intersection"]
    content["pedestrian_crossings"] = {"5": {"id": 5, "edge1": points((0, 0), (0, 4))}, "6": {"id": 6, "edge1": []}}
    found = dict(values(load(content), "map_quality", "lanelet_id message"))
    assert "lane segment 2 is left out: it has no 'is_intersection'" in found["2"]
    assert "crossing 5 is left out: it has no 'edge2'" in found["5"]
    assert "crossing 6 is left out: a line has fewer than two points" in found["6"]


def test_a_map_without_the_table_of_crossings() -> None:
    content = road(straight(1))
    del content["pedestrian_crossings"]
    assert set(lanelets(load(content))) == {"1"}


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (json.dumps(road(straight(1))).encode()[:-30], "not readable as JSON"),
        (b"{" * 100_000, "not readable as JSON"),
        (b'{"R": [1.0], "t": [0.0], "s": 3.3}', "not a map of Argoverse 2"),
        (b'{"lane_segments": []}', "not a map of Argoverse 2"),
        (json.dumps(road()).encode(), "no lane that can be built"),
        (json.dumps(road({"id": 1})).encode(), "no lane that can be built: lane segment 1 is left out"),
    ],
)
def test_files_that_are_no_such_map(content: bytes, says: str) -> None:
    with pytest.raises(MapError, match=says) as error:
        load(content)
    assert "\n" not in str(error.value)


PUBLISHED = {
    "ATX": (30.27464237939507, -97.7404457407424), "DTW": (42.29993066912924, -83.17555750783717),
    "MIA": (25.77452579915163, -80.19656914449405), "PAO": (37.416065, -122.13571963362166),
    "PIT": (40.44177902989321, -80.01294377242584), "WDC": (38.889377, -77.0355047439081),
}  # fmt: skip
"""Latitude and longitude of the origins, as av2-api's `geometry/utm.py` has them."""


@pytest.mark.parametrize("city", PUBLISHED)
def test_a_city_s_origin_is_where_it_is_published(city: str) -> None:
    frame = frame_of_city(city)
    assert frame is not None
    ((longitude, latitude),) = frame.longitude_latitude(np.zeros((1, 2))).tolist()
    assert (latitude, longitude) == pytest.approx(PUBLISHED[city], abs=2e-9)
    east, north = Transformer.from_crs("EPSG:4326", frame.reference, always_xy=True).transform(*PUBLISHED[city][::-1])
    assert (east, north) == pytest.approx(CITY_ORIGINS_IN_UTM[city][1:], abs=1e-3)


def test_the_city_is_in_the_name_of_the_file() -> None:
    utm = "+proj=utm +zone=18 +datum=WGS84 +units=m +no_defs"
    for name, reference in (("x____WDC_city_5", utm), ("x", None), ("x____XXX_city_5", None)):
        environment = load(road(straight(1)), f"log_map_archive_{name}.json")
        assert values(environment, "environment", "geo_reference") == [reference]
