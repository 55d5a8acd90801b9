"""Great Britain: overtaking on a country road, and being overtaken."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.twelfth.cast import (
    GB,
    N1,
    O1,
    ego,
)
from tests.outsiders.twelfth.drive import Actor, Drive, draw
from tests.outsiders.twelfth.maps import (
    rural,
)
from tests.outsiders.twelfth.road import signal
from tests.outsiders.twelfth.ways import Straight


def british_overtaking() -> Iterator[Drive]:
    yield draw(
        "gb_overtake_touch_and_go",
        rural(tf=(1, 2, -30)),
        [
            ego(
                Straight(100, N1, [(0, 22), (3, 27), (12, 27)], moves=[(1, 1.8, O1), (3.9, 1.6, N1)]),
                ind=[(0, "right"), (3, "left"), (6, "off")],
            ),
            Actor("l", "car", Straight(130, N1, 14)),
            Actor("o", "car", Straight(355, O1, 22, way=-1)),
        ],
        GB,
        12,
        [
            (
                "ukhc.r162.safe-distance-ahead",
                "fail",
                "pulled out 180 m before an oncoming car at closing 47 m/s with 4 s to go: met it while still moving back",
            ),
            ("criticality.thw", "fail", "closes to 0.3 s behind the car before it is out of the lane"),
        ],
    )
    yield draw(
        "gb_overtake_ample",
        rural(length=1800.0),
        [
            ego(
                Straight(100, N1, [(0, 24), (30, 24)], moves=[(2, 2.5, O1), (11, 3, N1)]),
                ind=[(0, "right"), (5, "off"), (10, "left"), (14, "off")],
            ),
            Actor("l", "truck", Straight(185, N1, 14)),
            Actor("o", "car", Straight(1650, O1, 20, way=-1)),
        ],
        GB,
        20,
        [
            ("ukhc.r162.safe-distance-ahead", "not fail", "the oncoming car is 1.4 km away"),
            ("ukhc.r143.direction", "not fail", "an overtake"),
            ("ukhc.no-collision", "pass", "clear of the lorry"),
        ],
    )
    yield draw(
        "gb_overtake_chased",
        rural(),
        [
            ego(Straight(100, N1, [(0, 20), (8, 21)], moves=[(0.8, 2, O1), (9.5, 2, N1)])),
            Actor("l", "car", Straight(135, N1, 14)),
            Actor("ch", "motorcycle", Straight(70, O1, [(0, 29), (1.5, 29), (3.2, 20), (20, 20)])),
        ],
        GB,
        15,
        [
            (
                "ukhc.r162.not-being-overtaken",
                "fail",
                "a motorcycle is 26 m behind in the passing lane, 9 m/s faster (2.8 s)",
            )
        ],
    )
    yield draw(
        "gb_overtake_into_no_gap",
        rural(),
        [
            ego(Straight(90, N1, [(0, 20), (7.9, 20), (9.6, 15)], moves=[(0.5, 2, O1), (8.2, 1.8, N1)])),
            Actor("l1", "car", Straight(125, N1, 15)),
            Actor("l2", None, Straight(142.5, N1, 15)),
        ],
        GB,
        16,
        [
            (
                "ukhc.r162.return-gap",
                "fail",
                "13 m between the passed car and the next (class NULL): no room for 4.4 m and two thinking distances",
            ),
            ("ukhc.r126.thinking-gap", "not pass", "ends 4 m behind the next at 15 m/s, though by its own cutting in"),
        ],
    )
    yield draw(
        "gb_overtake_from_bumper",
        rural(),
        [
            ego(Straight(100, N1, [(0, 18), (4, 18), (6, 23)], moves=[(4, 1.5, O1), (9.5, 2, N1)])),
            Actor("l", "van", Straight(111, N1, 18)),
        ],
        GB,
        18,
        [
            ("ukhc.r163.pull-out-separation", "fail", "pulls out 6 m behind the van at 18 m/s"),
            ("ukhc.r126.thinking-gap", "fail", "6 m behind at 18 m/s for four seconds, thinking distance 12 m"),
        ],
    )
    yield draw(
        "gb_solid_slow_cyclist",
        rural(mid=[(0.0, "solid solid")]),
        [
            ego(Straight(100, N1, [(0, 14), (6, 11)], moves=[(4, 2.5, -0.6), (10, 2.5, N1)])),
            Actor("b", "bicycle", Straight(165, 2.8, 3.7)),
        ],
        GB,
        18,
        [
            ("ukhc.r129.no-cross-solid", "not fail", "straddles to pass a cyclist at 8 mph"),
            ("ukhc.r163.cyclist", "pass", "2.2 m at 25 mph"),
        ],
    )
    yield draw(
        "gb_solid_brisk_cyclist",
        rural(mid=[(0.0, "solid solid")]),
        [
            ego(Straight(100, N1, 15, moves=[(4, 2.5, -0.9), (14, 2.5, N1)])),
            Actor("b", "bicycle", Straight(165, 2.9, 7.2)),
        ],
        GB,
        20,
        [("ukhc.r129.no-cross-solid", "fail", "the cyclist does 16 mph: the exception ends at 10 mph")],
    )
    yield draw(
        "gb_solid_parked_lorry",
        rural(mid=[(0.0, "solid solid")]),
        [
            ego(Straight(100, N1, [(0, 14), (6, 9)], moves=[(5, 2.5, -1.6), (12, 2.5, N1)])),
            Actor("p", "truck", Straight(200, 2.0, 0)),
        ],
        GB,
        20,
        [
            ("ukhc.r129.no-cross-solid", "not fail", "passes a standing lorry"),
            ("ukhc.r163.obstruction-give-way", "not fail", "nobody comes"),
        ],
    )
    yield draw(
        "gb_broken_turns_solid",
        rural(mid=[(0.0, "broken"), (330.0, "solid solid")]),
        [
            ego(Straight(100, N1, 21, moves=[(3, 2.2, O1), (12.5, 2.2, N1)])),
            Actor("l", "truck", Straight(180, N1, 13.5)),
        ],
        GB,
        18,
        [
            (
                "ukhc.r128.back-before-solid",
                "fail",
                "out at 185 m over a broken line, back at 409 m, 79 m into the double solid",
            ),
            ("ukhc.r129.no-cross-solid", "fail", "comes back over the solid line after 60 m on its wrong side"),
        ],
    )
    sg = [signal("N1", 150, 4.2, "+", ("gb", "632", "no_overtaking"))]
    yield draw(
        "gb_sign_ignored",
        rural(signals=sg),
        [ego(Straight(100, N1, 22, moves=[(6, 2.2, O1), (14, 2.2, N1)])), Actor("l", "car", Straight(190, N1, 14))],
        GB,
        20,
        [("ukhc.r165.no-overtaking-sign", "fail", "overtakes a moving car 80 m behind the sign")],
    )
    yield draw(
        "gb_races_overtaker",
        rural(),
        [
            ego(Straight(120, N1, [(0, 20), (2, 20), (10, 26)])),
            Actor("ov", "car", Straight(90, O1, [(0, 26), (4, 27), (10, 31)], moves=[(13, 2.5, N1)])),
        ],
        GB,
        18,
        [("ukhc.r168.when-overtaken", "fail", "accelerates by 6 m/s while it is overtaken")],
    )
