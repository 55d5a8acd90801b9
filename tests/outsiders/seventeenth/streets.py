"""Footways, things in the way, lights, horn, speed and parking; a German lorry too."""

from __future__ import annotations

from tests.outsiders.seventeenth.cast import ROAD, TOWN
from tests.outsiders.seventeenth.drive import Drive, draw, go
from tests.outsiders.seventeenth.maps import two_way

DRIVES: list[Drive] = [
    draw(
        "footway_wheel",
        TOWN,
        [go("ego", 9, 50, off=((4, 0), (6, 1.15), (10, 1.15), (12, 0)))],
        18,
        [("ukhc.r145.off-road", "fail", "0.3 m over it at 9 m/s")],
        moved=(0, 0, 1.57),
    ),
    draw(
        "footway_drive",
        TOWN,
        [go("ego", ((0, 9), (3, 9), (6, 3)), 50, off=((7, 0), (10, 2.2), (16, 2.2)))],
        16,
        [("ukhc.r145.off-road", "not fail", "3 m/s, to property")],
    ),
    draw(
        "obstruction_meets",
        TOWN,
        [
            go("ego", 10, 100, off=((7, 0), (9, -2.2), (11.3, -2.2), (13.3, 0))),
            go("pk", 0, 200, 2.6),
            go("o", ((0, 13), (10.2, 13), (12.2, 5), (15, 10)), 382, -1.75, back=True, seen_from=5),
        ],
        20,
        [("ukhc.r163.obstruction-give-way", "fail", "the oncoming one brakes with 4 m/s2")],
    ),
    draw(
        "obstruction_waits",
        TOWN,
        [
            go(
                "ego",
                ((0, 10), (6, 10), (9, 0), (16, 0), (19, 8)),
                100,
                off=((16.5, 0), (19, -2.2), (22, -2.2), (24, 0)),
            ),
            go("pk", 0, 200, 2.6),
            go("o", 10, 300, -1.75, back=True),
        ],
        28,
        [
            ("ukhc.r163.obstruction-give-way", "not fail", "waited"),
            ("ukhc.r143.direction", "not fail", "round a standing one"),
        ],
    ),
    draw(
        "hazards_driving",
        TOWN,
        [go("ego", 12, 50, ind=((0, "hazard"),))],
        15,
        [("ukhc.r116.hazards", "fail", "12 m/s in town")],
        nation="gb-eng",
    ),
    draw(
        "horn_standing",
        TOWN,
        [go("ego", 0, 50)],
        12,
        [("ukhc.r112.horn", "fail", "standing, nobody there")],
        events=[(0, "horn", "off"), (5, "horn", "on"), (6, "horn", "off")],
    ),
    draw(
        "dark_street",
        TOWN,
        [go("ego", 10, 50)],
        15,
        [
            ("ukhc.r115.dipped-headlights", "fail", "30 mph street at night"),
            ("ukhc.r113.headlights", "not fail", "it may be lit"),
        ],
        light="night",
        events=[(0, "headlights", "off")],
    ),
    draw(
        "lit_late",
        ROAD,
        [go("ego", 20, 50)],
        20,
        [("ukhc.r113.headlights", "fail", "off for 8 s of driving")],
        light="night",
        events=[(0, "headlights", "off"), (8, "headlights", "on")],
    ),
    draw(
        "speed_towing",
        ROAD,
        [go("ego", 25.03424, 50), go("tr", 25.03424, 44.2, cls="trailer")],
        12,
        [("ukhc.r124.speed-limit", "fail", "towing: 50 mph")],
        more={"vehicle_class": "car_towing"},
    ),
    draw(
        "speed_lorry_scotland",
        ROAD,
        [go("ego", 20.56384, 50, cls="truck")],
        15,
        [("ukhc.r124.speed-limit", "fail", "40 mph in Scotland")],
        nation="gb-sct",
        more={"vehicle_class": "goods_over_7t5"},
    ),
    draw(
        "speed_de_lorry",
        two_way(gb=False, limit=(100, "km/h")),
        [go("ego", 20, 50, -1.75, cls="truck")],
        15,
        [("stvo.rg3", "fail", "72 km/h, lorries over 7.5 t 60")],
        nation="de",
        more={"vehicle_class": "goods_over_7t5"},
    ),
    draw(
        "parked_against",
        TOWN,
        [go("ego", ((0, 8), (9, 8), (17, 0)), 100, off=((3, 0), (10, 0), (14, -4.2)))],
        85,
        [
            ("ukhc.r239.parked-with-traffic", "fail", "stands 68 s"),
            ("ukhc.r248.parked-at-night", "fail", "stands 68 s at night"),
        ],
        light="night",
        hz=5,
    ),
]
