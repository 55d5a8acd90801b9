"""Germany: distances on the motorway."""

from __future__ import annotations

import math
from collections.abc import Iterator

from tests.outsiders.sixteenth.cast import DE, FAST, MIDDLE, SLOW, ego
from tests.outsiders.sixteenth.drive import Actor, Drive, draw
from tests.outsiders.sixteenth.maps import motorway
from tests.outsiders.sixteenth.ways import Motion, along, line


def _own_gap() -> Iterator[Drive]:
    yield draw(
        "rg1-twelve-metres",
        motorway(),
        [ego(along(MIDDLE, 30, 50)), Actor("a", "car", along(MIDDLE, 30, 67))],
        DE,
        20,
        [
            ("stvo.rg1", "pass", "12.5 m, 11.14 needed"),
            ("criticality.thw", "fail", "0.42 s"),
            ("criticality.ttb", "pass", "no closing"),
        ],
    )
    yield draw(
        "own-cut-in",
        motorway(),
        [
            ego(
                along([(0, SLOW), (4, SLOW), (8, MIDDLE)], [(0, 30), (8, 30), (10, 28), (14, 28), (15, 30)], 50),
                ind=[(0, "off"), (2, "left"), (8, "off")],
            ),
            Actor("a", "van", along(MIDDLE, 30, 62.25)),
        ],
        DE,
        20,
        [
            ("stvo.rg1", "fail", "ego changes into 7 m at 30 m/s by itself, kept at once"),
            ("criticality.thw", "fail", "0.23 s, own cut-in"),
        ],
        hz=12.5,
    )
    yield draw(
        "cutter-restored",
        motorway(),
        [
            ego(along(MIDDLE, [(0, 30), (5.5, 30), (8.5, 26.5), (12, 26.5), (15, 30)], 50)),
            Actor(
                "a",
                "car",
                along([(0, FAST), (3, FAST), (7, MIDDLE)], [(0, 30)], 63.5),
                ind=[(0, "off"), (1, "right"), (7, "off")],
            ),
        ],
        DE,
        25,
        [("stvo.rg1", "not fail", "cut in at about 5 s, at 7.5 s 11.6 m at 27.7 again")],
    )
    yield draw(
        "rg1-motorcycle-lost",
        motorway(),
        [ego(along(MIDDLE, 33, 50)), Actor("a", "motorcycle", along(-4.625, 33, 60.35), gaps=[(8.0, 9.0)])],
        DE,
        24,
        [("stvo.rg1", "fail", "7 m behind a motorcycle at 33 m/s, at the side of the lane")],
    )


def _braking() -> Iterator[Drive]:
    yield draw(
        "rg2-brakes-for-nothing",
        motorway(),
        [
            ego(along(MIDDLE, [(0, 30), (8, 30), (8.6, 29), (11, 16), (12, 15), (20, 15)], 50)),
            Actor("a", "car", along(FAST, [(0, 28), (8, 28), (10, 20)], 130)),
        ],
        DE,
        20,
        [
            ("stvo.rg2", "fail", "5.4 m/s2, only a car in the next lane brakes"),
            ("comfort.nuplan", "fail", "5.4 > 4.05"),
            ("comfort.decel-iso15622", "fail", "mean over 2 s 5.2 at 20 m/s and more"),
        ],
    )
    yield draw(
        "rg2-lead-brakes",
        motorway(),
        [
            ego(along(MIDDLE, [(0, 30), (8.5, 30), (12, 16), (20, 16)], 50)),
            Actor("a", "car", along(MIDDLE, [(0, 30), (8, 30), (11.5, 16), (20, 16)], 99.5)),
        ],
        DE,
        20,
        [("stvo.rg2", "not fail", "the vehicle ahead brakes as hard"), ("stvo.rg1", "pass", "38 m at least")],
    )
    yield draw(
        "rg2-deer",
        motorway(),
        [
            ego(along(MIDDLE, [(0, 30), (4, 30), (8, 8), (15, 8)], 50)),
            Actor("deer", "animal", Motion(line(262, -14, math.pi / 2), 1.6), size=(1.6, 0.5, 1.1), since=3.5),
        ],
        DE,
        15,
        [
            ("stvo.rg2", "not fail", "a deer crosses 85 m ahead"),
            ("ukhc.no-collision", "pass", "the deer is 35 m away and more"),
        ],
    )
    yield draw(
        "s4-bus-cut-in-stays",
        motorway(),
        [ego(along(SLOW, 22, 50), "bus"), Actor("a", "car", along([(0, MIDDLE), (4, MIDDLE), (8, SLOW)], 22, 88.25))],
        DE,
        25,
        [("stvo.s4-truck", "fail", "30 m for 15 s after the cut-in")],
    )


def _lane_changes() -> Iterator[Drive]:
    yield draw(
        "rg6-pulls-before-fast",
        motorway(),
        [
            ego(along([(0, MIDDLE), (5, MIDDLE), (9, FAST)], 26, 200), ind=[(0, "off"), (2, "left"), (9, "off")]),
            Actor("f", "car", along(FAST, [(0, 38), (6, 38), (8, 26), (15, 26)], 108.1)),
        ],
        DE,
        15,
        [("stvo.rg6", "fail", "follower at 38 about 20 m behind an ego of 26 m/s")],
    )
    yield draw(
        "rg6-motorcycle-right",
        motorway(),
        [
            ego(along([(0, FAST), (5, FAST), (9, MIDDLE)], 30, 200), ind=[(0, "off"), (2, "right"), (9, "off")]),
            Actor("f", "motorcycle", along(MIDDLE, 30, 191.65)),
        ],
        DE,
        15,
        [("stvo.rg6", "fail", "motorcycle 5 m behind in the right lane at 30 m/s")],
        hz=20,
    )


def german_gaps() -> Iterator[Drive]:
    yield from _own_gap()
    yield from _braking()
    yield from _lane_changes()
