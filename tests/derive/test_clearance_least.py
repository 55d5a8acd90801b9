"""How near an actor without a place can have been, from where it was seen before and where it is seen next."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest

from tests.ingested import ingested
from tests.scenes import derived, drive, judged, moving, road, rows, times

if TYPE_CHECKING:
    from tests.scenes import Row


@pytest.mark.sample(0, ci=2)
@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize("who", ["ego", "b"])
def test_a_hole_far_from_each_other_is_no_contact_and_near_each_other_may_be(hand: str, who: str) -> None:
    """The other one is 150 m ahead, from 23 s on 20 m: 15.2 m between the boxes. One of the two has no place for a second."""
    way, t = road(((2000.0, 0.0),), hand=hand), times(30.0)

    def without(begin_s: float) -> list[Row]:
        actors = [moving("ego", way, t, 100 + 10 * t, way.own)]
        actors.append(moving("b", way, t, 250 + 10 * t - 10 * np.clip(t - 10, 0, 13), way.own))
        gone = (t >= begin_s - 0.05) & (t < begin_s + 0.95)
        scene = drive([a.lost(gone) if a.actor_id == who else a for a in actors], way.environment)
        found.extend(rows(derived(scene), "SELECT t_ns / 1e9 AS t_s, least_m FROM clearance_least ORDER BY t_ns"))
        return judged([scene], rules=["ukhc.no-collision"])

    found: list[Row] = []
    assert [row["verdict"] for row in without(5.0)] == ["pass"]
    # both come nearer by 60 m/s at the most, after the last sight of each other and before the next
    lost = [found[k]["least_m"] for k in range(10)]
    assert lost == pytest.approx([lost[0] - 6 * k for k in (0, 1, 2, 3, 4, 4, 3, 2, 1, 0)])
    found.clear()
    assert [(row["verdict"], row["reason_code"]) for row in without(25.0)] == [("unknown", "null_value")]
    assert [row["t_s"] for row in found] == pytest.approx([25.0, 25.1, 25.8, 25.9])
    assert [row["least_m"] for row in found] == pytest.approx([9.2, 3.2, 3.2, 9.2])


def test_one_that_never_has_a_place_may_be_anywhere() -> None:
    way, t = road(((2000.0, 0.0),)), times(5.0)
    other = moving("b", way, t, 900 + 10 * t, way.own)
    scene = drive([moving("ego", way, t, 100 + 10 * t, way.own), other.lost(t >= 0)], way.environment)
    assert rows(derived(scene), "FROM clearance_least") == []
    assert [row["verdict"] for row in judged([scene], rules=["ukhc.no-collision"])] == ["unknown"]


@pytest.mark.parametrize("who", ["ego", "b"])
@pytest.mark.parametrize(("off_m", "verdict"), [(1.0, "unknown"), (60.0, "pass")])
def test_who_jumps_onto_the_other_may_have_met_it(who: str, off_m: float, verdict: str) -> None:
    """150 m apart all along, but for one sample that puts one of them upon, or near, the other."""
    way, t = road(((2000.0, 0.0),)), times(20.0)
    actors = {"ego": moving("ego", way, t, 100 + 10 * t, way.own), "b": moving("b", way, t, 250 + 10 * t, way.own)}
    other = actors["b" if who == "ego" else "ego"]
    actors[who] = replace(actors[who], x=np.where(np.arange(len(t)) == 100, other.x + off_m, actors[who].x))
    scene = ingested(drive(list(actors.values()), way.environment))
    assert [row["verdict"] for row in judged([scene], rules=["ukhc.no-collision"])] == [verdict]
