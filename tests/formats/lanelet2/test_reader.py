"""Lanelet2 maps: neighbours and followers by their bounds, markings, signs, stop lines, crossings, where the map lies."""

from __future__ import annotations

import sys
from collections import Counter

import pytest

from drivelint.errors import MapError
from drivelint.formats import load_map, read_source
from tests.formats.lanelet2.drawing import ORIGIN, Drawing
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
    rows = {row["lanelet_id"]: row for row in environment.tables["lanelet"].to_pylist()}
    assert len(rows) == 4
    inner, outer, back = rows[ids["inner"]], rows[ids["outer"]], rows[ids["back"]]
    assert (inner["left_id"], inner["left_against"], inner["right_id"], inner["right_against"]) == (
        ids["back"], True, ids["outer"], False,
    )  # fmt: skip
    assert (back["left_id"], back["left_against"], back["right_id"]) == (ids["inner"], True, ids["back outer"])
    assert (outer["left_id"], outer["right_id"]) == (ids["inner"], None)
    assert len({row["road_id"] for row in rows.values()}) == 1
    assert (inner["along_road"], back["along_road"], inner["road_type"]) == (1, -1, "town")
    assert (environment.handedness, environment.handedness_source) == ("rht", "lanes")
    points = [row for row in environment.tables["lane_point"].to_pylist() if row["lanelet_id"] == ids["back"]]
    assert (points[0]["x_m"], points[0]["y_m"]) == pytest.approx((50, 1.75), abs=0.15)
    assert points[0]["tx"] == pytest.approx(-1, abs=1e-3)


def test_markings_are_seen_from_the_lane() -> None:
    drawing = Drawing()
    ids = {name: str(i) for name, i in road(drawing).items()}
    rows = drawing.load().tables["lane_boundary"].to_pylist()
    seen = {(row["lanelet_id"], row["side"]): row["marking"] for row in rows}
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
    tables = drawing.load().tables
    assert [(r["from_id"], r["to_id"]) for r in tables["lane_link"].to_pylist()] == [(ids["inner"], on)]
    assert [(r["lanelet_id"], round(r["limit_mps"] * 3.6)) for r in tables["speed_limit"].to_pylist()] == [
        (ids["inner"], 50)
    ]
    assert [(r["lanelet_id"], r["lane_s_m"]) for r in tables["stop_line"].to_pylist()] == [
        (ids["inner"], pytest.approx(48, abs=0.1))
    ]
    crossings = {r["lanelet_id"]: r for r in tables["crossing"].to_pylist()}
    assert set(crossings) == set(ids.values())
    row = crossings[ids["inner"]]
    assert (row["crossing_id"], row["kind"]) == (str(walk), "zebra")
    assert (row["s_start_m"], row["s_end_m"]) == pytest.approx((22, 25), abs=0.1)


@pytest.mark.parametrize("said", ["", "walk", "-5", "inf"])
def test_a_limit_that_cannot_be_read_is_no_limit_of_zero(said: str) -> None:
    drawing = Drawing()
    left, right = (drawing.way([(0.0, y), (50.0, y)]) for y in (0.0, -3.5))
    lane = str(drawing.lanelet(left, right, speed_limit=said))
    tables = drawing.load().tables
    assert [(r["limit_mps"], r["source"]) for r in tables["speed_limit"].to_pylist()] == [(None, "unread")]
    assert ("invalid_speed", lane) in {(r["check_id"], r["lanelet_id"]) for r in tables["map_quality"].to_pylist()}


def test_local_coordinates_come_before_the_globe() -> None:
    drawing = Drawing(local=True)
    ids = road(drawing)
    points = drawing.load(origin=None).tables["lane_point"].to_pylist()
    first = next(row for row in points if row["lanelet_id"] == str(ids["inner"]))
    assert (first["x_m"], first["y_m"]) == (0.0, -1.75)


def test_local_coordinates_need_no_latitude_and_longitude() -> None:
    """As Autoware writes it: which bound is the left one and which way a lane runs follows from the local coordinates."""
    drawing = Drawing(local=True, globe=False)
    ids = road(drawing)
    environment = drawing.load(origin=None, offset=(10.0, 0.0))
    points = environment.tables["lane_point"].to_pylist()
    way = {name: [(r["x_m"], r["y_m"], r["tx"]) for r in points if r["lanelet_id"] == str(ids[name])] for name in ids}
    assert way["inner"][0] == (10.0, -1.75, 1.0)
    assert way["back"][0] == (60.0, 1.75, -1.0)
    assert (environment.handedness, environment.handedness_source) == ("rht", "lanes")
    assert environment.tables["map_quality"].num_rows == 0
    assert environment.tables["environment"]["geo_reference"].to_pylist() == [None]


def test_local_coordinates_go_before_an_origin_and_that_is_said() -> None:
    drawing = Drawing(local=True)
    road(drawing)
    environment = drawing.load(origin=(35.0, 139.0))
    assert environment.tables["map_quality"]["check_id"].to_pylist() == ["map_origin_unused"]
    assert environment.tables["environment"]["geo_reference"].to_pylist() == [None]


def test_a_lane_with_a_node_that_has_no_place_is_named_and_no_other() -> None:
    drawing = Drawing(local=True, globe=False)
    ids = road(drawing)
    at = drawing.nodes[(50.0, -7.0)]
    drawing.parts[next(i for i, part in enumerate(drawing.parts) if part.startswith(f'<node id="{at}"'))] = (
        f'<node id="{at}" lat="49.1" lon="8.1"><tag k="local_x" v=""/></node>'
    )
    tables = drawing.load(origin=None).tables
    lost = {(r["check_id"], r["lanelet_id"]) for r in tables["map_quality"].to_pylist()}
    assert lost == {("unplaced_node", None), ("invalid_lane", str(ids["outer"]))}
    assert tables["lanelet"].num_rows == 3


def test_a_lane_whose_bound_has_no_points_is_left_out_and_named() -> None:
    drawing = Drawing()
    ids = road(drawing)
    empty = drawing.lanelet(drawing.way([]), drawing.way([(0.0, 20.0), (50.0, 20.0)]))
    tables = drawing.load().tables
    lost = {(r["check_id"], r["lanelet_id"]) for r in tables["map_quality"].to_pylist() if r["severity"] == "error"}
    assert ("invalid_lane", str(empty)) in lost
    assert tables["lanelet"].num_rows == len(ids)


@pytest.mark.parametrize("left", [[], [(10.0, -5.0)]])
def test_a_crossing_whose_bound_is_no_line_is_left_out_and_named(left: list[tuple[float, float]]) -> None:
    drawing = Drawing()
    road(drawing)
    walk = drawing.lanelet(drawing.way(left), drawing.way([(12.0, -5.0)]), subtype="crosswalk")
    tables = drawing.load().tables
    lost = {(r["check_id"], r["lanelet_id"]) for r in tables["map_quality"].to_pylist() if r["severity"] == "error"}
    assert ("invalid_lane", str(walk)) in lost
    assert tables["crossing"].num_rows == 0


def test_a_stop_line_and_its_sign_hold_for_the_lanes_that_refer_to_them() -> None:
    drawing = Drawing(local=True, globe=False)
    line = drawing.way([(40.2, 1.0), (40.2, -4.5)], "stop_line", "solid")
    sign = drawing.way([(41.0, -5.0), (41.0, -5.4)], "traffic_sign", "stop_sign")
    element = drawing.element(refers=[sign], ref_line=[line])
    lefts = [drawing.way([(0.0, 0.0), (40.0, 0.0)]), drawing.way([(40.0, 0.0), (60.0, 0.0)])]
    rights = [drawing.way([(0.0, -3.5), (40.0, -3.5)]), drawing.way([(40.0, -3.5), (60.0, -3.5)])]
    before = str(drawing.lanelet(lefts[0], rights[0], element, speed_limit="15"))
    drawing.lanelet(lefts[1], rights[1])
    tables = drawing.load(origin=None).tables
    assert [(r["lanelet_id"], r["lane_s_m"]) for r in tables["stop_line"].to_pylist()] == [(before, 40.0)]
    (row,) = tables["traffic_signal"].to_pylist()
    assert (row["kind"], row["lanelet_id"], row["lane_s_m"], row["x_m"]) == ("stop", before, 40.0, 40.0)
    assert [round(r["limit_mps"] * 3.6, 6) for r in tables["speed_limit"].to_pylist()] == [15.0]


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
    lanes = tables["lanelet"].to_pylist()
    kinds = Counter(row["lane_type"] for row in lanes)
    # 17 roads are tagged as for bicycles and people on foot only
    assert kinds == {"driving": 328, "biking": 14, "rail": 2, "sidewalk": 19}
    assert (environment.handedness, environment.handedness_source) == ("rht", "lanes")
    assert {row["kind"] for row in tables["traffic_signal"].to_pylist()} == {
        "traffic_light",
        "give_way",
        "priority_here",
    }
    assert (tables["stop_line"].num_rows, tables["crossing"].num_rows, tables["lane_link"].num_rows) == (29, 14, 321)
    # a line between two lanes stands at the end of the first, and is there once
    ends = {row["lanelet_id"] for row in tables["stop_line"].to_pylist() if row["lane_s_m"] > 1.0}
    links = {(row["from_id"], row["to_id"]) for row in tables["lane_link"].to_pylist()}
    starts = {row["lanelet_id"] for row in tables["stop_line"].to_pylist() if row["lane_s_m"] == 0.0}
    assert not {(a, b) for a, b in links if a in ends and b in starts}


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
    tables = environment.tables
    assert not [row for row in tables["map_quality"].to_pylist() if row["severity"] == "error"]
    assert (tables["lanelet"].num_rows, tables["lane_link"].num_rows) == counts
    assert Counter(round(row["limit_mps"] * 3.6) for row in tables["speed_limit"].to_pylist()) == limits
    signs = {(r["lanelet_id"], r["lane_s_m"]) for r in tables["traffic_signal"].to_pylist() if r["kind"] == "stop"}
    lines = {(r["lanelet_id"], r["lane_s_m"]) for r in tables["stop_line"].to_pylist()}
    assert signs == lines
    assert (len(lines), tables["stop_line"].num_rows) == (stops, stops)
    assert len(set(tables["crossing"]["crossing_id"].to_pylist())) == crossings
