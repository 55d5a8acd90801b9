"""Germany: towns and country roads, cyclists, lights and stop signs."""

from __future__ import annotations

from tests.outsiders.sixth.crossroads import lit, through, with_stop_sign
from tests.outsiders.sixth.drive import Chapter, Drive
from tests.outsiders.sixth.maps import OWN, german_town


def german_roads() -> list[Drive]:
    chapter = Chapter()

    d = chapter.draw(
        "de_rad_zu_eng_h",
        "The ego passes a cyclist in town with 1 m between, and comes back too soon.",
        "fail stvo.s5-passing | pass stvo.rg3",
        german_town(width=3.25),
        20,
    )
    d.add("ego", s=30, v=12.5, u=[(4, 1.6), (6.5, 0.7), (11, 0.7), (13, 1.6)]).add(
        "rad", s=110, v=5.5, u=2.9, cls="bicycle"
    )

    d = chapter.draw(
        "de_rad_mit_abstand_h",
        "The ego passes a cyclist in town with 2.1 m between.",
        "pass stvo.s5-passing | not fail r163.cyclist",
        german_town(width=3.25),
        20,
    )
    d.add("ego", s=30, v=12.5, u=[(3, 1.6), (6, -0.4), (12, -0.4), (14, 1.6)]).add(
        "rad", s=110, v=5.5, u=2.9, cls="bicycle"
    )

    d = chapter.draw(
        "de_rad_landstrasse_h",
        "The ego passes a cyclist on a country road with 1.6 m between.",
        "fail stvo.s5-passing | pass stvo.rg3",
        german_town(kind="rural", speed=100, walk=False, length=900),
        20,
        hz=20,
    )
    d.add("ego", s=30, v=24, u=[(2, OWN), (4.5, 0.1), (10, 0.1), (12, OWN)]).add(
        "rad", s=160, v=6.5, u=2.9, cls="bicycle"
    )

    d = chapter.draw(
        "de_zwei_raeder_noise_h",
        "The ego squeezes past two cyclists, one of unknown class, recorded with noise.",
        "fail stvo.s5-passing",
        german_town(width=3.5),
        24,
        hz=5,
        noise=0.05,
    )
    d.add("ego", s=30, v=11.5, u=1.6).add("r1", s=100, v=5.0, u=2.95, cls="bicycle").add(
        "r2", s=108, v=5.0, u=3.0, cls=None, size=(1.8, 0.6, 1.7)
    )

    d = chapter.draw(
        "de_rad_an_der_ampel_h",
        "A cyclist draws up beside the ego, which stands in a queue.",
        "not fail stvo.s5-passing",
        german_town(),
        34,
    )
    d.add("ego", s=60, v=[(0, 9), (4, 9), (9, 0), (22, 0), (25, 6), (34, 9)], u=1.5).add(
        "stau", s=130, v=[(0, 0), (19, 0), (23, 8)], u=1.5
    )
    d.add("rad", s=54, v=[(0, 5), (11, 5), (13, 2.5), (14.5, 0), (22.5, 0), (26, 5)], u=3.15, cls="bicycle")

    d = chapter.draw(
        "de_ohne_schild_70_h",
        "The ego does 68 km/h in a town whose map has no limit.",
        "fail stvo.rg3",
        german_town(speed=None),
        18,
    )
    d.add("ego", s=30, v=[(0, 14), (5, 19), (18, 19)], u=OWN)

    d = chapter.draw(
        "de_wohnwagen_land_h",
        "The ego tows a caravan at 94 km/h on a country road.",
        "fail stvo.rg3",
        german_town(kind="rural", speed=None, walk=False, length=900),
        20,
        vehicle_class="car_towing",
    )
    d.add("ego", s=60, v=26, u=OWN).add("ww", s=60 - 2.25 - 3.4, v=26, u=OWN, cls="trailer", size=(6.5, 2.3, 2.6))

    d = chapter.draw("de_rot_geradeaus_h", "The ego crosses the stop line on red.", "fail r175.red", lit("de", 50), 25)
    d.add("ego", through("s", "n"), s=100, v=12.5, u=OWN).light("tl1", (0, "green"), (2, "amber"), (5, "red"))

    d = chapter.draw(
        "de_pfeil_links_h",
        "The ego turns left on a green arrow beside a red light.",
        "not fail r175.red",
        lit("de", 50),
        25,
    )
    d.map["1"].signal("pf1", 2.0, -1, "1000012", name="filter_arrow_left")
    d.add("ego", through("s", "w"), s=120, v=[(0, 9), (6, 6), (20, 6)], u=OWN, ind=[(2, "left")]).light(
        "tl1", (0, "red")
    ).light("pf1", (0, "red"), (4, "green"))

    d = chapter.draw(
        "de_pfeil_missachtet_h",
        "The ego goes straight on while only the arrow to the left is green.",
        "not pass r175.red",
        lit("de", 50),
        25,
    )
    d.map["1"].signal("pf1", 2.0, -1, "1000012", name="filter_arrow_left")
    d.add("ego", through("s", "n"), s=100, v=12, u=OWN).light("tl1", (0, "red")).light("pf1", (0, "red"), (3, "green"))

    d = chapter.draw(
        "de_links_vor_gegenverkehr_h",
        "The ego turns left before an oncoming car, which brakes and is touched.",
        "fail r180.right-turn-gap",
        lit("de", 50),
        22,
    )
    d.add("ego", through("s", "w"), s=120, v=[(0, 9), (5, 7), (22, 7)], u=OWN, ind=[(2, "left"), (16, "off")]).light(
        "tl1", (0, "green")
    ).light("tl3", (0, "green"))
    d.add(
        "gegen",
        through("n", "s"),
        s=212 - 16 - 13.5 * 10.4,
        v=[(0, 13.5), (10.6, 13.5), (12.6, 4), (22, 4)],
        u=OWN,
        soft=0.2,
    )

    d = chapter.draw(
        "de_stop_gerollt_h",
        "The ego rolls past a stop sign.",
        "fail stvo.rin1 r171.stop-sign",
        with_stop_sign("de", 50),
        25,
    )
    d.add(
        "ego",
        through("s", "e"),
        s=120,
        v=[(0, 10), (4, 10), (9, 2.2), (12, 2.2), (15, 6), (25, 8)],
        u=OWN,
        ind=[(4, "right"), (18, "off")],
    )

    d = chapter.draw(
        "de_stop_gehalten_h",
        "The ego stops at the line of a stop sign.",
        "pass stvo.rin1 r171.stop-sign performance.precise-stop",
        with_stop_sign("de", 50),
        30,
    )
    d.add(
        "ego",
        through("s", "e"),
        s=198 - 0.15 - 0.3 - 2.25 - 66,
        v=[(0, 10), (3, 10), (10.2, 0), (13.5, 0), (17, 6), (30, 8)],
        u=OWN,
        ind=[(4, "right"), (22, "off")],
    )
    return chapter.drives
