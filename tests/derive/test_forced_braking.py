"""Whom the ego made to brake: who would have come to its ground at the speed before, whether it came late or never."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from tests.derive.junction_scenes import cross, lit, signal
from tests.scenes import Actor, Road, derived, drive, judged, moving, road, rows, standing, swing, times

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


def flipped(name: str, hand: str) -> str:
    """Return the way through the crossroads as it is where the left is driven on."""
    return name.translate(str.maketrans("ns", "sn")) if hand == "lht" else name


def turning(
    hand: str = "rht", *, by: float = 6.0, at: float = 8.0, again: float | None = None, s0: float = 46.0, period: float = 0.1,
    more: tuple[Actor, ...] = (), ways: dict[str, Road] | None = None, drive_id: str = "d", **other: Any,
) -> Drive:  # fmt: skip
    """Return the ego's turn across the oncoming traffic (in the junction from 7.9 s on) before one at 14 m/s that brakes at 8 s."""
    ways = ways or cross(hand)
    t = times(END, period=period)
    own, across = ways["we"].own, flipped("wn", hand)
    ego = moving("ego", ways[across], t, 120 + 8 * t, own)
    braking = moving("o", ways["ew"], t, way_of(stopping(t, 14.0, at, by, again), s0, t), own)
    return drive([ego, replace(braking, **other), *more], ways["we"].environment, drive_id=drive_id)


def forced(scene: Drive) -> list[Row]:
    return rows(derived(scene, tables=["forced_braking"]), "FROM forced_braking ORDER BY t_from_ns")


def verdicts(scene: Drive, rule: str) -> list[tuple[str, Any]]:
    return [(row["verdict"], row["object_id"]) for row in judged([scene], rules=[rule]) if row["ego_id"] == "ego"]


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
    scene = turning(period=period, at=8.0)
    assert forced(scene)[0]["decel_mps2"] > 4
    assert verdicts(scene, GAP) == [("fail", "o")]


@pytest.mark.ci
@pytest.mark.parametrize("hand", ["rht", "lht"])
def test_who_eases_off_or_was_far_away_is_not_forced(hand: str) -> None:
    # 1.4 m/s2 all the way
    assert not forced(turning(hand, by=1.4, at=4.0))
    assert verdicts(turning(hand, by=1.4, at=4.0, s0=20.0), GAP) == [("pass", None)]
    # at 14 m/s it would have come seven seconds later
    assert not forced(turning(hand, s0=-40.0))
    assert verdicts(turning(hand, s0=-40.0), GAP) == [("pass", None)]


def test_who_stops_before_the_ego_moves_off_lets_it_go() -> None:
    """The ego waits in the junction; the other stops for it, and only then it turns."""
    ways = cross()
    t = times(END)
    v = np.where(t < 5, 8.0, np.clip(8 - 3 * (t - 5), 0, 8)) + np.where(t > 14, np.clip(2 * (t - 14), 0, 8), 0.0)
    ego = moving("ego", ways["wn"], t, way_of(v, 138.0, t), ways["wn"].own)
    other = moving("o", ways["ew"], t, way_of(stopping(t, 14.0, 11.0, 4.0), 5.0, t), ways["ew"].own)
    scene = drive([ego, other], ways["we"].environment)
    found = forced(scene)
    assert not found or {row["other_cause"] for row in found} == {"let_go"}
    assert all(verdict != "fail" for verdict, _ in verdicts(scene, GAP))


@pytest.mark.ci
def test_who_brakes_for_somebody_before_it_is_in_doubt() -> None:
    ways = cross()
    t = times(END)
    queue = standing("q", ways["ew"], t, 178.0, ways["ew"].own)
    scene = turning(more=(queue,))
    assert [row["other_cause"] for row in forced(scene)] == ["somebody_else"]
    assert verdicts(scene, GAP) == [("unknown", None)]
    # parked beside its way it is none
    beside = standing("q", ways["ew"], t, 178.0, 2.2 * ways["ew"].own)
    assert verdicts(turning(more=(beside,)), GAP) == [("fail", "o")]
    # and a follower is not before it
    follower = moving("f", ways["ew"], t, way_of(stopping(t, 14.0, 8.5, 6.0), 20.0, t), ways["ew"].own)
    assert verdicts(turning(more=(follower,)), GAP) == [("fail", "o")]


@pytest.mark.parametrize(("state", "cause"), [("green", None), ("red", "signal"), (None, "signal")])
def test_who_brakes_for_a_light_is_in_doubt_unless_it_is_green(state: str | None, cause: str | None) -> None:
    # road 2 leads away from the junction: who comes along it drives against its line
    ways = cross(signals=(("2", signal("light", 4.0, "1000001", t=-5.0, orientation="-")),))
    scene = lit(turning(ways=ways), "light", *(((0.0, state), (39.0, state)) if state else ()))
    assert [row["other_cause"] for row in forced(scene)] == [cause]
    assert verdicts(scene, GAP) == [("unknown", None) if cause else ("fail", "o")]


def test_who_brakes_for_its_own_bend_is_in_doubt() -> None:
    """It turns into the same road as the ego: at 14 m/s it could not."""
    ways = cross()
    t = times(END)
    v = np.maximum(stopping(t, 14.0, 7.0, 3.0), 5.0)
    ego = moving("ego", ways["wn"], t, 120 + 8 * t, ways["wn"].own)
    other = moving("o", ways["en"], t, way_of(v, 60.0, t), ways["en"].own)
    found = forced(drive([ego, other], ways["we"].environment))
    assert all(row["other_cause"] == "bend" for row in found)


def test_a_follower_who_brakes_behind_the_turning_ego_is_not_forced() -> None:
    ways = cross()
    t = times(END)
    ego = moving("ego", ways["ws"], t, 120 + 8 * t, ways["ws"].own)
    follower = moving("f", ways["ws"], t, way_of(np.maximum(stopping(t, 12.0, 5.0, 3.0), 8.0), 80.0, t), ways["ws"].own)
    assert not forced(drive([ego, follower], ways["we"].environment))


def passing(
    hand: str,
    *,
    by: float = 6.5,
    at: float = 11.0,
    from_m: float = 380.0,
    v: float = 16.0,
    again: float | None = None,
    more: tuple[Actor, ...] = (),
    end: float = END,
    **other_has: Any,
) -> Drive:
    """Return the ego's way round a parked car at 200 m, at 10 m/s, and somebody oncoming who stops for it."""
    way = road(((600.0, 0.0),), hand)
    t = times(end)
    s = 50 + 10 * t
    ego = moving("ego", way, t, s, swing(way, s, 170.0, 215.0))
    parked = standing("p", way, t, 200.0, way.own)
    other = moving("o", way, t, from_m - way_of(stopping(t, v, at, by, again), 0.0, t), way.other, **other_has)
    return drive([ego, parked, other, *more], way.environment)


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
    parked = standing("p", way, t, 200.0, way.own)
    gone = way_of(np.where(t > 15, 0.0, stopping(t, 12.0, 13.5, by)), 0.0, t)
    other = moving("o", way, t, 204.78 + gone[-1] - gone, way.other)
    return drive([ego, parked, other], way.environment)


@pytest.mark.ci
@pytest.mark.parametrize("hand", ["rht", "lht"])
def test_the_deceleration_of_a_crash_is_no_braking(hand: str) -> None:
    """Who did not brake is not said to have, though it lost 12 m/s; who braked by 3 m/s2 is not said to have braked harder."""
    scene = crashing(hand, by=0.0)
    assert [row["object_id"] for row in rows(derived(scene, tables=["impact"]), "FROM impact")] == ["o"]
    assert forced(scene) == []
    (told,) = [row for row in judged([scene], rules=[GIVE_WAY]) if row["ego_id"] == "ego"]
    assert (told["verdict"], told["object_id"]) == ("fail", "p")
    assert "braked" not in told["reason"]
    (row,) = forced(crashing(hand, by=3.0))
    assert row["decel_mps2"] == pytest.approx(3.0, abs=0.3)
    assert row["waited"] is False  # it was stopped, it did not stop


@pytest.mark.parametrize("hand", ["rht", "lht"])
def test_who_stops_far_away_or_softly_is_not_forced(hand: str) -> None:
    assert verdicts(passing(hand, from_m=590.0, at=14.0), GIVE_WAY) == [("pass", "p")]
    assert verdicts(passing(hand, from_m=440.0, by=1.0, at=2.0), GIVE_WAY) == [("pass", "p")]


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize("at", [6.0, 8.0])
def test_who_stops_before_the_ego_is_over_the_line_waits_for_it_all_the_same(hand: str, at: float) -> None:
    """It brakes up to 7 s before the ego is on its ground, and stands until the ego is back; far off it would have passed first."""
    scene = passing(hand, by=4.0, at=at, from_m=350.0 + 12 * (at - 8), v=12.0)
    assert [(row["other_cause"], row["decel_mps2"] > 3.5) for row in forced(scene)] == [(None, True)]
    assert verdicts(scene, GIVE_WAY) == [("fail", "p")]


@pytest.mark.parametrize("hand", ["rht", "lht"])
def test_who_slows_early_and_goes_on_or_stops_far_off_does_not_wait_for_the_ego(hand: str) -> None:
    way = road(((600.0, 0.0),), hand)
    t = times(END)
    s = 50 + 10 * t
    ego = moving("ego", way, t, s, swing(way, s, 170.0, 215.0))
    parked = standing("p", way, t, 200.0, way.own)
    slowed = np.clip(16 - 3 * np.clip(t - 4, 0, None), 6, 16)
    other = moving("o", way, t, 420 - way_of(slowed, 0.0, t), way.other)
    assert verdicts(drive([ego, parked, other], way.environment), GIVE_WAY) == [("pass", "p")]
    assert verdicts(passing(hand, by=4.0, at=6.0, from_m=550.0, v=12.0), GIVE_WAY) == [("pass", "p")]


# it brakes at 8.5 s, 330 m up the road, by 1.4 m/s2 from 12 m/s, and stands 51 m further on from 17.1 s; the ego is back at 18.4 s or so
GENTLY: dict[str, Any] = {"by": 1.4, "at": 8.5, "from_m": 405.0, "v": 12.0}


@pytest.mark.ci
@pytest.mark.parametrize("hand", ["rht", "lht"])
def test_who_stops_gently_and_waits_for_the_ego_is_forced(hand: str) -> None:
    """It goes on 20 s into the log; one that goes on much later, or stands on, stands there for something else."""
    scene = passing(hand, again=19.0, **GENTLY)
    (row,) = forced(scene)
    assert (row["object_id"], row["other_cause"], row["waited"]) == ("o", None, True)
    assert row["decel_mps2"] == pytest.approx(1.4, abs=0.05)
    assert row["speed_mps"] == pytest.approx(12.0, abs=0.2)
    assert verdicts(scene, GIVE_WAY) == [("fail", "p")]
    for again in (28.0, None):
        scene = passing(hand, again=again, **GENTLY)
        assert [row["waited"] for row in forced(scene)] == [False]
        assert verdicts(scene, GIVE_WAY) == [("pass", "p")]


@pytest.mark.ci
@pytest.mark.parametrize("hand", ["rht", "lht"])
def test_whether_it_waited_may_not_be_clear(hand: str) -> None:
    """The log ends while it stands; it is a bus; somebody walks across before it."""
    scene = passing(hand, end=21.5, **GENTLY)
    assert [row["waited"] for row in forced(scene)] == [None]
    assert verdicts(scene, GIVE_WAY) == [("unknown", "p")]
    assert verdicts(passing(hand, again=19.0, kind="bus", **GENTLY), GIVE_WAY) == [("unknown", "p")]
    way = road(((600.0, 0.0),), hand)
    t = times(END)
    d = way.other * (2.5 - 0.6 * np.clip(t - 8, 0, 8))
    walker = moving("w", way, t, np.full(t.shape, 272.0), d, kind="pedestrian", length=0.5, width=0.5)
    scene = passing(hand, again=19.0, more=(walker,), **GENTLY)
    assert [row["other_cause"] for row in forced(scene) if row["object_id"] == "o"] == ["somebody_else"]
    assert verdicts(scene, GIVE_WAY) == [("unknown", "p")]


@pytest.mark.ci
@pytest.mark.parametrize("hand", ["rht", "lht"])
def test_who_stops_gently_far_off_or_while_the_ego_keeps_its_lane_does_not_wait(hand: str) -> None:
    far = {**GENTLY, "from_m": 560.0}
    assert not forced(passing(hand, again=19.0, **far))
    assert verdicts(passing(hand, again=19.0, **far), GIVE_WAY) == [("pass", "p")]
    way = road(((600.0, 0.0),), hand)
    t = times(END)
    other = moving("o", way, t, 405 - way_of(stopping(t, 12.0, 8.5, 1.4, 19.0), 0.0, t), way.other)
    assert not forced(drive([moving("ego", way, t, 50 + 10 * t, way.own), other], way.environment))


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize(("evades", "verdict"), [(0.8, "fail"), (2.5, "pass")])
def test_who_comes_by_with_hardly_any_room(hand: str, evades: float, verdict: str) -> None:
    """It swerves on to the verge as it meets the ego beside the parked car; their ways share no ground."""
    way = road(((600.0, 0.0),), hand)
    t = times(END)
    s = 50 + 10 * t
    ego = moving("ego", way, t, s, swing(way, s, 170.0, 215.0, share=0.6))
    parked = standing("p", way, t, 200.0, way.own * 1.4)
    there = 345 - 10 * t
    d = way.other + np.sign(way.other) * evades * (
        np.clip((there - 255) / -20, 0, 1) - np.clip((there - 160) / -20, 0, 1)
    )
    other = moving("o", way, t, there, d)
    assert verdicts(drive([ego, parked, other], way.environment), GIVE_WAY) == [(verdict, "p")]


@pytest.mark.ci
@pytest.mark.parametrize("hand", ["rht", "lht"])
def test_who_comes_without_a_place_may_have_come_too_near(hand: str) -> None:
    """It meets the ego 2 s after that is back; its heading or its position is lost while the ego is out, or once they have passed."""
    way = road(((600.0, 0.0),), hand)
    t = times(END)
    s = 50 + 10 * t
    ego = moving("ego", way, t, s, swing(way, s, 170.0, 215.0))
    parked = standing("p", way, t, 200.0, way.own)
    other = moving("o", way, t, 460 - 10 * t, way.other)

    def found(comes: Actor) -> list[tuple[str, Any]]:
        return verdicts(drive([ego, parked, comes], way.environment), GIVE_WAY)

    assert found(other) == [("pass", "p")]
    assert found(other.lost(t > 14)) == [("unknown", "p")]
    assert found(replace(other, yaw=np.where(t > 14, np.nan, other.yaw))) == [("unknown", "p")]
    assert found(replace(other, yaw=np.where(t > 26, np.nan, other.yaw))) == [("pass", "p")]


@pytest.mark.ci
def test_without_a_heading_or_a_size_it_is_in_doubt() -> None:
    for lacks in ({"length": None}, {"yaw": np.full(len(times(END)), np.nan)}):
        scene = turning(**lacks)
        assert [row["other_cause"] for row in forced(scene)] == ["incomplete"]
        assert verdicts(scene, GAP) == [("unknown", None)]


def test_every_ego_and_every_drive_for_itself() -> None:
    one, two = turning(), turning(by=4.0, drive_id="e")
    together = rows(derived(one, two, tables=["forced_braking"]), "FROM forced_braking ORDER BY drive_id")
    assert [row["drive_id"] for row in together] == ["d", "e"]
    assert [together[0]] == forced(one)


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize(("room", "verdict"), [(0.1, "fail"), (0.4, "fail"), (0.7, "pass")])
def test_who_brakes_hard_to_squeeze_by_is_forced_though_it_would_just_have_missed(
    hand: str, room: float, verdict: str
) -> None:
    """It keeps to its edge; the boxes would have been so far apart had it come on at its speed."""
    way = road(((600.0, 0.0),), hand)
    t = times(END)
    s = 50 + 10 * t
    ego = moving("ego", way, t, s, swing(way, s, 170.0, 215.0, share=0.6))
    parked = standing("p", way, t, 200.0, way.own * 1.4)
    v = np.clip(16 - 5 * np.clip(t - 12, 0, None), 3, 16)
    # the middle of the road is at 0, the ego's side at 0.35 + 0.9 m beyond it
    d = np.sign(way.other) * (1.25 + room + 0.9)
    other = moving("o", way, t, 400 - way_of(v, 0.0, t), d)
    assert verdicts(drive([ego, parked, other], way.environment), GIVE_WAY) == [(verdict, "p")]
