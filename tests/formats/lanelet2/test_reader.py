"""Lanelet2 maps: neighbours and followers by their bounds, markings, signs, stop lines, crossings, where the map lies."""

from __future__ import annotations

import sys
from collections import Counter

import pytest

from drivelint.errors import MapError
from drivelint.formats import load_map, read_source
from tests.formats.lanelet2.drawing import ORIGIN, Drawing
from tests.formats.maps import checks, hand, lanelet, lanelets, links, values
from tests.shared_data import shared

pytest.importorskip("lanelet2", reason="the package lanelet2 is not installed (extra 'lanelet2')")


def road(drawing: Drawing) -> dict[str, int]:
    """A two-way road of two lanes each way along x, 50 m, the left of travel driven nowhere: right-hand traffic."""
    ways = {y: drawing.way([(0.0, y), (50.0, y)], *look) for y, look in {
        7.0: ("curbstone", "low"), 3.5: ("line_thin", "dashed"), 0.0: ("line_thick", "solid_dashed"),
        -3.5: ("line_thin", "solid"), -7.0: ("road_border", ""),
    }.items()}  # fmt: skip
    return {
        "inner": drawing.lanelet(ways[0.0], ways[-3.5], speed_limit="50"),
        "outer": drawing.lanelet(ways[-3.5], ways[-7.0]),
        "back": drawing.lanelet(ways[0.0], ways[3.5]),
        "back outer": drawing.lanelet(ways[3.5], ways[7.0]),
    }


def test_lanes_side_by_side() -> None:
    drawing = Drawing()
    ids = {name: str(i) for name, i in road(drawing).items()}
    environment = drawing.load()
    inner, outer, back = (ids[name] for name in ("inner", "outer", "back"))
    assert len(lanelets(environment)) == 4
    beside = "left_id left_against right_id right_against"
    assert lanelet(environment, inner, beside) == (back, True, outer, False)
    assert lanelet(environment, back, beside)[:3] == (inner, True, ids["back outer"])
    assert lanelet(environment, outer, "left_id right_id") == (inner, None)
    assert len(set(values(environment, "lanelet", "road_id"))) == 1
    assert lanelet(environment, inner, "along_road road_type") == (1, "town")
    assert lanelet(environment, back, "along_road") == (-1,)
    assert hand(environment) == ("rht", "lanes")
    ((x, y, tx),) = values(environment, "lane_point", "x_m y_m tx", lanelet_id=back, k=0)
    assert (x, y) == pytest.approx((50, 1.75), abs=0.15)
    assert tx == pytest.approx(-1, abs=1e-3)


def test_markings_are_seen_from_the_lane() -> None:
    drawing = Drawing()
    ids = {name: str(i) for name, i in road(drawing).items()}
    marks = values(drawing.load(), "lane_boundary", "lanelet_id side marking")
    seen = {(name, side): marking for name, side, marking in marks}
    # the middle line is solid on its left, which is the side of the lanes that go back
    assert seen[ids["inner"], "left"] == "broken_solid"
    assert seen[ids["back"], "left"] == "solid_broken"
    assert seen[ids["inner"], "right"] == seen[ids["outer"], "left"] == "solid"
    assert seen[ids["outer"], "right"] is None
    assert seen[ids["back outer"], "right"] == "curb"
    assert seen[ids["back outer"], "left"] == "broken"


def test_what_follows_limits_stop_lines_lights_and_crossings() -> None:
    drawing = Drawing()
    ids = {name: str(i) for name, i in road(drawing).items()}
    on = str(drawing.lanelet(drawing.way([(50.0, 0.0), (90.0, 0.0)]), drawing.way([(50.0, -3.5), (90.0, -3.5)])))
    drawing.way([(48.0, 0.0), (48.0, -3.5)], "stop_line", "")
    walk = drawing.lanelet(
        drawing.way([(22.0, -9.0), (22.0, 9.0)], "zebra_marking"), drawing.way([(25.0, -9.0), (25.0, 9.0)], "zebra_marking"),
        subtype="crosswalk",
    )  # fmt: skip
    environment = drawing.load()
    assert links(environment) == [(ids["inner"], on)]
    assert values(environment, "speed_limit", "lanelet_id limit_mps") == [
        (ids["inner"], pytest.approx(50 / 3.6, abs=0.01))
    ]
    assert values(environment, "stop_line", "lanelet_id lane_s_m") == [(ids["inner"], pytest.approx(48, abs=0.1))]
    assert set(values(environment, "crossing", "lanelet_id")) == set(ids.values())
    ((name, kind, *span),) = values(
        environment, "crossing", "crossing_id kind s_start_m s_end_m", lanelet_id=ids["inner"]
    )
    assert (name, kind) == (str(walk), "zebra")
    assert span == pytest.approx([22, 25], abs=0.1)


@pytest.mark.parametrize("speed_limit", ["", "walk", "-5", "inf"])
def test_a_limit_that_cannot_be_read_is_no_limit_of_zero(speed_limit: str) -> None:
    drawing = Drawing()
    left, right = (drawing.way([(0.0, y), (50.0, y)]) for y in (0.0, -3.5))
    lane = str(drawing.lanelet(left, right, speed_limit=speed_limit))
    environment = drawing.load()
    assert values(environment, "speed_limit", "limit_mps source") == [(None, "unread")]
    assert lane in checks(environment)["invalid_speed"]


def test_local_coordinates_come_before_the_globe() -> None:
    drawing = Drawing(local=True)
    ids = road(drawing)
    first = values(drawing.load(origin=None), "lane_point", "x_m y_m", lanelet_id=str(ids["inner"]), k=0)
    assert first == [(0.0, -1.75)]


def test_local_coordinates_need_no_latitude_and_longitude() -> None:
    """As Autoware writes it: which bound is the left one and which way a lane runs follows from the local coordinates."""
    drawing = Drawing(local=True, globe=False)
    ids = road(drawing)
    environment = drawing.load(origin=None, offset=(10.0, 0.0))
    for name, first in (("inner", (10.0, -1.75, 1.0)), ("back", (60.0, 1.75, -1.0))):
        assert values(environment, "lane_point", "x_m y_m tx", lanelet_id=str(ids[name]), k=0) == [first]
    assert hand(environment) == ("rht", "lanes")
    assert checks(environment) == {}
    assert values(environment, "environment", "geo_reference") == [None]


def test_local_coordinates_go_before_an_origin_and_that_is_said() -> None:
    drawing = Drawing(local=True)
    road(drawing)
    environment = drawing.load(origin=(35.0, 139.0))
    assert list(checks(environment)) == ["map_origin_unused"]
    assert values(environment, "environment", "geo_reference") == [None]


def test_a_lane_with_a_node_that_has_no_place_is_named_and_no_other() -> None:
    drawing = Drawing(local=True, globe=False)
    ids = road(drawing)
    at = drawing.nodes[(50.0, -7.0)]
    drawing.parts[next(i for i, part in enumerate(drawing.parts) if part.startswith(f'<node id="{at}"'))] = (
        f'<node id="{at}" lat="49.1" lon="8.1"><tag k="local_x" v=""/></node>'
    )
    environment = drawing.load(origin=None)
    assert checks(environment) == {"unplaced_node": [None], "invalid_lane": [str(ids["outer"])]}
    assert len(lanelets(environment)) == 3


def test_a_lane_whose_bound_has_no_points_is_left_out_and_named() -> None:
    drawing = Drawing()
    ids = road(drawing)
    empty = drawing.lanelet(drawing.way([]), drawing.way([(0.0, 20.0), (50.0, 20.0)]))
    environment = drawing.load()
    assert str(empty) in values(environment, "map_quality", "lanelet_id", check_id="invalid_lane", severity="error")
    assert len(lanelets(environment)) == len(ids)


@pytest.mark.parametrize("left", [[], [(10.0, -5.0)]])
def test_a_crossing_whose_bound_is_no_line_is_left_out_and_named(left: list[tuple[float, float]]) -> None:
    drawing = Drawing()
    road(drawing)
    walk = drawing.lanelet(drawing.way(left), drawing.way([(12.0, -5.0)]), subtype="crosswalk")
    environment = drawing.load()
    assert str(walk) in values(environment, "map_quality", "lanelet_id", check_id="invalid_lane", severity="error")
    assert environment.tables["crossing"].num_rows == 0


def test_a_stop_line_and_its_sign_hold_for_the_lanes_that_refer_to_them() -> None:
    drawing = Drawing(local=True, globe=False)
    line = drawing.way([(40.2, 1.0), (40.2, -4.5)], "stop_line", "solid")
    sign = drawing.way([(41.0, -5.0), (41.0, -5.4)], "traffic_sign", "stop_sign")
    element = drawing.element(refers=[sign], ref_line=[line])
    lefts = [drawing.way([(0.0, 0.0), (40.0, 0.0)]), drawing.way([(40.0, 0.0), (60.0, 0.0)])]
    rights = [drawing.way([(0.0, -3.5), (40.0, -3.5)]), drawing.way([(40.0, -3.5), (60.0, -3.5)])]
    before = str(drawing.lanelet(lefts[0], rights[0], element, speed_limit="15"))
    drawing.lanelet(lefts[1], rights[1])
    environment = drawing.load(origin=None)
    assert values(environment, "stop_line", "lanelet_id lane_s_m") == [(before, 40.0)]
    assert values(environment, "traffic_signal", "kind lanelet_id lane_s_m x_m") == [("stop", before, 40.0, 40.0)]
    assert values(environment, "speed_limit", "limit_mps") == [pytest.approx(15.0 / 3.6, abs=1e-6)]


def test_at_an_all_way_stop_every_lane_has_a_stop_sign_at_its_line() -> None:
    drawing = Drawing(local=True, globe=False)
    lines = [
        drawing.way([(40.0, 0.0), (40.0, -3.5)], "stop_line", ""),
        drawing.way([(60.0, 3.5), (60.0, 0.0)], "stop_line", ""),
    ]
    east = drawing.way([(0.0, 0.0), (40.0, 0.0)]), drawing.way([(0.0, -3.5), (40.0, -3.5)])
    west = drawing.way([(99.0, 0.0), (60.0, 0.0)]), drawing.way([(99.0, 3.5), (60.0, 3.5)])
    names = drawing.count + 2, drawing.count + 3
    element = drawing.element("all_way_stop", yields=names, ref_line=lines)
    assert (drawing.lanelet(east[0], east[1], element), drawing.lanelet(west[0], west[1], element)) == names
    environment = drawing.load(origin=None)
    assert values(environment, "traffic_signal", "kind lanelet_id lane_s_m dynamic") == [
        ("stop", str(names[0]), 40.0, False),
        ("stop", str(names[1]), 39.0, False),
    ]
    assert values(environment, "stop_line", "lanelet_id lane_s_m") == [(str(names[0]), 40.0), (str(names[1]), 39.0)]


def test_a_sign_that_applies_only_under_a_condition_is_dynamic() -> None:
    drawing = Drawing(local=True, globe=False)
    element = drawing.element(refers=[drawing.way([(5.0, -5.0), (5.0, -5.4)], "traffic_sign", "de276")])
    drawing.tag_last(dynamic="yes")
    drawing.lanelet(drawing.way([(0.0, 0.0), (40.0, 0.0)]), drawing.way([(0.0, -3.5), (40.0, -3.5)]), element)
    assert values(drawing.load(origin=None), "traffic_signal", "kind dynamic") == [("no_overtaking", True)]


def test_a_map_on_the_globe_needs_its_origin() -> None:
    drawing = Drawing()
    road(drawing)
    with pytest.raises(MapError, match="--map-origin LAT,LON"):
        drawing.load(origin=None)


def test_a_plain_street_map_is_refused() -> None:
    drawing = Drawing()
    drawing.way([(0.0, 0.0), (50.0, 0.0)])
    with pytest.raises(MapError, match="no lanelet"):
        drawing.load()


def test_the_package_that_is_missing_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "lanelet2", None)
    drawing = Drawing()
    road(drawing)
    with pytest.raises(MapError, match=r"pip install 'drivelint\[lanelet2\]'"):
        drawing.load()


def test_the_real_map() -> None:
    environment = load_map(read_source(shared("maps/lanelet2_mapping_example.osm")), origin=ORIGIN)
    tables = environment.tables
    # 17 roads are tagged as for bicycles and people on foot only
    assert Counter(values(environment, "lanelet", "lane_type")) == {
        "driving": 328,
        "biking": 14,
        "rail": 2,
        "sidewalk": 19,
    }
    assert hand(environment) == ("rht", "lanes")
    assert set(values(environment, "traffic_signal", "kind")) == {"traffic_light", "give_way", "priority_here"}
    assert (tables["stop_line"].num_rows, tables["crossing"].num_rows, tables["lane_link"].num_rows) == (29, 14, 321)
    # a line between two lanes stands at the end of the first, and is there once
    lines = values(environment, "stop_line", "lanelet_id lane_s_m")
    ends, starts = {name for name, s in lines if s > 1.0}, {name for name, s in lines if s == 0.0}
    assert not {(a, b) for a, b in links(environment) if a in ends and b in starts}


@pytest.mark.parametrize(
    ("file", "counts", "limits", "stops", "crossings"),
    [
        ("autoware_cargo_transport_map.osm", (88, 91), {30: 88}, 0, 0),
        # one of its seven crossings lies across a footpath only
        ("autoware_zalazone_smart_city.osm", (218, 261), {30: 203, 10: 13, 15: 2}, 37, 6),
    ],
)
def test_real_maps_of_autoware_need_no_origin(
    file: str, counts: tuple[int, int], limits: dict[int, int], stops: int, crossings: int
) -> None:
    environment = load_map(read_source(shared(f"maps/{file}")))
    assert "error" not in values(environment, "map_quality", "severity")
    assert (len(lanelets(environment)), len(links(environment))) == counts
    assert Counter(round(limit * 3.6) for limit in values(environment, "speed_limit", "limit_mps")) == limits
    lines = values(environment, "stop_line", "lanelet_id lane_s_m")
    assert set(values(environment, "traffic_signal", "lanelet_id lane_s_m", kind="stop")) == set(lines)
    assert len(set(lines)) == len(lines) == stops
    assert len(set(values(environment, "crossing", "crossing_id"))) == crossings
