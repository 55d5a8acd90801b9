"""Motorways."""

from __future__ import annotations

from typing import Any

from tests.outsiders.twentieth.drive import Drive, Expect
from tests.outsiders.twentieth.motion import Actor, Move
from tests.outsiders.twentieth.roads import Lane
from tests.outsiders.twentieth.sites import Straight, straight


def motorway(near: int, **kw: Any) -> Straight:
    """Three lanes one way with a hard shoulder; lane 1 is the innermost, the fast one."""
    mph = kw.pop("mph", 70.0 if near > 0 else 120.0)
    kw.setdefault("own", 3)
    kw.setdefault("edge", [Lane("shoulder", 3.0, "none")])
    return straight(near, 1800.0, "motorway", mph, opp=0, width=3.6, **kw)


def lorry_lane_3() -> Drive:
    """A lorry in the fast lane."""
    p = motorway(1)
    a = Actor(
        "ego",
        "truck",
        p.lane(2),
        60,
        24.0,
        (),
        [(160, 0.0), (280, -3.6), (520, -3.6), (640, 0.0)],
        lamp=[(2, 9, "far")],
    )
    return Drive(
        "lorry_lane_3",
        "lorry over 7.5 t overtakes in the third lane",
        p.map,
        [a, Actor("car", "car", p.lane(2), 240, 18.0)],
        [
            ("ukhc.r265.right-lane-ban", "fail", "in the third of three lanes"),
            ("ukhc.r124.speed-limit", "pass", "24 m/s, 60 mph is 26.8"),
        ],
        26,
        env={"vehicle_class": "goods_over_7t5"},
    )


def shoulder() -> Drive:
    """Past a queue on the hard shoulder, and a halt and reverse there."""
    p = motorway(1)
    a = Actor("ego", "car", p.lane(3), 60, 18.0, (), [(120, 0.0), (190, 3.3), (420, 3.3), (480, 0.0)])
    q = [Actor(f"q{i}", "car", p.lane(3), 230 + 14 * i, 3.0, (), lamp=None) for i in range(5)]
    return Drive(
        "shoulder",
        "past a queue along the hard shoulder",
        p.map,
        [a, *q],
        [("ukhc.r269.hard-shoulder", "fail", "14 s along the hard shoulder without an emergency")],
        24,
    )


def stops(near: int) -> Drive:
    """Stands in its lane for 9 s and backs."""
    p = motorway(near)
    moves: list[Move] = [("stop", 300, 3.0), ("hold", 9.0), ("v", -2.0, 1.0), ("hold", 5), ("v", 0.0, 1.0)]
    a = Actor("ego", "car", p.lane(3), 150, 22.0, moves)
    want: list[Expect] = [
        ("ukhc.r263.no-reverse", "fail", "backs at 2 m/s"),
        ("ukhc.r240.no-stopping", "fail", "stands 9 s"),
        ("ukhc.r143.direction", "fail", "backs on a motorway"),
    ]
    if near < 0:
        want = [
            ("stvo.ri1", "fail", "stands with nobody ahead"),
            ("stvo.ri3", "fail", "backs at 2 m/s"),
            ("stvo.rg2", "fail", "3 m/s2 for nothing"),
            ("ukhc.r263.no-reverse", "fail", "backs"),
        ]
    return Drive(
        f"motorway_stop_{'gb' if near > 0 else 'de'}",
        "stands 9 s in its lane for nothing, then backs",
        p.map,
        [a],
        want,
        32,
        nation="gb" if near > 0 else "de",
    )


def leaving(good: bool) -> Drive:
    """Leaves by an exit lane; the signal on in time, or after the sign."""
    p = straight(1, 1000.0, "motorway", 70.0, own=2, opp=0, width=3.6, edge=[Lane("exit", 3.6, "solid")])
    p.road.sign("exit1", 330.0, 12.0, True, type="333", country="DE")
    a = Actor(
        "ego", "car", p.lane(2), 60, 25.0, (), [(360, 0.0), (460, 3.6)], lamp=[(6.0 if good else 12.5, 30, "near")]
    )
    return Drive(
        f"exit_{'signal' if good else 'late'}",
        "leaves by the exit lane" + ("" if good else ", its signal comes on after the sign"),
        p.map,
        [a],
        [("ukhc.exit-sign-signal", "pass" if good else "fail", "front passes the sign at 10.7 s")],
        26,
    )


def change(name: str, lead_s: float, gap: float, expect: list[Expect], **kw: Any) -> Drive:
    """Changes to the far side before a faster car."""
    p = motorway(-1, start=(10.0, 10.0, 2.0))
    span = kw.get("span", 110.0)
    start = 260.0
    lat = [(start, 0.0), (start + span, -3.6)]
    t = (start - 60) / 25
    mover = Actor("ego", "car", p.lane(3), 60, 25.0, (), lat, lamp=[(t + kw.get("after", 0.0) - lead_s, t + 6, "far")])
    v = kw.get("v", 33.0)
    back = Actor("behind", "car", p.lane(2), 60 + 25 * t - 4.5 - gap - v * t, v, [("hold", t), ("v", 25.0, 4.0)])
    return Drive(
        name,
        "changes to the left lane before a faster car",
        p.map,
        [mover, back],
        expect,
        8 + span / 25 + 6,
        nation="de",
        env={"engaged": "yes"},
    )


def undertake() -> Drive:
    """Passes on the right, too fast for a lorry-free road with a limit."""
    p = motorway(-1, mph=100.0)
    other = Actor("left", "car", p.lane(2), 200, 24.0)
    return Drive(
        "undertake",
        "passes on the right at 30 m/s where 100 km/h is the limit",
        p.map,
        [Actor("ego", "car", p.lane(3), 100, 30.0), other],
        [("stvo.ri2", "fail", "past a car in the lane to its left at 24 m/s"), ("stvo.rg3", "fail", "108 km/h at 100")],
        28,
        nation="de",
    )


def lorry_gap(gap: float, want: str) -> Drive:
    """A lorry behind another."""
    p = motorway(-1)
    lead = Actor("lead", "truck", p.lane(3), 60 + 12 + gap, 22.0)
    return Drive(
        f"lorry_gap_{gap:g}",
        f"lorry {gap:g} m behind a lorry at 22 m/s",
        p.map,
        [Actor("ego", "truck", p.lane(3), 60, 22.0), lead],
        [("stvo.s4-truck", want, f"{gap:g} m"), ("stvo.rg1", "pass", f"{gap:g} m are enough at equal speeds")],
        20,
        nation="de",
        env={"vehicle_class": "goods_over_7t5"},
    )


def slow() -> Drive:
    """Slow for nothing."""
    p = motorway(-1)
    return Drive(
        "slow_motorway",
        "15 m/s for 30 s, long astride a line, on an empty motorway of 120 km/h",
        p.map,
        [Actor("ego", "car", p.lane(3), 60, 15.0, (), [(120, 0.0), (150, -1.8), (420, -1.8), (450, 0.0)])],
        [
            ("stvo.rg4", "fail", "18.3 m/s below the limit, nobody there"),
            ("ukhc.r131.keep-in-lane", "fail", "19 s astride the line between two lanes"),
        ],
        30,
        nation="de",
    )


def minimal_risk() -> Drive:
    """A minimal risk manoeuvre that brakes too hard, without hazard lights."""
    p = motorway(-1)
    moves: list[Move] = [("hold", 5), ("v", 6.0, 4.8), ("v", 0.0, 2.0)]
    return Drive(
        "mrm_hard",
        "minimal risk manoeuvre: 4.8 m/s2 for 4 s, no hazard lights",
        p.map,
        [Actor("ego", "car", p.lane(3), 60, 25.0, moves, lamp=())],
        [("alks-r157.mrm", "fail", "4.8 m/s2 for 4 s"), ("alks-r157.mrm-hazards", "fail", "no hazard lights")],
        20,
        nation="de",
        env={"engaged": "yes"},
        says=[(0.0, "minimal_risk_manoeuvre", "off"), (4.9, "minimal_risk_manoeuvre", "on"), (0.0, "engaged", "on")],
    )


def cut_in() -> Drive:
    """Somebody cuts in at town speed; the gap is never made again."""
    p = motorway(-1, mph=60.0)
    other = Actor(
        "cutter", "car", p.lane(3), 66, 15.0, [("hold", 6), ("v", 14.0, 1.0)], [(60, -3.6), (110, -3.6), (150, 0.0)]
    )
    return Drive(
        "cut_in_kept_close",
        "a car cuts in; the ego stays about 6 m behind it at 14 m/s",
        p.map,
        [Actor("ego", "car", p.lane(3), 60, 14.0), other],
        [
            ("alks-r157.cut-in-gap", "fail", "far under the table's 20 m or so, 20 s later"),
            ("alks-r157.follow-gap", "fail", "beyond the 10 s to restore"),
        ],
        32,
        nation="de",
        env={"engaged": "yes"},
    )


def drives() -> list[Drive]:
    """All of them."""
    return [
        lorry_lane_3(),
        shoulder(),
        stops(1),
        stops(-1),
        leaving(False),
        change(
            "change_close",
            4.0,
            9.0,
            [
                ("stvo.rg6", "fail", "9 m before a car that is 8 m/s faster"),
                ("alks-r157.r79.lane-change-done", "pass", "over the line for less than 5 s"),
                ("alks-r157.r79.lane-change", "pass", "signal on 4 s before the line"),
            ],
            after=1.6,
        ),
        change(
            "change_slow",
            1.5,
            90.0,
            [
                ("alks-r157.r79.lane-change", "fail", "signal on under 3 s before the line"),
                ("alks-r157.r79.lane-change-done", "fail", "5.6 s on the line"),
                ("stvo.rg6", "pass", "90 m"),
            ],
            span=500.0,
            after=7.2,
            v=25.5,
        ),
        undertake(),
        lorry_gap(42.0, "fail"),
        slow(),
        minimal_risk(),
        cut_in(),
    ]
