"""Germany: crossings for those on foot."""

from __future__ import annotations

from tests.outsiders.ninth.drive import Drive, draw
from tests.outsiders.ninth.maps import crossing, ortsstrasse, own, stop_and_light
from tests.outsiders.ninth.movement import ego, who
from tests.outsiders.ninth.ways import straight, when


def _still_on_it() -> Drive:
    speeds = [(4, 11), (12, 0), (19, 0), (22, 6)]
    start = 195 - 2.25 - 2.2 - 44 - 44
    there = when(speeds, 195 - 2.25 - 2.2 - 88, 198.5 - 2.25)
    slow = who("alt", "pedestrian", straight(200, -5.5, 200, 6), 5.5 - 0.45 - 0.7 * there, 0.7)
    return draw(
        "de_ampel_gruen_noch_jemand_drauf_k",
        "The ego starts on green over a crossing that somebody slow is still on.",
        "fail r198.still-crossing performance.precise-stop",
        ortsstrasse().having(crossing(200, 3.5, signalled=True), *stop_and_light(3.5)),
        [ego(own, start, speeds), slow],
        36,
        lights={"P1": [(0, "red"), (18.4, "green")]},
    )


def german_crossings() -> list[Drive]:
    """Return its drives."""
    return [
        draw(
            "de_zebra_angehalten_k",
            "The ego stands on a zebra for twelve seconds with nobody about.",
            "fail r191.no-stopping",
            ortsstrasse().having(crossing(200, 3.5)),
            [ego(own, 100, [(6, 11), (11.9, 0), (24, 0), (28, 8)])],
            34,
        ),
        _still_on_it(),
    ]
