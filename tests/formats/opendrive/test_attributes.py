"""Types, limits, marks, signals, stop lines, objects and crossings on small maps."""

from __future__ import annotations

from typing import Any

import pytest

from drivelint.road.signcodes import signal_kind
from tests.formats.maps import checks, lanelets, rows, values
from tests.formats.opendrive.signal_text import WIDTH, signal
from tests.formats.opendrive.xodr import LINE, lane, load, road, section


def limits(environment: Any, name: str) -> list[Any]:
    return values(environment, "speed_limit", "s_start_m s_end_m limit_mps source", lanelet_id=name)


def marks(environment: Any, name: str, side: str) -> list[Any]:
    return values(environment, "lane_boundary", "s_start_m s_end_m marking", lanelet_id=name, side=side)


def with_speeds(*speeds: str) -> Any:
    """Return a road with one lane on which these limits are recorded."""
    said = "".join(f'<speed sOffset="{20 * k}" max="{speed}"/>' for k, speed in enumerate(speeds))
    return load(road(lanes=section(0, lane(-1, WIDTH + said))))


def with_signals(*signals: str, lanes: str = "") -> Any:
    return load(road(lanes=lanes, more=f"<signals>{''.join(signals)}</signals>"))


def with_objects(*objects: str, lanes: str = "", **options: Any) -> Any:
    return load(road(lanes=lanes, more=f"<objects>{''.join(objects)}</objects>"), **options)


def referring(defined: str, *references: str) -> Any:
    """Return two roads, one after the other: signals stand on the first, and the second refers to them."""
    return load(
        road(more=f"<signals>{defined}</signals>"),
        road("2", LINE.replace('x="0"', 'x="100"'), more=f"<signals>{''.join(references)}</signals>"),
    )


def test_limits_come_from_the_lane_then_the_road_type() -> None:
    types = (
        '<type s="0" type="town"><speed max="50" unit="km/h"/></type>'
        '<type s="60" type="town"><speed max="no limit"/></type><type s="90" type="town"/>'
    )
    inside = WIDTH + '<speed sOffset="20" max="30" unit="mph"/><speed sOffset="40" max="undefined"/>'
    environment = load(road(lanes=section(0, lane(1), lane(-1, inside)), more=types))
    assert limits(environment, "1.0.-1") == [
        (0, 20, 13.888889, "road_type"), (20, 40, 13.4112, "lane"), (40, 60, 13.888889, "road_type"), (60, 90, None, "road_type"),
    ]  # fmt: skip
    # the other lane is driven against the stations
    assert limits(environment, "1.0.1") == [(10, 40, None, "road_type"), (40, 100, 13.888889, "road_type")]


@pytest.mark.parametrize(
    ("attributes", "check"),
    [
        ('dynamicLaneType="true"', "lane_type_varies"),
        ('dynamicLaneDirection="1"', "lane_direction_varies"),
        ('dynamicLaneType="false" dynamicLaneDirection="0"', None),
    ],
)
def test_a_lane_whose_type_or_direction_may_change_is_named(attributes: str, check: str | None) -> None:
    environment = load(road(lanes=section(0, lane(-1), lane(-2, kind="stop", attributes=attributes))))
    assert checks(environment).get(check or "", []) == ["1.0.-2"] * bool(check)
    assert {"lane_type_varies", "lane_direction_varies"} & set(checks(environment)) == {check} - {None}


@pytest.mark.parametrize(
    ("access", "lane_type", "unread"),
    [
        ('<access rule="allow" restriction="bus"/>', "bus", False),
        # OpenDRIVE 1.8
        ('<access rule="allow"><restriction type="bus"/><restriction type="taxi"/></access>', "bus", False),
        ('<access rule="allow" restriction="taxi"/><access rule="allow" restriction="bicycle"/>', "taxi", False),
        ('<access rule="allow" restriction="bus"/><access rule="allow" restriction="passengerCar"/>', "driving", False),
        ('<access rule="deny" restriction="truck"/>', "driving", False),
        ('<access rule="deny" restriction="none"/><access restriction="none"/>', "driving", False),
        ('<access rule="deny" restriction="passengerCar"/>', "driving", True),
        ('<access rule="allow" restriction="emergency"/>', "driving", True),
        ('<access sOffset="50" rule="allow" restriction="bus"/>', "driving", True),
        (
            '<access rule="allow" restriction="passengerCar"/><access sOffset="50" rule="allow" restriction="bus"/>',
            "driving",
            True,
        ),
        # before OpenDRIVE 1.5, and a rule that the standard does not have
        ('<access restriction="bus"/>', "driving", True),
        ('<access rule="permit" restriction="bus"/>', "driving", True),
        # OpenDRIVE 1.4 to 1.7: a free text, of which two keep nobody out
        ('<rule value="No stopping at any time"/><rule value="disabled parking"/>', "driving", False),
        ('<rule sOffset="20" value="car pool"/>', "driving", True),
        ('<access rule="allow" restriction="bus"/><rule value="not on Sundays"/>', "bus", True),
        # cars of some kind alone
        ('<access rule="allow" restriction="autonomousTraffic"/>', "driving", True),
        ('<access rule="deny" restriction="throughTraffic"/>', "driving", True),
    ],
)
def test_who_may_use_a_lane(access: str, lane_type: str, unread: bool) -> None:
    environment = load(road(lanes=section(0, lane(1), lane(-1, WIDTH + access))))
    assert lanelets(environment)["1.0.-1"]["lane_type"] == lane_type
    assert [row["lanelet_id"] for row in rows(environment, "map_quality", check_id="access_unread")] == [
        "1.0.-1"
    ] * unread


@pytest.mark.parametrize(("road_works", "unread"), [("true", True), ("1", True), ("false", False)])
def test_whether_cars_may_use_a_lane_in_road_works_is_not_known(road_works: str, unread: bool) -> None:
    environment = load(road(lanes=section(0, lane(-1, attributes=f'roadWorks="{road_works}"'))))
    assert checks(environment).get("access_unread", []) == ["1.0.-1"] * unread


@pytest.mark.parametrize(("layer", "is_left_out"), [("temporary", True), ("permanent", False)])
def test_a_road_with_temporary_lanes_is_left_out(layer: str, is_left_out: bool) -> None:
    """They lie on the other lanes (OpenDRIVE 1.9), and vehicles drive on them."""
    lanes = f'{section(0, lane(-1))}</lanes><lanes layer="{layer}">{section(50, lane(-1, attributes=""))}'
    environment = load(road(lanes=lanes), road("2", LINE.replace('y="0"', 'y="50"')))
    assert ("1.0.-1" not in lanelets(environment)) == is_left_out
    assert checks(environment).get("invalid_road", []) == ["1"] * is_left_out


@pytest.mark.parametrize(
    ("speed", "limit"),
    [
        ("9", (0, 100, 9.0, "lane")),  # without a unit it is in metres per second
        ('fast" unit="mph', (0, 100, None, "unread")),
        # netconvert 1.28.0 writes it for OpenStreetMap's `maxspeed=none`, and for a motorway without a limit (findings/)
        ("39.44", (0, 100, None, "unread")),
    ],
)
def test_a_recorded_limit_and_nonsense_is_named(speed: str, limit: tuple[Any, ...]) -> None:
    environment = with_speeds(speed)
    assert limits(environment, "1.0.-1") == [limit]
    assert ("invalid_speed" in checks(environment)) == (limit[-1] == "unread")


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
    found = values(environment, "lane_boundary", "color lane_change", lanelet_id="1.0.-1", side="left")
    assert found == [("yellow", "none")]


def test_drivable_is_decided_by_type() -> None:
    kinds = ["driving", "exit", "bus", "shoulder", "sidewalk", "stop", "biking"]
    lanes = section(0, *(lane(-n, kind=kind) for n, kind in enumerate(kinds, 1)))
    found = dict(values(load(road(lanes=lanes)), "lanelet", "lane_type drivable"))
    assert found == dict.fromkeys(kinds[:3], True) | dict.fromkeys(kinds[3:], False)


TWO_WAYS = section(0, lane(1), lane(2, kind="sidewalk"), lane(-1), lane(-2))
VALIDITY = '<validity fromLane="-2" toLane="-2"/>'


@pytest.mark.parametrize(
    ("orientation", "inside", "lane_places"),
    [
        ("+", "", [("1.0.-1", 30.0), ("1.0.-2", 30.0)]),
        ("-", "", [("1.0.1", 70.0)]),
        ("none", "", [("1.0.-1", 30.0), ("1.0.-2", 30.0), ("1.0.1", 70.0)]),
        ("+", VALIDITY, [("1.0.-2", 30.0)]),
        ("-", VALIDITY, [("1.0.-2", 30.0)]),
    ],
)
def test_signals_hold_for_the_lanes_of_their_direction_and_validity(
    orientation: str, inside: str, lane_places: list[tuple[str, float]]
) -> None:
    environment = with_signals(signal(30, orientation, inside), lanes=TWO_WAYS)
    assert values(environment, "traffic_signal", "lanelet_id lane_s_m") == lane_places
    assert values(environment, "traffic_signal", "kind country x_m y_m")[0] == ("stop", "de", 30.0, -5.0)
    assert ("signal_orientation" in checks(environment)) == (bool(inside) and orientation == "-")


def test_a_signal_holds_where_it_is_referred_to_and_stands_where_it_is_defined() -> None:
    defined = signal(90, inside='<validity fromLane="0" toLane="0"/>', id="L1", type="1000001", dynamic="yes")
    reference = '<signalReference id="{}" s="10" t="0" orientation="+"/>'
    environment = referring(defined, *map(reference.format, ("L1", "gone")))
    assert values(environment, "traffic_signal", "lanelet_id road_id road_s_m x_m kind dynamic") == [
        ("2.0.-1", "2", 10.0, 90.0, "traffic_light", True)
    ]
    assert checks(environment)["invalid_signal"] == ["2"]
    assert "signal_without_lane" not in checks(environment)


def test_a_signal_that_holds_for_nobody_is_named() -> None:
    environment = with_signals(signal(30, "-"), lanes=section(0, lane(-1)))
    assert rows(environment, "traffic_signal") == []
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
    found = values(with_signals(signal(30, type=code, subtype=subtype)), "traffic_signal", "kind turns")
    assert found[0] == ("stop" if code == "206" else "traffic_light", turns)


@pytest.mark.parametrize(("value", "expected"), [("50", 50.0), ("-1.0", None), ("", None)])
def test_values_and_missing_values(value: str, expected: float | None) -> None:
    environment = with_signals(signal(30, type="274", value=value, unit="km/h"))
    assert values(environment, "traffic_signal", "kind value unit")[0] == ("speed_limit", expected, "km/h")


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


@pytest.mark.parametrize(
    ("meaning", "kind"),
    [
        ('<priority type="stop"/>', "stop"),
        ('<warning/><priority type="yield"/>', "give_way"),
        ('<lane type="noOvertakeCars"/>', "no_overtaking"),
        ('<priority type="4way"/>', None),
    ],
)
def test_a_sign_of_a_country_without_known_codes_is_recognised_by_its_semantics(meaning: str, kind: str | None) -> None:
    environment = with_signals(signal(30, country="fr", type="AB4", inside=f"<semantics>{meaning}</semantics>"))
    assert set(values(environment, "traffic_signal", "kind")) == {kind}
    assert "signs_unmapped" not in checks(environment)


@pytest.mark.parametrize(
    ("country", "attributes", "unmapped"),
    [
        ("fr", {"type": "AB4"}, True),
        ("fr", {"type": "AB4", "name": "Stop"}, False),
        ("fr", {"type": "AB4", "dynamic": "yes"}, False),
        ("fr", {"type": "-1"}, False),
        ("de", {"type": "1042"}, False),
    ],
)
def test_among_signs_of_unknown_codes_there_may_be_one_that_governs_a_junction(
    country: str, attributes: dict[str, str], unmapped: bool
) -> None:
    environment = with_signals(signal(30, country=country, **attributes))
    assert ("signs_unmapped" in checks(environment)) == unmapped
    assert values(environment, "environment", "signs_mapped") == [not unmapped]


def object_(kind: str, s: float, t: float, inside: str = "", **attributes: str) -> str:
    text = " ".join(f'{k}="{v}"' for k, v in attributes.items())
    return f'<object id="{attributes.get("name", "o")}" s="{s}" t="{t}" type="{kind}" {text}>{inside}</object>'


def test_stop_lines_as_objects_and_as_painted_signals() -> None:
    line = object_("-1", 40, -1.2, name="StopLine", hdg="1.5708", length="3.4", width="0.3")
    along = object_("-1", 60, -1.75, name="StopLine along", hdg="0.6", length="6", width="0.3")
    painted = signal(70, "-", type="294", t="-1.75", width="3.5", id="9")
    environment = load(road(more=f"<objects>{line}{along}</objects><signals>{painted}</signals>"))
    assert values(environment, "stop_line", "stop_line_id lanelet_id lane_s_m source", digits=2) == [
        ("9", "1.0.-1", 70.0, "signal"), ("StopLine", "1.0.-1", 39.85, "object"),
    ]  # fmt: skip
    assert checks(environment)["object_without_lane"] == ["1"]


FOUR_LANES = section(0, *(lane(n) for n in (2, 1, -1, -2)))  # 3.5 m wide each


@pytest.mark.parametrize(
    ("orientation", "t", "width", "validity", "lane_names"),
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
        (
            "-",
            "-3.5",
            "7",
            "",
            ["1.0.-1", "1.0.-2"],
        ),  # across the other direction alone: it holds there, and that is named
    ],
)
def test_a_painted_stop_line_holds_for_the_lanes_of_its_orientation_and_validity(
    orientation: str, t: str, width: str, validity: tuple[int, int] | str, lane_names: list[str]
) -> None:
    inside = f'<validity fromLane="{validity[0]}" toLane="{validity[1]}"/>' if validity else ""
    environment = with_signals(signal(70, orientation, inside, type="294", t=t, width=width), lanes=FOUR_LANES)
    found = dict(values(environment, "stop_line", "lanelet_id lane_s_m"))
    assert found == {name: 70.0 if "-" in name else 30.0 for name in lane_names}
    assert ("signal_orientation" in checks(environment)) == ((orientation, t) == ("-", "-3.5"))


def test_a_stop_line_holds_where_it_is_referred_to() -> None:
    line = signal(98, "+", type="294", t="-1.75", width="3.5", id="S")
    environment = referring(line, '<signalReference id="S" s="2" t="-1.75" orientation="+"/>')
    assert values(environment, "stop_line", "stop_line_id lanelet_id lane_s_m") == [
        ("S", "1.0.-1", 98.0), ("S", "2.0.-1", 2.0),
    ]  # fmt: skip


def test_two_signs_of_one_id_on_one_post_are_two() -> None:
    environment = with_signals(signal(30, type="274", value="50"), signal(30, type="276"))
    assert set(values(environment, "traffic_signal", "kind")) == {"speed_limit", "no_overtaking"}


def test_crossings_lie_across_drivable_lanes_only() -> None:
    outline = "".join(f'<cornerRoad s="{s}" t="{t}"/>' for s, t in ((20, -9), (24, -9), (24, 9), (20, 9)))
    crossing = object_("crosswalk", 22, 0, f"<outlines><outline>{outline}</outline></outlines>", name="Zebra")
    environment = with_objects(crossing, lanes=TWO_WAYS, offset=(5.0, 0.0))
    assert values(environment, "crossing", "lanelet_id s_start_m s_end_m kind", digits=3) == [
        ("1.0.-2", 20, 24, "zebra"), ("1.0.-1", 20, 24, "zebra"), ("1.0.1", 76, 80, "zebra"),
    ]  # fmt: skip
    row = rows(environment, "road_object")[0]
    assert (row["kind"], row["x_m"]) == ("crossing", 27.0)
    assert sorted(row["outline_x_m"]) == [25.0, 25.0, 29.0, 29.0]


@pytest.mark.parametrize(
    ("height", "z_offset", "crosses"),
    [("8", "0", False), ("-8", "0", False), ("2.9", "0", True), ("8", "8", True), (None, "0", True)],
)
def test_crossings_and_stop_lines_are_not_on_a_bridge_over_them(
    height: str | None, z_offset: str, crosses: bool
) -> None:
    """Road 2 crosses road 1, with the objects, at this height; None: the height is not stated."""
    flat = '<elevationProfile><elevation s="0" a="{}"/></elevationProfile>'
    crossing = object_("crosswalk", 50, 0, name="X", length="9", width="9", zOffset=z_offset)
    line = object_("stopLine", 50, 0, name="L", length="9", width="0.3", zOffset=z_offset)
    bridge = LINE.replace('x="0" y="0" hdg="0"', 'x="50" y="-50" hdg="1.5707963267948966"')
    environment = load(
        road(more=f"{flat.format(0)}<objects>{crossing}{line}</objects>"),
        road("2", bridge, more="" if height is None else flat.format(height)),
    )
    over = {"2.0.-1", "2.0.1"} if crosses else set()
    assert set(values(environment, "crossing", "lanelet_id")) == {"1.0.-1", "1.0.1"} | over
    assert set(values(environment, "stop_line", "lanelet_id")) == over


def test_objects_repeat() -> None:
    posts = object_("pole", 0, 4, '<repeat s="10" length="20" distance="10" tStart="4" tEnd="6"/>', radius="0.1")
    fence = object_("barrier", 0, -8, '<repeat s="0" length="50" distance="0" tStart="-8" tEnd="-8"/>', name="fence")
    environment = with_objects(posts, fence)
    assert sorted(values(environment, "road_object", "object_id kind x_m y_m")) == [
        ("fence", "barrier", 0.0, -8.0), *((f"o/{k}", "pole", 10.0 + 10.0 * k, 4.0 + k) for k in range(3)),
    ]  # fmt: skip
    (band,) = values(environment, "road_object", "outline_x_m", object_id="fence")
    assert (min(band), max(band)) == (0.0, 50.0)


def test_an_object_repeated_without_end_is_refused() -> None:
    environment = with_objects(
        object_("pole", 0, 4, '<repeat s="0" length="1e9" distance="0.001" tStart="4" tEnd="4"/>')
    )
    assert rows(environment, "road_object") == []
    assert checks(environment)["invalid_object"] == ["1"]


def outline(corners: list[tuple[int, int]], **attributes: str) -> tuple[list[float], list[float]]:
    """Return the outline of a building with these corners."""
    inside = "".join(f'<cornerLocal u="{u}" v="{v}"/>' for u, v in corners)
    environment = with_objects(object_("building", 10, 5, f"<outline>{inside}</outline>", **attributes))
    ((x, y),) = values(environment, "road_object", "outline_x_m outline_y_m")
    return x, y


def test_outlines_turn_with_the_object_and_the_road() -> None:
    x, y = outline([(0, 0), (4, 0), (4, 1)], hdg="1.5707963267948966")
    assert x == pytest.approx([10, 10, 9])
    assert y == pytest.approx([5, 9, 9])


def test_outlines_run_counter_clockwise() -> None:
    x, y = outline([(0, 0), (0, 2), (3, 2), (3, 0)])
    assert sum(x[i - 1] * y[i] - x[i] * y[i - 1] for i in range(4)) == pytest.approx(12.0)
