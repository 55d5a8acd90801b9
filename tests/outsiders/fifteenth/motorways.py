"""Motorways in Great Britain and in Germany."""

from tests.outsiders.fifteenth.drives import Drive
from tests.outsiders.fifteenth.motions import Floats, go, stop, weave
from tests.outsiders.fifteenth.roads import HOME, Lane, Place, motorway, sign

EAST = Place(120.0, -9000.0, 0.35)


def lane(side: int, k: int) -> Floats:
    """Return the way along lane k, 1 nearest to the middle."""
    u = (k - 0.5) * 3.5
    return weave(side, [(-90, u), (2600, u)])


def change(side: int, a: float, b: float, k: int, m: int) -> Floats:
    """Return the way from lane k to lane m, between x = a and b."""
    u, v = (k - 0.5) * 3.5, (m - 0.5) * 3.5
    return weave(side, [(-90, u), (a, u), (b, v), (2600, v)])


def british() -> list[Drive]:
    out = []
    d = Drive("m_stopped", motorway(1, speed=31.29), 30, "stands in its lane for 9 s for nobody")
    d.add("ego", "car", lane(1, 3), go(stop(20, 2.5, 220), 9, 2, 20), 50)
    out.append(d.want("ukhc.r240.no-stopping", "fail", "9 s"))
    d = Drive("m_reverse", motorway(1, speed=31.29), 30, "stops past its exit and reverses at 3 m/s")
    d.add(
        "ego",
        "car",
        lane(1, 3),
        [(0, 15), (5, 15), (11, 0), (13, 0), (15, -3), (22, -3), (24, 0), (25, 0), (30, 10)],
        200,
    )
    d.want("ukhc.r263.no-reverse", "fail", "20 m backwards")
    out.append(d.want("ukhc.r143.direction", "fail", "on a motorway nothing excuses it"))
    d = Drive(
        "m_towing_right",
        motorway(1, speed=31.29),
        25,
        "a car that tows in the right-hand lane of three",
        more={"vehicle_class": "car_towing"},
    )
    d.add("ego", "car", change(1, 100, 180, 2, 1), 26.0, 50).add("tail", "trailer", change(1, 100, 180, 2, 1), 26.0, 43)
    out.append(d.want("ukhc.r265.right-lane-ban", "fail"))
    d = Drive("m_shoulder", motorway(1, speed=31.29, place=EAST), 25, "drives past a queue on the hard shoulder")
    d.add(
        "ego", "car", weave(1, [(-90, 8.75), (50, 8.75), (110, 12.0), (400, 12.0), (460, 8.75), (2000, 8.75)]), 22.0, 60
    )
    d.add("slow", "truck", lane(1, 3), 10.0, 230)
    out.append(d.want("ukhc.r269.hard-shoulder", "fail"))
    d = Drive("m_breakdown", motorway(1, speed=31.29), 30, "stops on the hard shoulder with hazard lights")
    d.add(
        "ego",
        "car",
        weave(1, [(-90, 8.75), (50, 8.75), (130, 12.0), (2000, 12.0)]),
        stop(22, 2.5, 230),
        60,
        lamp=[(0, "off"), (5, "hazard")],
    )
    out.append(d.want("ukhc.r269.hard-shoulder", "not fail").want("ukhc.r240.no-stopping", "not fail"))
    return [*out, *exits()]


def exits() -> list[Drive]:
    out = []
    for name, lamp, away, rule, verdict in (
        ("m_exit_unsigned", [(0.0, "off")], True, "ukhc.exit-sign-signal", "fail"),
        ("m_exit_not_taken", [(0.0, "off"), (9.0, "left"), (17.0, "off")], False, "ukhc.signal-then-leaves", "fail"),
    ):
        w = motorway(1, lanes=2, speed=31.29, place=EAST if away else HOME)
        near = [Lane(), Lane(), Lane("exit", 3.5, "solid"), Lane("shoulder", 3.0, "none")]
        w.roads[0].late = (350.0, 650.0, near)
        w.roads[0].signals = [sign(900, 380.0, 1, "332", lanes=2)]
        d = Drive(name, w, 23 if away else 28, "an exit lane from x = 250 to 550")
        way = weave(1, [(-90, 5.25), (290, 5.25), (370, 8.75), (560, 8.75), (700, 12), (2000, 12)])
        d.add("ego", "car", way if away else lane(1, 2), 24.0, 60, lamp=lamp)
        out.append(d.want(rule, verdict))
    return out


def de(name: str, what: str, time: float = 25, vehicle: str | None = None) -> Drive:
    """Return a drive on a German motorway of three lanes and 130 km/h."""
    more = {"vehicle_class": vehicle} if vehicle else {}
    place = EAST if len(name) % 2 else HOME
    return Drive(name, motorway(-1, 3, 2600.0, 36.11, place), time, what, nation="de", more=more)


def german_gaps() -> list[Drive]:
    out = []

    d = (
        de("a_close", "7 m behind a car at 33 m/s")
        .add("ego", "car", lane(-1, 2), 33.0, 20)
        .add("lead", "car", lane(-1, 2), 33.0, 31.5)
    )
    out.append(d.want("stvo.rg1", "fail", "7 m; 0.3 s x 33 + 54.5 - 51.9 = 12.5 m"))
    d = de("a_brake_nothing", "brakes at 5 m/s2 for nothing")
    d.add("ego", "car", lane(-1, 2), [(0, 30), (8, 30), (8.5, 28.75), (11, 16.25), (11.5, 15), (25, 15)], 20)
    out.append(d.want("stvo.rg2", "fail", "5 m/s2").want("comfort.nuplan", "fail", "5 of 4.05 m/s2"))
    d = de("a_brake_lead", "brakes as the one ahead brakes")
    knots = [(0.0, 28.0), (8.0, 28.0), (11.0, 16.0), (25.0, 16.0)]
    d.add("ego", "car", lane(-1, 2), [(t + 0.5 if t else 0.0, v) for t, v in knots], 20).add(
        "lead", "car", lane(-1, 2), knots, 64
    )
    out.append(d.want("stvo.rg2", "pass", "half a second after it"))
    d = de("a_truck_35", "lorry 35 m behind another at 22 m/s", vehicle="goods_over_7t5")
    d.add("ego", "truck", lane(-1, 3), 22.0, 60).add("lead", "truck", lane(-1, 3), 22.0, 60 + 47)
    out.append(
        d.want("stvo.s4-truck", "fail", "35 m").want("stvo.rg1", "not fail").want("stvo.rg3", "pass", "22 of 22.2 m/s")
    )
    d = de("a_change_before", "changes lane 33 m before a car 9 m/s faster")
    d.add("ego", "car", change(-1, 200, 290, 3, 2), 27.0, 100).add(
        "behind", "car", lane(-1, 2), [(0, 36), (8, 36), (10, 27)], 0.0
    )
    out.append(d.want("stvo.rg6", "fail", "33 m of 41 m"))
    return out


def german_ways() -> list[Drive]:
    out = []

    d = de("a_towing_fast", "a car that tows at 26 m/s", vehicle="car_towing")
    d.add("ego", "car", lane(-1, 3), 26.0, 60).add("tail", "trailer", lane(-1, 3), 26.0, 53)
    out.append(d.want("stvo.rg3", "not pass", "94 km/h; 80, by exemption 100"))
    d = de("a_slow", "18 m/s on an empty motorway", 40).add("ego", "car", lane(-1, 3), 18.0, 60)
    out.append(d.want("stvo.rg4", "fail", "18 m/s under 36"))
    d = de("a_stopped", "stops for nobody", 30).add("ego", "car", lane(-1, 3), go(stop(22, 2.2, 220), 7, 2, 22), 60)
    out.append(d.want("stvo.ri1", "fail").want("ukhc.r240.no-stopping", "fail", "7 s"))
    d = de("a_right_queue", "passes a slow queue on the right, 14 against 11 m/s")
    d.add("ego", "car", lane(-1, 3), 14.0, 20)
    for k in range(5):
        d.add(f"q{k}", "car", lane(-1, 2), 11.0, 40 + 15.0 * k)
    out.append(d.want("stvo.ri2", "not fail", "3 m/s faster past five"))
    d = de("a_reverse", "reverses on the hard shoulder side lane", 20)
    d.add("ego", "car", lane(-1, 3), [(0, 0), (3, 0), (5, -2.5), (12, -2.5), (14, 0)], 300)
    out.append(d.want("stvo.ri3", "fail").want("ukhc.r263.no-reverse", "fail"))
    return out


def drives() -> list[Drive]:
    return [*british(), *german_gaps(), *german_ways()]
