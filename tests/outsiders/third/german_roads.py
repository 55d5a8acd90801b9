"""Germany: roads and junctions."""

from __future__ import annotations

import math

from tests.outsiders.third.cast import VAN, overtaker
from tests.outsiders.third.crossroads import junction, through
from tests.outsiders.third.drive import Drive, draw
from tests.outsiders.third.maps import START, bridge, curve, straight, town
from tests.outsiders.third.movement import KMH, N, car, ego, who
from tests.outsiders.third.ways import EAST, WEST, Way


def german_roads() -> list[Drive]:
    passing = [(3, N), (5, 0.5), (11, 0.5), (13, N)]
    bend, bend_way = curve(40, 50 * KMH)
    bus = who("bus", "bus", EAST, (0, 40), [(0, 0), (12, 0), (15, 5)])
    return [
        draw(
            "de_country_road_120",
            "The ego drives 120 km/h on a country road without a sign.",
            "fail stvo.rg3",
            straight(limit=None),
            [ego(EAST, (0, 0), 120 * KMH)],
            12,
            area="open",
        ),
        draw(
            "de_stop_sign_rolled",
            "The ego rolls past a stop sign at 13 km/h.",
            "fail stvo.rin1",
            junction(stop="SN", limit=50 * KMH, country="de"),
            [ego(through("S", "ahead"), (6, -1), [(0, 9), (5, 3.5), (7, 3.5), (12, 9)])],
            14,
        ),
        draw(
            "de_stop_sign_kept_3",
            "The ego stands for four seconds at a stop sign, then crosses behind a car.",
            "pass stvo.rin1 performance.precise-stop no-collision criticality.pet",
            junction(stop="SN", limit=50 * KMH, country="de"),
            [
                ego(through("S", "ahead"), (6, -3.95), [(0, 9), (5, 0), (9.6, 0), (14, 6)]),
                car(through("E", "ahead"), (6, 0), 12),
            ],
            18,
        ),
        draw(
            "de_cyclist_close",
            "The ego passes a cyclist in a town with less than a metre between.",
            "fail stvo.s5-passing",
            town(50 * KMH),
            [ego(EAST, (0, -40), 12.5, passing), who("cyclist", "bicycle", EAST, (0, 30), 4, 2.6)],
            15,
            area="built_up",
        ),
        draw(
            "de_cyclist_country_road",
            "The ego passes a cyclist on a country road with 1.3 m between.",
            "fail stvo.s5-passing",
            straight(limit=100 * KMH),
            [
                ego(EAST, (0, -60), 20, [(2, N), (4, 0.1), (8, 0.1), (10, N)]),
                who("cyclist", "bicycle", EAST, (0, 30), 5, 2.6),
            ],
            13,
            area="open",
        ),
        draw(
            "de_cyclist_with_room",
            "The ego passes a cyclist in a town with 1.9 m between.",
            "pass stvo.s5-passing stvo.rg3 no-collision",
            town(50 * KMH),
            [
                ego(EAST, (0, -40), 12.5, [(3, N), (5, -0.5), (11, -0.5), (13, N)]),
                who("cyclist", "bicycle", EAST, (0, 30), 4, 2.6),
            ],
            19,
            area="built_up",
        ),
        draw(
            "de_cyclist_beside_queue",
            "A cyclist draws up beside the standing ego and both set off.",
            "not fail stvo.s5-passing criticality.thw | pass no-collision",
            town(50 * KMH),
            [
                ego(EAST, (0, 30), [(0, 0), (13, 0), (17, 4.5)], 1.4),
                bus,
                who("cyclist", "bicycle", EAST, (8, 30), [(0, 4), (6, 4), (8, 0), (13.5, 0), (16, 3)], 3.0),
            ],
            20,
            area="built_up",
        ),
        draw(
            "de_hard_corner",
            "The ego takes a bend of 40 m radius at 14 m/s.",
            "fail comfort.lateral",
            bend,
            [ego(bend_way, (6, 0), 14, 1.75)],
            13,
        ),
        draw(
            "de_crosses_close",
            "The ego crosses another car's way less than a second before it.",
            "fail criticality.pet",
            junction(limit=50 * KMH),
            [ego(through("S", "ahead"), (6, 0), 10), car(through("W", "ahead"), (8.05, 8.25), 12)],
            11,
        ),
        draw(
            "de_bridge",
            "The ego drives under a bridge while a car drives over it.",
            "pass no-collision | not fail criticality.pet contact-signature",
            bridge(),
            [ego(EAST, (5, 0), 15, z=0.75), car(Way(0, -START, math.pi / 2, [(600, 0)], START), (5, 0), 15, z=6.75)],
            10,
        ),
        draw(
            "de_overtake_head_on",
            "The ego overtakes a van and runs into an oncoming car.",
            "fail rss.opposite",
            straight(limit=100 * KMH),
            [overtaker(), VAN, car(WEST, (13.2, -295), 22)],
            20,
        ),
    ]
