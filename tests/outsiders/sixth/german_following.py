"""Germany: distances and lane changes on motorways."""

from __future__ import annotations

from tests.outsiders.sixth.drive import Chapter, Drive
from tests.outsiders.sixth.maps import autobahn, beside


def german_following() -> list[Drive]:
    chapter = Chapter()

    d = chapter.draw(
        "de_a_draengler_h",
        "The ego follows a van on the Autobahn at 131 km/h, 8 m behind it.",
        "fail stvo.rg1 criticality.thw r126.thinking-gap | not fail stvo.rg3",
        autobahn(),
        22,
    )
    d.add("ego", s=60, v=36.5, u=beside(2)).add(
        "lead", s=60 + 4.5 + 8.5, v=36.5, u=beside(2), cls="van", size=(5.0, 2.0, 2.4)
    )

    d = chapter.draw(
        "de_a_distance_kept_h",
        "The ego follows a car on the Autobahn with 50 m between.",
        "pass stvo.rg1 stvo.rg3 stvo.ri3",
        autobahn(speed=120),
        30,
        hz=5,
    )
    d.add("ego", s=60, v=31.5, u=beside(3)).add("lead", s=130, v=31.0, u=beside(3)).add(
        "lw", s=250, v=24, u=beside(4), cls="truck"
    )

    d = chapter.draw(
        "de_a_brake_test_h",
        "The ego brakes hard on a free Autobahn before a follower.",
        "fail stvo.rg2 | pass no-collision",
        autobahn(),
        20,
    )
    d.add("ego", s=200, v=[(0, 33), (6, 33), (9, 18), (12, 18), (20, 27)], u=beside(2)).add(
        "tail", s=140, v=[(0, 33), (7, 33), (10.5, 17), (20, 25)], u=beside(2)
    )

    d = chapter.draw(
        "de_a_brake_for_jam_h",
        "The ego brakes for the end of a jam, and longer than the car ahead.",
        "fail stvo.rg2 | pass no-collision",
        autobahn(),
        24,
    )
    d.add("ego", s=100, v=[(0, 33), (4, 33), (14, 4), (24, 4)], u=beside(2)).add(
        "jam", s=345, v=[(0, 20), (1, 20), (9, 3.5), (24, 3.5)], u=beside(2)
    )
    d.add("jam2", s=360, v=[(0, 15), (8, 3.5), (24, 3.5)], u=beside(3))

    d = chapter.draw(
        "de_a_slow_behind_convoy_h",
        "The ego follows a slow heavy transport.",
        "pass stvo.rg1 | not fail stvo.rg4",
        autobahn(),
        30,
    )
    d.add("ego", s=60, v=15, u=beside(4)).add("heavy", s=60 + 40, v=15, u=beside(4), cls="truck", size=(22, 3, 4))

    d = chapter.draw(
        "de_a_pull_out_before_fast_h",
        "The ego changes lane right before a much faster car and touches it.",
        "fail stvo.rg6 r162.not-being-overtaken",
        autobahn(),
        18,
    )
    d.add("ego", s=400, v=25, u=[(5, beside(4)), (8, beside(3))], ind=[(4.5, "left"), (9, "off")])
    d.add("lkw", s=470, v=22, u=beside(4), cls="truck")
    d.add("fast", s=400 - 26 - 5 * 19.5, v=[(0, 44.5), (6.2, 44.5), (9, 25), (18, 24.5)], u=beside(3))

    d = chapter.draw(
        "de_a_lane_change_good_h",
        "The ego changes lane with 160 m to the next car behind.",
        "pass stvo.rg6 | not fail r162.not-being-overtaken",
        autobahn(),
        18,
    )
    d.add("ego", s=400, v=30, u=[(7, beside(4)), (12, beside(3))], ind=[(3, "left"), (12.5, "off")])
    d.add("lkw", s=560, v=23, u=beside(4), cls="truck").add("far", s=220, v=32, u=beside(3))

    d = chapter.draw(
        "de_a_lorry_close_h",
        "A lorry follows another, 27 m behind it; the map has no limit.",
        "fail stvo.s4-truck | not fail stvo.rg3",
        autobahn(speed=None),
        30,
        vehicle_class="goods_over_7t5",
    )
    d.add("ego", s=60, v=22.0, u=beside(4), cls="truck", size=(16.5, 2.5, 4)).add(
        "lead", s=60 + 8.25 + 6 + 27, v=22.0, u=beside(4), cls="truck"
    )

    d = chapter.draw(
        "de_a_lorry_cut_in_h",
        "A car moves in before a lorry and draws away.",
        "pass no-collision | not fail stvo.s4-truck",
        autobahn(),
        30,
        vehicle_class="goods_7t5",
    )
    d.add("ego", s=60, v=[(0, 22), (8, 22), (10, 19.5), (30, 19.5)], u=beside(4), cls="truck")
    d.add("car", s=70, v=[(0, 27), (30, 32)], u=[(6, beside(3)), (9, beside(4))])

    d = chapter.draw(
        "de_a_lorry_jam_h",
        "A lorry follows another in slow traffic, 24 m behind it.",
        "pass r126.thinking-gap | not fail stvo.s4-truck",
        autobahn(),
        25,
        vehicle_class="goods_over_7t5",
    )
    d.add("ego", s=60, v=12.0, u=beside(4), cls="truck").add("lead", s=60 + 12 + 24, v=12.0, u=beside(4), cls="truck")

    d = chapter.draw(
        "de_a_bus_in_curve_h",
        "A bus follows a car through a long bend, 33 m behind it.",
        "fail stvo.s4-truck | not pass stvo.rg3",
        autobahn(bend=((300, 0), (900, -1 / 480))),
        30,
        vehicle_class="bus",
    )
    d.add("ego", s=40, v=25.5, u=beside(4), cls="bus").add("lead", s=40 + 6 + 2.25 + 33, v=25.5, u=beside(4))
    return chapter.drives
