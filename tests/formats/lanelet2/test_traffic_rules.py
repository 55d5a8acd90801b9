"""Who may drive on a lanelet, which way, and how fast: against lanelet2 1.2.3 by its German rules (it has no others)."""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import pytest

from drivelint.engine.map_fit import one_way_lanes
from drivelint.formats import load_map, read_source
from drivelint.formats.lanelet2.file import load_map_and_is_local
from drivelint.formats.lanelet2.traffic_rules import speed_mps
from drivelint.report.progress import Silent
from drivelint.road.map_reader import MapOptions, MapTables
from drivelint.road.quality import MapQuality
from drivelint.run import CheckOptions, check
from tests.formats.lanelet2.drawing import Drawing
from tests.shared_data import shared

lanelet2: Any = pytest.importorskip("lanelet2", reason="the package lanelet2 is not installed (extra 'lanelet2')")

MOTOR = ("vehicle:car", "vehicle:truck", "vehicle:motorcycle", "vehicle:bus", "vehicle:taxi")
REPORTED = "reported/lanelet2_participants"
# lane_type, drivable, bidirectional of the lanelets of both maps that are not the same, then of all others
BY_PEER = {
    "who.osm": {"104": ("driving", True, True), "105": ("driving", True, False)},
    "who2.osm": {"104": ("driving", True, True), "105": ("driving", True, True)},
}
SAME_IN_BOTH = {
    "100": ("driving", True, False), "101": ("biking", False, False), "102": ("sidewalk", False, False),
    "103": ("driving", True, False), "106": ("driving", True, False), "107": ("driving", True, False),
    "108": ("driving", True, False), "109": ("driving", True, False), "110": ("driving", True, False),
    "111": ("driving", True, False),
}  # fmt: skip


@cache
def rules(participant: str) -> Any:
    return lanelet2.traffic_rules.create(lanelet2.traffic_rules.Locations.Germany, participant)


def lanes(environment: MapTables) -> dict[str, tuple[str, bool, bool]]:
    rows = environment.tables["lanelet"].to_pylist()
    return {row["lanelet_id"]: (row["lane_type"], row["drivable"], row["bidirectional"]) for row in rows}


@pytest.mark.parametrize("name", BY_PEER)
def test_who_may_use_the_lanelets_of_a_public_report(name: str) -> None:
    source = read_source(shared(f"{REPORTED}/{name}"))
    found = lanes(load_map(source))
    assert found == BY_PEER[name] | SAME_IN_BOTH
    layers, _ = load_map_and_is_local(source, MapOptions(), MapQuality())
    assert len(list(layers.laneletLayer)) == 12
    for lanelet in layers.laneletLayer:
        lane_type, drivable, bidirectional = found[str(lanelet.id)]
        motor = [word for word in MOTOR if rules(word).canPass(lanelet)]
        assert drivable == bool(motor)
        assert bidirectional == any(not rules(word).isOneWay(lanelet) for word in motor)
        assert (lane_type == "biking") == (not motor and rules("bicycle").canPass(lanelet))
        assert (lane_type == "sidewalk") == (not motor and rules("pedestrian").canPass(lanelet))


def test_limits_of_the_lanelets_of_a_public_report() -> None:
    rows = load_map(read_source(shared(f"{REPORTED}/who.osm"))).tables["speed_limit"].to_pylist()
    assert {row["lanelet_id"]: round(3.6 * row["limit_mps"], 2) for row in rows} == {
        "107": 112.65, "108": 50.0, "109": 50.04, "110": 48.28,
    }  # fmt: skip


def lane_with_tags(**tags: str) -> tuple[tuple[str, bool, bool] | None, MapTables]:
    """Return lane type, drivable and bidirectional of a lanelet with these tags, which lies beside a road; None: it is no lane."""
    drawing = Drawing()
    left, middle, right = (drawing.way([(0.0, y), (50.0, y)]) for y in (3.5, 0.0, -3.5))
    drawing.lanelet(left, middle)
    said = {key.replace("__", ":"): value for key, value in tags.items()}
    name = str(drawing.lanelet(middle, right, **said))
    environment = drawing.load()
    return lanes(environment).get(name), environment


@pytest.mark.sample(12, ci=11)
@pytest.mark.parametrize(
    ("tags", "expected"),
    [
        ({}, ("driving", True, False)),
        ({"subtype": "bus_lane"}, ("bus", True, False)),
        ({"subtype": "bus_lane", "participant__vehicle": "yes"}, ("driving", True, False)),
        ({"subtype": "bus_lane", "participant__bicycle": "yes"}, ("biking", False, False)),
        ({"participant__vehicle__taxi": "yes"}, ("taxi", True, False)),
        ({"participant__vehicle__truck": "yes"}, ("driving", True, False)),
        ({"participant__vehicle__emergency": "yes"}, ("restricted", False, False)),
        ({"participant__vehicle": "no"}, ("restricted", False, False)),
        ({"participant__bicycle": "yes", "participant__pedestrian": "yes"}, ("sidewalk", False, False)),
        ({"subtype": "emergency_lane"}, ("stop", False, False)),
        ({"subtype": "exit"}, ("exit", True, False)),
        ({"subtype": "bicycle_lane"}, ("biking", False, False)),
        ({"subtype": "bicycle_lane", "participant__pedestrian": "yes"}, ("sidewalk", False, False)),
        ({"subtype": "shared_walkway"}, ("sidewalk", False, False)),
        ({"subtype": "road_shoulder"}, ("shoulder", False, False)),
        ({"subtype": "road_shoulder", "participant__vehicle": "yes"}, ("shoulder", False, False)),
        ({"subtype": "crosswalk"}, None),
        ({"subtype": "parking"}, None),
        ({"one_way": "no"}, ("driving", True, True)),
        ({"one_way": "no", "one_way__vehicle": "yes"}, ("driving", True, True)),
        ({"one_way": "yes", "one_way__vehicle": "no"}, ("driving", True, False)),
        ({"subtype": "bus_lane", "one_way": "no"}, ("bus", True, True)),
        ({"subtype": "bicycle_lane", "one_way": "no"}, ("biking", False, False)),
    ],
)
def test_who_may_use_a_lanelet_with_these_tags(tags: dict[str, str], expected: tuple[str, bool, bool] | None) -> None:
    """The library's answers, seen with lanelet2 1.2.3, but for Autoware's road shoulders; of `one_way`, the tag for all counts first."""
    assert lane_with_tags(**tags)[0] == expected


@pytest.mark.parametrize(
    ("tags", "lane_type", "unread"),
    [
        ({"participant__vehicle__bus": "yes", "participant__vehicle__motorcycle": "yes"}, "bus", False),
        ({"participant__vehicle__taxi": "yes", "participant__vehicle__motorcycle": "yes"}, "taxi", False),
        ({"participant__vehicle__motorcycle": "yes"}, "driving", True),
        ({"participant__vehicle__truck": "yes", "participant__vehicle__bus": "yes"}, "driving", True),
        ({"subtype": "exit", "participant__vehicle__bus": "yes"}, "exit", True),
        ({"participant__vehicle__car": "yes", "participant__vehicle__bus": "yes"}, "driving", False),
        ({"participant__vehicle__emergency": "yes"}, "restricted", False),
    ],
)
def test_a_lanelet_that_cars_may_not_use_is_of_another_type_or_named(
    tags: dict[str, str], lane_type: str, unread: bool
) -> None:
    lane, environment = lane_with_tags(**tags)
    assert lane is not None
    assert lane[0] == lane_type
    named = [row for row in environment.tables["map_quality"].to_pylist() if row["check_id"] == "access_unread"]
    assert len(named) == unread


@pytest.mark.parametrize("mandatory", ["no", "false", "yes"])
@pytest.mark.parametrize("tag", ["speed_limit_mandatory", "speed_limit_mandatory__vehicle"])
def test_a_recommended_speed_is_no_limit(tag: str, mandatory: str) -> None:
    _, environment = lane_with_tags(speed_limit="30", **{tag: mandatory})
    limits = [round(3.6 * row["limit_mps"]) for row in environment.tables["speed_limit"].to_pylist()]
    assert limits == ([30] if mandatory == "yes" else [])


@pytest.mark.parametrize("dynamic", ["yes", "no", ""])
def test_a_limit_that_changes_is_unknown(dynamic: str) -> None:
    drawing = Drawing()
    left, right = (drawing.way([(0.0, y), (50.0, y)]) for y in (0.0, -3.5))
    said = [
        drawing.element("speed_limit", refers=[drawing.way([(5.0, -5.0), (5.0, -5.5)], "traffic_sign", "de274-50")])
    ]
    if dynamic:
        drawing.tag_last(dynamic=dynamic)
    drawing.lanelet(left, right, said[0], speed_limit="30")
    environment = drawing.load()
    rows = [(row["limit_mps"], row["source"]) for row in environment.tables["speed_limit"].to_pylist()]
    checks = [(row["check_id"], row["message"]) for row in environment.tables["map_quality"].to_pylist()]
    if dynamic == "yes":
        assert rows == [(None, "unread")]
        message = "its limit is dynamic: what it is at a time is not in the map: treated as unknown"
        assert checks == [("invalid_speed", message)]
    else:
        assert rows == [(pytest.approx(50 / 3.6), "sign")]
        assert not checks


def test_a_crosswalk_that_is_a_lane_is_no_crossing() -> None:
    found, environment = lane_with_tags(subtype="crosswalk", participant__vehicle="yes")
    assert found == ("driving", True, False)
    assert environment.tables["crossing"].num_rows == 0


@pytest.mark.parametrize(
    ("text", "kmh"),
    [
        ("50", 50.0), ("50.5", 50.5), ("50 km/h", 50.0), ("50kmh", 50.0), ("50 kmph", 50.0), ("30 mph", 48.28032), ("30mph", 48.28032),
        ("13.9 m/s", 50.04), ("10mps", 36.0), (" 50 ", 50.0), ("50 Km/h", 50.0), ("50 KM/H", 50.0), ("50 Kmh", 50.0), ("30 MPH", 48.28032),
    ],
)  # fmt: skip
def test_limits_that_can_be_read(text: str, kmh: float) -> None:
    """Whatever the case of the unit: lanelet2 1.2.3 reads `50 Km/h` and `50 kmph` as miles, and `50 KM/H` as 0 (findings/)."""
    assert 3.6 * speed_mps(text) == pytest.approx(kmh)
    row = lane_with_tags(speed_limit=text)[1].tables["speed_limit"].to_pylist()[0]
    assert (3.6 * row["limit_mps"], row["source"]) == (pytest.approx(kmh), "sign")


@pytest.mark.parametrize(
    "text",
    [
        "none",
        "walk",
        "DE:urban",
        "50;30",
        "50 mph;30",
        "",
        "-5",
        "0",
        "0 km/h",
        "inf",
        "nan",
        "50 knots",
        "fifty",
        "5 0",
        "signals",
    ],
)
def test_a_limit_that_cannot_be_read_is_unknown_and_never_zero(text: str) -> None:
    assert math.isnan(speed_mps(text))
    environment = lane_with_tags(speed_limit=text)[1]
    rows = environment.tables["speed_limit"].to_pylist()
    assert [(row["limit_mps"], row["source"]) for row in rows] == [(None, "unread")]
    assert "invalid_speed" in environment.tables["map_quality"]["check_id"].to_pylist()


def test_the_tag_for_vehicles_goes_before_that_for_all() -> None:
    rows = lane_with_tags(speed_limit="50", speed_limit__vehicle="30", speed_limit__bicycle="10")[1].tables[
        "speed_limit"
    ]
    assert [round(3.6 * row["limit_mps"], 6) for row in rows.to_pylist()] == [30.0]


@pytest.mark.parametrize(
    ("code", "tag", "expected"),
    [
        ("de274-30", "50", (30.0, "sign")),
        ("gb670", "50", (50.0, "sign")),
        ("gb670", "50 Km/h", (50.0, "sign")),
        ("de274-30", "50 Km/h", (30.0, "sign")),
        ("gb670", "50;30", (None, "unread")),
        ("gb670", "DE:urban", (None, "unread")),
        ("gb670", None, (None, "unread")),
        ("gb670", "none", (None, "unread")),
    ],
)
def test_a_sign_whose_code_the_library_does_not_know(
    code: str, tag: str | None, expected: tuple[float | None, str]
) -> None:
    drawing = Drawing()
    left, right = (drawing.way([(0.0, y), (50.0, y)]) for y in (0.0, -3.5))
    sign = drawing.way([(10.0, -5.0), (10.0, -6.0)], "traffic_sign", code)
    member = drawing.element(refers=[sign])
    drawing.parts[-1] = drawing.parts[-1].replace('v="traffic_sign"', 'v="speed_limit"')
    drawing.lanelet(left, right, member, **({} if tag is None else {"speed_limit": tag}))
    (row,) = drawing.load().tables["speed_limit"].to_pylist()
    assert (row["limit_mps"] and pytest.approx(3.6 * row["limit_mps"]), row["source"]) == expected


def test_a_lanelet_that_is_driven_both_ways_does_not_vote_against_the_map() -> None:
    """Driven against its drawn direction, the map fits; the same drive on a lanelet of one direction is against it."""
    assert len(one_way_lanes(lane_with_tags(one_way="no")[1]).lines) == 1


@pytest.mark.ci
@pytest.mark.parametrize(("y", "ok"), [(41.75, True), (1.75, False)])
def test_the_drive_of_a_public_report_turned_round(y: float, ok: bool, tmp_path: Any) -> None:
    """Lanelet 104 is `one_way:vehicle=no`, lanelet 100 has one direction: only there, to drive to the west is to drive against the lane."""
    folder = shared(REPORTED)
    log = tmp_path / "d.csv"
    lines = ["t,id,x,y,yaw,v,l,w", *(f"{n / 10},c0,{250 - n},{y},3.14159265,10,4.5,1.8" for n in range(200))]
    log.write_text("\n".join(lines) + "\n", "utf-8")
    options = CheckOptions(
        (str(log),), mapping=str(folder / "d.toml"), map=folder / "who.osm", handedness="rht", rules=("ukhc.r143.direction",),
        robustness=False,
    )  # fmt: skip
    (verdict,) = check(options, Silent()).verdicts.to_pylist()
    assert (verdict["verdict"], verdict["reason_code"]) == (
        ("pass", "kept") if ok else ("unknown", "missing_registration")
    )
