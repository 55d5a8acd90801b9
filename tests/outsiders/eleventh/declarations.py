"""What a driver's aid declares, well and badly."""

from __future__ import annotations

from tests.outsiders.eleventh.drive import Drive
from tests.outsiders.eleventh.motion import actor, ego, still, track
from tests.outsiders.eleventh.places import STRAIGHT, N, near
from tests.outsiders.eleventh.road import DE, GB, simple


def declarations() -> list[Drive]:
    plain, way = simple(GB, STRAIGHT, speed=60)
    overtakes = track(way, 28, 20, 20, lat=[(0, N), (7, N), (9.5, -N), (17, -N), (19.5, N)])
    slow = actor("b", "van", track(way, 28, 160, 10.5, lat=near(GB)))
    lamps = [(6.0, 9.5, "right"), (16.5, 19.5, "left")]
    good = [
        (0.2, "chosen_speed", "22; dry, wide road"),
        (4.5, "mirror_check", None),
        (5.5, "confidence", "0.97"),
        (5.6, "overtake_go", None),
        (6.3, "mirror_check", "right"),
        (6.6, "blind_spot_check", "right"),
        (15.8, "mirror_check", "left"),
        (16.2, "blind_spot_check", "left"),
    ]
    town, street = simple(DE, [(300.0, 0.0)], kind="town", speed=30, verge="sidewalk")
    return [
        Drive(
            "gb_declares_badly",
            plain,
            [ego(overtakes, lamps=lamps), slow],
            events=[
                (0.0, "mirror_check", "right"),
                (0.2, "chosen_speed", "16.5"),
                (4.5, "confidence", "0.45"),
                (5.0, "overtake_no_go", None),
                (6.8, "blind_spot_check", "right"),
            ],
            expect=[
                ("declared.r161.mirrors-before-signal", "fail", "the look is six seconds old as the signal comes on"),
                ("declared.r162.go-before-overtaking", "fail", "it had decided not to go, two seconds before"),
                (
                    "declared.r163.checks-before-pull-out",
                    "fail",
                    "a blind spot check, but no mirrors in the last five seconds",
                ),
                ("declared.r166.confidence-at-commit", "fail", "0.45"),
                ("declared.r125.chosen-speed-kept", "fail", "20 m/s, 16.5 chosen"),
            ],
        ),
        Drive(
            "gb_declares_well",
            plain,
            [ego(overtakes.copy(), lamps=lamps), slow],
            events=good,
            expect=[
                ("declared.r161.mirrors-before-signal", "pass", "looks into the mirrors before each signal"),
                ("declared.r162.go-before-overtaking", "pass", "decided to go"),
                ("declared.r163.checks-before-pull-out", "not fail", "mirrors, then blind spot"),
                ("declared.r166.confidence-at-commit", "pass", "0.97"),
                ("declared.r152.speed-reason", "pass", "named"),
            ],
        ),
        Drive(
            "de_reverses",
            town,
            [
                ego(track(street, 22, 150, 0, [(8, 0.8), (10, 0), (15, -0.8)], near(DE), way=-1, back=True)),
                actor("w", "pedestrian", still(street, 120, -4.6, 22)),
            ],
            events=[(1.5, "mirror_check", None), (0.5, "blind_spot_check", "left"), (0.2, "chosen_speed", "4")],
            expect=[
                (
                    "declared.r202.checks-before-reversing",
                    "fail",
                    "its last look into the mirrors was six seconds before, that over the shoulder seven",
                ),
                ("ukhc.r143.direction", "not fail", "reverses at walking pace in a street"),
                ("declared.r152.speed-reason", "fail", "4 m/s and no reason"),
            ],
        ),
    ]
