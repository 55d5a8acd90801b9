"""Great Britain: crossings for those on foot."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.sixteenth.cast import ENGLAND, OWN, down, ego, up
from tests.outsiders.sixteenth.drive import Actor, Drive, draw
from tests.outsiders.sixteenth.maps import pelican, zebra
from tests.outsiders.sixteenth.ways import along


def _zebras() -> Iterator[Drive]:
    yield draw(
        "gb-zebra-near-half",
        zebra(),
        [ego(along(OWN, 10, 196.25)), up(300, -16.07, [(0, 1.3), (9.8, 1.3), (10, 0)])],
        ENGLAND,
        22,
        [("ukhc.r195.zebra-on", "fail", "somebody is 0.5 m on the crossing on the near half, gap 0.25 m")],
    )
    yield draw(
        "gb-zebra-left-already",
        zebra(),
        [ego(along(OWN, 10, 196.25)), down(300, 8.4, 1.3)],
        ENGLAND,
        22,
        [("ukhc.r195.zebra-on", "pass", "already on the pavement"), ("ukhc.no-collision", "pass", "clear")],
    )
    yield draw(
        "gb-zebra-stands-on",
        zebra(),
        [ego(along(OWN, [(0, 10), (6, 10), (10, 0), (22, 0), (26, 8)], 220))],
        ENGLAND,
        34,
        [
            ("ukhc.r191.no-stopping", "fail", "stands on it 12 s for nobody"),
            ("ukhc.r192.keep-clear", "not fail", "nobody ahead"),
        ],
    )
    yield draw(
        "gb-zebra-overtakes",
        zebra(lanes=2),
        [ego(along(OWN, 10, 196.25)), Actor("o", "car", along(-5.25, 6, 233))],
        ENGLAND,
        22,
        [("ukhc.r191.crossing-overtake", "fail", "gets past a moving car 10 m before the zebra")],
    )


def _pelicans() -> Iterator[Drive]:
    yield draw(
        "gb-pelican-flashing",
        pelican(),
        [ego(along(OWN, 10, 196.25)), up(300, -16.07, [(0, 1.3), (9.8, 1.3), (10, 0)])],
        ENGLAND,
        22,
        [("ukhc.r196.pelican", "fail", "somebody on the near half while amber flashes")],
        lights={"tl": [(0, "red"), (5, "flashing"), (16, "green")]},
    )
    yield draw(
        "gb-still-crossing",
        pelican(),
        [ego(along(OWN, 10, 196.25)), down(300, 6.8, 1)],
        ENGLAND,
        22,
        [
            ("ukhc.r198.still-crossing", "fail", "old man still on the near half on green"),
            ("ukhc.r196.pelican", "not fail", "green"),
        ],
        lights={"tl": [(0, "red"), (7, "red_amber"), (8.5, "green")]},
    )


def british_crossings() -> Iterator[Drive]:
    yield from _zebras()
    yield from _pelicans()
