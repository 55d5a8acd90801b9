"""Great Britain: cyclists, horses, parked vehicles, and what is declared."""

from __future__ import annotations

from tests.outsiders.sixth.drive import Chapter, Drive
from tests.outsiders.sixth.maps import OPP, OWN, british_town, country_road


def british_roads() -> list[Drive]:
    chapter = Chapter()

    d = chapter.draw(
        "gb_bike_squeezed_h",
        "The ego passes a cyclist with 25 cm to spare; five steps a second.",
        "fail r163.cyclist | pass no-collision",
        british_town(),
        25,
        hz=5,
        area="built_up",
    )
    d.add("ego", s=30, v=12.3, u=OWN - 0.1).add("bike", s=110, v=5.2, u=3.1, cls="bicycle").add(
        "onc", s=450, v=12, u=OPP, against=True
    )

    d = chapter.draw(
        "gb_bike_fast_1m6_h",
        "The ego passes a cyclist at 49 mph with 1.55 m to spare.",
        "fail r163.cyclist",
        country_road(),
        25,
    )
    d.add("ego", s=30, v=22, u=[(3, OWN), (6, -0.15), (12, -0.15), (15, OWN)]).add(
        "bike", s=150, v=6, u=2.6, cls="bicycle"
    )

    d = chapter.draw(
        "gb_bike_wide_h",
        "The ego passes a cyclist with 3 m to spare, recorded with noise.",
        "pass r163.cyclist r129.no-cross-solid",
        country_road(),
        25,
        noise=0.05,
    )
    d.add("ego", s=30, v=21, u=[(3, OWN), (6, -1.4), (12, -1.4), (15, OWN)]).add(
        "bike", s=150, v=6, u=2.8, cls="bicycle"
    )

    d = chapter.draw("gb_horse_rushed_h", "The ego passes a horse at 28 mph.", "fail r215.horse", country_road(), 25)
    d.add("ego", s=30, v=12.5, u=[(3, OWN), (6, -1.5), (14, -1.5), (17, OWN)]).add(
        "horse", s=130, v=1.8, u=2.6, cls="animal"
    )

    d = chapter.draw(
        "gb_horse_slow_h",
        "The ego passes a horse at 8 mph with 2.9 m between.",
        "pass r215.horse | not fail r143.direction",
        country_road(),
        40,
    )
    d.add(
        "ego", s=60, v=[(0, 10), (4, 10), (9, 3.6), (30, 3.6), (36, 10)], u=[(5, OWN), (9, -1.5), (28, -1.5), (33, OWN)]
    ).add("horse", s=150, v=1.2, u=2.7, cls="animal")

    d = chapter.draw(
        "gb_van_and_oncoming_h",
        "The ego goes round a parked van and touches the oncoming car, which had to brake.",
        "fail r163.obstruction-give-way no-collision",
        british_town(),
        25,
        hz=20,
    )
    d.add("ego", s=40, v=11, u=[(5, OWN), (8, -1.1), (12, -1.1), (15, OWN)]).add("van", s=155, v=0, u=2.4, cls="van")
    d.add("onc", s=299, v=[(0, 12.5), (8.0, 12.5), (11, 2.0), (13, 0.5), (17, 10)], u=OPP - 0.3, against=True)

    d = chapter.draw(
        "gb_van_waits_h",
        "The ego waits behind a parked van until the oncoming car has passed.",
        "pass no-collision | not fail r163.obstruction-give-way",
        british_town(),
        35,
    )
    d.add(
        "ego",
        s=40,
        v=[(0, 11), (3, 11), (9, 0), (17, 0), (21, 6), (35, 9)],
        u=[(18.5, OWN), (21.5, -1.1), (24, -1.1), (28, OWN)],
    ).add("van", s=131, v=0, u=2.5, cls="van")
    d.add("onc", s=280, v=12, u=OPP, against=True)

    d = chapter.draw(
        "gb_wrong_side_h",
        "The ego drives on the right-hand side for twenty seconds.",
        "fail r143.direction",
        country_road(),
        25,
        noise=0.02,
    )
    d.add("ego", s=40, v=19, u=[(2, OWN), (5, OPP), (25, OPP)])

    d = chapter.draw(
        "gb_over_pavement_h",
        "The ego passes a queue along the pavement.",
        "fail r145.off-road | pass no-collision",
        british_town(),
        18,
    )
    d.add("ego", s=40, v=9.5, u=[(3, OWN), (5, 4.6), (10, 4.6), (12, OWN)]).add("q", s=115, v=0.3, u=OWN).add(
        "q2", s=121, v=0.3, u=OWN
    )

    d = chapter.draw(
        "gb_scots_lorry_h",
        "A heavy lorry does 49 mph on a Scottish single carriageway; two steps a second.",
        "fail r124.speed-limit",
        country_road(),
        25,
        hz=2,
        nation="gb-sct",
        vehicle_class="goods_over_7t5",
    )
    d.add("ego", s=40, v=21.8, u=OWN, cls="truck")

    d = chapter.draw(
        "gb_night_parked_facing_h",
        "The ego parks at night facing the traffic.",
        "fail r248.parked-at-night r239.parked-with-traffic",
        british_town(),
        85,
        hz=2,
        light="night",
    )
    d.add("ego", s=300, v=[(0, 6), (4, 6), (8, 0), (85, 0)], u=[(0, OWN), (7, -2.4)])
    d.says(0, "headlights", "on")

    d = chapter.draw(
        "gb_declared_hurry_h",
        "The ego drives faster than it chose to, and signals without a look.",
        (
            "fail declared.r125.chosen-speed-kept declared.r152.speed-reason declared.r161.mirrors-before-signal | not "
            "fail r112.horn"
        ),
        country_road(kind="town", speed=30),
        25,
    )
    d.add("ego", s=20, v=[(0, 9), (3, 12.6), (25, 12.6)], u=OWN, ind=[(12, "left"), (16, "off")])
    d.says(0, "chosen_speed", "10").says(1, "mirror_check", "right").says(2, "horn", "off")

    d = chapter.draw(
        "gb_horn_standing_h",
        "The ego sounds its horn while it stands and nobody is about.",
        "fail r112.horn",
        country_road(kind="town", speed=30),
        30,
    )
    d.add("ego", s=20, v=[(0, 10), (3, 10), (8, 0), (30, 0)], u=OWN)
    d.says(0, "horn", "off").says(15, "horn", "on").says(17, "horn", "off")
    return chapter.drives
