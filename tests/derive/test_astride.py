"""On a line for long, and over it round somebody: what a lane change, an overtake and a slow cyclist excuse."""

from __future__ import annotations

import numpy as np
import pytest

from tests.derive.marked import ease, marked, offsets, tables
from tests.scenes import LANE, Actor, Road, drive, judged, moving, rows, standing, times

HANDS = pytest.mark.parametrize("hand", ["rht", "lht"])
KEEP = "ukhc.r131.keep-in-lane"
SOLID = "ukhc.r129.no-cross-solid"


def verdict(rule: str, way: Road, *actors: Actor, in_sight: bool = False) -> str:
    (row,) = judged([drive(actors, way.environment, in_sight=in_sight)], rules=[rule])
    return str(row["verdict"])


# ---- astride a lane line


def astride(way: Road, by: float, begin: float, end: float, *, to: float = 1.5, last: float = 30.0) -> Actor:
    """Return an ego at 15 m/s that goes from the outer lane onto its line, `by` metres beyond it, and from there to the lane `to`."""
    t = times(last)
    sign = np.sign(way.own)
    on, off = ease((t - begin) / 2), ease((t - end) / 2)
    line = LANE - by
    d = sign * (LANE * 1.5 + (line - LANE * 1.5) * on + (LANE * to - line) * off)
    return moving("ego", way, t, 50 + 15 * t, d)


@pytest.mark.ci
@HANDS
@pytest.mark.parametrize("by", [-0.5, -0.01, 0.0, 0.01, 0.5])
def test_astride_a_line_for_ten_seconds_wherever_the_centre_is(hand: str, by: float) -> None:
    way = marked(hand, lanes=2)
    ego = astride(way, by, 5.0, 15.0)
    found = rows(tables(way, ego), "FROM line_step WHERE t_astride_ns IS NOT NULL ORDER BY t_ns")
    assert {(row["astride_begin_seen"], row["changes"], row["overtaking"]) for row in found} == {(True, False, False)}
    assert len({row["t_astride_ns"] for row in found}) == 1
    assert found[-1]["t_ns"] - found[0]["t_ns"] >= 9_000_000_000
    assert verdict(KEEP, way, ego) == "fail"
    assert verdict(KEEP, way, astride(way, by, 5.0, 8.0)) == "pass"


@pytest.mark.ci
@HANDS
def test_astride_for_long_before_the_lane_change_is_done(hand: str) -> None:
    way = marked(hand, lanes=2)
    assert verdict(KEEP, way, astride(way, 0.0, 5.0, 18.0, to=0.5)) == "fail"
    # the log ends: it may be a slow lane change still
    assert verdict(KEEP, way, astride(way, 0.2, 11.0, 40.0, last=20.0)) == "unknown"
    assert verdict(KEEP, way, astride(way, -0.2, 11.0, 40.0, last=20.0)) == "fail"
    assert verdict(KEEP, way, astride(way, 0.2, 14.0, 40.0, last=27.0)) == "fail"


@HANDS
@pytest.mark.parametrize("lasts", [3.0, 6.0, 10.0])
@pytest.mark.parametrize("width", [1.8, 2.55])
def test_a_lane_change_may_be_slow(hand: str, lasts: float, width: float) -> None:
    way = marked(hand, lanes=2)
    t = times(25.0)
    ego = moving("ego", way, t, 50 + 15 * t, offsets(way, t, 6.0, lasts), width=width)
    found = rows(tables(way, ego), "FROM line_step WHERE t_astride_ns IS NOT NULL")
    assert {row["changes"] for row in found} == {True}
    assert verdict(KEEP, way, ego) == "pass"


@HANDS
@pytest.mark.parametrize("by", [-0.3, 0.3])
def test_astride_the_middle_of_the_road(hand: str, by: float) -> None:
    """Wholly beyond it is the business of other rules; on the way there and back it changes lanes twice."""
    way = marked(hand, "broken")
    t = times(30.0)
    s = 50 + 15 * t
    sign = np.sign(way.own)
    on = ease((t - 5) / 2) * (1 - ease((t - 17) / 2))
    assert verdict(KEEP, way, moving("ego", way, t, s, sign * (LANE / 2 - (LANE / 2 + by) * on))) == "fail"
    assert verdict(KEEP, way, moving("ego", way, t, s, sign * (LANE / 2 - LANE * on))) == "pass"


@pytest.mark.ci
@HANDS
def test_astride_is_lawful_as_long_as_somebody_is_overtaken(hand: str) -> None:
    way = marked(hand, "broken")
    t = times(30.0)
    s = 50 + 9 * t
    sign = np.sign(way.own)
    ego = moving("ego", way, t, s, sign * (LANE / 2 - LANE / 2 * ease((t - 4) / 2) * (1 - ease((t - 14) / 2))))
    rider = moving("c", way, t, 105 + 4.8 * t, sign * (LANE - 0.5), kind="bicycle", length=1.8, width=0.6)
    assert verdict(KEEP, way, ego, rider) == "pass"
    assert verdict(KEEP, way, ego) == "fail"
    # on along the line for somebody who was overtaken long ago
    t = times(45.0)
    s = 50 + 12 * t
    ego = moving("ego", way, t, s, sign * (LANE / 2 - LANE / 2 * ease((t - 17) / 2) * (1 - ease((t - 36) / 2))))
    rider = moving("c", way, t, 220 + 3.0 * t, sign * (LANE - 0.5), kind="bicycle", length=1.8, width=0.6)
    assert verdict(KEEP, way, ego, rider) == "fail"


@HANDS
@pytest.mark.parametrize(("until", "expected"), [(14.0, "pass"), (25.0, "fail")])
def test_a_cyclist_is_being_overtaken_for_some_seconds_and_no_longer(hand: str, until: float, expected: str) -> None:
    """Over the line from 4 s on; at 7 m/s more than the cyclist the ego is beside it at 10 s."""
    way = marked(hand, "broken")
    t = times(30.0)
    sign = np.sign(way.own)
    on = ease((t - 4) / 2) * (1 - ease((t - until) / 2))
    ego = moving("ego", way, t, 50 + 12 * t, sign * (LANE / 2 - 0.3 * LANE * on))
    rider = moving("c", way, t, 120 + 5 * t, sign * (LANE - 0.5), kind="bicycle", length=1.8, width=0.6)
    assert verdict(KEEP, way, ego, rider) == expected


@HANDS
def test_the_overtaken_cyclist_excuses_nothing_once_it_has_turned_off(hand: str) -> None:
    """On the line from 16 to 40 s, the cyclist passed at 22 s and gone across the fields from 24 s on."""
    way = marked(hand, "broken")
    t = times(45.0)
    s = 50 + 8 * t
    sign = np.sign(way.own)
    ego = moving("ego", way, t, s, sign * (LANE / 2 - LANE / 2 * ease((t - 16) / 2) * (1 - ease((t - 38) / 2))))
    away = np.clip(t - 24, 0, None)
    rider = moving(
        "c",
        way,
        t,
        160 + 3 * np.minimum(t, 24.0),
        sign * (LANE - 0.5 + 12 * away),
        kind="bicycle",
        length=1.8,
        width=0.6,
    )
    assert verdict(KEEP, way, ego, rider) == "fail"
    assert verdict(KEEP, way, ego, rider.keep(t < 25)) == "unknown"


@HANDS
@pytest.mark.parametrize(("aside", "expected"), [(0.5, "pass"), (-0.4, "fail")])
def test_astride_round_somebody_on_foot_in_the_lane(hand: str, aside: float, expected: str) -> None:
    way = marked(hand, "broken")
    t = times(30.0)
    sign = np.sign(way.own)
    ego = moving("ego", way, t, 50 + 9 * t, sign * (LANE / 2 - LANE / 2 * ease((t - 4) / 2) * (1 - ease((t - 12) / 2))))
    walker = moving("w", way, t, 120 + 1.4 * t, sign * (LANE - aside), kind="pedestrian", length=0.5, width=0.5)
    assert verdict(KEEP, way, ego, walker) == expected


# ---- over a solid line round somebody


def over_line(
    way: Road,
    *,
    speed: float = 13.0,
    at: float = 200.0,
    out: float = 20.0,
    back: float = 25.0,
    rider: float | None = 3.6,
) -> list[Actor]:
    """Return an ego that is over the middle of the road from `out` metres before somebody until `back` metres past it.

    `at`: where that is at first. `rider`: its speed, a cyclist at the edge of the lane; 0: a parked car; None: nobody.
    """
    v = rider or 0.0
    t = times(60.0)
    s = 20 + speed * t
    sign = np.sign(way.own)
    ahead = at + v * t - s
    share = ease((out + 15 - ahead) / 15) * (1 - ease((-ahead - back) / 15))
    ego = moving("ego", way, t, s, sign * (LANE / 2 - 1.6 * share))
    if rider is None:
        return [ego]
    if rider:
        return [ego, moving("c", way, t, at + v * t, sign * (LANE - 0.5), kind="bicycle", length=1.8, width=0.6)]
    return [ego, standing("c", way, t, at, float(sign * (LANE - 0.7)))]


@HANDS
@pytest.mark.parametrize("rider", [0.0, 3.6, 4.4])
def test_room_to_pass_a_slow_cyclist_over_a_solid_line_grows_with_speed(hand: str, rider: float) -> None:
    way = marked(hand, "solid solid", length=900.0)
    assert verdict(SOLID, way, *over_line(way, rider=rider, out=45.0, back=40.0)) == "pass"
    assert verdict(SOLID, way, *over_line(way, rider=rider, speed=6.0, at=70.0, out=18.0, back=18.0)) == "pass"


@pytest.mark.ci
@HANDS
def test_over_a_solid_line_for_nobody_or_long_after(hand: str) -> None:
    way = marked(hand, "solid solid", length=900.0)
    assert verdict(SOLID, way, *over_line(way, rider=None)) == "fail"
    assert verdict(SOLID, way, *over_line(way, rider=5.0)) == "fail"  # too fast a cyclist
    assert verdict(SOLID, way, *over_line(way, back=100.0)) == "fail"
    assert verdict(SOLID, way, *over_line(way, out=110.0)) == "fail"
    assert verdict(SOLID, way, *over_line(way, rider=1.0, speed=6.0, at=100.0, out=30.0, back=60.0)) == "fail"


@HANDS
def test_somebody_hidden_so_far_ahead_may_be_the_reason(hand: str) -> None:
    """A parked car that is lost as the ego goes over the line, and does not come back."""
    way = marked(hand, length=900.0)
    ego, parked = over_line(way, rider=0.0, out=60.0, back=10.0)
    seen = parked.keep(parked.t_s < float(ego.t_s[np.abs(ego.x - 130.0).argmin()]))
    assert verdict(SOLID, way, ego, seen) == "unknown"


@pytest.mark.ci
@HANDS
def test_who_went_away_ahead_and_is_out_of_sight_is_no_reason(hand: str) -> None:
    """The lane ahead is in plain view: nobody stands in it. A parked car that is lost meanwhile may have been passed."""
    way = marked(hand, length=1500.0)
    (ego,) = over_line(way, rider=None, speed=6.0, at=100.0)
    left = moving("x", way, ego.t_s, 60 + 8 * ego.t_s, way.own).keep(ego.t_s < 3.05)
    assert verdict(SOLID, way, ego, left, in_sight=True) == "fail"
    assert verdict(SOLID, way, ego, left) == "unknown"
    ego, parked = over_line(way, rider=0.0, out=60.0, back=10.0)
    seen = parked.keep(parked.t_s < float(ego.t_s[np.abs(ego.x - 130.0).argmin()]))
    assert verdict(SOLID, way, ego, seen, in_sight=True) == "unknown"
