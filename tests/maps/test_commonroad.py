"""CommonRoad maps: lanelets, junctions, markings, limits, stop lines, crosswalks, the side driven on."""

from __future__ import annotations

import pytest

from drivelint.errors import MapError
from drivelint.maps import load_map, read_source
from drivelint.maps.contract import Environment, MapSource
from tests.shared_data import shared


def bound(tag: str, points: list[tuple[float, float]], marking: str = "") -> str:
    inner = "".join(f"<point><x>{x}</x><y>{y}</y></point>" for x, y in points)
    return f"<{tag}>{inner}{f'<lineMarking>{marking}</lineMarking>' if marking else ''}</{tag}>"


def lanelet(name: int, y: float, more: str = "", *, x: float = 0.0, left: str = "dashed", right: str = "solid") -> str:
    a, b = [(x, y + 1.75), (x + 50, y + 1.75)], [(x, y - 1.75), (x + 50, y - 1.75)]
    return f'<lanelet id="{name}">{bound("leftBound", a, left)}{bound("rightBound", b, right)}{more}</lanelet>'


def scenario(*parts: str, benchmark: str = "ZAM_Test-1") -> str:
    return f'<commonRoad commonRoadVersion="2020a" benchmarkID="{benchmark}" timeStepSize="0.1">{"".join(parts)}</commonRoad>'


def load(text: str, **options: object) -> Environment:
    return load_map(MapSource("a.xml", text.encode()), **options)  # type: ignore[arg-type]


def test_lanelets_and_what_lies_on_them() -> None:
    environment = load(
        scenario(
            lanelet(1, 0.0, '<successor ref="2"/><laneletType>country</laneletType><trafficSignRef ref="90"/>'
                    "<stopLine><point><x>45</x><y>1.75</y></point><point><x>45</x><y>-1.75</y></point></stopLine>"),
            lanelet(2, 0.0, "<laneletType>interstate</laneletType>", x=50.0),
            lanelet(3, -3.5, '<laneletType>sidewalk</laneletType><adjacentLeft ref="1" drivingDir="same"/>'),
            '<lanelet id="4">'
            + bound("leftBound", [(20.0, 5.0), (20.0, -5.0)])
            + bound("rightBound", [(17.0, 5.0), (17.0, -5.0)])
            + "<laneletType>crosswalk</laneletType></lanelet>",
            '<trafficSign id="90"><trafficSignElement><trafficSignID>274</trafficSignID>'
            "<additionalValue>13.9</additionalValue></trafficSignElement>"
            "<position><point><x>10</x><y>-4</y></point></position></trafficSign>",
            '<intersection id="80"><incoming id="81"><incomingLanelet ref="1"/><successorsStraight ref="2"/></incoming></intersection>',
        ),
        offset=(100.0, 0.0),
    )  # fmt: skip
    rows = {table: content.to_pylist() for table, content in environment.tables.items()}
    lanes = {row["lanelet_id"]: row for row in rows["lanelet"]}
    assert set(lanes) == {"1", "2", "3"}
    assert (lanes["1"]["road_type"], lanes["1"]["drivable"], lanes["1"]["junction_id"]) == ("rural", True, None)
    assert (lanes["2"]["road_type"], lanes["2"]["junction_id"]) == ("motorway", "80")
    assert (lanes["3"]["lane_type"], lanes["3"]["drivable"]) == ("sidewalk", False)
    assert [(r["from_id"], r["to_id"]) for r in rows["lane_link"]] == [("1", "2")]
    assert [(r["side"], r["marking"]) for r in rows["lane_boundary"] if r["lanelet_id"] == "1"] == [
        ("left", "broken"),
        ("right", "solid"),
    ]
    assert [(r["lanelet_id"], r["limit_mps"], r["source"]) for r in rows["speed_limit"]] == [("1", 13.9, "sign")]
    assert [(r["stop_line_id"], r["lane_s_m"]) for r in rows["stop_line"]] == [("1.stop", pytest.approx(45.0))]
    assert [(r["crossing_id"], r["lanelet_id"], r["s_start_m"], r["s_end_m"]) for r in rows["crossing"]] == [
        ("4", "1", pytest.approx(17.0), pytest.approx(20.0))
    ]
    assert [(r["signal_id"], r["kind"], r["lane_s_m"]) for r in rows["traffic_signal"]] == [
        ("90", "speed_limit", pytest.approx(10.0))
    ]
    assert rows["lane_point"][0]["x_m"] == 100.0


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
    environment = load(
        scenario(lanelet(1, 0.0, '<trafficLightRef ref="90"/>'), f'<trafficLight id="90">{direction}</trafficLight>')
    )
    (row,) = environment.tables["traffic_signal"].to_pylist()
    assert (row["kind"], row["turns"]) == ("traffic_light", turns)


@pytest.mark.parametrize(
    ("parts", "benchmark", "options", "expected"),
    [
        ([lanelet(1, 0.0)], "ZAM_Test-1", {}, ("rht", "default")),
        ([lanelet(1, 0.0)], "DEU_Test-1", {}, ("rht", "attribute")),
        ([lanelet(1, 0.0)], "C-GBR_Test-1", {}, ("lht", "attribute")),
        ([lanelet(1, 0.0)], "ZAM_Test-1", {"handedness": "lht"}, ("lht", "option")),
        (
            [lanelet(1, 0.0, '<adjacentRight ref="2" drivingDir="opposite"/>'), lanelet(2, -3.5)],
            "ZAM_T-1",
            {},
            ("lht", "lanes"),
        ),
        # whoever drives along one-way lanes agrees with them on either side of the road
        ([lanelet(1, 0.0)], "ZAM_Test-1", {"sensed": "lht"}, ("rht", "default")),
    ],
)
def test_the_side_driven_on(
    parts: list[str], benchmark: str, options: dict[str, str], expected: tuple[str, str]
) -> None:
    environment = load(scenario(*parts, benchmark=benchmark), **options)
    assert (environment.handedness, environment.handedness_source) == expected
    assert environment.environment_id.endswith("?") == (expected[1] == "default")


def test_witnesses_that_disagree_are_reported() -> None:
    environment = load(
        scenario(lanelet(1, 0.0, '<adjacentLeft ref="2" drivingDir="opposite"/>'), lanelet(2, 3.5), benchmark="GBR_T-1")
    )
    assert environment.handedness == "rht"
    assert [row["check_id"] for row in environment.tables["map_quality"].to_pylist()] == ["handedness_disagrees"]


def test_a_lanelet_that_cannot_be_read_is_named() -> None:
    environment = load(
        scenario(lanelet(1, 0.0), '<lanelet id="9"><leftBound><point><x>a</x><y>1</y></point></leftBound></lanelet>')
    )
    assert [
        (r["check_id"], r["lanelet_id"])
        for r in environment.tables["map_quality"].to_pylist()
        if r["severity"] == "error"
    ] == [("invalid_lane", "9")]


@pytest.mark.parametrize(
    "text", ["<commonRoad/>", '<!DOCTYPE a [<!ENTITY b "c">]><commonRoad>&b;</commonRoad>', "<commonRoad>"]
)
def test_what_cannot_be_a_map_is_refused(text: str) -> None:
    with pytest.raises(MapError, match=r"map a\.xml"):
        load(text)


@pytest.mark.parametrize(
    ("name", "lanelets", "drivable", "found"),
    [
        ("commonroad/DEU_Gar-1_1_T-1.xml", 5, 5, ("rht", "attribute")),
        ("commonroad/OSC_Overtake-1_1_T-1.xml", 124, 107, ("rht", "lanes")),
        ("commonroad/OSC_PedestrianCollision-1_1_T-1.xml", 24, 20, ("rht", "lanes")),
        ("commonroad/USA_US101-5_1_T-1.xml", 5, 5, ("rht", "attribute")),
    ],
)
def test_real_maps(name: str, lanelets: int, drivable: int, found: tuple[str, str]) -> None:
    environment = load_map(read_source(shared(name)))
    rows = environment.tables["lanelet"].to_pylist()
    assert (len(rows), sum(row["drivable"] for row in rows)) == (lanelets, drivable)
    assert (environment.handedness, environment.handedness_source) == found
    assert not environment.tables["map_quality"].num_rows
    assert all(1.9 < row["width_m"] < 6.0 for row in rows if row["drivable"])
