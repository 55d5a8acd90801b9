"""Pedestrian crossings."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.fourteenth.drive import Actor, Drive
from tests.outsiders.fourteenth.lines import Course, go, walk
from tests.outsiders.fourteenth.maps import Lane
from tests.outsiders.fourteenth.places import OWN, crossing_street, street
from tests.outsiders.fourteenth.scenes import alone, at_lights, on


def crossings_a() -> Iterator[Drive]:
    zebra = crossing_street("zebra crossing")

    def foot(course: Course, t: float, u0: float, u1: float, v: float = 1.4) -> Actor:
        return Actor(
            "f", "pedestrian", walk(course, (0.0, 220.0, u0), (t, 220.0, u0), (t + abs(u1 - u0) / v, 220.0, u1))
        )

    on_z = "ukhc.r195.zebra-on"
    z = zebra.course
    run = ((0.0, 10.0),)
    yield alone(
        "zebra-walker",
        "goes before somebody on its half of the zebra",
        zebra,
        run,
        [(on_z, "fail", "on its half when it comes on")],
        u=OWN,
        others=[
            Actor(
                "f",
                "pedestrian",
                walk(z, (0, 220, 4.3), (10.4, 220, 4.3), (11.4, 220, 3.0), (13, 220, 3.0), (18, 220, -4)),
            )
        ],
    )
    yield alone(
        "zebra-waits",
        "stops for somebody on the zebra",
        zebra,
        ((0, 10), (7, 10), (15.5, 0), (21, 0), (24, 6)),
        [(on_z, "pass", "the half is free")],
        u=OWN,
        others=[foot(z, 9.0, 4.0, -4.0)],
        seconds=28.0,
    )
    yield alone(
        "zebra-running",
        "goes before a child that has just run on from the near side, seen late",
        zebra,
        run,
        [(on_z, "fail", "0.9 m onto the zebra")],
        u=OWN,
        others=[
            Actor(
                "f",
                "pedestrian",
                walk(z, (0, 220, 5.8), (10.7, 220, 5.8), (11.55, 220, 3.1), (12.4, 220, 3.05), (14.0, 220, 5.5)),
                size=(0.4, 0.4, 1.2),
                seen=(9.5, 60.0),
            )
        ],
        hz=20.0,
    )


def crossings_b() -> Iterator[Drive]:
    plain = crossing_street("signal crossing", light=True)

    def foot(course: Course, t: float, u0: float, u1: float, v: float = 1.4) -> Actor:
        return Actor(
            "f", "pedestrian", walk(course, (0.0, 220.0, u0), (t, 220.0, u0), (t + abs(u1 - u0) / v, 220.0, u1))
        )

    pel = "ukhc.r196.pelican"
    still = "ukhc.r198.still-crossing"
    p = plain.course
    changing = ((0.0, "green"), (6.0, "amber"), (9.0, "red"))
    both = {"pl": changing, "pl2": changing}
    blinking = ((0.0, "red"), (8.0, "flashing"))
    flash = {"pl": blinking, "pl2": blinking}
    freed = ((0.0, "red"), (9.0, "green"))
    green = {"pl": freed, "pl2": freed}
    run = ((0.0, 10.0),)
    yield at_lights(
        "pelican-red",
        "over the signalled crossing on red",
        plain,
        run,
        [(pel, "fail", "red from 9 s, on it at 11.6 s"), ("ukhc.r175.red", "fail", "red at the line")],
        both,
        [],
    )
    yield at_lights(
        "pelican-flash",
        "amber flashes, somebody is on its half",
        plain,
        run,
        [(pel, "fail", "somebody on its half")],
        flash,
        [foot(p, 10.8, 4.0, 3.0)],
    )
    yield at_lights(
        "pelican-flash-free", "amber flashes, nobody there", plain, run, [(pel, "pass", "nobody")], flash, []
    )
    yield at_lights(
        "pelican-green-on",
        "green, somebody still on its half",
        plain,
        run,
        [(still, "fail", "still on its half")],
        green,
        [foot(p, 6.9, -4.0, 4.0, 1.5)],
    )


def crossings_c() -> Iterator[Drive]:
    zebra = crossing_street("zebra crossing")
    ov = "ukhc.r191.crossing-overtake"
    stand = "ukhc.r191.no-stopping"
    keep = "ukhc.r192.keep-clear"
    z = zebra.course
    wide = street("gb", kind="town", speed="30 mph", own=(Lane(3.5), Lane(3.5)), at=(8.0, 8.0, -0.2))
    wide.road.crossing("zc", 220.0, "zebra crossing", half=7.0)
    beside = Actor("s", "van", on(wide.course, go(150.0, (0, 5), (20, 5)), 5.25))
    q = Actor("q", "truck", on(z, go(205.0, (0, 6), (3, 6), (6, 0), (22, 0), (25, 5)), 1.75))
    yield alone(
        "zebra-overtake",
        "gets past a moving van in the lane beside within the zig-zags",
        wide,
        ((0, 10),),
        [(ov, "fail", "gets past it about 8 m before the crossing")],
        u=OWN,
        others=[beside],
        s0=96.0,
    )
    yield alone(
        "zebra-stands",
        "stands on the zebra 10 s for nothing",
        zebra,
        ((0, 10), (7, 10), (17, 0), (28, 0), (31, 6)),
        [(stand, "fail", "10 s")],
        u=OWN,
        seconds=32.0,
    )
    yield alone(
        "zebra-queue",
        "stands on the zebra 11 s behind a lorry",
        zebra,
        ((0, 9), (10.3, 9), (16.3, 0), (27.0, 0), (29, 4)),
        [(keep, "fail", "11 s behind a lorry")],
        u=OWN,
        others=[q],
        seconds=32.0,
    )


def crossings() -> Iterator[Drive]:
    """Return the drives of this chapter."""
    yield from crossings_a()
    yield from crossings_b()
    yield from crossings_c()
