"""An encounter is one: who it is seen from changes nothing of it. Between samples, on tracks that are cut, where somebody stops."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.derive.meetings import NORTH, across, east, line, mirrored, same
from tests.scenes import Actor, Road, derived, drive, moving, rows, standing, times

Row = dict[str, object]
T = times(24)


def way(*pieces: tuple[float, float], start: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Road:
    return Road(None, pieces, start)  # type: ignore[arg-type]


def of_both(*actors: Actor, **options: object) -> list[Row]:
    """Return the encounters that `ego` sees; `other` sees the same."""
    con = derived(drive(actors, None, egos=("ego", "other"), **options), tables=["conflict"])  # type: ignore[arg-type]
    found = rows(con, "FROM conflict WHERE ego_id = 'ego' AND object_id = 'other' ORDER BY occurrence")
    turned = rows(con, "FROM conflict WHERE ego_id = 'other' AND object_id = 'ego' ORDER BY occurrence")
    assert sorted(map(repr, map(mirrored, found))) == sorted(map(repr, map(same, turned)))
    return found


LEFT = (8 * math.pi / 2, 1 / 8)
RIGHT = (6 * math.pi / 2, -1 / 6)
WAYS = {
    "east": way((400.0, 0.0)),
    "east, left to north": way((100.0, 0.0), LEFT, (200.0, 0.0)),
    "east, right to south": way((100.0, 0.0), RIGHT, (200.0, 0.0)),
    "west, in the next lane": way((400.0, 0.0), start=(200.0, 3.5, math.pi)),
    "west, left to south": way((96.0, 0.0), LEFT, (200.0, 0.0), start=(200.0, 3.5, math.pi)),
    "north, right to east": way((94.0, 0.0), RIGHT, (200.0, 0.0), start=(108.0, -100.0, math.pi / 2)),
    "north, left to west": way((95.5, 0.0), LEFT, (200.0, 0.0), start=(108.0, -100.0, math.pi / 2)),
    "a shift to the left": way((90.0, 0.0), (8.0, 1 / 12), (8.0, -1 / 12), (200.0, 0.0)),
    "once round": way((90.0, 0.0), (2 * math.pi * 12, 1 / 12), (200.0, 0.0)),
}  # fmt: skip


@st.composite
def drivers(draw: st.DrawFn, name: str) -> Actor:
    """Return one on one of the ways, at 3 to 12 m/s, that stands for a while somewhere or does not."""
    road = WAYS[draw(st.sampled_from(sorted(WAYS)))]
    v, at, waits = draw(st.integers(3, 12)), draw(st.integers(80, 125)), draw(st.sampled_from([0, 0, 1, 5]))
    came = draw(st.integers(6, 12))  # seconds: when it is there
    s = np.interp(T, [came - 20, came, came + waits, came + waits + 20], [at - 20 * v, at, at, at + 20 * v])
    sizes: list[dict[str, Any]] = [{}, {"length": 12.0, "width": 2.5}, {"length": 1.8, "width": 0.6, "kind": "bicycle"}]
    size = draw(st.sampled_from(sizes))
    return moving(name, road, T, s, 0.0, **size)


@pytest.mark.slow
@settings(max_examples=8)
@given(st.lists(st.tuples(drivers("ego"), drivers("other")), min_size=12, max_size=12))
def test_both_see_the_same(pairs: list[tuple[Actor, Actor]]) -> None:
    """Turning across each other, merging, parting, following, standing: the same encounters, times, angle and time between."""
    con = derived(
        *(drive(pair, None, drive_id=f"{no:02}", egos=("ego", "other")) for no, pair in enumerate(pairs)),
        tables=["conflict"],
    )
    for no in range(len(pairs)):
        seen = rows(con, "FROM conflict WHERE drive_id = ? ORDER BY t_object_in_ns", [f"{no:02}"])
        of_ego, of_other = ([row for row in seen if row["ego_id"] == who] for who in ("ego", "other"))
        assert sorted(map(repr, map(mirrored, of_ego))) == sorted(map(repr, map(same, of_other)))


def test_the_ids_do_not_matter() -> None:
    """Merging from the side behind the other, whatever the two are called."""
    a = moving("ego", WAYS["east"], T, 9 * T - 20, 0.0)
    b = moving("other", WAYS["north, right to east"], T, 7 * T, 0.0)
    (first,), (second,) = of_both(a, b), of_both(replace(a, actor_id="other"), replace(b, actor_id="ego"))
    assert mirrored(first) == same(second)


def test_merging_behind_somebody_counts_from_its_rear() -> None:
    """The time between runs from when the ego's rear has left the ground over which the other turns, until the other's corner is there."""
    a = moving("ego", WAYS["east"], T, 10 * T, 0.0)
    b = moving("other", WAYS["north, right to east"], T, 5 * T - 5, 0.0)
    (row,) = of_both(a, b)
    # the corner comes to the ego's side about y = -0.9, the last of the turn at more than 20 degrees ends about x = 117
    assert row["ego_first"]
    assert 10.9 < row["t_ego_out_ns"] / 1e9 < 12.3  # type: ignore[operator]
    assert row["pet_s"] == pytest.approx((row["t_object_in_ns"] - row["t_ego_out_ns"]) / 1e9, abs=0.2)  # type: ignore[operator]


def test_who_follows_somebody_that_turns_off_does_not_cross_its_way() -> None:
    """The ego goes straight on 1.5 s behind: its front comes where the other's tail swung over at an angle of less than 45 degrees."""
    a = moving("ego", WAYS["east"], T, 6 * T - 9, 0.0)
    (row,) = of_both(a, moving("other", WAYS["east, right to south"], T, 6 * T, 0.0))
    assert row["ego_first"] is False
    assert math.radians(20) < abs(row["angle_rad"]) < math.radians(45)  # type: ignore[arg-type]
    assert abs(row["pet_s"]) < 0.7  # type: ignore[arg-type]


@pytest.mark.parametrize(("period", "v"), [(0.1, 20.0), (0.5, 20.0), (1.0, 30.0)])
def test_a_slow_recorder_gives_the_same_time(period: float, v: float) -> None:
    """At 30 m/s and 1 Hz a car is never recorded on the ground that it drives over."""
    t = times(20, period=period)
    a = moving("ego", line(), t, v * (t - 8.3), 0.0)
    b = moving("other", NORTH, t, v / 2 * (t - 11.7), 0.0)
    (row,) = of_both(a, b)
    assert row["pet_s"] == pytest.approx(11.7 - 3.3 / (v / 2) - (8.3 + 3.3 / v), abs=0.002)
    assert row["pet_at_most"] is False


def test_who_stands_on_the_ground_for_long_leaves_it_once() -> None:
    """The ego waits there for 14 s; the other comes 2 s after it has gone on."""
    t = times(40)
    s = np.interp(t, [0, 5, 19, 30], [-50, 0, 0, 55])
    (row,) = of_both(moving("ego", line(), t, s, 0.0), moving("other", NORTH, t, 5 * (t - 22), 0.0))
    assert row["ego_first"]
    assert row["pet_s"] == pytest.approx(22 - 3.3 / 5 - (19 + 3.3 / 5), abs=0.02)
    assert row["pet_at_most"] is False


def test_who_is_struck_standing_meets_nobody_and_is_not_met() -> None:
    t = times(12)
    stands = standing("other", NORTH, t, 0.0, 0.0)
    drove_before = replace(stands, y=np.where(t < 0.3, stands.y - 200, stands.y), vy=np.where(t < 0.3, 10.0, 0.0))
    assert not of_both(east(), drove_before)


@pytest.mark.parametrize(
    ("cut", "at_most"),
    [
        ("whole", False), ("the later one begins on it", True), ("the earlier one ends on it", True), ("the later one ends on it", False),
        ("the earlier one begins on it", False), ("the later one has a hole before it", True), ("a sample is missing before it", False),
    ],
)  # fmt: skip
def test_a_track_that_is_cut_there_bounds_the_time(cut: str, at_most: bool) -> None:
    """The ego is on it from 4.67 to 5.33 s, the other from 7.34 to 8.66 s: what was not seen can only make it less."""
    t = times(12)
    seen = {
        "the later one begins on it": ("other", t > 7.55), "the earlier one ends on it": ("ego", t < 5.05),
        "the later one ends on it": ("other", t < 8.05), "the earlier one begins on it": ("ego", t > 4.95),
        "the later one has a hole before it": ("other", (t < 6.95) | (t > 7.55)),
        "a sample is missing before it": ("other", (t < 7.25) | (t > 7.35)),
    }  # fmt: skip
    who, mask = seen.get(cut, ("ego", t >= 0))
    both = [east(), across(-40 + 5 * t)]
    (row,) = of_both(*(each.keep(mask) if each.actor_id == who else each for each in both))
    assert row["pet_at_most"] is at_most
    whole = 8 - 3.3 / 5 - (5 + 3.3 / 10)
    if at_most:
        assert row["pet_s"] > whole  # type: ignore[operator]
    else:
        assert row["pet_s"] == pytest.approx(whole, abs=1e-6)


def test_the_same_two_meet_once_more() -> None:
    """The other goes on round the block and crosses the ego's way again, where the ego has been driving to and fro."""
    t = times(60)
    s = np.interp(t, [0, 10, 30, 40, 60], [-50, 50, 50, -50, -50])
    ego = moving("ego", line(), t, s, 0.0)
    o = np.interp(t, [0, 8, 14, 28, 38, 60], [-40, -8, 30, 30, -30, -30])
    found = of_both(ego, moving("other", NORTH, t, o, 0.0))
    assert len(found) == 2
    assert [row["ego_first"] for row in found] == [True, False]


@pytest.mark.parametrize("turned", [math.pi, math.pi / 2, -math.pi / 3])
@pytest.mark.parametrize("v", [1.2, 8.0])
def test_followers_on_one_course_do_not_meet_whatever_a_heading_says(turned: float, v: float) -> None:
    """The heading of the follower flips for two seconds: its course over ground stays."""
    gap = 2.0 * v + 5.0
    ego, other = (moving(name, line(), T, s0 + v * T, 0.0) for name, s0 in (("ego", 0.0), ("other", gap)))
    ego.yaw[80:100] += turned
    assert of_both(ego, other) == []


@pytest.mark.parametrize("degrees", [30, 60, 180, -45])
def test_ways_at_an_angle_meet(degrees: int) -> None:
    """As slow as the followers, with headings that are right."""
    heading = math.radians(degrees)
    other = moving("other", line(heading, -16.0 * math.cos(heading), -16.0 * math.sin(heading)), T, 1.4 * T, 0.0)
    (row,) = of_both(moving("ego", line(), T, -14.4 + 1.2 * T, 0.0), other)
    assert row["angle_rad"] == pytest.approx(heading) or abs(degrees) == 180
