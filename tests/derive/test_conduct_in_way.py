"""Who is in the ego's way, whatever he is; and that braking or standing for him is no breach."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tests.scenes import LANE, Actor, Road, derived, drive, judged, moving, road, rows, saying, standing, times

HANDS = pytest.mark.parametrize("hand", ["rht", "lht"])
KINDS = pytest.mark.parametrize("kind", ["pedestrian", "animal", "object", "bicycle", "car", None])


def motorway(hand: str) -> tuple[Road, float]:
    """Return two lanes in one direction, and the middle of the nearside one, whose sign points to the nearside."""
    lanes = (0, 2) if hand == "rht" else (2, 0)
    return road(((2000.0, 0.0),), hand=hand, lanes=lanes, limit_mph=70), -1.5 * LANE * (1 if hand == "rht" else -1)


def braked(way: Road, d: float, *, stays: float = 0.0, light: str | None = None) -> Actor:
    """Return an ego at 25 m/s that brakes with 6 m/s2 from 400 m on to a stand at 452 m, stays, and drives on."""
    t = times(6.0 + 4.2 + max(stays, 0.1) + 6.0)
    v = np.clip(25 - 6 * (t - 6), 0, 25)
    v = np.where(t > 10.2 + stays, np.clip(2 * (t - 10.2 - stays), 0, 25), v)
    s = 250 + np.concatenate([[0.0], np.cumsum((v[1:] + v[:-1]) / 2 * np.diff(t))])
    ego = moving("ego", way, t, s, d)
    _, _, heading = way.at(s, np.full(t.shape, d))
    lights = (light,) * len(t) if light else ()
    return replace(ego, yaw=heading, vx=v * np.cos(heading), vy=v * np.sin(heading), indicator=lights)


def verdicts(scene: Any, rule: str) -> set[str]:
    return {row["verdict"] for row in judged([saying(scene, road_type="motorway")], rules=[rule])}


def small(actor: Actor, kind: str | None) -> Actor:
    return replace(actor, length=0.6, width=0.6, kind=kind)


@HANDS
@KINDS
def test_braking_and_stopping_for_somebody_in_the_lane_is_no_breach(hand: str, kind: str | None) -> None:
    way, d = motorway(hand)
    ego = braked(way, d, stays=8.0)
    other = small(standing("x", way, ego.t_s, 460.0, d), kind)
    found = judged(
        [saying(drive([ego, other], way.environment), road_type="motorway")],
        rules=["stvo.rg2", "stvo.ri1", "ukhc.r240.no-stopping"],
    )
    assert not [row for row in found if row["verdict"] == "fail"]
    decided = [row["rule_id"] for row in found if row["verdict"] == "unknown"]
    assert decided == []


@pytest.mark.ci
@HANDS
def test_without_anybody_the_same_braking_and_stopping_is_one(hand: str) -> None:
    way, d = motorway(hand)
    ego = braked(way, d, stays=8.0)
    for rule in ("stvo.rg2", "stvo.ri1", "ukhc.r240.no-stopping"):
        assert "fail" in verdicts(drive([ego], way.environment), rule), rule
        # nor is somebody a reason who walks beside the other lane, or stands far behind
        far = small(standing("x", way, ego.t_s, 455.0, d + 2.5 * LANE * math.copysign(1, -d)), "pedestrian")
        assert "fail" in verdicts(drive([ego, far], way.environment), rule), rule


@pytest.mark.sample(0, ci=2)
@HANDS
@pytest.mark.parametrize(("kind", "rule"), [("animal", "stvo.rg2"), ("pedestrian", "stvo.rg2"), (None, "stvo.rg2")])
def test_who_runs_across_is_a_reason_by_his_velocity_not_by_his_heading(hand: str, kind: str | None, rule: str) -> None:
    """It comes from 12 m beside the lane at 4 m/s, turned along the road, and is over it when the ego is there."""
    way, d = motorway(hand)
    ego = braked(way, d)
    t, side = ego.t_s, math.copysign(1, d)
    runs = small(moving("x", way, t, 460.0, d + side * (12 - 4 * (t - 5.0)), kind=kind), kind)
    _, _, heading = way.at(np.full(t.shape, 460.0), np.full(t.shape, d))
    for actor in (runs, replace(runs, yaw=heading), replace(runs, yaw=heading + math.pi)):
        scene = drive([ego, actor], way.environment)
        found = rows(derived(scene, tables=["in_way"]), "FROM in_way WHERE t_ns = 7000000000")
        assert [row["object_id"] for row in found] == ["x"]
        assert found[0]["need_mps2"] > 2.0
        assert "fail" not in verdicts(scene, rule)


@HANDS
@pytest.mark.parametrize("samples", [0, 1, 80])
def test_one_velocity_is_no_proof_that_somebody_comes_across(hand: str, samples: int) -> None:
    """A car in the next lane, ahead and slower; so many of its recorded velocities point into the ego's lane."""
    way, d = motorway(hand)
    ego = braked(way, d)
    car = moving("x", way, ego.t_s, 335 + 15 * ego.t_s, -d / 3)
    k = np.arange(len(ego.t_s))
    across = np.where((k >= 50) & (k < 50 + samples), math.copysign(3.0, d - car.y[0]), 0.0)
    con = derived(drive([ego, replace(car, vy=car.vy + across)], way.environment), tables=["in_way"])
    found = {round(row["t_ns"] / 1e8): row for row in rows(con, "FROM in_way")}
    assert (found[49]["need_mps2"], found[49]["known"]) == (0, True)
    assert found[50]["known"] is (samples == 0)
    assert found[50]["need_mps2"] == 0
    assert (found[55]["need_mps2"] > 0) is (samples == 80)


@HANDS
def test_who_walks_along_beside_the_lane_or_has_no_place_leaves_it_unknown(hand: str) -> None:
    way, d = motorway(hand)
    ego = braked(way, d)
    side = math.copysign(1, d)
    beside = small(standing("x", way, ego.t_s, 460.0, d + side * (LANE / 2 + 0.9)), "pedestrian")
    assert verdicts(drive([ego, beside], way.environment), "stvo.rg2") == {"unknown"}
    placed = small(standing("x", way, ego.t_s, 460.0, d), None)
    found = verdicts(drive([ego, placed.lost(ego.t_s > 5.0)], way.environment), "stvo.rg2")
    assert "unknown" in found
    assert "fail" not in found


@HANDS
def test_the_reason_lasts_a_little_longer_than_he_does(hand: str) -> None:
    """The animal has leapt over the lane; the ego brakes for another second, which is no breach; for six seconds it is one."""
    way, d = motorway(hand)
    ego = braked(way, d)
    t, side = ego.t_s, math.copysign(1, d)
    leaps = small(moving("x", way, t, 460.0, d + side * np.clip(12 - 4 * (t - 5.0), -14, 12)), "animal")
    assert "fail" not in verdicts(drive([ego, leaps], way.environment), "stvo.rg2")
    early = small(moving("x", way, t, 460.0, d + side * np.clip(12 - 8 * (t - 1.0), -14, 12)), "animal")
    assert "fail" in verdicts(drive([ego, early], way.environment), "stvo.rg2")


@pytest.mark.ci
@HANDS
def test_a_breakdown_says_so_with_its_hazard_lights(hand: str) -> None:
    way, d = motorway(hand)
    lit, dark = (drive([braked(way, d, stays=8.0, light=light)], way.environment) for light in ("hazard", "off"))
    for rule in ("stvo.ri1", "ukhc.r240.no-stopping"):
        assert "fail" not in verdicts(lit, rule)
        assert "fail" in verdicts(dark, rule)
