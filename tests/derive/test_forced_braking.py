"""Whom the ego made to brake: who would have come to its ground at the speed before, whether it came late or never."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from tests.derive.junction_scenes import cross
from tests.scenes import derived, drive, moving, road, rows, standing, swing, times, verdict_rows

if TYPE_CHECKING:
    from drivelint.engine.batch import Drive
    from tests.scenes import Floats, Row

END = 40.0


def way_of(v: Floats, s0: float, t: Floats) -> Floats:
    """Return the stations of somebody with these speeds."""
    gone: Floats = s0 + np.concatenate([[0.0], np.cumsum((v[1:] + v[:-1]) / 2 * np.diff(t))])
    return gone


def stopping(t: Floats, v: float, at: float, by: float, again: float | None = None) -> Floats:
    """Return speeds of who brakes at `at` by `by` m/s2 to a stand, and goes on at `again` (None: never)."""
    speeds: Floats = np.clip(v - by * np.clip(t - at, 0, None), 0, v)
    return speeds if again is None else np.where(t > again, np.clip(2 * (t - again), 0, v), speeds)


def turning(hand: str = "rht", *, again: float | None = None, period: float = 0.1) -> Drive:
    """Return the ego's turn across the oncoming traffic (in the junction from 7.9 s on) before one at 14 m/s that brakes at 8 s."""
    ways, t = cross(hand), times(END, period=period)
    own, across = ways["we"].ego_d, "ws" if hand == "lht" else "wn"
    ego = moving("ego", ways[across], t, 120 + 8 * t, own)
    braking = moving("o", ways["ew"], t, way_of(stopping(t, 14.0, 8.0, 6.0, again), 46.0, t), own)
    return drive([ego, braking], ways["we"].environment)


def forced(scene: Drive) -> list[Row]:
    return rows(derived(scene, tables=["forced_braking"]), "FROM forced_braking ORDER BY t_from_ns")


def verdicts(scene: Drive, rule: str) -> list[tuple[str, Any]]:
    return [(row["verdict"], row["object_id"]) for row in verdict_rows([scene], rules=[rule]) if row["ego_id"] == "ego"]


GAP = "ukhc.r180.right-turn-gap"


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize("again", [None, 14.0, 25.0])
def test_who_has_to_stop_for_the_turn_is_forced_whether_it_comes_late_or_never(hand: str, again: float | None) -> None:
    scene = turning(hand, again=again)
    (row,) = forced(scene)
    assert row["object_id"] == "o"
    assert row["decel_mps2"] == pytest.approx(6.0, abs=0.05)
    assert row["speed_mps"] == pytest.approx(14.0)
    assert row["pet_s"] < 2
    assert row["other_cause"] is None
    assert verdicts(scene, GAP) == [("fail", "o")]


@pytest.mark.parametrize("period", [0.05, 0.13, 0.19, 0.2, 1 / 3, 0.5, 1.0])
def test_at_every_rate(period: float) -> None:
    scene = turning(period=period)
    assert forced(scene)[0]["decel_mps2"] > 4
    assert verdicts(scene, GAP) == [("fail", "o")]


def passing(hand: str) -> Drive:
    """Return the ego's way round a parked car at 200 m, at 10 m/s, and somebody oncoming who stops for it."""
    way = road(((600.0, 0.0),), hand)
    t = times(END)
    s = 50 + 10 * t
    ego = moving("ego", way, t, s, swing(way, s, 170.0, 215.0))
    parked = standing("p", way, t, 200.0, way.ego_d)
    other = moving("o", way, t, 380.0 - way_of(stopping(t, 16.0, 11.0, 6.5), 0.0, t), way.oncoming_d)
    return drive([ego, parked, other], way.environment)


GIVE_WAY = "ukhc.r163.obstruction-give-way"


@pytest.mark.parametrize("hand", ["rht", "lht"])
def test_who_has_to_stop_for_the_ego_round_an_obstruction(hand: str) -> None:
    scene = passing(hand)
    (row,) = forced(scene)
    assert (row["object_id"], row["other_cause"]) == ("o", None)
    assert abs(row["angle_rad"]) > 2.6
    assert row["decel_mps2"] == pytest.approx(6.5, abs=0.1)
    assert verdicts(scene, GIVE_WAY) == [("fail", "p")]


def crashing(hand: str, by: float) -> Drive:
    """Return a head-on crash beside the parked car at 15 s; the oncoming driver brakes from 13.5 s on by `by` m/s2; then both stand."""
    way = road(((600.0, 0.0),), hand)
    t = times(END)
    s = 50 + 10 * np.minimum(t, 15.0)
    ego = moving("ego", way, t, s, swing(way, s, 170.0, 215.0))
    parked = standing("p", way, t, 200.0, way.ego_d)
    gone = way_of(np.where(t > 15, 0.0, stopping(t, 12.0, 13.5, by)), 0.0, t)
    other = moving("o", way, t, 204.78 + gone[-1] - gone, way.oncoming_d)
    return drive([ego, parked, other], way.environment)


@pytest.mark.ci
@pytest.mark.parametrize("hand", ["rht", "lht"])
def test_the_deceleration_of_a_crash_is_no_braking(hand: str) -> None:
    """Who did not brake is not said to have, though it lost 12 m/s; who braked by 3 m/s2 is not said to have braked harder."""
    scene = crashing(hand, by=0.0)
    assert [row["object_id"] for row in rows(derived(scene, tables=["impact"]), "FROM impact")] == ["o"]
    assert forced(scene) == []
    (told,) = [row for row in verdict_rows([scene], rules=[GIVE_WAY]) if row["ego_id"] == "ego"]
    assert (told["verdict"], told["object_id"]) == ("fail", "p")
    assert "braked" not in told["reason"]
    (row,) = forced(crashing(hand, by=3.0))
    assert row["decel_mps2"] == pytest.approx(3.0, abs=0.3)
    assert row["waited"] is False  # it was stopped, it did not stop
