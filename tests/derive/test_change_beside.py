"""A lane change into a vehicle beside the ego, at every usual rate of samples; and what a lower rate may not hide."""

from __future__ import annotations

from functools import cache

import pytest

from drivelint.formats import load_map
from drivelint.road.map_reader import MapSource
from tests.derive.marked import ease, mark
from tests.formats.opendrive import xodr
from tests.scenes import LANE, Road, Row, drive, linked, moving, plan, times, verdict_rows

HANDS = pytest.mark.parametrize("hand", ["rht", "lht"])
PERIODS = (0.05, 0.1, 0.2, 0.5)
SAFE = "stvo.rg6"


@cache
def motorway(hand: str) -> Road:
    """Return one carriageway of a motorway with three lanes."""
    side = 1 if hand == "lht" else -1
    lanes = [linked(side * n).replace("</lane>", mark("broken") + "</lane>") for n in (1, 2, 3)]
    text = xodr.xodr(
        xodr.road(
            geometry=plan(((900.0, 0.0),)),
            lanes=xodr.section(0, *(lanes[::-1] if side > 0 else lanes)),
            length=900.0,
            attributes=f'rule="{hand.upper()}"',
            more='<type s="0" type="motorway"/>',
        )
    )
    return Road(load_map(MapSource(f"motorway-{hand}.xodr", text.encode())), ((900.0, 0.0),))


def change(hand: str, period: float, *, ahead_m: float, faster_mps: float = 0.0) -> list[Row]:
    """Judge a change from the outer to the middle lane at 25 m/s beside a vehicle whose centre is so far ahead as it begins."""
    way = motorway(hand)
    side = 1 if hand == "lht" else -1
    t = times(16.0, period=period)
    ego = moving("ego", way, t, 100 + 25 * t, side * LANE * (2.5 - ease((t - 6) / 4.0)))
    other = moving("other", way, t, 100 + ahead_m + 25 * t + faster_mps * (t - 6), side * LANE * 1.5)
    return verdict_rows([drive([ego, other], way.environment)], rules=[SAFE])


def verdict(rows: list[Row]) -> str:
    (row,) = rows
    return str(row["verdict"])


@HANDS
@pytest.mark.parametrize("period", PERIODS)
@pytest.mark.parametrize("ahead_m", [-3.0, 0.0, 1.0, 3.0, 4.5])
def test_into_a_vehicle_beside(hand: str, period: float, ahead_m: float) -> None:
    assert verdict(change(hand, period, ahead_m=ahead_m)) == "fail"


@HANDS
@pytest.mark.parametrize("period", PERIODS)
@pytest.mark.parametrize(("ahead_m", "faster_mps"), [(-3.0, 2.0), (-7.5, 6.0), (2.0, 1.0), (-15.0, 12.0)])
def test_one_that_draws_ahead_meanwhile(hand: str, period: float, ahead_m: float, faster_mps: float) -> None:
    every = [verdict(change(hand, p, ahead_m=ahead_m, faster_mps=faster_mps)) for p in (0.05, period)]
    assert every[0] == "fail"
    assert every[1] in {"fail", "unknown"}


@HANDS
@pytest.mark.parametrize("period", PERIODS)
def test_behind_one_that_has_passed_is_no_danger(hand: str, period: float) -> None:
    """It is just ahead as the ego comes over the line, or still beside the ego's front: before the centre is over, it is clear."""
    assert verdict(change(hand, period, ahead_m=12.0, faster_mps=5.0)) == "not_applicable"
    assert verdict(change(hand, period, ahead_m=-8.0, faster_mps=10.0)) != "fail"


@HANDS
@pytest.mark.parametrize("period", PERIODS)
def test_far_behind_or_ahead_at_every_rate(hand: str, period: float) -> None:
    assert verdict(change(hand, period, ahead_m=-60.0)) == "pass"
    assert verdict(change(hand, period, ahead_m=30.0)) == "not_applicable"
