"""Whom the ego follows: who is ahead in its lane and neither met, overtaken, beside it nor passed at the lane's edge."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from tests.scenes import derived, drive, moving, road, rows, swing, times

if TYPE_CHECKING:
    from tests.scenes import Actor, Road, Row

HANDS = pytest.mark.parametrize("hand", ["rht", "lht"])


def following(way: Road, *actors: Actor) -> list[Row]:
    con = derived(drive(list(actors), way.environment), tables=["following"])
    found = rows(con, "FROM following ORDER BY t_ns")
    assert len(found) == len(actors[0].t_s)
    return found


@HANDS
def test_an_overtaken_vehicle_is_followed_until_the_ego_pulls_out(hand: str) -> None:
    way = road(hand=hand)
    t = times(14.0)
    s = 60 + 10 * t
    ego = moving("ego", way, t, s, swing(way, s, 100, 160))
    found = following(way, ego, moving("x", way, t, 100 + 4 * t, way.ego_d))
    out = next(k for k, row in enumerate(found) if not row["follows"])
    assert 4.0 < t[out] < 5.5
    assert {row["follows"] for row in found[:out]} == {True}
    assert {row["follows"] for row in found[out:]} == {False}


@HANDS
def test_one_that_drew_up_beside_makes_a_new_gap_when_it_goes_ahead(hand: str) -> None:
    way = road(hand=hand)
    t = times(12.0)
    ego = moving("ego", way, t, 100 + np.clip(t - 9, 0, None), way.ego_d)
    # it comes from behind to beside the standing ego, and goes first
    s = 85 + np.clip(4 * t, 0, 16) + 4 * np.clip(t - 7.0, 0, None)
    found = following(way, ego, moving("x", way, t, s, way.ego_d + 1.6, width=0.6, length=1.8, kind="bicycle"))
    ahead = next(k for k, row in enumerate(found) if row["object_id"] == "x")
    assert t[ahead] == pytest.approx(7.7, abs=0.15)
    assert {row["joined_ns"] for row in found[ahead:]} == {found[ahead]["t_ns"]}


def test_one_that_rides_at_the_edge_hides_neither_the_follower_s_lead_nor_who_comes() -> None:
    """The nearest moves beside the way and is followed; of the others each is there once, with its own motion."""
    way = road()
    t = times(3.0)
    ego = moving("ego", way, t, 100 + 10 * t, way.ego_d)
    rider = moving("x", way, t, 130 + 10 * t, way.ego_d - 1.4, kind="bicycle", width=0.7)
    lead = moving("y", way, t, 170 + 8 * t - t * t / 2, way.ego_d)
    comes = moving("z", way, t, 300 - 10 * t, way.ego_d)
    con = derived(drive([ego, rider, lead, comes], way.environment), tables=["following", "vehicle_ahead"])
    found = rows(con, "FROM vehicle_ahead WHERE t_ns = 2_000_000_000 ORDER BY gap_m")
    assert [(row["object_id"], row["nearest"], row["oncoming"]) for row in found] == [
        ("x", True, False), ("y", False, False), ("z", False, True)
    ]  # fmt: skip
    assert found[1]["accel_mps2"] == pytest.approx(-1.0, abs=0.05)
    assert found[0]["gap_m"] < found[1]["gap_m"] < found[2]["gap_m"]
    assert {(row["object_id"], row["follows"]) for row in rows(con, "FROM following")} == {("x", True)}
