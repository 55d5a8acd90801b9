"""Laws of motion in scenes: speed is along the path, places are where the road is, what touches stops."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tests.demo.actors import car, cyclist
from tests.demo.line import Line, left, right, straight
from tests.demo.motion import TICKS_PER_S, actor_track, separation
from tests.demo.road import LANE_WIDTH_M, Handedness, Road
from tests.demo.scene import lane_departure, place_oncoming

HANDS: tuple[Handedness, ...] = ("left", "right")
S_BEND = Road((straight(60.0), left(80.0, radius=100.0), right(80.0, radius=60.0), straight(300.0)))


@pytest.mark.parametrize("hand", HANDS)
def test_the_nearside_is_the_side_that_is_driven_on(hand: Handedness) -> None:
    road, side = S_BEND.driven_on_the(hand), 1 if hand == "left" else -1
    ego = actor_track(car().starts(10.0).drives(10.0).signals("offside", 1.0, 2.0), road, 3.0)
    assert ego.y[0] * side == pytest.approx(LANE_WIDTH_M / 2)
    assert set(ego.light) == {"off", "right" if hand == "left" else "left"}
    assert ego.light[999] == ego.light[2000] == "off"
    assert ego.light[1000] == ego.light[1999] != "off"
    oncoming = actor_track(car().starts(10.0, lane=-1, nearside_m=0.5).drives(10.0), road, 1.0)
    assert oncoming.y[0] * side == pytest.approx(-LANE_WIDTH_M / 2 - 0.5)  # its own nearside
    assert abs(oncoming.yaw[0]) == pytest.approx(math.pi)


def test_speeds_change_at_the_rate_said_and_brake_lights_tell() -> None:
    who = car().drives(10.0).then_drives(4.0, at_s=1.0, rate=3.0).then_drives(12.0, at_s=4.0, rate=2.0)
    track = actor_track(who, S_BEND, 10.0)
    at = {t: float(track.speed[t * TICKS_PER_S]) for t in range(11)}
    assert at == pytest.approx({0: 10, 1: 10, 2: 7, 3: 4, 4: 4, 5: 6, 6: 8, 7: 10, 8: 12, 9: 12, 10: 12})
    lit = np.flatnonzero(track.brakes) / TICKS_PER_S
    assert (lit.min(), lit.max()) == pytest.approx((1.0, 3.0), abs=0.01)


def test_boxes_apart_are_as_far_apart_as_shapely_says() -> None:
    shapely = pytest.importorskip("shapely")
    road = Road((straight(60.0), left(200.0, radius=40.0)))
    ego = car().starts(0.0).drives(12.0).moves_out(3.0, at=10.0, within=15.0)
    other = cyclist().starts(30.0, nearside_m=0.5).drives(3.0)
    a, b = actor_track(ego, road, 6.0), actor_track(other, road, 6.0)
    sat = separation(a, b)
    for k in range(0, 6001, 50):
        boxes = []
        for track in (a, b):
            body, c, s = track.actor.body, math.cos(track.yaw[k]), math.sin(track.yaw[k])
            u, w = np.array([1, 1, -1, -1]) * body.length_m / 2, np.array([1, -1, -1, 1]) * body.width_m / 2
            boxes.append(shapely.Polygon(np.column_stack([track.x[k] + c * u - s * w, track.y[k] + s * u + c * w])))
        assert (sat[k] <= 0) == boxes[0].intersects(boxes[1])
        assert sat[k] <= boxes[0].distance(boxes[1]) + 1e-9


@pytest.mark.parametrize("ahead", [25.0, 80.0, 140.5])
def test_an_oncoming_car_is_as_far_ahead_as_asked_when_the_ego_departs(ahead: float) -> None:
    road = Road((straight(500.0),))
    ego = car().starts(10.0).drives(9.0).moves_out(3.5, at=60.0, within=20.0)
    left_at = lane_departure(ego, road, 10.0)
    other = place_oncoming(car().drives(7.0), left_at, ahead_m=ahead)
    track = actor_track(other, road, 10.0)
    front = track.station[round(left_at.t_s * TICKS_PER_S)] - 2.4
    assert front - left_at.front == pytest.approx(ahead, abs=1e-6)


def test_an_ego_that_stays_never_departs() -> None:
    with pytest.raises(ValueError, match="never leaves"):
        lane_departure(car().drives(9.0), Road((straight(500.0),)), 5.0)


def test_a_line_is_cut_and_continued_where_it_was() -> None:
    line = S_BEND.line
    part = line.cut(30.0, 170.0)
    assert part.length_m == pytest.approx(140.0)
    for s in (0.0, 30.0, 77.0, 140.0):
        assert part.pose(s) == pytest.approx(line.pose(30.0 + s))
    longer = Line((straight(10.0),)).then(left(10.0, radius=5.0))
    assert longer.pose(20.0).heading == pytest.approx(2.0)
