"""Drives on motorways."""

from __future__ import annotations

from typing import Any

from tests.outsiders.eighteenth.drive import Drive, Expect
from tests.outsiders.eighteenth.motion import Track, trailer
from tests.outsiders.eighteenth.roads import Frame, Map, Path, motorway

CAR = (4.6, 1.85)
TRUCK = (12.0, 2.5)
LINE = Path(0, 0, 0, ((3000.0, 0.0),))
FAST, MIDDLE, SLOW, SHOULDER = 1.875, 5.625, 9.375, 12.75


def ego(
    v: float,
    o: float = SLOW,
    s: float = 100.0,
    *,
    g: int = -1,
    kind: str = "car",
    size: tuple[float, float] = CAR,
    **more: Any,
) -> Track:
    return Track("ego", kind, size, LINE, s, v, o, g, **more)


def other(
    me: Track,
    gap: float,
    v: float,
    o: float | None = None,
    name: str = "a",
    *,
    kind: str | None = "car",
    size: tuple[float, float] = CAR,
    **more: Any,
) -> Track:
    """Somebody with his rear so far before the ego's front; or behind it where gap is negative."""
    half = (me.size[0] + size[0]) / 2
    s = me.s + gap + half if gap >= 0 else me.s + gap - half
    return Track(name, kind, size, LINE, s, v, me.o if o is None else o, me.g, **more)


def made(
    name: str, tracks: list[Track], seconds: float, expect: list[Expect], road: Map | None = None, **more: Any
) -> Drive:
    return Drive(name, road or motorway(more.get("nation", "de")[:2]), tracks, seconds, expect, **more)


def following() -> list[Drive]:
    found: list[Drive] = []
    for name, gap, verdict in (("rg1_8m", 8.0, "fail"), ("rg1_14m", 14.0, "pass")):
        me = ego(30.0)
        found.append(
            made(
                name,
                [me, other(me, gap, 30.0)],
                14,
                [
                    ("stvo.rg1", verdict, f"{gap} m, safe is 11.1 m at 30 m/s each"),
                    ("criticality.thw", "fail", f"{gap / 30:.2f} s"),
                    ("criticality.ttc", "not fail", "same speed"),
                ],
            )
        )
    # The gap is too small to the motorcycle, not to the lorry before it; low rate, turned map
    me = ego(33.0, MIDDLE)
    bike = other(me, 7.0, 33.0, kind="motorcycle", size=(2.2, 0.8), o=MIDDLE + 1.1)
    found.append(
        made(
            "rg1_motorcycle",
            [me, bike, other(me, 70.0, 33.0, name="b", kind="truck", size=TRUCK)],
            20,
            [
                ("stvo.rg1", "fail", "7 m behind a motorcycle at 33 m/s; needed 9.9 + 54.45 - 51.86 = 12.5 m"),
                ("criticality.thw", "fail", "0.21 s"),
            ],
            hz=5.0,
            frame=Frame(4000, -900, 1.1),
        )
    )
    # Three seconds after somebody cut in, the gap is still too small: he goes on at the ego's speed
    me = ego(30.0)
    found.append(
        made(
            "rg1_cut_in_stays",
            [me, other(me, 6.0, 30.0, MIDDLE, moves=[(3, 7, SLOW)], lost=(12, 14))],
            25,
            [("stvo.rg1", "fail", "6 m for over 15 s after the cut in, needed 11.1 m")],
        )
    )
    me = ego(30.0, MIDDLE, moves=[(3, 7, SLOW)], lamps=[(0, "right"), (8, "off")])
    found.append(
        made(
            "rg1_ego_cuts_in_behind",
            [me, other(me, 6.5, 30.0, SLOW, kind=None)],
            20,
            [("stvo.rg1", "fail", "ego changes lane to 6.5 m behind a car, needed at once 11.1 m")],
        )
    )
    return found


def lorries() -> list[Drive]:
    found: list[Drive] = []
    for name, kind, size, klass, v, gap, more, verdict in (
        ("truck_40m", "truck", (16.5, 2.5), "goods_over_7t5", 22.0, 40.0, 0, "fail"),
        ("truck_behind_trailer", "truck", (12.0, 2.5), "goods_over_7t5", 20.0, 53.0, 1, "fail"),
    ):
        me = ego(v, kind=kind, size=size)
        lead = other(me, gap, v, kind="truck", size=(9.0, 2.5))
        tracks = [me, lead] + ([trailer(lead, "a2", (7.5, 2.5), 1.0)] if more else [])
        why = f"{gap - (8.5 if more else 0)} m at {v} m/s"
        found.append(
            made(
                "s4_" + name,
                tracks,
                12,
                [("stvo.s4-truck", verdict, why), ("stvo.rg3", "not fail", "no more than 80 km/h")],
                more={"vehicle_class": klass},
            )
        )
    me = ego(22.0, kind="bus", size=(12.0, 2.5))
    found.append(
        made(
            "s4_bus_cut_in_leaves",
            [me, other(me, 35.0, 32.0, MIDDLE, moves=[(1, 4, SLOW)])],
            14,
            [("stvo.s4-truck", "not fail", "he goes off at 10 m/s: 50 m 1.5 s after the start")],
        )
    )
    me = ego(22.0, kind="bus", size=(12.0, 2.5))
    found.append(
        made(
            "s4_bus_cut_in_stays",
            [me, other(me, 28.0, 23.0, MIDDLE, moves=[(1, 4, SLOW)])],
            16,
            [("stvo.s4-truck", "fail", "gap 28 + t m; at 8 s still 36 m")],
        )
    )
    return found


def braking() -> list[Drive]:
    found: list[Drive] = []
    me = ego(30.0, pace=[(3.6, 0), (3, -4.5)])
    found.append(
        made(
            "rg2_lead_brakes",
            [me, other(me, 35.0, 30.0, pace=[(3, 0), (3.5, -4.5)])],
            14,
            [("stvo.rg2", "not fail", "the vehicle ahead brakes as hard, 0.6 s earlier")],
        )
    )
    me = ego(30.0, pace=[(3.6, 0), (3, -4.5)])
    found.append(
        made(
            "rg2_other_lane_brakes",
            [me, other(me, 35.0, 30.0, MIDDLE, pace=[(3, 0), (3.5, -4.5)])],
            14,
            [("stvo.rg2", "fail", "only a vehicle in the lane beside brakes; nobody in the ego's lane")],
        )
    )
    me = ego(28.0, pace=[(3, 0), (3, -5.0)])
    deer = Track("d", "animal", (1.6, 0.5), Path(me.s + 190, -30, 1.5708, ((100, 0),)), 18, 1.0, g=-1)
    found.append(
        made(
            "rg2_deer",
            [me, deer],
            14,
            [
                ("stvo.rg2", "not fail", "a deer on the road ahead"),
                ("ukhc.no-collision", "pass", "ego is far before it"),
            ],
        )
    )
    me = ego(30.0, MIDDLE, pace=[(5, 0), (2, -7.5)])
    behind = other(me, -25, 30.0, MIDDLE, pace=[(5.8, 0), (2.2, -7)])
    found.append(
        made(
            "rg2_brake_check",
            [me, behind],
            14,
            [
                ("stvo.rg2", "fail", "brakes 7.5 m/s2 before a follower, nothing ahead"),
                ("alks-r157.emergency", "fail", "no emergency manoeuvre declared though 7.5 > 5"),
            ],
            events=[(0.0, "engaged", "on"), (0.0, "emergency_manoeuvre", "off")],
        )
    )
    return found


def slow_or_standing() -> list[Drive]:
    found: list[Drive] = []
    me = ego(18.0)
    far = other(me, 300, 36, FAST)
    found.append(made("rg4_18", [me, far], 25, [("stvo.rg4", "fail", "18.0 m/s of 130 km/h")]))
    me = ego(17.0)
    found.append(
        made(
            "rg4_behind_truck",
            [me, other(me, 45, 17.0, kind="truck", size=TRUCK)],
            20,
            [("stvo.rg4", "not fail", "a slow lorry ahead"), ("criticality.thw", "pass", "2.6 s")],
        )
    )
    me = ego(17.0)
    found.append(
        made(
            "rg4_behind_then_free",
            [me, other(me, 45, 17.0, kind="truck", size=TRUCK, pace=[(2, 0), (12, 1.6)], moves=[(2, 6, SHOULDER)])],
            40,
            [("stvo.rg4", "fail", "the lorry is off the lane at 6 s and far, ego is at 17 m/s 30 s later")],
        )
    )
    return found


def stopping() -> list[Drive]:
    found: list[Drive] = []
    me = ego(25.0, pace=[(4, 0), (12, -2.5)])
    found.append(
        made(
            "ri1_alone",
            [me],
            30,
            [
                ("stvo.ri1", "fail", "stands at 14 s with nobody there"),
                ("ukhc.r240.no-stopping", "fail", "16 s"),
                ("stvo.rg2", "fail", "2.5 m/s2 of braking without cause"),
            ],
        )
    )
    me = ego(25.0, pace=[(4, 0), (12, -2.5)])
    stop = 25 * 4 + 125.0
    queue = [
        other(me, stop + 5, 0.0, name="q1", kind="truck", size=(16.5, 2.5)),
        other(me, stop + 3, 0.0, MIDDLE, "q2"),
    ]
    found.append(
        made(
            "ri1_queue",
            [me, *queue],
            30,
            [
                ("stvo.ri1", "pass", "5 m behind a standing lorry"),
                ("ukhc.r240.no-stopping", "not fail", "queue"),
                ("ukhc.no-collision", "pass", "5 m"),
            ],
        )
    )
    me = ego(25.0, pace=[(4, 0), (12, -2.5)])
    found.append(
        made(
            "ri1_queue_other_lane",
            [me, other(me, stop + 5, 0.0, FAST, name="q1")],
            30,
            [
                ("stvo.ri1", "fail", "who stands is two lanes away"),
                ("ukhc.r240.no-stopping", "fail", "nobody in its way"),
            ],
        )
    )
    return found


def shoulders() -> list[Drive]:
    found: list[Drive] = []
    me = ego(22.0, pace=[(3, 0), (10, -3.0)], lamps=[(4, "hazard")], moves=[(3, 7, SHOULDER)])
    found.append(
        made(
            "breakdown_on_shoulder",
            [me],
            25,
            [
                ("ukhc.r269.hard-shoulder", "not fail", "breakdown with hazard lights, stops at 10.3 s"),
                ("stvo.ri1", "not fail", "hazard lights are on"),
                ("stvo.rg4", "not fail", "slow on its way to the shoulder, hazard lights on"),
                ("ukhc.r240.no-stopping", "not fail", "not on a lane; breakdown"),
            ],
        )
    )
    me = ego(25.0, moves=[(2, 5, SHOULDER), (16, 19, SLOW)])
    jam = [other(me, 115 + 30 * k, 6.0, SLOW, f"q{k}") for k in range(2)]
    found.append(
        made(
            "shoulder_past_queue",
            [me, *jam],
            22,
            [
                ("ukhc.r269.hard-shoulder", "fail", "drives along the shoulder for 11 s at 25 m/s"),
                ("stvo.ri2", "fail", "passes on the right, on the shoulder, two cars in a lane, 19 m/s faster"),
            ],
        )
    )
    return found


def backwards() -> list[Drive]:
    found: list[Drive] = []
    me = ego(0.0, SLOW, s=600, pace=[(3, 0), (2, -0.8), (4, 0)], backwards=True, lamps=[(0, "hazard")])
    found.append(
        made(
            "reverse_on_lane",
            [me],
            14,
            [
                ("ukhc.r263.no-reverse", "fail", "1.6 m/s backwards"),
                ("stvo.ri3", "fail", "backwards"),
                ("stvo.rg4", "not fail", "stands for 3 s at the start of the log, with hazard lights on"),
            ],
        )
    )
    back = Path(3000, 0, 3.141592653589793, ((3000.0, 0.0),))
    me = Track("ego", "car", CAR, back, 600, 22.0, -FAST, -1)
    meets = Track("a", "car", CAR, LINE, 1600, 25.0, MIDDLE, -1)
    found.append(
        made(
            "ghost_driver",
            [me, meets],
            15,
            [
                ("stvo.ri3", "fail", "against the traffic"),
                ("ukhc.r143.direction", "fail", "against the traffic on a motorway"),
                ("ukhc.no-collision", "pass", "one lane between them"),
            ],
            frame=Frame(-50, 77, 2.7),
        )
    )
    return found


def changing() -> list[Drive]:
    found: list[Drive] = []
    me = ego(25.0, moves=[(3, 7, MIDDLE)], lamps=[(0.2, "left"), (8, "off")])
    found.append(
        made(
            "rg6_close",
            [me, other(me, -75, 38.0, MIDDLE, pace=[(4.5, 0), (1.9, -7)])],
            14,
            [("stvo.rg6", "fail", "safe is 11.4 + 72.2 - 29.8 = 54 m; gap under 20 m")],
        )
    )
    me = ego(25.0, moves=[(3, 7, MIDDLE)], lamps=[(0.2, "left"), (8, "off")])
    found.append(
        made(
            "rg6_same_7m",
            [me, other(me, -6.0, 25.0, MIDDLE)],
            14,
            [("stvo.rg6", "fail", "safe is 7.5 + 31.25 - 29.76 = 9 m; gap 6 m")],
        )
    )
    # The follower is a van in the fast lane; the ego changes two lanes at once
    me = ego(22.0, moves=[(2, 9, FAST)], lamps=[(0.0, "left"), (10, "off")])
    lorry = other(me, -75, 33.0, FAST, kind="van", size=(6.5, 2.1), pace=[(5, 0), (2.6, -5)])
    found.append(
        made(
            "rg6_second_change",
            [me, lorry],
            14,
            [("stvo.rg6", "fail", "into the left lane: follower some 10 m behind is 6 m/s and more faster")],
        )
    )
    return found


def changing_by_itself() -> list[Drive]:
    found: list[Drive] = []
    v = 25.0
    for name, on, t0, length, first, second in (
        ("r79_late_lamp", 4.0, 4.5, 4.0, "fail", "pass"),
        ("r79_good", 1.0, 4.0, 4.5, "pass", "pass"),
        ("r79_slow_change", 1.0, 3.0, 20.0, "not pass", "fail"),
    ):
        me = ego(v, lamps=[(on, "left"), (t0 + length + 1, "off")], moves=[(t0, t0 + length, MIDDLE)])
        expect = [
            ("alks-r157.r79.lane-change", first, f"lamp at {on} s, over the line about {t0 + length * 0.33:.1f} s"),
            ("alks-r157.r79.lane-change-done", second, f"whole change takes {length} s"),
        ]
        if name == "r79_slow_change":
            expect = expect[1:]
        found.append(
            made(name, [me], 30 if length > 9 else 22, expect, more={"engaged": "yes", "vehicle_class": "car"})
        )
    me = ego(v, lamps=[(0.5, "right"), (9, "off")], moves=[(4, 8, MIDDLE)])
    found.append(
        made(
            "r79_wrong_side",
            [me],
            15,
            [
                ("alks-r157.r79.lane-change", "fail", "indicates to the right and goes to the left"),
                (
                    "declared.r163.checks-before-pull-out",
                    "fail",
                    "only a mirror check, 9 s old at the line: no blind spot",
                ),
            ],
            events=[(0.0, "engaged", "on"), (-0.0, "mirror_check", None), (12.0, "blind_spot_check", "left")],
        )
    )
    return found


def looking() -> list[Drive]:
    found: list[Drive] = []
    v = 25.0
    me = ego(v, lamps=[(1.5, "left"), (9, "off")], moves=[(4, 8, MIDDLE)])
    found.append(
        made(
            "checks_kept",
            [me],
            15,
            [
                ("declared.r163.checks-before-pull-out", "pass", "mirror 1.0, blind spot 3.0"),
                ("declared.r161.mirrors-before-signal", "pass", "mirror 0.5 s before the lamp"),
            ],
            events=[(1.0, "mirror_check", "left"), (3.0, "blind_spot_check", "left")],
        )
    )
    me = ego(v, lamps=[(1.5, "left"), (9, "off")], moves=[(4, 8, MIDDLE)])
    found.append(
        made(
            "checks_other_side",
            [me],
            15,
            [
                ("declared.r163.checks-before-pull-out", "fail", "looks to the right, goes to the left"),
                ("declared.r161.mirrors-before-signal", "not pass", "the mirror looked into is the other side's"),
            ],
            events=[(1.0, "mirror_check", "right"), (3.0, "blind_spot_check", "right")],
        )
    )
    return found


def passing() -> list[Drive]:
    found: list[Drive] = []
    me = ego(32.0, MIDDLE)
    found.append(
        made(
            "ri2_right",
            [me, other(me, 20, 26.0, FAST)],
            15,
            [("stvo.ri2", "fail", "passes at 32 a car at 26 m/s on the left")],
        )
    )
    for name, vq, n, v, verdict in (("ri2_queue", 12.0, 4, 15.5, "pass"), ("ri2_two_only", 12.0, 2, 16.0, "fail")):
        me = ego(v, MIDDLE)
        row = [
            other(
                me,
                8 + 25 * k,
                vq,
                FAST,
                f"q{k}",
                kind="truck" if k == 1 else "car",
                size=(10.0, 2.5) if k == 1 else CAR,
            )
            for k in range(n)
        ]
        found.append(made(name, [me, *row], 16, [("stvo.ri2", verdict, f"{n} at {vq}, ego {v} m/s")]))
    return found


CHAPTERS = (
    following,
    lorries,
    braking,
    slow_or_standing,
    stopping,
    shoulders,
    backwards,
    changing,
    changing_by_itself,
    looking,
    passing,
)


def all_drives() -> list[Drive]:
    return [drive for chapter in CHAPTERS for drive in chapter()]
