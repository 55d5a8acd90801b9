"""Overtakes, the ego's and others'."""

from __future__ import annotations

from tests.outsiders.twentieth.drive import Drive, Expect
from tests.outsiders.twentieth.motion import Actor
from tests.outsiders.twentieth.sites import rural


def overtake(name: str, on_s: float | None, good: bool) -> Drive:
    """An overtake of a car at 15 m/s, with declarations."""
    p = rural(1, 1600.0)
    p.road.sign("no_over", 20.0 if not good else 1500.0, 5.0, True, type="632", country="GB")
    slow = Actor("slow", "car", p.lane(1), 170, 15.0)
    lat = [(170.0, 0.0), (240.0, -3.5), (430.0, -3.5), (490.0, 0.0)]
    a = Actor("ego", "car", p.lane(1), 60, 24.0, (), lat, lamp=[(2, 8, "far"), (14, 18, "near")])
    others = [slow]
    if on_s is not None:
        others.append(Actor("on", "car", p.lane(1, -1), 1600 - on_s, 22.0, [("hold", 9.0), ("v", 6.0, 4.0)]))
    says: list[tuple[float, str, str | None]] = [
        (1.0, "mirror_check", None),
        (3.0, "confidence", "0.95" if good else "0.6"),
    ]
    says += [(3.2, "blind_spot_check", "right"), (3.5, "overtake_go" if good else "overtake_no_go", None)]
    if good:
        want: list[Expect] = [
            ("ukhc.r165.no-overtaking-sign", "not fail", "the sign stands 1 km further on"),
            ("declared.r162.go-before-overtaking", "pass", "go"),
            ("declared.r163.checks-before-pull-out", "pass", "mirrors, blind spot"),
            ("ukhc.r162.safe-distance-ahead", "not fail", "nobody oncoming"),
        ]
    else:
        want = [
            ("ukhc.r162.safe-distance-ahead", "fail", "an oncoming car too near for the manoeuvre"),
            ("rss.opposite", "fail", "both in one lane, under 50 m apart at 46 m/s closing"),
            ("ukhc.r165.no-overtaking-sign", "fail", "sign passed 40 m before the start"),
            ("declared.r162.go-before-overtaking", "fail", "last decision: no go"),
            ("declared.r166.confidence-at-commit", "fail", "0.6 < 0.9"),
            ("ukhc.r126.ds-disjoint", "fail", "neither could stop"),
        ]
    return Drive(
        name,
        "overtakes in sight of an oncoming car" if on_s else "overtakes on a free road",
        p.map,
        [a, *others],
        want,
        24,
        says=says,
    )


def overtaken_speeds() -> Drive:
    """Speeds up while it is overtaken."""
    p = rural(1, 1200.0)
    quick = Actor(
        "quick",
        "car",
        p.lane(1),
        20,
        26.0,
        (),
        [(100, 0.0), (160, -3.5), (620, -3.5), (700, 0.0)],
        lamp=[(1, 6, "far")],
    )
    return Drive(
        "overtaken_speeds",
        "speeds up by 4 m/s while it is overtaken",
        p.map,
        [Actor("ego", "car", p.lane(1), 150, 17.0, [("hold", 11), ("v", 21.0, 1.0)]), quick],
        [("ukhc.r168.when-overtaken", "fail", "accelerates with 1 m/s2 while the other is beside it")],
        28,
    )


def pulls_out_before() -> Drive:
    """Pulls out before one who overtakes already."""
    q = rural(1, 1200.0)
    behind = Actor(
        "behind",
        "car",
        q.lane(1),
        45,
        27.0,
        [("hold", 6), ("v", 20.0, 3.5)],
        [(60, 0.0), (120, -3.5), (500, -3.5)],
        lamp=[(0, 20, "far")],
    )
    slow = Actor("slow", "truck", q.lane(1), 240, 13.0)
    me = Actor(
        "ego",
        "car",
        q.lane(1),
        130,
        17.0,
        [("hold", 5), ("v", 24, 1.5)],
        [(196, 0.0), (245, -3.5), (560, -3.5)],
        lamp=[(2, 9, "far")],
    )
    return Drive(
        "pulls_out_before",
        "pulls out to overtake before a faster car already in the passing lane",
        q.map,
        [me, behind, slow],
        [("ukhc.r162.not-being-overtaken", "fail", "the car behind closes 10 m/s from under 40 m")],
        13,
    )


def no_drop_back() -> Drive:
    """Stays close behind one who moved in."""
    r = rural(1, 1200.0)
    cutter = Actor(
        "cutter", "car", r.lane(1), 60, 24.0, [("to_s", 310), ("v", 20.0, 1.0)], [(70, -3.5), (250, -3.5), (310, 0.0)]
    )
    return Drive(
        "no_drop_back",
        "a car moves in ahead; the ego stays 14 m behind it at 20 m/s",
        r.map,
        [Actor("ego", "car", r.lane(1), 90, 20.0), cutter],
        [
            ("ukhc.r168.drop-back", "fail", "gap under 1 s 20 s later"),
            ("criticality.thw", "fail", "under 0.9 s for long"),
        ],
        34,
    )


def drives() -> list[Drive]:
    """All of them."""
    return [
        overtake("overtake_bad", 760.0, False),
        overtake("overtake_good", None, True),
        overtaken_speeds(),
        pulls_out_before(),
        no_drop_back(),
    ]
