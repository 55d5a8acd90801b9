"""Meeting round an obstruction; being overtaken."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tests.outsiders.nineteenth.cast import OWN, oncoming
from tests.outsiders.nineteenth.drive import Actor, Drive, Knots, draw, gaining
from tests.outsiders.nineteenth.maps import (
    LONG,
    STREET,
    country,
    street,
)

ROUND = [(4, OWN), (6.5, 1.3), (10, 1.3), (13, OWN)]


def overtaken(name: str, gains: Sequence[tuple[float, float]], verdict: str, why: str, across: Knots = OWN) -> Drive:
    """Somebody overtakes the ego, which gains speed as said."""
    return draw(
        name,
        "gb-eng",
        country(),
        [
            Actor("ego", "car", LONG, 150, gaining(18, gains), across),
            Actor("f", "car", LONG, 90, 25, [(2, OWN), (5, 1.75), (14, 1.75), (17, OWN)]),
        ],
        22,
        [("ukhc.r168.when-overtaken", verdict, why)],
    )


def obstructions() -> Iterator[Drive]:
    """A parked car, and somebody comes the other way."""
    yield draw(
        "obs_forced",
        "gb-eng",
        street(),
        [
            Actor("ego", "car", STREET, 50, 10, ROUND),
            Actor("p", "car", STREET, 140, 0, -2.3),
            oncoming(STREET, 250, gaining(11, [(0, 0), (4.5, 0), (5.5, -3.5), (8, -3.5), (8.5, 0)])),
        ],
        20,
        [("ukhc.r163.obstruction-give-way", "fail", "the oncoming car brakes 3.5 m/s2 for it")],
    )
    yield draw(
        "obs_waits",
        "gb-eng",
        street(),
        [
            Actor(
                "ego",
                "car",
                STREET,
                50,
                [(0, 10), (3, 10), (8, 0), (15, 0), (20, 8)],
                [(15.5, OWN), (19.5, 1.3), (22.5, 1.3), (25.5, OWN)],
            ),
            Actor("p", "car", STREET, 128, 0, -2.3),
            oncoming(STREET, 230, 11),
        ],
        30,
        [
            ("ukhc.r163.obstruction-give-way", "pass", "waits until the other is past"),
            ("ukhc.r143.direction", "not fail", "a standing car closes its lane"),
            ("ukhc.no-collision", "pass", "metres"),
        ],
    )
    yield draw(
        "obs_squeeze",
        "gb-eng",
        street(),
        [
            Actor("ego", "car", STREET, 50, 10, [(4, OWN), (6.5, 0.55), (10, 0.55), (13, OWN)]),
            Actor("p", "car", STREET, 140, 0, -2.5),
            oncoming(STREET, 232, 11, across=-2.6),
        ],
        20,
        [
            ("ukhc.r163.obstruction-give-way", "fail", "they meet beside it at 21 m/s with 0.25 m of air"),
            ("ukhc.no-collision", "pass", "0.25 m"),
        ],
    )


def being_overtaken() -> Iterator[Drive]:
    """Somebody overtakes the ego."""
    yield overtaken(
        "been_accelerates",
        [(0, 0), (5, 0), (6, 0.8), (10, 0.8), (11, 0)],
        "fail",
        "0.8 m/s2 while the other is alongside",
    )
    yield draw(
        "been_creeps",
        "gb-eng",
        country(),
        [
            Actor("ego", "car", LONG, 150, gaining(18, [(0, 0), (4, 0), (4.2, 0.24), (13, 0.24), (13.5, 0)]), OWN),
            Actor("f", "car", LONG, 110, 22, [(1, OWN), (4, 1.75), (21, 1.75), (24, OWN)]),
        ],
        28,
        [("ukhc.r168.when-overtaken", "fail", "0.24 m/s2 for 9 s: 2.2 m/s gained while the other comes by")],
        hz=20,
    )
    yield overtaken(
        "been_drifts",
        [(0, 0)],
        "fail",
        "drifts 0.8 m towards the other within 2 s",
        across=[(7, OWN - 0.4), (8.6, OWN + 0.5)],
    )
