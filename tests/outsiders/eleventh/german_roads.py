"""Germany: Landstrassen and streets."""

from __future__ import annotations

import numpy as np

from tests.outsiders.eleventh.drive import Drive
from tests.outsiders.eleventh.motion import Actor, actor, ego, line, noisy, still, towed, track
from tests.outsiders.eleventh.places import STRAIGHT, N, beside, cyclist, near, out
from tests.outsiders.eleventh.road import DE, signal, simple


def german_roads() -> list[Drive]:
    plain, way = simple(DE, STRAIGHT, speed=100)
    town, street = simple(DE, [(600.0, 0.0)], kind="town", speed=50, verge="sidewalk")
    unsigned, beyond = simple(DE, STRAIGHT, speed=None)
    towing = track(beyond, 20, 60, 25.5, lat=near(DE))
    banned, after = simple(DE, STRAIGHT, speed=100, signals=signal("9", 150, -4.2, "276", "de"))
    return [
        Drive(
            "de_cyclist_1m5",
            plain,
            [ego(track(way, 18, 20, 21, lat=beside(-0.05, 7.5, DE))), cyclist(way, 18, 140, 5.0, side=DE)],
            expect=[("stvo.s5-passing", "fail", "1.5 m on a Landstrasse, where 2 m are due")],
        ),
        Drive(
            "de_cyclist_2m6",
            plain,
            [ego(track(way, 18, 20, 21, lat=beside(-1.2, 7.5, DE))), cyclist(way, 18, 140, 5.0, side=DE)],
            expect=[("stvo.s5-passing", "pass", "2.65 m"), ("stvo.rg3", "pass", "76 km/h of 100")],
        ),
        Drive(
            "de_town_cyclist_near",
            town,
            [ego(track(street, 18, 20, 12.5, lat=beside(0.4, 8, DE), hz=5)), cyclist(street, 18, 84, 4.5, side=DE)],
            expect=[("stvo.s5-passing", "fail", "1.05 m in a town, where 1.5 m are due")],
        ),
        Drive(
            "de_town_cyclist_good",
            town,
            [ego(track(street, 18, 20, 12.5, lat=beside(-0.5, 8, DE))), cyclist(street, 18, 84, 4.5, side=DE)],
            expect=[("stvo.s5-passing", "pass", "1.95 m in a town"), ("stvo.rg3", "pass", "45 km/h")],
        ),
        Drive(
            "de_walker",
            plain,
            [
                ego(track(way, 16, 20, 17, lat=beside(0.6, 8.3, DE))),
                actor("w", "pedestrian", track(way, 16, 150, 1.3, lat=[(0, -2.6)])),
            ],
            expect=[("stvo.s5-passing", "fail", "0.8 m beside somebody walking along the Landstrasse")],
        ),
        Drive(
            "de_queue_cyclist_right",
            town,
            [
                ego(track(street, 24, 60, 10, [(2, -2.0), (7, 0)], near(DE, 1.2))),
                cyclist(street, 24, 55, 4.0, 3.1, DE),
                actor("a", "car", still(street, 115, -1.3, 24)),
            ],
            expect=[
                ("stvo.s5-passing", "not fail", "the ego stands in a queue and the cyclist rides past it on the right"),
                ("ukhc.no-collision", "pass", "one metre of room"),
            ],
        ),
        Drive(
            "de_land_120",
            unsigned,
            [ego(track(beyond, 16, 60, 33.4, lat=near(DE)))],
            expect=[("stvo.rg3", "fail", "120 km/h on a Landstrasse without a sign, where 100 hold")],
        ),
        Drive(
            "de_caravan_92",
            unsigned,
            [ego(towing), Actor("tr", "trailer", (6.5, 2.3, 2.6), towed(towing, 6.0))],
            conditions={"vehicle_class": "car_towing"},
            expect=[("stvo.rg3", "fail", "92 km/h with a trailer on a Landstrasse, where 80 hold")],
        ),
        Drive(
            "de_lorry_76",
            plain,
            [ego(track(way, 20, 60, 21.0, lat=near(DE), hz=2), "truck")],
            conditions={"vehicle_class": "goods_over_7t5"},
            expect=[("stvo.rg3", "fail", "a lorry over 7.5 t at 76 km/h, where 60 hold; 2 Hz")],
        ),
        Drive(
            "de_overtake_oncoming",
            plain,
            [
                ego(track(way, 22, 60, 24, lat=out(3, 10, DE))),
                actor("t", "truck", track(way, 22, 110, 16, lat=near(DE))),
                actor("o", "van", noisy(track(way, 22, 635, 25, lat=near(DE, -N), way=-1), 0.05, 3)),
            ],
            expect=[
                ("ukhc.r162.safe-distance-ahead", "fail", "the oncoming van is past as the ego is just back"),
                ("ukhc.overtake-zone", "fail", "no half second to spare"),
                ("rss.opposite", "fail", "both fast, and near"),
            ],
        ),
        Drive(
            "de_276",
            banned,
            [
                ego(track(after, 24, 80, 24, lat=out(6, 15, DE))),
                actor("t", "truck", track(after, 24, 175, 15, lat=near(DE))),
            ],
            expect=[("ukhc.r165.no-overtaking-sign", "fail", "sign 276 at 150 m, pulls out at 224 m")],
        ),
        Drive(
            "de_deer",
            plain,
            [
                ego(track(way, 30, 60, 23, [(4, -2.2), (8, 0), (9, -0.5), (12, 0)], near(DE))),
                Actor("d", "animal", (1.6, 0.5, 1.2), track(line(230, -8, np.pi / 2), 30, -1.0, 1.6)),
            ],
            expect=[
                ("ukhc.no-collision", "pass", "slows down, the deer is across in time"),
                ("stvo.rg3", "pass", "83 km/h at most"),
                ("stvo.rg2", "not fail", "no motorway, and a deer"),
            ],
        ),
    ]
