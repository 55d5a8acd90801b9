"""Where two ways cross or merge: who was on the shared ground, and when. No map is needed for that."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pytest
import shapely
from hypothesis import example, given, settings
from hypothesis import strategies as st

from tests.derive.meetings import NORTH, across, east, line, mirrored, same
from tests.scenes import Actor, Road, derived, drive, moving, rows, seconds, standing, tee, times

if TYPE_CHECKING:
    from collections.abc import Callable

    from drivelint.engine.batch import Drive
    from tests.scenes import Row


SOUTH = line(-math.pi / 2)


def conflicts(*actors: Actor, **options: object) -> list[Row]:
    con = derived(drive(actors, None, **options), tables=["conflict"])  # type: ignore[arg-type]
    return rows(con, "FROM conflict ORDER BY ego_id, occurrence")


def test_the_other_crosses_behind_the_ego() -> None:
    """Boxes 4.8 m x 1.8 m at right angles: each is on the shared 1.8 m square while its centre is within 3.3 m of it."""
    t = times(12)
    (row,) = conflicts(east(), across(-40 + 5 * t))
    # ego's centre at 10 (t - 5), on it for |x| <= 3.3; the other's at 5 (t - 8)
    assert seconds([row], "t_ego_in_ns") == [pytest.approx(4.7)]
    assert seconds([row], "t_ego_out_ns") == [pytest.approx(5.3)]
    assert seconds([row], "t_object_in_ns") == [pytest.approx(7.4)]
    assert seconds([row], "t_object_out_ns") == [pytest.approx(8.6)]
    assert row["pet_s"] == pytest.approx(8 - 3.3 / 5 - (5 + 3.3 / 10))
    assert (row["ego_first"], row["occurrence"], row["actor_class"]) == (True, 0, "car")
    assert row["angle_rad"] == pytest.approx(math.pi / 2)
    assert (row["ego_speed_mps"], row["speed_mps"]) == (pytest.approx(10), pytest.approx(5))
    assert row["decel_mps2"] == pytest.approx(0, abs=1e-6)
    assert (row["junction_id"], row["crossing_id"]) == (None, None)


@pytest.mark.parametrize(("degrees", "n"), [(15, 0), (25, 1), (155, 1), (180, 1)])
def test_ways_that_run_along_each_other_do_not_cross(degrees: float, n: int) -> None:
    """Oncoming in the ego's own lane, some seconds later, is a conflict at 180 degrees."""
    way = line(math.radians(degrees))
    t = times(12)
    found = conflicts(east(), across(-100 + 10 * t if degrees < 180 else -90 + 10 * t, way=way))
    assert len(found) == n
    if n:
        assert abs(found[0]["angle_rad"]) == pytest.approx(math.radians(degrees), abs=1e-6)


def test_oncoming_in_the_next_lane_is_no_conflict() -> None:
    way = line(math.pi, 0.0, 3.5)
    assert not conflicts(east(), across(-50 + 10 * times(12), way=way))


def test_a_follower_in_a_tight_bend_is_no_conflict() -> None:
    """Its box lies across that of the ego of half a second before, at 45 degrees; its way is the ego's own."""
    bend = Road(None, ((50.0, 0.0), (9.4, 1 / 6), (50.0, 0.0)))  # type: ignore[arg-type]
    t = times(14)
    ego, other = moving("ego", bend, t, 20 + 5 * t, 0.0), moving("other", bend, t, 8 + 5 * t, 0.0)
    assert not conflicts(ego, other)


def test_merging_onto_the_egos_way_is_a_conflict_while_it_is_at_an_angle() -> None:
    """The other comes in behind the ego: from 90 degrees into the same lane."""
    side = Road(None, ((40.0, 0.0), (5 * math.pi, -0.1), (300.0, 0.0)), (-10.0, -50.0, math.pi / 2))  # type: ignore[arg-type]
    t = times(14)
    other = moving("other", side, t, 5 * t, 0.0)
    (row,) = conflicts(east(s0=-65.0, end=14), other)
    assert row["ego_first"] is True
    # the other's front corner reaches the ego's side (y = -0.9) on the bend, its heading still well off
    assert 0.4 < abs(row["angle_rad"]) < 1.2
    between = (row["t_object_in_ns"] - row["t_ego_out_ns"]) / 1e9
    assert between - 0.2 <= row["pet_s"] <= between


def test_parked_across_the_way_is_no_partner_but_a_walker_who_pauses_is() -> None:
    t = times(12)
    parked = standing("parked", NORTH, t, 0.0, 0.0)
    there = east(v=1.0, s0=-20.0)  # stops nowhere, yet touches nobody within the log but by 4 m
    assert not conflicts(there, parked)
    # walks onto the ego's way, stands there until 3 s and walks on
    s = np.interp(t, [0, 1, 3, 6], [-3, 0, 0, 5])
    walker = moving("walker", NORTH, t, s, 0.0, length=0.5, width=0.5, kind="pedestrian")
    (row,) = conflicts(east(v=10.0, s0=-70.0), walker)
    assert row["ego_first"] is False
    assert row["actor_class"] == "pedestrian"


def test_a_walker_goes_where_they_go_whichever_way_they_are_turned() -> None:
    t = times(12)
    walker = moving("w", NORTH, t, -8 + 1.4 * t, 0.0, length=0.5, width=0.5, kind="pedestrian")
    turned = Actor(**{**walker.__dict__, "yaw": np.zeros(t.shape)})
    (row,) = conflicts(east(), turned)
    assert row["angle_rad"] == pytest.approx(math.pi / 2)


def test_two_encounters_with_the_same_actor_are_two_rows() -> None:
    """Ahead of the ego and, turned round, behind it again, both within ten seconds of the ego's passing."""
    t = times(20)
    s = np.interp(t, [0, 2, 6, 12, 20], [-10, 10, 14, 14, -26])
    found = conflicts(east(s0=-70.0, end=20), moving("other", NORTH, t, s, 0.0))
    assert [row["ego_first"] for row in found] == [False, True]
    assert [row["occurrence"] for row in found] == [0, 1]
    assert all(row["pet_s"] > 0 for row in found)


def test_out_of_the_egos_way_and_back_into_it_are_two_places() -> None:
    """A car ahead swerves out of the lane and, past an obstacle, back in: the ego gets to each place after it."""
    t = times(16)
    s = -30 + 10 * t
    out, back = np.clip((s - 20) / 8, 0, 1), np.clip((s - 34) / 8, 0, 1)
    d = 3.5 * (out * out * (3 - 2 * out) - back * back * (3 - 2 * back))
    ego = east(s0=-50.0, end=16)
    found = conflicts(ego, moving("other", line(), t, s, d))
    assert len(found) == 2
    assert all(row["pet_s"] > 0.5 for row in found)
    assert found[0]["angle_rad"] > 0.35 > -0.35 > found[1]["angle_rad"]


def test_a_log_of_few_samples_misses_nobody() -> None:
    """At 1 Hz and 30 m/s every car jumps over six car lengths."""
    t = times(12, period=1.0)
    ego = moving("ego", line(), t, -165 + 30 * t, 0.0)
    assert len(conflicts(ego, moving("other", NORTH, t, -165 + 30 * (t - 2), 0.0))) == 1
    assert not conflicts(ego, moving("other", line(math.pi / 2, 250.0), t, -165 + 30 * (t - 2), 0.0))


def test_every_ego_and_every_drive_for_itself() -> None:
    t = times(12)
    first, second = across(-40 + 5 * t), across(-36 + 5 * t, name="third", way=line(math.pi / 2, 30.0))
    one = drive([east(), first, second], None, egos=("ego", "other"))
    two = drive([east(v=8.0), first], None, drive_id="e")
    con = derived(one, two, tables=["conflict"])
    found = rows(con, "FROM conflict ORDER BY drive_id, ego_id, occurrence")
    assert [(r["drive_id"], r["ego_id"], r["object_id"]) for r in found] == [
        ("d", "ego", "other"), ("d", "ego", "third"), ("d", "other", "ego"), ("e", "ego", "other"),
    ]  # fmt: skip
    assert [r["occurrence"] for r in found] == [0, 1, 0, 0]
    assert found[0]["pet_s"] == found[2]["pet_s"]
    assert found[0]["angle_rad"] == pytest.approx(-found[2]["angle_rad"])
    assert (found[0]["ego_first"], found[2]["ego_first"]) == (True, False)
    alone = derived(two, tables=["conflict"])
    assert rows(alone, "FROM conflict") == [found[3]]


def test_the_junction_in_which_they_meet() -> None:
    way = tee()["straight"]
    t = times(20)
    ego = moving("ego", way, t, 150 + 10 * t, way.own)
    other = moving("other", line(math.pi / 2, 210.0), t, -20 + 5 * (t - 5), 0.0)
    late = moving("late", line(math.pi / 2, 260.0), t, -20 + 5 * (t - 10), 0.0)
    con = derived(drive([ego, other, late], way.environment), tables=["conflict"])
    found = rows(con, "FROM conflict ORDER BY occurrence")
    assert [(r["object_id"], r["junction_id"]) for r in found] == [("other", "5"), ("late", None)]


class Meeting(NamedTuple):
    """The ego goes east; the other comes at an angle, both at constant speeds, and crosses its way some seconds later."""

    degrees: int
    ego_v: int
    other_v: int
    delay: float
    length: float
    width: float

    @property
    def heading(self) -> float:
        return math.radians(self.degrees)

    def other(self, t: np.ndarray) -> np.ndarray:
        """Return where its centre is at each time: (n, 2)."""
        s = self.other_v * (t - 20 - self.delay)
        return np.stack([s * math.cos(self.heading), s * math.sin(self.heading)], axis=1)

    def ego(self, t: np.ndarray) -> np.ndarray:
        return np.stack([self.ego_v * (t - 20), 0 * t], axis=1)

    def drive(self, drive_id: str) -> Drive:
        t = times(40)
        x, y = self.other(t).T
        v = np.full(t.shape, float(self.other_v))
        other = Actor(
            "other", t, x, y, np.full(t.shape, self.heading), v * math.cos(self.heading), v * math.sin(self.heading),
            length=self.length, width=self.width,
        )  # fmt: skip
        return drive(
            [moving("ego", line(), t, self.ego_v * (t - 20), 0.0), other],
            None,
            drive_id=drive_id,
            egos=("ego", "other"),
        )


def boxes(centres: np.ndarray, heading: float, length: float, width: float) -> np.ndarray:
    """Return the box around every centre."""
    u, v = np.array([math.cos(heading), math.sin(heading)]), np.array([-math.sin(heading), math.cos(heading)])
    corners = [a * length / 2 * u + b * width / 2 * v for a, b in ((1, 1), (-1, 1), (-1, -1), (1, -1))]
    return np.asarray(shapely.polygons(centres[:, None, :] + np.array(corners)))


def ground(swept: np.ndarray) -> shapely.Geometry:
    """Return what a box covers that goes straight on: the hull of where it begins and ends."""
    hull: shapely.Geometry = shapely.convex_hull(shapely.union(swept[0], swept[-1]))
    return hull


meetings = st.builds(
    lambda degrees, ego_v, other_v, delay, size: Meeting(degrees, ego_v, other_v, delay, *size),
    st.one_of(st.integers(25, 155), st.integers(-155, -25)),
    st.integers(4, 20),
    st.integers(1, 15),
    st.floats(-6, 6),
    st.sampled_from([(4.8, 1.8), (0.6, 0.6), (12.0, 2.5), (1.8, 0.6)]),
)


@pytest.mark.slow
@settings(max_examples=3)
@given(st.lists(meetings, min_size=14, max_size=14))
@example([Meeting(90, 10, 10, 0.0, 4.8, 1.8)])
@example([Meeting(27, 20, 1, 0.0, 0.6, 0.6)])  # the ego goes 2 m a sample, over a box of 0.6 m
def test_the_times_are_those_of_the_swept_polygons(found: list[Meeting]) -> None:
    """Entry and exit by shapely: first and last moment that a box touches the ground that the other's covers; whoever is the ego.

    Each meeting is a drive of its own, all derived at once.
    """
    con = derived(*(each.drive(f"{no:02}") for no, each in enumerate(found)), tables=["conflict"])
    told = rows(con, "FROM conflict ORDER BY drive_id, ego_id")
    assert [(row["drive_id"], row["ego_id"]) for row in told] == [
        (f"{no:02}", who) for no in range(len(found)) for who in ("ego", "other")
    ]
    for each, row, turned in zip(found, told[::2], told[1::2], strict=True):
        as_swept(each, row)
        assert mirrored(row) == same(turned), each


def touching(each: Meeting, place: Callable[[np.ndarray], np.ndarray], on: shapely.Geometry) -> tuple[float, float]:
    """Return the first and the last moment that this box touches that ground, to a millisecond."""
    heading, length, width = (0.0, 4.8, 1.8) if place == each.ego else (each.heading, each.length, each.width)

    def touches(t: np.ndarray) -> np.ndarray:
        found: np.ndarray = t[shapely.intersects(boxes(place(t), heading, length, width), on)]
        return found

    coarse = touches(np.arange(0, 40.001, 0.02))
    fine = np.arange(-0.02, 0.0201, 0.001)
    return float(touches(coarse[0] + fine)[0]), float(touches(coarse[-1] + fine)[-1])


def as_swept(each: Meeting, row: Row) -> None:
    """Hold that the conflict has the times of the polygons."""
    ends = np.array([0.0, 40.0])
    on_ego = touching(each, each.ego, ground(boxes(each.other(ends), each.heading, each.length, each.width)))
    on_other = touching(each, each.other, ground(boxes(each.ego(ends), 0.0, 4.8, 1.8)))
    pet = max(on_ego[0], on_other[0]) - min(on_ego[1], on_other[1])
    times_ = [row[f"t_{who}_{end}_ns"] / 1e9 for who in ("ego", "object") for end in ("in", "out")]
    # a sample of 10 Hz at most, and where the ends of two slender boxes barely touch one more of the other's
    tolerance = 0.13 + 0.1 * max(each.ego_v / each.other_v, each.other_v / each.ego_v)
    if max(on_ego[1], on_other[1]) - min(on_ego[0], on_other[0]) < 10:  # pairs more than ten seconds apart are left out
        assert times_ == pytest.approx([*on_ego, *on_other], abs=tolerance), each
    assert row["pet_s"] == pytest.approx(pet, abs=0.0025), each  # the polygons' moments are whole milliseconds
    assert row["pet_at_most"] is False
    assert row["ego_first"] == (row["t_ego_in_ns"] <= row["t_object_in_ns"]), each
    assert row["angle_rad"] == pytest.approx(each.heading), each
