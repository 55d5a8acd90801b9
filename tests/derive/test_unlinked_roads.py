"""An overtake that goes on beyond the end of a road that the map does not join to the next."""

from __future__ import annotations

from functools import cache

import pytest

from drivelint.formats import load_map
from drivelint.road.map_reader import MapSource
from tests.formats.opendrive import xodr
from tests.scenes import Road, drive, judged, limited, linked, moving, plan, swing, times

HANDS = pytest.mark.parametrize("hand", ["rht", "lht"])
DIRECTION = "ukhc.r143.direction"


@cache
def broken(hand: str, gap_m: float) -> Road:
    """Return a two-way road of 1000 m in two pieces, the second so far beyond the end of the first at 300 m, without links."""
    lanes = xodr.section(0, linked(1), linked(-1))
    rule = f'rule="{hand.upper()}"'
    parts = [
        xodr.road(number, plan(((length, 0.0),), (x, 0.0, 0.0)), lanes, length, "", rule, limited(60))
        for number, x, length in (("1", 0.0, 300.0), ("2", 300.0 + gap_m, 700.0 - gap_m))
    ]
    environment = load_map(MapSource(f"broken-{hand}-{gap_m}.xodr", xodr.xodr(*parts).encode()))
    return Road(environment, ((1000.0, 0.0),))


def verdicts(hand: str, gap_m: float, *, out: float, back: float | None) -> set[str]:
    """Return r143's verdicts on an ego that goes out at `out`, 25 m behind a car of half its speed, and back at `back`."""
    way = broken(hand, gap_m)
    t = times(40.0)
    s = 40 + 16 * t
    ego = moving("ego", way, t, s, swing(way, s, out, back))
    slow = moving("slow", way, t, out + 30 + (s - out) / 2, way.own)
    return {row["verdict"] for row in judged([drive([ego, slow], way.environment)], rules=[DIRECTION])}


@HANDS
@pytest.mark.parametrize("gap_m", [0.0, 0.3, 1.0, 5.0, 15.0, 30.0])
@pytest.mark.parametrize("out", [160.0, 200.0, 240.0, 280.0, 295.0])
def test_an_overtake_across_the_break_is_no_breach(hand: str, gap_m: float, out: float) -> None:
    assert "fail" not in verdicts(hand, gap_m, out=out, back=out + 220.0)


@HANDS
@pytest.mark.parametrize("gap_m", [1.0, 15.0])
def test_who_stays_there_is_in_breach_all_the_same(hand: str, gap_m: float) -> None:
    assert "fail" in verdicts(hand, gap_m, out=200.0, back=None)
