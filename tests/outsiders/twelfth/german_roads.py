"""Germany: streets and roads outside towns."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.twelfth.cast import (
    DE,
    ND,
    OD,
    ego,
)
from tests.outsiders.twelfth.drive import Actor, Drive, draw
from tests.outsiders.twelfth.junction import Cross
from tests.outsiders.twelfth.maps import (
    land,
    stadt,
)
from tests.outsiders.twelfth.ways import Straight


def german_roads() -> Iterator[Drive]:
    yield draw(
        "de_radfahrer_innerorts",
        stadt(),
        [
            ego(Straight(50, ND, 12)),
            Actor("b", "bicycle", Straight(105, -3.05, 5), noise=0.02),
            Actor("o", "car", Straight(500, OD, 12, way=-1)),
        ],
        DE,
        18,
        [("stvo.s5-passing", "fail", "0.1 m beside a cyclist in a town")],
    )
    yield draw(
        "de_radfahrer_ausserorts_17",
        land(tf=(0, 0, 270)),
        [ego(Straight(50, ND, 19, moves=[(1, 2, -0.1), (9, 2, -1.75)])), Actor("b", "bicycle", Straight(150, -3.0, 6))],
        DE,
        16,
        [("stvo.s5-passing", "fail", "1.7 m outside towns, 2 m are due")],
    )
    c = Cross(False, lights=(0, 1, 2, 3), w=4.0, limit=50, unit="km/h")
    yield draw(
        "de_radfahrer_an_der_ampel",
        c.map,
        [
            ego(c.drive(0, 2, 110, [(0, 10), (2, 10), (5.2, 0), (16, 0), (20, 8)], off=0.4)),
            Actor("b", "bicycle", c.drive(0, 2, 100, [(0, 4.2), (10, 4.2), (11.5, 0), (15.5, 0), (18, 4.5)], off=-1.5)),
        ],
        DE,
        26,
        [
            ("stvo.s5-passing", "not fail", "the cyclist rode up beside the car that stood at the red light"),
            ("ukhc.r175.red", "pass", "waits on red"),
        ],
        lights={
            "L0": [(0, "red"), (15, "red_amber"), (16, "green")],
            "L2": [(0, "red"), (16, "green")],
            "L1": [(0, "green"), (12, "red")],
            "L3": [(0, "green"), (12, "red")],
        },
    )
    c = Cross(False, stops=(0,), limit=50, unit="km/h", tf=(100, 50, 65))
    yield draw(
        "de_stopschild_gerollt",
        c.map,
        [ego(c.drive(0, 3, 84, [(0, 9), (5, 9), (8, 2.2), (10, 2.2), (13, 7)]), ind=[(0, "left")])],
        DE,
        22,
        [("stvo.rin1", "fail", "rolls over the stop line at 2.2 m/s")],
    )
    c = Cross(False, stops=(0,), limit=50, unit="km/h")
    yield draw(
        "de_stopschild_halt",
        c.map,
        [
            ego(c.drive(0, 2, 86, [(0, 9), (5, 9), (8.3333, 0), (11, 0), (15, 8)]), noise=0.01),
            Actor("q", "motorcycle", c.drive(1, 3, 60, 10)),
        ],
        DE,
        22,
        [
            ("stvo.rin1", "pass", "stands 2.7 s, 0.3 m before the line"),
            ("ukhc.no-collision", "pass", "lets the motorcycle by"),
        ],
    )
    yield draw(
        "de_stadt_ohne_tafel_64",
        stadt(limit=None),
        [ego(Straight(20, ND, 17.8)), Actor("bus", "bus", Straight(680, OD, [(0, 8), (9, 0)], way=-1))],
        {"nation": "de", "weather": "wet"},
        20,
        [("stvo.rg3", "fail", "64 km/h in a town, no sign in the map: 50 hold")],
    )
    yield draw(
        "de_lkw_landstrasse_76",
        land(),
        [ego(Straight(20, ND, 21.2), "truck")],
        {"nation": "de", "vehicle_class": "goods_over_7t5"},
        18,
        [("stvo.rg3", "fail", "76 km/h with a lorry over 7.5 t on a road outside towns, 60 allowed")],
    )
