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


def ids(found: dict[float, Row]) -> set[str | None]:
    return {row["object_id"] for row in found.values()}


def aside(way: Road, t: Floats, begin: float, lasts: float, share: float = 1.0) -> Floats:
    """Return the offsets of an ego that moves by `share` metres to the middle of the road from `begin` on."""
    towards = -np.sign(way.own)
    u = np.clip((t - begin) / lasts, 0.0, 1.0)
    d: Floats = way.own + towards * share * u * u * (3 - 2 * u)
    return d


def parked(way: Road, t: Floats, s: float = 200.0, reaches_in: float = 1.1) -> Actor:
    """Return a car at the kerb that reaches into the ego's lane, and 0.25 m into the way of an ego in its middle."""
    return standing("p", way, t, s, np.sign(way.own) * (LANE + 0.9 - reaches_in))


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
def test_met_by_less_than_sensors_tell_it_is_the_lead_only_perhaps(hand: str) -> None:
    """The ego stops behind a car at the kerb that reaches 0.15 m into its way, or 0.75 m."""
    way = road(hand=hand)
    t = times(8.0)
    ego = moving("ego", way, t, 150 + 10 * t - np.clip(t - 1, 0, 6) ** 2 / 1.2 - 10 * np.clip(t - 7, 0, None), way.own)
    for reaches_in, sensor_range_m, lead in ((1.0, 80.0, None), (1.0, None, "p"), (1.6, 80.0, "p")):
        found = leads(way, ego, parked(way, t, reaches_in=reaches_in), sensor_range_m=sensor_range_m)
        near = [found.get(round(at, 1)) for at in np.arange(3.0, 6.5, 0.1)]
        assert {row["object_id"] if row else None for row in near} == {lead}


@HANDS
@pytest.mark.parametrize("with_map", [True, False])
def test_stopped_in_the_lane_it_is_the_lead_braked_for_or_swerved_round(hand: str, with_map: bool) -> None:
    way = road(hand=hand)
    t = times(14.0)
    stopped = standing("x", way, t, 200, way.own)
    s = 100 + np.where(t < 6, 10 * t, 60 + 10 * (np.clip(t, 6, 12) - 6) - (np.clip(t, 6, 12) - 6) ** 2 / 1.2)
    found = leads(way if with_map else None, moving("ego", way, t, s, way.own), stopped)
    assert ids(found) == {"x"}
    assert len(found) == len(t)
    # 1.2 s before it is level the ego begins to steer, by 2.2 m in 1 s
    swerves = moving("ego", way, t, 100 + 10 * t, aside(way, t, 8.3, 1.0, 2.2))
    found = leads(way if with_map else None, swerves, stopped)
    near = {at: found.get(at) for at in (7.9, 8.0, 8.1, 8.2)}
    assert {row["object_id"] if row else "unknown" for row in near.values()} == {"x" if with_map else "unknown"}


@HANDS
@pytest.mark.parametrize("with_map", [True, False])
@pytest.mark.parametrize("hurry", [False, True])
def test_overtaken_against_the_oncoming_traffic_it_is_ahead_until_the_ego_pulls_out(
    hand: str, with_map: bool, hurry: bool
) -> None:
    """A delivery van in the middle of the lane: the ego goes round it over the middle of the road, in 3 s, or within 1.2 s of it."""
    way = road(hand=hand)
    t = times(14.0)
    stopped = standing("x", way, t, 200, way.own)
    begin, lasts = (8.3, 1.0) if hurry else (5.5, 3.0)
    found = leads(
        way if with_map else None, moving("ego", way, t, 100 + 10 * t, aside(way, t, begin, lasts, 2.8)), stopped
    )
    assert ("x" in ids(found)) == with_map


@HANDS
@pytest.mark.parametrize("with_map", [True, False])
def test_a_queue_is_followed_until_the_end_of_the_log(hand: str, with_map: bool) -> None:
    """The ego drives on and stops 3 m behind the car that it follows: its own way ends there, and the car is beyond that end."""
    way = road(hand=hand)
    t = times(14.0)
    s = 100 + np.where(t < 8, 8 * t, 64 + 8 * (np.clip(t, 8, 12) - 8) - (np.clip(t, 8, 12) - 8) ** 2)
    ego, first = moving("ego", way, t, s, way.own), moving("x", way, t, s + 7.8, way.own)
    second = moving("y", way, t, s + 15.6, way.own)
    found = leads(way if with_map else None, ego, first, second)
    assert ids(found) == {"x"}
    assert len(found) == len(t)
    assert [row["gap_m"] for row in found.values()] == pytest.approx([3.0] * len(t), abs=0.05)


@HANDS
@pytest.mark.parametrize(("width", "lead"), [(2.5, None), (0.8, "b")])
def test_one_beside_that_has_no_room_in_the_lane_is_in_another_lane(hand: str, width: float, lead: str | None) -> None:
    """In a bend the map's lanes lie 1.2 m off: the bus of the next lane has its centre in the ego's. A motorcycle there has room."""
    way = road(hand=hand, pieces=((400.0, 0.01),))
    t = times(8.0)
    side = np.sign(way.own)
    ego = moving("ego", way, t, 20 + 8 * t, way.own - side * 0.8)
    other = moving("b", way, t, 32 + 8 * t, way.own + side * 1.74, width=width, length=10.0 if width > 2 else 2.2)
    found = leads(way, ego, other)
    # in the last seconds the ego's own way does not show how it went on
    assert {row["object_id"] for at, row in found.items() if at < 5} == {lead}


# ---- without a map


@HANDS
def test_in_a_bend_the_lead_is_found_by_the_way_and_who_stands_straight_on_is_not(hand: str) -> None:
    way = road(hand=hand, pieces=((60.0, 0.0), (60.0, 1 / 40), (200.0, 0.0)))
    t = times(14.0)
    s = 10 + 8 * t
    ego, x = moving("ego", way, t, s, way.own), moving("x", way, t, s + 20, way.own)
    straight_on = standing("p", way, t, 60.0, way.own)
    straight_on = replace(straight_on, x=straight_on.x + 35.0)
    found = leads(None, ego, x, straight_on)
    # s is along the road's middle, and the lane is longer or shorter than that
    assert {row["object_id"] for row in found.values()} == {"x"}
    assert [row["gap_m"] for at, row in found.items() if at < 10] == pytest.approx([15.2] * 100, abs=1.0)


@pytest.mark.ci
def test_beyond_the_end_of_the_own_way_who_is_far_is_unknown_and_who_is_near_is_the_lead() -> None:
    way = road()
    t = times(5.0)
    ego = standing("ego", way, t, 100, way.own)
    assert ids(leads(None, ego, standing("x", way, t, 110, way.own))) == {"x"}
    assert not leads(None, ego, standing("x", way, t, 150, way.own))
    assert ids(leads(None, ego, standing("x", way, t, 60, way.own))) == {None}


@pytest.mark.ci
def test_without_a_heading_or_backwards_nothing_is_ahead() -> None:
    way = road()
    t = times(5.0)
    ego = moving("ego", way, t, 100 + 5 * t, way.own)
    x = moving("x", way, t, 120 + 5 * t, way.own)
    assert ids(leads(None, ego, x)) == {"x"}
    assert not leads(None, replace(ego, yaw=np.full(t.shape, np.nan)), x)
    assert not leads(None, replace(ego, yaw=ego.yaw + np.pi), x)


def test_crossing_traffic_is_not_followed() -> None:
    """It crosses the ego's way at a right angle, 20 m ahead."""
    way = road()
    t = times(6.0)
    ego = moving("ego", way, t, 100 + 8 * t, way.own)
    x, y, _ = way.at(np.full(t.shape, 140.0), -20 + 10 * t)
    crossing = Actor("x", t, x, y, np.full(t.shape, np.pi / 2), 0 * t, np.full(t.shape, 10.0))
    assert ids(leads(None, ego, crossing)) == {None}


def test_a_hole_in_the_log_ends_the_way() -> None:
    """The ego is not recorded from 3 to 6 s: before the hole, who is beyond it by more than the bend may change is unknown."""
    way = road()
    t = times(10.0)
    seen = (t < 3.0) | (t > 6.0)
    ego = moving("ego", way, t, 100 + 10 * t, way.own).keep(seen)
    x = moving("x", way, t, 145 + 10 * t, way.own)
    found = leads(None, ego, x)
    assert 0.0 not in found or found[0.0]["object_id"] == "x"
    assert all(at not in found for at in (2.8, 2.9))
    assert found[6.5]["object_id"] == "x"


@pytest.mark.parametrize("jitter", [0.0, 0.05])
def test_an_ego_that_stands_makes_no_way_by_jitter(jitter: float) -> None:
    way = road()
    t = times(20.0)
    rng = np.random.default_rng(1)
    ego = moving("ego", way, t, 100 + 8 * np.clip(t - 15, 0, None), way.own)
    ego = replace(ego, x=ego.x + jitter * rng.standard_normal(len(t)), y=ego.y + jitter * rng.standard_normal(len(t)))
    con = derived(drive([ego], None), tables=["_own_way"])
    (driven,) = {round(row["driven_m"]) for row in rows(con, "FROM _own_way")}
    assert driven == pytest.approx(40, abs=1)


@HANDS
def test_a_motorcycle_that_a_car_draws_past_follows_it_only_perhaps(hand: str) -> None:
    """Both fit into the lane; the way of the motorcycle, on the line, meets the car by 0.1 m, and so do its places."""
    way = road(hand=hand)
    t = times(6.0)
    out = np.sign(way.own) * (LANE / 2 + way.own * np.sign(way.own) - LANE / 2)
    ego = moving("ego", way, t, 100 + 10 * t, out - np.sign(way.own) * 0.9, length=2.1, width=0.8)
    car = moving("x", way, t, 110 + 12 * t, out + np.sign(way.own) * 0.3, length=4.5, width=1.8)
    assert ids(leads(way, ego, car)) == {"x"}
    assert "x" not in ids(leads(way, ego, car, sensor_range_m=80.0))
