"""Accelerations of all kinds."""

from __future__ import annotations

from tests.outsiders.seventeenth.drive import Actor, Drive, draw, go
from tests.outsiders.seventeenth.maps import two_way
from tests.outsiders.seventeenth.ways import EAST, Way

DRIVES: list[Drive] = [
    draw(
        "accelerates_hard",
        two_way(length=1600),
        [go("ego", ((0, 10), (4, 10), (9, 25), (20, 25)), 50)],
        20,
        [("comfort.accel-iso15622", "fail", "3 m/s2 at 20 m/s and more"), ("comfort.nuplan", "fail", "3 m/s2")],
    ),
    draw(
        "brakes_at_once",
        two_way(length=1600),
        [go("ego", ((0, 22), (7, 22), (7.2, 21.6), (10.5, 8.4), (12, 8)), 50)],
        18,
        [("comfort.jerk-iso15622", "fail", "from 0 to 4 m/s2 within half a second")],
        hz=20,
    ),
    draw(
        "bend_bus",
        two_way(pieces=[(60, 0), (120, 0.016194332), (60, 0)]),
        [Actor("ego", Way(0, 1.75, EAST, [(60, 0), (116.59919, 0.0166666667)]), 12.6, 10, cls="bus")],
        14,
        [("comfort.lateral", "fail", "2.65 m/s2")],
        more={"vehicle_class": "bus"},
        hz=20,
    ),
]
