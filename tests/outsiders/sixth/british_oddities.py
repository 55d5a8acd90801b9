"""Great Britain: logs and maps that lack something."""

from __future__ import annotations

from tests.outsiders.sixth.crossroads import cross, lit, through
from tests.outsiders.sixth.drive import Chapter, Drive
from tests.outsiders.sixth.faults import freeze, hole, jump, tremble
from tests.outsiders.sixth.lines import Geom
from tests.outsiders.sixth.maps import OPP, OWN, beside, british_motorway, street
from tests.outsiders.sixth.road import Lane, Map, Road


def british_oddities() -> list[Drive]:
    chapter = Chapter()

    d = chapter.draw(
        "gb_lead_vanishes_h",
        "The track of a standing van ends just before the ego is there.",
        "fail criticality.ttc criticality.drac | not pass r126.thinking-gap",
        street("gb", 800),
        18,
    )
    d.add("ego", s=20, v=23, u=OWN).add("stopped", s=240, v=0, u=OWN, cls="van", t1=8.6)

    d = chapter.draw(
        "gb_null_bike_h",
        "The ego passes somebody of a bicycle's size, whose class is not known.",
        "pass no-collision | not pass r163.cyclist",
        street("gb", 600),
        18,
    )
    d.add("ego", s=30, v=17, u=OWN).add("what", s=120, v=5.5, u=3.1, cls=None, size=(1.8, 0.6, 1.7))

    d = chapter.draw(
        "gb_lead_turned_pi_h",
        "The ego tails a car whose recorded heading is turned round.",
        "not pass r126.thinking-gap criticality.thw",
        street("gb", 900),
        20,
    )
    d.add("ego", s=20, v=24, u=OWN).add("lead", s=20 + 4.5 + 8, v=24, u=OWN, turned=3.14159)

    d = chapter.draw(
        "gb_teleport_onto_h",
        "For one step another car is recorded upon the ego.",
        "not pass no-collision",
        street("gb", 600),
        14,
    )
    d.add("ego", s=20, v=20, u=OWN).add("t", s=500, v=18, u=OPP, against=True, edit=jump)

    d = chapter.draw(
        "gb_lead_without_size_h",
        "The ego tails a car whose size is not known.",
        "not fail no-collision | not pass r126.thinking-gap",
        street("gb", 900),
        20,
    )
    d.add("ego", s=20, v=21, u=OWN).add("lead", s=20 + 6.2, v=21, u=OWN, size=(None, None, None))

    d = chapter.draw(
        "gb_two_hertz_crash_h",
        "Two cars meet at a crossroads between two steps.",
        "not pass no-collision",
        cross("gb"),
        20,
        hz=2,
    )
    d.add("ego", through("w", "e"), s=100, v=13, u=OWN).add("x", through("s", "n"), s=209.9 - 14 * 8.5, v=14, u=OWN)

    d = chapter.draw(
        "gb_map_ends_h",
        "The ego speeds up to 60 mph where the map of a street ends.",
        "not pass r124.speed-limit",
        street("gb", 240, "town", 30),
        18,
        hz=5,
    )
    d.add("ego", s=20, v=[(0, 12), (10, 12), (14, 27), (18, 30)], u=OWN)
    low = Road("1", [Geom((0, 0, 0), 600)], [Lane()], [Lane()], 1, "rural", 60, "mph")
    high = Road("2", [Geom((300, -250, 1.5708), 500)], [Lane()], [Lane()], 1, "rural", 60, "mph", z=6.5)

    d = chapter.draw(
        "gb_bridge_over_h",
        "Two vehicles cross above the ego on a bridge.",
        "pass no-collision r143.direction | not fail criticality.pet",
        Map([low, high]),
        20,
        high=True,
    )
    d.add("ego", low.geoms, s=50, v=22, u=OWN).add(
        "above", high.geoms, s=250 - 15 * 11.4 + 1.75, v=15, u=OWN, cls="truck", z=6.5
    )
    d.add("above2", high.geoms, s=250 - 16 * 11.2, v=16, u=OWN, z=6.5)

    d = chapter.draw(
        "gb_child_late_h",
        "The ego hits a child that the log knows late.",
        "fail no-collision",
        street("gb", 500, "town", 30, walk=True),
        14,
        hz=10,
    )
    d.add("ego", s=60, v=[(0, 12), (8.2, 12), (9.8, 0), (14, 0)], u=OWN, soft=0.1).walk(
        "child", [(7.4, 161.2, 3.9), (9.4, 161.2, 0.4), (14, 161.2, -4)], t0=7.4, size=(0.4, 0.4, 1.2)
    )

    d = chapter.draw(
        "gb_child_braked_h",
        "The ego stops for a child.",
        "pass no-collision r143.direction | not fail contact-signature",
        street("gb", 500, "town", 30, walk=True),
        18,
        hz=10,
    )
    d.add("ego", s=60, v=[(0, 12.5), (7.6, 12.5), (9.4, 0), (13, 0), (18, 8)], u=OWN, soft=0.2).walk(
        "child", [(7.0, 172, 5), (11, 172, -1), (15, 172, -5)], t0=7.0, size=(0.4, 0.4, 1.2)
    )

    d = chapter.draw(
        "gb_hole_at_red_h",
        "The ego crosses the line on red within a hole of the log.",
        "not pass r175.red",
        lit("gb", arms="s"),
        20,
    )
    d.add("ego", through("s", "n"), s=100, v=12, u=OWN, edit=hole).light("tl1", (0, "red"))

    d = chapter.draw(
        "gb_trembling_queue_h",
        "The ego stands in a motorway queue, and its recorded speed trembles.",
        "pass no-collision | not fail r263.no-reverse r143.direction r240.no-stopping",
        british_motorway(length=800),
        30,
        noise=0.03,
    )
    u = beside(3)
    d.add("ego", s=200, v=0, u=u, edit=tremble).add("a", s=207.5, v=0, u=u).add("b", s=193, v=0, u=u).add(
        "c", s=203, v=0, u=beside(4), cls="truck"
    )

    d = chapter.draw(
        "gb_lead_frozen_h",
        "The track of the car ahead freezes and the ego drives through it.",
        "not pass no-collision",
        street("gb", 900),
        18,
    )
    d.add("ego", s=20, v=22, u=OWN).add("lead", s=20 + 50, v=22, u=OWN, edit=freeze)

    d = chapter.draw(
        "gb_noise_single_track_h",
        "The ego follows a car on a narrow road, recorded with noise.",
        "pass r131.keep-in-lane r143.direction | not fail r129.no-cross-solid r126.thinking-gap",
        street("gb", 700, "rural", 60, width=3.0),
        30,
        noise=0.05,
    )
    d.add("ego", s=30, v=20, u=1.5).add("lead", s=110, v=20, u=1.5).add("on", s=690, v=20, u=-1.5, against=True)
    return chapter.drives
