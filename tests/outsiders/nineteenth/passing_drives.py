"""Cyclists, walkers and horses."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tests.outsiders.nineteenth.cast import OWN, oncoming
from tests.outsiders.nineteenth.drive import Actor, Drive, Knots, Wanted, draw
from tests.outsiders.nineteenth.maps import (
    KMH_50,
    KMH_100,
    MPH_30,
    MPH_60,
    two_lanes,
)
from tests.outsiders.nineteenth.path import Path, bend, line
from tests.outsiders.nineteenth.road import Limit, Map

TIGHT_BEND = bend(60, 45, 1.4, 300)


def passing(  # noqa: PLR0917
    name: str,
    nation: str,
    wanted: Sequence[Wanted],
    speed: float,
    across: float,
    other_across: Knots,
    other_speed: float = 4.0,
    cls: str = "bicycle",
    *,
    path: Path | None = None,
    kind: str = "town",
    limit: Limit = None,
    gap: float = 40.0,
    seconds: float = 16,
    hz: float = 10,
    more: Sequence[Actor] = (),
    times: tuple[float, float, float, float] = (0, 3, 9, 12),
    footway: float = 0.0,
    cond: dict[str, str] | None = None,
) -> Drive:
    """The ego passes somebody slow: it moves over between the first two times, and back between the last two."""
    way = path or line(700)
    out = [(times[0], OWN), (times[1], across), (times[2], across), (times[3], OWN)]
    return draw(
        name,
        nation,
        Map([two_lanes(way, "broken", kind, limit or (MPH_30 if nation != "de" else KMH_50), footway=footway)]),
        [
            Actor("ego", "car", way, 30, speed, out),
            Actor("c", cls, way, 30 + gap, other_speed, other_across),
            *more,
        ],
        seconds,
        wanted,
        hz=hz,
        cond=cond or {},
    )


def cyclists() -> Iterator[Drive]:
    """Cyclists in Great Britain."""
    yield passing(
        "cyc_fast_17",
        "gb-eng",
        [("ukhc.r163.cyclist", "fail", "1.7 m at 17 m/s (38 mph) wants 2 m")],
        17,
        -2.9 + 0.3 + 1.7 + 0.9,
        -2.9,
        seconds=30,
        kind="rural",
        limit=MPH_60,
        gap=80,
    )
    yield passing(
        "cyc_bend",
        "gb-eng",
        [("ukhc.r163.cyclist", "fail", "1.2 m in a bend of 45 m")],
        10,
        -2.8 + 0.3 + 1.2 + 0.9,
        -2.8,
        path=TIGHT_BEND,
        gap=35,
    )
    yield passing(
        "cyc_swerves",
        "gb-eng",
        [("ukhc.r163.cyclist", "fail", "the cyclist comes out to 1.0 m while being passed; the ego holds its line")],
        11,
        -3.0 + 0.3 + 1.7 + 0.9,
        [(3.5, -3.0), (5.2, -2.3)],
        seconds=30,
    )
    yield draw(
        "cyc_bus_tail",
        "gb-eng",
        Map([two_lanes(line(700), "broken", "town", ("30", "mph"))]),
        [
            Actor("ego", "bus", line(700), 30, 12, [(0, OWN), (3, 0.375), (5, 0.375), (7, -0.45), (10, OWN)]),
            Actor("c", "bicycle", line(700), 75, 4, -2.9),
        ],
        26,
        [("ukhc.r163.cyclist", "fail", "the bus moves in while its rear is still beside the cyclist: 1.2 m")],
    )


def in_germany() -> Iterator[Drive]:
    """Cyclists and walkers in Germany."""
    yield passing(
        "cyc_de_open_18",
        "de",
        [("stvo.s5-passing", "fail", "1.8 m outside wants 2")],
        19,
        -2.9 + 0.3 + 1.8 + 0.9,
        -2.9,
        seconds=30,
        kind="rural",
        limit=KMH_100,
        gap=95,
        cond={"area": "open"},
    )
    yield passing(
        "walk_de_14",
        "de",
        [("stvo.s5-passing", "fail", "1.2 m to one who walks along the edge")],
        11,
        -3.1 + 0.25 + 1.2 + 0.9,
        -3.1,
        1.4,
        "pedestrian",
        gap=55,
    )
    yield passing(
        "walk_de_footway",
        "de",
        [("stvo.s5-passing", "not fail", "walks on the footway"), ("ukhc.no-collision", "pass", "1.9 m")],
        11,
        OWN,
        -4.8,
        1.4,
        "pedestrian",
        gap=55,
        footway=2.5,
    )


def more_cyclists() -> Iterator[Drive]:
    """Two cyclists, and one that comes."""
    yield passing(
        "cyc_two_second",
        "gb-eng",
        [("ukhc.r163.cyclist", "fail", "the first at 1.8 m, the second, further out, at 0.9 m")],
        11,
        -2.9 + 0.3 + 1.8 + 0.9,
        -2.9,
        more=[Actor("c2", "bicycle", line(700), 30 + 55, 4, -2.0)],
        times=(0, 3, 9, 12),
        seconds=32,
    )
    yield passing(
        "cyc_oncoming",
        "gb-eng",
        [
            ("ukhc.r163.cyclist", "not fail", "comes the other way: met, not passed"),
            ("ukhc.no-collision", "pass", "over a metre"),
        ],
        11,
        OWN,
        -2.9,
        more=[oncoming(line(700), 150, 5, "c2", "bicycle", -1.4)],
        other_speed=11.5,
        gap=120,
    )


def horses() -> Iterator[Drive]:
    """Horses."""
    yield passing(
        "horse_fast",
        "gb-eng",
        [("ukhc.r215.horse", "fail", "7 m/s (15.7 mph) though 2.5 m away")],
        7,
        -2.9 + 0.35 + 2.5 + 0.9,
        -2.9,
        1.8,
        "animal",
        gap=30,
    )
    yield passing(
        "horse_slow",
        "gb-eng",
        [("ukhc.r215.horse", "pass", "4.2 m/s and 2.4 m")],
        4.2,
        -2.9 + 0.35 + 2.4 + 0.9,
        -2.9,
        1.6,
        "animal",
        gap=18,
        times=(0, 3, 13, 16),
        seconds=20,
    )
