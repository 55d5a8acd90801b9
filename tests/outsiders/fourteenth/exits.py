"""Exits of motorways."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.fourteenth.drive import Drive
from tests.outsiders.fourteenth.lines import side
from tests.outsiders.fourteenth.places import SLOW, motorway
from tests.outsiders.fourteenth.scenes import alone


def exits_a() -> Iterator[Drive]:
    for nation, kind, lamps, verdict in (
        ("gb", "exit", ((0.0, "off"), (9.0, "left"), (22.0, "off")), "pass"),
        ("gb", "offRamp", ((0.0, "off"), (12.5, "left"), (22.0, "off")), "fail"),
        ("de", "exit", ((0.0, "off"), (9.0, "left"), (22.0, "off")), "fail"),
    ):
        place = motorway(nation, length=900.0, exit_at=(500.0, 900.0), exit_kind=kind, at=(5.0, 5.0, 2.0))
        place.road.sign("ex1", 380.0, "333" if nation == "de" else "450", name="exit", t=15.0, lanes=(4, 4))
        u = side((0.0, SLOW), (16.0, SLOW), (20.0, 14.1))
        yield (
            alone(
                f"exit-{nation}-{verdict}-{kind.lower()}",
                "passes the exit sign after 11.1 s and leaves after 16 s",
                place,
                ((0, 25),),
                [("ukhc.exit-sign-signal", verdict, f"indicator {lamps[1][1]} from {lamps[1][0]} s")],
                u=u,
                lamp=lamps,
                seconds=25.0,
            )
        )


def exits_b() -> Iterator[Drive]:
    for goes in (False, True):
        place = motorway("gb", length=1100.0, exit_at=(400.0, 700.0), at=(5.0, 5.0, 2.0))
        place.road.sign("ex1", 300.0, "450", name="exit", t=15.0, lanes=(4, 4))
        u = side((0.0, SLOW), (13.0, SLOW), (17.0, 14.1)) if goes else SLOW
        yield (
            alone(
                f"exit-signals-{'goes' if goes else 'stays'}",
                "signals left beside the exit lane, which ends at 700 m",
                place,
                ((0, 25),),
                [
                    (
                        "ukhc.signal-then-leaves",
                        "not fail" if goes else "fail",
                        "in the exit lane" if goes else "stays on the motorway",
                    )
                ],
                u=u,
                lamp=((0.0, "off"), (7.0, "left"), (20.0, "off")),
                seconds=30.0 if not goes else 23.5,
            )
        )


def exits() -> Iterator[Drive]:
    """Return the drives of this chapter."""
    yield from exits_a()
    yield from exits_b()
