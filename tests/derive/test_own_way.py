"""The lead by the ego's own way: with a map it corrects the lane, without one it is the lane."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest

from tests.scenes import LANE, Actor, derived, drive, moving, road, rows, standing, times

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from tests.scenes import Road, Row

    Floats = NDArray[np.float64]

HANDS = pytest.mark.parametrize("hand", ["rht", "lht"])
KERB = 0.67
"""Clearance of the parked car in these scenes."""


def leads(way: Road | None, *actors: Actor, sensor_range_m: float | None = None) -> dict[float, Row]:
    """Return the rows of `lead` by the time of their step."""
    scene = drive(list(actors), None if way is None else way.environment, sensor_range_m=sensor_range_m)
    con = derived(scene, tables=["lead"])
    return {round(row["t_ns"] / 1e9, 1): row for row in rows(con, "FROM lead")}


def ids(row_by_time: dict[float, Row]) -> set[str | None]:
    return {row["object_id"] for row in row_by_time.values()}


def aside(way: Road, t: Floats, begin: float, lasts: float, share: float = 1.0) -> Floats:
    """Return the offsets of an ego that moves by `share` metres to the middle of the road from `begin` on."""
    towards = -np.sign(way.ego_d)
    u = np.clip((t - begin) / lasts, 0.0, 1.0)
    d: Floats = way.ego_d + towards * share * u * u * (3 - 2 * u)
    return d


def parked(way: Road, t: Floats) -> Actor:
    """Return a car at the kerb that reaches into the ego's lane, and 0.25 m into the way of an ego in its middle."""
    return standing("p", way, t, 200.0, np.sign(way.ego_d) * (LANE + 0.9 - 1.1))


@HANDS
@pytest.mark.parametrize("with_map", [True, False])
def test_parked_at_the_kerb_and_passed_it_is_no_lead_at_any_distance(hand: str, with_map: bool) -> None:
    """The ego moves aside by 0.92 m, 4 s before it is level with the car: it passes at 0.67 m."""
    way = road(hand=hand)
    t = times(12.0)
    ego = moving("ego", way, t, 100 + 10 * t, aside(way, t, 4.0, 2.5, 0.25 + KERB))
    found = leads(way if with_map else None, ego, parked(way, t))
    assert "p" not in ids(found)
    assert len(found) == len(t)


@HANDS
@pytest.mark.parametrize("with_map", [True, False])
def test_swerved_round_at_the_last_moment_it_was_the_lead_or_may_have_been(hand: str, with_map: bool) -> None:
    """The ego begins to steer 1.2 s before it is level: with a map the car was ahead in its lane; without one nobody can tell."""
    way = road(hand=hand)
    t = times(12.0)
    ego = moving("ego", way, t, 100 + 10 * t, aside(way, t, 8.4, 1.0, 0.25 + KERB))
    found = leads(way if with_map else None, ego, parked(way, t))
    near = [found.get(round(at, 1)) for at in np.arange(7.8, 8.4, 0.1)]
    if with_map:
        assert {row["object_id"] for row in near if row} == {"p"}
        assert all(near)
    else:
        assert near == [None] * len(near)


@HANDS
@pytest.mark.parametrize("with_map", [True, False])
def test_a_queue_is_followed_until_the_end_of_the_log(hand: str, with_map: bool) -> None:
    """The ego drives on and stops 3 m behind the car that it follows: its own way ends there, and the car is beyond that end."""
    way = road(hand=hand)
    t = times(14.0)
    s = 100 + np.where(t < 8, 8 * t, 64 + 8 * (np.clip(t, 8, 12) - 8) - (np.clip(t, 8, 12) - 8) ** 2)
    ego, first = moving("ego", way, t, s, way.ego_d), moving("x", way, t, s + 7.8, way.ego_d)
    second = moving("y", way, t, s + 15.6, way.ego_d)
    found = leads(way if with_map else None, ego, first, second)
    assert ids(found) == {"x"}
    assert len(found) == len(t)
    assert [row["gap_m"] for row in found.values()] == pytest.approx([3.0] * len(t), abs=0.05)


# ---- without a map


@HANDS
def test_in_a_bend_the_lead_is_found_by_the_way_and_who_stands_straight_on_is_not(hand: str) -> None:
    way = road(hand=hand, pieces=((60.0, 0.0), (60.0, 1 / 40), (200.0, 0.0)))
    t = times(14.0)
    s = 10 + 8 * t
    ego, x = moving("ego", way, t, s, way.ego_d), moving("x", way, t, s + 20, way.ego_d)
    straight_on = standing("p", way, t, 60.0, way.ego_d)
    straight_on = replace(straight_on, x=straight_on.x + 35.0)
    found = leads(None, ego, x, straight_on)
    # s is along the road's middle, and the lane is longer or shorter than that
    assert {row["object_id"] for row in found.values()} == {"x"}
    assert [row["gap_m"] for at, row in found.items() if at < 10] == pytest.approx([15.2] * 100, abs=1.0)
