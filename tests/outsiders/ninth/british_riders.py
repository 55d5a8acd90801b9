"""Great Britain: horses, dogs and cyclists."""

from __future__ import annotations

from tests.outsiders.ninth.drive import Drive, draw
from tests.outsiders.ninth.maps import country, own, town
from tests.outsiders.ninth.movement import SIZELESS, ego, who


def british_riders() -> list[Drive]:
    """Return its drives."""
    return [
        draw(
            "gb_horse_at_twenty_k",
            "The ego passes a horse at 20 mph.",
            "fail r215.horse",
            country(),
            [ego(own, 60, 9, [(5, 0), (8, 2.6), (16, 2.6), (19, 0)]), who("horse", "animal", own, 140, 1.7, -1.2)],
            24,
        ),
        draw(
            "gb_horse_as_it_should_be_k",
            "The ego slows down to 9 mph and passes a horse with much room.",
            "pass r215.horse no-collision",
            country(limit=40),
            [
                ego(own, 60, [(3, 12), (8, 3.9), (38, 3.9), (43, 10)], [(14, 0), (18, 2.9), (34, 2.9), (38, 0)]),
                who("horse", "animal", own, 150, 1.5, -1.2),
            ],
            48,
        ),
        draw(
            "gb_horse_brushed_past_k",
            "The ego passes a horse slowly, 1.1 m from it.",
            "fail r215.horse",
            country(),
            [
                ego(own, 50, [(0, 3.7)], [(18, 0), (22, 1.2), (30, 1.2), (34, 0)]),
                who("horse", "animal", own, 107, 1.5, -1.2),
            ],
            52,
            rate=5,
        ),
        draw(
            "gb_two_horses_one_unknown_k",
            "The ego passes two horses at 31 mph; one has no class, the other no size.",
            "not pass r215.horse",
            country(),
            [
                ego(own, 60, 14, [(3, 0), (6, 2.4), (10, 2.4), (13, 0)]),
                who("horse", None, own, 140, 1.7, -1.2, size=(2.4, 0.8, 2.4)),
                who("second", "animal", own, 144, 1.7, -1.2, size=SIZELESS),
            ],
            24,
        ),
        draw(
            "gb_dog_on_a_lead_k",
            "The ego passes a small dog and its owner, who walk along the road.",
            "not fail r215.horse",
            town(),
            [
                ego(own, 60, 7, [(8, 0), (11, 1.1), (18, 1.1), (21, 0)]),
                who("dog", "animal", own, 140, 1.3, -1.4, size=(0.8, 0.3, 0.6)),
                who("owner", "pedestrian", own, 140, 1.3, -2.6),
            ],
            24,
            noise=0.02,
        ),
        draw(
            "gb_cyclist_brushed_k",
            "The ego passes a cyclist at 28 mph, 0.75 m away.",
            "fail r163.cyclist",
            country(),
            [
                ego(own, 60, 12.5, [(3, 0), (6, 0.75), (13, 0.75), (16, 0)]),
                who("cyc", "bicycle", own, 120, 6, -1.2, indicator=None),
            ],
            20,
        ),
        draw(
            "gb_cyclist_at_43_mph_k",
            "The ego passes a cyclist at 43 mph, 1.65 m away.",
            "fail r163.cyclist",
            country(),
            [ego(own, 40, 19.2, [(3, 0), (6, 1.65), (11, 1.65), (14, 0)]), who("cyc", "bicycle", own, 145, 6, -1.2)],
            20,
            rate=25,
        ),
        draw(
            "gb_cyclists_abreast_given_room_k",
            "The ego passes two cyclists abreast in the other lane.",
            "pass r163.cyclist no-collision",
            country(),
            [
                ego(own, 50, [(3, 12), (6, 8), (15, 9), (18, 15)], [(5, 0), (8.5, 3.6), (16, 3.6), (19, 0)]),
                who("c1", "bicycle", own, 125, 4.5, -1.2),
                who("c2", "bicycle", own, 125.5, 4.5, -0.1),
            ],
            26,
        ),
        draw(
            "gb_cyclist_turned_round_k",
            "The ego passes a cyclist 0.8 m away, whose heading is turned round in the log.",
            "not pass r163.cyclist",
            country(),
            [
                ego(own, 60, 12.5, [(3, 0), (6, 0.8), (13, 0.8), (16, 0)]),
                who("cyc", "bicycle", own, 120, 6, -1.2, turned=True),
            ],
            20,
        ),
        draw(
            "gb_cyclist_two_hertz_k",
            "The ego passes a cyclist 0.6 m away; the log has two steps a second.",
            "fail r163.cyclist",
            country(),
            [ego(own, 60, 13, [(3, 0), (6, 0.6), (13, 0.6), (16, 0)]), who("cyc", "bicycle", own, 120, 6, -1.2)],
            20,
            rate=2,
        ),
        draw(
            "gb_cyclist_gone_before_passed_k",
            "The track of a cyclist ends 4 m ahead of the ego.",
            "not pass r163.cyclist",
            country(),
            [ego(own, 60, 13), who("cyc", "bicycle", own, 120, 6, -0.6, until=7.5)],
            20,
        ),
    ]
