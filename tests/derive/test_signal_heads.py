"""Several signal heads at one line: each holds for some turns, and the ego is judged by that of its own."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from tests.derive.junction_scenes import cross, crosswalk, lit, signal, stop_line
from tests.scenes import Actor, derived, drive, judged, moving, rows, times

if TYPE_CHECKING:
    from drivelint.engine.batch import Drive
    from tests.scenes import Road, Row

LINE = 180.0
HANDS = pytest.mark.parametrize("hand", ["rht", "lht"])
FULL, LEFT, RIGHT, STRAIGHT = "-1", "10", "20", "30"
LEFT_STRAIGHT, UNSAID = "40", "99"
Heads = dict[str, tuple[str, str | None]]  # name -> subtype (of an arrow, unless FULL), what it shows all the time


def head(name: str, subtype: str, s: float = 181.0) -> str:
    code = "1000001" if subtype == FULL else "1000011"
    return signal(name, s, code, more=f'subtype="{subtype}"')


def heads_at_line(heads: Heads, hand: str = "rht", line: bool = True) -> dict[str, Road]:
    t = -1.75 if hand == "rht" else 1.75
    lines = (("1", stop_line("line", LINE, t)),) if line else ()
    return cross(hand, (*lines, *(("1", head(name, subtype)) for name, (subtype, _) in heads.items())))


def going(way: Road, end: float = 14.0, v: float = 8.0) -> Actor:
    """Return the ego, whose front is at 122.4 + 8 t and over the line at 7.2 s; it has turned at 11 s."""
    t = times(end)
    return moving("ego", way, t, 120.0 + v * t, way.own)


def told(way: Road, heads: Heads, end: float = 14.0) -> Drive:
    made = drive([going(way, end)], way.environment)
    for name, (_, state) in heads.items():
        if state:
            lit(made, name, (0.0, state))
    return made


def crossed(made: Drive) -> Row:
    con = derived(made, tables=["stop_line_crossing"])
    (row,) = rows(con, "FROM stop_line_crossing")
    assert row["control"] == "traffic_light"
    return row


FILTER: Heads = {"arrow": (LEFT, "green"), "main": (FULL, "red")}
PROTECTED: Heads = {"arrow": (LEFT, "red"), "main": (FULL, "green")}
LINKS: Heads = {"l": (LEFT, "red"), "r": (RIGHT, "amber"), "s": (STRAIGHT, "green"), "u": (FULL, "flashing")}


@HANDS
@pytest.mark.parametrize(
    ("heads", "way", "state"),
    [
        (FILTER, "we", "red"),
        (FILTER, "wn", "green"),
        (FILTER, "ws", "red"),
        (PROTECTED, "we", "green"),
        (PROTECTED, "wn", "red"),
        (PROTECTED, "ws", "green"),
        (LINKS, "we", "green"),
        (LINKS, "wn", "red"),
        (LINKS, "ws", "amber"),
        ({"shared": (LEFT_STRAIGHT, "red"), "r": (RIGHT, "green")}, "we", "red"),
        ({"shared": (LEFT_STRAIGHT, "red"), "r": (RIGHT, "green")}, "wn", "red"),
        ({"shared": (LEFT_STRAIGHT, "red"), "r": (RIGHT, "green")}, "ws", "green"),
    ],
)
def test_each_turn_by_its_own_head(hand: str, heads: Heads, way: str, state: str) -> None:
    road = heads_at_line(heads, hand)[way]
    assert crossed(told(road, heads))["state"] == state


@HANDS
def test_the_same_without_a_line(hand: str) -> None:
    for way, state in (("we", "red"), ("wn", "green")):
        assert crossed(told(heads_at_line(FILTER, hand, line=False)[way], FILTER))["state"] == state


@HANDS
@pytest.mark.parametrize(
    ("heads", "way", "state"),
    [
        # a head that nobody recorded may show something else
        ({"arrow": (LEFT, None), "main": (FULL, "red")}, "wn", None),
        ({"arrow": (LEFT, None), "main": (FULL, "red")}, "we", "red"),
        ({"arrow": (LEFT, "green"), "main": (FULL, None)}, "we", None),
        ({"arrow": (LEFT, "green"), "main": (FULL, None)}, "wn", "green"),
        # two of the same turns are one, as long as they agree
        ({"a": (FULL, "red"), "b": (FULL, "red")}, "we", "red"),
        ({"a": (FULL, "red"), "b": (FULL, "green")}, "we", None),
        ({"a": (FULL, None), "b": (FULL, "green")}, "we", "green"),
        ({"a": (LEFT, None), "b": (LEFT, "green"), "main": (FULL, "red")}, "wn", "green"),
        ({"a": (LEFT, "red"), "b": (LEFT, "green"), "main": (FULL, "red")}, "wn", None),
        # the map does not say which turns
        ({"a": (UNSAID, "red"), "b": (FULL, "green")}, "we", None),
        ({"a": (UNSAID, "green"), "b": (FULL, "green")}, "we", "green"),
        ({"a": (UNSAID, None), "b": (FULL, "green")}, "we", None),
        ({"a": (UNSAID, "red")}, "we", "red"),
        ({"a": (UNSAID, "red"), "arrow": (LEFT, "green")}, "wn", "green"),
        # a dark arrow leaves it to the full light
        ({"arrow": (LEFT, "off"), "main": (FULL, "red")}, "wn", "red"),
        ({"arrow": (LEFT, "off"), "main": (FULL, None)}, "wn", None),
        ({"arrow": (LEFT, "off")}, "wn", "off"),
        # no head is for the ego's turn
        ({"arrow": (LEFT, "green")}, "we", None),
        ({"arrow": (LEFT, "green")}, "wn", "green"),
    ],
)
def test_heads_that_are_not_recorded_or_differ(hand: str, heads: Heads, way: str, state: str | None) -> None:
    road = heads_at_line(heads, hand)[way]
    assert crossed(told(road, heads))["state"] == state


@pytest.mark.ci
@HANDS
def test_a_log_that_ends_before_the_turn_leaves_open_which_head_it_was(hand: str) -> None:
    """Over the line at 7.2 s, into the junction at 7.9 s with the front and at 8.2 s with the centre."""
    same: Heads = {name: (subtype, "red") for name, (subtype, _) in LINKS.items()}
    for heads, state in ((LINKS, None), (FILTER, None), (same, "red")):
        road = heads_at_line(heads, hand)["wn"]
        assert crossed(told(road, heads, end=7.6))["state"] == state


@pytest.mark.ci
@HANDS
@pytest.mark.parametrize("full", [None, "red"])
def test_heads_of_connecting_lanelets(hand: str, full: str | None) -> None:
    """Each way through the junction has its own, beside a full light before it that does not count then."""
    heads: Heads = {"s": (FULL, "green"), "r": (FULL, "amber"), "l": (FULL, "red")}
    inside = tuple((road, head(name, FULL, 5.0)) for road, name in (("10", "s"), ("11", "r"), ("12", "l")))
    line = (("1", stop_line("line", LINE, -1.75 if hand == "rht" else 1.75)),)
    before = (("1", head("main", FULL)),) if full else ()
    ways = cross(hand, (*line, *before, *inside))
    heads = {**heads, **({"main": (FULL, full)} if full else {})}
    for way, state in (("we", "green"), ("ws", "amber"), ("wn", "red")):
        assert crossed(told(ways[way], heads))["state"] == state
    # undriven, it may have been any of them
    assert crossed(told(ways["we"], heads, end=7.6))["state"] is None
    same: Heads = {name: (subtype, "red") for name, (subtype, _) in heads.items()}
    assert crossed(told(ways["we"], same, end=7.6))["state"] == "red"


@HANDS
def test_a_light_belongs_to_the_line_it_stands_at(hand: str) -> None:
    """A crossing with its own lights 22 m before those of the junction."""
    t = -1.75 if hand == "rht" else 1.75
    signals = (
        ("1", stop_line("first", 158.0, t)), ("1", head("near", FULL, 159.0)),
        ("1", stop_line("line", LINE, t)), ("1", head("far", FULL, 181.0)),
    )  # fmt: skip
    way = cross(hand, signals, (("1", crosswalk("walk", 160.0)),))["we"]
    made = told(way, {"near": (FULL, "green"), "far": (FULL, "red")})
    con = derived(made, tables=["stop_line_crossing", "crossing_passage"])
    found = rows(con, "FROM stop_line_crossing ORDER BY t_ns")
    assert [(r["stop_line_id"], r["signal_id"], r["state"]) for r in found] == [
        ("first", "near", "green"), ("line", "far", "red"),
    ]  # fmt: skip
    (over,) = rows(con, "FROM crossing_passage")
    assert (over["signal_id"], over["state"]) == ("near", "green")


@HANDS
def test_standing_before_the_line_it_sees_its_own_head(hand: str) -> None:
    t = times(30)
    s = np.interp(t, [0, 10, 20, 30], [LINE - 42.4, LINE - 3.4, LINE - 3.4, LINE + 40])
    for way, state in (("we", "red"), ("wn", "green")):
        road = heads_at_line(FILTER, hand)[way]
        made = drive([moving("ego", road, t, s, road.own)], road.environment)
        for name, (_, shown) in FILTER.items():
            lit(made, name, (0.0, shown))
        (row,) = rows(derived(made, tables=["standstill"]), "FROM standstill")
        assert (row["control"], row["state"]) == ("traffic_light", state)


@HANDS
def test_the_change_of_the_own_head_is_the_one_that_counts(hand: str) -> None:
    """The main light turns amber at 4 s; the arrow stays green, and turns amber at 6 s."""
    for way, since in (("we", 4.0), ("wn", 6.0)):
        road = heads_at_line(FILTER, hand)[way]
        made = drive([going(road)], road.environment)
        lit(made, "main", (0.0, "green"), (4.0, "amber"))
        lit(made, "arrow", (0.0, "green"), (6.0, "amber"))
        row = crossed(made)
        assert (row["state"], row["state_before"], row["t_state_ns"]) == ("amber", "green", since * 1e9)
        assert row["amber_front_m"] == pytest.approx(LINE - 122.4 - 8 * since, abs=0.05)


@HANDS
@pytest.mark.parametrize(
    ("heads", "way", "verdict"),
    [
        (FILTER, "we", "fail"), (FILTER, "wn", "pass"), (PROTECTED, "we", "pass"), (PROTECTED, "wn", "fail"),
        ({"a": (FULL, "red"), "b": (FULL, "green")}, "we", "unknown"),
    ],
)  # fmt: skip
def test_the_rule_on_red_lights(hand: str, heads: Heads, way: str, verdict: str) -> None:
    road = heads_at_line(heads, hand)[way]
    found = judged([told(road, heads)], rules=("ukhc.r175.red",))
    assert [row["verdict"] for row in found] == [verdict]
