"""Germany: the Autobahn."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.twelfth.cast import (
    DE,
    DL,
    DM,
    DR,
    DS,
    ego,
)
from tests.outsiders.twelfth.drive import Actor, Drive, draw
from tests.outsiders.twelfth.maps import (
    bab,
    bab_under_bridge,
)
from tests.outsiders.twelfth.ways import Along, Path, Straight, Walk


def german_motorways() -> Iterator[Drive]:
    yield draw(
        "de_draengler_flipped",
        bab(limit=130),
        [ego(Straight(50, DL, 33)), Actor("l", "car", Straight(61.2, DL, 33), flip=True)],
        DE,
        18,
        [
            (
                "stvo.rg1",
                "fail",
                "6.8 m behind at 33 m/s (12.5 m asked for); the one ahead is recorded heading backwards",
            ),
            ("criticality.thw", "fail", "0.2 s"),
        ],
    )
    yield draw(
        "de_brake_check",
        bab(limit=120),
        [
            ego(Straight(50, DM, [(0, 30), (6, 30), (9, 14), (12, 14), (18, 24)])),
            Actor("f", "car", Straight(-5, DM, [(0, 30), (6.8, 30), (9.8, 12), (14, 12)]), span=(0.5, 99)),
        ],
        DE,
        22,
        [("stvo.rg2", "fail", "brakes with 5.3 m/s2 with nobody ahead, a car behind")],
    )
    yield draw(
        "de_brake_deer_late",
        bab(limit=120),
        [
            ego(Straight(50, DR, [(0, 28), (6, 28), (10.5, 1), (14, 1), (20, 12)])),
            Actor(
                "deer",
                "animal",
                Walk([(0, 300, -16), (5, 300, -14), (8, 301, -9), (13, 303, -8), (16, 304, 2), (25, 305, 9)]),
                span=(5.0, 22.0),
                size=(1.2, 0.4, 1.1),
            ),
        ],
        DE,
        22,
        [
            ("stvo.rg2", "not fail", "brakes for a deer in its lane, which appears at 5 s"),
            ("ukhc.no-collision", "pass", "stops before it"),
        ],
    )
    yield draw(
        "de_139_in_120_short_map",
        bab(limit=120, length=500.0),
        [ego(Straight(20, DL, 38.6))],
        DE,
        20,
        [("stvo.rg3", "fail", "139 km/h where 120 are allowed, before the map ends at 500 m")],
    )
    yield draw(
        "de_free_speed_under_bridge",
        bab_under_bridge(),
        [
            ego(Straight(60, DL, 56), z=0.75),
            Actor("over", "bus", Along(Path(701.75, -60, 90).fwd(120), 10, [(0, 4.2)]), z=8.5),
        ],
        DE,
        25,
        [
            ("ukhc.no-collision", "not fail", "the bus stands on a bridge 7 m above"),
            ("criticality.pet", "not fail", "a bridge is no crossing"),
            ("stvo.rg3", "not fail", "no limit on this Autobahn"),
        ],
    )
    yield draw(
        "de_crawler_night",
        bab(limit="no limit"),
        [ego(Straight(50, DM, 17.5)), Actor("f", "truck", Straight(0, DR, 22))],
        {"nation": "de", "light": "night"},
        30,
        [
            ("stvo.rg4", "fail", "63 km/h on a free Autobahn without a limit"),
            ("ukhc.r113.headlights", "not pass", "night, headlights not recorded"),
        ],
    )
    yield draw(
        "de_crawl_behind_convoy",
        bab(),
        [
            ego(Straight(50, DR, 18)),
            Actor("t", "truck", Straight(105, DR, 18)),
            Actor("t2", "truck", Straight(180, DR, 18)),
        ],
        DE,
        25,
        [("stvo.rg4", "not fail", "a slow lorry ahead"), ("stvo.rg1", "pass", "47 m at 18 m/s")],
    )
    yield draw(
        "de_pulls_out_before_racer",
        bab(),
        [
            ego(Straight(200, DM, 30, moves=[(3, 3.5, DL)]), ind=[(0, "off"), (2, "left"), (7, "off")]),
            Actor("t", "truck", Straight(270, DM, 23)),
            Actor("r", None, Straight(74, DL, [(0, 50), (4, 50), (7, 31), (12, 30)])),
        ],
        DE,
        14,
        [("stvo.rg6", "fail", "pulls out 40 to 60 m before one who is 20 m/s faster (about 97 m asked for)")],
        hz=5,
    )
    yield draw(
        "de_halt_on_autobahn",
        bab(limit=120),
        [ego(Straight(50, DR, [(0, 24), (3, 24), (16, 0)])), Actor("c", "car", Straight(10, DL, 33))],
        {"nation": "de", "light": "night"},
        35,
        [
            ("stvo.ri1", "fail", "comes to stand in the right lane, nobody ahead, no hazard lights"),
            ("ukhc.r240.no-stopping", "fail", "stands 19 s on the carriageway"),
        ],
    )
    yield draw(
        "de_panne_standstreifen",
        bab(limit=120),
        [
            ego(
                Straight(50, DR, [(0, 24), (3, 24), (16, 0)], moves=[(6, 5, DS)]),
                ind=[(0, "off"), (5, "right"), (9, "hazard")],
            )
        ],
        DE,
        30,
        [
            ("stvo.ri1", "not fail", "breaks down with hazard lights on"),
            ("ukhc.r269.hard-shoulder", "not fail", "stops there with hazard lights"),
        ],
    )
    yield draw(
        "de_rechts_ueberholt",
        bab(tf=(0, 0, 140)),
        [ego(Straight(50, DM, 36)), Actor("c", "car", Straight(120, DL, 29), span=(0, 16))],
        DE,
        20,
        [
            (
                "stvo.ri2",
                "fail",
                "passes a car at 104 km/h in the lane to its left; the car vanishes from the log after that",
            )
        ],
    )
    yield draw(
        "de_kolonne_rechts",
        bab(),
        [
            ego(Straight(50, DM, 15.5)),
            *[Actor(f"k{i}", ("car", "van", "truck")[i % 3], Straight(80 + 24 * i, DL, 12)) for i in range(5)],
            Actor("a", "car", Straight(120, DM, 15.5)),
        ],
        DE,
        28,
        [
            ("stvo.ri2", "not fail", "a queue at 43 km/h passed with 13 km/h more"),
            ("stvo.rg1", "pass", "65 m behind the next"),
        ],
    )
    yield draw(
        "de_ausfahrt_verpasst",
        bab(limit=100),
        [
            ego(Straight(500, DR, [(0, 0), (3, 0), (6, -4.5), (14, -4.5), (17, 0)]), noise=0.05),
            Actor("c", "car", Straight(100, DL, 30)),
        ],
        DE,
        22,
        [
            ("stvo.ri3", "fail", "backs 49 m along the right lane of an Autobahn"),
            ("ukhc.r263.no-reverse", "fail", "backwards along a motorway"),
        ],
    )
    yield draw(
        "de_lkw_30m_trailer",
        bab(limit=100),
        [
            ego(Straight(60, DR, 22.5), "truck"),
            Actor("hanger", "trailer", Straight(50.2, DR, 22.5), size=(7.2, 2.5, 3.8)),
            Actor("l", "truck", Straight(102, DR, 22.5)),
        ],
        {"nation": "de", "vehicle_class": "goods_over_7t5"},
        16,
        [("stvo.s4-truck", "fail", "30 m behind at 81 km/h"), ("ukhc.no-collision", "not fail", "its own trailer")],
        hz=25,
    )
    yield draw(
        "de_bus_95",
        bab(limit=120),
        [ego(Straight(20, DR, 26.3), "bus")],
        DE,
        18,
        [("stvo.rg3", "not pass", "a bus at 95 km/h: 80 hold, 100 for an approved coach, which nobody can tell")],
    )
