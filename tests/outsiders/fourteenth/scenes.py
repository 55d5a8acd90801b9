"""What many drives have in common: following, driving alone, overtaking, changing lane, turning."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from tests.outsiders.fourteenth.drive import OFF, SIZES, Actor, Drive, Events, Lamps, Size, Wanted, car
from tests.outsiders.fourteenth.lines import Course, Fn, Motion, go, side
from tests.outsiders.fourteenth.places import FAST, MID, ON, OPP, OWN, SLOW, Cross, Place, motorway

Points = tuple[tuple[float, float], ...]


def on(course: Course, s: Fn, u: float | Fn, *, back: bool = False, turned: float | None = None) -> Motion:
    """Along a course at a fixed place across it, or one that changes; speeds hold at that place."""
    place = side((0.0, u)) if isinstance(u, float) else u
    if len(course.parts) > 1:
        s = course.offset(s, float(place(np.zeros(1))[0]))
    return Motion(course, s, place, back=back, turned=turned)


def behind(  # noqa: PLR0917
    name: str,
    what: str,
    place: Place,
    ego: Points,
    other: Points,
    gap: float,
    wanted: Wanted,
    *,
    kind: str | None = "car",
    seconds: float = 20.0,
    u: float | Fn = MID,
    other_u: float | Fn | None = None,
    env: Mapping[str, str] | None = None,
    size: Size | None = None,
    ego_kind: str = "car",
    hz: float = 10.0,
    noise: float = 0.0,
    lost: tuple[float, float] = (0.0, 0.0),
    more: Sequence[Actor] = (),
) -> Drive:
    """The ego behind another vehicle: `gap` at the beginning, from front to rear."""
    me = car(on(place.course, go(100.0, *ego), u), kind=ego_kind)
    start = 100.0 + gap + (SIZES[ego_kind][0] + (size or SIZES[kind])[0]) / 2
    motion = on(place.course, go(start, *other), u if other_u is None else other_u)
    lead = Actor("lead", kind, motion, size=size, lost=lost)
    return Drive(name, what, place, me, [lead, *more], seconds, wanted, hz=hz, env=env or {}, noise=noise)


def alone(
    name: str,
    what: str,
    place: Place,
    ego: Points,
    wanted: Wanted,
    *,
    u: float | Fn = SLOW,
    kind: str = "car",
    seconds: float = 20.0,
    env: Mapping[str, str] | None = None,
    lamp: Lamps = OFF,
    others: Sequence[Actor] = (),
    s0: float = 100.0,
    hz: float = 10.0,
    turned: float | None = None,
    back: bool = False,
    events: Events = (),
    soft: float = 1.0,
    lights: Mapping[str, Lamps] | None = None,
) -> Drive:
    """The ego along a road at `u`, with or without others."""
    me = car(on(place.course, go(s0, *ego, back=back, soft=soft), u, turned=turned, back=back), kind=kind, lamp=lamp)
    return Drive(
        name, what, place, me, others, seconds, wanted, hz=hz, env=env or {}, events=events, lights=lights or {}
    )


def comes_in(  # noqa: PLR0917
    name: str,
    what: str,
    ego: Points,
    other: Points,
    gap: float,
    wanted: Wanted,
    *,
    nation: str = "de",
    gone: float | None = None,
    seconds: float = 26.0,
    env: Mapping[str, str] | None = None,
    hz: float = 10.0,
    start: float = 4.0,
) -> Drive:
    """A car from the lane beside comes in ahead until 7 s, and may go again."""
    place = motorway(nation, at=(300, 300, 1.9))
    points = [(0.0, SLOW), (start, SLOW), (7.0, MID)]
    if gone is not None:
        points += [(gone, MID), (gone + 3.0, FAST)]
    env = ON if env is None else env
    return behind(name, what, place, ego, other, gap, wanted, other_u=side(*points), env=env, seconds=seconds, hz=hz)


def brakes(name: str, what: str, hard: float, wanted: Wanted, *, events: Events = (), lamp: Lamps = OFF) -> Drive:
    """Alone on the motorway the ego brakes from 25 to 5 m/s from 6 s on."""
    place = motorway("gb", at=(-40, 10, -2.0))
    end = 6.0 + 20.0 / hard
    way = go(100.0, (0, 25.0), (6, 25.0), (end, 5.0), (end + 4, 5.0), (end + 9, 12.0), soft=0.3)
    return Drive(
        name, what, place, car(on(place.course, way, MID), lamp=lamp), [], end + 9, wanted, env=ON, events=events
    )


def over(points: Points, level: float, half: float) -> float:
    """When the near edge of a box of half width `half` first reaches over `level`."""
    t = np.arange(0.0, 60.0, 0.01)
    sign = 1.0 if points[0][1] > level else -1.0
    return float(t[np.flatnonzero(sign * (side(*points)(t) - level) < half)[0]])


def changes(
    name: str,
    what: str,
    wanted: Wanted,
    lead_s: float | None,
    *,
    points: Points = ((8.0, SLOW), (13.0, MID)),
    wrong: bool = False,
    stop_s: float = -3.0,
    nation: str = "de",
    hz: float = 10.0,
) -> Drive:
    """A lane change by the system, its indicator on `lead_s` before the line and off `stop_s` before it."""
    place = motorway(nation, at=(77, -600, 0.3))
    near, far = ("left", "right") if nation.startswith("gb") else ("right", "left")
    to = far if (points[-1][1] < points[0][1]) != wrong else near
    at = over(points, 8.7, 0.9)
    lamp = OFF if lead_s is None else ((0.0, "off"), (at - lead_s, to), (at - stop_s, "off"))
    me = car(on(place.course, go(100.0, (0, 25)), side(*points)), lamp=lamp)
    return Drive(name, what, place, me, [], 26.0, wanted, hz=hz, env=ON)


def others_in_right(n: int, s0: float, step: float, v: float, u: float, place: Place) -> list[Actor]:  # noqa: PLR0917
    """A row of cars of the same speed."""
    return [Actor(f"q{i}", "car", on(place.course, go(s0 + i * step, (0, v)), u)) for i in range(n)]


def pass_by(
    name: str,
    place: Place,
    what: str,
    wanted: Wanted,
    *,
    v: float = 22.0,
    slow: float = 13.0,
    out_t: float = 4.0,
    back_t: float = 13.0,
    gap: float = 30.0,
    oncoming: float | None = None,
    v_on: float = 22.0,
    seconds: float = 20.0,
    more: Sequence[Actor] = (),
    events: Events = (),
) -> Drive:
    """The ego comes up behind a slow car, pulls out at `out_t` and is back 2.5 s after `back_t`."""
    far, near = ("right", "left") if place.course.near > 0 else ("left", "right")
    u = side((0.0, OWN), (out_t, OWN), (out_t + 2.5, OPP), (back_t, OPP), (back_t + 2.5, OWN))
    lamp = ((0.0, "off"), (out_t - 2.5, far), (out_t + 2.5, "off"), (back_t - 1.0, near), (back_t + 2.5, "off"))
    me = car(on(place.course, go(100.0, (0, v)), u), lamp=lamp)
    start = 100 + (v - slow) * (out_t + 1.0) + gap + 4.5
    others = [Actor("slow", "car", on(place.course, go(start, (0, slow)), OWN)), *more]
    if oncoming is not None:
        others.append(Actor("oncoming", "car", on(place.course, go(oncoming, (0, v_on), back=True), OPP, back=True)))
    return Drive(name, what, place, me, others, seconds, wanted, events=events)


def out_to(u: float) -> Fn:
    """Out of the middle of the lane and back again, there from 5.5 to 11.5 s."""
    return side((0.0, OWN), (3.0, OWN), (5.5, u), (11.5, u), (14.0, OWN))


def turn(  # noqa: PLR0917
    name: str,
    what: str,
    place: Cross,
    to: str,
    ego: Points,
    wanted: Wanted,
    *,
    u: float | Fn = OWN,
    others: Sequence[Actor] = (),
    seconds: float = 20.0,
    kind: str = "car",
    hz: float = 10.0,
    lights: Mapping[str, Lamps] | None = None,
) -> Drive:
    """The ego comes from the south, 40 m along its arm, and goes out at `to`."""
    course = place.way("S", to)
    side_on: dict[str, Lamps] = {"E": ((1.0, "right"),), "W": ((1.0, "left"),), "N": ()}
    me = car(on(course, go(40.0, *ego), u), kind=kind, lamp=((0.0, "off"), *side_on[to]))
    return Drive(name, what, place, me, others, seconds, wanted, hz=hz, lights=lights or {})


def at_lights(  # noqa: PLR0917
    name: str,
    what: str,
    place: Place,
    ego: Points,
    wanted: Wanted,
    lights: Mapping[str, Lamps],
    others: Sequence[Actor],
) -> Drive:
    """Alone along a street with lights."""
    return alone(name, what, place, ego, wanted, u=OWN, others=others, lights=lights)
