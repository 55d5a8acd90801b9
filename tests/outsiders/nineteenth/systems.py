"""Comfort, and the automated lane keeping."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from tests.outsiders.nineteenth.cast import OWN
from tests.outsiders.nineteenth.drive import Actor, Drive, Knots, Lamps, Wanted, draw, gaining, steady
from tests.outsiders.nineteenth.maps import (
    KMH_60,
    KMH_100,
    carriageway,
    middle_of,
    two_lanes,
)
from tests.outsiders.nineteenth.path import Path, bend, line
from tests.outsiders.nineteenth.road import Map

PLAIN = line(1500)
SIXTY_BEND = bend(100, 60, 1.5, 300)
ROAD = line(1200)
FAST, SLOW = middle_of(1), middle_of(2)


def comfort(
    name: str,
    speed: float,
    gains: Sequence[tuple[float, float]],
    wanted: Sequence[Wanted],
    cls: str = "car",
    *,
    path: Path = PLAIN,
    hz: float = 10,
) -> Drive:
    """The ego alone on a road, which gains speed as said."""
    actor = Actor("ego", cls, path.offset(OWN), 60, gaining(speed, gains, 18))
    return draw(name, "de", Map([two_lanes(path, "broken", "rural", KMH_100)]), [actor], 16, wanted, hz=hz)


def ego(speed: Knots, across: Knots = SLOW, ind: Lamps = None) -> Actor:
    """The ego, driven by the system."""
    return Actor("ego", "car", ROAD, 60, speed, across, ind=ind)


def other(name: str, speed: Knots, across: Knots, start: float) -> Actor:
    """Somebody else."""
    return Actor(name, "car", ROAD, start, speed, across)


def in_lane(name: str, actors: Sequence[Actor], seconds: float, wanted: Sequence[Wanted], **more: Any) -> Drive:
    """A drive of the automated lane keeping on a motorway of two lanes."""
    road = Map([carriageway(ROAD, 2, limit=KMH_60)])
    return draw(name, "de", road, actors, seconds, wanted, cond={"engaged": "yes"}, **more)


def accelerations() -> Iterator[Drive]:
    """Accelerations and jerks."""
    yield comfort(
        "acc_hard_slow",
        1,
        steady(3.3, 3, 5),
        [
            ("comfort.accel-iso15622", "pass", "3.3 m/s2 below 8 m/s (3.6 allowed there)"),
            ("comfort.nuplan", "fail", "3.3 over 2.4"),
        ],
        hz=20,
    )
    yield comfort(
        "dec_short",
        25,
        [(0, 0), (5, 0), (6.2, -4.6), (6.4, -4.6), (7.6, 0)],
        [("comfort.decel-iso15622", "pass", "the mean of no 2 s is over 3.3")],
        hz=20,
    )
    yield comfort(
        "jerk_up",
        25,
        [(0, 0), (6, 0), (7, -3.3), (9, -3.3), (10.5, 0)],
        [("comfort.jerk-iso15622", "fail", "3.3 m/s2 within one second at 24 m/s, 2.5 allowed")],
        hz=20,
    )
    yield comfort(
        "jerk_ok",
        25,
        [(0, 0), (5, 0), (8, -3.0), (9, -3.0), (12, 0)],
        [
            ("comfort.jerk-iso15622", "pass", "1 m/s3"),
            ("comfort.decel-iso15622", "pass", "3 at most"),
            ("comfort.nuplan", "pass", "gentle"),
        ],
        hz=20,
    )
    yield comfort(
        "jerk_release",
        22,
        [(0, 0), (4, 0), (7, -3.0), (8, -3.0), (8.5, 0)],
        [
            ("comfort.jerk-iso15622", "pass", "the braking grows slowly; only its end is sudden"),
            ("comfort.nuplan", "pass", "6 m/s3 when the brake is let go, but 2.9 m/s3 by nuPlan's own filter"),
        ],
        hz=20,
    )
    yield comfort(
        "bend_bus",
        13.1,
        [(0, 0)],
        [("comfort.lateral", "fail", "13.1^2/61.75 = 2.78; a bus 2.5")],
        path=SIXTY_BEND,
        cls="bus",
    )


def lane_keeping() -> Iterator[Drive]:
    """The automated lane keeping."""
    yield in_lane(
        "alks_gap_close",
        [ego(13.5), other("l", 13.5, middle_of(2), 60 + 4.5 + 15)],
        16,
        [("alks-r157.follow-gap", "fail", "15 m at 48.6 km/h; about 20 m")],
    )
    yield in_lane(
        "alks_cutin_stays",
        [ego(13.0), other("l", 13.0, [(2, middle_of(1)), (5, middle_of(2))], 60 + 4.5 + 9)],
        25,
        [
            ("alks-r157.cut-in-gap", "fail", "stays at 9 m for 20 s; 19 m asked for"),
            ("alks-r157.cut-in", "not fail", "no contact"),
        ],
    )
    yield in_lane(
        "alks_cutin_hits",
        [ego([(0, 16), (20, 16)]), other("l", 8.0, [(2, middle_of(1)), (5, middle_of(2))], 60 + 4.5 + 60)],
        11,
        [("ukhc.no-collision", "fail", "hits it"), ("criticality.ttc", "fail", "to nothing")],
    )
    yield in_lane(
        "alks_brakes",
        [ego(gaining(16, steady(-6.3, 4, 6.2)))],
        12,
        [("alks-r157.emergency", "fail", "6.3 m/s2, nothing declared")],
        events=[(0, "emergency_manoeuvre", "off")],
    )
