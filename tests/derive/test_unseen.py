"""Actors that leave or enter the log near enough to matter: for how long, and how near they may be."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from tests.scenes import LANE, derived, drive, moving, road, rows, times, verdict_rows

if TYPE_CHECKING:
    from tests.scenes import Actor, Floats, Road

FOLLOWING = ("criticality.ttc", "criticality.thw", "ukhc.r126.thinking-gap")


@pytest.mark.sample(0, ci=2)
@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize("gap", [52.0, 99.0])
def test_a_braking_lead_that_is_lost_is_not_nobody(hand: str, gap: float) -> None:
    """31 m/s; the lead brakes with 6 m/s2 from 5 s on and is lost at 5.5 s."""
    way = road(((3000.0, 0.0),), hand=hand)
    t = times(25.0)
    ego = moving("ego", way, t, 100 + 31 * t, way.ego_d)
    s = 100 + 4.8 + gap + 31 * t - 3 * np.clip(t - 5, 0, None) ** 2
    lead = moving("x", way, t, s, way.ego_d).keep(t < 5.55)
    scene = drive([ego, lead], way.environment)
    found = {round(r["t_ns"] / 1e8) for r in rows(derived(scene, tables=["lead"]), "FROM lead WHERE t_ns > 5.6e9")}
    # the brakes of the lost one may be harder than those of the ego, which has not got so far yet
    assert not found & set(range(100, 250))
    for rule in FOLLOWING:
        verdicts = {r["verdict"] for r in verdict_rows([scene], rules=[rule]) if r["t_end_ns"] > 15e9}
        assert "unknown" in verdicts, rule


def _entering(hand: str) -> tuple[Road, Floats, Actor]:
    """Return two lanes each way, the times, and an ego that is over the near end of the map at 0.4 s and changes lanes from 4 s to 7 s."""
    way = road(((2000.0, 0.0),), hand=hand, lanes=(2, 2), limit_mph=70)
    t = times(20.0)
    d = way.ego_d + LANE * way.over * -1 * (1 - np.clip((t - 4) / 3, 0, 1))
    return way, t, moving("ego", way, t, 10 + 25 * t, d)


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize("lane", [0, 1])
def test_who_comes_in_behind_was_behind_in_whichever_lane(hand: str, lane: int) -> None:
    """It is over the near end at 9 s and drives with the ego: no step leaves it open whether it was ahead, was passed or comes."""
    way, t, ego = _entering(hand)
    other = moving("x", way, t, 3 + 28 * (t - 9), way.ego_d - lane * LANE * way.over).keep(t > 8.99)
    con = derived(drive([ego, other], way.environment), tables=["hidden", "oncoming", "passing", "lane_change", "lead"])
    hidden = rows(con, "FROM hidden WHERE t_ns > 1e9 ORDER BY t_ns")
    assert len(hidden) > 70
    assert {(row["ahead"], row["along"]) for row in hidden} == {(False, True)}
    # at 5 s the ego's rear is at 132.6 m, and the other over the end 4 s later
    (at5,) = (row for row in hidden if round(row["t_ns"] / 1e8) == 50)
    assert at5["least_m"] > 132.6 + 28**2 / 20 - 12
    assert not rows(con, "FROM passing")
    assert len(rows(con, "FROM lead WHERE t_ns > 1e9")) == len(t) - 11
    (change,) = rows(con, "FROM lane_change")
    assert change["unseen_m"] > 100
