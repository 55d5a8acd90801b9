"""Actors that leave or enter the log near enough to matter: for how long, and how near they may be."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from tests.scenes import LANE, derived, drive, judged, moving, road, rows, standing, swing, tee, times

if TYPE_CHECKING:
    from tests.scenes import Actor, Floats, Road

FOLLOWING = ("criticality.ttc", "criticality.thw", "ukhc.r126.thinking-gap")


@pytest.mark.sample(0, ci=2)
@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize("gap", [52.0, 99.0])
def test_a_braking_lead_that_is_lost_is_not_nobody(hand: str, gap: float) -> None:
    """31 m/s; the lead brakes with 6 m/s2 from 5 s on and is lost at 5.5 s."""
    way = road(((3000.0, 0.0),), hand=hand)
    t = times(25.0)
    ego = moving("ego", way, t, 100 + 31 * t, way.own)
    s = 100 + 4.8 + gap + 31 * t - 3 * np.clip(t - 5, 0, None) ** 2
    lead = moving("x", way, t, s, way.own).keep(t < 5.55)
    scene = drive([ego, lead], way.environment)
    found = {round(r["t_ns"] / 1e8) for r in rows(derived(scene, tables=["lead"]), "FROM lead WHERE t_ns > 5.6e9")}
    # the brakes of the lost one may be harder than those of the ego, which has not got so far yet
    assert not found & set(range(100, 250))
    for rule in FOLLOWING:
        verdicts = {r["verdict"] for r in judged([scene], rules=[rule]) if r["t_end_ns"] > 15e9}
        assert "unknown" in verdicts, rule


def test_just_after_it_was_lost_a_lead_far_away_is_still_far() -> None:
    """99 m ahead at 31 m/s: half a second later it has got 1.25 m nearer at the most."""
    way = road(((3000.0, 0.0),))
    t = times(10.0)
    ego = moving("ego", way, t, 100 + 31 * t, way.own)
    lead = moving("x", way, t, 203.8 + 31 * t, way.own).keep(t < 5.05)
    con = derived(drive([ego, lead], way.environment), tables=["hidden", "_unseen", "unplaced"])
    hidden = {round(r["t_ns"] / 1e8): r for r in rows(con, "FROM hidden")}
    assert hidden[55]["least_m"] == pytest.approx(99.0 - 5 * 0.25, abs=1e-3)
    assert hidden[55]["ahead"] is True
    # it goes the ego's way, too far away to be anything but a lead
    assert {(r["code"], r["near"]) for r in rows(con, "FROM _unseen")} == {("lost", False)}
    assert not rows(con, "FROM unplaced")


def test_one_that_leaves_over_the_end_of_the_map_is_beyond_it() -> None:
    way = road(((500.0, 0.0),))
    t = times(35.0)
    ego = moving("ego", way, t, 50 + 12 * t, way.own)
    lead = moving("x", way, t, 120 + 14 * t, way.own).keep(t < 26.95)
    con = derived(drive([ego, lead], way.environment), tables=["hidden", "ego_state"])
    sql = "FROM hidden h JOIN ego_state e USING (drive_id, ego_id, t_ns) WHERE h.t_ns < 35e9 ORDER BY t_ns"
    found = rows(con, f"SELECT h.least_m, 500 - e.front_s_m AS end_m, h.ahead {sql}")
    assert found
    assert all(r["ahead"] and r["least_m"] >= r["end_m"] - 12 - 1e-6 for r in found if r["end_m"] > 0)


@pytest.mark.ci
@pytest.mark.parametrize("hand", ["rht", "lht"])
def test_a_fast_vehicle_that_appears_behind_just_after_t0_may_have_been_overtaking(hand: str) -> None:
    """The ego pulls out at 11 m/s; a car at 33 m/s is seen first 53 m behind it, 0.3 s later."""
    way = road(((1500.0, 0.0),), hand=hand)
    t = times(30.0)
    s = 300 + 11 * t
    ego = moving("ego", way, t, s, swing(way, s, 390, 480))
    vbp = moving("vbp", way, t, 380 + 6 * t, way.own)
    fast = moving("fast", way, t, 200 + 33 * (t - 5), way.other)
    whole = drive([ego, vbp, fast], way.environment)
    rule = "ukhc.r162.not-being-overtaken"
    (t0,) = {r["t0_ns"] for r in rows(derived(whole, tables=["overtake"]), "FROM overtake")}
    at = t0 / 1e9 + 0.3
    late = moving("fast", way, t, 300 + 11 * at - 4.8 - 53 + 33 * (t - at), way.other).keep(
        (t > at - 0.05) & (t < at + 6)
    )
    (row,) = judged([drive([ego, vbp, late], way.environment)], rules=[rule])
    assert row["verdict"] in {"unknown", "fail"}
    (row,) = judged([drive([ego, vbp], way.environment)], rules=[rule])
    assert row["verdict"] == "pass"


def _entering(hand: str) -> tuple[Road, Floats, Actor]:
    """Return two lanes each way, the times, and an ego that is over the near end of the map at 0.4 s and changes lanes from 4 s to 7 s."""
    way = road(((2000.0, 0.0),), hand=hand, lanes=(2, 2), limit_mph=70)
    t = times(20.0)
    d = way.own + LANE * way.over * -1 * (1 - np.clip((t - 4) / 3, 0, 1))
    return way, t, moving("ego", way, t, 10 + 25 * t, d)


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize("lane", [0, 1])
def test_who_comes_in_behind_was_behind_in_whichever_lane(hand: str, lane: int) -> None:
    """It is over the near end at 9 s and drives with the ego: no step leaves it open whether it was ahead, was passed or comes."""
    way, t, ego = _entering(hand)
    other = moving("x", way, t, 3 + 28 * (t - 9), way.own - lane * LANE * way.over).keep(t > 8.99)
    con = derived(drive([ego, other], way.environment), tables=["hidden", "oncoming", "passing", "lane_change", "lead"])
    hidden = rows(con, "FROM hidden WHERE t_ns > 1e9 ORDER BY t_ns")
    assert len(hidden) > 70
    assert {(row["ahead"], row["along"]) for row in hidden} == {(False, True)}
    # at 5 s the ego's rear is at 132.6 m, and the other over the end 4 s later
    (at5,) = (row for row in hidden if round(row["t_ns"] / 1e8) == 50)
    assert at5["least_m"] > 132.6 + 28**2 / 20 - 12
    assert not rows(con, "FROM passing")
    assert len(rows(con, "FROM lead WHERE t_ns > 1e9")) == len(t) - 11
    (change,) = rows(con, "FROM lane_change")
    assert change["unseen_m"] > 100


def test_who_is_lost_behind_on_the_way_back_is_overtaken_by_nobody() -> None:
    """It was met, and is lost 20 m behind; 4 s later the ego goes over the line and back, round nobody."""
    way = road(((900.0, 0.0),))
    t = times(20.0)
    d = way.own + way.over * LANE * (np.clip((t - 9) / 2, 0, 1) - np.clip((t - 13) / 2, 0, 1))
    ego = moving("ego", way, t, 100 + 12 * t, d)
    other = moving("x", way, t, 150 - 12 * (t - 4.6) + 12 * 4.6, way.other).keep(t < 7.05)
    con = derived(drive([ego, other], way.environment), tables=["overtake", "hidden"])
    assert {row["ahead"] for row in rows(con, "FROM hidden WHERE t_ns > 7.05e9")} == {False}
    assert not rows(con, "FROM overtake")


def test_who_comes_in_on_another_road_was_on_no_lane_of_the_ego() -> None:
    """The ego goes straight on; the other comes in over the end of the side road ahead of it."""
    ways = tee()
    t = times(12.0)
    ego = moving("ego", ways["straight"], t, 60 + 20 * t, ways["straight"].own)
    south = ways["south"]
    end = sum(length for length, _ in south.pieces)
    other = moving("x", south, t, end - 2.6 - 8 * (t - 5.0), south.other).keep(t > 4.99)
    con = derived(drive([ego, other], ways["straight"].environment), tables=["hidden", "_unseen", "ego_state"])
    unseen = rows(con, "FROM _unseen WHERE off_ahead_m IS NOT NULL ORDER BY t_ns")
    assert len(unseen) == 50
    assert {row["ahead_m"] for row in unseen} == {None}
    assert unseen[0]["off_behind_m"] == pytest.approx(60 - 2.4, abs=0.5)
    hidden = rows(con, "FROM hidden h JOIN _unseen u USING (drive_id, ego_id, t_ns, object_id)")
    assert all(row["lane_m"] > row["off_ahead_m"] - 6 for row in hidden)


def test_somebody_unseen_ahead_of_whom_is_seen_far_away_leaves_the_way_free_as_far_as_he_must_be() -> None:
    """80 m ahead one is lost, and another is seen 400 m ahead: at 20 m/s nobody is near enough to follow closely."""
    way = road(((3000.0, 0.0),))
    t = times(7.0)
    ego = moving("ego", way, t, 100 + 20 * t, way.own)
    lost = moving("x", way, t, 184.8 + 20 * t, way.own).keep(t < 5.05)
    far = moving("y", way, t, 504.8 + 20 * t, way.own)
    con = derived(drive([ego, lost, far], way.environment), tables=["vehicle_ahead", "hidden"])
    (row,) = rows(con, "FROM vehicle_ahead WHERE t_ns = 6000000000")
    assert (row["object_id"], row["known"]) == (None, False)
    assert row["free_m"] == pytest.approx(80 - 5, abs=0.5)
    assert row["free_mps"] == pytest.approx(20, abs=0.1)
    verdicts = {
        r["verdict"] for r in judged([drive([ego, lost, far], way.environment)], rules=["ukhc.r126.thinking-gap"])
    }
    assert verdicts == {"pass"}


@pytest.mark.parametrize("hand", ["rht", "lht"])
def test_who_is_first_seen_far_beside_the_lane_was_not_the_lead_a_moment_before(hand: str) -> None:
    """A car stands 8 m beside the lane, 20 m ahead, recorded from 3 s on: 0.5 s before it was not ahead of the vehicle that is seen.

    A second before, it might have come from there at 10 m/s2.
    """
    way = road(hand=hand)
    t = times(6.0)
    ego, seen = moving("ego", way, t, 100 + 10 * t, way.own), moving("x", way, t, 140 + 10 * t, way.own)
    late = standing("p", way, t, 155, way.own + 8.0 * np.sign(way.own)).keep(t > 2.95)
    con = derived(drive([ego, seen, late], way.environment), tables=["lead", "hidden"])
    leads = {round(row["t_ns"] / 1e9, 1): row["object_id"] for row in rows(con, "FROM lead")}
    assert {leads.get(at) for at in (2.5, 2.6, 2.7, 2.8, 2.9, 3.0)} == {"x"}
    beside = {round(row["t_ns"] / 1e9, 1): row["beside_lane"] for row in rows(con, "FROM hidden")}
    assert [beside[at] for at in (1.5, 2.5)] == [False, True]
    assert 1.5 not in leads
