"""Great Britain: crossings for those on foot, and roundabouts."""

from __future__ import annotations

from tests.outsiders.sixth.cast import pelican, zebra
from tests.outsiders.sixth.drive import Chapter, Drive
from tests.outsiders.sixth.maps import OWN
from tests.outsiders.sixth.roundabout import around, ring, wrong_way


def british_crossings() -> list[Drive]:
    chapter = Chapter()

    d = chapter.draw(
        "gb_zebra_ignored_h",
        "The ego drives over a zebra while two people are on it.",
        "fail r195.zebra-on | pass r191.no-stopping",
        zebra(),
        18,
    )
    d.add("ego", s=80, v=10.5, u=OWN).walk("w", [(0, 200, -6), (5, 200, -6), (14, 200, 6.6)])
    d.walk("w2", [(0, 200.5, 5.8), (8.6, 200.5, 5.8), (16, 200.5, -4.6)])

    d = chapter.draw(
        "gb_zebra_courteous_h",
        "The ego waits at a zebra until the walker is on the other half.",
        "pass r195.zebra-on r191.crossing-overtake",
        zebra(),
        25,
    )
    d.add("ego", s=80, v=[(0, 11), (4, 11), (11, 0), (15, 0), (20, 9), (25, 10)], u=OWN).walk(
        "w", [(0, 200, 6), (8, 200, 6), (16, 200, -6)]
    )

    d = chapter.draw(
        "gb_zebra_overtake_h",
        "The ego passes a car that has stopped at a zebra for somebody.",
        "fail r191.crossing-overtake r195.zebra-on",
        zebra(own=2),
        16,
    )
    d.add("ego", s=60, v=12, u=1.75).add("kind", s=150, v=[(0, 10), (2, 10), (6, 0), (16, 0)], u=5.25)
    d.walk("w", [(0, 200, 9), (5, 200, 9), (13, 200, -2)])

    d = chapter.draw(
        "gb_zebra_stood_on_h", "The ego stands on a zebra of its own accord.", "fail r191.no-stopping", zebra(), 35
    )
    d.add("ego", s=125.5, v=[(0, 9), (5, 9), (11.5, 0), (28, 0), (35, 8)], u=OWN)
    d.add("far", s=330, v=0, u=OWN)

    d = chapter.draw(
        "gb_zebra_queue_h",
        "The ego stands on a zebra behind a van.",
        "fail r192.keep-clear | not fail r191.no-stopping",
        zebra(),
        40,
    )
    d.add("ego", s=125.5, v=[(0, 9), (5, 9), (11.5, 0), (30, 0), (40, 8)], u=OWN).add(
        "q", s=208.5, v=[(0, 0), (28, 0), (40, 9)], u=OWN, cls="van"
    )

    d = chapter.draw(
        "gb_pelican_red_h",
        "The ego drives over a signalled crossing on red.",
        "fail r196.pelican r175.red",
        pelican("signal crossing"),
        18,
    )
    d.add("ego", s=80, v=11, u=OWN).light("tp", (0, "green"), (4, "amber"), (7, "red"))
    d.walk("w", [(0, 200, -6), (11.5, 200, -6), (18, 200, 3)])

    d = chapter.draw(
        "gb_puffin_still_crossing_h",
        "The ego drives over a signalled crossing on green into somebody who is still on it.",
        "fail r198.still-crossing",
        pelican("signal crossing"),
        18,
    )
    d.add("ego", s=90, v=11, u=OWN).light("tp", (0, "red"), (5, "red_amber"), (7, "green"))
    d.walk("w", [(0, 200, -6), (4, 200, -6), (14, 200, 7)])

    drawn, pieces = ring()

    d = chapter.draw(
        "gb_roundabout_good_h",
        "The ego goes straight on at a roundabout.",
        "pass r143.direction r124.speed-limit | not fail no-collision",
        drawn,
        36,
    )
    d.add(
        "ego",
        around(pieces, "s", "n"),
        s=40,
        v=[(0, 9), (6, 9), (10, 5.2), (24, 5.2), (30, 8), (36, 9)],
        u=2.0,
        ind=[(18, "left"), (26, "off")],
    )

    drawn, _ = ring()

    d = chapter.draw(
        "gb_roundabout_wrong_way_h", "The ego goes the wrong way round a roundabout.", "fail r143.direction", drawn, 34
    )
    way = wrong_way(drawn)
    d.add("ego", way, s=60, v=[(0, 8), (4, 8), (7, 5.5), (34, 6)], u=[(6, 2.0), (10, 0.0), (18, 0.0), (22, 2.0)])

    drawn, pieces = ring()

    d = chapter.draw(
        "gb_roundabout_hit_h",
        "The ego runs into a car that slows down in a roundabout.",
        "fail no-collision criticality.ttc",
        drawn,
        20,
    )
    way = around(pieces, "s", "n")
    d.add("ego", way, s=60, v=6, u=2.0).add("lead", way, s=86, v=[(0, 6), (9, 5), (10.5, 1), (20, 1)], u=2.0)
    return chapter.drives
