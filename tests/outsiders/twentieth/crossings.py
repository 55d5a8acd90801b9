"""Pedestrian crossings, with and without lights."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tests.outsiders.twentieth.drive import Drive, Expect
from tests.outsiders.twentieth.motion import Actor, Move, when
from tests.outsiders.twentieth.roads import Lane
from tests.outsiders.twentieth.sites import Straight, foot, straight

Z0, Z1 = 100.0, 103.0
ON = "ukhc.r195.zebra-on"


def site(near: int = 1, name: str = "zebra", **kw: Any) -> Straight:
    """A town road of 240 m with footways and a crossing at 100 m."""
    p = straight(near, 240.0, "town", 30.0 if near > 0 else 50.0, edge=[Lane("sidewalk", 2.5, "none")], **kw)
    half = 3.5 * int(kw.get("own", 1))
    p.road.patch(name, "crosswalk", (Z0, Z1, -half, half), "c1")
    return p


def walker(p: Straight, t: float, u: float, v: float, kind: str | None = "pedestrian", **kw: Any) -> Actor:
    """Crosses from the near to the far side (v > 0) and is u metres to the near side at t; v < 0: the other way."""
    way = foot(p.road, 101.5, 9.0 if v > 0 else -9.0, -9.0 if v > 0 else 9.0)
    s = 9.0 - u if v > 0 else 9.0 + u
    return Actor("ped", kind, way, s - abs(v) * t, abs(v), **kw)


def zebra(name: str, u: float, walk: float, expect: Sequence[Expect], **kw: Any) -> Drive:
    """The ego goes over at v; the walker is at u when its front comes on."""
    near = int(kw.get("near", 1))
    v = float(kw.get("v", 9.0))
    p = site(near, str(kw.get("label", "zebra")))
    t = (Z0 - 2.25 - 30) / v
    kind = kw.get("kind", "pedestrian")
    size = (0.5, 0.5, 1.7) if kind is None else None
    ped = walker(p, t, u, walk, kind, size=size)
    return Drive(
        name,
        str(kw["what"]),
        p.map,
        [Actor("ego", "car", p.lane(1), 30, v), ped],
        list(expect),
        t + 6,
        hz=float(kw.get("hz", 10.0)),
        nation="gb" if near > 0 else "de",
    )


def zebras() -> list[Drive]:
    """People on zebras."""
    return [
        zebra(
            "zebra_leaving",
            0.4,
            1.5,
            [(ON, "fail", "still on the ego's half, 0.4 m from the middle")],
            what="the walker is about to leave the ego's half",
        ),
        zebra(
            "zebra_low_rate",
            2.6,
            1.2,
            [
                ("ukhc.no-collision", "fail", "hit between two steps"),
                (ON, "fail", "walker 0.9 m inside the ego's half"),
            ],
            what="the same at 2 Hz and 13 m/s",
            hz=2.0,
            v=13.0,
        ),
        zebra(
            "zebra_bike",
            0.0,
            3.0,
            [
                (ON, "not fail", "nobody on foot is on it"),
                ("criticality.thw", "not fail", "the cyclist crosses at right angles, nobody is followed"),
            ],
            what="a cyclist rides over the zebra behind the ego",
            kind="bicycle",
        ),
        zebra(
            "zebra_unnamed",
            0.5,
            1.4,
            [(ON, "not pass", "it may be a zebra, and a walker is on the ego's half")],
            what="a crossing that does not say what it is",
            label="crossing",
        ),
        zebra(
            "zebra_noclass",
            0.5,
            1.4,
            [(ON, "not pass", "somebody of a person's size is on the ego's half")],
            what="the walker has no class",
            kind=None,
        ),
        zebra(
            "zebra_de",
            3.05,
            -1.3,
            [(ON, "fail", "walker 0.45 m from the near kerb, still on the ego's half")],
            what="DE: the walker is about to reach the near kerb",
            near=-1,
        ),
        zebra_kept(),
    ]


def zebra_kept() -> Drive:
    """Stops and waits, then goes."""
    p = site()
    moves: list[Move] = [("stop", Z0 - 2.25 - 1.5, 2.0), ("hold", 8.0), ("v", 8.0, 1.5)]
    return Drive(
        "zebra_kept",
        "waits until the walker has left the whole crossing",
        p.map,
        [Actor("ego", "car", p.lane(1), 40, 9, moves), walker(p, 8.0, 3.0, 1.4)],
        [(ON, "pass", "nobody on it")],
        28,
    )


def standing_on(name: str, kind: str, queue: bool, ped: bool, expect: Sequence[Expect]) -> Drive:
    """The ego stands on the crossing for 8 s."""
    p = site()
    length = 12.0 if kind == "bus" else 4.5
    at = 101.5 if kind == "car" else Z1 + length / 2 - 1.5
    moves: list[Move] = [("stop", at, 1.5), ("hold", 8.0), ("v", 8.0, 1.5)]
    t = when(40, 9, moves, at - 0.01)
    others: list[Actor] = []
    if queue:
        lead = at + length / 2 + 2.5 + 2.25
        others = [
            Actor(f"q{i}", "car", p.lane(1), lead + 7 * i, 0.0, [("hold", t + 7.5 - i), ("v", 8.0, 1.5)])
            for i in range(3)
        ]
    if ped:
        way = foot(p.road, at + length / 2 + 1.2, 5.5, -9.0)
        others.append(
            Actor(
                "ped",
                "pedestrian",
                way,
                0.0,
                0.0,
                [("hold", t - 4.5), ("v", 1.2, 1.5), ("stop", 3.8, 1.5), ("hold", 7.0), ("v", 1.2, 1.5)],
            )
        )
    return Drive(
        name,
        f"{kind} stands on the crossing for 8 s",
        p.map,
        [Actor("ego", kind, p.lane(1), 40, 9, moves), *others],
        list(expect),
        t + 18,
    )


def side_by_side(name: str, moving: bool, ped: bool, past: float, expect: Sequence[Expect]) -> Drive:
    """Two lanes each way: the ego in the inner lane gets past somebody in the outer one, `past` m before the crossing."""
    p = site(own=2, opp=2)
    v = 12.0
    t = (Z0 - past - 2.25 - 20) / v
    here = Z0 - past - 2.25
    if moving:
        other = Actor("other", "car", p.lane(2), here - 7.0 * t, 7.0)
    else:
        stop = Z0 - 2.25 - 1.0
        away = stop - 40
        other = Actor(
            "other",
            "van",
            p.lane(2),
            away,
            9.0,
            [("stop", stop, 2.5), ("hold", 9), ("v", 8, 1.5)],
            size=(4.5, 1.9, 2.0),
        )
        if not ped:
            other = Actor("other", "van", p.lane(2), stop, 0.0, [], lat=[(0.0, 0.75)])
    others = [other]
    if ped:
        others.append(walker(p, (Z0 - 2.25 - 20) / v + 0.3, 5.4, 1.4))
    return Drive(
        name,
        "gets past somebody in the outer lane near the zebra",
        p.map,
        [Actor("ego", "car", p.lane(1), 20, v), *others],
        list(expect),
        t + 8,
    )


PELICAN = "ukhc.r196.pelican"


def pelican(name: str, state: str, u: float | None, expect: Sequence[Expect], **kw: Any) -> Drive:
    """A signalled crossing 2 m behind its stop line; the walker is at u when the front comes onto it."""
    near = int(kw.get("near", 1))
    p = site(near, "signal crossing")
    p.road.bar(Z0 - 2, 1.75, 3.5, True, "line")
    p.road.sign("pel", Z0 - 2, 4.5, True, type="1000001", country="OpenDRIVE", lanes="1")
    v = float(kw.get("v", 8.0))
    t = (Z0 - 2.25 - 30) / v
    rows = [("pel", 0.0, "red"), ("pel", t - float(kw.get("since", 3.0)), state)]
    others = [walker(p, t, u, 1.3)] if u is not None else []
    return Drive(
        name,
        str(kw["what"]),
        p.map,
        [Actor("ego", "car", p.lane(1), 30, v), *others],
        list(expect),
        t + 6,
        nation="gb" if near > 0 else "de",
        lights=rows,
    )


def pelicans() -> list[Drive]:
    """Crossings with lights."""
    return [
        pelican(
            "pelican_red",
            "red",
            None,
            [(PELICAN, "fail", "on red"), ("ukhc.r175.red", "fail", "on red")],
            what="over a signalled crossing on red, nobody there",
        ),
        pelican(
            "pelican_flash",
            "flashing",
            0.5,
            [(PELICAN, "fail", "amber flashes, walker on the ego's half")],
            what="amber flashes, a walker is on the ego's half",
        ),
        pelican(
            "pelican_flash_free",
            "flashing",
            None,
            [(PELICAN, "pass", "amber flashes, nobody there")],
            what="amber flashes, nobody there",
        ),
        pelican(
            "pelican_green_on",
            "green",
            0.45,
            [("ukhc.r198.still-crossing", "fail", "walker still on the ego's half")],
            what="green, a walker is still on the ego's half",
            since=1.0,
        ),
    ]


def drives() -> list[Drive]:
    """All of them."""
    past = "ukhc.r191.crossing-overtake"
    return [
        *zebras(),
        standing_on(
            "stand_zebra", "car", False, False, [("ukhc.r191.no-stopping", "fail", "stands 8 s on it, nobody there")]
        ),
        standing_on(
            "stand_queue_bus",
            "bus",
            True,
            False,
            [("ukhc.r192.keep-clear", "fail", "the bus's tail is 1.5 m on it for 8 s behind a queue")],
        ),
        standing_on(
            "stand_ped", "car", False, True, [("ukhc.r191.no-stopping", "not fail", "stands for somebody in its way")]
        ),
        side_by_side("pass_moving", True, False, 9.0, [(past, "fail", "front past a moving car 9 m before the zebra")]),
        side_by_side(
            "pass_stopped",
            False,
            True,
            3.0,
            [(past, "fail", "past a van that stopped for a walker"), (ON, "fail", "the walker is on the ego's half")],
        ),
        side_by_side("pass_parked", False, False, 3.0, [(past, "not fail", "a parked van may be passed")]),
        *pelicans(),
    ]
