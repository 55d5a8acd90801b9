"""Several signal heads at one line: each holds for some turns, and the ego is judged by that of its own."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.derive.junction_scenes import cross, lit, signal, stop_line
from tests.scenes import Actor, derived, drive, moving, rows, times

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


def heads_at_line(heads: Heads, hand: str) -> dict[str, Road]:
    t = -1.75 if hand == "rht" else 1.75
    return cross(
        hand, (("1", stop_line("line", LINE, t)), *(("1", head(name, subtype)) for name, (subtype, _) in heads.items()))
    )


def going(way: Road) -> Actor:
    """Return the ego, whose front is at 122.4 + 8 t and over the line at 7.2 s; it has turned at 11 s."""
    t = times(14.0)
    return moving("ego", way, t, 120.0 + 8.0 * t, way.ego_d)


def scene_with_heads(way: Road, heads: Heads) -> Drive:
    made = drive([going(way)], way.environment)
    for name, (_, state) in heads.items():
        if state:
            lit(made, name, (0.0, state))
    return made


def crossed(scene: Drive) -> Row:
    con = derived(scene, tables=["stop_line_crossing"])
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
    assert crossed(scene_with_heads(road, heads))["state"] == state
