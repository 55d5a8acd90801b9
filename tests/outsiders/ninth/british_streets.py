"""Great Britain: children, parked cars, pavements and lamps."""

from __future__ import annotations

from tests.outsiders.ninth.drive import Drive, draw
from tests.outsiders.ninth.maps import country, opposite, own, town
from tests.outsiders.ninth.movement import ego, oncoming, who
from tests.outsiders.ninth.ways import straight


def british_streets() -> list[Drive]:
    """Return its drives."""
    return [
        draw(
            "gb_child_runs_out_k",
            "A child runs out, and the ego brakes hard and stops before it.",
            "pass no-collision r124.speed-limit | fail comfort.decel-iso15622",
            town(),
            [
                ego(own, 80, [(8, 12.5), (8.3, 10.9), (9.7, 0)]),
                who(
                    "child",
                    "pedestrian",
                    straight(198, -5.2, 198, 3.2),
                    0,
                    [(7.3, 0), (7.6, 3.2), (9.8, 3.2), (10.2, 0)],
                ),
            ],
            18,
        ),
        draw(
            "gb_child_is_hit_k",
            "A child runs out, and the ego brakes too late.",
            "fail no-collision",
            town(),
            [
                ego(own, 80, [(11.3, 10), (13, 0)]),
                who("child", "pedestrian", straight(200, -5, 200, 3.2), 0, [(10.6, 0), (10.7, 3), (12, 3), (12.1, 0)]),
            ],
            16,
            rate=20,
        ),
        draw(
            "gb_parked_car_forces_oncoming_k",
            "The ego passes a parked car and makes an oncoming car, close to its edge, brake down to walking pace.",
            "fail r163.obstruction-give-way",
            town(),
            [
                ego(own, 150, 11, [(6, 0), (8.5, 2.6), (11, 2.6), (13.5, 0)]),
                who("parked", "car", own, 260, 0, -0.6),
                who("onc", "car", opposite, -423, [(8, 14), (11, 2), (14, 2), (17, 12)], -0.9, from_end=True),
            ],
            22,
        ),
        draw(
            "gb_parked_car_waits_first_k",
            "The ego waits behind a parked car until an oncoming car has passed.",
            "not fail r163.obstruction-give-way r143.direction",
            town(),
            [
                ego(own, 122, [(8, 11), (12, 0), (20, 0), (24, 8)], [(20.5, 0), (23, 2.6), (29, 2.6), (32, 0)]),
                who("parked", "car", own, 256, 0, -0.6),
                oncoming("onc", "car", 250, 16, 12),
            ],
            38,
        ),
        draw(
            "gb_pavement_past_the_queue_k",
            "The ego drives over the pavement past two standing cars.",
            "fail r145.off-road",
            town(2.4),
            [
                ego(own, 60, 10, [(20, 0), (23, -2.8), (29, -2.8), (32, 0)]),
                who("q1", "car", own, 310, 0, 0.2),
                who("q2", "car", own, 317, 0, 0.2),
            ],
            44,
        ),
        draw(
            "gb_hazards_as_thanks_k",
            "The ego puts the hazard lights on for four seconds while it drives.",
            "fail r116.hazards",
            country(),
            [ego(own, 60, 19, indicator=[(0, "off"), (5, "hazard"), (9, "off")])],
            16,
        ),
        draw(
            "gb_night_without_headlights_k",
            "The ego drives on a country road at night with headlights off.",
            "fail r113.headlights",
            country(),
            [ego(own, 60, 20)],
            16,
            events=[(0.0, "headlights", "off")],
            light="night",
        ),
        draw(
            "gb_parked_facing_wrong_at_night_k",
            "The ego parks on the wrong side of the road at night.",
            "fail r248.parked-at-night r239.parked-with-traffic | pass r113.headlights",
            town(),
            [ego(own, 60, [(2, 8), (9, 0)], [(2, 0), (7.5, 4.3)])],
            74,
            rate=2,
            events=[(0.0, "headlights", "on")],
            light="night",
        ),
        draw(
            "gb_shunt_the_boxes_miss_k",
            "The ego loses 9 m/s in an instant 0.3 m behind a car, which is thrown forward.",
            "fail contact-signature",
            town(),
            [
                ego(own, 60, [(9.0, 12), (9.1, 3), (10, 0)]),
                who("lead", "car", own, 60 + 108 + 0.75 + 4.5 + 0.1, [(9.0, 0), (9.1, 3.5), (10.6, 0)]),
            ],
            16,
            rate=20,
        ),
    ]
