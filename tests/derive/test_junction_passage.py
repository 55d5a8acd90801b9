"""The ego's ways through junctions: when, by which lanelets, which turn, and what governs the way in."""

from __future__ import annotations

from itertools import permutations
from typing import TYPE_CHECKING

import numpy as np
import pytest

from tests.derive.junction_scenes import ARM, TURN, R, cross
from tests.scenes import Actor, Road, derived, drive, moving, rows, times

if TYPE_CHECKING:
    from tests.scenes import Row

LENGTH = {"right": TURN, "straight": 2 * R, "left": TURN}


def going(way: Road) -> Actor:
    """Drive in the way's own lane at 8 m/s; its centre enters the junction at s = 185."""
    t = times(18.0)
    return moving("ego", way, t, 120.0 + 8.0 * t, way.ego_d)


def passages(*actors: Actor, way: Road) -> list[Row]:
    con = derived(drive(actors, way.environment), tables=["junction_passage"])
    return rows(con, "FROM junction_passage ORDER BY ego_id, occurrence")


def turned(a: str, b: str) -> str:
    return {1: "right", 2: "straight", 3: "left"}[("wsen".index(b) - "wsen".index(a)) % 4]


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize("name", ["".join(p) for p in permutations("wsen", 2)])
def test_every_way_through_a_crossroads(hand: str, name: str) -> None:
    way = cross(hand)[name]
    (row,) = passages(going(way), way=way)
    turn = turned(*name)
    assert (row["turn"], row["branches"], row["junction_id"], row["occurrence"]) == (turn, 4, "9", 0)
    assert row["turn_rad"] == pytest.approx({"left": 1, "straight": 0, "right": -1}[turn] * np.pi / 2, abs=1e-3)
    assert row["across"] == (turn == ("right" if hand == "lht" else "left"))
    # the front bumper is 2.4 m ahead of the centre, the rear one as far behind; the log has a step every 0.8 m
    assert row["t_in_ns"] / 1e9 == pytest.approx((ARM - 2.4 - 120) / 8, abs=0.1)
    assert row["t_out_ns"] / 1e9 == pytest.approx((ARM + LENGTH[turn] + 2.4 - 120) / 8, abs=0.1)
    assert row["from_lanelet_id"].split(".")[0] == {"w": "1", "e": "2", "s": "3", "n": "4"}[name[0]]
    assert row["to_lanelet_id"].split(".")[0] == {"w": "1", "e": "2", "s": "3", "n": "4"}[name[1]]
    assert len(row["via_lanelet_id"].split(".")[0]) == 2
    # no signal of these kinds in the whole map: nobody can tell
    assert (row["control"], row["minor"]) == (None, None)
