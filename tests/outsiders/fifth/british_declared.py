"""Great Britain: what the ego declares."""

from __future__ import annotations

from tests.outsiders.fifth.cast import (
    TRUCK,
    drive,
    ego,
)
from tests.outsiders.fifth.drive import Drive, draw
from tests.outsiders.fifth.places import (
    OWN,
    overtaking,
    single,
)
from tests.outsiders.fifth.ways import Speed


def british_declared() -> list[Drive]:
    found: list[Drive] = []
    world, road = single(((1400, 0.0),))
    found.append(
        draw(
            "gb_declares_little_g",
            "The only look was 6 s before the signal, behind the 5 s.",
            "fail declared.r161.mirrors-before-signal declared.r162.go-before-overtaking "
            "declared.r166.confidence-at-commit declared.r152.speed-reason "
            "declared.r125.chosen-speed-kept",
            world,
            [
                ego(overtaking(road, 170, 400), Speed(20), 30, ind=((6, 10, "right"),)),
                drive("lorry", "truck", TRUCK, road.along(OWN), Speed(11, 155), 30),
            ],
            events=[
                (0, "mirror_check", "left"),
                (0.5, "chosen_speed", "15"),
                (6.2, "overtake_go", None),
                (6.6, "overtake_no_go", None),
                (6.4, "confidence", "0.55"),
            ],
        )
    )
    world, road = single(((1400, 0.0),))
    found.append(
        draw(
            "gb_declares_all_g",
            "A look before each signal.",
            "pass declared.r161.mirrors-before-signal declared.r162.go-before-overtaking "
            "declared.r166.confidence-at-commit declared.r163.checks-before-pull-out "
            "declared.r125.chosen-speed-kept",
            world,
            [
                ego(overtaking(road, 170, 400), Speed(20), 30, ind=((6, 10, "right"), (18, 21, "left"))),
                drive("lorry", "truck", TRUCK, road.along(OWN), Speed(11, 155), 30),
            ],
            events=[
                (0.5, "chosen_speed", "22; dry open road"),
                (4, "mirror_check", None),
                (6.3, "blind_spot_check", None),
                (6.5, "confidence", "0.97"),
                (6.6, "overtake_go", None),
                (16.6, "mirror_check", None),
                (17.5, "blind_spot_check", None),
            ],
        )
    )
    world, road = single(((400, 0.0),), kind="town", mph=30, walk=2)
    speed = Speed(8).hold(5).to(0, 1.5).hold(6)
    speed.to(-2, 0.8).hold(6).to(0, 1)
    found.append(
        draw(
            "gb_reverses_unlooking_g",
            "Looks into the mirrors only, not over the shoulder.",
            "fail declared.r202.checks-before-reversing | not fail r143.direction",
            world,
            [ego(road.along(OWN, 30), speed, 34)],
            events=[(15, "mirror_check", None), (1, "blind_spot_check", None)],
        )
    )
    return found
