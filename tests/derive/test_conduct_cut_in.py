"""Others that come from beside into the ego's lane."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tests.derive.marked import marked, offsets, tables
from tests.scenes import LANE, Actor, Road, moving, rows, times

ROW = dict[str, Any]


def cuts(way: Road, *actors: Actor, egos: tuple[str, ...] = ("ego",)) -> list[ROW]:
    return rows(tables(way, *actors, egos=egos, of=("cut_in",)), "FROM cut_in ORDER BY ego_id, occurrence")


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize("of", ["in", "out"])
def test_one_cuts_in_from_either_side(hand: str, of: str) -> None:
    way = marked(hand, lanes=2)
    t = times(14.0)
    mine, its = (1.5, 0.5) if of == "in" else (0.5, 1.5)
    ego = moving("ego", way, t, 100 + 12 * t, offsets(way, t, 99.0, start=mine))
    other = moving("x", way, t, 95 + 13 * t, offsets(way, t, 7.0, start=its, to=mine))
    (found,) = cuts(way, ego, other)
    left = (hand == "rht") == (of == "in")
    assert (found["object_id"], found["side"], found["begin_seen"]) == ("x", "left" if left else "right", True)
    lane = abs(mine) * LANE * np.sign(way.ego_d)
    inside = LANE / 2 + 0.9 * np.cos(other.yaw) + 2.4 * np.abs(np.sin(other.yaw)) - np.abs(other.y - lane)
    k = int(np.argmax(inside > 0.3))
    assert found["t_ns"] == round(t[k] * 1e9)
    assert found["in_place_ns"] == round(t[np.abs(other.y - lane) < LANE / 2][0] * 1e9)
    assert found["gap_m"] == pytest.approx(-5 + t[k] - 4.8, abs=0.2)
    assert found["ego_speed_mps"] == pytest.approx(12.0)
    assert found["speed_mps"] == pytest.approx(13.0, abs=0.2)
