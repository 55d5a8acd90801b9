"""Whom the ego follows: who is ahead in its lane and neither met, overtaken, beside it nor passed at the lane's edge."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
import pytest

from tests import blinding
from tests.scenes import LANE, derived, drive, moving, road, rows, standing, swing, times

if TYPE_CHECKING:
    from tests.scenes import Actor, Road, Row

HANDS = pytest.mark.parametrize("hand", ["rht", "lht"])


def following(way: Road, *actors: Actor) -> list[Row]:
    con = derived(drive(list(actors), way.environment), tables=["following"])
    found = rows(con, "FROM following ORDER BY t_ns")
    assert len(found) == len(actors[0].t_s)
    return found


@HANDS
def test_behind_a_vehicle_and_behind_nobody(hand: str) -> None:
    way = road(hand=hand)
    t = times(5.0)
    ego = moving("ego", way, t, 100 + 10 * t, way.own)
    found = following(way, ego, moving("x", way, t, 140 + 8 * t, way.own, length=4.8))
    assert {(row["object_id"], row["follows"], row["joined_ns"]) for row in found} == {("x", True, None)}
    assert found[0]["gap_m"] == pytest.approx(40 - 4.8, abs=0.3)
    assert (found[9]["ego_speed_mps"], found[9]["speed_mps"]) == pytest.approx((10, 8))
    assert {(row["object_id"], row["follows"]) for row in following(way, ego)} == {(None, False)}


@HANDS
def test_an_overtaken_vehicle_is_followed_until_the_ego_pulls_out(hand: str) -> None:
    way = road(hand=hand)
    t = times(14.0)
    s = 60 + 10 * t
    ego = moving("ego", way, t, s, swing(way, s, 100, 160))
    found = following(way, ego, moving("x", way, t, 100 + 4 * t, way.own))
    out = next(k for k, row in enumerate(found) if not row["follows"])
    assert 4.0 < t[out] < 5.5
    assert {row["follows"] for row in found[:out]} == {True}
    assert {row["follows"] for row in found[out:]} == {False}


@HANDS
def test_oncoming_in_its_lane_is_met_not_followed(hand: str) -> None:
    way = road(hand=hand)
    t = times(4.0)
    ego = moving("ego", way, t, 100 + 10 * t, way.own)
    found = following(way, ego, moving("x", way, t, 300 - 10 * t, way.own))
    assert {row["follows"] for row in found} == {False}


@HANDS
@pytest.mark.parametrize("aside", [1.6, -1.6])
@pytest.mark.parametrize("speed", [5.0, 9.5])
def test_a_cyclist_in_the_lane_is_followed_until_it_is_about_to_be_passed(
    hand: str, aside: float, speed: float
) -> None:
    """The cyclist rides at the lane's edge, 0.4 m beside the ego's way; the ego passes it without leaving its lane."""
    way = road(hand=hand)
    t = times(10.0)
    ego = moving("ego", way, t, 100 + 10 * t, way.own)
    # its length is 1.8 m, so that the ego's front reaches its rear after 5 s
    rides = partial(moving, "x", way, t, d=way.own + aside, width=0.6, length=1.8, kind="bicycle")
    found = following(way, ego, rides(s=100 + 2.4 + 0.9 + 5 * (10 - speed) + speed * t))
    assert {row["follows"] for row in found if row["t_ns"] <= 1_900_000_000} == {True}
    assert {row["follows"] for row in found if row["t_ns"] >= 2_100_000_000} == {False}
    assert {row["object_id"] for row in found if row["t_ns"] >= 5_200_000_000} == {None}, "beside is not ahead"
    kept = following(way, ego, rides(s=106 + 10 * t))
    assert {row["follows"] for row in kept} == {True}, "as fast as the ego it is followed"


@pytest.mark.ci
@HANDS
def test_astride_for_longer_than_a_lane_change_takes_is_following(hand: str) -> None:
    """The ego weaves along the line between two lanes, 8 m behind one that does so too: that is no lane change for ever."""
    way = road(((2000.0, 0.0),), hand=hand, lanes=(0, 2) if hand == "rht" else (2, 0))
    t = times(25.0)
    line = LANE if hand == "lht" else -LANE
    ego = moving("ego", way, t, 100 + 20 * t, line + 0.3 * np.sin(2 * np.pi * t / 5))
    ahead = moving("x", way, t, 112.8 + 20 * t, line + 0.3)
    found = following(way, ego, ahead)
    assert {row["object_id"] for row in found} == {"x"}
    assert {row["follows"] for row in found if row["t_ns"] > 10_500_000_000} == {True}
    # where it is not known on which side one overtakes, it may be an overtake
    unsure = blinding.remade(way.environment, "no side", environment=blinding.guessed)
    con = derived(drive([ego, ahead], unsure), tables=["following"])
    late = rows(con, "FROM following WHERE t_ns > 10_500_000_000")
    assert {row["follows"] for row in late} == {None}


@HANDS
def test_one_beside_hides_nobody_ahead(hand: str) -> None:
    way = road(hand=hand)
    t = times(3.0)
    ego = moving("ego", way, t, 100 + 10 * t, way.own)
    beside = moving("x", way, t, 101 + 10 * t, way.own + 1.6, width=0.6, length=1.8, kind="bicycle")
    lead = moving("y", way, t, 112 + 10 * t, way.own)
    assert {(row["object_id"], row["follows"]) for row in following(way, ego, beside, lead)} == {("y", True)}


@HANDS
def test_one_that_drew_up_beside_makes_a_new_gap_when_it_goes_ahead(hand: str) -> None:
    way = road(hand=hand)
    t = times(12.0)
    ego = moving("ego", way, t, 100 + np.clip(t - 9, 0, None), way.own)
    # it comes from behind to beside the standing ego, and goes first
    s = 85 + np.clip(4 * t, 0, 16) + 4 * np.clip(t - 7.0, 0, None)
    found = following(way, ego, moving("x", way, t, s, way.own + 1.6, width=0.6, length=1.8, kind="bicycle"))
    ahead = next(k for k, row in enumerate(found) if row["object_id"] == "x")
    assert t[ahead] == pytest.approx(7.7, abs=0.15)
    assert {row["joined_ns"] for row in found[ahead:]} == {found[ahead]["t_ns"]}


@HANDS
@pytest.mark.parametrize(("aside", "follows"), [(1.0, True), (-1.0, True), (0.0, True)])
def test_a_car_offset_in_its_lane_is_followed(hand: str, aside: float, follows: bool) -> None:
    way = road(hand=hand)
    t = times(4.0)
    ego = moving("ego", way, t, 100 + 10 * t, way.own)
    found = following(way, ego, moving("x", way, t, 112 + 8 * t, way.own + aside))
    apart = [row for row in found if row["gap_m"] is not None and row["gap_m"] >= 0]
    assert {row["follows"] for row in apart} == {follows}
    met = [row for row in found if row["gap_m"] is not None and row["gap_m"] < 0]
    assert met, "where the boxes overlap they have met"
    assert {(row["object_id"], row["follows"]) for row in met if row["gap_m"] > -4} == {("x", False)}


@HANDS
def test_a_standing_car_is_followed_until_the_ego_swerves_round_it(hand: str) -> None:
    way = road(hand=hand)
    sign = 1 if hand == "rht" else -1
    t = times(6.0)
    parked = standing("x", way, t, 160, way.own)
    s = 100 + 10 * t
    out = np.clip((s - 145) / 10, 0, 1) * 2.2 * sign
    found = following(way, moving("ego", way, t, s, way.own + out), parked)
    # the front is 12.6 m from its rear when it begins to steer; the boxes overlap still
    assert {row["follows"] for row in found if row["t_ns"] <= 4_300_000_000} == {True}
    steers = [row for row in found if 4_700_000_000 <= row["t_ns"] <= 5_200_000_000]
    assert {(row["object_id"], row["follows"]) for row in steers} == {("x", False)}
    straight = following(way, moving("ego", way, t, s, way.own), parked)
    assert {row["follows"] for row in straight if row["t_ns"] <= 5_000_000_000} == {True}


@pytest.mark.parametrize(("across", "seen"), [(0.2, "y"), (0.5, "x"), (-0.5, "y")])
def test_one_that_is_about_to_come_in_the_way_is_ahead_before(across: float, seen: str) -> None:
    """0.65 m beside the ego's way and coming nearer: within three seconds at more than 0.22 m/s."""
    way = road(lanes=(0, 2))
    t = times(0.5)
    ego = moving("ego", way, t, 100 + 10 * t, -1.5 * LANE)
    other = moving("x", way, t, 112 + 10 * t, -1.5 * LANE + 0.9 + 0.65 + 0.9 - across * t)
    lead = moving("y", way, t, 140 + 10 * t, -1.5 * LANE)
    con = derived(drive([ego, other, lead], way.environment), tables=["following", "lead"])
    assert rows(con, "FROM lead ORDER BY t_ns")[0]["object_id"] == seen
    # until it is in the way the ego follows the one beyond it
    assert {(row["object_id"], row["follows"]) for row in rows(con, "FROM following")} == {("y", True)}


@HANDS
@pytest.mark.parametrize("edge", [0.2, -0.2])
def test_one_at_the_lanes_edge_hides_nobody_who_is_in_the_way(hand: str, edge: float) -> None:
    """x stands so far beside the ego's way, y stands in it, and z beyond y at the edge again."""
    way = road(hand=hand)
    t = times(0.5)
    sign = 1 if hand == "rht" else -1
    beside = way.own - sign * (0.9 + 0.35 + edge)
    ego = moving("ego", way, t, 100 + 10 * t, way.own)
    x, z = (standing(name, way, t, s, beside, kind="motorcycle", width=0.7) for name, s in (("x", 120), ("z", 160)))
    y = standing("y", way, t, 140, way.own)
    con = derived(drive([ego, x, y, z], way.environment), tables=["following", "lead", "vehicle_ahead"])
    assert {row["object_id"] for row in rows(con, "FROM lead")} == {"x"}
    told = rows(con, "SELECT DISTINCT object_id, nearest, known FROM vehicle_ahead ORDER BY ALL")
    in_way = "y" if edge > 0 else "x"
    assert [tuple(row.values()) for row in told] == sorted({("x", True, True), (in_way, in_way == "x", True)})
    assert {(row["object_id"], row["follows"]) for row in rows(con, "FROM following")} == {(in_way, True)}


def test_one_that_rides_at_the_edge_hides_neither_the_follower_s_lead_nor_who_comes() -> None:
    """The nearest moves beside the way and is followed; of the others each is there once, with its own motion."""
    way = road()
    t = times(3.0)
    ego = moving("ego", way, t, 100 + 10 * t, way.own)
    rider = moving("x", way, t, 130 + 10 * t, way.own - 1.4, kind="bicycle", width=0.7)
    lead = moving("y", way, t, 170 + 8 * t - t * t / 2, way.own)
    comes = moving("z", way, t, 300 - 10 * t, way.own)
    con = derived(drive([ego, rider, lead, comes], way.environment), tables=["following", "vehicle_ahead"])
    found = rows(con, "FROM vehicle_ahead WHERE t_ns = 2_000_000_000 ORDER BY gap_m")
    assert [(row["object_id"], row["nearest"], row["oncoming"]) for row in found] == [
        ("x", True, False), ("y", False, False), ("z", False, True)
    ]  # fmt: skip
    assert found[1]["accel_mps2"] == pytest.approx(-1.0, abs=0.05)
    assert found[0]["gap_m"] < found[1]["gap_m"] < found[2]["gap_m"]
    assert {(row["object_id"], row["follows"]) for row in rows(con, "FROM following")} == {("x", True)}


@pytest.mark.parametrize(("at", "known"), [(200.0, False), (60.0, True), (400.0, True)])
def test_behind_one_at_the_edge_an_actor_without_a_place_may_be_in_the_way(at: float, known: bool) -> None:
    way = road()
    t = times(0.5)
    ego = moving("ego", way, t, 100 + 10 * t, way.own)
    rider = standing("x", way, t, 130, way.own - 1.4, kind="bicycle", width=0.7)
    lost = standing("u", way, t, at, way.own, turned=math.nan)
    con = derived(drive([ego, rider, lost], way.environment), tables=["following", "vehicle_ahead"])
    assert {row["object_id"] for row in rows(con, "FROM vehicle_ahead WHERE nearest")} == {"x"}
    assert {row["known"] for row in rows(con, "FROM vehicle_ahead WHERE NOT nearest")} == (set() if known else {False})
    assert {row["follows"] for row in rows(con, "FROM following")} == {False if known else None}


@HANDS
def test_the_ego_that_changes_lanes_makes_a_new_gap_itself(hand: str) -> None:
    way = road(hand=hand, lanes=(0, 2) if hand == "rht" else (2, 0))
    t = times(8.0)
    sign = 1 if hand == "rht" else -1
    ego = moving("ego", way, t, 100 + 10 * t, sign * LANE * (np.clip((t - 3.0) / 2.0, 0, 1) - 1.5))
    found = following(way, ego, moving("x", way, t, 130 + 10 * t, -0.5 * LANE * sign))
    joins = next(k for k, row in enumerate(found) if row["object_id"] == "x")
    assert {row["joined_ns"] for row in found[joins:]} == {found[joins]["t_ns"]}
    assert {row["let_in_ns"] for row in found[joins:]} == {None}
    assert found[-1]["follows"] is True


def test_somebody_without_a_place_leaves_it_open() -> None:
    way = road()
    t = times(5.0)
    ego = moving("ego", way, t, 100 + 10 * t, way.own)
    other = moving("x", way, t, 130 + 10 * t, way.own).lost((t > 1.95) & (t < 2.45))
    found = following(way, ego, other)
    open_ = {round(row["t_ns"] / 1e9, 1) for row in found if row["follows"] is None}
    assert open_ == {2.0, 2.1, 2.2, 2.3, 2.4}
    assert {row["object_id"] for row in found if row["follows"] is None} == {None}


@HANDS
@pytest.mark.parametrize(
    ("kind", "aside", "lead_aside", "follows"),
    [
        ("motorcycle", 1.1, 0.0, None),
        ("bicycle", -1.1, 0.0, None),
        ("motorcycle", 0.8, 0.0, True),  # in the wheel track
        ("motorcycle", 1.1, 0.6, True),  # behind the other's width, which is beside the line as well
        ("car", 1.1, 0.0, True),
    ],
)
def test_a_rider_on_the_line_may_ride_between_the_lanes(
    hand: str, kind: str, aside: float, lead_aside: float, follows: bool | None
) -> None:
    """The lane's edge is at 1.75 m, the side of the vehicle ahead at 0.9 m; the rider is 0.8 m wide."""
    way = road(hand=hand)
    t = times(1.0)
    ego = moving("ego", way, t, 100 + 10 * t, way.own + way.over * aside, length=2.1, width=0.8, kind=kind)
    found = following(way, ego, moving("x", way, t, 115 + 10 * t, way.own + way.over * lead_aside))
    assert {(row["object_id"], row["follows"]) for row in found} == {("x", follows)}
