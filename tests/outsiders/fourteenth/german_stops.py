"""Stopping, turning back and braking on German motorways."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.fourteenth.drive import Actor, Drive
from tests.outsiders.fourteenth.lines import go
from tests.outsiders.fourteenth.places import MID, SLOW, motorway
from tests.outsiders.fourteenth.scenes import alone, behind, on


def german_stops_a() -> Iterator[Drive]:
    de = motorway("de", at=(50.0, 2000.0, -2.8))
    i1 = "stvo.ri1"
    i3 = "stvo.ri3"
    halt = ((0, 20), (4, 20), (14, 0))
    yield alone(
        "de-stops",
        "stops on the motorway for nothing and stands 12 s",
        de,
        halt,
        [(i1, "fail", "nobody ahead"), ("ukhc.r240.no-stopping", "fail", "stands 12 s")],
        seconds=28.0,
    )
    yield alone(
        "de-stops-queue",
        "stops behind a standing queue",
        de,
        halt,
        [(i1, "pass", "queue 6 m ahead"), ("ukhc.r240.no-stopping", "pass", "queue")],
        others=[
            Actor("q", "truck", on(de.course, go(100 + 180 + 14.5, (0, 0)), SLOW)),
            Actor("q2", "car", on(de.course, go(100 + 180 + 30, (0, 0)), SLOW)),
        ],
        seconds=28.0,
    )
    yield alone(
        "de-stops-far",
        "stops 60 m behind the queue's end and stands 12 s",
        de,
        halt,
        [(i1, "fail", "60 m, 30 m count as the queue")],
        others=[Actor("q", "truck", on(de.course, go(100 + 180 + 8.25 + 60, (0, 0)), SLOW))],
        seconds=28.0,
    )
    yield alone(
        "de-reverses",
        "stands, then reverses 20 m on the motorway",
        de,
        ((0, 10), (4, 0), (7, 0), (9, -3.0), (14, -3.0), (16, 0)),
        [(i3, "fail", "3 m/s backwards"), ("ukhc.r263.no-reverse", "fail", "3 m/s backwards")],
        turned=0.0,
    )
    yield alone(
        "de-wrong-way",
        "against the traffic on the motorway",
        de,
        ((0, 25),),
        [(i3, "not pass", "wrong way"), ("ukhc.r143.direction", "not pass", "wrong way")],
        s0=1500.0,
        back=True,
        u=MID,
    )


def german_stops_b() -> Iterator[Drive]:
    de = motorway("de", at=(50.0, 2000.0, -2.8))
    g2 = "stvo.rg2"
    yield alone(
        "de-brakes-hard",
        "brakes with 5 m/s2 for nothing",
        de,
        ((0, 32), (6, 32), (9, 17), (14, 17), (20, 28)),
        [(g2, "fail", "5 m/s2, nobody ahead")],
        u=MID,
    )
    yield behind(
        "de-brakes-too",
        "brakes with 4.5 m/s2 behind one that does",
        de,
        ((0, 30), (6.6, 30), (9.6, 16.5)),
        ((0, 30), (6, 30), (9, 16.5)),
        40.0,
        [(g2, "pass", "the vehicle ahead braked")],
    )
    yield alone(
        "de-brakes-soft",
        "brakes with 1.6 m/s2 for nothing",
        de,
        ((0, 32), (6, 32), (11, 24)),
        [(g2, "pass", "1.6 m/s2")],
        u=MID,
    )


def german_stops() -> Iterator[Drive]:
    """Return the drives of this chapter."""
    yield from german_stops_a()
    yield from german_stops_b()
