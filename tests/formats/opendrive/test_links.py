"""The lane graph on small maps: sections, both contact points, junctions, and links that lead nowhere."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import pytest

from tests.formats.maps import checks, lanelets, links, messages, points, values
from tests.formats.opendrive.signal_text import WIDTH
from tests.formats.opendrive.xodr import lane, load, road, section

if TYPE_CHECKING:
    from drivelint.road.map_reader import MapTables


def linked(number: int, predecessor: int | None = None, successor: int | None = None, width: str = WIDTH) -> str:
    before = "" if predecessor is None else f'<predecessor id="{predecessor}"/>'
    after = "" if successor is None else f'<successor id="{successor}"/>'
    return lane(number, f"<link>{before}{after}</link>{width}")


def line(x: float, y: float = 0.0, heading: float = 0.0, length: float = 100.0) -> str:
    return f'<geometry s="0" x="{x}" y="{y}" hdg="{heading}" length="{length}"><line/></geometry>'


def link_element(end: str, element_id: str, contact: str, kind: str = "road") -> str:
    at = f' contactPoint="{contact}"' if contact else ""
    return f'<{end} elementType="{kind}" elementId="{element_id}"{at}/>'


def two_roads(
    first: str, second: str, contact: str = "start", *, back: str | None = None, at: str = line(100)
) -> MapTables:
    """Return road 1 that leads to road 2 with these lanes; `back`: the end of road 1 to which road 2 leads with its end."""
    link = "" if back is None else link_element("successor", "1", back)
    return load(
        road("1", lanes=section(0, first), link=link_element("successor", "2", contact)),
        road("2", at, lanes=section(0, second), link=link),
    )


FACING = line(200, heading=math.pi)


def test_sections_of_one_road_are_linked_in_the_direction_of_travel() -> None:
    lanes = section(0, linked(1, successor=1), linked(-1, successor=-2)) + section(
        50, linked(1, predecessor=1), linked(-1), linked(-2, predecessor=-1)
    )
    assert set(links(load(road(lanes=lanes)))) == {("1.0.-1", "1.1.-2"), ("1.1.1", "1.0.1")}
    assert set(links(load(road(lanes=lanes), handedness="lht"))) == {("1.1.-2", "1.0.-1"), ("1.0.1", "1.1.1")}


@pytest.mark.parametrize("told_by", ["first", "second", "both"])
def test_one_link_whoever_declares_it(told_by: str) -> None:
    first = linked(-1, successor=-1) if told_by != "second" else linked(-1)
    second = linked(-1, predecessor=-1) if told_by != "first" else linked(-1)
    environment = load(
        road("1", lanes=section(0, first), link=link_element("successor", "2", "start")),
        road("2", line(100), lanes=section(0, second), link=link_element("predecessor", "1", "end")),
    )
    assert set(links(environment)) == {("1.0.-1", "2.0.-1")}
    assert checks(environment).keys() == {"handedness_default"}


@pytest.mark.parametrize("contact", ["end", ""])
def test_roads_that_meet_end_to_end_swap_the_sign_of_their_lanes(contact: str) -> None:
    environment = load(
        road("1", lanes=section(0, linked(-1, successor=1), linked(1, successor=-1)), link=link_element("successor", "2", contact)),
        road("2", FACING, lanes=section(0, linked(1, successor=-1), linked(-1, successor=1)), link=link_element("successor", "1", "end")),
    )  # fmt: skip
    assert set(links(environment)) == {("1.0.-1", "2.0.1"), ("2.0.-1", "1.0.1")}
    assert "link_gap" not in checks(environment)


def test_a_contact_that_is_not_said_is_the_end_that_names_the_road() -> None:
    environment = two_roads(linked(-1, successor=1), lane(1), "", back="", at=FACING)
    assert set(links(environment)) == {("1.0.-1", "2.0.1")}
    unsaid = two_roads(linked(-1, successor=1), lane(1), "", at=FACING)
    assert checks(unsaid)["missing_link"] == ["1.0.-1"]


def junction(contact: str, to: int, connecting: str) -> tuple[str, str, str, str]:
    """Road 1 leads into the junction, road 2 out of it, 10 joins them."""
    connection = (
        f'<connection incomingRoad="1" connectingRoad="10" contactPoint="{contact}"><laneLink from="-1" to="{to}"/>'
    )
    return (
        road("1", lanes=section(0, lane(-1), lane(1)), link=link_element("successor", "9", "", "junction")),
        road(
            "2", line(120), lanes=section(0, lane(-1), lane(1)), link=link_element("predecessor", "9", "", "junction")
        ),
        connecting,
        f'<junction id="9">{connection}</connection></junction>',
    )


def test_junctions_entered_at_the_start_and_at_the_end_of_the_connecting_road() -> None:
    along = road(
        "10", line(100, length=20), section(0, linked(-1, -1, -1)), 20,
        link_element("predecessor", "1", "end") + link_element("successor", "2", "start"), junction="9",
    )  # fmt: skip
    against = road(
        "10", line(120, heading=math.pi, length=20), section(0, linked(1, -1, -1)), 20,
        link_element("predecessor", "2", "start") + link_element("successor", "1", "end"), junction="9",
    )  # fmt: skip
    for contact, to, connecting in (("start", -1, along), ("end", 1, against)):
        environment = load(*junction(contact, to, connecting))
        name = f"10.0.{to}"
        assert set(links(environment)) == {("1.0.-1", name), (name, "2.0.-1")}
        assert lanelets(environment)[name]["junction_id"] == "9"
        assert lanelets(environment)["1.0.-1"]["junction_id"] is None
        assert environment.handedness_source == "junctions"
        assert set(checks(environment)) <= {"unlinked_end"}


def test_the_incoming_road_says_which_of_its_ends_lies_at_the_junction() -> None:
    elsewhere = road("10", line(-20, length=20), section(0, lane(-1)), 20, junction="9")
    environment = load(*junction("start", -1, elsewhere))
    assert set(links(environment)) == {("1.0.-1", "10.0.-1")}
    assert checks(environment)["link_gap"] == ["1.0.-1"]


def test_the_nearer_end_is_taken_where_nobody_says() -> None:
    parts = junction("start", -1, road("10", line(100, length=20), section(0, lane(-1)), 20, junction="9"))
    environment = load(road("1"), *parts[1:])
    assert set(links(environment)) == {("1.0.-1", "10.0.-1")}


def test_turn_is_the_heading_change_over_the_lane_entered() -> None:
    bend = '<geometry s="0" x="100" y="0" hdg="0" length="20"><arc curvature="0.05"/></geometry>'
    parts = (
        road("1", lanes=section(0, linked(-1, successor=-1)), link=link_element("successor", "2", "start")),
        road("2", bend, section(0, linked(-1, predecessor=-1)), 20, link_element("predecessor", "1", "end")),
    )
    assert values(load(*parts), "lane_link", "turn_rad") == [1.0]
    back = load(*parts, handedness="lht")
    assert values(back, "lane_link", "from_id to_id turn_rad") == [("2.0.-1", "1.0.-1", 0.0)]


def test_a_link_to_a_lane_or_road_that_is_missing_is_named() -> None:
    lanes = section(0, linked(-1, successor=-4), linked(-2, successor=-2))
    gone = load(road("1", lanes=lanes, link=link_element("successor", "2", "start")), road("2", line(100)))
    assert checks(gone)["missing_link"] == ["1.0.-1", "1.0.-2"]
    nowhere = load(road(lanes=section(0, linked(-1, successor=-1)), link=link_element("successor", "77", "start")))
    assert checks(nowhere)["missing_link"] == ["1.0.-1"]
    wrong = '<junction id="9"><connection id="0" incomingRoad="1" connectingRoad="5" contactPoint="start"/></junction>'
    assert checks(load(road(), wrong))["missing_link"] == ["5"]
    assert set(values(gone, "map_quality", "severity", check_id="missing_link")) == {"error"}


def test_a_link_that_the_map_forgot_is_named() -> None:
    environment = load(road("1"), road("2", line(100)))
    assert links(environment) == []
    assert checks(environment)["unlinked_end"] == ["1.0.-1", "2.0.1"]


def test_a_link_over_a_gap_is_kept_and_named_with_its_distance() -> None:
    environment = two_roads(linked(-1, successor=-1), linked(-1), at=line(102))
    assert set(links(environment)) == {("1.0.-1", "2.0.-1")}
    (message,) = messages(environment, "link_gap")
    assert "2.00 m" in message


def test_lanes_that_are_driven_towards_each_other_are_not_linked() -> None:
    environment = two_roads(linked(-1, successor=1), linked(1))
    assert links(environment) == []
    assert checks(environment)["direction_conflict"] == ["1.0.-1"]


def test_links_pass_through_a_section_that_is_a_rounding_error() -> None:
    lanes = (
        section(0, linked(-1, successor=-1))
        + section(50, linked(-1, predecessor=-1, successor=-2), linked(-2))
        + section(50.0000001, linked(-1), linked(-2, predecessor=-1))
    )
    environment = load(road(lanes=lanes))
    assert set(lanelets(environment)) == {"1.0.-1", "1.2.-1", "1.2.-2"}
    assert set(links(environment)) == {("1.0.-1", "1.2.-2")}
    assert checks(environment)["short_section"] == ["1"]


def test_neighbours_skip_a_lane_that_is_only_a_line() -> None:
    environment = load(road(lanes=section(0, lane(1), lane(-1, '<width sOffset="0" a="0.02"/>'), lane(-2))))
    lanes = lanelets(environment)
    assert set(lanes) == {"1.0.1", "1.0.-2"}
    assert (lanes["1.0.-2"]["left_id"], lanes["1.0.-2"]["left_against"]) == ("1.0.1", True)
    assert checks(environment)["narrow_lane"] == ["1.0.-1"]


def test_sides_may_be_cut_differently() -> None:
    lanes = (
        section(0, lane(1), lane(-1, "<link><successor id='-1'/></link>" + WIDTH))
        + section(40, linked(-1, predecessor=-1), linked(-2), attributes='singleSide="true"')
    )  # fmt: skip
    environment = load(road(lanes=lanes))
    found = lanelets(environment)
    assert {name: round(row["length_m"], 6) for name, row in found.items()} == {
        "1.0.-1": 40.0, "1.0.1": 100.0, "1.1.-2": 60.0, "1.1.-1": 60.0,
    }  # fmt: skip
    assert set(links(environment)) == {("1.0.-1", "1.1.-1")}
    assert found["1.1.-1"]["left_id"] == found["1.0.-1"]["left_id"] == "1.0.1"
    assert found["1.0.1"]["left_id"] == "1.1.-1"  # the one that it lies longest beside


def test_a_virtual_junction_is_named() -> None:
    environment = load(
        road(), '<junction id="4" type="virtual"><connection incomingRoad="1" connectingRoad="2"/></junction>'
    )
    assert checks(environment)["virtual_junction"] == ["4"]


def test_bidirectional_lanes_run_as_the_right_hand_side() -> None:
    lanes = section(0, lane(1), lane(-1, kind="bidirectional"), lane(-2))
    for handedness, along in (("rht", 1), ("lht", -1)):
        middle = lanelets(load(road(lanes=lanes), handedness=handedness))["1.0.-1"]
        assert (middle["bidirectional"], middle["along_road"]) == (True, along)
    beside = lanelets(load(road(lanes=lanes)))["1.0.-2"]
    assert (beside["left_id"], beside["left_against"]) == ("1.0.-1", True)


def test_a_reversed_lane_goes_the_other_way() -> None:
    lanes = section(0, lane(-1, attributes='direction="reversed"'), lane(-2))
    found = lanelets(load(road(lanes=lanes)))
    assert (found["1.0.-1"]["along_road"], found["1.0.-2"]["along_road"]) == (-1, 1)
    assert found["1.0.-2"]["left_against"] is True


def test_mirrored_handedness_is_the_same_road_driven_the_other_way() -> None:
    lanes = section(0, linked(1, successor=1), linked(-1, successor=-1)) + section(
        60, linked(1, predecessor=1), linked(-1)
    )
    right, left = load(road(lanes=lanes)), load(road(lanes=lanes), handedness="lht")
    assert set(links(left)) == {(b, a) for a, b in links(right)}
    for name, line_ in points(right).items():
        other = points(left)[name][::-1]
        assert [(p["x_m"], p["y_m"]) for p in line_] == [(p["x_m"], p["y_m"]) for p in other]
        assert [(p["left_x_m"], p["left_y_m"]) for p in line_] == [(p["right_x_m"], p["right_y_m"]) for p in other]
        assert [(p["tx"], p["ty"]) for p in line_] == [(-p["tx"], -p["ty"]) for p in other]
