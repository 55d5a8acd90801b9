"""Germany: speed, stopping and sides on motorways."""

from __future__ import annotations

from tests.outsiders.sixth.drive import Chapter, Drive
from tests.outsiders.sixth.maps import autobahn, beside


def german_motorways() -> list[Drive]:
    chapter = Chapter()

    d = chapter.draw(
        "de_a_too_fast_100_h",
        "The ego does 128 km/h where 100 are allowed.",
        "fail stvo.rg3",
        autobahn(speed=100),
        15,
        hz=20,
    )
    d.add("ego", s=60, v=[(0, 36), (15, 34)], u=beside(2)).add("o", s=300, v=27, u=beside(4))

    d = chapter.draw(
        "de_a_lorry_95_h",
        "A lorry does 96 km/h on the Autobahn.",
        "fail stvo.rg3 | not fail stvo.s4-truck",
        autobahn(),
        20,
        vehicle_class="goods_over_7t5",
    )
    d.add("ego", s=60, v=26.6, u=beside(4), cls="truck")

    d = chapter.draw("de_a_crawler_h", "The ego does 51 km/h on a free Autobahn.", "fail stvo.rg4", autobahn(), 40)
    d.add("ego", s=60, v=14.2, u=beside(4)).add("o1", s=0, v=32, u=beside(3)).add("o2", s=-200, v=34, u=beside(2))

    d = chapter.draw(
        "de_a_picnic_stop_h",
        "The ego stops on the Autobahn for nobody.",
        "fail stvo.ri1 r240.no-stopping",
        autobahn(),
        45,
    )
    d.add("ego", s=300, v=[(0, 22), (3, 22), (15, 0), (45, 0)], u=[(0, beside(4)), (15, beside(4) + 0.6)])

    d = chapter.draw(
        "de_a_jam_stop_h",
        "The ego stands in a jam on the Autobahn.",
        "not fail stvo.ri1 r240.no-stopping",
        autobahn(),
        45,
    )
    d.add("ego", s=100, v=[(0, 20), (3, 20), (14, 1), (16, 0), (40, 0), (45, 3)], u=beside(2))
    d.add("f", s=100 + 4.5 + 110, v=[(0, 8), (6, 8), (12, 0), (38, 0), (45, 4)], u=beside(2)).add(
        "g", s=300, v=[(0, 5), (11, 0), (45, 0)], u=beside(3), cls="truck"
    )

    d = chapter.draw(
        "de_a_right_overtaker_h", "The ego passes a car on the right at 126 km/h.", "fail stvo.ri2", autobahn(), 25
    )
    d.add("ego", s=60, v=35, u=beside(3)).add("left", s=180, v=28, u=beside(2)).add("left2", s=500, v=28.5, u=beside(2))

    d = chapter.draw(
        "de_a_right_past_queue_h",
        "The ego passes a queue on the right, little faster than it.",
        "pass stvo.ri2 | not fail stvo.rg4",
        autobahn(),
        30,
    )
    for i in range(5):
        d.add(f"q{i}", s=130 + 16 * i, v=10, u=beside(2))
    d.add("ego", s=60, v=13.5, u=beside(3)).add("ahead", s=150, v=13.8, u=beside(3), cls="van")

    d = chapter.draw(
        "de_a_right_past_queue_fast_h",
        "The ego passes a queue on the right, 36 km/h faster than it.",
        "fail stvo.ri2",
        autobahn(),
        16,
    )
    for i in range(5):
        d.add(f"q{i}", s=120 + 16 * i, v=9, u=beside(2))
    d.add("ego", s=60, v=19, u=beside(3))

    d = chapter.draw(
        "de_a_turns_round_h",
        "The ego drives back the way that it came on the Autobahn.",
        "fail stvo.ri3 r143.direction",
        autobahn(length=900),
        30,
    )
    d.add("ego", s=700, v=[(0, 8), (3, 8), (6, 10), (30, 20)], u=beside(4), against=True).add(
        "x", s=20, v=30, u=beside(3)
    )

    d = chapter.draw(
        "de_a_reverses_h",
        "The ego reverses along the hard shoulder.",
        "fail r263.no-reverse | not pass stvo.ri3",
        autobahn(),
        25,
        vehicle_class="car",
    )
    d.add("ego", s=500, v=[(0, 6), (5, 0), (7, 0), (9, -2.2), (20, -2.2), (22, 0)], u=beside(5))
    return chapter.drives
