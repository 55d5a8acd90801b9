"""Crossings with lights."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.first.chapter import Spec, scene
from tests.outsiders.first.maps import urban
from tests.outsiders.first.movement import ahead, car, line, to_stop


def crossings() -> Iterator[Spec]:
    m = urban(1, crossing="lights")
    there = line([(200, 6.5), (200, -40)], 0)
    red = {60: [(0.0, "red")], 70: [(0.0, "red")]}
    yield scene(
        "pelican_red",
        "The ego drives over a pelican crossing on red while somebody crosses.",
        "fail r196.pelican r175.red",
        m,
        [
            car(ahead(m, 100), 12.0),
            car(there, [(0, 0), (4.5, 0), (5, 1.3), (7.1, 1.3), (7.6, 0), (11, 0), (12, 1.3)], "pedestrian"),
        ],
        16,
        lights=red,
    )
    late = {k: [(0.0, "red"), (5.0, "flashing"), (8.0, "green")] for k in (60, 70)}
    slow = [(0, 0), (2, 0), (2.5, 0.8)]
    yield scene(
        "pelican_still_crossing",
        "The light has turned green, somebody slow is still on the ego's half; it drives on before them.",
        "fail r198.still-crossing",
        m,
        [
            car(ahead(m, 62), 11.0),
            car(there, [(0, 0), (3.5, 0), (4, 0.9), (7.3, 0.9), (7.8, 0), (13.5, 0), (14.5, 1.2)], "pedestrian"),
        ],
        16,
        lights=late,
    )
    yield scene(
        "pelican_waited",
        "The ego stops for red, the walker is across, it goes on green.",
        "pass r196.pelican r175.red | not fail r198.still-crossing",
        m,
        [car(ahead(m, 100), to_stop(11, 92, 2.5, 8.0, 9)), car(there, [*slow[:2], (2.5, 1.4)], "pedestrian")],
        30,
        lights={k: [(0.0, "red"), (12.0, "flashing"), (16.0, "green")] for k in (60, 70)},
    )
