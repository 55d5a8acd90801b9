"""Great Britain: a roundabout."""

from __future__ import annotations

from tests.outsiders.seventeenth.cast import ROUNDABOUT
from tests.outsiders.seventeenth.drive import Actor, Drive, draw
from tests.outsiders.seventeenth.maps import ring, round_way
from tests.outsiders.seventeenth.ways import EAST, Way

DRIVES: list[Drive] = [
    draw(
        "round_right",
        ROUNDABOUT,
        [
            Actor("ego", round_way(True, 3), ((0, 11), (6, 11), (9, 6), (30, 6)), 40),
            Actor("b", round_way(True, 3), ((0, 11), (6, 11), (9, 6), (30, 6)), 5),
        ],
        26,
        [
            ("ukhc.r143.direction", "not fail", "the right way round"),
            ("ukhc.no-collision", "pass", "nobody near"),
            ("comfort.lateral", "pass", "6 m/s on 14 m is 2.6 m/s2"),
        ],
        moved=(7, -3, 0.9),
    ),
    draw(
        "round_wrong_way",
        ROUNDABOUT,
        [
            Actor(
                "ego",
                Way(-160, -1.75, EAST, [(134.47, 0), *ring(False, 3)[1:]]),
                ((0, 6), (40, 6)),
                2,
                off=((0, 3.5), (18, 3.5), (21, 0)),
            )
        ],
        36,
        [("ukhc.r143.direction", "fail", "three quarters of the ring the wrong way round, 9 s")],
        hz=5,
    ),
]
