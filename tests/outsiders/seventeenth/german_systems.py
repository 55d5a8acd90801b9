"""Germany: the automated driver on a motorway."""

from __future__ import annotations

from tests.outsiders.seventeenth.cast import DE3
from tests.outsiders.seventeenth.drive import Drive, draw, go

DRIVES: list[Drive] = [
    draw(
        "auto_gap_15",
        DE3,
        [go("ego", 15, 50, -9.125), go("l", 15, 69.5, -9.125)],
        25,
        [("alks-r157.follow-gap", "fail", "15 m at 54 km/h, some 24 m asked")],
        nation="de",
        more={"engaged": "yes"},
        noise=0.02,
    ),
    draw(
        "auto_cut_in_kept",
        DE3,
        [go("ego", 15, 50, -9.125), go("c", 15, 62.5, -9.125, off=((0, 3.65), (5, 3.65), (8, 0)))],
        30,
        [("alks-r157.cut-in-gap", "fail", "8 m for 20 s")],
        nation="de",
        more={"engaged": "yes"},
    ),
    draw(
        "auto_cut_in_restored",
        DE3,
        [
            go("ego", ((0, 15), (8, 15), (10, 11.5), (18, 11.5), (20, 15)), 50, -9.125),
            go("c", 15, 62.5, -9.125, off=((0, 3.65), (5, 3.65), (8, 0))),
        ],
        30,
        [("alks-r157.cut-in-gap", "pass", "there again"), ("stvo.rg6", "not fail", "the ego changed no lane")],
        nation="de",
        more={"engaged": "yes"},
    ),
    draw(
        "auto_cut_in_struck",
        DE3,
        [go("ego", 22, 50, -9.125), go("c", 10, 171.5, -9.125, off=((0, 3.65), (5.5, 3.65), (8, 0)))],
        14,
        [
            ("ukhc.no-collision", "fail", "struck at 9.8 s"),
            ("stvo.rg1", "fail", "0.6 m at 12 m/s more, 3.3 s after the other came over"),
        ],
        nation="de",
        more={"engaged": "yes"},
    ),
    draw(
        "auto_brakes_hard",
        DE3,
        [go("ego", ((0, 25), (6, 25), (8.5, 8), (20, 8)), 50, -9.125)],
        20,
        [("alks-r157.emergency", "fail", "6.8 m/s2 undeclared"), ("comfort.nuplan", "fail", "6.8 m/s2")],
        nation="de",
        more={"engaged": "yes"},
        events=[(0, "emergency_manoeuvre", "off")],
    ),
    draw(
        "auto_mrm_hard",
        DE3,
        [go("ego", ((0, 25), (5.5, 25), (10, 2.5), (11, 0)), 50, -9.125, ind=((0, "off"), (5.1, "hazard")))],
        20,
        [("alks-r157.mrm", "fail", "5 m/s2 for 4.5 s"), ("alks-r157.mrm-hazards", "pass", "on")],
        nation="de",
        more={"engaged": "yes"},
        events=[(0, "minimal_risk_manoeuvre", "off"), (5, "minimal_risk_manoeuvre", "on")],
    ),
    draw(
        "auto_mrm_dark",
        DE3,
        [go("ego", ((0, 25), (5.5, 25), (14, 0)), 50, -9.125, ind=((0, "off"), (8.5, "hazard")))],
        20,
        [("alks-r157.mrm", "pass", "2.9 m/s2"), ("alks-r157.mrm-hazards", "fail", "3.5 s late")],
        nation="de",
        more={"engaged": "yes"},
        events=[(0, "minimal_risk_manoeuvre", "off"), (5, "minimal_risk_manoeuvre", "on")],
    ),
    draw(
        "auto_change_short",
        DE3,
        [go("ego", 28, 50, -9.125, off=((6.5, 0), (10, 3.65)), ind=((0, "off"), (6, "left"), (11, "off")))],
        26,
        [
            ("alks-r157.r79.lane-change", "fail", "indicator from 6.0 s, over the line about 7.7 s"),
            ("alks-r157.r79.lane-change-done", "pass", "3.5 s in all"),
        ],
        nation="de",
        more={"engaged": "yes"},
    ),
    draw(
        "auto_change_slow",
        DE3,
        [
            go(
                "ego",
                28,
                50,
                -9.125,
                off=((5.5, 0), (8, 1.3), (15, 2.2), (18, 3.65)),
                ind=((0, "off"), (5, "left"), (20, "off")),
            )
        ],
        26,
        [("alks-r157.r79.lane-change-done", "fail", "13.5 s in all")],
        nation="de",
        more={"engaged": "yes"},
    ),
]
