"""Stop signs of both countries."""

from __future__ import annotations

from tests.outsiders.seventeenth.cast import STOP_CROSS
from tests.outsiders.seventeenth.drive import Drive, draw, go
from tests.outsiders.seventeenth.maps import cross
from tests.outsiders.seventeenth.road import box, sign

DRIVES: list[Drive] = [
    draw(
        "stop_halts",
        STOP_CROSS,
        [go("ego", ((0, 10), (5, 10), (10, 0), (12.5, 0), (16.5, 6)), -91.7)],
        22,
        [
            ("ukhc.r171.stop-sign", "pass", "stands 2.5 s, 0.3 m before it"),
            ("performance.precise-stop", "pass", "0.3 m"),
        ],
        moved=(10, 20, 0.7),
    ),
    draw(
        "stop_over",
        STOP_CROSS,
        [go("ego", ((0, 10), (5, 10), (10, 0), (12.5, 0), (16.5, 6)), -89.75)],
        22,
        [("ukhc.r171.stop-sign", "fail", "halts 1.5 m over it"), ("performance.precise-stop", "not pass", "over it")],
    ),
    draw(
        "stop_short",
        STOP_CROSS,
        [go("ego", ((0, 10), (5, 10), (10, 0), (12.5, 0), (16.5, 6)), -94.25)],
        22,
        [("performance.precise-stop", "fail", "2.85 m before it")],
    ),
    draw(
        "de_stop_rolls",
        cross(
            gb=False,
            west=([box("sl", "stopLine", "stopline", 148, -1.75, 0.3, 3.4)], [sign("s", "DE", "206", 148, -3.8, -1)]),
        ),
        [go("ego", ((0, 10), (6, 10), (10, 1.5), (13, 1.5), (17, 8)), -98, -1.75)],
        24,
        [("stvo.rin1", "fail", "never slower than 1.5 m/s")],
        nation="de",
    ),
]
