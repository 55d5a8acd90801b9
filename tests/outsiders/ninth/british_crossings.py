"""Great Britain: crossings for those on foot."""

from __future__ import annotations

from tests.outsiders.ninth.drive import Drive, draw
from tests.outsiders.ninth.maps import crossing, own, town
from tests.outsiders.ninth.movement import ego, who
from tests.outsiders.ninth.road import Signal
from tests.outsiders.ninth.ways import straight


def _behind_the_walker() -> Drive:
    there = (198.5 - 2.25 - 80) / 9
    walker = straight(200, -5.2, 200, 6)
    return draw(
        "gb_zebra_behind_the_walker_k",
        "The ego drives over a zebra behind the back of somebody on its half.",
        "fail r195.zebra-on",
        town().having(crossing(200, 3.6)),
        [ego(own, 80, 9, -0.4), who("walker", "pedestrian", walker, 5.2 - 0.6 - 1.4 * there, 1.4)],
        20,
        rate=20,
    )


def british_crossings() -> list[Drive]:
    """Return its drives."""
    return [
        draw(
            "gb_overtakes_before_zebra_k",
            "The ego overtakes a moving car just before a zebra.",
            "fail r191.crossing-overtake",
            town().having(crossing(260, 3.6)),
            [
                ego(
                    own,
                    130,
                    12,
                    [(5, 0), (7.5, 3.6), (11.5, 3.6), (14, 0)],
                    indicator=[(0, "off"), (4, "offside"), (9, "off")],
                ),
                who("slow", "car", own, 190, 6),
            ],
            22,
        ),
        draw(
            "gb_pelican_on_red_two_heads_k",
            "The ego drives over a signalled crossing on red; the head of the other side is green.",
            "fail r196.pelican r175.red",
            town().having(
                crossing(200, 3.6, signalled=True),
                Signal(195, -1.8, name="stop_line", kind="294", country="DE", lanes=(-1, -1), width=3.6),
                Signal(
                    195.5,
                    -4.4,
                    name="traffic_light",
                    country="OpenDRIVE",
                    kind="1000001",
                    ident="P1",
                    lanes=(-1, -1),
                    dynamic=True,
                ),
                Signal(
                    204.5,
                    4.4,
                    name="traffic_light",
                    country="OpenDRIVE",
                    kind="1000001",
                    ident="P2",
                    lanes=(1, 1),
                    orientation="-",
                    dynamic=True,
                ),
            ),
            [ego(own, 60, 11), who("walker", "pedestrian", straight(200, 5.2, 200, -6), 0, [(9.5, 0), (10, 1.3)])],
            20,
            lights={"P1": [(0, "green"), (4, "amber"), (7, "red")], "P2": [(0, "green")]},
        ),
        _behind_the_walker(),
    ]
