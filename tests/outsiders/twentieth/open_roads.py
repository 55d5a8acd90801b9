"""Roads between junctions: distance, speed, lamps, parking, the wrong side, bends."""

from __future__ import annotations

from tests.outsiders.twentieth.drive import Drive
from tests.outsiders.twentieth.motion import Actor, Move
from tests.outsiders.twentieth.roads import Lane
from tests.outsiders.twentieth.sites import rural, straight


def tailgate() -> Drive:
    """Too near."""
    p = rural(1, 1200.0)
    a = [Actor("ego", "car", p.lane(1), 60, 20.0), Actor("lead", "van", p.lane(1), 60 + 5.05 + 7.0, 20.0)]
    return Drive(
        "tailgate",
        "7 m behind a van at 20 m/s",
        p.map,
        a,
        [("ukhc.r126.thinking-gap", "fail", "7 m at 20 m/s"), ("criticality.thw", "fail", "0.35 s")],
        20,
    )


def brakes_late() -> Drive:
    """Brakes late."""
    q = straight(-1, 500.0, "town", 50.0, parts=[(250, 0.0), (250, -0.004)])
    stands = Actor("lead", "car", q.lane(1), 200, 0.0, [("hold", 13), ("v", 8, 1.5)])
    moves: list[Move] = [("stop", 200 - 4.5 - 1.2, 7.5), ("hold", 5), ("v", 8, 1.5)]
    b = Actor("ego", "car", q.lane(1), 60, 13.5, moves)
    return Drive(
        "brakes_late",
        "brakes with 7.5 m/s2 behind a standing car, stops 1.2 m behind",
        q.map,
        [b, stands],
        [
            ("criticality.ttc", "fail", "about 1 s"),
            ("criticality.drac", "fail", "over 6 m/s2"),
            ("criticality.ttb", "fail", "no second left"),
            ("criticality.mttc", "fail", "about 1 s"),
            ("comfort.nuplan", "fail", "7.5 m/s2"),
            ("comfort.decel-iso15622", "fail", "mean 6.7 m/s2 over 2 s"),
            ("ukhc.no-collision", "pass", "1.2 m"),
            ("alks-r157.emergency", "fail", "7.5 m/s2 undeclared"),
        ],
        22,
        nation="de",
        env={"engaged": "yes"},
        says=[(0.0, "emergency_manoeuvre", "off")],
    )


def lorry(nation: str, want: str) -> Drive:
    """A lorry over 7.5 t at 20 m/s on a single carriageway of 60 mph."""
    p = rural(1, 700.0)
    return Drive(
        f"lorry_{nation[-3:]}",
        "lorry over 7.5 t at 20 m/s (45 mph) on a single carriageway",
        p.map,
        [Actor("ego", "truck", p.lane(1), 60, 20.0)],
        [("ukhc.r124.speed-limit", want, "40 mph in Scotland, 50 mph in England")],
        20,
        nation=nation,
        env={"vehicle_class": "goods_over_7t5"},
    )


def night_dark() -> Drive:
    """Night without headlights, hazards on, and the horn while it stands."""
    p = rural(1, 700.0)
    moves: list[Move] = [("stop", 200, 2.0), ("hold", 6), ("v", 14, 1.5)]
    return Drive(
        "night_dark",
        "night, 60 mph road: no headlights, hazards on while driving, horn while standing",
        p.map,
        [Actor("ego", "car", p.lane(1), 60, 14, moves, lamp=[(0, 99, "hazard")])],
        [
            ("ukhc.r113.headlights", "fail", "headlights off at night on a 60 mph road"),
            ("ukhc.r116.hazards", "fail", "hazards while driving 14 m/s on a rural road"),
            ("ukhc.r112.horn", "fail", "horn while standing, nobody there"),
        ],
        30,
        light="night",
        says=[(0.0, "headlights", "off"), (0.0, "horn", "off"), (16.0, "horn", "on"), (17.0, "horn", "off")],
    )


def parked_wrong() -> Drive:
    """Parks against the traffic."""
    q = straight(1, 300.0, "town", 30.0)
    wrong = Actor("ego", "car", q.lane(1, -1), 100, 0.0, flip=True, lamp=())
    return Drive(
        "parked_wrong",
        "parked for 68 s at night facing against the traffic",
        q.map,
        [wrong],
        [
            ("ukhc.r239.parked-with-traffic", "fail", "68 s facing against"),
            ("ukhc.r248.parked-at-night", "fail", "at night"),
        ],
        68,
        hz=5.0,
        light="night",
        says=[(0.0, "headlights", "off")],
    )


def footway() -> Drive:
    """Drives on the footway."""
    r = straight(1, 400.0, "town", 30.0, edge=[Lane("sidewalk", 2.0, "none")])
    return Drive(
        "footway",
        "0.5 m of it on the footway for some 4 s at 9 m/s",
        r.map,
        [Actor("ego", "car", r.lane(1), 60, 9.0, (), [(100, 0.0), (130, 1.35), (160, 1.35), (190, 0.0)])],
        [("ukhc.r145.off-road", "fail", "0.5 m on the footway at 9 m/s")],
        24,
    )


def wrong_side() -> Drive:
    """Long in the opposing lane."""
    s = rural(1, 900.0)
    return Drive(
        "wrong_side",
        "14 s in the opposing lane at 14 m/s past nothing",
        s.map,
        [Actor("ego", "car", s.lane(1), 60, 14.0, (), [(100, 0.0), (140, -3.5), (390, -3.5), (430, 0.0)])],
        [("ukhc.r143.direction", "fail", "over 16 s in the opposing lane past nothing")],
        34,
    )


def backs_fast() -> Drive:
    """Backs fast."""
    t = straight(-1, 300.0, "town", 50.0)
    return Drive(
        "backs_fast",
        "DE: backs 50 m at 6 m/s along its lane",
        t.map,
        [
            Actor(
                "ego",
                "van",
                t.lane(1),
                200,
                0.0,
                [("hold", 8), ("v", -6.0, 2.0), ("hold", 7), ("v", 0.0, 2.0)],
                lamp=(),
            )
        ],
        [
            ("ukhc.r143.direction", "fail", "6 m/s backwards, over 10 mph"),
            ("declared.r202.checks-before-reversing", "fail", "mirrors checked, blind spot not"),
        ],
        26,
        nation="de",
        says=[(5.0, "mirror_check", None), (24.0, "blind_spot_check", None)],
    )


def brisk() -> Drive:
    """A bend too fast, and chosen speed broken."""
    p = straight(-1, 700.0, "rural", 100.0, parts=[(250, 0.0), (200, 0.0125), (250, 0.0)])
    a = Actor("ego", "car", p.lane(1), 60, 14.0, [("hold", 5), ("v", 17.5, 3.2)], lamp=[(8.0, 12.0, "near")])
    return Drive(
        "bend_brisk",
        "3.2 m/s2 at 14 to 17.5 m/s, then a bend of 80 m radius; faster than the chosen speed",
        p.map,
        [a],
        [
            ("comfort.lateral", "fail", "17.5^2 / 81.75 = 3.7 m/s2"),
            ("comfort.accel-iso15622", "fail", "3.2 m/s2 at 16 m/s, 2.5 allowed"),
            ("declared.r125.chosen-speed-kept", "fail", "17.5 against 15 chosen"),
            ("declared.r161.mirrors-before-signal", "fail", "no look within 5 s before the signal"),
        ],
        26,
        nation="de",
        says=[(0.5, "chosen_speed", "15; bend ahead"), (20.0, "mirror_check", "right")],
    )


def drives() -> list[Drive]:
    """All of them."""
    lorries = [lorry("gb-sct", "fail"), lorry("gb-eng", "pass")]
    return [
        tailgate(),
        brakes_late(),
        *lorries,
        night_dark(),
        parked_wrong(),
        footway(),
        wrong_side(),
        backs_fast(),
        brisk(),
    ]
