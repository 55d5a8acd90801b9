"""Germany: country roads and towns."""

from __future__ import annotations

from tests.outsiders.ninth.cast import INDICATED, SCHNELLER, out_and_back
from tests.outsiders.ninth.drive import Drive, draw
from tests.outsiders.ninth.maps import landstrasse, ortsstrasse, own
from tests.outsiders.ninth.movement import KMH, ego, oncoming, who
from tests.outsiders.ninth.road import Signal
from tests.outsiders.ninth.ways import gone


def german_roads() -> list[Drive]:
    """Return its drives."""
    return [
        draw(
            "de_landstrasse_overtake_squeezed_k",
            "The ego overtakes a lorry and moves back as an oncoming car passes.",
            "fail r162.safe-distance-ahead rss.opposite r126.ds-disjoint r126.ds-av-out-of-ov | pass stvo.rg3",
            landstrasse(1400),
            [
                ego(own, 45, SCHNELLER, out_and_back(3.5, back=15), indicator=INDICATED),
                who("lkw", "truck", own, 100, 19),
                oncoming("onc", "car", 45 + gone(SCHNELLER, 16.7), 16.7, 26, -0.85),
            ],
            24,
        ),
        draw(
            "de_landstrasse_overtake_ample_k",
            "The ego overtakes a lorry between two oncoming cars far apart.",
            "pass r162.safe-distance-ahead no-collision",
            landstrasse(2400),
            [
                ego(own, 345, SCHNELLER, out_and_back(3.5, back=15), indicator=INDICATED),
                who("lkw", "truck", own, 400, 19),
                oncoming("early", "car", 390, 2, 13),
                oncoming("late", "car", 345 + gone(SCHNELLER, 26) + 300, 26, 24),
            ],
            26,
            rate=5,
        ),
        draw(
            "de_ueberholverbot_k",
            "The ego overtakes a car after sign 276.",
            "fail r165.no-overtaking-sign",
            landstrasse(1400).having(Signal(60, -4.5, kind="276", country="DE")),
            [
                ego(own, 25, SCHNELLER, out_and_back(3.5, back=14.5), indicator=INDICATED),
                who("pkw", "car", own, 75, 19),
            ],
            24,
        ),
        draw(
            "de_landstrasse_121_kmh_k",
            "The ego speeds up sharply to 121 km/h on a road of 100 km/h.",
            "fail stvo.rg3 comfort.accel-iso15622",
            landstrasse(1200),
            [ego(own, 30, [(3, 22), (5.6, 33.7), (16, 33.7), (20, 27)])],
            24,
        ),
        draw(
            "de_landstrasse_lkw_78_kmh_k",
            "A heavy lorry drives at 78 km/h on a country road.",
            "fail stvo.rg3",
            landstrasse(),
            [ego(own, 60, 78 * KMH, kind="truck")],
            24,
            vehicle_class="goods_over_7t5",
        ),
        draw(
            "de_radfahrer_landstrasse_knapp_k",
            "The ego passes a cyclist on a country road, 1.5 m away.",
            "fail stvo.s5-passing",
            landstrasse(),
            [ego(own, 40, 24, [(2, 0), (5, 1.5), (8, 1.5), (11, 0)]), who("rad", "bicycle", own, 150, 5.5, -1.2)],
            16,
            rate=20,
        ),
        draw(
            "de_radfahrer_ort_180_k",
            "The ego passes a cyclist in a town, 1.8 m away.",
            "pass stvo.s5-passing no-collision",
            ortsstrasse(),
            [ego(own, 60, 11, [(4, 0), (7, 1.8), (13, 1.8), (16, 0)]), who("rad", "bicycle", own, 115, 5, -1.2)],
            20,
        ),
        draw(
            "de_wanderer_am_fahrbahnrand_k",
            "The ego passes somebody who walks along a country road, 1.15 m away.",
            "fail stvo.s5-passing",
            landstrasse(),
            [
                ego(own, 60, 21, [(3, 0), (5, 1.0), (8, 1.0), (10, 0)]),
                who("wanderer", "pedestrian", own, 200, 1.4, -1.3),
            ],
            18,
        ),
    ]
