"""Cyclists, walkers and horses that are passed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tests.outsiders.twentieth.drive import Drive, Expect
from tests.outsiders.twentieth.motion import Actor
from tests.outsiders.twentieth.sites import rural


def passing(  # noqa: PLR0917
    name: str, near: int, kind: str, v: float, gap: float, expect: Sequence[Expect], **kw: Any
) -> Drive:
    """The ego passes somebody slow at the near edge with a gap."""
    town = bool(kw.get("town", False))
    limit = (30.0 if near > 0 else 50.0) if town else (60.0 if near > 0 else 100.0)
    p = rural(near, kind="town" if town else "rural", mph=limit, parts=[(200, 0.0), (300, 0.002), (200, 0.0)])
    slow = float(kw.get("slow", 4.0))
    width = {"bicycle": 0.6, "animal": 0.7, "pedestrian": 0.5}[kind]
    u = 1.2
    out = u - width / 2 - gap - 0.9
    meet = 60 + 120 / (v - slow) * v
    size = kw.get("size")
    other = Actor("slow", kind, p.lane(1), 180, slow, lat=[(0, u)], size=size, noise=float(kw.get("noise", 0.0)))
    lat = [(meet - 90, 0.0), (meet - 30, out), (meet + 25, out), (meet + 70, 0.0)]
    a = Actor("ego", "car", p.lane(1), 60, v, (), lat)
    return Drive(
        name, str(kw["what"]), p.map, [a, other], list(expect), 120 / (v - slow) + 8, nation="gb" if near > 0 else "de"
    )


def cyclists() -> list[Drive]:
    """Cyclists."""
    bike, s5, _horse = "ukhc.r163.cyclist", "stvo.s5-passing", "ukhc.r215.horse"
    return [
        passing(
            "bike_close",
            1,
            "bicycle",
            10.0,
            1.25,
            [(bike, "fail", "1.25 m")],
            what="GB: 1.25 m beside a cyclist",
            town=True,
        ),
        passing(
            "bike_fast",
            1,
            "bicycle",
            17.0,
            1.75,
            [(bike, "fail", "1.75 m at 17 m/s, 2 m asked for")],
            what="GB: 1.75 m at 38 mph",
        ),
        passing(
            "bike_open_de",
            -1,
            "bicycle",
            16.0,
            1.75,
            [(s5, "fail", "1.75 m outside towns")],
            what="DE: 1.75 m outside a town",
        ),
        passing(
            "bike_town_de",
            -1,
            "bicycle",
            11.0,
            1.65,
            [(s5, "pass", "1.65 m in a town")],
            what="DE: 1.65 m in a town",
            town=True,
        ),
    ]


def walkers() -> list[Drive]:
    """Walkers and horses."""
    _bike, s5, horse = "ukhc.r163.cyclist", "stvo.s5-passing", "ukhc.r215.horse"
    return [
        passing(
            "walk_de",
            -1,
            "pedestrian",
            10.0,
            1.2,
            [(s5, "fail", "1.2 m beside somebody walking the same way")],
            what="DE: 1.2 m beside a walker",
            town=True,
            slow=1.3,
        ),
        passing(
            "horse_fast",
            1,
            "animal",
            7.0,
            2.5,
            [(horse, "fail", "7 m/s, over 10 mph")],
            what="2.5 m beside a horse at 7 m/s",
            slow=1.6,
        ),
        passing(
            "horse_kept",
            1,
            "animal",
            4.2,
            2.3,
            [(horse, "pass", "4.2 m/s, 2.3 m")],
            what="2.3 m beside a horse at 4.2 m/s",
            slow=1.0,
        ),
    ]


def drives() -> list[Drive]:
    """All of them."""
    return [*cyclists(), *walkers()]
