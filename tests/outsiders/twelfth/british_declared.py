"""Great Britain: what the ego declares."""

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
    town,
)
from tests.outsiders.twelfth.ways import Straight


def british_declared() -> Iterator[Drive]:
    yield draw(
        "gb_declared_no_go",
        rural(length=1500.0),
        [
            ego(
                Straight(60, N1, 23, moves=[(5, 2.4, O1), (14, 2.5, N1)]), ind=[(0, "off"), (3.8, "right"), (8, "off")]
            ),
            Actor("l", "truck", Straight(165, N1, 14)),
        ],
        GB,
        20,
        [
            ("declared.r162.go-before-overtaking", "fail", "the last decision was not to overtake"),
            ("declared.r166.confidence-at-commit", "fail", "confidence 0.55"),
            ("declared.r163.checks-before-pull-out", "pass", "mirror, then blind spot, within 5 s"),
        ],
        events=[
            (2, "overtake_go", None),
            (2.6, "mirror_check", "right"),
            (3.4, "blind_spot_check", "right"),
            (4.2, "overtake_no_go", None),
            (4.3, "confidence", "0.55"),
        ],
    )
    yield draw(
        "gb_declared_blind_first",
        rural(length=1500.0),
        [
            ego(
                Straight(60, N1, 23, moves=[(5, 2.4, O1), (14, 2.5, N1)]),
                ind=[(0, "off"), (3.8, "right"), (8, "off"), (13, "left"), (17, "off")],
            ),
            Actor("l", "bus", Straight(165, N1, 14)),
        ],
        GB,
        20,
        [
            (
                "declared.r163.checks-before-pull-out",
                "fail",
                "only a mirror check after the blind spot check, and none of the two before the return",
            ),
            (
                "declared.r161.mirrors-before-signal",
                "fail",
                "no mirror check in the five seconds before the left signal",
            ),
            ("declared.r162.go-before-overtaking", "pass", "go at 3 s"),
        ],
        events=[
            (1.6, "blind_spot_check", "right"),
            (2.8, "mirror_check", "right"),
            (3, "overtake_go", None),
            (3.1, "confidence", "0.97"),
        ],
    )
    yield draw(
        "gb_declared_speed",
        rural(),
        [ego(Straight(30, N1, [(0, 17), (10, 17), (14, 22.5), (25, 22.5)]))],
        {"nation": "gb", "weather": "ice"},
        25,
        [
            ("declared.r125.chosen-speed-kept", "fail", "22.5 m/s, chosen were 18"),
            ("declared.r152.speed-reason", "fail", "the second choice names no reason"),
        ],
        events=[(0.5, "chosen_speed", "19; ice on the road"), (6, "chosen_speed", "18")],
    )
    yield draw(
        "gb_declared_reverse",
        town(),
        [ego(Straight(100, N1, [(0, 0), (8, 0), (10, -1.4), (14, -1.4), (15, 0)]))],
        GB,
        18.0,
        [
            (
                "declared.r202.checks-before-reversing",
                "fail",
                "mirror check, but the blind spot check was 7.5 s before it reverses",
            )
        ],
        events=[(0.5, "blind_spot_check", None), (6, "mirror_check", None)],
    )
