"""Traffic lights."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.fourteenth.drive import Drive
from tests.outsiders.fourteenth.places import lit
from tests.outsiders.fourteenth.scenes import turn


def red_lights_a() -> Iterator[Drive]:
    gb = lit("gb")
    de = lit("de")
    r = "ukhc.r175.red"
    steady = ((0.0, 10.0),)

    def light(*rows: tuple[float, str | None]) -> dict[str, tuple[tuple[float, str | None], ...]]:
        return {"tl": rows}

    yield turn(
        "light-red-03",
        "red 0.4 s before the front is over the line",
        gb,
        "N",
        steady,
        [(r, "fail", "front over the line at 7.48 s, red from 7.0")],
        lights=light((0.0, "green"), (4.0, "amber"), (7.0, "red")),
    )
    yield turn(
        "light-amber",
        "red only 0.6 s after the front was over the line",
        gb,
        "N",
        steady,
        [(r, "pass", "amber at 7.48 s")],
        lights=light((0.0, "green"), (6.5, "amber"), (8.1, "red")),
    )
    yield turn(
        "light-red-amber",
        "goes on red and amber",
        gb,
        "E",
        steady,
        [(r, "fail", "red with amber at 7.48 s")],
        lights=light((0.0, "red"), (6.5, "red_amber"), (8.2, "green")),
    )
    yield turn(
        "light-de-red-late",
        "a lorry goes over at red",
        de,
        "N",
        ((0, 8.0),),
        [(r, "fail", "red")],
        kind="truck",
        lights=light((0.0, "green"), (5.0, "amber"), (7.0, "red")),
    )
    yield turn(
        "light-stops-over",
        "stops with the front 1.5 m over the line at red",
        gb,
        "N",
        ((0, 10), (3, 10), (12.29, 0)),
        [(r, "fail", "front 1.5 m over the line")],
        lights=light((0.0, "green"), (2.0, "amber"), (5.0, "red")),
        seconds=18.0,
    )


def red_lights_b() -> Iterator[Drive]:
    gb = lit("gb")
    r = "ukhc.r175.red"

    def light(*rows: tuple[float, str | None]) -> dict[str, tuple[tuple[float, str | None], ...]]:
        return {"tl": rows}

    halt = ((0, 10), (3, 10), (11.84, 0), (14, 0), (17, 6))
    yield turn(
        "light-waits",
        "stops 0.25 m before the line, goes on green",
        gb,
        "N",
        halt,
        [(r, "pass", "green"), ("performance.precise-stop", "pass", "0.2 m")],
        lights=light((0.0, "amber"), (3.0, "red"), (13.5, "green")),
    )


def red_lights() -> Iterator[Drive]:
    """Return the drives of this chapter."""
    yield from red_lights_a()
    yield from red_lights_b()
