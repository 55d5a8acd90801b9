"""What the ego declares."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.thirteenth.drive import TURNED, Drive, Events, Wanted, draw
from tests.outsiders.thirteenth.following import following
from tests.outsiders.thirteenth.road import Frame
from tests.outsiders.thirteenth.street import N, two_way

LOOKS: list[tuple[float, str, str]] = [
    (1.0, "mirror_check", "right"),
    (2.0, "overtake_go", ""),
    (2.2, "confidence", "0.95"),
    (4.2, "mirror_check", "right"),
    (4.6, "blind_spot_check", "right"),
    (11.5, "mirror_check", "left"),
    (12.9, "blind_spot_check", "left"),
    (13.2, "mirror_check", "left"),
    (13.6, "blind_spot_check", "left"),
]


def declared_overtake(name: str, events: Events, wanted: Wanted, frame: Frame = (0.0, 0.0, 0.0)) -> Drive:
    """The ego overtakes; its indicator comes on at 3 s and at 13 s, it is over the line at 5.9 s."""
    street = two_way(length=1800, frame=frame)
    ego = street.go(
        "ego",
        "car",
        200,
        [(0, 14), (3, 14), (8, 21), (99, 21)],
        [(0, N), (5, N), (8, -N), (14, -N), (17, N)],
        indicator=[(0, "off"), (3, "right"), (7, "off"), (13, "left"), (16, "off")],
    )
    return draw(name, street.map, [ego, street.go("l", "car", 240, 13, N)], 24, wanted, events=events)


def speeds() -> Iterator[Drive]:
    """The speed that it chose, and looks before reversing."""
    yield following(
        "chosen_fast",
        20,
        [
            ("declared.r125.chosen-speed-kept", "fail", "20 m/s, 16 chosen"),
            ("declared.r152.speed-reason", "pass", "reason given"),
        ],
        events=[(0, "chosen_speed", "16; bends")],
    )
    yield following(
        "chosen_noreason",
        15,
        [
            ("declared.r152.speed-reason", "fail", "second choice without reason"),
            ("declared.r125.chosen-speed-kept", "pass", "15 of 16"),
        ],
        events=[(0, "chosen_speed", "16; bends"), (5, "chosen_speed", "17")],
    )
    yield following(
        "reverse_blind",
        [(0, 4), (3, 0), (5, 0), (6, -1.5), (10, -1.5), (11, 0), (99, 0)],
        [("declared.r202.checks-before-reversing", "fail", "last look 6 s and more before and while reversing")],
        events=[(0, "mirror_check", ""), (0.2, "blind_spot_check", "")],
        kind="town",
        limit=13.41,
    )


def overtakes() -> Iterator[Drive]:
    """Looks and decisions before an overtake."""
    yield declared_overtake(
        "dec_good",
        LOOKS,
        [
            ("declared.r161.mirrors-before-signal", "pass", "looked"),
            ("declared.r162.go-before-overtaking", "pass", "go"),
            ("declared.r166.confidence-at-commit", "pass", "0.95"),
            ("declared.r163.checks-before-pull-out", "pass", "mirror, then blind spot"),
        ],
    )
    yield declared_overtake(
        "dec_nogo",
        [*LOOKS, (3.5, "overtake_no_go", "")],
        [("declared.r162.go-before-overtaking", "fail", "the last decision was no-go")],
    )
    yield declared_overtake(
        "dec_doubt",
        [(t, e, "0.6" if e == "confidence" else v) for t, e, v in LOOKS],
        [("declared.r166.confidence-at-commit", "fail", "0.6")],
        frame=TURNED,
    )
    yield declared_overtake(
        "dec_wrong_order",
        [
            (0.4, "mirror_check", "right"),
            (2.0, "overtake_go", ""),
            (4.2, "blind_spot_check", "right"),
            (2.2, "confidence", "0.95"),
            (12.9, "mirror_check", "left"),
            (13.6, "blind_spot_check", "left"),
        ][:4],
        [
            ("declared.r161.mirrors-before-signal", "fail", "no look before the second signal at 13 s"),
            (
                "declared.r163.checks-before-pull-out",
                "fail",
                "the mirror 5.5 s before it pulls out, nothing before moving back",
            ),
        ],
    )
    yield declared_overtake(
        "dec_left_eye",
        [(t, e, "left" if e == "blind_spot_check" else v) for t, e, v in LOOKS],
        [("declared.r163.checks-before-pull-out", "fail", "looked over the wrong shoulder")],
    )
