"""Collisions, and what is none."""

from __future__ import annotations

import math
from collections.abc import Iterator

from tests.outsiders.sixteenth.cast import DE, MIDDLE, OWN, SLOW, ego
from tests.outsiders.sixteenth.drive import Actor, Drive, draw
from tests.outsiders.sixteenth.maps import motorway, rural, town
from tests.outsiders.sixteenth.ways import Motion, against, along, line


def _crashes() -> Iterator[Drive]:
    yield draw(
        "hit-tunnel",
        rural(limit=27.78),
        [ego(along(OWN, 25, 50)), Actor("x", "motorcycle", Motion(line(202.5, -172.55, math.pi / 2), 28))],
        DE,
        12,
        [("ukhc.no-collision", "fail", "a motorcycle crosses through it between two frames")],
        hz=5,
    )
    yield draw(
        "hit-oncoming-mirror",
        rural(limit=27.78),
        [
            ego(along([(0, OWN), (3, OWN), (6, -0.75), (7, -0.75), (9, OWN)], 22, 50)),
            Actor("o", "truck", Motion(against(800), 20, 485.4, -1.05)),
        ],
        DE,
        14,
        [("ukhc.no-collision", "fail", "side swipe: ego reaches 0.15 over the middle, the lorry 0.05")],
    )
    yield draw(
        "hit-reversing",
        town(limit=13.89),
        [
            ego(along(OWN, [(0, 0), (3, 0), (5, -1.5), (9.5, -1.5), (10.5, 0), (20, 0)], 100)),
            Actor("b", "car", along(OWN, 0, 89), ind=None, brakes=False),
        ],
        DE,
        20,
        [
            ("ukhc.no-collision", "fail", "reverses 9 m where 6.5 are free"),
            ("declared.r202.checks-before-reversing", "not pass", "nothing declared"),
        ],
    )
    yield draw(
        "hit-long-trailer",
        motorway(),
        [
            ego(along([(0, MIDDLE), (5, MIDDLE), (8.5, SLOW)], 27, 50), ind=[(0, "off"), (3, "right")]),
            Actor("t", "truck", along(SLOW, 24, 81.5)),
            Actor("tr", "trailer", along(SLOW, 24, 68), size=(13.0, 2.5, 3.8)),
        ],
        DE,
        14,
        [("ukhc.no-collision", "fail", "moves into the trailer of a lorry")],
    )


def _near_ones() -> Iterator[Drive]:
    yield draw(
        "hit-unknown-class",
        rural(limit=27.78),
        [ego(along(OWN, 20, 50)), Actor("u", None, along(-2.9, [(0, 8), (4, 8), (6, 0)], 130), ind=None, brakes=False)],
        DE,
        12,
        [("ukhc.no-collision", "fail", "lateral distance 1.15 < 1.8")],
    )
    yield draw(
        "squeezes-past",
        town(limit=13.89),
        [ego(along([(0, OWN), (3, OWN), (6, -0.95), (20, -0.95)], 6, 50)), Actor("b", "van", along(-3.05, 0, 115))],
        DE,
        20,
        [("ukhc.no-collision", "pass", "0.15 m between the boxes"), ("ukhc.contact-signature", "pass", "steady")],
    )
    yield draw(
        "jolt-no-box",
        rural(limit=27.78),
        [
            ego(along(OWN, [(0, 20), (6, 20), (6.06, 16), (12, 16)], 50)),
            Actor("a", "car", along(OWN, [(0, 14), (6, 14), (6.06, 18), (12, 18)], 90.75)),
        ],
        DE,
        12,
        [
            ("ukhc.contact-signature", "fail", "loses 4 m/s in a tick 0.25 m behind a car that gains 4"),
            ("ukhc.no-collision", "not fail", "0.2 m remain"),
            ("criticality.ttc", "fail", "into it"),
        ],
    )


def collisions() -> Iterator[Drive]:
    yield from _crashes()
    yield from _near_ones()
