"""Great Britain: being overtaken."""

from __future__ import annotations

from tests.outsiders.ninth.drive import Drive, draw
from tests.outsiders.ninth.maps import country, own
from tests.outsiders.ninth.movement import ego, who


def british_overtaken() -> list[Drive]:
    """Return its drives."""
    return [
        draw(
            "gb_overtaken_speeds_up_k",
            "The ego speeds up while a car overtakes it.",
            "fail r168.when-overtaken",
            country(1400),
            [
                ego(own, 160, [(6, 18), (14, 25)]),
                who("fast", "car", own, 125, [(2, 18), (8, 26)], [(3, 0), (6, 3.6), (19, 3.6), (21.5, 0)]),
            ],
            22,
        ),
        draw(
            "gb_overtaken_keeps_steady_k",
            "A car overtakes the ego, which eases off.",
            "pass r168.when-overtaken",
            country(1400),
            [
                ego(own, 160, [(9, 18), (15, 16.5)]),
                who("fast", "car", own, 100, [(2, 18), (8, 27)], [(3, 0), (6, 3.6), (15, 3.6), (18, 0)]),
            ],
            22,
        ),
        draw(
            "gb_cut_in_never_drops_back_k",
            "A car overtakes and cuts in 7 m ahead; the ego never drops back.",
            "fail r168.drop-back",
            country(1600),
            [
                ego(own, 160, [(0, 22)]),
                who(
                    "fast",
                    "car",
                    own,
                    120,
                    [(2, 24), (6, 29), (9, 29), (11.5, 22)],
                    [(1, 0), (3.5, 3.6), (9, 3.6), (11, 0)],
                ),
            ],
            30,
        ),
        draw(
            "gb_cut_in_drops_back_k",
            "A car overtakes and cuts in 7 m ahead; the ego drops back at once.",
            "not fail r168.drop-back",
            country(1600),
            [
                ego(own, 160, [(10, 22), (12.5, 15), (20, 17.5)]),
                who(
                    "fast",
                    "car",
                    own,
                    120,
                    [(2, 24), (6, 29), (9, 29), (11.5, 22)],
                    [(1, 0), (3.5, 3.6), (9, 3.6), (11, 0)],
                ),
            ],
            34,
        ),
    ]
