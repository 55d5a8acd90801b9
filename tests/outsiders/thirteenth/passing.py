"""Cyclists, people on foot and animals that are passed; being overtaken; parked vans."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from tests.outsiders.log import Size
from tests.outsiders.thirteenth.drive import DE, FAR, TURNED, Drive, Wanted, draw
from tests.outsiders.thirteenth.motion import SIZES, Across, Speeds
from tests.outsiders.thirteenth.street import AWAY, N, two_way


def passing(
    name: str,
    clear: float,
    wanted: Wanted,
    *,
    v: float = 11,
    vb: float = 5,
    cls: str = "bicycle",
    size: Size | None = None,
    ego_cls: str = "car",
    ego_size: Size = (4.5, 1.8, 1.5),
    ego_u: Callable[[float, float], Across] | None = None,
    wob: Callable[[float], Across] | None = None,
    lht: bool = True,
    **more: Any,
) -> Drive:
    """The ego passes somebody 2.9 m from the middle, so far away; ego_u, wob: their own ways, by the time when it is level."""
    road = {key: more.pop(key) for key in ("frame", "kind", "limit") if key in more}
    street = two_way(lht, length=900, **road)
    width = (size or SIZES[cls])[1] or 0
    u = 2.9 - width / 2 - clear - (ego_size[1] or 0) / 2
    level = 40 / (v - vb)
    usual = [(0, N), (max(level - 4.5, 0), N), (max(level - 2, 0.5), u), (level + 2, u), (level + 5, N)]
    actors = [
        street.go("ego", ego_cls, 150, v, ego_u(u, level) if ego_u else usual, size=ego_size),
        street.go("b", cls, 190, vb, wob(level) if wob else 2.9, size=size),
    ]
    return draw(name, street.map, actors, level + 9, wanted, **more)


def overtaken(
    name: str, v: Speeds, wanted: Wanted, *, across: Across = ((0, N),), vo: float = 20, **more: Any
) -> Drive:
    """A car overtakes the ego."""
    street = two_way(**more)
    other = street.go("o", "car", 165, vo, [(0, N), (0.5, N), (3, AWAY), (12.5, AWAY), (15.5, N)])
    return draw(name, street.map, [street.go("ego", "car", 200, v, across), other], 20, wanted)


def obstructed(
    name: str, s: float, wanted: Wanted, *, v: Speeds = 10, come: Speeds = 11, late: bool = False, seconds: float = 22
) -> Drive:
    """The ego goes round a parked van, somebody comes from s; late: it waits first."""
    street = two_way(kind="town", limit=13.41, length=900)
    at_once: Across = [(0, N), (2.5, N), (4.8, -0.9), (8, -0.9), (10.5, N)]
    waited: Across = [(0, N), (13, N), (16, -0.9), (19.5, -0.9), (22, N)]
    actors = [
        street.go("ego", "car", 200, v, waited if late else at_once),
        street.go("parked", "van", 262, 0, 2.2),
        street.come("onc", "car", s, come, N),
    ]
    return draw(name, street.map, actors, seconds, wanted)


def british_cyclists() -> Iterator[Drive]:
    """Cyclists in Great Britain."""
    yield passing("bike_1m2", 1.2, [("ukhc.r163.cyclist", "fail", "1.2 m at 11 m/s")])
    yield passing("bike_1m4", 1.4, [("ukhc.r163.cyclist", "fail", "1.4 m")], v=12, frame=TURNED)
    yield passing("bike_1m65", 1.65, [("ukhc.r163.cyclist", "pass", "1.65 m at 27 mph")], v=12)
    yield passing("bike_1m7_fast", 1.7, [("ukhc.r163.cyclist", "fail", "1.7 m at 36 mph, 2 m asked")], v=16)
    yield passing("bike_2m2_fast", 2.2, [("ukhc.r163.cyclist", "pass", "2.2 m")], v=16, hz=20)
    yield passing(
        "bike_cut_back",
        1.7,
        [
            ("ukhc.r163.cyclist", "fail", "lorry's tail comes back in while the cyclist is still beside it"),
            (
                "criticality.thw",
                "not fail",
                "1.16 s at least while its front is behind the cyclist; later only its tail is",
            ),
        ],
        v=10,
        ego_cls="truck",
        ego_size=(12, 2.5, 3.5),
        ego_u=lambda u, t: [(0, N), (t - 4, N), (t - 2, u), (t - 0.3, u), (t + 1.2, 0.75)],
    )
    yield passing(
        "bike_wobble",
        1.7,
        [("ukhc.r163.cyclist", "fail", "the cyclist swerves to 1.0 m while beside")],
        v=10,
        wob=lambda t: [(0, 2.9), (t - 0.5, 2.9), (t + 0.2, 2.3), (t + 1.2, 2.9)],
    )
    yield passing("bike_near_miss_slow", 0.6, [("ukhc.r163.cyclist", "fail", "0.6 m")], v=7, vb=3.5, frame=FAR)


def german_cyclists() -> Iterator[Drive]:
    """Cyclists and people on foot in Germany."""
    yield passing(
        "s5_town_1m3",
        1.3,
        [("stvo.s5-passing", "fail", "1.3 m in town")],
        lht=False,
        conditions=DE,
        kind="town",
        limit=13.89,
    )
    yield passing(
        "s5_town_1m65",
        1.65,
        [("stvo.s5-passing", "pass", "1.65 m in town")],
        lht=False,
        conditions=DE,
        kind="town",
        limit=13.89,
    )
    yield passing(
        "s5_open_1m8",
        1.8,
        [("stvo.s5-passing", "fail", "1.8 m outside")],
        v=18,
        lht=False,
        conditions=DE,
        limit=27.78,
        frame=TURNED,
    )
    yield passing(
        "s5_open_2m2", 2.2, [("stvo.s5-passing", "pass", "2.2 m outside")], v=18, lht=False, conditions=DE, limit=27.78
    )
    yield passing(
        "s5_walker",
        1.0,
        [
            ("stvo.s5-passing", "fail", "1.0 m from somebody walking along"),
            ("ukhc.r131.keep-in-lane", "not fail", "over the middle by 0.2 m only to get round somebody on foot"),
        ],
        v=9,
        vb=1.4,
        cls="pedestrian",
        lht=False,
        conditions=DE,
        kind="town",
        limit=13.89,
    )
    yield passing(
        "s5_area_says_open",
        1.7,
        [("stvo.s5-passing", "fail", "1.7 m, area declared open")],
        v=12,
        lht=False,
        conditions={**DE, "area": "open"},
        kind="town",
        limit=13.89,
    )


def animals() -> Iterator[Drive]:
    """Horses, and a dog."""
    yield passing("horse_fast", 2.6, [("ukhc.r215.horse", "fail", "18 mph past a horse")], v=8, vb=2, cls="animal")
    yield passing("horse_close", 1.5, [("ukhc.r215.horse", "fail", "1.5 m")], v=4.2, vb=1.8, cls="animal", frame=TURNED)
    yield passing("horse_good", 2.4, [("ukhc.r215.horse", "pass", "9 mph, 2.4 m")], v=4.1, vb=1.8, cls="animal")
    yield passing("dog", 1.4, [("ukhc.r215.horse", "not fail", "a dog")], v=8, vb=2, cls="animal", size=(0.8, 0.3, 0.6))


def by_others() -> Iterator[Drive]:
    """Others overtake the ego."""
    yield overtaken("oby_steady", 13, [("ukhc.r168.when-overtaken", "pass", "steady")])
    yield overtaken(
        "oby_accel",
        [(0, 13), (3, 13), (9, 18), (20, 18)],
        [("ukhc.r168.when-overtaken", "fail", "0.83 m/s2 while overtaken")],
        vo=21,
    )
    yield overtaken(
        "oby_creep_up",
        [(0, 12), (2, 12), (11, 14.52), (20, 14.52)],
        [("ukhc.r168.when-overtaken", "fail", "2 m/s gained at 0.28 m/s2 while it comes up and passes")],
        vo=17,
        frame=TURNED,
    )
    yield overtaken(
        "oby_drift",
        13,
        [("ukhc.r168.when-overtaken", "fail", "0.47 m/s mean drift towards it")],
        across=[(0, N), (3.5, N), (5.2, 1.05), (14, 1.05)],
    )
    yield overtaken(
        "oby_slow", [(0, 14), (3, 14), (6, 11), (20, 11)], [("ukhc.r168.when-overtaken", "pass", "slows down")]
    )


def parked() -> Iterator[Drive]:
    """A van stands in the way."""
    yield obstructed(
        "obst_force",
        375,
        [("ukhc.r163.obstruction-give-way", "fail", "oncoming at 11 m/s is there as the ego is still in its lane")],
        come=[(0, 11), (4, 11), (6, 5), (8.5, 2.5), (11, 8), (22, 11)],
    )
    yield obstructed(
        "obst_clear",
        800,
        [
            ("ukhc.r163.obstruction-give-way", "not fail", "oncoming is 400 m off"),
            ("ukhc.r143.direction", "not fail", "round a parked van"),
        ],
    )
    yield obstructed(
        "obst_wait",
        380,
        [
            ("ukhc.r163.obstruction-give-way", "not fail", "waits until the oncoming has gone"),
            ("criticality.drac", "not fail", "3.0 m/s2 at most while its front is behind the van"),
            ("criticality.thw", "not fail", "its front is clear of the van before it reaches 5 m/s"),
        ],
        seconds=26,
        v=[(0, 10), (3, 10), (7, 0), (12, 0), (15, 6), (24, 8)],
        late=True,
    )
