"""Which side of the road: option, attribute, junctions, lanes' direction, traces, default; and disagreements."""

from __future__ import annotations

import pytest

from tests.formats.maps import checks, hand, lanelets, messages, points
from tests.formats.opendrive.signal_text import WIDTH
from tests.formats.opendrive.xodr import geometry, lane, load, road, section


def travelling(number: int, way: str) -> str:
    return lane(number, f'{WIDTH}<userData><vectorLane travelDir="{way}"/></userData>')


def junction(*links: tuple[str, int]) -> str:
    connections = "".join(
        f'<connection id="{i}" incomingRoad="1" connectingRoad="10" contactPoint="{contact}">'
        f'<laneLink from="1" to="{to}"/></connection>'
        for i, (contact, to) in enumerate(links)
    )
    return f'<junction id="9">{connections}</junction>'


CONNECTING = road("10", junction="9")


def test_the_option_comes_first() -> None:
    environment = load(road(attributes='rule="RHT"'), handedness="lht", voted_handedness="rht")
    assert hand(environment) == ("lht", "option")
    assert "handedness_disagrees" in checks(environment)
    assert lanelets(environment)["1.0.1"]["along_road"] == 1


@pytest.mark.parametrize(
    ("options", "sides", "remedy"),
    [
        ({"handedness": "lht", "voted_handedness": "rht"}, ("--handedness says lht, ", "rht", "lht"), "leave the option out, or set rht"),
        ({"handedness": "rht", "voted_handedness": "lht"}, ("--handedness says rht, ", "lht", "rht"), "give --handedness lht"),
        ({"voted_handedness": "lht"}, ("", "lht", "rht"), "give --handedness lht"),
    ],
)  # fmt: skip
def test_a_doubt_says_what_would_have_the_other_side(
    options: dict[str, str], sides: tuple[str, str, str], remedy: str
) -> None:
    option, traces, used = sides
    (message,) = messages(load(road(attributes='rule="RHT"'), **options), "handedness_disagrees")
    assert message == (
        f"{option}the rule attribute of 1 road says rht, the traces fit {traces}: {used} is used. "
        f"If this is not right, every direction is wrong: {remedy}."
    )


def test_then_the_attribute() -> None:
    environment = load(road(attributes='rule="LHT"'), CONNECTING, junction(("start", -1)), voted_handedness="rht")
    assert hand(environment) == ("lht", "attribute")
    assert "handedness_disagrees" in checks(environment)


@pytest.mark.parametrize(
    ("contact", "to", "handedness"), [("start", -1, "rht"), ("start", 1, "lht"), ("end", 1, "rht"), ("end", -1, "lht")]
)
def test_then_the_junctions(contact: str, to: int, handedness: str) -> None:
    environment = load(road(), CONNECTING, junction((contact, to)))
    assert hand(environment) == (handedness, "junctions")
    assert "handedness_disagrees" not in checks(environment)


def test_junctions_that_list_both_ends_say_nothing() -> None:
    environment = load(road(), CONNECTING, junction(("start", -1), ("end", -1)), voted_handedness="lht")
    assert hand(environment) == ("lht", "traces")


def test_then_the_lanes_own_travel_direction() -> None:
    environment = load(
        road(lanes=section(0, travelling(1, "forward"), travelling(-1, "backward"))), voted_handedness="rht"
    )
    assert hand(environment) == ("lht", "attribute")
    assert "handedness_disagrees" in checks(environment)


def test_then_the_traces_then_the_default_with_a_warning() -> None:
    voted = load(road(), voted_handedness="lht")
    assert hand(voted) == ("lht", "traces")
    assert "handedness_default" not in checks(voted)
    guessed = load(road())
    assert hand(guessed) == ("rht", "default")
    assert checks(guessed)["handedness_default"] == [None]


def test_roads_that_disagree_are_named() -> None:
    environment = load(road("1", attributes='rule="LHT"'), road("2", attributes='rule="RHT"'))
    assert environment.handedness_source == "default"
    assert "handedness_mixed" in checks(environment)


def test_one_lane_against_the_rule_of_its_side_is_followed_and_named() -> None:
    ways = {1: "backward", -1: "backward", -2: "forward", -3: "forward"}
    lanes = section(0, *(travelling(*way) for way in ways.items()))
    environment = load(road(lanes=lanes))
    along = {name: row["along_road"] for name, row in lanelets(environment).items()}
    assert along == {"1.0.-3": 1, "1.0.-2": 1, "1.0.-1": -1, "1.0.1": -1}
    assert checks(environment)["direction_exception"] == ["1.0.-1"]
    assert lanelets(environment)["1.0.-2"]["left_against"] is True


def test_the_option_overrides_travel_directions_too() -> None:
    lanes = section(0, travelling(1, "backward"), travelling(-1, "forward"))
    along = {name: row["along_road"] for name, row in lanelets(load(road(lanes=lanes), handedness="lht")).items()}
    assert along == {"1.0.-1": -1, "1.0.1": 1}


def test_the_left_hand_roads_of_netconvert_are_read_by_the_numbers_of_their_lanes() -> None:
    """Those in junctions stand under `<left>` and have negative numbers, and no road says a rule (netconvert 1.28.0).

    The way to the east through a junction: lane 0 of the net, the outer one, is at y = 4.8, and so is lane -1 of each road.
    """
    east = [(1, 0.0, 92.8), (2, 92.8, 14.4), (3, 107.2, 92.8)]
    wide = '<width sOffset="0" a="3.2" b="0" c="0" d="0"/>'
    parts = []
    for number, x, length in east:
        numbered = lane(-1, wide) + lane(-2, wide)
        middle = '<center><lane id="0" type="none"/></center>'
        both = f"<left>{numbered}</left>{middle}" if number == 2 else f"{middle}<right>{numbered}</right>"
        line, lanes = geometry("<line/>", at=(x, 6.4, 0), length=length), f'<laneSection s="0">{both}</laneSection>'
        parts.append(road(str(number), line, lanes, length, junction="9" if number == 2 else "-1"))
    found = load(*parts)
    where = {name: {(p["left_y_m"] + p["right_y_m"]) / 2 for p in line} for name, line in points(found).items()}
    assert {name: sorted(y) for name, y in where.items()} == {
        f"{number}.0.{no}": [pytest.approx(y)] for number, *_ in east for no, y in ((-1, 4.8), (-2, 1.6))
    }
    assert "invalid_lane" not in checks(found)
    assert checks(found)["lane_side"] == [None]


def test_one_lane_under_the_wrong_side_is_left_out() -> None:
    both = f'<left>{lane(-2)}{lane(1)}</left><center><lane id="0" type="none"/></center><right>{lane(-1)}</right>'
    found = load(road(lanes=f'<laneSection s="0">{both}</laneSection>'))
    assert (checks(found)["invalid_lane"], sorted(lanelets(found))) == (["1.0.-2"], ["1.0.-1", "1.0.1"])
