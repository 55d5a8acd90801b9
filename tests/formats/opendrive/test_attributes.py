"""Types, limits, marks, signals, stop lines, objects and crossings on small maps."""

from __future__ import annotations

from typing import Any

import pytest

from drivelint.road.signcodes import signal_kind
from tests.formats.opendrive.signal_text import WIDTH, signal
from tests.formats.opendrive.xodr import LINE, checks, lane, lanelets, load, road, rows, section


def limits(environment: Any, name: str) -> list[tuple[float, float, float | None, str]]:
    return [
        (round(r["s_start_m"], 6), round(r["s_end_m"], 6), r["limit_mps"], r["source"])
        for r in rows(environment, "speed_limit")
        if r["lanelet_id"] == name
    ]


def marks(environment: Any, name: str, side: str) -> list[tuple[float, float, str | None]]:
    return [
        (round(r["s_start_m"], 6), round(r["s_end_m"], 6), r["marking"])
        for r in rows(environment, "lane_boundary")
        if (r["lanelet_id"], r["side"]) == (name, side)
    ]


def test_limits_come_from_the_lane_then_the_road_type() -> None:
    types = (
        '<type s="0" type="town"><speed max="50" unit="km/h"/></type>'
        '<type s="60" type="motorway"><speed max="no limit"/></type><type s="90" type="rural"/>'
    )
    lanes = section(
        0, lane(1), lane(-1, WIDTH + '<speed sOffset="20" max="30" unit="mph"/><speed sOffset="40" max="undefined"/>')
    )
    environment = load(road(lanes=lanes, more=types))
    assert limits(environment, "1.0.-1") == [
        (0, 20, pytest.approx(13.8889, abs=1e-3), "road_type"),
        (20, 40, pytest.approx(13.4112), "lane"),
        (40, 60, pytest.approx(13.8889, abs=1e-3), "road_type"),
        (60, 90, None, "road_type"),
    ]
    # the other lane is driven against the stations
    assert limits(environment, "1.0.1") == [
        (10, 40, None, "road_type"),
        (40, 100, pytest.approx(13.8889, abs=1e-3), "road_type"),
    ]
    assert lanelets(environment)["1.0.1"]["road_type"] == "town"


def test_a_limit_without_a_unit_is_in_metres_per_second_and_nonsense_is_named() -> None:
    plain = load(road(lanes=section(0, lane(-1, WIDTH + '<speed sOffset="0" max="9"/>'))))
    assert limits(plain, "1.0.-1") == [(0, 100, 9.0, "lane")]
    broken = load(road(lanes=section(0, lane(-1, WIDTH + '<speed sOffset="0" max="fast" unit="mph"/>'))))
    assert limits(broken, "1.0.-1") == [(0, 100, None, "unread")]
    assert "invalid_speed" in checks(broken)
    assert "1.0.-1" in lanelets(broken)


def test_the_stand_in_of_netconvert_for_a_road_without_a_limit_is_unknown() -> None:
    """netconvert 1.28.0 writes 39.44 m/s for OpenStreetMap's `maxspeed=none`, and for a motorway without a limit (findings/)."""
    free = load(road(lanes=section(0, lane(-1, WIDTH + '<speed sOffset="0" max="39.44"/>'))))
    assert limits(free, "1.0.-1") == [(0, 100, None, "unread")]
    assert "invalid_speed" in checks(free)


def test_marks_are_seen_from_each_lanelet() -> None:
    centre = '<roadMark sOffset="0" type="solid broken" color="yellow" laneChange="none"/>'
    edge = (
        WIDTH + '<roadMark sOffset="30" type="broken" laneChange="both"/><roadMark sOffset="70" type="solid broken"/>'
    )
    lanes = section(0, lane(1), lane(-1, edge), lane(-2), centre=centre)
    environment = load(road(lanes=lanes))
    assert marks(environment, "1.0.-1", "right") == [(0, 30, None), (30, 70, "broken"), (70, 100, "solid_broken")]
    # from the lane beyond it, the same double line shows its broken half first
    assert marks(environment, "1.0.-2", "left") == [(0, 30, None), (30, 70, "broken"), (70, 100, "broken_solid")]
    assert marks(environment, "1.0.-2", "right") == [(0, 100, None)]
    # the centre line is named from left to right: solid towards lane 1, broken towards lane -1
    assert marks(environment, "1.0.1", "left") == [(0, 100, "solid_broken")]
    assert marks(environment, "1.0.-1", "left") == [(0, 100, "broken_solid")]
    left_hand = load(road(lanes=lanes), handedness="lht")
    assert marks(left_hand, "1.0.-1", "left") == [(0, 30, "solid_broken"), (30, 70, "broken"), (70, 100, None)]
    assert marks(left_hand, "1.0.1", "right") == [(0, 100, "solid_broken")]
    row = next(r for r in rows(environment, "lane_boundary") if (r["lanelet_id"], r["side"]) == ("1.0.-1", "left"))
    assert (row["color"], row["lane_change"]) == ("yellow", "none")


def test_drivable_is_decided_by_type() -> None:
    kinds = ["driving", "exit", "bus", "shoulder", "sidewalk", "stop", "biking"]
    lanes = section(0, *(lane(-n, kind=kind) for n, kind in enumerate(kinds, 1)))
    found = {row["lane_type"]: row["drivable"] for row in lanelets(load(road(lanes=lanes))).values()}
    assert found == dict.fromkeys(kinds[:3], True) | dict.fromkeys(kinds[3:], False)


def signals(environment: Any) -> list[tuple[str, float]]:
    return [(r["lanelet_id"], round(r["lane_s_m"], 6)) for r in rows(environment, "traffic_signal")]


TWO_WAYS = section(0, lane(1), lane(2, kind="sidewalk"), lane(-1), lane(-2))


@pytest.mark.parametrize(
    ("orientation", "held"),
    [
        ("+", [("1.0.-1", 30.0), ("1.0.-2", 30.0)]),
        ("-", [("1.0.1", 70.0)]),
        ("none", [("1.0.-1", 30.0), ("1.0.-2", 30.0), ("1.0.1", 70.0)]),
    ],
)
def test_signals_hold_for_the_lanes_of_their_direction(orientation: str, held: list[tuple[str, float]]) -> None:
    environment = load(road(lanes=TWO_WAYS, more=f"<signals>{signal(30, orientation)}</signals>"))
    assert signals(environment) == held
    row = rows(environment, "traffic_signal")[0]
    assert (row["kind"], row["country"], row["x_m"], row["y_m"]) == ("stop", "de", 30.0, -5.0)


def test_validity_narrows_and_a_contradiction_is_named() -> None:
    validity = '<validity fromLane="-2" toLane="-2"/>'
    environment = load(road(lanes=TWO_WAYS, more=f"<signals>{signal(30, '+', validity)}</signals>"))
    assert signals(environment) == [("1.0.-2", 30.0)]
    contradicting = load(road(lanes=TWO_WAYS, more=f"<signals>{signal(30, '-', validity)}</signals>"))
    assert signals(contradicting) == [("1.0.-2", 30.0)]
    assert "signal_orientation" in checks(contradicting)


def test_a_signal_holds_where_it_is_referred_to_and_stands_where_it_is_defined() -> None:
    defined = signal(90, inside='<validity fromLane="0" toLane="0"/>', id="L1", type="1000001", dynamic="yes")
    reference = "".join(f'<signalReference id="{name}" s="10" t="0" orientation="+"/>' for name in ("L1", "gone"))
    environment = load(
        road(more=f"<signals>{defined}</signals>"),
        road("2", LINE.replace('x="0"', 'x="100"'), more=f"<signals>{reference}</signals>"),
    )
    row = rows(environment, "traffic_signal")[0]
    assert (row["lanelet_id"], row["road_id"], row["road_s_m"], row["x_m"]) == ("2.0.-1", "2", 10.0, 90.0)
    assert (row["kind"], row["dynamic"]) == ("traffic_light", True)
    assert len(rows(environment, "traffic_signal")) == 1
    assert checks(environment)["invalid_signal"] == ["2"]
    assert "signal_without_lane" not in checks(environment)


def test_a_signal_that_holds_for_nobody_is_named() -> None:
    environment = load(road(lanes=section(0, lane(-1)), more=f"<signals>{signal(30, '-')}</signals>"))
    assert signals(environment) == []
    assert checks(environment)["signal_without_lane"] == ["1"]


@pytest.mark.parametrize(
    ("code", "subtype", "turns"),
    [
        ("1000001", "-1", ["left", "straight", "right", "u_turn"]),
        ("1000001", "10", None),
        ("1000011", "10", ["left"]),
        ("1.000.011", "20", ["right"]),
        ("1000011", "30.0", ["straight"]),
        ("1000011", "40", ["left", "straight"]),
        ("1000011", "50", ["straight", "right"]),
        ("1000011", "-1", None),
        ("206", "-1", None),
    ],
)
def test_turns_that_a_light_holds_for(code: str, subtype: str, turns: list[str] | None) -> None:
    (row, *_) = rows(load(road(more=f"<signals>{signal(30, type=code, subtype=subtype)}</signals>")), "traffic_signal")
    assert (row["kind"], row["turns"]) == ("stop" if code == "206" else "traffic_light", turns)


def test_values_and_missing_values() -> None:
    for value, expected in (("50", 50.0), ("-1.0", None), ("", None)):
        environment = load(road(more=f"<signals>{signal(30, type='274', value=value, unit='km/h')}</signals>"))
        row = rows(environment, "traffic_signal")[0]
        assert (row["kind"], row["value"], row["unit"]) == ("speed_limit", expected, "km/h")


@pytest.mark.parametrize(
    ("country", "code", "name", "kind"),
    [
        ("OpenDRIVE", "1000001", "", "traffic_light"),
        ("DE", "205", "", "give_way"),
        ("de", "274-50", "", "speed_limit"),
        ("DEU", "276", "", "no_overtaking"),
        ("de", "333", "", "exit"),
        ("GB", "602", "", "give_way"),
        ("gb", "670", "", "speed_limit"),
        ("GB", "206", "", None),
        ("se", "c", "speed_50_1", "speed_limit"),
        ("us", "", "Sign Exit 12", "exit"),
        ("us", "", "exiting sun", None),
        ("us", "x", "Sign_Yield", "give_way"),
    ],
)
def test_kinds_by_code_then_by_name(country: str, code: str, name: str, kind: str | None) -> None:
    assert signal_kind(country, code, name) == kind


def object_(kind: str, s: float, t: float, **attributes: str) -> str:
    inside = attributes.pop("inside", "")
    text = " ".join(f'{k}="{v}"' for k, v in attributes.items())
    return f'<object id="{attributes.get("name", "o")}" s="{s}" t="{t}" type="{kind}" {text}>{inside}</object>'


def test_stop_lines_as_objects_and_as_painted_signals() -> None:
    line = object_("-1", 40, -1.2, name="StopLine", hdg="1.5708", length="3.4", width="0.3")
    along = object_("-1", 60, -1.75, name="StopLine along", hdg="0.6", length="6", width="0.3")
    painted = signal(70, "-", type="294", t="-1.75", width="3.5", id="9")
    environment = load(road(more=f"<objects>{line}{along}</objects><signals>{painted}</signals>"))
    found = [
        (r["stop_line_id"], r["lanelet_id"], round(r["lane_s_m"], 2), r["source"])
        for r in rows(environment, "stop_line")
    ]
    assert found == [("9", "1.0.-1", 70.0, "signal"), ("StopLine", "1.0.-1", 39.85, "object")]
    assert checks(environment)["object_without_lane"] == ["1"]


FOUR_LANES = section(0, *(lane(n) for n in (2, 1, -1, -2)))  # 3.5 m wide each


@pytest.mark.parametrize(
    ("orientation", "t", "width", "validity", "held"),
    [
        ("-", "0", "3.5", "", ["1.0.1", "1.0.2"]),  # drawn beside the reference line on which it is placed
        ("-", "0", "14", "", ["1.0.1", "1.0.2"]),
        ("-", "1.75", "3.5", "", ["1.0.1"]),
        ("+", "-3.5", "7", "", ["1.0.-1", "1.0.-2"]),
        ("+", "-9", "0.6", "", ["1.0.-1", "1.0.-2"]),  # placed beside the road, without saying how long it is
        ("none", "-1.75", "3.5", "", ["1.0.-1"]),
        ("none", "-9", "0.6", "", ["1.0.-1", "1.0.-2", "1.0.1", "1.0.2"]),
        ("-", "0", "7", (0, 4), ["1.0.1", "1.0.2"]),
        ("-", "0", "3.5", (2, 2), ["1.0.2"]),
        ("none", "0", "14", (-2, -1), ["1.0.-1", "1.0.-2"]),
    ],
)
def test_a_painted_stop_line_holds_for_the_lanes_of_its_orientation_and_validity(
    orientation: str, t: str, width: str, validity: tuple[int, int] | str, held: list[str]
) -> None:
    inside = f'<validity fromLane="{validity[0]}" toLane="{validity[1]}"/>' if validity else ""
    line = signal(70, orientation, inside, type="294", t=t, width=width)
    environment = load(road(lanes=FOUR_LANES, more=f"<signals>{line}</signals>"))
    found = {r["lanelet_id"]: round(r["lane_s_m"], 6) for r in rows(environment, "stop_line")}
    assert found == {name: 70.0 if "-" in name else 30.0 for name in held}
    assert "signal_orientation" not in checks(environment)


def test_a_stop_line_across_the_other_direction_alone_holds_there_and_that_is_named() -> None:
    line = signal(70, "-", type="294", t="-3.5", width="7")
    environment = load(road(lanes=FOUR_LANES, more=f"<signals>{line}</signals>"))
    assert [r["lanelet_id"] for r in rows(environment, "stop_line")] == ["1.0.-1", "1.0.-2"]
    assert "signal_orientation" in checks(environment)


def test_a_stop_line_holds_where_it_is_referred_to() -> None:
    line = signal(98, "+", type="294", t="-1.75", width="3.5", id="S")
    reference = '<signalReference id="S" s="2" t="-1.75" orientation="+"/>'
    environment = load(
        road(more=f"<signals>{line}</signals>"),
        road("2", LINE.replace('x="0"', 'x="100"'), more=f"<signals>{reference}</signals>"),
    )
    assert [(r["stop_line_id"], r["lanelet_id"], r["lane_s_m"]) for r in rows(environment, "stop_line")] == [
        ("S", "1.0.-1", 98.0),
        ("S", "2.0.-1", 2.0),
    ]


def test_two_signs_of_one_id_on_one_post_are_two() -> None:
    both = signal(30, type="274", value="50") + signal(30, type="276")
    environment = load(road(more=f"<signals>{both}</signals>"))
    assert {r["kind"] for r in rows(environment, "traffic_signal")} == {"speed_limit", "no_overtaking"}


def test_crossings_lie_across_drivable_lanes_only() -> None:
    outline = "".join(f'<cornerRoad s="{s}" t="{t}"/>' for s, t in ((20, -9), (24, -9), (24, 9), (20, 9)))
    crossing = object_("crosswalk", 22, 0, name="Zebra", inside=f"<outlines><outline>{outline}</outline></outlines>")
    environment = load(road(lanes=TWO_WAYS, more=f"<objects>{crossing}</objects>"), offset=(5.0, 0.0))
    found = [
        (r["lanelet_id"], round(r["s_start_m"], 3), round(r["s_end_m"], 3), r["kind"])
        for r in rows(environment, "crossing")
    ]
    assert found == [("1.0.-2", 20, 24, "zebra"), ("1.0.-1", 20, 24, "zebra"), ("1.0.1", 76, 80, "zebra")]
    row = rows(environment, "road_object")[0]
    assert (row["kind"], row["x_m"]) == ("crossing", 27.0)
    assert sorted(row["outline_x_m"]) == [25.0, 25.0, 29.0, 29.0]


def test_objects_repeat() -> None:
    posts = object_("pole", 0, 4, radius="0.1", inside='<repeat s="10" length="20" distance="10" tStart="4" tEnd="6"/>')
    fence = object_(
        "barrier", 0, -8, name="fence", inside='<repeat s="0" length="50" distance="0" tStart="-8" tEnd="-8"/>'
    )
    environment = load(road(more=f"<objects>{posts}{fence}</objects>"))
    found = {r["object_id"]: (r["kind"], r["x_m"], r["y_m"]) for r in rows(environment, "road_object")}
    assert found == {
        "o/0": ("pole", 10.0, 4.0),
        "o/1": ("pole", 20.0, 5.0),
        "o/2": ("pole", 30.0, 6.0),
        "fence": ("barrier", 0.0, -8.0),
    }
    band = next(r for r in rows(environment, "road_object") if r["object_id"] == "fence")
    assert (min(band["outline_x_m"]), max(band["outline_x_m"])) == (0.0, 50.0)


def test_an_object_repeated_without_end_is_refused() -> None:
    posts = object_("pole", 0, 4, inside='<repeat s="0" length="1e9" distance="0.001" tStart="4" tEnd="4"/>')
    environment = load(road(more=f"<objects>{posts}</objects>"))
    assert rows(environment, "road_object") == []
    assert checks(environment)["invalid_object"] == ["1"]


def test_outlines_turn_with_the_object_and_the_road() -> None:
    corners = "".join(f'<cornerLocal u="{u}" v="{v}"/>' for u, v in ((0, 0), (4, 0), (4, 1)))
    building = object_("building", 10, 5, hdg="1.5707963267948966", inside=f"<outline>{corners}</outline>")
    row = rows(load(road(more=f"<objects>{building}</objects>")), "road_object")[0]
    assert row["outline_x_m"] == pytest.approx([10, 10, 9])
    assert row["outline_y_m"] == pytest.approx([5, 9, 9])


def test_outlines_run_counter_clockwise() -> None:
    corners = "".join(f'<cornerLocal u="{u}" v="{v}"/>' for u, v in ((0, 0), (0, 2), (3, 2), (3, 0)))
    environment = load(
        road(more=f"<objects>{object_('building', 10, 10, inside=f'<outline>{corners}</outline>')}</objects>")
    )
    row = rows(environment, "road_object")[0]
    x, y = row["outline_x_m"], row["outline_y_m"]
    assert sum(x[i - 1] * y[i] - x[i] * y[i - 1] for i in range(4)) == pytest.approx(12.0)
