"""Cyclists, horses and people on foot along the road."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.fourteenth.drive import Actor, Drive
from tests.outsiders.fourteenth.lines import go, walk
from tests.outsiders.fourteenth.places import Place, street
from tests.outsiders.fourteenth.scenes import alone, on, out_to


def soft_users_a() -> Iterator[Drive]:
    gb = street("gb", at=(1.0, 2.0, 0.0))
    bend = street("gb", bends=((150, 0.0), (300, 1 / 120), (300, 0.0)), at=(1.0, 2.0, 2.0))
    cyc = "ukhc.r163.cyclist"

    def bike(place: Place, v: float = 5.0, u: float = 3.0, kind: str = "bicycle", s0: float = 170.0) -> list[Actor]:
        return [Actor("b", kind, on(place.course, go(s0, (0, v)), u))]

    yield alone(
        "cyclist-09", "passes a cyclist at 0.9 m", gb, ((0, 13),), [(cyc, "fail", "0.9 m")], u=0.9, others=bike(gb)
    )
    yield alone(
        "cyclist-17-slow",
        "passes at 1.8 m at 27 mph",
        gb,
        ((0, 12),),
        [(cyc, "pass", "1.8 m, 1.5 asked for")],
        u=out_to(0.0),
        others=bike(gb),
    )
    yield alone(
        "cyclist-17-fast",
        "passes at 1.7 m at 45 mph",
        gb,
        ((0, 20),),
        [(cyc, "fail", "1.7 m, 2 asked for")],
        u=out_to(0.1),
        others=bike(gb, s0=230.0),
    )
    yield alone(
        "cyclist-bend",
        "passes at 1.1 m in a bend, box turned",
        bend,
        ((0, 12),),
        [(cyc, "fail", "1.1 m"), ("ukhc.r131.keep-in-lane", "fail", "0.2 m over the line for 20 s")],
        u=0.7,
        others=bike(bend),
        hz=5.0,
    )
    yield alone(
        "cyclist-lorry-mirror",
        "a bus passes at 1.2 m",
        gb,
        ((0, 12),),
        [(cyc, "fail", "1.2 m")],
        u=out_to(0.22),
        others=bike(gb),
        kind="bus",
    )


def soft_users_b() -> Iterator[Drive]:
    de = street("de", at=(1.0, 2.0, 2.0))
    town = street("de", kind="town", speed="50 km/h", at=(1.0, 2.0, 2.0))
    s5 = "stvo.s5-passing"

    def bike(place: Place, v: float = 5.0, u: float = 3.0, kind: str = "bicycle", s0: float = 170.0) -> list[Actor]:
        return [Actor("b", kind, on(place.course, go(s0, (0, v)), u))]

    yield alone(
        "de-cyclist-town-13",
        "passes at 1.3 m in town",
        town,
        ((0, 12),),
        [(s5, "fail", "1.3 m, 1.5 asked for")],
        u=out_to(0.5),
        others=bike(town),
    )
    yield alone(
        "de-cyclist-town-17",
        "passes at 1.7 m in town",
        town,
        ((0, 12),),
        [(s5, "pass", "1.7 m")],
        u=out_to(0.1),
        others=bike(town),
        hz=20.0,
    )
    yield alone(
        "de-cyclist-open-17",
        "passes at 1.7 m outside",
        de,
        ((0, 18),),
        [(s5, "fail", "1.7 m, 2 asked for")],
        u=out_to(0.1),
        others=bike(de, s0=210.0),
    )
    yield alone(
        "de-walker-open",
        "passes somebody walking the same way at 1.4 m",
        de,
        ((0, 18),),
        [(s5, "fail", "1.4 m, 2 asked for")],
        u=out_to(0.45),
        others=[Actor("w", "pedestrian", walk(de.course, (0, 250, 3.0), (40, 300, 3.0)))],
    )
    yield alone(
        "de-cyclist-overtakes-on",
        "a cyclist rides faster past the crawling ego at 0.8 m",
        town,
        ((0, 2.0),),
        [(s5, "not fail", "the cyclist is faster")],
        u=1.2,
        others=bike(town, v=6.0, u=3.2, s0=60.0),
    )


def soft_users_c() -> Iterator[Drive]:
    gb = street("gb", at=(1.0, 2.0, 0.0))
    horse = "ukhc.r215.horse"

    def bike(place: Place, v: float = 5.0, u: float = 3.0, kind: str = "bicycle", s0: float = 170.0) -> list[Actor]:
        return [Actor("b", kind, on(place.course, go(s0, (0, v)), u))]

    yield alone(
        "horse-fast",
        "passes a horse at 8 m/s, 2.5 m away",
        gb,
        ((0, 8),),
        [(horse, "fail", "8 m/s, 4.5 allowed")],
        u=out_to(-0.8),
        others=bike(gb, 1.5, 3.0, "animal", 150.0),
    )
    yield alone(
        "horse-near",
        "passes a horse at 4 m/s, 1.3 m away",
        gb,
        ((0, 4),),
        [(horse, "fail", "1.3 m, 2 asked for")],
        u=out_to(0.4),
        others=bike(gb, 1.5, 3.0, "animal", 118.0),
    )
    yield alone(
        "horse-good",
        "passes a horse at 4 m/s, 2.4 m away",
        gb,
        ((0, 4),),
        [(horse, "pass", "2.4 m at 4 m/s")],
        u=out_to(-0.7),
        others=bike(gb, 1.5, 3.0, "animal", 118.0),
    )


def soft_users() -> Iterator[Drive]:
    """Return the drives of this chapter."""
    yield from soft_users_a()
    yield from soft_users_b()
    yield from soft_users_c()
