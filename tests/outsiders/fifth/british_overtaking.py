"""Great Britain: overtaking, and being overtaken, on country roads."""

from __future__ import annotations

from tests.outsiders.fifth.cast import (
    BIKE,
    CAR,
    TRUCK,
    VAN,
    drive,
    ego,
    noisy,
)
from tests.outsiders.fifth.drive import Drive, draw
from tests.outsiders.fifth.places import (
    OPPOSING,
    OWN,
    overtaking,
    single,
)
from tests.outsiders.fifth.road import signal
from tests.outsiders.fifth.ways import Speed


def british_overtaking() -> list[Drive]:
    found: list[Drive] = []
    world, road = single()
    found.append(
        draw(
            "gb_overtake_squeezed_g",
            "380 m of road were left and the manoeuvre takes 9 s at closing 46 m/s, over 400 m; the "
            "other had to brake hard.",
            "fail r162.safe-distance-ahead rss.opposite | not pass overtake-zone | pass no-collision",
            world,
            [
                ego(overtaking(road, 140, 310), Speed(22), 24, ind=((4, 8, "right"), (12, 15, "left"))),
                drive("lorry", "truck", (9.5, 2.4, 3.4), road.along(OWN), Speed(13, 120), 24),
                drive(
                    "car", "car", CAR, road.back(OPPOSING), Speed(24, 900 - 655).hold(10).to(5, 4).hold(3).to(18, 2), 24
                ),
            ],
        )
    )
    world, road = single(((1900, 0.0),))
    found.append(
        draw(
            "gb_overtake_ample_g",
            "Over a kilometre to the oncoming car.",
            "pass r162.safe-distance-ahead no-collision | not fail r143.direction",
            world,
            [
                ego(overtaking(road, 150, 330), Speed(21), 30, ind=((4, 9, "right"), (13, 17, "left"))),
                drive("tractor", "truck", (6.5, 2.3, 2.9), road.along(OWN), Speed(9, 150), 30),
                drive("car", "car", CAR, road.back(OPPOSING), Speed(22, 1900 - 1450), 30),
            ],
        )
    )
    world, road = single(((150, 0.0), (400, 1 / 380), (300, 0.0)), mark="solid solid")
    found.append(
        draw(
            "gb_overtake_solid_bend_g",
            "Crosses a double solid line to overtake a car at 26 mph.",
            "fail r129.no-cross-solid | pass r124.speed-limit",
            world,
            [
                ego(overtaking(road, 160, 330), Speed(20), 26),
                drive("car", "car", CAR, road.along(OWN), Speed(11.5, 125), 26),
            ],
        )
    )
    world, road = single(mark="solid solid")
    found.append(
        draw(
            "gb_solid_slow_cyclist_g",
            "Straddles a solid line only to pass a cyclist at 8 mph, which R129 allows.",
            "not fail r129.no-cross-solid | pass r163.cyclist",
            world,
            [
                ego(road.path((20, OWN), (90, OWN), (120, -0.25), (190, -0.25), (220, OWN), (500, OWN)), Speed(10), 30),
                drive("bike", "bicycle", BIKE, road.along(2.9), Speed(3.6, 90), 30),
            ],
        )
    )
    world, road = single(mark="solid solid")
    found.append(
        draw(
            "gb_solid_quick_cyclist_g",
            "Straddles a solid line for a cyclist at 16.5 mph, who is too fast for the exception.",
            "fail r129.no-cross-solid | pass r163.cyclist",
            world,
            [
                noisy(
                    ego(
                        road.path((20, OWN), (120, OWN), (160, -0.9), (290, -0.9), (330, OWN), (800, OWN)),
                        Speed(14),
                        30,
                    ),
                    1,
                    0.03,
                ),
                drive("bike", "bicycle", BIKE, road.along(2.9), Speed(7.4, 110), 30),
            ],
        )
    )
    world, road = single(mark=[(0, "broken"), (300, "solid solid")])
    found.append(
        draw(
            "gb_back_late_solid_g",
            "30 m and more into the solid line before it begins to come back.",
            "fail r128.back-before-solid r129.no-cross-solid",
            world,
            [
                ego(overtaking(road, 140, 330), Speed(21), 25),
                drive("van", "van", VAN, road.along(OWN), Speed(12, 125), 25),
            ],
        )
    )
    world, road = single(mark=[(0, "broken"), (520, "solid solid")])
    found.append(
        draw(
            "gb_back_in_time_g",
            "Back 160 m before the line gets solid.",
            "pass r128.back-before-solid | not fail r129.no-cross-solid",
            world,
            [
                ego(overtaking(road, 140, 310), Speed(21), 27),
                drive("van", "van", VAN, road.along(OWN), Speed(11, 125), 27),
            ],
        )
    )
    world, road = single(signals=[signal("n1", "no_overtaking", 80, 4.4, "+", "632", "GB", (1, 1))])
    found.append(
        draw(
            "gb_sign_no_overtaking_g",
            "Overtakes a moving lorry 90 m after the no-overtaking sign.",
            "fail r165.no-overtaking-sign",
            world,
            [
                ego(overtaking(road, 170, 340), Speed(20), 27),
                drive("lorry", "truck", TRUCK, road.along(2.0), Speed(11, 140), 27, t0=2.3),
            ],
        )
    )
    world, road = single(
        signals=[
            signal("n1", "no_overtaking", 60, 4.4, "+", "632", "GB", (1, 1)),
            signal("n2", "overtaking_end", 190, 4.4, "+", "-1", "", (1, 1)),
        ]
    )
    found.append(
        draw(
            "gb_sign_ended_g",
            "The prohibition ended 50 m before it pulled out.",
            "not fail r165.no-overtaking-sign",
            world,
            [
                ego(overtaking(road, 240, 420), Speed(20), 30),
                drive("lorry", "truck", TRUCK, road.along(OWN), Speed(11, 175), 30),
            ],
        )
    )
    world, road = single(signals=[signal("n1", "no_overtaking", 60, 4.4, "+", "632", "GB", (1, 1))])
    found.append(
        draw(
            "gb_sign_standing_van_g",
            "A standing van is no moving vehicle.",
            "not fail r165.no-overtaking-sign r143.direction",
            world,
            [
                ego(overtaking(road, 185, 235, 35, t1=-1.2), Speed(11), 30),
                drive("van", "van", VAN, road.along(2.3), Speed(0, 230), 30),
            ],
        )
    )
    return found
