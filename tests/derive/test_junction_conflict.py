"""Where two ways cross or merge: who was on the shared ground, and when. No map is needed for that."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pytest
import shapely
from hypothesis import example, given, settings
from hypothesis import strategies as st

from tests.derive.meetings import east, line, mirrored, same
from tests.scenes import Actor, Road, derived, drive, moving, rows, times

if TYPE_CHECKING:
    from collections.abc import Callable

    from drivelint.engine.batch import Drive
    from tests.scenes import Row


def conflicts(*actors: Actor) -> list[Row]:
    con = derived(drive(actors, None), tables=["conflict"])
    return rows(con, "FROM conflict ORDER BY ego_id, occurrence")


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

    def other_centres(self, t: np.ndarray) -> np.ndarray:
        """Return where its centre is at each time: (n, 2)."""
        s = self.other_v * (t - 20 - self.delay)
        return np.stack([s * math.cos(self.heading), s * math.sin(self.heading)], axis=1)

    def ego_centres(self, t: np.ndarray) -> np.ndarray:
        return np.stack([self.ego_v * (t - 20), 0 * t], axis=1)

    def drive(self, drive_id: str) -> Drive:
        t = times(40)
        x, y = self.other_centres(t).T
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


MEETINGS = st.builds(
    lambda degrees, ego_v, other_v, delay, size: Meeting(degrees, ego_v, other_v, delay, *size),
    st.one_of(st.integers(25, 155), st.integers(-155, -25)),
    st.integers(4, 20),
    st.integers(1, 15),
    st.floats(-6, 6),
    st.sampled_from([(4.8, 1.8), (0.6, 0.6), (12.0, 2.5), (1.8, 0.6)]),
)


@pytest.mark.slow
@settings(max_examples=3)
@given(st.lists(MEETINGS, min_size=14, max_size=14))
@example([Meeting(90, 10, 10, 0.0, 4.8, 1.8)])
@example([Meeting(27, 20, 1, 0.0, 0.6, 0.6)])  # the ego goes 2 m a sample, over a box of 0.6 m
def test_the_times_are_those_of_the_swept_polygons(meetings: list[Meeting]) -> None:
    """Entry and exit by shapely: first and last moment that a box touches the ground that the other's covers; whoever is the ego.

    Each meeting is a drive of its own, all derived at once.
    """
    con = derived(*(each.drive(f"{no:02}") for no, each in enumerate(meetings)), tables=["conflict"])
    told = rows(con, "FROM conflict ORDER BY drive_id, ego_id")
    assert [(row["drive_id"], row["ego_id"]) for row in told] == [
        (f"{no:02}", who) for no in range(len(meetings)) for who in ("ego", "other")
    ]
    for each, row, turned in zip(meetings, told[::2], told[1::2], strict=True):
        as_swept(each, row)
        assert mirrored(row) == same(turned), each


def touching(meeting: Meeting, place: Callable[[np.ndarray], np.ndarray], on: shapely.Geometry) -> tuple[float, float]:
    """Return the first and the last moment that this box touches that ground, to a millisecond."""
    heading, length, width = (
        (0.0, 4.8, 1.8) if place == meeting.ego_centres else (meeting.heading, meeting.length, meeting.width)
    )

    def touches(t: np.ndarray) -> np.ndarray:
        found: np.ndarray = t[shapely.intersects(boxes(place(t), heading, length, width), on)]
        return found

    coarse = touches(np.arange(0, 40.001, 0.02))
    fine = np.arange(-0.02, 0.0201, 0.001)
    return float(touches(coarse[0] + fine)[0]), float(touches(coarse[-1] + fine)[-1])


def as_swept(meeting: Meeting, row: Row) -> None:
    """Hold that the conflict has the times of the polygons."""
    ends = np.array([0.0, 40.0])
    on_ego = touching(
        meeting,
        meeting.ego_centres,
        ground(boxes(meeting.other_centres(ends), meeting.heading, meeting.length, meeting.width)),
    )
    on_other = touching(meeting, meeting.other_centres, ground(boxes(meeting.ego_centres(ends), 0.0, 4.8, 1.8)))
    pet = max(on_ego[0], on_other[0]) - min(on_ego[1], on_other[1])
    times_ = [row[f"t_{who}_{end}_ns"] / 1e9 for who in ("ego", "object") for end in ("in", "out")]
    # a sample of 10 Hz at most, and where the ends of two slender boxes barely touch one more of the other's
    tolerance = 0.13 + 0.1 * max(meeting.ego_v / meeting.other_v, meeting.other_v / meeting.ego_v)
    if max(on_ego[1], on_other[1]) - min(on_ego[0], on_other[0]) < 10:  # pairs more than ten seconds apart are left out
        assert times_ == pytest.approx([*on_ego, *on_other], abs=tolerance), meeting
    assert row["pet_s"] == pytest.approx(pet, abs=0.0025), meeting  # the polygons' moments are whole milliseconds
    assert row["pet_at_most"] is False
    assert row["ego_first"] == (row["t_ego_in_ns"] <= row["t_object_in_ns"]), meeting
    assert row["angle_rad"] == pytest.approx(meeting.heading), meeting
