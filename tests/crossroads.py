"""Whole scenes at a junction, a crossing, in a queue and by night, each with the rules that it breaks."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa

from tests.derive.junction_scenes import ARM, R, cross, crosswalk, signal, stop_line
from tests.scenes import Actor, drive, moving, times

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

    from drivelint.engine.batch import Drive
    from tests.scenes import Road, Row

    Floats = NDArray[np.float64]

T = times(30)
LINE = 183.0  # 2 m before the junction
WALK = 100.0  # where the crossing begins, 3 m wide; the ego's front is there at 7.2 s


def going(way: Road, s: ArrayLike, name: str = "ego", *, d: Floats | float | None = None, **more: object) -> Actor:
    return moving(name, way, T, s, way.own if d is None else d, **more)


def steady(s0: float, v: float = 8.0) -> Floats:
    way: Floats = s0 + v * T
    return way


def halting(front_m: float, until: float = 12.0) -> Floats:
    """Return the way of one that halts from 9.4 s with its front there, 2.4 m ahead of its centre, and goes on."""
    v = np.interp(T, (0, 6, 9.4, until, until + 3), (8, 8, 0, 0, 6))
    s = np.concatenate([[0.0], np.cumsum((v[1:] + v[:-1]) / 2 * np.diff(T))])
    way: Floats = s - s[100] + front_m - 2.4
    return way


def swung(way: Road, s: Floats, over: float) -> Floats:
    """Return offsets from the own lane's centre to so far over the line about the end of the junction, and back."""
    to = over * way.over
    return np.interp(s, (185, 203, 212, 235), (way.own, to, to, way.own))


def lit(*changes: tuple[float, str]) -> list[Row]:
    """Return the states of the light, recorded at every step."""
    begins = np.array([begin for begin, _ in changes])
    states = [changes[int(np.searchsorted(begins, t + 1e-6)) - 1][1] for t in T]
    return [{"signal_id": "sign", "t_ns": round(t * 1e9), "state": state} for t, state in zip(T, states, strict=True)]


def declared(event: str, *changes: tuple[float, str]) -> list[Row]:
    return [{"actor_id": "ego", "t_ns": round(t * 1e9), "event": event, "value": value} for t, value in changes]


def given(**conditions: str) -> list[Row]:
    return [{"condition": name, "value": value, "source": "env"} for name, value in conditions.items()]


def walker(y: float, x0: float, v: float = 1.4) -> Actor:
    """Somebody who walks west at this y, at x0 when the drive is ten seconds old."""
    still = np.zeros(T.shape)
    return Actor("walker", T, x0 - v * (T - 10), y + still, np.pi + still, still - v, still, 0.5, 0.5, "pedestrian")


def crossing(side: int, out_m: float, v: float = 1.4) -> Actor:
    """Somebody who walks over the crossing from the ego's side, so far from the middle of the road at 7.2 s."""
    still = np.zeros(T.shape)
    y = side * (out_m - v * (T - 7.2))
    x = WALK + 1.5 - R - ARM + still
    return Actor("walker", T, x, y, still - side * np.pi / 2, still, still - side * v, 0.5, 0.5, "pedestrian")


def ways(hand: str, code: str = "", walk: str = "", at: float = LINE) -> dict[str, Road]:
    """Return the ways through a crossroads, named as where the left is driven on: elsewhere north and south change.

    `code`: the sign one metre behind the stop line at `at`; `walk`: what the crossing is called.
    """
    side = 1 if hand == "lht" else -1
    signs = (("1", signal("sign", at + 1, code, t=6 * side)), ("1", stop_line("line", at, 1.75 * side)))
    found = cross(hand, signs if code else (), (("1", crosswalk("walk", WALK, said=walk)),) if walk else ())
    return {name.translate(str.maketrans("ns", "sn")) if side < 0 else name: way for name, way in found.items()}


def scenes(hand: str) -> dict[str, tuple[Callable[[str], Drive], tuple[str, ...]]]:
    """Return name -> (what makes the drive, the rules that it breaks); the ego comes from the west.

    Left and right are said as where the left is driven on; elsewhere all is mirrored.
    """
    free, stop, minor, light = ways(hand), ways(hand, "206"), ways(hand, "205"), ways(hand, "1000001")
    side = 1 if hand == "lht" else -1

    def scene(way: Road, *actors: Actor, **more: list[Row]) -> Callable[[str], Drive]:
        """`more`: rows of other tables of the trace."""

        def make(name: str) -> Drive:
            made = drive(actors, way.environment, drive_id=name)
            tables = made.trace.tables
            for table, rows in more.items():
                tables[table] = pa.Table.from_pylist([{"drive_id": name, **row} for row in rows], tables[table].schema)
            return made

        return make

    at = steady(120)
    straight, right, left = (going(free[way], at) for way in ("we", "ws", "wn"))
    cyclist = going(free["we"], steady(140, 5), "cyclist", d=3.0 * side, length=1.8, width=0.6, kind="bicycle")
    through, inside = going(light["we"], at), going(light["we"], halting(202))
    zebra, pelican = ways(hand, walk="zebra"), ways(hand, "1000001", "signalled", WALK - 2)
    over = going(zebra["we"], steady(40))
    motorway, night = given(road_type="motorway"), given(light="night")
    horn = declared("horn", (11, "on"), (11.5, "off"))
    hazards = going(free["we"], at, indicator=("hazard",) * len(T))
    backwards = going(free["we"], at).keep(T < 10)
    backwards = Actor("ego", backwards.t_s, backwards.x[::-1], backwards.y, backwards.yaw, -backwards.vx, backwards.vy)
    return {
        "straight": (scene(free["we"], straight), ()),
        "right": (scene(free["ws"], right), ()),
        "left": (scene(free["wn"], left), ()),
        "right with time": (scene(free["ws"], right, going(free["ew"], steady(100), "other")), ()),
        "right before somebody": (
            scene(free["ws"], right, going(free["ew"], steady(112), "other")),
            ("r180.right-turn-gap",),
        ),
        "right behind somebody": (scene(free["ws"], right, going(free["ew"], steady(140), "other")), ()),
        "corner cut": (scene(free["ws"], going(free["ws"], at, d=swung(free["ws"], at, 1.5))), ("r180.corner-cut",)),
        "left and wide": (scene(free["wn"], going(free["wn"], at, d=swung(free["wn"], at, 1.0))), ("r183.keep-in",)),
        "left across a cyclist": (
            scene(free["wn"], left, cyclist),
            ("h3.no-cut-across", "r182.no-pass-before-turn"),
        ),
        "left before a walker": (scene(free["wn"], left, walker(side * (R + 4), 1.8)), ("h2.turn-pedestrian",)),
        "left behind a walker": (scene(free["wn"], left, walker(side * (R + 4), -6.0)), ()),
        "stop sign, rolls": (scene(stop["we"], going(stop["we"], steady(120, 4))), ("r171.stop-sign",)),
        "stop sign, halts": (scene(stop["we"], going(stop["we"], halting(LINE - 1))), ()),
        "stop sign, halts too early": (scene(stop["we"], going(stop["we"], halting(LINE - 5))), ("r171.stop-sign",)),
        "stop sign, halts too late": (scene(stop["we"], going(stop["we"], halting(LINE + 1))), ("r171.stop-sign",)),
        "give way, nobody": (scene(minor["we"], going(minor["we"], at)), ()),
        "give way, before somebody": (
            scene(minor["we"], going(minor["we"], at), going(minor["sn"], steady(112), "other")),
            ("r172.give-way",),
        ),
        "green": (scene(light["we"], through, signal_state=lit((0, "green"))), ()),
        "red": (scene(light["we"], through, signal_state=lit((0, "amber"), (2, "red"))), ("r175.red",)),
        "red after the line": (
            scene(light["we"], through, signal_state=lit((0, "green"), (7, "amber"), (7.7, "red"))),
            (),
        ),
        "red and amber": (
            scene(light["we"], through, signal_state=lit((0, "red"), (7, "red_amber"), (8, "green"))),
            ("r175.red",),
        ),
        "amber, near": (scene(light["we"], through, signal_state=lit((0, "green"), (7, "amber"))), ()),
        "amber, far": (scene(light["we"], through, signal_state=lit((0, "green"), (4, "amber"))), ("r175.amber",)),
        "stands in the junction behind somebody": (
            scene(light["we"], inside, going(light["we"], halting(209), "other"), signal_state=lit((0, "green"))),
            ("r174.box", "r176.green-exit-clear"),
        ),
        "stands in a junction without lights behind somebody": (
            scene(minor["we"], inside, going(minor["we"], halting(209), "other")),
            ("r151.side-roads-clear", "r174.box"),
        ),
        "stands in the junction for long with its way out full 15 m ahead": (
            scene(
                light["we"],
                going(light["we"], halting(202, 21)),
                going(light["we"], halting(222, 21), "other"),
                signal_state=lit((0, "green")),
            ),
            ("r174.box", "r176.green-exit-clear"),
        ),
        "stands in a junction without lights for long with its way out full 15 m ahead": (
            scene(minor["we"], going(minor["we"], halting(202, 21)), going(minor["we"], halting(222, 21), "other")),
            ("r151.side-roads-clear", "r174.box"),
        ),
        "pauses in the junction with room to get out behind somebody": (
            scene(
                light["we"],
                going(light["we"], halting(202)),
                going(light["we"], halting(226), "other"),
                signal_state=lit((0, "green")),
            ),
            (),
        ),
        "stands in the junction": (scene(light["we"], inside, signal_state=lit((0, "green"))), ()),
        "waits to turn right behind somebody": (
            scene(
                light["ws"],
                going(light["ws"], halting(197)),
                going(light["ws"], halting(204), "other"),
                signal_state=lit((0, "green")),
            ),
            (),
        ),
        "zebra, nobody": (scene(zebra["we"], over), ()),
        "zebra, somebody on it": (scene(zebra["we"], over, crossing(side, 2.0)), ("r195.zebra-on",)),
        "zebra, somebody on the other half": (scene(zebra["we"], over, crossing(side, -1.0)), ()),
        "zebra, somebody far from it": (scene(zebra["we"], over, crossing(side, 9.0)), ()),
        "zebra, somebody waits": (scene(zebra["we"], over, crossing(side, 4.2, 0.0)), ("r195.zebra-waiting",)),
        "signalled crossing, green": (scene(pelican["we"], over, signal_state=lit((0, "green"))), ()),
        "signalled crossing, red": (
            scene(pelican["we"], over, signal_state=lit((0, "red"))),
            ("r175.red", "r196.pelican"),
        ),
        "signalled crossing, red after the line": (
            scene(pelican["we"], over, signal_state=lit((0, "green"), (6.6, "amber"), (7.1, "red"))),
            (),
        ),
        "signalled crossing, flashing, nobody": (scene(pelican["we"], over, signal_state=lit((0, "flashing"))), ()),
        "signalled crossing, flashing, somebody on it": (
            scene(pelican["we"], over, crossing(side, 2.0), signal_state=lit((0, "flashing"))),
            ("r196.pelican",),
        ),
        "signalled crossing, flashing, somebody who came from here": (
            scene(pelican["we"], over, crossing(side, -1.0), signal_state=lit((0, "flashing"))),
            (),
        ),
        "signalled crossing, flashing, somebody comes over": (
            scene(pelican["we"], over, crossing(side, -1.5, -1.4), signal_state=lit((0, "flashing"))),
            ("r196.pelican",),
        ),
        "signalled crossing, green, somebody on it": (
            scene(pelican["we"], over, crossing(side, 2.0), signal_state=lit((0, "green"))),
            ("r198.still-crossing",),
        ),
        "stands on the crossing behind somebody": (
            scene(
                zebra["we"],
                going(zebra["we"], halting(WALK + 4, 20)),
                going(zebra["we"], halting(WALK + 12, 20), "other"),
            ),
            ("r192.keep-clear",),
        ),
        "stands on the crossing for long behind somebody 12 m ahead": (
            scene(
                zebra["we"],
                going(zebra["we"], halting(WALK + 4, 20)),
                going(zebra["we"], halting(WALK + 20.8, 20), "other"),
            ),
            ("r191.no-stopping", "r192.keep-clear"),
        ),
        "stands on the crossing": (
            scene(zebra["we"], going(zebra["we"], halting(WALK + 4, 20))),
            ("r191.no-stopping",),
        ),
        "halts on the crossing": (scene(zebra["we"], going(zebra["we"], halting(WALK + 4))), ()),
        "stands before the crossing": (scene(zebra["we"], going(zebra["we"], halting(WALK - 1, 20))), ()),
        "motorway": (scene(free["we"], straight, drive_condition=motorway), ()),
        "stands on a motorway": (
            scene(free["we"], going(free["we"], halting(150, 20)), drive_condition=motorway),
            ("r240.no-stopping",),
        ),
        "stands on a motorway behind somebody": (
            scene(
                free["we"],
                going(free["we"], halting(150, 20)),
                going(free["we"], halting(157, 20), "other"),
                drive_condition=motorway,
            ),
            (),
        ),
        "backwards on a motorway": (
            scene(free["we"], backwards, drive_condition=motorway),
            ("r263.no-reverse",),
        ),
        "hazard lights": (
            scene(free["we"], hazards, drive_condition=given(carriageway="single")),
            ("r116.hazards",),
        ),
        "hazard lights on a motorway": (scene(free["we"], hazards, drive_condition=motorway), ()),
        "night, lights off": (
            scene(free["we"], straight, drive_condition=night, declared_event=declared("headlights", (0, "off"))),
            ("r115.dipped-headlights",),
        ),
        "night, lights off on a motorway": (
            scene(
                free["we"],
                straight,
                drive_condition=night + motorway,
                declared_event=declared("headlights", (0, "off")),
            ),
            ("r113.headlights",),
        ),
        "night, lights on": (
            scene(free["we"], straight, drive_condition=night, declared_event=declared("headlights", (0, "on"))),
            (),
        ),
        "horn, standing": (
            scene(free["we"], going(free["we"], halting(150, 20)), declared_event=horn),
            ("r112.horn",),
        ),
        "horn, moving": (scene(free["we"], straight, declared_event=horn), ()),
    }
