"""Automated systems, critical gaps, collisions and comfort."""

from __future__ import annotations

import math

from tests.outsiders.eighteenth.drive import Drive
from tests.outsiders.eighteenth.motion import Track, trailer
from tests.outsiders.eighteenth.motorways import LINE, MIDDLE, SLOW, ego, made, other
from tests.outsiders.eighteenth.roads import Frame, Path, single

ON = (0.0, "engaged", "on")


def alks() -> list[Drive]:
    found: list[Drive] = []
    for name, v, gap, verdict, why in (
        ("alks_50_14m", 13.89, 14.0, "fail", "20.8 m at 50 km/h"),
        ("alks_50_24m", 13.89, 24.0, "pass", "20.8 m"),
    ):
        me = ego(v)
        found.append(
            made(name, [me, other(me, gap, v)], 24, [("alks-r157.follow-gap", verdict, f"{gap} m; {why}")], events=[ON])
        )
    me = ego(13.89)
    lead = other(me, 26.0, 13.89, kind="van", size=(5.5, 2.0))
    found.append(
        made(
            "alks_behind_trailer",
            [me, lead, trailer(lead, "a2", (6.0, 2.2), 0.7)],
            24,
            [("alks-r157.follow-gap", "fail", "19.3 m to the trailer's rear, 20.8 m needed")],
            events=[ON],
            hz=8.0,
        )
    )
    me = ego(13.89)
    found.append(
        made(
            "alks_off",
            [me, other(me, 8.0, 13.89)],
            20,
            [("alks-r157.follow-gap", "not fail", "the automated driver does not drive")],
            events=[(0.0, "engaged", "off")],
        )
    )
    return found


def cutting_in() -> list[Drive]:
    found: list[Drive] = []
    me = ego(20.0)
    found.append(
        made(
            "alks_cut_in_hit",
            [me, other(me, 46.0, 11.0, MIDDLE, moves=[(1.0, 5.0, SLOW)])],
            12,
            [
                ("alks-r157.cut-in", "fail", "ttc at the cut-in 2 s and more, 9 m/s faster, never brakes, hits"),
                ("ukhc.no-collision", "fail", "runs into it"),
                ("criticality.ttc", "fail", "0 s"),
                ("stvo.rg4", "not fail", "2 s at 20 m/s at the start of the log"),
            ],
            events=[ON],
        )
    )
    me = ego(20.0, pace=[(3.2, 0), (4, -2.6)])
    found.append(
        made(
            "alks_cut_in_kept",
            [me, other(me, 45.0, 13.0, MIDDLE, moves=[(1.5, 4.5, SLOW)])],
            14,
            [
                ("alks-r157.cut-in", "pass", "brakes"),
                ("ukhc.no-collision", "pass", "gap stays over 10 m"),
                ("stvo.rg4", "not fail", "2 s at 20 m/s at the start of the log, then behind a slow car"),
            ],
            events=[ON],
        )
    )
    me = ego(13.0)
    found.append(
        made(
            "alks_cut_in_gap_left",
            [me, other(me, 9.0, 13.0, MIDDLE, moves=[(2, 5, SLOW)])],
            26,
            [("alks-r157.cut-in-gap", "fail", "9 m for 20 s; 19 m needed")],
            events=[ON],
        )
    )
    return found


def manoeuvres() -> list[Drive]:
    found: list[Drive] = []
    me = ego(30.0, pace=[(4, 0), (3, -7.0)])
    found.append(
        made(
            "emergency_declared",
            [me],
            14,
            [("alks-r157.emergency", "pass", "-7.0 m/s2")],
            events=[
                ON,
                (0.0, "emergency_manoeuvre", "off"),
                (3.9, "emergency_manoeuvre", "on"),
                (7.5, "emergency_manoeuvre", "off"),
            ],
        )
    )
    for name, a, lamp, first, second in (
        ("mrm_hard", -5.5, "hazard", "fail", "pass"),
        ("mrm_no_lamp", -3.0, "off", "pass", "fail"),
    ):
        me = ego(20.0, pace=[(4, 0), (12, a)], lamps=[(4.0, lamp)])
        found.append(
            made(
                name,
                [me],
                18,
                [
                    ("alks-r157.mrm", first, f"{a} m/s2"),
                    ("alks-r157.mrm-hazards", second, lamp),
                    ("stvo.rg4", "not fail", "4 s at 20 m/s at the start of the log: it may have just joined"),
                ],
                events=[ON, (0.0, "minimal_risk_manoeuvre", "off"), (4.0, "minimal_risk_manoeuvre", "on")],
            )
        )
    return found


def critical() -> list[Drive]:
    found: list[Drive] = []
    gap = 22 + 3 * 13.0
    me = ego(30.0, MIDDLE, pace=[(3, 0), (3, -7.0)])
    found.append(
        made(
            "late_brake_beside",
            [me, other(me, gap, 17.0, SLOW)],
            12,
            [
                ("criticality.drac", "not fail", "the slow one is in the lane beside"),
                ("criticality.ttb", "not fail", "nobody in its lane"),
                ("stvo.rg2", "fail", "7 m/s2, nobody in its lane"),
            ],
        )
    )
    me = ego(26.0, MIDDLE, pace=[(3, 0), (1.6, -7.5)])
    found.append(
        made(
            "ttc_near",
            [me, other(me, 14 + 3 * 11.0, 15.0)],
            9,
            [
                ("criticality.ttc", "fail", "14 m / 11 m/s = 1.27 s"),
                ("criticality.drac", "fail", "4.3"),
                ("criticality.ttb", "fail", "(14 - 7.6) / 11 = 0.6 s"),
                ("ukhc.no-collision", "pass", "5 m left"),
            ],
        )
    )
    # Same speed, the lead brakes hard and the ego speeds up: only the accelerations say it
    me = ego(25.0, MIDDLE, pace=[(4, 0), (2.0, 1.5), (2.0, -8)])
    found.append(
        made(
            "mttc",
            [me, other(me, 26.0, 25.0, pace=[(4.2, 0), (3, -4.0)])],
            8,
            [
                ("criticality.mttc", "fail", "at 6 s 16.5 m, 10.2 m/s and 5.5 m/s2 of closing: 1.2 s"),
            ],
        )
    )
    return found


def collisions() -> list[Drive]:
    found: list[Drive] = []
    me = ego(14.0, 1.75, s=200)
    walker = Track(
        "p", "pedestrian", (0.5, 0.5), Path(331.5, -12, math.pi / 2, ((50, 0),)), 0.0, 1.2, g=-1, still=math.pi / 2
    )
    t = (331.5 - 200) / 14.0
    walker.s = 12 - 1.75 - 1.2 * t
    found.append(
        made(
            "hit_walker_low_rate",
            [me, walker],
            14,
            [("ukhc.no-collision", "fail", "on the ego's line as it gets there")],
            single("de", "town", "50 km/h"),
            hz=2.0,
            more={"area": "built_up"},
        )
    )
    # Between two steps: a motorcycle crosses before a fast ego; at 4 Hz the boxes never overlap in a step
    me = ego(32.0, MIDDLE, s=100)
    t = 6.125
    cross = Track(
        "m",
        "motorcycle",
        (2.0, 0.7),
        Path(100 + 32 * t + 0.0, -MIDDLE - 60, math.pi / 2, ((200, 0),)),
        60 - 20 * t,
        20.0,
        g=-1,
    )
    found.append(
        made(
            "hit_between_steps",
            [me, cross],
            12,
            [
                ("ukhc.no-collision", "fail", "centres meet 6.125 s, between the steps"),
                ("criticality.ttc", "fail", "1.35 m at 32 m/s: 0.04 s"),
            ],
            hz=4.0,
        )
    )
    return found


def scrapes() -> list[Drive]:
    found: list[Drive] = []
    me = ego(26.0, SLOW)
    lorry = other(me, 20.0, 21.0, MIDDLE, kind="truck", size=(10.0, 2.5))
    tail = trailer(lorry, "a2", (9.0, 2.5), 0.9)
    tail.moves = [(2.0, 4.5, 7.6)]
    found.append(
        made(
            "hit_trailer_side",
            [me, lorry, tail],
            16,
            [
                ("ukhc.no-collision", "fail", "the trailer swings 1.98 m over; its side is at 8.85, the ego's at 8.45"),
            ],
            hz=10.0,
        )
    )
    for name, o, verdict in (("scrape", 2.0 + 1.6, "fail"), ("near_scrape", 2.0 + 2.1, "pass")):
        me = ego(12.0, 1.75, s=100)
        parked = Track("a", "truck", (9.0, 2.4), LINE, 180, 0.0, o + 0.0, -1)
        # half widths 0.925 + 1.2 = 2.125; ego centre 1.75
        free = o - 1.75 - 2.125
        found.append(
            made(
                f"parked_{name}",
                [me, parked],
                14,
                [("ukhc.no-collision", verdict, f"sides {free:.2f} m apart")],
                single("de", "town", "50 km/h"),
                frame=Frame(1000, 2000, -0.6),
            )
        )
    me = ego(10.0, 1.75, s=100, pace=[(3, 0), (5, -2.5)])
    found.append(
        made(
            "hit_from_behind",
            [me, Track("b", "van", (5.5, 2.0), LINE, 80, 10.0, 1.75, -1, pace=[(8.2, 0), (0.3, -33)])],
            14,
            [("ukhc.no-collision", "fail", "a van runs into the ego from behind")],
            single("de", "town", "50 km/h"),
        )
    )
    return found


def reversing() -> list[Drive]:
    found: list[Drive] = []
    me = ego(0.0, 1.75, s=200, pace=[(7, 0), (3, -0.7), (4, 0)], backwards=True)
    found.append(
        made(
            "reverse_into_post",
            [me, Track("x", "object", (0.3, 0.3), LINE, 192.0, 0, 1.2, -1)],
            15,
            [
                ("ukhc.no-collision", "fail", "reverses 11 m, the post is 8 m behind"),
                ("declared.r202.checks-before-reversing", "fail", "looked into the mirror, not over the shoulder"),
            ],
            single("de", "town", "30 km/h"),
            events=[(6.0, "mirror_check", None), (14.0, "blind_spot_check", None)],
        )
    )
    me = ego(0.0, 1.75, s=200, pace=[(2, 0), (3, -0.5), (1, 0), (3, 0.5)], backwards=True)
    found.append(
        made(
            "reverse_checked",
            [me],
            12,
            [("declared.r202.checks-before-reversing", "pass", "mirror 0.5, blind spot 1.2, goes 2.0")],
            single("gb", "town", "30 mph"),
            nation="gb",
            events=[(0.5, "mirror_check", None), (1.2, "blind_spot_check", None)],
        )
    )
    found[-1].tracks[0].g = 1
    return found


def touching() -> list[Drive]:
    found: list[Drive] = []
    # The ego tows; its own trailer keeps 0.6 m and is no follower and no collision
    me = ego(20.0, SLOW, moves=[(4, 8, MIDDLE)], lamps=[(0.5, "left"), (9, "off")])
    bus = Track("x", "bus", (12.0, 2.5), Path(348.6, -MIDDLE - 60, math.pi / 2, ((200, 0),)), -160, 20.0, g=-1)
    found.append(
        made(
            "own_trailer",
            [me, trailer(me, "t", (6.0, 2.2), 0.6), bus],
            14,
            [
                ("ukhc.no-collision", "pass", "own trailer 0.6 m behind; the bus is gone"),
                ("stvo.rg6", "not fail", "own trailer is no follower"),
            ],
            more={"vehicle_class": "car_towing"},
        )
    )
    # A contact that the boxes miss: 0.3 m apart, both change speed at once
    me = ego(15.0, 1.75, s=100, pace=[(5, 0), (0.1, -60)])
    gap = 25.35
    lead = other(me, gap, 10.0, pace=[(5, 0), (0.1, 50)])
    found.append(
        made(
            "contact_unseen",
            [me, lead],
            12,
            [("ukhc.contact-signature", "fail", "both jump by 5 m/s at 0.3 m")],
            single("de", "rural", "100 km/h"),
            hz=20.0,
        )
    )
    return found


def comfort() -> list[Drive]:
    found: list[Drive] = []
    me = ego(20.0, pace=[(4, 0), (4, 2.7)])
    found.append(
        made(
            "accel_hard",
            [me],
            14,
            [
                ("comfort.accel-iso15622", "fail", "2.7 from 20 m/s on, 2 allowed"),
                ("comfort.nuplan", "fail", "2.7 of 2.4"),
                ("stvo.rg4", "not fail", "4 s at 20 m/s at the start of the log, then it speeds up"),
            ],
        )
    )
    way = ((80.0, 0.0), (250.0, 0.01), (200.0, 0.0))
    me = Track("ego", "bus", (12.0, 2.5), Path(0, 0, 0, way), 20, 16.8, 1.75, -1)
    found.append(
        made(
            "lat_bus",
            [me],
            18,
            [("comfort.lateral", "fail", f"v2/r = {16.8**2 / 101.75:.2f}")],
            single("de", "rural", "100 km/h", segments=way),
            frame=Frame(300, 100, 0.4),
        )
    )
    return found


def all_drives() -> list[Drive]:
    return [
        *alks(),
        *cutting_in(),
        *manoeuvres(),
        *critical(),
        *collisions(),
        *scrapes(),
        *reversing(),
        *touching(),
        *comfort(),
    ]
