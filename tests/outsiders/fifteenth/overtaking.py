"""Overtaking on two-way roads in Great Britain, middle lines, and being overtaken."""

from tests.outsiders.fifteenth.drives import Drive
from tests.outsiders.fifteenth.motions import Floats, weave
from tests.outsiders.fifteenth.roads import HOME, Place, World, sign, straight

HILL = Place(-3000.0, 1200.0, -1.9)
LONG = 2600.0
OWN = weave(1, [(-90, 1.75), (2400, 1.75)])
ONC = weave(1, [(2400, -1.75), (-90, -1.75)])


def road(middle: list[tuple[float, str]] | None = None, place: Place = HOME, side: int = 1) -> World:
    return straight(side, LONG, 26.82, "rural", middle=middle, place=place)


def out_and_back(a: float, b: float, u: float = -1.75, change: float = 60.0, side: int = 1) -> Floats:
    """Return a way that leaves the lane from x = a on, and is back at b."""
    return weave(side, [(-90, 1.75), (a, 1.75), (a + change, u), (b - change, u), (b, 1.75), (2400, 1.75)])


def oncoming() -> list[Drive]:
    out = []
    d = Drive("overtake_close", road(), 20, "oncoming car brakes hard and meets the ego as it comes back")
    d.add("ego", "car", out_and_back(40, 324), 22.0, 90).add("slow", "car", OWN, 14.0, 150)
    d.add("onc", "car", ONC, [(0, 20), (10, 20), (14, 4)], 2400 - 550)
    d.want("ukhc.r162.safe-distance-ahead", "fail", "an accident but for its braking").want("rss.opposite", "fail")
    d.want("ukhc.r126.ds-disjoint", "fail")
    out.append(d.want("ukhc.overtake-zone", "fail"))
    d = Drive("overtake_alone", road(place=HILL), 20, "overtakes with nobody coming")
    d.add("ego", "car", out_and_back(40, 324), 22.0, 90).add("slow", "car", OWN, 14.0, 150)
    d.want("ukhc.r162.safe-distance-ahead", "not fail").want("ukhc.r143.direction", "not fail")
    out.append(d.want("ukhc.overtake-zone", "not fail").want("ukhc.r162.return-gap", "not fail"))
    d = Drive(
        "overtake_motorcycle_coming", road(place=HILL), 20, "oncoming motorcycle, 27 m/s, meets it soon after", hz=5
    )
    d.add("ego", "van", out_and_back(40, 324), 22.0, 90).add("slow", "truck", OWN, 14.0, 155)
    d.add("onc", "motorcycle", ONC, 27.0, 2400 - (324 + 27 * 14.7 + 25))
    out.append(d.want("ukhc.r126.ds-disjoint", "fail").want("rss.opposite", "fail"))
    return out


def around() -> list[Drive]:
    out = []
    d = Drive("overtake_from_close", road(), 20, "pulls out 5 m behind at 20 m/s")
    d.add("ego", "car", out_and_back(60, 420, change=50), [(0, 16), (4, 16), (8, 24)], 90).add(
        "slow", "van", OWN, 16.0, 100
    )
    d.want("ukhc.r163.pull-out-separation", "fail", "5 m; stopping takes some 36 m")
    out.append(d.want("ukhc.r126.thinking-gap", "fail", "5 m; 0.67 s x 16 m/s = 11 m"))
    d = Drive("overtake_no_room", road(place=HILL), 20, "comes back between two cars 9 m apart")
    d.add(
        "ego",
        "car",
        weave(1, [(-90, 1.75), (40, 1.75), (100, -1.75), (150, -1.75), (200, 1.75), (2400, 1.75)]),
        [(0, 22), (7.6, 22), (9.6, 14)],
        90,
    ).add("slow", "car", OWN, 14.0, 150).add("next", "car", OWN, 14.0, 163.5)
    out.append(
        d.want("ukhc.r162.return-gap", "fail", "9 m between the two").want(
            "ukhc.no-collision", "fail", "touches the hinder one"
        )
    )
    d = Drive("overtake_overtaken", road(), 20, "pulls out before a car that overtakes both")
    d.add("ego", "car", out_and_back(100, 384), [(0, 18), (9, 18), (12, 22)], 90).add("slow", "car", OWN, 14.0, 150)
    d.add(
        "fast",
        "car",
        weave(1, [(-90, 1.75), (-60, 1.75), (0, -1.75), (2400, -1.75)]),
        [(0, 27), (6.5, 27), (8.5, 20)],
        0,
    )
    out.append(d.want("ukhc.r162.not-being-overtaken", "fail", "beside it within 4 s"))
    w = road()
    w.roads[0].signals = [sign(800, 60.0, 1, "276")]
    d = Drive("no_overtaking_sign", w, 20, "overtakes a moving car after the sign")
    d.add("ego", "car", out_and_back(40, 324), 22.0, 90).add("slow", "car", OWN, 14.0, 150)
    out.append(d.want("ukhc.r165.no-overtaking-sign", "fail"))
    return out


def lines() -> list[Drive]:
    out = []
    solid = [(0.0, "solid")]
    for name, v, verdict in (("solid_slow_cyclist", 3.5, "not fail"), ("solid_quick_cyclist", 7.0, "fail")):
        d = Drive(name, road(solid, HILL), 24, f"straddles a solid line for a cyclist at {v} m/s")
        d.add("ego", "car", out_and_back(20 if v < 5 else 115, 170 if v < 5 else 250, -0.4, 40), 11.0, 90)
        d.add("bike", "bicycle", weave(1, [(-90, 2.9), (2400, 2.9)]), v, 150)
        out.append(d.want("ukhc.r129.no-cross-solid", verdict, "4.47 m/s is the most"))
    d = Drive("solid_begins", road([(0.0, "broken"), (330.0, "solid")]), 20, "not back when the line becomes solid")
    d.add("ego", "car", out_and_back(40, 324), 22.0, 90).add("slow", "car", OWN, 14.0, 150)
    d.want("ukhc.r129.no-cross-solid", "fail", "80 m over the solid part")
    out.append(d.want("ukhc.r128.back-before-solid", "fail", "back at x = 310, solid from 230"))
    d = Drive("solid_later", road([(0.0, "broken"), (520.0, "solid")], HILL), 20, "back before the line becomes solid")
    d.add("ego", "car", out_and_back(40, 324), 22.0, 90).add("slow", "car", OWN, 14.0, 150)
    out.append(d.want("ukhc.r128.back-before-solid", "pass").want("ukhc.r129.no-cross-solid", "not fail"))
    return out


def overtaken() -> list[Drive]:
    out = []
    by = weave(1, [(-90, 1.75), (-60, 1.75), (-10, -1.75), (300, -1.75), (360, 1.75), (2400, 1.75)])
    d = Drive("overtaken_speeds_up", road(), 20, "is overtaken by a car")
    d.add("ego", "car", OWN, [(0, 17), (6, 17), (11, 21)], 100).add("fast", "car", by, 23.0, 40)
    out.append(d.want("ukhc.r168.when-overtaken", "fail", "0.8 m/s2 while it is beside"))
    for name, knots, weather, verdict in (
        ("pulled_in_dropped_back", [(0.0, 20.0), (9.0, 20.0), (11.0, 16.0), (17.0, 16.0), (20.0, 20.0)], "dry", "pass"),
        ("pulled_in_wet", [(0.0, 20.0), (9.0, 20.0), (11.0, 16.0), (15.0, 16.0), (17.0, 20.0)], "wet", "fail"),
    ):
        d = Drive(name, road(), 34, "somebody overtakes and pulls in ahead", weather=weather)
        way = weave(1, [(-90, 1.75), (-60, 1.75), (-10, -1.75), (160, -1.75), (200, 1.75), (2400, 1.75)])
        d.add("ego", "car", OWN, knots, 100).add("fast", "car", way, [(0, 26), (9, 26), (10.5, 20)], 70)
        out.append(d.want("ukhc.r168.drop-back", verdict))
    return out


def drives() -> list[Drive]:
    return [*oncoming(), *around(), *lines(), *overtaken()]
