"""Things that stand in the way, and middle lines."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tests.outsiders.twentieth.drive import Drive, Expect
from tests.outsiders.twentieth.motion import Actor, Move
from tests.outsiders.twentieth.sites import rural, straight

GIVE = "ukhc.r163.obstruction-give-way"
SOLID = "ukhc.r129.no-cross-solid"


def round_parked(
    name: str, oncoming: Sequence[Move] | None, s_on: float, v_on: float, expect: Sequence[Expect], **kw: Any
) -> Drive:
    """A van stands half in the ego's lane; the ego goes round it."""
    p = rural(kind="town", mph=30.0, middle=str(kw.get("middle", "broken")))
    van = Actor("van", "van", p.lane(1), 200, 0.0, lat=[(0, 0.35)], lamp=None)
    moves: list[Move] = list(kw.get("moves", ()))
    lat = [(165.0, 0.0), (187.0, -2.7), (207.0, -2.7), (230.0, 0.0)]
    a = Actor("ego", "car", p.lane(1), 90, 8.0, moves, lat, lamp=[(6, 12, "far"), (15, 18, "near")])
    others = [van]
    if oncoming is not None:
        others.append(Actor("on", "car", p.lane(1, -1), s_on, v_on, oncoming))
    return Drive(name, str(kw["what"]), p.map, [a, *others], list(expect), float(kw.get("last", 26)))


def parked() -> list[Drive]:
    """Standing vans, oncoming cars."""
    wait: list[Move] = [("stop", 172, 1.5), ("hold", 7.0), ("v", 8.0, 1.5)]
    return [
        round_parked(
            "parked_close",
            [],
            700 - 223 - 12 * 17.0,
            12.0,
            [(GIVE, "fail", "back in its lane less than 2 s before the oncoming car")],
            what="goes round a parked van close before an oncoming car",
        ),
        round_parked(
            "parked_waits",
            [],
            700 - 200 - 12 * 15,
            12.0,
            [
                (GIVE, "not fail", "waited until the oncoming car was by"),
                ("ukhc.r143.direction", "not fail", "round a parked van"),
            ],
            what="waits for the oncoming car, then goes round",
            moves=wait,
            last=40,
        ),
        round_parked(
            "parked_made_wait",
            [("stop", 466, 2.5), ("hold", 7.0), ("v", 10.0, 1.5)],
            350,
            10.0,
            [(GIVE, "fail", "the oncoming car had to stop for the ego")],
            what="the oncoming car stops 20 m before and waits for the ego",
        ),
        round_parked(
            "solid_parked",
            None,
            0,
            0,
            [(SOLID, "not fail", "passes a parked van"), (GIVE, "not fail", "nobody oncoming")],
            what="solid middle line; round a parked van",
            middle="solid",
        ),
    ]


def over_line(  # noqa: PLR0917
    name: str, near: int, middle: str, kind: str, v: float, expect: Sequence[Expect], **kw: Any
) -> Drive:
    """The ego passes somebody slow over the middle line."""
    p = rural(near, middle=middle, start=(300.0, -40.0, 0.6))
    u = 0.9 if kind in ("bicycle", "animal") else 0.0
    out = float(kw.get("out", -2.6))
    other = Actor("slow", kind, p.lane(1), 150, v, lat=[(0, u)])
    rel = float(kw.get("v0", 14.0)) - v
    meet = 60 + (90 / rel) * (rel + v)
    lat = [(meet - 75, 0.0), (meet - 35, out), (meet + 28, out), (meet + 60, 0.0)]
    a = Actor("ego", "car", p.lane(1), 60, rel + v, (), lat, lamp=[(1, 8, "far")])
    return Drive(
        name, str(kw["what"]), p.map, [a, other], list(expect), 90 / rel + 9, nation="gb" if near > 0 else "de"
    )


def lines() -> list[Drive]:
    """Solid middle lines."""
    return [
        over_line(
            "solid_bike_slow",
            1,
            "solid",
            "bicycle",
            4.0,
            [(SOLID, "not fail", "a cyclist at 4.0 m/s, under 10 mph")],
            what="solid line, past a cyclist at 4 m/s",
        ),
        over_line(
            "solid_bike_fast",
            1,
            "solid",
            "bicycle",
            6.0,
            [(SOLID, "fail", "a cyclist at 6 m/s, over 10 mph")],
            what="solid line, past a cyclist at 6 m/s",
        ),
        over_line(
            "solid_near_de",
            -1,
            "broken solid",
            "car",
            6.0,
            [(SOLID, "fail", "the line on the ego's side is solid")],
            what="DE: broken and solid, the ego's own side solid",
            out=-3.5,
        ),
        over_line(
            "solid_other",
            1,
            "broken solid",
            "car",
            6.0,
            [(SOLID, "not fail", "the line on the ego's side is broken")],
            what="GB: broken on the ego's side, solid on the other",
            out=-3.5,
        ),
    ]


def back_late(name: str, solid_at: float, want: str) -> Drive:
    """An overtake over a line that turns solid."""
    p = straight(1, 900.0, "rural", 60.0, middle=[(0.0, "broken solid"), (solid_at, "solid")], version=6)
    slow = Actor("slow", "truck", p.lane(1), 190, 10.0)
    lat = [(140.0, 0.0), (190.0, -3.5), (370.0, -3.5), (420.0, 0.0)]
    a = Actor("ego", "car", p.lane(1), 60, 22.0, (), lat, lamp=[(1, 6, "far"), (12, 16, "near")])
    return Drive(
        name,
        f"overtakes; the line on its side turns solid at {solid_at:g} m",
        p.map,
        [a, slow],
        [("ukhc.r128.back-before-solid", want, "wholly back in its lane at about 400 m")],
        24,
    )


def drives() -> list[Drive]:
    """All of them."""
    return [*parked(), *lines(), back_late("back_late", 340.0, "fail"), back_late("back_in_time", 560.0, "not fail")]
