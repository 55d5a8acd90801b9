"""Who is in the ego's way, whatever he is; and that braking or standing for him is no breach."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tests.scenes import LANE, Actor, Road, drive, moving, road, saying, standing, times, verdict_rows

HANDS = pytest.mark.parametrize("hand", ["rht", "lht"])
KINDS = pytest.mark.parametrize("kind", ["pedestrian", "animal", "object", "bicycle", "car", None])


def motorway(hand: str) -> tuple[Road, float]:
    """Return two lanes in one direction, and the middle of the nearside one, whose sign points to the nearside."""
    lanes = (0, 2) if hand == "rht" else (2, 0)
    return road(((2000.0, 0.0),), hand=hand, lanes=lanes, limit_mph=70), -1.5 * LANE * (1 if hand == "rht" else -1)


def braked(way: Road, d: float, *, stays: float = 0.0) -> Actor:
    """Return an ego at 25 m/s that brakes with 6 m/s2 from 400 m on to a stand at 452 m, stays, and drives on."""
    t = times(6.0 + 4.2 + max(stays, 0.1) + 6.0)
    v = np.clip(25 - 6 * (t - 6), 0, 25)
    v = np.where(t > 10.2 + stays, np.clip(2 * (t - 10.2 - stays), 0, 25), v)
    s = 250 + np.concatenate([[0.0], np.cumsum((v[1:] + v[:-1]) / 2 * np.diff(t))])
    ego = moving("ego", way, t, s, d)
    _, _, heading = way.at(s, np.full(t.shape, d))
    return replace(ego, yaw=heading, vx=v * np.cos(heading), vy=v * np.sin(heading))


def verdicts(scene: Any, rule: str) -> set[str]:
    return {row["verdict"] for row in verdict_rows([saying(scene, road_type="motorway")], rules=[rule])}


def small(actor: Actor, kind: str | None) -> Actor:
    return replace(actor, length=0.6, width=0.6, kind=kind)


@HANDS
@KINDS
def test_braking_and_stopping_for_somebody_in_the_lane_is_no_breach(hand: str, kind: str | None) -> None:
    way, d = motorway(hand)
    ego = braked(way, d, stays=8.0)
    other = small(standing("x", way, ego.t_s, 460.0, d), kind)
    found = verdict_rows(
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
