"""What is easily missed between two steps."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.fourteenth.drive import Actor, Drive, car
from tests.outsiders.fourteenth.lines import go, side
from tests.outsiders.fourteenth.places import crossroads, street
from tests.outsiders.fourteenth.scenes import alone, on


def between_steps_a() -> Iterator[Drive]:
    gb = crossroads("gb", speed="60 mph", kind="rural", at=(2.0, 3.0, 0.4), reach=200.0)
    fast = on(gb.way("W", "E"), go(100.0, (0, 26)), 1.75)
    road = street("gb", at=(2.0, 3.0, 0.4))
    drifts = side((0.0, -1.75), (5.0, -1.75), (8.0, 0.6), (11.0, 0.6), (14.0, -1.75))
    drifter = Actor("o", "car", on(road.course, go(520.0, (0, 18), back=True), drifts, back=True))
    swing = on(road.course, go(170.0, (0, 0)), 2.75, turned=0.35)
    me = car(on(gb.way("S", "N"), go(157.0, (0, 13)), 1.75))
    late = Actor("o", "car", on(gb.way("W", "E"), go(80.0, (0, 26)), 1.75))
    early = car(on(gb.way("S", "N"), go(155.0, (0, 13)), 1.75))
    yield Drive(
        "between-steps",
        "two cars cross, 2 steps a second: they meet between two of them",
        gb,
        me,
        [Actor("o", "car", fast)],
        12.0,
        [("ukhc.no-collision", "fail", "boxes meet between two steps")],
        hz=2.0,
    )
    yield Drive(
        "pet-one",
        "crosses about a second before another",
        gb,
        early,
        [late],
        12.0,
        [("criticality.pet", "fail", "about 1 s"), ("ukhc.no-collision", "pass", "apart")],
    )
    yield alone(
        "drifts-over",
        "an oncoming car comes over into the ego's lane for some seconds",
        road,
        ((0, 18),),
        [("rss.opposite", "fail", "its centre in the ego's lane, 36 m/s towards each other")],
        u=2.55,
        others=[drifter],
    )
    yield alone(
        "touches-corner",
        "brushes the corner of a van that stands aslant",
        road,
        ((0, 10),),
        [("ukhc.no-collision", "fail", "0.1 m of overlap at one corner")],
        u=0.55,
        others=[Actor("p", "van", swing)],
    )


def between_steps() -> Iterator[Drive]:
    """Return the drives of this chapter."""
    yield from between_steps_a()
