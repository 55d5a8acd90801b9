"""Great Britain: speed, lanes, sides of the road."""

from __future__ import annotations

from tests.outsiders.eighth.drive import Drive, draw
from tests.outsiders.eighth.movement import car, ego
from tests.outsiders.eighth.road import Map
from tests.outsiders.eighth.worlds import lane, oncoming, straight, wrong_way


def british_driving() -> list[Drive]:
    return [
        draw(
            "gb_plain_rural_j",
            "The ego drives along a country road at 47 mph and meets a car in the other lane.",
            "pass r124.speed-limit no-collision r143.direction",
            Map((straight(1200),)),
            [
                ego(lane(1), 60, 21),
                car("on", oncoming(1200), 100, 22),
            ],
            30,
            weather="dry",
        ),
        draw(
            "gb_burst_over_limit_j",
            "The ego speeds up to 68 mph for some seconds where 60 is the limit.",
            "fail r124.speed-limit",
            Map((straight(900),)),
            [
                ego(lane(1), 40, [(0, 25), (8, 25), (11, 30.5), (14, 30.5), (18, 25)]),
            ],
            25,
        ),
        draw(
            "gb_goods_single_58mph_j",
            "A lorry over 7.5 t drives at 56 mph on a single carriageway.",
            "fail r124.speed-limit",
            Map((straight(900),)),
            [
                ego(lane(1), 40, 24.9, kind="truck"),
            ],
            20,
            vehicle_class="goods_over_7t5",
        ),
        draw(
            "gb_towing_dual_66_j",
            "A car with a trailer drives at 66 mph on a dual carriageway.",
            "fail r124.speed-limit",
            Map((straight(900, "dual"),)),
            [
                ego(lane(2), 40, 29.7),
            ],
            20,
            vehicle_class="car_towing",
        ),
        draw(
            "gb_20zone_2hz_j",
            "The ego drives at 25 mph in a 20 zone; the log has two steps a second.",
            "fail r124.speed-limit",
            Map((straight(700, "town", limit=20),)),
            [
                ego(lane(1), 30, 11.2),
            ],
            30,
            rate=2,
        ),
        draw(
            "gb_noise_29mph_j",
            "The ego follows a car at 26 mph; all positions tremble by 5 cm.",
            "pass r124.speed-limit | not fail r131.keep-in-lane contact-signature",
            Map((straight(700, "town"),)),
            [
                ego(lane(1), 30, 11.6, noise=0.05),
                car("l", lane(1), 75, 11.6, noise=0.05),
            ],
            30,
            rate=25,
        ),
        draw(
            "gb_astride_12s_j",
            "The ego is astride the lane line for 15 s without a reason.",
            "fail r131.keep-in-lane",
            Map((straight(900, "dual"),)),
            [
                ego(lane(2), 40, 24, [(3, 0), (5, -1.75), (20, -1.75), (22, 0)]),
            ],
            25,
        ),
        draw(
            "gb_wrong_side_long_j",
            "The ego is in the opposing lane for 18 s with nothing to pass.",
            "fail r143.direction",
            Map((straight(800),)),
            [
                ego(lane(1), 40, 15, [(3, 0), (6, -3.5), (24, -3.5), (27, 0)]),
            ],
            30,
        ),
        draw(
            "gb_mway_against_j",
            "The ego drives the wrong way on a motorway.",
            "fail r143.direction | not fail r263.no-reverse",
            Map((straight(1500, "motorway", lanes=3),)),
            [
                ego(wrong_way(3, 1500), 100, 24),
                car("a", lane(2), 300, 29),
            ],
            20,
        ),
        draw(
            "gb_wrong_way_other_j",
            "A wrong-way driver comes towards the ego, which gets out of its way.",
            "pass r143.direction no-collision",
            Map((straight(1200, "motorway", lanes=3),)),
            [
                ego(lane(2), 60, [(0, 29), (4, 29), (7, 22), (18, 22)], [(3.5, 0), (6.5, 3.5)]),
                car("ghost", wrong_way(2, 1200), 300, 30),
            ],
            18,
        ),
        draw(
            "gb_pavement_swerve_j",
            "The ego has its left wheels on the pavement for three seconds at 27 mph.",
            "fail r145.off-road",
            Map((straight(500, "town"),)),
            [
                ego(lane(1), 30, 12, [(5, 0), (7, 2.6), (10, 2.6), (12, 0)]),
            ],
            20,
        ),
        draw(
            "gb_pavement_access_j",
            "The ego crosses the pavement at walking pace to reach property.",
            "not fail r145.off-road",
            Map((straight(500, "town"),)),
            [
                ego(lane(1), 30, [(0, 10), (5, 10), (9, 2), (16, 2), (17, 0)], [(9, 0), (13, 3.4)]),
            ],
            25,
        ),
        draw(
            "gb_hazards_moving_j",
            "The ego drives in a town with its hazard lights on.",
            "fail r116.hazards",
            Map((straight(800, "town", limit=30),)),
            [
                ego(lane(1), 30, 11, blink=[(0, "off"), (5, "hazard"), (13, "off")]),
            ],
            20,
        ),
        draw(
            "gb_hazards_dual_queue_j",
            "The ego warns of a queue on an unrestricted dual carriageway and brakes for it in good time.",
            "not fail r116.hazards | pass criticality.ttc",
            Map((straight(900, "dual"),)),
            [
                ego(lane(2), 40, [(0, 29), (6, 29), (14, 6), (25, 6)], blink=[(0, "off"), (7, "hazard"), (14, "off")]),
                car("q", lane(2), 345, 6),
            ],
            25,
        ),
    ]
