"""A vehicle without a position between two sightings stays near the straight line between them, whatever its velocities."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tests.scenes import Actor, Road, derived, drive, moving, road, rows, times

T = times(5.0)


def least(way: Road, lost_actor: Actor) -> dict[float, float]:
    """Return by time how near the other may be while it has no position: the ego stands at s = 100."""
    ego = moving("ego", way, T, np.full(len(T), 100.0), way.ego_d)
    con = derived(drive([ego, lost_actor], way.environment), tables=["hidden"])
    return {row["t_ns"] / 1e9: row["least_m"] for row in rows(con, "FROM hidden WHERE object_id = 'x' ORDER BY t_ns")}


def without_velocity(actor: Actor) -> Actor:
    nothing = np.full(len(actor.t_s), np.nan)
    return Actor(actor.actor_id, actor.t_s, actor.x, actor.y, actor.yaw, nothing, nothing, kind=actor.kind)


@pytest.mark.parametrize("hole_s", [0.5, 2.0, 4.0])
def test_no_vehicle_is_nearer_than_the_bound(hole_s: float) -> None:
    """It swings towards the ego as hard as it can, and back, just while it has no position."""
    way = road()
    middle = 2.5
    u = np.clip((T - middle + hole_s / 2) / hole_s, 0, 1)
    # half of the time towards the line's other side at 10 m/s2, half back: at rest on the line at both ends
    held = np.minimum(u, 1 - u)
    aside = 5 * (hole_s * held) ** 2
    other = without_velocity(moving("x", way, T, np.full(len(T), 130.0), way.ego_d + 30 - aside, kind="car"))
    found = least(way, other.without_position((u > 0) & (u < 1)))
    for t, bound in found.items():
        k = round(t * 10)
        apart = math.hypot(other.x[k] - 100, other.y[k] - way.ego_d)
        assert bound <= apart - math.hypot(4.8, 1.8) + 1e-6 or bound == 0
