"""Who is ahead along the lane, and whose box the ego's passes by as both move: no collision is near, and nobody is followed."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np
import pytest

from tests.scenes import Actor, derived, drive, judged, road, rows, times

WAY: Final = road(((300.0, 0.0),), lanes=(1, 1))
T: Final = times(1.0)
RULES: Final = (
    "criticality.ttc",
    "criticality.mttc",
    "criticality.drac",
    "criticality.ttb",
    "ukhc.r126.thinking-gap",
    "ukhc.r126.stopping-gap",
)


def heading(actor_id: str, x: float, y: float, yaw: float, speed: float) -> Actor:
    """Return who drives straight on from (x, y)."""
    vx, vy = speed * np.cos(yaw), speed * np.sin(yaw)
    still = np.zeros(len(T))
    return Actor(actor_id, T, x + vx * T, y + vy * T, still + yaw, still + vx, still + vy, width=2.0, length=5.0)


def passing(*actors: Actor) -> set[bool | None]:
    con = derived(drive(actors, WAY.environment), tables=["vehicle_ahead"])
    found = rows(con, "FROM vehicle_ahead WHERE object_id = 'x' AND gap_m >= 0")
    assert found
    return {row["passes_by"] for row in found}


def aslant() -> tuple[Actor, Actor]:
    """Return the ego that leaves its lane to the right, and one to its left that hardly moves, 40 degrees across the lane: side by side.

    Along and across the lane their outlines overlap; the boxes are 2.4 m apart. (Two vehicles in a junction of HRV_Pula-27_3.)
    """
    ego = heading("ego", 100.0, -2.0, -0.65, 1.9)
    return ego, heading("x", 105.6, 0.6, 2.34, 0.8)


def test_a_box_beside_another_across_the_lane_is_passed() -> None:
    assert passing(*aslant()) == {True}
    found = judged([drive(aslant(), WAY.environment)], rules=RULES)
    assert not [(row["rule_id"], row["reason"]) for row in found if row["verdict"] == "fail"]


@pytest.mark.parametrize("speed", [0.0, 2.0])
@pytest.mark.parametrize("aside", [0.0, 1.5, -1.5])
def test_a_box_in_the_way_is_not_passed(speed: float, aside: float) -> None:
    ego = heading("ego", 100.0, -1.75, 0.0, 8.0)
    assert passing(ego, heading("x", 112.0, -1.75 + aside, 0.0, speed)) <= {False, None}
    found = judged(
        [drive([ego, heading("x", 112.0, -1.75 + aside, 0.0, speed)], WAY.environment)], rules=["criticality.ttc"]
    )
    assert [row["verdict"] for row in found] == ["fail"]


@pytest.mark.parametrize(("overlap", "verdict"), [(0.05, "unknown"), (0.25, "fail")])
@pytest.mark.parametrize("side", [1, -1])
def test_boxes_that_meet_by_a_few_centimetres_may_pass_each_other(overlap: float, verdict: str, side: int) -> None:
    """Two narrow cars in one lane, the other to the left or right, a metre wide, their middles 1 m apart less the overlap."""
    apart = side * (1.0 - overlap) / 2
    ego = replace(heading("ego", 100.0, -1.75 - apart, 0.0, 8.0), width=1.0)
    other = replace(heading("x", 112.0, -1.75 + apart, 0.0, 1.0), width=1.0)
    found = judged([drive([ego, other], WAY.environment)], rules=["criticality.ttc"])
    assert {row["verdict"] for row in found} == {verdict}
