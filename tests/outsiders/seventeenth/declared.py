"""Great Britain: what the ego declares."""

from __future__ import annotations

from tests.outsiders.seventeenth.cast import LONGER_ROAD
from tests.outsiders.seventeenth.drive import Drive, draw, go

DRIVES: list[Drive] = [
    draw(
        "told_no_go",
        LONGER_ROAD,
        [
            go(
                "ego", 22, 60, off=((6, 0), (9, -3.5), (17, -3.5), (20, 0)), ind=((0, "off"), (4, "right"), (10, "off"))
            ),
            go("v", 14, 178, cls="van"),
        ],
        26,
        [
            ("declared.r162.go-before-overtaking", "fail", "the last word was no"),
            ("declared.r166.confidence-at-commit", "fail", "0.6"),
            ("declared.r161.mirrors-before-signal", "pass", "1 s before"),
        ],
        events=[
            (3, "mirror_check", None),
            (5, "blind_spot_check", "right"),
            (4, "overtake_go", None),
            (5.5, "overtake_no_go", None),
            (5.6, "confidence", "0.6"),
        ],
    ),
    draw(
        "told_wrong_order",
        LONGER_ROAD,
        [
            go(
                "ego",
                22,
                60,
                off=((6, 0), (9, -3.5), (17, -3.5), (20, 0)),
                ind=((0, "off"), (5.5, "right"), (10, "off")),
            ),
            go("v", 14, 178, cls="van"),
        ],
        26,
        [
            ("declared.r163.checks-before-pull-out", "fail", "blind spot before the mirrors"),
            ("declared.r161.mirrors-before-signal", "fail", "mirrors after the signal"),
        ],
        events=[
            (0, "mirror_check", None),
            (4.5, "blind_spot_check", "right"),
            (5.7, "mirror_check", None),
            (5.8, "overtake_go", None),
            (5.9, "confidence", "0.95"),
        ],
    ),
    draw(
        "told_wrong_side",
        LONGER_ROAD,
        [
            go(
                "ego", 22, 60, off=((6, 0), (9, -3.5), (17, -3.5), (20, 0)), ind=((0, "off"), (4, "right"), (10, "off"))
            ),
            go("v", 14, 178, cls="van"),
        ],
        26,
        [("declared.r163.checks-before-pull-out", "fail", "both looks to the left, it goes right")],
        events=[
            (3, "mirror_check", "left"),
            (5, "blind_spot_check", "left"),
            (5.4, "overtake_go", None),
            (5.5, "confidence", "0.95"),
        ],
    ),
    draw(
        "chosen_exceeded",
        LONGER_ROAD,
        [go("ego", ((0, 18), (12, 18), (16, 21)), 60)],
        26,
        [
            ("declared.r125.chosen-speed-kept", "fail", "21 m/s, 18 chosen"),
            ("declared.r152.speed-reason", "fail", "no reason"),
        ],
        events=[(0, "chosen_speed", "18")],
    ),
    draw(
        "reverse_half_checked",
        LONGER_ROAD,
        [go("ego", ((0, 0), (6, 0), (8, -1.5), (12, -1.5), (14, 0)), 160)],
        18,
        [("declared.r202.checks-before-reversing", "fail", "no blind spot check")],
        events=[(4, "mirror_check", None), (15, "blind_spot_check", None)],
    ),
]
