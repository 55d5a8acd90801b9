"""Crossings for those on foot, and contact."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from tests.outsiders.nineteenth.cast import OWN, halting, walker
from tests.outsiders.nineteenth.drive import Actor, Drive, Knots, Wanted, draw
from tests.outsiders.nineteenth.maps import (
    MPH_30,
    NEAR_CROSSING,
    WIDTH,
    carriageway,
    light,
    stop_line,
    two_lanes,
)
from tests.outsiders.nineteenth.road import Map, Thing

PELICAN_LIGHT = light("pl", 195)
PELICAN_LINE = stop_line("ps", 195.0)


def ego(speed: Knots, across: Knots = OWN, start: float = 80, cls: str = "car") -> Actor:
    """The ego on the road with the crossing, which is at 200 m."""
    return Actor("ego", cls, NEAR_CROSSING, start, speed, across)


def at_crossing(
    name: str,
    nation: str,
    actors: Sequence[Actor],
    seconds: float,
    wanted: Sequence[Wanted],
    *,
    signalled: bool = False,
    lanes: int = 1,
    **more: Any,
) -> Drive:
    """A drive over a crossing: of a street, or of two lanes of one direction."""
    kind = "signal" if signalled else "zebra"
    if lanes == 1:
        road = two_lanes(NEAR_CROSSING, "broken", "town", MPH_30, footway=2.0)
        road.things.append(Thing("z", "crosswalk", kind, 200, 0.0, 4.0, 2 * WIDTH))
    else:
        road = carriageway(NEAR_CROSSING, lanes, "town", MPH_30, width=WIDTH, shoulder=False)
        road.things.append(Thing("z", "crosswalk", kind, 200, -WIDTH * lanes / 2, 4.0, lanes * WIDTH))
    if signalled:
        road.things.append(PELICAN_LINE)
        road.signs.append(PELICAN_LIGHT)
    return draw(name, nation, Map([road]), actors, seconds, wanted, **more)


def zebras() -> Iterator[Drive]:
    """Zebras."""
    yield at_crossing(
        "zebra_gone",
        "gb-eng",
        [ego(8), walker(200, -9.3, 1.4)],
        20,
        [("ukhc.r195.zebra-on", "pass", "the walker has left the crossing eight seconds before")],
    )
    yield at_crossing(
        "zebra_just_on",
        "gb-eng",
        [ego(9), walker(201, -4.2, [(0, 0), (11.5, 0), (11.8, 0.8), (13.0, 0.8), (13.2, 0), (60, 0)])],
        18,
        [("ukhc.r195.zebra-on", "fail", "stepped onto it a moment before the ego's front came")],
        hz=20,
    )
    yield at_crossing(
        "zebra_two_walkers",
        "gb-eng",
        [ego(8), walker(199.5, -7, 1.4), walker(200.5, -19.5, 1.3, name="w2")],
        20,
        [("ukhc.r195.zebra-on", "fail", "the first has gone over, the second is before the ego")],
    )


def signalled_crossings() -> Iterator[Drive]:
    """Crossings with lights."""
    yield at_crossing(
        "pelican_flash",
        "gb-eng",
        [ego(8), walker(200, -8.0, [(0, 0), (8.5, 0), (9.0, 1.3), (60, 1.3)])],
        22,
        [("ukhc.r196.pelican", "fail", "flashing amber with somebody on its half")],
        signalled=True,
        lights=[("pl", 0, "red"), ("pl", 9, "flashing")],
    )
    yield at_crossing(
        "pelican_still",
        "gb-eng",
        [ego(8), walker(200, -8.0, [(0, 0), (8.5, 0), (9.0, 1.3), (60, 1.3)])],
        22,
        [
            ("ukhc.r198.still-crossing", "fail", "green, but somebody is still before it"),
            ("ukhc.r175.red", "pass", "green"),
        ],
        signalled=True,
        lights=[("pl", 0, "red"), ("pl", 11, "green")],
    )


def crossing_traffic() -> Iterator[Drive]:
    """Overtaking and standing at a crossing."""
    yield at_crossing(
        "crossing_overtakes",
        "gb-eng",
        [ego(12, -WIDTH / 2, 80), Actor("v", "car", NEAR_CROSSING, 118, 7.5, -WIDTH * 1.5)],
        16,
        [("ukhc.r191.crossing-overtake", "fail", "gets past a moving car within 18 m before the crossing")],
        lanes=2,
    )
    yield at_crossing(
        "crossing_queue",
        "gb-eng",
        [
            ego(halting(8, 80, 200.5, 8)),
            Actor("q", "car", NEAR_CROSSING, 208, [(0, 0), (22.5, 0), (24.5, 8), (60, 8)], OWN),
        ],
        32,
        [
            ("ukhc.r192.keep-clear", "fail", "stands on the crossing for 8 s behind a car 3 m ahead"),
            ("ukhc.r191.no-stopping", "not fail", "in a queue"),
        ],
    )


def contact() -> Iterator[Drive]:
    """Contact, and room enough."""
    yield at_crossing(
        "jolt",
        "gb-eng",
        [
            ego([(0, 9), (9, 9), (10.9, 5.5), (11.0, 1.0), (11.4, 0), (30, 0)]),
            Actor(
                "p",
                "car",
                NEAR_CROSSING,
                80 + 81 + 13.77 + 0.325 + 4.5 + 0.2 + 0.2,
                [(0, 0), (10.95, 0), (11.05, 3.0), (13, 0), (30, 0)],
                OWN,
            ),
        ],
        16,
        [("ukhc.contact-signature", "fail", "4.5 m/s lost in 0.1 s at 0.2-0.4 m of another that leaps forward")],
        hz=20,
    )
    yield at_crossing(
        "side_pass",
        "gb-eng",
        [ego(7, -1.55, cls="bus", start=60), Actor("p", "van", NEAR_CROSSING, 150, 0, -4.3)],
        20,
        [("ukhc.no-collision", "pass", "0.47 m of air"), ("ukhc.contact-signature", "pass", "no jolt")],
    )
