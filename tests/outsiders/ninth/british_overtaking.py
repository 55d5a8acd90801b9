"""Great Britain: overtaking on a country road."""

from __future__ import annotations

from tests.outsiders.ninth.cast import FASTER, INDICATED, out_and_back
from tests.outsiders.ninth.drive import Drive, draw
from tests.outsiders.ninth.maps import country, own
from tests.outsiders.ninth.movement import ego, oncoming, who
from tests.outsiders.ninth.road import Signal
from tests.outsiders.ninth.ways import gone


def british_overtaking() -> list[Drive]:
    """Return its drives."""
    return [
        draw(
            "gb_overtake_squeezed_k",
            "The ego overtakes a lorry and is still half in the other lane when an oncoming car passes.",
            "fail r162.safe-distance-ahead overtake-zone rss.opposite r126.ds-disjoint | pass no-collision",
            country(),
            [
                ego(own, 60, FASTER, out_and_back(), indicator=INDICATED),
                who("slow", "truck", own, 100, 13),
                oncoming("onc", "car", 60 + gone(FASTER, 14.3), 14.3, 24, -0.9),
            ],
            22,
        ),
        draw(
            "gb_overtake_ample_k",
            "The ego overtakes a van; the next oncoming car is over a kilometre away.",
            "pass r162.safe-distance-ahead | not fail r129.no-cross-solid r143.direction r162.return-gap",
            country(1400),
            [
                ego(own, 60, FASTER, out_and_back(), indicator=INDICATED),
                who("slow", "van", own, 105, 13),
                oncoming("onc", "car", 60 + gone(FASTER, 22) + 500, 22, 20),
            ],
            24,
        ),
        draw(
            "gb_overtake_past_the_sign_k",
            "The ego overtakes a motorcycle after a no-overtaking sign.",
            "fail r165.no-overtaking-sign",
            country().having(Signal(40, -4.6, name="no_overtaking", country="gb", kind="632")),
            [ego(own, 20, FASTER, out_and_back(), indicator=INDICATED), who("slow", "motorcycle", own, 60, 13, 0.4)],
            22,
        ),
        draw(
            "gb_overtake_past_the_end_sign_k",
            "The ego overtakes after the sign that ends a ban on overtaking.",
            "not fail r165.no-overtaking-sign",
            country().having(
                Signal(30, -4.6, name="no_overtaking", country="gb", kind="632"),
                Signal(110, -4.6, name="overtaking_end", country="gb", kind="645"),
            ),
            [ego(own, 20, [(8, 13), (14, 23)], out_and_back(out=9, back=17)), who("slow", "car", own, 60, 13)],
            24,
        ),
        draw(
            "gb_overtake_into_biker_k",
            "The ego pulls out to overtake right before a motorcycle that is overtaking both.",
            "fail r162.not-being-overtaken",
            country(),
            [
                ego(own, 160, FASTER, out_and_back(), indicator=INDICATED),
                who("slow", "car", own, 200, 13),
                who("biker", "motorcycle", own, 33, [(5.4, 30), (9, 14.5), (11, 20), (13, 20)], [(0.5, 0), (3, 3.6)]),
            ],
            20,
        ),
        draw(
            "gb_overtake_no_gap_in_platoon_k",
            "The ego overtakes the last of four cars and squeezes in between it and the next.",
            "fail r162.return-gap",
            country(1200),
            [
                ego(
                    own,
                    60,
                    [(4, 13), (10, 23), (11, 23), (13, 13)],
                    out_and_back(back=11.5, lasting=2.5),
                    indicator=INDICATED,
                ),
                *(who(f"p{i}", "car", own, 100 + 20 * i, 13) for i in range(4)),
            ],
            22,
            noise=0.02,
        ),
        draw(
            "gb_overtake_from_the_bumper_k",
            "The ego pulls out to overtake from 5 m behind a car.",
            "fail r163.pull-out-separation r126.thinking-gap criticality.thw",
            country(),
            [
                ego(own, 60, [(6, 20), (9, 26)], out_and_back(out=6.5, back=13, lasting=2.5), indicator=INDICATED),
                who("slow", "car", own, 71, 20),
            ],
            20,
        ),
        draw(
            "gb_overtake_blind_bend_k",
            "The ego overtakes in a bend; an oncoming car appears in the log late.",
            "not pass r162.safe-distance-ahead | fail rss.opposite",
            country(bends=[(200, 0), (260, 1 / 170), (400, 0)]),
            [
                ego(own, 100, [(3, 13), (8, 20)], out_and_back(out=4, back=12), indicator=INDICATED),
                who("slow", "truck", own, 135, 12),
                oncoming("onc", "car", 100 + gone([(3, 13), (8, 20)], 14), 14, 17, -0.9, since=9.5),
            ],
            20,
        ),
        draw(
            "gb_overtake_given_up_k",
            "The ego begins to overtake, brakes, and moves back in behind the lorry.",
            "not fail r143.direction | pass no-collision",
            country(1200),
            [
                ego(
                    own,
                    60,
                    [(4, 16), (6, 18), (8, 18), (11, 14.5), (14, 15)],
                    [(5, 0), (7.5, 3.6), (9, 3.6), (12, 0)],
                    indicator=INDICATED,
                ),
                who("slow", "truck", own, 100, 16),
                oncoming("onc", "car", 620, 13, 20),
            ],
            24,
        ),
        draw(
            "gb_overtake_one_of_two_k",
            "The ego overtakes one of two cars that are far apart.",
            "pass r162.return-gap no-collision",
            country(1600),
            [
                ego(own, 60, [(4, 15), (9, 23), (14, 23), (18, 15)], out_and_back(), indicator=INDICATED),
                who("a", "car", own, 110, 14),
                who("b", "car", own, 290, 15.2),
            ],
            24,
        ),
        draw(
            "gb_overtake_tractor_with_trailer_k",
            "The ego overtakes a tractor with a trailer; a van comes before it is wholly back.",
            "fail r162.safe-distance-ahead rss.opposite",
            country(1200),
            [
                ego(own, 60, [(4, 9), (10, 19)], out_and_back(out=4.5, back=15), indicator=INDICATED),
                who("tractor", "vehicle", own, 112, 9),
                who("tail", "trailer", own, 106.5, 9, size=(5.5, 2.4, 2.4)),
                oncoming("onc", "van", 60 + gone([(4, 9), (10, 19)], 16.6), 16.6, 22, -0.95),
            ],
            26,
        ),
        draw(
            "gb_overtake_at_78_k",
            "The ego overtakes at 78 mph where 60 are allowed.",
            "fail r124.speed-limit",
            country(1500),
            [
                ego(own, 60, [(4, 22), (10, 35)], out_and_back(back=11), indicator=INDICATED),
                who("slow", "car", own, 110, 22),
            ],
            22,
        ),
    ]
