"""What the ego declares."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.sixteenth.cast import DE, ENGAGED, GB, MIDDLE, OPPOSING, OWN, SLOW, ego
from tests.outsiders.sixteenth.drive import Actor, Drive, draw
from tests.outsiders.sixteenth.maps import motorway, rural, town
from tests.outsiders.sixteenth.ways import along


def _speeds_and_looks() -> Iterator[Drive]:
    yield draw(
        "chosen-lowered-ignored",
        rural(limit=27.78),
        [ego(along(OWN, 15, 20))],
        DE,
        25,
        [
            ("declared.r125.chosen-speed-kept", "fail", "still 15 more than 5 s after it chose 11"),
            ("declared.r152.speed-reason", "fail", "the second names none"),
        ],
        events=[(1, "chosen_speed", "15.5; bend"), (8, "chosen_speed", "11; ")],
    )
    yield draw(
        "reverse-unlooked",
        town(limit=13.89),
        [ego(along(-2.4, [(0, 0), (6, 0), (8, -1.2), (12, -1.2), (14, 0)], 100))],
        DE,
        20,
        [("declared.r202.checks-before-reversing", "not pass", "no blind spot check, mirror 6 s old")],
        events=[(0.3, "mirror_check", None)],
    )


def _lane_changes() -> Iterator[Drive]:
    yield draw(
        "pull-out-ok",
        motorway(),
        [
            ego(along([(0, SLOW), (6, SLOW), (10, MIDDLE)], 28, 50), ind=[(0, "off"), (3, "left"), (10.5, "off")]),
            Actor("a", "truck", along(SLOW, 22, 160)),
        ],
        ENGAGED,
        16,
        [
            ("declared.r163.checks-before-pull-out", "pass", "ok: reaches over the line at 7.4 s"),
            ("declared.r161.mirrors-before-signal", "pass", "mirror 0.5 s before"),
        ],
        events=[(2.8, "mirror_check", "left"), (4.6, "blind_spot_check", "left")],
    )
    yield draw(
        "pull-out-order",
        motorway(),
        [
            ego(along([(0, SLOW), (6, SLOW), (10, MIDDLE)], 28, 50), ind=[(0, "off"), (3, "left"), (10.5, "off")]),
            Actor("a", "truck", along(SLOW, 22, 160)),
        ],
        ENGAGED,
        16,
        [("declared.r163.checks-before-pull-out", "fail", "order: reaches over the line at 7.4 s")],
        events=[(2.5, "blind_spot_check", "left"), (2.9, "mirror_check", "left")],
    )
    yield draw(
        "mirror-after-signal",
        motorway(),
        [ego(along([(0, SLOW), (7, SLOW), (11, MIDDLE)], 28, 50), ind=[(0, "off"), (4, "left"), (11.5, "off")])],
        DE,
        16,
        [
            ("declared.r161.mirrors-before-signal", "fail", "looks 0.5 s after it signals"),
            ("declared.r163.checks-before-pull-out", "pass", "in order, in time"),
        ],
        events=[(4.5, "mirror_check", "left"), (5.5, "blind_spot_check", "left")],
    )


def _decisions() -> Iterator[Drive]:
    yield draw(
        "changed-its-mind",
        rural(limit=27.78, length=2500),
        [
            ego(
                along(
                    [(0, OWN), (6, OWN), (9, OPPOSING), (14, OPPOSING), (17, OWN)],
                    [(0, 12), (5, 12), (9, 22), (26, 22)],
                    100,
                ),
                ind=[(0, "off"), (4, "left"), (9, "off"), (14, "right"), (17, "off")],
            ),
            Actor("slow", "car", along(OWN, 12, 129.5)),
        ],
        DE,
        26,
        [
            ("declared.r162.go-before-overtaking", "fail", "the last word was no go"),
            ("declared.r166.confidence-at-commit", "fail", "0.6"),
        ],
        events=[
            (3, "overtake_go", None),
            (3.1, "confidence", "0.95"),
            (5.2, "overtake_no_go", None),
            (5.3, "confidence", "0.6"),
        ],
    )
    yield draw(
        "never-decided",
        rural(length=2500),
        [
            ego(
                along(
                    [(0, OWN), (6, OWN), (9, OPPOSING), (14, OPPOSING), (17, OWN)],
                    [(0, 12), (5, 12), (9, 22), (26, 22)],
                    100,
                ),
                ind=[(0, "off"), (4, "left"), (9, "off"), (14, "right"), (17, "off")],
            ),
            Actor("slow", "car", along(OWN, 12, 129.5)),
        ],
        GB,
        26,
        [
            ("declared.r162.go-before-overtaking", "not pass", "go only after it"),
            ("declared.r166.confidence-at-commit", "not pass", "6 s old"),
        ],
        events=[(20, "overtake_go", None), (0.1, "confidence", "0.95")],
    )


def declarations() -> Iterator[Drive]:
    yield from _speeds_and_looks()
    yield from _lane_changes()
    yield from _decisions()
