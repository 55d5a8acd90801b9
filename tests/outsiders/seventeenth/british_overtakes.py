"""Great Britain: overtaking on open roads."""

from __future__ import annotations

from tests.outsiders.seventeenth.cast import LONGER_ROAD
from tests.outsiders.seventeenth.drive import Drive, draw, go
from tests.outsiders.seventeenth.maps import two_way
from tests.outsiders.seventeenth.road import sign

DRIVES: list[Drive] = [
    draw(
        "overtake_clear",
        LONGER_ROAD,
        [
            go(
                "ego",
                22,
                50,
                off=((2, 0), (5, -3.5), (15, -3.5), (18, 0)),
                ind=((0, "off"), (0.5, "right"), (6, "off")),
            ),
            go("v", 14, 150, cls="van"),
        ],
        26,
        [
            ("ukhc.r163.pull-out-separation", "not fail", "79 m"),
            ("ukhc.r143.direction", "not fail", "an overtake"),
            ("ukhc.r162.safe-distance-ahead", "not fail", "nobody comes"),
        ],
    ),
    draw(
        "overtake_from_near",
        LONGER_ROAD,
        [
            go("ego", ((0, 15), (3, 15), (9, 24)), 50, off=((2, 0), (4, -3.5), (11, -3.5), (14, 0))),
            go("v", 15, 64.95, cls="van"),
        ],
        22,
        [("ukhc.r163.pull-out-separation", "fail", "10 m at 15 m/s, stopping takes 27 m")],
    ),
    draw(
        "overtake_oncoming",
        LONGER_ROAD,
        [
            go("ego", 22, 50, off=((2, 0), (4, -3.5), (6.5, -3.5), (8.5, 0))),
            go("v", 12, 95),
            go("o", 25, 474, -1.75, back=True, seen_from=3),
        ],
        14,
        [
            ("ukhc.r126.ds-disjoint", "fail", "119 m apart when stopping takes 51 m and 63 m"),
            ("rss.opposite", "fail", "119 m head on"),
        ],
        moved=(70000, -30000, 0.2),
    ),
    draw(
        "overtake_while_overtaken",
        LONGER_ROAD,
        [
            go("ego", 20, 100, off=((4, 0), (6, -3.5), (13, -3.5), (16, 0))),
            go("v", 13, 190),
            go("f", ((0, 33), (5, 33), (8, 20)), 0, -1.75),
        ],
        20,
        [("ukhc.r162.not-being-overtaken", "fail", "44 m behind and 13 m/s faster")],
    ),
    draw(
        "no_overtaking",
        two_way(length=1400, signals=[sign("n", "GB", "632", 100, 4, 1, "no_overtaking")]),
        [go("ego", 22, 60, off=((4, 0), (7, -3.5), (15, -3.5), (18, 0))), go("v", 14, 160, cls="van")],
        24,
        [("ukhc.r165.no-overtaking-sign", "fail", "pulled out at 148 m, the sign stands at 100 m")],
    ),
    draw(
        "no_overtaking_ended",
        two_way(
            length=1400,
            signals=[
                sign("n", "GB", "632", 100, 4, 1, "no_overtaking"),
                sign("e", "GB", "645", 125, 4, 1, "overtaking_end"),
            ],
        ),
        [go("ego", 22, 60, off=((4, 0), (7, -3.5), (15, -3.5), (18, 0))), go("v", 14, 160, cls="van")],
        24,
        [("ukhc.r165.no-overtaking-sign", "not fail", "ended at 125 m, pulled out at 148 m")],
    ),
]
