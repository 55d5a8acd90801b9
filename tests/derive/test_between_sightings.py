"""A vehicle without a position between two sightings stays near the straight line between them, whatever its velocities."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tests.scenes import Actor, Road, derived, drive, moving, road, rows, times

T = times(5.0)


def least(way: Road, other: Actor) -> dict[float, float]:
    """Return by time how near the other may be while it has no position: the ego stands at s = 100."""
    ego = moving("ego", way, T, np.full(len(T), 100.0), way.own)
    con = derived(drive([ego, other], way.environment), tables=["hidden"])
    return {row["t_ns"] / 1e9: row["least_m"] for row in rows(con, "FROM hidden WHERE object_id = 'x' ORDER BY t_ns")}


def without_velocity(actor: Actor) -> Actor:
    nothing = np.full(len(actor.t_s), np.nan)
    return Actor(actor.actor_id, actor.t_s, actor.x, actor.y, actor.yaw, nothing, nothing, kind=actor.kind)


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize(("kind", "bounded"), [("car", True), ("vehicle", True), ("pedestrian", False)])
def test_only_a_vehicle_keeps_to_the_line(hand: str, kind: str, bounded: bool) -> None:
    """It moves 35 m beside the road, at 5 m/s, and lacks a position from 1.4 to 3.6 s, as it is beside the ego."""
    way = road(hand=hand)
    other = without_velocity(moving("x", way, T, 87.5 + 5 * T, way.own + 35 * way.over, kind=kind))
    found = least(way, other.lost((other.t_s > 1.45) & (other.t_s < 3.55)))
    distance = 35 - math.hypot(4.8, 1.8)
    assert found[2.5] <= distance
    assert (found[2.5] >= distance - 0.1 - 5 * 1.1 * 1.1 - 1e-6) == bounded


@pytest.mark.parametrize("hole_s", [0.5, 2.0, 4.0])
def test_no_vehicle_is_nearer_than_the_bound(hole_s: float) -> None:
    """It swings towards the ego as hard as it can, and back, just while it has no position."""
    way = road()
    middle = 2.5
    u = np.clip((T - middle + hole_s / 2) / hole_s, 0, 1)
    # half of the time towards the line's other side at 10 m/s2, half back: at rest on the line at both ends
    held = np.minimum(u, 1 - u)
    aside = 5 * (hole_s * held) ** 2
    other = without_velocity(moving("x", way, T, np.full(len(T), 130.0), way.own + 30 - aside, kind="car"))
    found = least(way, other.lost((u > 0) & (u < 1)))
    for t, bound in found.items():
        k = round(t * 10)
        apart = math.hypot(other.x[k] - 100, other.y[k] - way.own)
        assert bound <= apart - math.hypot(4.8, 1.8) + 1e-6 or bound == 0


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize("first", [True, False])
def test_before_and_after_all_sightings_the_line_leads_on(hand: str, first: bool) -> None:
    """It comes straight towards the place beside the ego, or leaves it, and is not seen for the half second nearest to the ego."""
    way = road(hand=hand)
    s = 180 - 20 * np.abs(T - 2.5) if first else 120 + 20 * np.abs(T - 2.5)
    other = without_velocity(moving("x", way, T, s, way.own))
    ego = moving("ego", way, T, np.full(len(T), 100.0), way.own)
    seen = T > 2.45 if first else T < 2.55
    told = drive([ego, other.keep(seen)], way.environment)
    found = {
        row["t_ns"] / 1e9: row["least_m"]
        for row in rows(derived(told, tables=["hidden"]), "FROM hidden WHERE object_id = 'x' ORDER BY t_ns")
    }
    at, line = (2.2, 180 + 20 * 0.3) if first else (2.8, 120 - 20 * 0.3)
    room = 0.1 * (1 + 2 * 0.3 / 0.5) + 5 * 0.3 * 0.8
    assert found[at] == pytest.approx(line - 100 - math.hypot(4.8, 1.8) - room, abs=0.05)
