"""The ego and everybody else: clearance, place on the corridor, samples of other times, coming and going, the lead."""

from __future__ import annotations

import math
from dataclasses import replace

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
def test_clearance_is_the_distance_between_the_boxes(far: float, yaw: float, others: list[tuple[float, ...]]) -> None:
    """Forty boxes around one ego, near and far, apart and into each other."""
    t = np.array([0.0])
    zero = np.zeros(1)

    def still(name: str, place: tuple[float, ...]) -> Actor:
        x, y, heading, length, width = place
        return Actor(name, t, zero + x, zero + y, zero + heading, zero, zero, length, width)

    ego = (far * 100, -far, yaw, 4.8, 1.8)
    placed = [(x + ego[0], y + ego[1], *rest) for x, y, *rest in others]
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


def test_a_box_that_is_not_known_has_no_clearance() -> None:
    way = road()
    t = times(0.5)
    ego = standing("ego", way, t, 100, way.own)
    others = [
        replace(standing("no-size", way, t, 110, way.own), length=None),
        replace(standing("no-heading", way, t, 120, way.own), yaw=np.full(len(t), np.nan)),
        standing("no-place", way, t, 130, way.own).lost(t >= 0),
    ]
    con = derived(drive([ego, *others], way.environment), tables=["pair", "unplaced", "lead"])
    found = rows(con, "SELECT DISTINCT object_id, clearance_m, s_m IS NULL AS nowhere FROM pair ORDER BY ALL")
    assert [tuple(row.values()) for row in found] == [
        ("no-heading", None, False),
        ("no-place", None, True),
        ("no-size", None, False),
    ]
    doubts = rows(con, "SELECT DISTINCT object_id, code FROM unplaced ORDER BY ALL")
    assert [tuple(row.values()) for row in doubts] == [
        ("no-heading", "no_heading"),
        ("no-place", "no_position"),
        ("no-size", "no_size"),
    ]
    assert not rows(con, "FROM lead")


@pytest.mark.parametrize("curvature", [1 / 80, -1 / 80])
def test_distance_along_a_bend_is_not_the_chord(curvature: float) -> None:
    """150 m of bend: bumper to bumper is the arc length of the ego's own lane, less both half lengths."""
    way = road(((50.0, 0.0), (250.0, curvature), (50.0, 0.0)))
    t = times(0.2)
    ego, other = standing("ego", way, t, 60, way.own), moving("far", way, t, 210 - 5 * t, way.other)
    con = derived(drive([ego, other], way.environment), tables=["pair", "oncoming"])
    row = rows(con, "SELECT p.*, e.front_s_m AS ego_front_m FROM pair p JOIN ego_state e USING (t_ns) ORDER BY t_ns")[0]
    arc = 150 * (1 - way.own * curvature)
    # a box's ends stick out along the tangent, so the corners' stations are a hair short of the half length
    assert row["rear_s_m"] - row["ego_front_m"] == pytest.approx(arc - 4.8, abs=0.1)
    assert row["d_m"] == pytest.approx(LANE, abs=0.02)
    assert abs(row["heading_diff_rad"]) == pytest.approx(math.pi, abs=0.01)
    assert row["distance_m"] < arc - 15
    assert row["clearance_m"] <= row["distance_m"]
    assert rows(con, "FROM oncoming ORDER BY t_ns")[0]["da_m"] == pytest.approx(arc - 4.8, abs=0.1)


def test_a_sample_of_another_time_is_moved_on_while_it_is_fresh() -> None:
    """The object is sampled every 0.5 s between the ego's 0.1 s steps: fresh for 0.25 s, then there but not placed."""
    way = road()
    t = times(4.0)
    ego = moving("ego", way, t, 50 + 10 * t, way.own)
    slow = times(3.55, 0.55, 0.5)
    other = moving("slow", way, slow, 200 - 8 * slow, way.other)
    con = derived(drive([ego, other], way.environment), tables=["pair", "unplaced"])
    found = {round(row["t_ns"] / 1e8): row for row in rows(con, "FROM pair")}
    assert sorted(found) == list(range(6, 36))
    for tenth, row in found.items():
        age = (tenth / 10 - 0.55) % 0.5
        if age < 0.26:
            assert row["x_m"] == pytest.approx(200 - 8 * tenth / 10)
            assert row["speed_mps"] == pytest.approx(8.0)
        else:
            assert row["x_m"] is None
            assert row["clearance_m"] is None
    doubts = {round(row["t_ns"] / 1e8) for row in rows(con, "FROM unplaced") if row["code"] == "no_position"}
    assert doubts == {k for k, row in found.items() if row["x_m"] is None}


def test_what_comes_the_other_way_round_a_ring_is_still_to_be_met() -> None:
    """Round a ring of 800 m it is 300 m behind the ego and 500 m ahead; towards the ego only the latter counts."""
    way = road(((800.0, 2 * math.pi / 800.0),), ring=True)
    t = times(0.2)
    ego = standing("ego", way, t, 100, way.own)
    con = derived(
        drive([ego, moving("ov", way, t, 600 - 5 * t, way.other)], way.environment),
        tables=["pair", "oncoming"],
    )
    stretch = 1 - way.own * 2 * math.pi / 800
    assert rows(con, "FROM oncoming ORDER BY t_ns")[0]["da_m"] == pytest.approx(500 * stretch - 4.8, abs=0.3)
    con = derived(drive([ego, standing("follower", way, t, 600, way.own)], way.environment), tables=["pair"])
    row = rows(con, "SELECT p.s_m - e.s_m AS ahead_m FROM pair p JOIN ego_state e USING (t_ns) ORDER BY t_ns")[0]
    assert row["ahead_m"] == pytest.approx(-300 * stretch, abs=0.3)


@pytest.mark.parametrize(
    ("length", "ring", "ego_m", "ov_m", "expected_m"),
    [
        (2000.0, False, 1500.0, 600.0, -900.0),
        (2000.0, False, 600.0, 1500.0, 900.0),
        (3000.0, True, 1000.0, 900.0, -100.0),  # 2.9 km ahead
        (3000.0, True, 1000.0, 2900.0, -1100.0),  # 1.9 km ahead
        (3000.0, True, 2500.0, 400.0, 900.0),
    ],
)
def test_an_oncoming_vehicle_that_has_passed_is_behind(
    length: float, ring: bool, ego_m: float, ov_m: float, expected_m: float
) -> None:
    way = road(((length, 2 * math.pi / length if ring else 0.0),), ring=ring)
    t = times(0.2)
    ego = standing("ego", way, t, ego_m, way.own)
    con = derived(
        drive([ego, standing("ov", way, t, ov_m, way.other, turned=math.pi)], way.environment), tables=["pair"]
    )
    stretch = 1 - way.own * 2 * math.pi / length if ring else 1.0
    row = rows(con, "SELECT p.s_m - e.s_m AS ahead_m FROM pair p JOIN ego_state e USING (t_ns) ORDER BY t_ns")[0]
    assert row["ahead_m"] == pytest.approx(expected_m * stretch, abs=0.5)


def test_the_other_leg_of_a_hairpin_is_not_beside_the_road() -> None:
    """Legs 11 m apart lie in each other's strip: an OV on the far leg is 120 m ahead, not beside the ego."""
    turn = math.pi * 5.5
    way = road(((100.0, 0.0), (turn, 1 / 5.5), (100.0, 0.0)))
    t = times(0.2)
    ego = standing("ego", way, t, 60, way.own)
    ov = moving("ov", way, t, 100 + turn + 40 - 5 * t, way.other)
    con = derived(drive([ego, ov], way.environment), tables=["pair", "oncoming"])
    row = rows(con, "SELECT p.* FROM pair p ORDER BY p.t_ns")[0]
    assert row["distance_m"] < 15
    assert row["d_m"] == pytest.approx(LANE, abs=0.05)
    along = 40 + turn + 40 - way.own * math.pi - 4.8  # the ego's lane is on the outside of the turn
    assert rows(con, "FROM oncoming ORDER BY t_ns")[0]["da_m"] == pytest.approx(along, abs=0.5)


def test_the_nearest_leads_and_people_do_not() -> None:
    way = road()
    t = times(0.3)
    ego = moving("ego", way, t, 100 + 10 * t, way.own)
    others = [
        moving("far", way, t, 180 + 10 * t, way.own),
        moving("near", way, t, 140 + 10 * t, way.own),
        standing("walker", way, t, 120, way.own, kind="pedestrian"),
    ]
    found = rows(derived(drive([ego, *others], way.environment), tables=["lead"]), "FROM lead")
    assert {row["object_id"] for row in found} == {"near"}
    assert all(row["gap_m"] == pytest.approx(35.2) for row in found)
    blind = [others[0], others[1].lost(t > 0.15), others[2]]
    found = rows(derived(drive([ego, *blind], way.environment), tables=["lead"]), "FROM lead ORDER BY t_ns")
    assert [row["object_id"] for row in found] == ["near", "near"]  # then it cannot be told: no row
