"""Germany: logs and maps that lack something."""

from __future__ import annotations

from tests.outsiders.sixth.crossroads import lit, through
from tests.outsiders.sixth.drive import Chapter, Drive
from tests.outsiders.sixth.faults import mute
from tests.outsiders.sixth.maps import OPP, OWN, autobahn, beside, street


def german_oddities() -> list[Drive]:
    chapter = Chapter()

    d = chapter.draw(
        "de_ego_without_size_h",
        "The ego tails a car; its own size is not known.",
        "pass stvo.rg3 | not fail no-collision | not pass stvo.rg1",
        autobahn(length=1500, lanes=2, speed=120),
        20,
    )
    u = beside(2)
    d.add("ego", s=20, v=31, u=u, size=(None, None, None)).add("lead", s=20 + 9, v=31, u=u)

    d = chapter.draw(
        "de_light_silent_h",
        "The ego passes a light whose state is not told for thirteen seconds.",
        "not pass r175.red",
        lit("de", 50, "s", walk=False),
        20,
    )
    d.add("ego", through("s", "n"), s=100, v=12, u=OWN)
    d.lights = [("tl1", 0.1 * i, "green") for i in range(8)] + [("tl1", 14 + 0.1 * i, "red") for i in range(20)]

    d = chapter.draw(
        "de_speed_column_zero_h",
        "The ego does 140 km/h where 100 are allowed, and the recorded speed is zero.",
        "not pass stvo.rg3",
        autobahn(length=1500, lanes=2, speed=100),
        20,
    )
    d.add("ego", s=20, v=39, u=beside(2), edit=mute)

    d = chapter.draw(
        "de_kurve_zu_schnell_h",
        "The ego takes a bend of 58 m at 66 km/h; 25 steps a second.",
        "fail comfort.lateral comfort.nuplan | pass stvo.rg3",
        street("de", kind="rural", speed=100, bend=((150, 0), (110, 1 / 58), (250, 0))),
        22,
        hz=25,
        noise=0.0,
    )
    d.add("ego", s=10, v=18.3, u=OWN).add("geg", s=480, v=15, u=OPP, against=True)

    d = chapter.draw(
        "de_bus_angefahren_h",
        "A bus runs into the standing ego.",
        "fail no-collision",
        street("de", 500, "town", 50, walk=True),
        20,
    )
    d.add("ego", s=150, v=0, u=OWN).add("bus", s=40, v=[(0, 9), (8, 9), (20, 9)], u=OWN, cls="bus", t1=12)
    return chapter.drives
