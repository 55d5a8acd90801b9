"""Comfort."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.sixteenth.cast import DE, OWN, ego
from tests.outsiders.sixteenth.drive import Drive, draw
from tests.outsiders.sixteenth.maps import rural
from tests.outsiders.sixteenth.ways import Motion, Path, along


def _rides() -> Iterator[Drive]:
    yield draw(
        "comfort-gentle",
        rural(limit=27.78),
        [ego(along(OWN, [(0, 10), (4, 10), (12, 20), (16, 20), (22, 12)], 20))],
        DE,
        25,
        [
            ("comfort.accel-iso15622", "pass", "1.25"),
            ("comfort.decel-iso15622", "pass", "1.33"),
            ("comfort.nuplan", "pass", "gentle"),
        ],
    )
    yield draw(
        "comfort-bus-bend",
        rural(limit=27.78, bends=[(150, 0), (200, -1 / 80), (200, 0)]),
        [ego(Motion(Path(0, 0, 0, [(150, 0), (200, -1 / 80), (200, 0)]), 14.8, 20, OWN), "bus")],
        DE,
        22,
        [("comfort.lateral", "fail", "2.68 m/s2 and more, a bus")],
    )
    yield draw(
        "comfort-jab",
        rural(limit=27.78),
        [ego(along(OWN, [(0, 22), (6, 22), (6.2, 21.7), (7.6, 16), (15, 16)], 20))],
        DE,
        15,
        [("comfort.jerk-iso15622", "fail", "from 0 to 4 m/s2 in 0.2 s at 21 m/s"), ("comfort.nuplan", "fail", "jerk")],
    )


def comforts() -> Iterator[Drive]:
    yield from _rides()
