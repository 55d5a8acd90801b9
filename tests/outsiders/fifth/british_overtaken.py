"""Great Britain: being overtaken, and overtaking in company, on country roads."""

from __future__ import annotations

from tests.outsiders.fifth.cast import (
    CAR,
    MOTO,
    TRUCK,
    drive,
    ego,
)
from tests.outsiders.fifth.drive import Drive, draw
from tests.outsiders.fifth.places import (
    OPPOSING,
    OWN,
    overtaking,
    single,
)
from tests.outsiders.fifth.ways import Speed


def british_overtaken() -> list[Drive]:
    found: list[Drive] = []
    world, road = single(((1400, 0.0),))
    found.append(
        draw(
            "gb_overtaken_races_g",
            "Accelerates at 1.3 m/s2 while the other is beside it in the opposing lane.",
            "fail r168.when-overtaken",
            world,
            [
                ego(road.along(OWN), Speed(19, 130).hold(3).to(25.5, 1.3), 20),
                drive(
                    "rival",
                    "car",
                    CAR,
                    road.path((0, OWN), (125, OWN), (165, OPPOSING), (620, OPPOSING), (670, OWN), (1400, OWN)),
                    Speed(28, 100),
                    20,
                ),
            ],
        )
    )
    world, road = single(((1400, 0.0),))
    found.append(
        draw(
            "gb_overtaken_eases_g",
            "Keeps its line and eases off.",
            "pass r168.when-overtaken r124.speed-limit",
            world,
            [
                ego(road.along(OWN), Speed(19, 150).hold(6).to(16.5, 0.6).hold(6).to(18, 0.7), 24),
                drive(
                    "rival",
                    "motorcycle",
                    MOTO,
                    road.path((0, OWN), (90, OWN), (150, OPPOSING), (600, OPPOSING), (660, OWN), (1400, OWN)),
                    Speed(26, 70),
                    24,
                ),
            ],
        )
    )
    world, road = single(((1600, 0.0),))
    found.append(
        draw(
            "gb_pulled_in_stays_close_g",
            "Stays some 10 m behind the car that pulled in at 51 mph, for 20 s.",
            "fail r168.drop-back r126.thinking-gap",
            world,
            [
                ego(road.along(OWN), Speed(23, 100), 32),
                drive(
                    "rival",
                    "car",
                    CAR,
                    road.path((0, OPPOSING), (350, OPPOSING), (405, OWN), (1600, OWN)),
                    Speed(27, 75).hold(9).to(23, 2),
                    32,
                ),
            ],
        )
    )
    world, road = single(((1600, 0.0),))
    found.append(
        draw(
            "gb_pulled_in_drops_back_g",
            "More than two seconds again within some 5 s.",
            "pass r168.drop-back no-collision",
            world,
            [
                ego(road.along(OWN), Speed(23, 100).hold(9.5).to(17, 1.3).hold(2).to(19.5, 0.6), 34),
                drive(
                    "rival",
                    "car",
                    CAR,
                    road.path((0, OPPOSING), (330, OPPOSING), (390, OWN), (1600, OWN)),
                    Speed(27, 75).hold(14).to(23, 1),
                    34,
                ),
            ],
        )
    )
    world, road = single(((1400, 0.0),))
    found.append(
        draw(
            "gb_pulls_out_before_overtaker_g",
            "Pulls out when a faster car is already in the opposing lane less than 4 s behind.",
            "fail r162.not-being-overtaken",
            world,
            [
                ego(overtaking(road, 205, 420), Speed(19, 80), 24),
                drive("lorry", "truck", TRUCK, road.along(OWN), Speed(12, 190), 24),
                drive(
                    "fast",
                    "car",
                    CAR,
                    road.path((0, OWN), (60, OWN), (110, OPPOSING), (1400, OPPOSING)),
                    Speed(28.5, 14).hold(6).to(19, 4.5),
                    24,
                ),
            ],
        )
    )
    world, road = single(((1700, 0.0),))
    found.append(
        draw(
            "gb_platoon_no_gap_g",
            "Overtakes four cars at once, with all the road before the last of them.",
            "pass r162.return-gap",
            world,
            [
                ego(overtaking(road, 150, 560), Speed(23), 35),
                *[drive(f"c{i}", "car", CAR, road.along(OWN), Speed(14, 120 + 11.5 * i), 35) for i in range(4)],
            ],
        )
    )
    world, road = single(((1500, 0.0),))
    found.append(
        draw(
            "gb_tailgate_then_out_g",
            "6 m behind at 40 mph, where thinking alone takes 12 m.",
            "fail r126.thinking-gap criticality.thw r163.pull-out-separation",
            world,
            [
                ego(overtaking(road, 296, 520, 40), Speed(18).hold(17.3).to(24, 2).hold(9).to(20, 1), 38),
                drive("car", "car", CAR, road.along(OWN), Speed(18, 30.2), 38, ind=None),
            ],
        )
    )
    return found
