"""Zebras and signalled crossings on a street."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from tests.outsiders.thirteenth.crossroads import steps
from tests.outsiders.thirteenth.drive import FAR, GB, TURNED, Drive, Wanted, draw
from tests.outsiders.thirteenth.following import Other, went
from tests.outsiders.thirteenth.motion import Actor, Speeds, line
from tests.outsiders.thirteenth.street import AWAY, N, Street, two_way

HERE = 300.0


def street_with(name: str, n: int = 1, lit: bool = False, **more: Any) -> Street:
    """A street of n lanes each way with a crossing, whose lights are P0, P1, ..."""
    street = two_way(True, n, n, 2.0, kind="town", limit=13.41, length=600, **more)
    street.road.add_crosswalk(HERE, 3.5 * n, name)
    if lit:
        street.road.add_stop_line(HERE - 4, 1.75 * n, 3.5 * n)
        for i in range(n):
            street.road.add_light(HERE - 4, 3.5 * n + 1, f"P{i}", i + 1)
    return street


def crosses(u0: float, u1: float, t: float) -> Other:
    """Somebody on foot sets out at t."""

    def drawn(street: Street) -> Actor:
        way = line(HERE, street.side * u0, HERE, street.side * u1)
        return Actor("p", "pedestrian", way, 0, steps(t, abs(u1 - u0)), soft=0.1)

    return drawn


def crossing(
    name: str,
    v: Speeds,
    wanted: Wanted,
    *,
    u: float = N,
    others: tuple[Other, ...] | list[Other] = (),
    kind: str = "zebra",
    lights: list[tuple[float, str]] | None = None,
    n: int = 1,
    seconds: float = 16,
    **more: Any,
) -> Drive:
    """The ego comes from 60 m before the crossing."""
    street = street_with(kind, n, bool(lights), **more)
    actors = [street.go("ego", "car", HERE - 60, v, u), *(other(street) for other in others)]
    shown = {f"P{i}": lights for i in range(n)} if lights else None
    return draw(name, street.map, actors, seconds, wanted, lights=shown)


def zebras() -> Iterator[Drive]:
    """Zebras."""
    yield crossing(
        "zebra_on",
        10,
        [("ukhc.r195.zebra-on", "fail", "on the near half, 1.3 m from the kerb, as the ego comes")],
        others=[crosses(4.6, -4.6, 4.6)],
    )
    yield crossing(
        "zebra_far_half_then_near",
        10,
        [("ukhc.r195.zebra-on", "fail", "has walked over from the far side and is on the ego's half")],
        others=[crosses(-4.6, 4.6, 1.9)],
        frame=TURNED,
    )
    yield crossing(
        "zebra_empty",
        10,
        [("ukhc.r195.zebra-on", "pass", "steps out after the ego has gone")],
        others=[crosses(4.6, -4.6, 9)],
    )
    yield crossing(
        "zebra_give",
        [(0, 10), (1.5, 10), (5.5, 0), (11, 0), (14, 6), (99, 6)],
        [
            ("ukhc.r195.zebra-on", "pass", "waits until the walker is over"),
            ("ukhc.r191.no-stopping", "pass", "stands before it"),
        ],
        others=[crosses(5, -5, 3)],
        seconds=20,
    )
    yield crossing(
        "zebra_noname",
        10,
        [("ukhc.r195.zebra-on", "unknown", "the crossing is not named a zebra")],
        others=[crosses(4.6, -4.6, 4.6)],
        kind="crosswalk",
    )


def standing() -> Iterator[Drive]:
    """Standing on a zebra."""
    yield crossing(
        "zebra_stand",
        [(0, 8), (5.8, 8), (9.3, 0), (17.6, 0), (19, 5), (99, 5)],
        [("ukhc.r191.no-stopping", "fail", "stands 8 s on the crossing with nobody about")],
        others=[],
        seconds=24,
    )
    yield crossing(
        "zebra_queue",
        [(0, 8), (5.8, 8), (9.3, 0), (17.6, 0), (19, 5), (99, 5)],
        [
            ("ukhc.r192.keep-clear", "fail", "stands 8 s on the crossing behind a queue"),
            ("ukhc.r191.no-stopping", "not fail", "queue"),
        ],
        others=[went("q", "car", 310, [(0, 0), (16, 0), (18, 5), (99, 5)], 1.75)],
        seconds=24,
        frame=FAR,
    )


def past_others() -> Iterator[Drive]:
    """Past others before a zebra."""
    yield crossing(
        "zebra_overtake",
        11,
        [("ukhc.r191.crossing-overtake", "fail", "gets past a moving car some 10 m before the crossing")],
        u=5.25 - 3.5,
        n=2,
        others=[went("s", "car", 258, 6.5, 5.25)],
    )
    yield crossing(
        "zebra_overtake_stopped",
        [(0, 10), (99, 10)],
        [
            ("ukhc.r191.crossing-overtake", "fail", "goes past a car that has stopped for somebody on the crossing"),
            ("ukhc.r195.zebra-on", "fail", "walker on the ego's half"),
        ],
        u=1.75,
        n=2,
        others=[
            went("s", "car", 290, [(0, 4), (1, 2), (1.6, 0), (12, 0), (14, 5), (99, 5)], 5.25),
            crosses(8, -8, 2.0),
        ],
        frame=TURNED,
    )
    yield crossing(
        "zebra_passed_before",
        12,
        [("ukhc.r191.crossing-overtake", "pass", "got past 45 m before the crossing")],
        u=1.75,
        n=2,
        others=[went("s", "car", 250, 6, 5.25)],
    )


def signalled() -> Iterator[Drive]:
    """Crossings with lights."""
    yield crossing(
        "pelican_red",
        10,
        [("ukhc.r196.pelican", "fail", "red"), ("ukhc.r175.red", "fail", "red")],
        kind="signal crossing",
        lights=[(0, "red")],
    )
    yield crossing(
        "pelican_flash_on",
        10,
        [("ukhc.r196.pelican", "fail", "on its half while amber flashes")],
        kind="signal crossing",
        lights=[(0, "red"), (2, "flashing")],
        others=[crosses(4.6, -4.6, 4.4)],
        frame=TURNED,
    )
    yield crossing(
        "pelican_flash_free",
        10,
        [("ukhc.r196.pelican", "pass", "nobody there")],
        kind="signal crossing",
        lights=[(0, "red"), (2, "flashing")],
    )
    yield crossing(
        "pelican_green_still",
        10,
        [("ukhc.r198.still-crossing", "fail", "walker still on its half on green")],
        kind="signal crossing",
        lights=[(0, "green")],
        others=[crosses(-4.6, 4.6, 1.5)],
    )
    yield crossing(
        "pelican_green_free",
        10,
        [("ukhc.r198.still-crossing", "pass", "nobody on it"), ("ukhc.r196.pelican", "pass", "green")],
        kind="signal crossing",
        lights=[(0, "green")],
        others=[crosses(-4.6, 4.6, 9)],
    )


def out_late(name: str, cls: str | None, wanted: Wanted, **more: Any) -> Drive:
    """Somebody sets out 1.4 s before the ego is there, and does not stop."""
    street = street_with("zebra")
    way = line(HERE, 4.6, HERE, -4.6)
    speeds: Speeds = [(0, 0), (4.2, 0), (4.4, 1.4), (99, 1.4)]
    size = (0.5, 0.5, 1.75 if cls else 1.7)
    who = Actor("p", cls, way, 0, speeds, size=size, soft=0.1)
    return draw(name, street.map, [street.go("ego", "car", 240, 10, N), who], 12, wanted, **more)


def second_look() -> Iterator[Drive]:
    """What a lazy judge would pass."""
    street = street_with("zebra")
    ego = street.go("ego", "car", 250, 11, [(0, N), (0.2, N), (1.7, AWAY), (5, AWAY), (7, N)])
    yield draw(
        "x_zebra_overtake_wrong_side",
        street.map,
        [ego, street.go("s", "car", 271, 5, N)],
        14,
        [
            (
                "ukhc.r191.crossing-overtake",
                "fail",
                "gets past a moving car 8 m before the crossing, in the opposing lane",
            )
        ],
    )
    yield out_late(
        "x_zebra_lowrate", "pedestrian", [("ukhc.r195.zebra-on", "fail", "on its half as the ego comes, at 2 Hz")], hz=2
    )
    yield out_late(
        "x_zebra_noclass", None, [("ukhc.r195.zebra-on", "not pass", "somebody without a class is on its half")]
    )
    street = street_with("zebra", frame=FAR)
    yield draw(
        "x_zebra_stand_rear",
        street.map,
        [street.go("ego", "car", 240, [(0, 8), (5.8, 8), (9.9, 0), (18, 0), (20, 5), (99, 5)], N)],
        26,
        [("ukhc.r191.no-stopping", "fail", "stands 8 s with its rear on the crossing, nobody ahead")],
        conditions=GB,
    )
