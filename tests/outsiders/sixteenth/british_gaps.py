"""Great Britain: somebody gets ahead, or is passed."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.sixteenth.cast import GB, OPPOSING, OWN, ego
from tests.outsiders.sixteenth.drive import Actor, Drive, draw
from tests.outsiders.sixteenth.maps import motorway, rural, town
from tests.outsiders.sixteenth.ways import Motion, against, along


def _dropping_back() -> Iterator[Drive]:
    yield draw(
        "gb-drop-back-done",
        motorway(length=3500, limit=31.29, width=3.65),
        [
            ego(along(-5.625, [(0, 28), (8, 28), (12, 22), (16, 22), (19, 28)], 50)),
            Actor("a", "car", along([(0, -1.875), (5, -1.875), (9, -5.625)], 28, 76.5)),
        ],
        GB,
        35,
        [("ukhc.r168.drop-back", "pass", "two seconds again at about 14 s")],
        hz=5,
    )
    yield draw(
        "gb-drop-back-wet",
        motorway(length=3500, limit=31.29, width=3.65),
        [
            ego(along(-5.625, [(0, 28), (8, 28), (12, 23), (15, 23), (18, 28)], 50), noise=0.02),
            Actor("a", "car", along([(0, -1.875), (5, -1.875), (9, -5.625)], 28, 79.5), noise=0.02),
        ],
        {**GB, "weather": "wet"},
        35,
        [("ukhc.r168.drop-back", "fail", "wet: 4 s are 112 m, has 57")],
        hz=5,
    )


def _overtaken() -> Iterator[Drive]:
    yield draw(
        "gb-speeds-up-overtaken",
        rural(length=2500),
        [
            ego(along(OWN, [(0, 18), (7, 18), (12, 22.5), (24, 22.5)], 100)),
            Actor(
                "o",
                "car",
                along(
                    [(0, OWN), (4, OWN), (7, OPPOSING), (17, OPPOSING), (20, OWN)],
                    [(0, 18), (4, 18), (7, 25), (24, 25)],
                    80,
                ),
                ind=[(0, "off"), (3, "left"), (7, "off")],
            ),
        ],
        GB,
        24,
        [("ukhc.r168.when-overtaken", "fail", "accelerates with 0.9 m/s2 while somebody is beside it")],
    )
    yield draw(
        "gb-steady-overtaken",
        rural(length=2500),
        [
            ego(along(OWN, 18, 100), noise=0.01),
            Actor(
                "o",
                "motorcycle",
                along(
                    [(0, OWN), (4, OWN), (7, OPPOSING), (14, OPPOSING), (17, OWN)],
                    [(0, 18), (4, 18), (7, 25), (24, 25)],
                    80,
                ),
            ),
        ],
        GB,
        24,
        [("ukhc.r168.when-overtaken", "pass", "steady")],
    )


def _passing() -> Iterator[Drive]:
    yield draw(
        "gb-cyclist-fast-1m7",
        rural(),
        [
            ego(along([(0, OWN), (2, OWN), (5, -0.1), (14, -0.1), (17, OWN)], 20, 20)),
            Actor("c", "bicycle", along(-3, 4, 164)),
        ],
        {**GB, "nation": "gb-sct"},
        20,
        [("ukhc.r163.cyclist", "fail", "1.7 m at 20 m/s"), ("stvo.s5-passing", "not fail", "law of de")],
        turned=-0.6,
        shift=(100, 100),
    )
    yield draw(
        "gb-horse-slow",
        rural(),
        [
            ego(
                along(
                    [(0, OWN), (6, OWN), (10, 1), (24, 1), (28, OWN)], [(0, 10), (5, 10), (9, 4), (24, 4), (30, 10)], 20
                )
            ),
            Actor("h", "animal", along(-2.9, 1.6, 105)),
        ],
        GB,
        40,
        [("ukhc.r215.horse", "pass", "4 m/s, 2.65 m")],
        hz=5,
    )
    yield draw(
        "gb-parked-forces-oncoming",
        town(),
        [
            ego(along([(0, OWN), (7, OWN), (9, 1.2), (12.5, 1.2), (14.5, OWN)], 10, 20)),
            Actor("p", "van", along(-2.2, 0, 128)),
            Actor("o", "car", Motion(against(600), [(0, 12), (9, 12), (11.6, 1.5), (14, 1.5), (18, 10)], 314, OWN)),
        ],
        GB,
        24,
        [("ukhc.r163.obstruction-give-way", "fail", "oncoming brakes with 4 m/s2")],
    )


def _own_side() -> Iterator[Drive]:
    yield draw(
        "gb-wrong-side-long",
        rural(),
        [ego(along([(0, OWN), (4, OWN), (7, OPPOSING), (34, OPPOSING), (37, OWN)], 15, 20), noise=0.02)],
        GB,
        40,
        [("ukhc.r143.direction", "fail", "25 s in the opposing lane for nothing")],
        hz=5,
    )
    yield draw(
        "gb-pavement",
        town(),
        [ego(along([(0, OWN), (5, OWN), (8, -3.1), (12, -3.1), (15, OWN)], 9, 20))],
        GB,
        20,
        [("ukhc.r145.off-road", "fail", "0.5 m on the pavement at 9 m/s")],
    )


def british_gaps() -> Iterator[Drive]:
    yield from _dropping_back()
    yield from _overtaken()
    yield from _passing()
    yield from _own_side()
