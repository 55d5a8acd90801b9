"""The ego and everybody else: clearance, place on the corridor, samples of other times, coming and going, the lead."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import affinity
from shapely.geometry import Polygon, box

from tests.scenes import LANE, Actor, derived, drive, moving, road, rows, standing, times

ANGLE = st.floats(-math.pi, math.pi)
SIDE = st.floats(0.3, 20.0)
BOXES = st.tuples(st.floats(-45, 45), st.floats(-45, 45), ANGLE, SIDE, SIDE)


def outline(x: float, y: float, yaw: float, length: float, width: float) -> Polygon:
    upright = box(-length / 2, -width / 2, length / 2, width / 2)
    return affinity.translate(affinity.rotate(upright, yaw, origin=(0, 0), use_radians=True), x, y)


@pytest.mark.ci
@settings(max_examples=12, deadline=None)
@given(st.floats(0, 20), ANGLE, st.lists(BOXES, min_size=40, max_size=40))
def test_clearance_is_the_distance_between_the_boxes(
    far: float, yaw: float, other_boxes: list[tuple[float, ...]]
) -> None:
    """Forty boxes around one ego, near and far, apart and into each other."""
    t = np.array([0.0])
    zero = np.zeros(1)

    def still(name: str, place: tuple[float, ...]) -> Actor:
        x, y, heading, length, width = place
        return Actor(name, t, zero + x, zero + y, zero + heading, zero, zero, length, width)

    ego = (far * 100, -far, yaw, 4.8, 1.8)
    placed = [(x + ego[0], y + ego[1], *rest) for x, y, *rest in other_boxes]
    actors = [still("ego", ego), *(still(f"{n:02}", o) for n, o in enumerate(placed))]
    con = derived(drive(actors, None), tables=["pair"])
    found = rows(con, "FROM pair ORDER BY object_id")
    assert len(found) == 40
    for row, other in zip(found, placed, strict=True):
        a, b = outline(*ego), outline(*other)
        distance = a.distance(b)
        assert row["distance_m"] == pytest.approx(math.hypot(other[0] - ego[0], other[1] - ego[1]))
        if row["clearance_is_bound"]:
            assert 30.0 < row["clearance_m"] <= distance + 1e-6
        elif distance > 1e-9:
            assert row["clearance_m"] == pytest.approx(distance, abs=1e-6)
        else:
            depth = -row["clearance_m"]
            assert depth >= 0
            # moved apart by the depth along some axis they no longer overlap, by less they do along every one of them
            axes = [h + q for h in (ego[2], other[2]) for q in (0, math.pi / 2)]
            gaps = [
                affinity.translate(b, f * (depth + e) * math.cos(h), f * (depth + e) * math.sin(h)).intersection(a).area
                for h in axes
                for f in (1, -1)
                for e in (1e-6,)
            ]
            assert min(gaps) < 1e-9


@pytest.mark.parametrize("curvature", [1 / 80, -1 / 80])
def test_distance_along_a_bend_is_not_the_chord(curvature: float) -> None:
    """150 m of bend: bumper to bumper is the arc length of the ego's own lane, less both half lengths."""
    way = road(((50.0, 0.0), (250.0, curvature), (50.0, 0.0)))
    t = times(0.2)
    ego, other = standing("ego", way, t, 60, way.ego_d), moving("far", way, t, 210 - 5 * t, way.oncoming_d)
    con = derived(drive([ego, other], way.environment), tables=["pair", "oncoming"])
    row = rows(con, "SELECT p.*, e.front_s_m AS ego_front_m FROM pair p JOIN ego_state e USING (t_ns) ORDER BY t_ns")[0]
    arc = 150 * (1 - way.ego_d * curvature)
    # a box's ends stick out along the tangent, so the corners' stations are a hair short of the half length
    assert row["rear_s_m"] - row["ego_front_m"] == pytest.approx(arc - 4.8, abs=0.1)
    assert row["d_m"] == pytest.approx(LANE, abs=0.02)
    assert abs(row["heading_diff_rad"]) == pytest.approx(math.pi, abs=0.01)
    assert row["distance_m"] < arc - 15
    assert row["clearance_m"] <= row["distance_m"]
    assert rows(con, "FROM oncoming ORDER BY t_ns")[0]["da_m"] == pytest.approx(arc - 4.8, abs=0.1)
