"""Who comes towards the ego, from where, and how far that nobody does can be told."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tests.scenes import LANE, derived, drive, moving, rows, tee, times


@pytest.mark.parametrize("hand", ["rht", "lht"])
def test_one_that_turns_in_from_a_side_road_counts_at_the_way_it_makes(hand: str) -> None:
    """It comes up road 3 and turns towards the ego: from 15 s before it is on the corridor, its own way counts."""
    ways = tee(hand)
    straight, home = ways["straight"], ways["home"]
    t = times(24.0)
    ego = moving("ego", straight, t, 20 + 3 * t, straight.ego_d)
    offset = -LANE / 2 if hand == "rht" else LANE / 2
    ov = moving("ov", home, t, 20 + 8 * t, offset)
    con = derived(drive([ego, ov], straight.environment), tables=["oncoming"])
    found = rows(con, "FROM oncoming ORDER BY t_ns")
    placed = [k for k, row in enumerate(found) if row["object_id"] and not row["on_its_way"]]
    on_its_way = [k for k, row in enumerate(found) if row["on_its_way"]]
    assert placed
    assert on_its_way == list(range(max(0, placed[0] - 150), placed[0]))
    speed = np.hypot(ov.vx, ov.vy)
    for k in on_its_way:
        went = np.hypot(np.diff(ov.x[k : placed[0] + 1]), np.diff(ov.y[k : placed[0] + 1])).sum()
        moved = ego.x[placed[0]] - ego.x[k]
        assert found[k]["da_m"] == pytest.approx(found[placed[0]]["da_m"] + moved + went, abs=1e-6)
        assert found[k]["speed_mps"] == pytest.approx(speed[k])
    # it meets the corridor in the turn, heading at least 120 degrees against it
    turned = abs(math.remainder(ov.yaw[placed[0]] - ego.yaw[placed[0]], 2 * math.pi))
    assert 2 * math.pi / 3 < turned < 2 * math.pi / 3 + 0.15
