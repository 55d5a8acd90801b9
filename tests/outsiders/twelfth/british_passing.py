"""Great Britain: cyclists, horses, parked vans, contact, parking and keeping to the road."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.twelfth.cast import (
    GB,
    N1,
    O1,
    ego,
)
from tests.outsiders.twelfth.drive import Actor, Drive, draw
from tests.outsiders.twelfth.maps import (
    dual,
    rural,
    town,
)
from tests.outsiders.twelfth.ways import Straight


def british_passing() -> Iterator[Drive]:
    yield draw(
        "gb_cyclist_fast_17",
        rural(),
        [ego(Straight(60, N1, 22, moves=[(1, 2, 0.1), (8, 2, N1)])), Actor("b", "bicycle", Straight(150, 3.0, 5.5))],
        GB,
        15,
        [("ukhc.r163.cyclist", "fail", "1.7 m at 49 mph where more than 1.5 m (2 m) is due")],
    )
    yield draw(
        "gb_horse_at_speed",
        rural(),
        [ego(Straight(60, N1, 9, moves=[(3, 3, -1.3), (15, 2.5, N1)])), Actor("h", "animal", Straight(125, 2.6, 1.6))],
        GB,
        20,
        [("ukhc.r215.horse", "fail", "2.6 m, but at 20 mph where 10 mph is the most")],
    )
    yield draw(
        "gb_van_no_give_way",
        town(),
        [
            ego(Straight(120, N1, 11, moves=[(4.5, 2, -1.4), (9, 2, N1)])),
            Actor("p", "van", Straight(200, 1.9, 0)),
            Actor("o", "car", Straight(340, O1, [(0, 12), (5, 12), (8, 0), (12, 0), (15, 8)], way=-1)),
        ],
        GB,
        18,
        [
            (
                "ukhc.r163.obstruction-give-way",
                "fail",
                "goes round the van, the oncoming car brakes with 4 m/s2 and has to wait",
            )
        ],
    )
    yield draw(
        "gb_van_waited",
        town(),
        [
            ego(Straight(120, N1, [(0, 10), (4, 10), (8, 0), (15, 0), (18, 6)], moves=[(15.2, 3, -1.5), (22, 3, N1)])),
            Actor("p", "van", Straight(200, 1.9, 0)),
            Actor("o", "car", Straight(330, O1, 11, way=-1)),
        ],
        GB,
        30,
        [
            ("ukhc.r163.obstruction-give-way", "not fail", "waits behind the van until the oncoming car is past"),
            ("ukhc.no-collision", "pass", "clear"),
        ],
    )
    yield draw(
        "gb_wrong_side_noise_2hz",
        rural(),
        [ego(Straight(20, N1, 13, moves=[(1, 2, O1)]), noise=0.05), Actor("o", "car", Straight(850, N1, 0.0))],
        GB,
        30,
        [
            (
                "ukhc.r143.direction",
                "fail",
                "27 s in the opposing lane at 13 m/s, 2 Hz and noise; a car stands 400 m further on",
            )
        ],
        hz=2,
    )
    yield draw(
        "gb_pavement_run",
        town(),
        [
            ego(Straight(30, N1, 9.5, moves=[(4, 2, 4.6), (10, 2, N1)])),
            Actor("q1", "car", Straight(100, N1, 0)),
            Actor("q2", "car", Straight(108, N1, 0)),
        ],
        GB,
        16,
        [("ukhc.r145.off-road", "fail", "past a queue on the pavement at 21 mph")],
    )
    yield draw(
        "gb_astride_lanes",
        dual(),
        [ego(Straight(20, 2 + 3.65 * 1.5, 24, moves=[(2, 3, 2 + 3.65), (14, 3, 2 + 3.65 * 1.5)]))],
        GB,
        35.0,
        [
            ("ukhc.r131.keep-in-lane", "fail", "12 s astride the lane line"),
            ("ukhc.r124.speed-limit", "pass", "24 m/s on 70 mph"),
        ],
    )
    yield draw(
        "gb_rear_end",
        town(),
        [
            ego(Straight(60, N1, [(0, 12), (8, 12), (8.15, 6.5), (10, 0)])),
            Actor("l", "car", Straight(96.6, N1, [(0, 9), (5, 9), (8, 3.5), (8.2, 7.0), (11, 0)])),
        ],
        GB,
        15,
        [
            ("ukhc.no-collision", "fail", "runs into the braking car ahead"),
            ("criticality.ttc", "fail", "under 1.5 s to collision before"),
        ],
        hz=20,
    )
    yield draw(
        "gb_bump_unboxed",
        town(),
        [ego(Straight(60, N1, [(0, 8), (5.9, 8), (5.98, 0.3), (6.1, 0)])), Actor("l", "van", Straight(112.8, N1, 0))],
        GB,
        12,
        [
            ("ukhc.contact-signature", "fail", "loses 7.7 m/s in 0.08 s at the standing van's back"),
            ("criticality.ttc", "fail", "closes in at 8 m/s to under a metre"),
        ],
        hz=20,
    )
    yield draw(
        "gb_teleport_through",
        town(),
        [ego(Straight(60, N1, 10)), Actor("l", "car", Straight(100, N1, 4), gaps=[(5.0, 9.0)])],
        GB,
        14,
        [
            (
                "ukhc.no-collision",
                "not pass",
                "not seen from 5 to 9 s, the car is then behind the ego in the same lane: it went through it or round",
            )
        ],
    )
    yield draw(
        "gb_parked_facing",
        town(),
        [ego(Straight(60, N1, [(0, 7), (4, 7), (8, 0)], moves=[(2, 4, -2.4)]), ind=[(0, "right"), (7, "off")])],
        {"nation": "gb", "light": "night"},
        78,
        [
            ("ukhc.r239.parked-with-traffic", "fail", "stands 70 s facing against the traffic"),
            ("ukhc.r248.parked-at-night", "fail", "the same at night"),
        ],
        hz=2,
    )
