"""CommonRoad maps: lanelets, junctions, markings, limits, stop lines, crosswalks, the side driven on."""

from __future__ import annotations

from collections import Counter

import pytest

from drivelint.errors import MapError
from drivelint.formats import load_map, read_source
from drivelint.road.map_reader import MapSource, MapTables
from tests.formats.commonroad.scenario_text import bound, lanelet, scenario
from tests.formats.maps import checks, hand, links, values
from tests.shared_data import shared


def load(text: str, **options: object) -> MapTables:
    return load_map(MapSource("a.xml", text.encode()), **options)  # type: ignore[arg-type]


def test_lanelets_and_what_lies_on_them() -> None:
    environment = load(
        scenario(
            lanelet(1, 0.0, '<successor ref="2"/><laneletType>country</laneletType><trafficSignRef ref="90"/>'
                    "<stopLine><point><x>45</x><y>1.75</y></point><point><x>45</x><y>-1.75</y></point></stopLine>"),
            lanelet(2, 0.0, "<laneletType>interstate</laneletType>", x=50.0),
            lanelet(3, -3.5, '<laneletType>sidewalk</laneletType><adjacentLeft ref="1" drivingDir="same"/>'),
            '<lanelet id="4">' + bound("leftBound", [(20.0, 5.0), (20.0, -5.0)]) + bound("rightBound", [(17.0, 5.0), (17.0, -5.0)])
            + "<laneletType>crosswalk</laneletType></lanelet>",
            '<trafficSign id="90"><trafficSignElement><trafficSignID>274</trafficSignID>'
            "<additionalValue>13.9</additionalValue></trafficSignElement>"
            "<position><point><x>10</x><y>-4</y></point></position></trafficSign>",
            '<intersection id="80"><incoming id="81"><incomingLanelet ref="1"/><successorsStraight ref="2"/></incoming></intersection>',
        ),
        offset=(100.0, 0.0),
    )  # fmt: skip
    assert values(environment, "lanelet", "lanelet_id lane_type drivable road_type junction_id") == [
        ("1", "driving", True, "rural", None), ("2", "driving", True, "motorway", "80"), ("3", "sidewalk", False, None, None),
    ]  # fmt: skip
    assert links(environment) == [("1", "2")]
    marks = values(environment, "lane_boundary", "side marking", lanelet_id="1")
    assert marks == [("left", "broken"), ("right", "solid")]
    for table, columns, row in (
        ("speed_limit", "lanelet_id limit_mps source", ("1", 13.9, "sign")),
        ("stop_line", "stop_line_id lane_s_m", ("1.stop", 45.0)),
        ("crossing", "crossing_id lanelet_id s_start_m s_end_m", ("4", "1", 17.0, 20.0)),
        ("traffic_signal", "signal_id kind lane_s_m", ("90", "speed_limit", 10.0)),
    ):
        assert values(environment, table, columns) == [row]
    assert values(environment, "lane_point", "x_m")[0] == 100.0


@pytest.mark.parametrize(
    ("users", "lane_type", "drivable", "unread"),
    [
        ("<userOneWay>vehicle</userOneWay>", "driving", True, []),
        ("<userOneWay>car</userOneWay><userOneWay>bus</userOneWay>", "driving", True, []),
        ("<userOneWay>bus</userOneWay><userOneWay>bicycle</userOneWay>", "bus", True, []),
        ("<userOneWay>taxi</userOneWay>", "taxi", True, []),
        ("<userBidirectional>bicycle</userBidirectional>", "biking", False, []),
        ("<userOneWay>train</userOneWay>", "rail", False, []),
        ("<userOneWay>truck</userOneWay>", "driving", True, ["1"]),
        ("<laneletType>exitRamp</laneletType><userOneWay>bus</userOneWay>", "exit", True, []),
    ],
)
def test_who_may_use_a_lanelet(users: str, lane_type: str, drivable: bool, unread: list[str]) -> None:
    environment = load(scenario(lanelet(1, 0.0, users), lanelet(2, -3.5)))
    assert values(environment, "lanelet", "lane_type drivable", lanelet_id="1") == [(lane_type, drivable)]
    assert values(environment, "map_quality", "lanelet_id", check_id="access_unread") == unread


@pytest.mark.parametrize(
    ("direction", "turns"),
    [
        ("<direction>leftStraight</direction>", ["left", "straight"]),
        ("<direction>right</direction>", ["right"]),
        ("<direction>all</direction>", ["left", "straight", "right", "u_turn"]),
        ("", None),
    ],
)
def test_turns_that_a_light_holds_for(direction: str, turns: list[str] | None) -> None:
    light = f'<trafficLight id="90">{direction}</trafficLight>'
    environment = load(scenario(lanelet(1, 0.0, '<trafficLightRef ref="90"/>'), light))
    assert values(environment, "traffic_signal", "kind turns") == [("traffic_light", turns)]


ONE_LANELET = [lanelet(1, 0.0)]
OPPOSITE = [lanelet(1, 0.0, '<adjacentRight ref="2" drivingDir="opposite"/>'), lanelet(2, -3.5)]


@pytest.mark.parametrize(
    ("parts", "benchmark", "options", "expected"),
    [
        (ONE_LANELET, "ZAM_Test-1", {}, ("rht", "default")),
        (ONE_LANELET, "DEU_Test-1", {}, ("rht", "attribute")),
        (ONE_LANELET, "C-GBR_Test-1", {}, ("lht", "attribute")),
        (ONE_LANELET, "ZAM_Test-1", {"handedness": "lht"}, ("lht", "option")),
        (OPPOSITE, "ZAM_T-1", {}, ("lht", "lanes")),
        # whoever drives along one-way lanes agrees with them on either side of the road
        (ONE_LANELET, "ZAM_Test-1", {"voted_handedness": "lht"}, ("rht", "default")),
    ],
)
def test_the_side_driven_on(
    parts: list[str], benchmark: str, options: dict[str, str], expected: tuple[str, str]
) -> None:
    environment = load(scenario(*parts, benchmark=benchmark), **options)
    assert hand(environment) == expected
    assert environment.environment_id.endswith("?") == (expected[1] == "default")


def test_witnesses_that_disagree_are_reported() -> None:
    beside = lanelet(1, 0.0, '<adjacentLeft ref="2" drivingDir="opposite"/>')
    environment = load(scenario(beside, lanelet(2, 3.5), benchmark="GBR_T-1"))
    assert environment.handedness == "rht"
    assert list(checks(environment)) == ["handedness_disagrees"]


def errors(environment: MapTables) -> list[tuple[str, str]]:
    return values(environment, "map_quality", "check_id lanelet_id", severity="error")


def test_a_lanelet_that_cannot_be_read_is_named() -> None:
    broken = '<lanelet id="9"><leftBound><point><x>a</x><y>1</y></point></leftBound></lanelet>'
    assert errors(load(scenario(lanelet(1, 0.0), broken))) == [("invalid_lane", "9")]


@pytest.mark.parametrize("x", ["nan", "1e300", "1 2"])
@pytest.mark.parametrize("tag", ["stopLine", "trafficSign"])
def test_a_sign_or_stop_line_at_no_place_is_refused_with_its_line(tag: str, x: str) -> None:
    point = f"\n<point><x>{x}</x><y>0</y></point>"
    stop = f"<stopLine>{point}</stopLine>" if tag == "stopLine" else '<trafficSignRef ref="5"/>'
    sign = f'<trafficSign id="5"><position>{point if tag == "trafficSign" else ""}</position></trafficSign>'
    with pytest.raises(
        MapError,
        match="a sign, light or stop line cannot be read: the point in line 2 has impossible values of x and y",
    ):
        load(scenario(lanelet(1, 0.0, stop), sign))


def test_a_crossing_without_a_shape_is_named() -> None:
    walk = '<lanelet id="9"><leftBound/><rightBound/><laneletType>crosswalk</laneletType></lanelet>'
    assert errors(load(scenario(lanelet(1, 0.0), walk))) == [("invalid_lane", "9")]


@pytest.mark.parametrize(
    "text", ["<commonRoad/>", '<!DOCTYPE a [<!ENTITY b "c">]><commonRoad>&b;</commonRoad>', "<commonRoad>"]
)
def test_what_cannot_be_a_map_is_refused(text: str) -> None:
    with pytest.raises(MapError, match=r"map a\.xml"):
        load(text)


@pytest.mark.parametrize(
    ("name", "lanelets", "drivable", "handedness"),
    [
        ("commonroad/DEU_Gar-1_1_T-1.xml", 5, 5, ("rht", "attribute")),
        ("commonroad/OSC_Overtake-1_1_T-1.xml", 124, 107, ("rht", "lanes")),
        ("commonroad/OSC_PedestrianCollision-1_1_T-1.xml", 24, 20, ("rht", "lanes")),
        ("commonroad/USA_US101-5_1_T-1.xml", 5, 5, ("rht", "attribute")),
    ],
)
def test_real_maps(name: str, lanelets: int, drivable: int, handedness: tuple[str, str]) -> None:
    environment = load_map(read_source(shared(name)))
    widths = values(environment, "lanelet", "width_m", drivable=True)
    assert (environment.tables["lanelet"].num_rows, len(widths)) == (lanelets, drivable)
    assert hand(environment) == handedness
    doubts = {
        check for check, severity in values(environment, "map_quality", "check_id severity") if severity != "info"
    }
    assert doubts == ({"road_type_contradicted"} if "US101" in name else set())
    assert all(1.9 < width < 6.0 for width in widths)


def sign(name: int, *elements: tuple[str, str], more: str = "") -> str:
    inner = "".join(
        f"<trafficSignElement><trafficSignID>{code}</trafficSignID>"
        f"{f'<additionalValue>{value}</additionalValue>' if value else ''}</trafficSignElement>"
        for code, value in elements
    )
    return f'<trafficSign id="{name}">{inner}{more}</trafficSign>'


def limits(environment: MapTables) -> dict[str, tuple[float | None, str]]:
    return {
        name: (limit, source)
        for name, limit, source in values(environment, "speed_limit", "lanelet_id limit_mps source")
    }


def quality_rows(environment: MapTables) -> list[tuple[str, str]]:
    rows = values(environment, "map_quality", "check_id message")
    return [row for row in rows if row[0] != "handedness_default"]


@pytest.mark.parametrize(
    ("country", "code", "kind"),
    [
        ("USA", "R2-1", "speed_limit"),
        ("C-USA", "R2-1", "speed_limit"),
        ("ESP", "r301", "speed_limit"),
        ("ESP", "R-301", "speed_limit"),
        ("DEU", "274", "speed_limit"),
        ("ZAM", "274.1", "speed_zone"),
        *(
            (name, "274", "speed_limit")
            for name in ("HRV", "CHN", "RUS", "ARG", "BEL", "FRA", "GRC", "ITA", "PRI", "USA")
        ),
        ("USA", "R1-1", "stop"),
        ("USA", "R5-1a", "no_entry"),
        ("ESP", "r1", "give_way"),
        ("ESP", "r2", "stop"),
        ("DEU", "283-10", "no_stopping"),
        ("DEU", "R2-1", None),
        ("ESP", "R2-1", None),
    ],
)
def test_codes_of_signs_are_those_of_the_country(country: str, code: str, kind: str | None) -> None:
    parts = lanelet(1, 0.0, '<trafficSignRef ref="90"/>'), sign(90, (code, "13.9"))
    environment = load(scenario(*parts, benchmark=f"{country}_Test-1_1_T-1"))
    assert values(environment, "traffic_signal", "kind") == [kind]
    assert limits(environment) == ({"1": (13.9, "sign")} if kind in {"speed_limit", "speed_zone"} else {})
    assert [check for check, _ in quality_rows(environment)] == ([] if kind else ["unknown_sign"])


def test_the_least_limit_of_a_lanelet_and_that_of_older_files() -> None:
    environment = load(
        scenario(
            lanelet(1, 0.0, '<trafficSignRef ref="90"/><trafficSignRef ref="91"/>'),
            lanelet(2, 10.0, "<speedLimit>8.5</speedLimit>"),
            lanelet(3, 20.0, '<speedLimit>8.5</speedLimit><trafficSignRef ref="91"/>'),
            sign(90, ("274", "20")),
            sign(91, ("274", "8"), more="<virtual>true</virtual>"),
        )
    )
    assert limits(environment) == {"1": (8.0, "sign"), "2": (8.5, "lane"), "3": (8.0, "sign")}
    assert quality_rows(environment) == []


def test_a_limit_that_is_not_sure_is_not_taken_and_named() -> None:
    refers = ("90",), ("91",), ("92",), ("92", "94"), ("92", "93"), ("95",)
    lanes = [
        lanelet(k + 1, 10.0 * k, "".join(f'<trafficSignRef ref="{name}"/>' for name in names))
        for k, names in enumerate(refers)
    ]
    signs = {
        90: [("274", "50")], 91: [("274", "")], 92: [("274", "12"), ("1053-35", "")], 93: [("274", "10")], 94: [("274", "20")],
        95: [("274", "9"), ("1012-50", "")],
    }  # fmt: skip
    slow = lanelet(7, 60.0, "<speedLimit>-1</speedLimit>")
    environment = load(scenario(*lanes, slow, *(sign(name, *elements) for name, elements in signs.items())))
    assert limits(environment) == {"5": (10.0, "sign"), "6": (9.0, "sign")}
    found = quality_rows(environment)
    assert [message for check, message in found if check == "invalid_speed"] == [
        "the limit of sign 90 is not used: 50 m/s is more than any sign allows: the value may be in km/h",
        "the limit of sign 91 is not used: it has no number",
        "the limit of sign 92 is not used: it applies only as its plates state (1053-35)",
        "the limit of lanelet 7 is not used: -1 m/s is not a speed limit",
    ]


@pytest.mark.parametrize(
    ("elements", "unread"),
    [
        ([("276", ""), ("1040-30", "")], ["1", "2"]),
        ([("276", ""), ("1049-13", "")], ["1", "2"]),
        ([("276", ""), ("1012-50", "")], []),
        ([("276", "")], []),
        ([("206", ""), ("1040-30", "")], []),
    ],
)
def test_lanes_of_a_ban_on_overtaking_with_a_plate_are_named(
    elements: list[tuple[str, str]], unread: list[str]
) -> None:
    lanes = lanelet(1, 0.0, '<trafficSignRef ref="90"/>'), lanelet(2, -3.5, '<trafficSignRef ref="90"/>')
    environment = load(scenario(*lanes, lanelet(3, -7.0), sign(90, *elements)))
    assert values(environment, "map_quality", "lanelet_id", check_id="sign_condition_unread") == unread
    if unread:
        message = f"sign 90 applies only as its plates state ({elements[1][0]}): when it applies is not known"
        assert ("sign_condition_unread", message) in quality_rows(environment)


def test_what_is_not_read_is_named() -> None:
    environment = load(
        scenario(
            lanelet(1, 0.0, '<trafficSignRef ref="90"/><trafficLightRef ref="7"/>', left="dashed_solid"),
            sign(90, ("R9-9", "12"), ("R8-8", "")),
            sign(91, ("R1-1", "")),
            benchmark="USA_Test-1",
        )
    )
    assert [message for _, message in quality_rows(environment)] == [
        "lanelets refer to signs or lights that the map does not contain: 7 (1)",
        "signs with a number and a code that is not known (USA): R9-9 (1): whether they limit the speed is not known",
        "signs and lights to which no lanelet refers apply to no lane: 91",
        "signs that no rule reads (USA): R8-8 (1)",
        "markings that are not read: dashed_solid (1)",
    ]


def test_a_light_and_a_stop_sign_hold_at_the_stop_line() -> None:
    line = "<stopLine><point><x>45</x><y>1.75</y></point><point><x>45</x><y>-1.75</y></point>{}</stopLine>"
    beyond = "<position><point><x>80</x><y>0</y></point></position>"
    environment = load(
        scenario(
            lanelet(1, 0.0, line.format('<trafficLightRef ref="90"/><trafficSignRef ref="92"/>')),
            lanelet(2, 10.0, '<trafficLightRef ref="90"/>' + line.format("").replace("1.75<", "11.75<")),
            lanelet(3, 20.0, '<trafficLightRef ref="91"/><trafficSignRef ref="92"/><trafficSignRef ref="93"/>'),
            f'<trafficLight id="90">{beyond}</trafficLight>',
            f'<trafficLight id="91">{beyond}</trafficLight>',
            sign(92, ("206", "")),
            sign(93, ("276", "")),
        )
    )
    assert sorted(values(environment, "traffic_signal", "signal_id lanelet_id lane_s_m")) == [
        ("90", "1", 45.0), ("90", "2", pytest.approx(45.0, abs=0.5)), ("91", "3", 50.0), ("92", "1", 45.0), ("92", "3", 50.0),
        ("93", "3", 0.0),
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("name", "limit_counts"),
    [
        ("USA_Lanker-1_1_T-1", {(13.4112, "lane"): 74, (11.176, "lane"): 17}),
        ("USA_Peach-4_8_T-1", {(15.6464, "sign"): 38, (11.176, "sign"): 41}),
        ("HRV_Pula-27_3_T-1", {(13.8889, "sign"): 18}),
        ("DEU_Moelln-10_2_T-1", {(13.8889, "sign"): 9}),
        ("USA_US101-4_1_T-1", {}),
    ],
)
def test_limits_of_real_maps(name: str, limit_counts: dict[tuple[float, str], int]) -> None:
    environment = load_map(read_source(shared(f"commonroad/{name}.xml")))
    assert Counter((round(limit or 0.0, 4), source) for limit, source in limits(environment).values()) == limit_counts
    assert {check for check, _ in quality_rows(environment)} == (
        {"road_type_contradicted"} if "US101" in name else set()
    )


def test_urban_lanelets_of_a_scenario_that_is_tagged_as_of_a_highway_are_of_no_known_type() -> None:
    """US101 is a freeway: every lanelet of the file is `urban`, its tags say highway. Peach's tags say urban."""
    for name, types in (("USA_US101-4_1_T-1", {None}), ("USA_Peach-4_8_T-1", {"town"})):
        environment = load_map(read_source(shared(f"commonroad/{name}.xml")))
        assert set(values(environment, "lanelet", "road_type")) == types
