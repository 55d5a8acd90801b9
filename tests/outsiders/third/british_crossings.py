"""Great Britain: crossings for those on foot."""

from __future__ import annotations

from tests.outsiders.third.drive import Drive, draw
from tests.outsiders.third.maps import town, zebra
from tests.outsiders.third.movement import F, N, car, ego, who
from tests.outsiders.third.ways import EAST, line


def british_crossings() -> list[Drive]:
    walker = line(100, 5, -90)
    return [
        draw(
            "gb_zebra_with_walker",
            "The ego drives over a zebra while somebody stands on its half.",
            "fail r195.zebra-on",
            town(things=zebra(100)),
            [
                ego(EAST, (8, 95.75), 10, 1.2),
                who(
                    "walker",
                    "pedestrian",
                    walker,
                    (8, 1.95),
                    [(0, 0), (5, 0), (5.6, 1.2), (7.2, 1.2), (7.6, 0), (10, 0), (10.8, 1.2)],
                    0,
                ),
            ],
            15,
        ),
        draw(
            "gb_zebra_waits",
            "The ego waits at a zebra until somebody has crossed.",
            "pass r195.zebra-on r191.crossing-overtake | not fail r191.no-stopping",
            town(things=zebra(100)),
            [
                ego(EAST, (8, 93.5), [(0, 10), (2, 10), (7, 0), (12.5, 0), (15, 7)]),
                who("walker", "pedestrian", walker, (5, 0), [(0, 0), (4.6, 0), (5.4, 1.35)], 0),
            ],
            18,
        ),
        draw(
            "gb_overtakes_at_zebra",
            "The ego overtakes a moving car just before a zebra.",
            "fail r191.crossing-overtake",
            town(things=zebra(100)),
            [ego(EAST, (0, 0), 11, [(2.5, N), (5.5, F), (10.5, F), (13.5, N)]), car(EAST, (8.2, 90), 5)],
            15,
        ),
        draw(
            "gb_stands_on_zebra",
            "The ego follows a queue onto a zebra and stands on it.",
            "fail r192.keep-clear | not fail r191.no-stopping",
            town(things=zebra(100)),
            [
                ego(EAST, (10, 100), [(0, 8), (3.5, 8), (8, 0), (17, 0), (20, 5)]),
                car(EAST, (10, 107), [(0, 8), (2.5, 8), (7, 0), (16.5, 0), (19, 5)]),
            ],
            21,
        ),
        draw(
            "gb_walker_still_crossing",
            "The light turns green and the ego drives past somebody on its half.",
            "fail r198.still-crossing | pass r175.red",
            town(things=zebra(100, "signal_crossing", True)),
            [ego(EAST, (8, 95.75), 6, 2.4), who("walker", "pedestrian", walker, (8, 4.6), 1.3, 0)],
            13,
            lights={"light": [(0, "red"), (4, "green")]},
        ),
    ]
