"""Lines crossed step by step, and lanes changed, on roads of two lanes each way."""

from __future__ import annotations

import numpy as np
import pytest

from tests.derive.marked import ease, marked, offsets, tables
from tests.scenes import (
    LANE,
    moving,
    rows,
    seconds,
    times,
)

HANDS = pytest.mark.parametrize("hand", ["rht", "lht"])


# ---- line_step


@HANDS
def test_every_step_over_the_centre_line(hand: str) -> None:
    """A wobble over a solid line to one that comes the other way; its furthest corner by hand."""
    way = marked(hand)
    t = times(10.0)
    d = way.ego_d - np.sign(way.ego_d) * 1.2 * ease((t - 3) / 1.5) * (1 - ease((t - 6) / 1.5))
    ego = moving("ego", way, t, 100 + 10 * t, d)
    found = rows(tables(way, ego), "FROM line_step ORDER BY t_ns")
    out = np.abs(d - way.ego_d) + 0.9 * np.cos(ego.yaw) + 2.4 * np.abs(np.sin(ego.yaw)) - LANE / 2
    assert seconds(found, "t_ns") == pytest.approx(list(t[out > 0.05]))
    assert [row["out_m"] for row in found] == pytest.approx(list(out[out > 0.05]), abs=1e-6)
    assert {(r["side"], r["marking"], r["forbidden"], r["beyond"]) for r in found} == {
        ("left" if hand == "rht" else "right", "solid", True, "opposing")
    }
    assert {r["middle"] for r in found} == {True}
    assert {(r["t_since_ns"], r["begin_seen"], r["manoeuvre"]) for r in found} == {(found[0]["t_ns"], True, False)}
    assert {(r["passing_id"], r["passing_known"], r["access"]) for r in found} == {(None, True, False)}


# ---- lane_change


@HANDS
@pytest.mark.parametrize("to", ["in", "out"])
def test_a_lane_change_to_either_side(hand: str, to: str) -> None:
    way = marked(hand, lanes=2)
    t = times(16.0)
    d = offsets(way, t, 6.0) if to == "in" else offsets(way, t, 6.0, start=0.5, to=1.5)
    ego = moving("ego", way, t, 100 + 12 * t, d)
    ahead = moving("ahead", way, t, 160 + 12 * t, offsets(way, t, 99.0, start=0.5 if to == "in" else 1.5))
    behind = moving("behind", way, t, 70 + 13 * t - 1.5 * np.clip(t - 7.5, 0, 1) ** 2, ahead.y)
    same = moving("same", way, t, 130 + 12 * t, offsets(way, t, 99.0, start=1.5 if to == "in" else 0.5))
    con = tables(way, ego, ahead, behind, same)
    (found,) = rows(con, "FROM lane_change")
    left = (hand == "rht") == (to == "in")
    inner, outer = ("1.0.-1", "1.0.-2") if hand == "rht" else ("1.0.1", "1.0.2")
    assert found["side"] == ("left" if left else "right")
    assert (found["from_lanelet_id"], found["to_lanelet_id"]) == ((outer, inner) if to == "in" else (inner, outer))
    moved = np.abs(d - d[0])
    extent = 0.9 * np.cos(ego.yaw) + 2.4 * np.abs(np.sin(ego.yaw))
    assert found["t_start_ns"] == round(t[moved + extent - LANE / 2 > 0.05][0] * 1e9)
    assert found["t_cross_ns"] == pytest.approx(8e9, abs=1.1e8)
    assert found["t_done_ns"] == round(t[(moved - extent > LANE / 2 - 0.05)][0] * 1e9)
    start = int(np.searchsorted(t, found["t_start_ns"] / 1e9 - 0.01))
    front = 100 + 12 * t[start] + 2.4
    assert (found["begin_seen"], found["known"], found["merge"]) == (True, True, False)
    assert (found["leader_id"], found["follower_id"]) == ("ahead", "behind")
    assert found["leader_gap_m"] == pytest.approx(160 + 12 * t[start] - 2.4 - front, abs=0.1)
    assert found["follower_gap_m"] == pytest.approx(front - 4.8 - (70 + 13 * t[start]) - 2.4, abs=0.2)
    assert (found["leader_speed_mps"], found["follower_speed_mps"]) == pytest.approx((12.0, 13.0))
    assert found["ego_speed_mps"] == pytest.approx(12.0, abs=0.2)
    speed = behind.vx
    drops = [(speed[k - 5] - speed[k]) / 0.5 for k in range(start + 5, start + 41)]
    assert found["follower_decel_mps2"] == pytest.approx(max(drops), abs=1e-6)
    assert max(drops) > 2.0
    (line,) = rows(con, "SELECT DISTINCT t_since_ns, begin_seen, manoeuvre FROM line_step")
    assert tuple(line.values()) == (found["t_start_ns"], True, True)
    assert {row["side"] for row in rows(con, "FROM line_step")} == {"left", "right"}
    assert {row["forbidden"] for row in rows(con, "FROM line_step")} == {False}
