"""Who is beside the ego, how far apart; who passes whom; who is there and has no place."""

from __future__ import annotations

import math

import numpy as np
import pytest
from shapely import affinity
from shapely.geometry import Polygon, box

from tests.scenes import Actor, Road, derived, drive, moving, road, rows, seconds, standing, swing, times

HANDS = pytest.mark.parametrize("hand", ["rht", "lht"])


def outline(actor: Actor, k: int) -> Polygon:
    assert actor.length
    assert actor.width
    upright = box(-actor.length / 2, -actor.width / 2, actor.length / 2, actor.width / 2)
    return affinity.translate(
        affinity.rotate(upright, actor.yaw[k], origin=(0, 0), use_radians=True), actor.x[k], actor.y[k]
    )


@pytest.mark.parametrize("curvature", [0.0, 1 / 90, -1 / 90])
def test_gaps_and_clearances_are_those_of_the_boxes(curvature: float) -> None:
    """A weaving car beside a weaving ego: across the lane as on a straight road, box to box as shapely says."""
    way = road(((500.0, curvature),))
    t = times(20.0)
    ego = moving("ego", way, t, 60 + 10 * t, way.ego_d + 0.3 * np.sin(t))
    other = moving("x", way, t, 52 + 10.8 * t, way.ego_d + 2.9 + 0.2 * np.cos(t))
    con = derived(drive([ego, other], way.environment), tables=["beside"])
    found = {row["t_ns"]: row for row in rows(con, "FROM beside")}
    assert 80 < len(found) < 130
    for k, at in enumerate(t):
        row = found.get(round(at * 1e9))
        # stations grow faster outside of a bend: along the lane's own centre line
        stretch = 1 - way.ego_d * curvature
        ahead = (0.8 * at - 8) * stretch
        if abs(ahead) < 4.6:
            assert row is not None
            assert row["clearance_m"] == pytest.approx(outline(ego, k).distance(outline(other, k)), abs=1e-6)
            assert row["ahead_m"] == pytest.approx(ahead, abs=0.25)
            assert row["side"] == "left"
            assert (row["along"], row["on_carriageway"], row["actor_class"]) == (True, True, "car")
            if not curvature:
                halves = [0.9 * abs(math.cos(a.yaw[k])) + 2.4 * abs(math.sin(a.yaw[k])) for a in (ego, other)]
                apart = 2.9 + 0.2 * math.cos(at) - 0.3 * math.sin(at)
                assert row["gap_m"] == pytest.approx(apart - sum(halves), abs=1e-6)
                assert row["ego_lat_mps"] == pytest.approx(ego.vy[k], abs=1e-6)
                assert row["lat_mps"] == pytest.approx(-other.vy[k], abs=1e-6)
        elif abs(ahead) > 5.2:
            assert row is None


# ---- passing


def passings(way: Road, *actors: Actor) -> list[dict[str, object]]:
    con = derived(drive(actors, way.environment), tables=["passing"])
    return rows(con, "FROM passing ORDER BY ego_id, occurrence")


@HANDS
def test_the_ego_passes_a_parked_car_round_the_overtaking_side(hand: str) -> None:
    way = road(hand=hand)
    t = times(20.0)
    s = 50 + 12 * t
    ego = moving("ego", way, t, s, swing(way, s, 150, 230))
    parked = standing("x", way, t, 200, way.ego_d)
    (found,) = passings(way, ego, parked)
    assert found["side"] == ("right" if hand == "rht" else "left")
    assert (found["ego_passes"], found["same_lane"], found["whole"]) == (True, True, True)
    assert found["t_ns"] == 12_600_000_000  # 201.2 m, 1.2 m past; at 200.0 m the fronts are level
    assert seconds([found], "t_from_ns")[0] == pytest.approx((195.2 - 50) / 12, abs=0.1)
    assert seconds([found], "t_to_ns")[0] == pytest.approx((204.8 - 50) / 12, abs=0.1)
    assert found["gap_m"] == pytest.approx(3.5 - 1.8, abs=1e-6)
    assert (found["ego_speed_mps"], found["speed_mps"]) == pytest.approx((12.0, 0.0))
