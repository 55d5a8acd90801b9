"""Great Britain: overtaking on a country road."""

from __future__ import annotations

from tests.outsiders.third.cast import OVER_BLINK, VAN, overtaker
from tests.outsiders.third.drive import Drive, draw
from tests.outsiders.third.maps import START, straight
from tests.outsiders.third.movement import F, N, car, ego, who
from tests.outsiders.third.road import Sign
from tests.outsiders.third.ways import EAST, WEST


def british_overtaking() -> list[Drive]:
    solid = "solid solid"
    return [
        draw(
            "gb_overtake_clear_3",
            "The ego overtakes a van on a straight, empty country road.",
            "pass r129.no-cross-solid no-collision r163.pull-out-separation "
            "| not fail r143.direction r162.safe-distance-ahead r162.not-being-overtaken",
            straight(),
            [overtaker(), VAN],
            22,
        ),
        draw(
            "gb_overtake_near_miss",
            "The ego gets back half a second before an oncoming car passes it.",
            "fail r126.ds-disjoint r126.ds-ov-out-of-av overtake-zone rss.opposite",
            straight(),
            [overtaker(), VAN, car(WEST, (15.0, -345), 25)],
            20,
        ),
        draw(
            "gb_overtake_head_on",
            "The ego overtakes and runs head on into an oncoming car.",
            "fail no-collision r162.safe-distance-ahead r126.ds-disjoint rss.opposite",
            straight(),
            [overtaker(), VAN, car(WEST, (10.0, -210), 20)],
            10.6,
        ),
        draw(
            "gb_overtake_double_white_3",
            "The ego overtakes a moving van across a double white line.",
            "fail r129.no-cross-solid",
            straight(solid),
            [overtaker(), VAN],
            22,
        ),
        draw(
            "gb_no_overtaking_sign_3",
            "The ego overtakes a moving van after a no-overtaking sign.",
            "fail r165.no-overtaking-sign",
            straight(things=(Sign("ban", "no_overtaking", 30, 4.5, "gb", "632"),)),
            [overtaker(), VAN],
            22,
        ),
        draw(
            "gb_accelerates_when_overtaken",
            "The ego speeds up while a car overtakes it.",
            "fail r168.when-overtaken",
            straight(),
            [
                ego(EAST, (0, 0), [(0, 18), (3.5, 18), (8, 25)]),
                car(EAST, (0, -40), [(0, 26), (6, 26), (9, 33)], [(1, N), (3.5, F), (12.5, F), (15, N)]),
            ],
            17,
        ),
        draw(
            "gb_steady_when_overtaken",
            "A car overtakes the ego, moves in ahead of it and draws away.",
            "pass r168.when-overtaken r168.drop-back no-collision | not fail r126.thinking-gap",
            straight(),
            [ego(EAST, (0, 0), 18), car(EAST, (0, -40), 26, [(1, N), (3.5, F), (7.5, F), (10.5, N)])],
            18,
        ),
        draw(
            "gb_pulls_out_before_overtaker_3",
            "The ego pulls out right before a car that is overtaking both.",
            "fail r162.not-being-overtaken",
            straight(),
            [
                ego(
                    EAST,
                    (0, 15),
                    [(0, 15), (4, 15), (8, 21)],
                    [(4, N), (6.5, F), (14, F), (17, N)],
                    blink=((3.5, 6.5, "far"),),
                ),
                VAN,
                car(EAST, (4, 44.5), [(0, 25), (4.5, 25), (8, 16), (12, 19)], F),
            ],
            19,
        ),
        draw(
            "gb_squeezes_between_vans",
            "The ego overtakes one van and squeezes into 12 m before the next.",
            "fail r162.return-gap",
            straight(),
            [
                ego(
                    EAST,
                    (0, 15),
                    [(0, 15), (3, 15), (7, 21), (10.5, 21), (13.5, 14)],
                    [(2, N), (5, F), (11.5, F), (14.5, N)],
                    blink=OVER_BLINK,
                ),
                VAN,
                who("van_2", "van", EAST, (0, 77.5), 14),
            ],
            20,
        ),
        draw(
            "gb_back_after_solid_begins",
            "The ego is still overtaking long after the middle line has become solid.",
            "fail r128.back-before-solid r129.no-cross-solid",
            straight(((-START, "broken"), (150, "solid"))),
            [overtaker(), VAN],
            22,
        ),
    ]
