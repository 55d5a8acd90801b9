"""Lanes given by their bounds: geometry against shapely, roads made of what lies side by side, what cannot be built."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from drivelint.road.boundary_lanes import BoundedLane, build_lanes, lane_point_columns, side_driven_on
from drivelint.road.quality import MapQuality


def straight(
    name: str, y: float, *, back: bool = False, width: float = 3.5, length: float = 10.0, **more: object
) -> BoundedLane:
    """A lane along x whose middle is at y; `back`: driven towards -x."""
    left, right = (
        np.array([[0.0, y + width / 2], [length, y + width / 2]]),
        np.array([[0.0, y - width / 2], [length, y - width / 2]]),
    )
    if back:
        left, right = right[::-1], left[::-1]
    return BoundedLane(name, left, right, **more)  # type: ignore[arg-type]


def test_a_straight_lane() -> None:
    (lane,) = build_lanes([straight("1", 0.0)], (100.0, 50.0), MapQuality())
    assert np.allclose(lane.line.centre, np.array([(100, 50), (100 + 10 / 3, 50), (100 + 20 / 3, 50), (110, 50)]))
    assert np.allclose(lane.line.half_width, 1.75)
    assert np.allclose(lane.line.tangent, [1, 0])
    assert (lane.line.width, lane.line.area, lane.line.turn_rad) == pytest.approx((3.5, 35.0, 0.0))


@given(
    radius=st.floats(8, 200),
    angle=st.floats(0.2, 1.5),
    left=st.integers(5, 40),
    right=st.integers(5, 40),
    turn=st.sampled_from([1, -1]),
)
def test_an_arc_with_differently_many_points(radius: float, angle: float, left: int, right: int, turn: int) -> None:
    def bound(r: float, n: int) -> np.ndarray:
        a = np.linspace(0.0, angle, n)
        return np.column_stack([r * np.sin(a), turn * (radius - r * np.cos(a))])

    inner, outer = (radius - 1.75, radius + 1.75) if turn > 0 else (radius + 1.75, radius - 1.75)
    lane = BoundedLane("1", bound(inner, left), bound(outer, right))
    quality = MapQuality()
    (built,) = build_lanes([lane], (0.0, 0.0), quality)
    area = shapely.Polygon(np.vstack([lane.right, lane.left[::-1]])).area
    sagitta = (radius + 1.75) * (1 - np.cos(angle / (min(left, right) - 1) / 2))
    assert built.line.area == pytest.approx(area, rel=0.02)
    assert abs(built.line.s[-1] - radius * angle) < 0.02 * radius * angle + sagitta
    assert built.line.turn_rad == pytest.approx(turn * angle, abs=angle / 3)
    assert abs(built.line.width - 3.5) < 2 * sagitta + 0.05
    assert not quality.rows


def test_what_lies_side_by_side_is_one_road() -> None:
    lanes = build_lanes(
        [
            straight("10", -5.25, left_id="11", left_against=False),
            straight("11", -1.75, left_id="12", left_against=True, right_id="10", right_against=False),
            straight("12", 1.75, back=True, left_id="11", left_against=True, right_id="13", right_against=False),
            straight("13", 5.25, back=True, left_id="12", left_against=False),
            straight("20", 50.0),
        ],
        (0.0, 0.0),
        MapQuality(),
    )
    assert {lane.lanelet_id: (lane.road_id, lane.lane_no, lane.along) for lane in lanes} == {
        "10": ("r10", -2, 1),
        "11": ("r10", -1, 1),
        "12": ("r10", 1, -1),
        "13": ("r10", 2, -1),
        "20": ("r20", -1, 1),
    }
    assert side_driven_on(lanes) == "rht"
    points = lane_point_columns(lanes)
    last = np.array(points["lanelet_id"]) == "13"
    assert points["road_s_m"][last].tolist() == pytest.approx([10, 20 / 3, 10 / 3, 0])


def test_the_left_is_driven_on_where_the_oncoming_lane_is_on_the_right() -> None:
    one, other = (
        straight("1", 0.0, right_id="2", right_against=True),
        straight("2", -3.5, right_id="1", right_against=True),
    )
    assert side_driven_on(build_lanes([one, other], (0.0, 0.0), MapQuality())) == "lht"
    assert side_driven_on(build_lanes([straight("1", 0.0)], (0.0, 0.0), MapQuality())) is None
    other.bidirectional = True  # beside a lane that is driven both ways nothing is said
    assert side_driven_on([one, other]) is None


@pytest.mark.parametrize(
    ("left", "right", "why"),
    [
        ([[0, 1]], [[0, -1], [9, -1]], "fewer than two points"),
        ([[0, 1], [float("nan"), 1]], [[0, -1], [9, -1]], "an impossible coordinate"),
        ([[0, 1], [0, 1]], [[0, -1], [0, -1]], "no length"),
        ([[0, -1], [9, -1]], [[0, 1], [9, 1]], "on the right of its right bound"),
        ([[0, 100], [9, 100]], [[0, -1], [9, -1]], "101 m wide"),
        ([[0, 1], [9, 1], [0, 1]], [[0, -1], [9, -1], [0, -1]], "turns back on itself"),
    ],
)
def test_a_lane_that_cannot_be_built_is_named_and_nobody_leads_to_it(left: list, right: list, why: str) -> None:  # type: ignore[type-arg]
    quality = MapQuality()
    bad = BoundedLane("7", np.array(left, float), np.array(right, float))
    (good,) = build_lanes(
        [straight("1", 0.0, successors=("7",), left_id="7", left_against=False), bad], (0.0, 0.0), quality
    )
    assert (good.successors, good.left_id, good.left_against) == ((), None, None)
    assert [(row["check_id"], row["lanelet_id"]) for row in quality.rows] == [
        ("invalid_lane", "7"),
        ("missing_link", "1"),
    ]
    assert why in quality.rows[0]["message"]


def test_a_lane_of_points_every_few_millimetres_is_a_lane() -> None:
    x = np.arange(0.0, 10.0001, 0.004)
    lane = BoundedLane("1", np.column_stack([x, 1.75 + 0.0 * x]), np.column_stack([x, -1.75 + 0.0 * x]))
    quality = MapQuality()
    (built,) = build_lanes([lane], (0.0, 0.0), quality)
    assert (built.line.length, built.line.width) == pytest.approx((10.0, 3.5))
    assert not quality.rows


def test_a_corner_that_is_drawn_by_two_near_points_keeps_both() -> None:
    left = np.array([[0.0, 1.5], [5.0, 1.5], [5.006, 1.499], [10.0, 0.5]])
    lane = BoundedLane("1", left, left - [0.0, 3.0])
    (built,) = build_lanes([lane], (0.0, 0.0), MapQuality())
    assert shapely.distance(shapely.points(left), shapely.LineString(built.line.left)).max() < 1e-6


def test_a_hand_that_goes_back_by_millimetres_does_not_turn_a_lane_round() -> None:
    x = np.array([0.0, 5.0, 4.996, 10.0])
    lane = BoundedLane("1", np.column_stack([x, 1.75 + 0.0 * x]), np.column_stack([x, -1.75 + 0.0 * x]))
    quality = MapQuality()
    (built,) = build_lanes([lane], (0.0, 0.0), quality)
    assert np.allclose(built.line.tangent, [1, 0])
    assert not quality.rows
