"""A map's own words become those of the vocabularies; what is in none is not known, and the map's quality says so."""

from __future__ import annotations

import pytest

from drivelint.sql.words import words_of_vocabulary
from tests.formats.opendrive.signal_text import WIDTH
from tests.formats.opendrive.xodr import lane, lanelets, load, road, rows, section

MARK = '<roadMark sOffset="0" type="{}" color="{}" laneChange="{}"/>'


def unknown(environment: object) -> list[tuple[str, str, int]]:
    """Return severity, message and number of what the map says with unknown names."""
    found = [row for row in rows(environment, "map_quality") if row["check_id"] == "unknown_word"]  # type: ignore[arg-type]
    return [(row["severity"], row["message"], row["n"]) for row in found]


# ASAM OpenDRIVE 1.8.1, e_laneType, in the order of its schema
LANE_TYPES = (
    "shoulder", "border", "driving", "stop", "none", "restricted", "parking", "median", "biking", "shared", "sidewalk", "curb", "exit",
    "entry", "onRamp", "offRamp", "connectingRamp", "bidirectional", "special1", "special2", "special3", "roadWorks", "tram", "rail",
    "bus", "taxi", "HOV", "mwyEntry", "mwyExit", "walking", "slipLane",
)  # fmt: skip


@pytest.mark.parametrize("kind", LANE_TYPES)
def test_every_lane_type_of_the_standard_is_a_word(kind: str) -> None:
    environment = load(road(lanes=section(0, lane(1), lane(-1, kind=kind))))
    assert lanelets(environment)["1.0.-1"]["lane_type"] == kind
    assert unknown(environment) == []


def test_the_lane_types_are_those_of_the_standard_and_two_more() -> None:
    assert set(words_of_vocabulary("lane_type")) - set(LANE_TYPES) == {"carpool", "unknown"}
    assert set(LANE_TYPES) <= set(words_of_vocabulary("lane_type"))


def test_a_lane_of_a_type_that_is_not_known_is_named_and_not_driven_on() -> None:
    lanes = section(0, lane(1), lane(-1, kind="drivng"), lane(-2, kind="drivng"), lane(-3, kind="hoverlane"))
    environment = load(road(lanes=lanes))
    found = {name: (row["lane_type"], row["drivable"]) for name, row in lanelets(environment).items()}
    assert found == {"1.0.1": ("driving", True), **dict.fromkeys(["1.0.-1", "1.0.-2", "1.0.-3"], ("unknown", False))}
    message = "types of lanes with unknown names: drivng (2), hoverlane (1): vehicles are assumed not to drive there"
    assert unknown(environment) == [("warning", message, 3)]


def test_the_case_of_a_word_does_not_matter() -> None:
    lanes = section(0, lane(1, WIDTH + MARK.format("Solid Solid", "WHITE", "None")), lane(-1, kind="onramp"))
    environment = load(road(lanes=lanes, more='<type s="0" type="Motorway"/>'))
    assert lanelets(environment)["1.0.-1"]["lane_type"] == "onRamp"
    assert lanelets(environment)["1.0.-1"]["road_type"] == "motorway"
    (mark,) = {(r["marking"], r["color"], r["lane_change"]) for r in rows(environment, "lane_boundary") if r["marking"]}
    assert mark == ("solid_solid", "white", "none")
    assert unknown(environment) == []


def test_marks_and_roads_in_words_that_are_not_known_are_not_known() -> None:
    """`custom` is described in the file by its lines, which are not read: it may be a solid line."""
    lanes = section(0, lane(1), lane(-1, WIDTH + MARK.format("custom", "pink", "sometimes")))
    environment = load(road(lanes=lanes, more='<type s="0" type="boulevard"/>'))
    edges = [r for r in rows(environment, "lane_boundary") if (r["lanelet_id"], r["side"]) == ("1.0.-1", "right")]
    assert [(r["marking"], r["color"], r["lane_change"]) for r in edges] == [(None, None, None)]
    assert lanelets(environment)["1.0.-1"]["road_type"] is None
    assert [message.partition(":")[0] for _, message, _ in unknown(environment)] == [
        "colors of road marks with unknown names",
        "lane changes over road marks with unknown names",
        "road marks with unknown names",
        "types of roads with unknown names",
    ]
    assert {severity for severity, _, _ in unknown(environment)} == {"info"}


def test_a_road_of_type_unknown_says_none_and_is_no_finding() -> None:
    environment = load(road(more='<type s="0" type="unknown"/>'))
    assert lanelets(environment)["1.0.-1"]["road_type"] is None
    assert unknown(environment) == []


def test_a_word_that_steers_a_terminal_is_shown_as_its_code() -> None:
    environment = load(road(lanes=section(0, lane(1), lane(-1, kind="a&#x202e;b"))))
    ((_, message, _),) = unknown(environment)
    assert "a\\u202eb (1)" in message
