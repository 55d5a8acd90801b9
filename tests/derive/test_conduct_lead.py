"""Since when the nearest vehicle ahead is that, and how it came."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from tests.scenes import LANE, derived, drive, moving, road, rows, swing, times, verdict_rows

HANDS = pytest.mark.parametrize("hand", ["rht", "lht"])


@HANDS
def test_a_lead_that_cut_in_joined_then(hand: str) -> None:
    """From the lane beside into the ego's: turned by 10 degrees, it is 2.6 m across, and in when its centre is 3.0 m from the lane's."""
    way = road(hand=hand, lanes=(0, 2) if hand == "rht" else (2, 0))
    t = times(8.0)
    sign = 1 if hand == "rht" else -1
    slow, fast = -1.5 * LANE * sign, -0.5 * LANE * sign
    ego = moving("ego", way, t, 100 + 10 * t, slow)
    old = moving("old", way, t, 200 + 10 * t, slow)
    other = moving("x", way, t, 130 + 10 * t, fast + (slow - fast) * np.clip((t - 3.0) / 2.0, 0.0, 1.0))
    con = derived(drive([ego, old, other], way.environment), tables=["lead"])
    found = rows(con, "FROM lead ORDER BY t_ns")
    assert len(found) == len(t)
    joins = next(k for k, row in enumerate(found) if row["object_id"] == "x")
    assert t[joins] == pytest.approx(3.3)
    assert [row["object_id"] for row in found] == ["old"] * joins + ["x"] * (len(t) - joins)
    assert {row["joined"] for row in found[:joins]} == {False}  # the log begins there
    assert {row["joined"] for row in found[joins:]} == {True}
    assert {row["t_since_ns"] for row in found[joins:]} == {found[joins]["t_ns"]}
    assert {row["t_since_ns"] for row in found[:joins]} == {0}


@pytest.mark.parametrize("hand", ["right", "left"])
def test_one_that_comes_in_the_lane_in_which_the_ego_overtakes_is_ahead_of_it(hand: str) -> None:
    """Out of its lane the ego has no lead there, and yet one in its way; once back, that one is beside its way."""
    way = road(lanes=(1, 1), hand=hand)
    t = times(12.0)
    s = 50 + 12 * t
    ego = moving("ego", way, t, s, swing(way, s, 70, 150, share=1.0))
    other = moving("x", way, t, 400 - 12 * t, -way.ego_d)
    con = derived(drive([ego, other], way.environment), tables=["lead", "vehicle_ahead"])
    assert {row["object_id"] for row in rows(con, "FROM lead")} == {None}
    ahead = {row["t_ns"]: row for row in rows(con, "FROM vehicle_ahead WHERE object_id = 'x'")}
    for k, at in enumerate(t):
        beside = abs(float(ego.y[k] - other.y[k]))
        if beside < 1.5 or beside > 2.6:
            assert (round(float(at) * 1e9) in ahead) == (beside < 1.5 and ego.x[k] < other.x[k]), at
    assert all(row["oncoming"] and not row["nearest"] for row in ahead.values())
    assert ahead[4_000_000_000]["gap_m"] == pytest.approx(400 - 48 - (50 + 48) - 4.8, abs=0.01)
    assert not rows(con, "FROM vehicle_ahead WHERE NOT known")
    # one that is short and of no known class may be a vehicle: every such step is unknown
    small = replace(other, kind=None, length=2.0)
    con = derived(drive([ego, small], way.environment), tables=["_lane_ahead", "vehicle_ahead"])
    near = {row["t_ns"] for row in rows(con, "FROM _lane_ahead WHERE gap_m < lead_reach_m(12.0)")}
    unknown = {row["t_ns"] for row in rows(con, "FROM vehicle_ahead WHERE NOT known")}
    assert near
    assert near == unknown
    assert not rows(con, "FROM vehicle_ahead WHERE object_id = 'x'")


@pytest.mark.parametrize("turned", [math.pi / 2, math.pi / 3, -2.0])
def test_the_speed_of_one_ahead_is_that_along_the_lane(turned: float) -> None:
    """A bus slides over the lane ahead at 18 m/s, turned so: away from the ego it goes with the cosine of that."""
    way = road()
    t = times(8.0)
    ego = moving("ego", way, t, 100 + 18 * t, way.ego_d)
    s, d = 190 + 18 * math.cos(turned) * (t - 4), way.ego_d + 18 * math.sin(turned) * (t - 4)
    bus = replace(moving("bus", way, t, s, d, length=11.0, width=2.5), yaw=np.full(len(t), turned))
    found = rows(
        derived(drive([ego, bus], way.environment), tables=["vehicle_ahead"]),
        "FROM vehicle_ahead WHERE object_id = 'bus'",
    )
    assert found
    for row in found:
        assert row["speed_mps"] == pytest.approx(18 * abs(math.cos(turned)), abs=0.02)
        assert row["oncoming"] == (abs(turned) > math.pi / 2)
        if row["accel_mps2"] is not None:
            assert row["accel_mps2"] == pytest.approx(0, abs=0.1)
    if turned == math.pi / 2:
        worst = [
            r
            for r in verdict_rows([drive([ego, bus], way.environment)], rules=["criticality.ttc"])
            if r["object_id"] == "bus"
        ]
        assert "pass" not in {row["verdict"] for row in worst}
