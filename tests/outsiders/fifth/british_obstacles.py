"""Great Britain: parked vehicles, limits of a class, and driving by night."""

from __future__ import annotations

from tests.outsiders.fifth.cast import (
    BUS,
    CAR,
    TRUCK,
    VAN,
    drive,
    ego,
)
from tests.outsiders.fifth.drive import Drive, draw
from tests.outsiders.fifth.places import (
    OPPOSING,
    OWN,
    single,
)
from tests.outsiders.fifth.ways import Path, Speed


def british_obstacles() -> list[Drive]:
    found: list[Drive] = []
    world, road = single(kind="town", mph=30, walk=2.0)
    stands = 230
    found.append(
        draw(
            "gb_parked_van_forces_g",
            "Goes round the parked van in the face of an oncoming car, which has to stop hard.",
            "fail r163.obstruction-give-way",
            world,
            [
                ego(
                    road.path((20, OWN), (185, OWN), (208, -1.35), (245, -1.35), (270, OWN), (800, OWN)),
                    Speed(10.5),
                    34,
                ),
                drive("van", "van", VAN, road.along(2.4), Speed(0, stands), 34),
                drive(
                    "car",
                    "car",
                    CAR,
                    road.back(OPPOSING),
                    Speed(11, 900 - 485).hold(17.4).to(0, 4.2).hold(5).to(8, 1.5),
                    34,
                ),
            ],
        )
    )
    world, road = single(kind="town", mph=30, walk=2.0)
    way = road.path((20, OWN), (200, OWN), (222, -1.35), (248, -1.35), (272, OWN), (800, OWN))
    found.append(
        draw(
            "gb_parked_van_waits_g",
            "Waits behind the van until both have come through.",
            "pass r163.obstruction-give-way no-collision",
            world,
            [
                ego(way, Speed(10).stop_at(193 - 20, 1.8).till(31.5).to(7, 1.5), 50, ind=((27, 36, "right"),)),
                drive("van", "van", VAN, road.along(2.4), Speed(0, 236), 50, ind=((0, 60, "hazard"),)),
                drive("car", "car", CAR, road.back(OPPOSING), Speed(9, 900 - 400), 50),
                drive("bus", "bus", BUS, road.back(OPPOSING), Speed(9, 900 - 445), 50),
            ],
        )
    )
    world, road = single(kind="town", mph=30, walk=2.0)
    found.append(
        draw(
            "gb_parked_row_ghost_g",
            "The oncoming car is more than 6 s away when the ego is back.",
            "not fail r163.obstruction-give-way | pass no-collision",
            world,
            [
                ego(
                    road.path((20, OWN), (130, OWN), (155, -0.9), (235, -0.9), (260, OWN), (800, OWN)),
                    Speed(9),
                    36,
                    hz=5,
                ),
                *[
                    drive(f"p{i}", "car", CAR, road.along(2.55), Speed(0, 165 + 6.2 * i), 36, hz=5, t0=2.0 * i)
                    for i in range(10)
                ],
                drive("car", "car", CAR, road.back(OPPOSING), Speed(9, 900 - 640), 36, hz=5),
            ],
        )
    )
    for name, nat, cls, v, exp, why in (
        (
            "eng_fast",
            "gb-eng",
            "goods_over_7t5",
            25.0,
            "fail",
            "56 mph in a lorry over 7.5 t, which may do 50 in England",
        ),
        ("sct", "gb-sct", "goods_over_7t5", 20.1, "fail", "45 mph in a lorry over 7.5 t, which may do 40 in Scotland"),
        (
            "eng_fine",
            "gb-eng",
            "goods_over_7t5",
            20.1,
            "pass",
            "45 mph in a lorry over 7.5 t, which may do 50 in England",
        ),
    ):
        world, road = single(((1300, 0.0),))
        found.append(
            draw(
                f"gb_lorry_{name}_g",
                f"{why}.",
                f"{exp} r124.speed-limit",
                world,
                [
                    ego(road.along(OWN, 30), Speed(v), 25, TRUCK, "truck"),
                    drive("car", "car", CAR, road.back(OPPOSING), Speed(24, 200), 25),
                ],
                nation=nat,
                vehicle_class=cls,
            )
        )
    world, road = single(((900, 0.0),))
    found.append(
        draw(
            "gb_towing_bridge_g",
            "56 mph with a caravan on a single carriageway, where 50 is the most.",
            "fail r124.speed-limit",
            world,
            [
                ego(road.along(OWN, 30), Speed(25.2), 22),
                drive("caravan", "trailer", (6.2, 2.2, 2.6), road.along(OWN, 23.4), Speed(25.2), 22),
                drive("under", "car", CAR, Path([(400, -150), (400, 250)]), Speed(13), 22),
            ],
            vehicle_class="car_towing",
        )
    )
    world, road = single(((700, 0.0),))
    found.append(
        draw(
            "gb_night_dark_g",
            "No headlights at night on a road of 60 mph.",
            "fail r113.headlights",
            world,
            [ego(road.along(OWN, 30), Speed(20), 25)],
            events=[(0, "headlights", "on"), (6, "headlights", "off")],
            light="night",
        )
    )
    world, road = single(((500, 0.0),), kind="town", mph=30, walk=2)
    found.append(
        draw(
            "gb_night_town_g",
            "No headlights at night in a town.",
            "fail r115.dipped-headlights | not fail r113.headlights",
            world,
            [ego(road.along(OWN, 30), Speed(11), 25)],
            events=[(0, "headlights", "off")],
            light="night",
        )
    )
    world, road = single(((500, 0.0),), kind="town", mph=30, walk=2)
    found.append(
        draw(
            "gb_night_parks_wrong_side_g",
            "Parks for 75 s at night facing the traffic.",
            "fail r248.parked-at-night r239.parked-with-traffic",
            world,
            [
                ego(
                    road.path((30, OWN), (75, OWN), (105, -2.4), (300, -2.4)),
                    Speed(8).hold(9).to(0, 2),
                    92,
                    hz=2,
                    ind=((0, 9, "right"),),
                )
            ],
            events=[(0, "headlights", "on")],
            light="night",
        )
    )
    return found
