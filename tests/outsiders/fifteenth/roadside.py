"""Obstructions, collisions, lamps, speeds and sides of the road."""

from tests.outsiders.fifteenth.drives import Drive
from tests.outsiders.fifteenth.motions import across, stop, weave
from tests.outsiders.fifteenth.roads import Place, straight

VALE = Place(900.0, 15000.0, 3.0)
OWN = weave(1, [(-90, 1.75), (1400, 1.75)])
ONC = weave(1, [(1400, -1.75), (-90, -1.75)])


def obstructions() -> list[Drive]:
    out = []
    rule = "ukhc.r163.obstruction-give-way"
    way = weave(1, [(-90, 1.75), (30, 1.75), (55, -0.9), (105, -0.9), (130, 1.75), (1400, 1.75)])
    park = weave(1, [(-90, 2.4), (1400, 2.4)])

    def scene(name: str) -> Drive:
        d = Drive(name, straight(1, 1600, 13.41, "town"), 24, "passes a parked van")
        return d.add("parked", "van", park, 0.0, 170)

    d = scene("parked_forced").add("ego", "car", way, 11.0, 60)
    d.add("onc", "car", ONC, [(0, 11), (7, 11), (9, 2), (12, 2), (16, 10)], 1400 - 240)
    out.append(d.want(rule, "fail", "it brakes at 4.5 m/s2 as the ego comes"))
    d = scene("parked_just_before").add("ego", "car", way, 11.0, 60)
    d.add("onc", "motorcycle", weave(1, [(1400, -2.4), (-90, -2.4)]), 13.0, 1400 - 257)
    out.append(d.want(rule, "fail", "0.2 m apart at 24 m/s"))
    d = scene("parked_brushed").add(
        "ego", "car", weave(1, [(-90, 1.75), (40, 1.75), (70, 0.55), (1400, 0.55)]), 8.0, 60
    )
    out.append(d.want("ukhc.no-collision", "fail", "2.4 - 1.0 = 1.40 < 0.55 + 0.9 = 1.45"))
    d = Drive("tunnelled", straight(1, 800, 26.82), 12, "a walker runs across between two steps", hz=2)
    d.add("ego", "car", OWN, 20.0, 90)
    d.add("ped", "pedestrian", across(65.0, 4.5, -8), 2.5, 2.75 - 2.5 * 3.25)
    out.append(d.want("ukhc.no-collision", "fail", "at t = 3.25 s its middle is on the ego's"))
    return out


def lamps() -> list[Drive]:
    out = []
    d = Drive("hazards_driving", straight(1), 15, "hazard lights on while driving")
    d.add("ego", "car", OWN, 15.0, 60, lamp=[(0, "off"), (5, "hazard"), (11, "off")])
    out.append(d.want("ukhc.r116.hazards", "fail", "6 s at 15 m/s"))
    k = stop(12, 2, 90)
    d = Drive("horn_standing", straight(1, 800, 13.41, "town"), 20, "sounds its horn standing, nobody near")
    d.add("ego", "car", OWN, k, 60).say(0, "horn", "off").say(14, "horn", "on").say(15, "horn", "off")
    out.append(d.want("ukhc.r112.horn", "fail"))
    w = straight(1, 800, 13.41, "town", place=VALE)
    d = Drive("night_lit_street", w, 12, "night, headlights off where lamps may stand", light="night")
    d.add("ego", "car", OWN, 12.0, 60).say(0, "headlights", "off")
    out.append(d.want("ukhc.r115.dipped-headlights", "fail"))
    d = Drive("night_off_late", straight(1, 1200, 26.82), 20, "headlights go off for 4 s", light="night")
    d.add("ego", "car", OWN, 18.0, 60).say(0, "headlights", "on").say(9, "headlights", "off").say(
        13, "headlights", "on"
    )
    return [*out, d.want("ukhc.r113.headlights", "fail", "4 s at 18 m/s")]


def sides() -> list[Drive]:
    out = []
    d = Drive("wrong_side", straight(1, 1600, 17.88), 28, "15 s on the other side for nothing")
    d.add(
        "ego", "car", weave(1, [(-90, 1.75), (0, 1.75), (40, -1.75), (250, -1.75), (290, 1.75), (1400, 1.75)]), 13.0, 70
    )
    out.append(d.want("ukhc.r143.direction", "fail", "some 19 s of 10 s"))
    d = Drive("reversed_fast", straight(1, 800, 13.41), 20, "reverses at 6 m/s")
    d.add("ego", "car", OWN, [(0, 0), (2, 0), (6, -6), (14, -6), (17, 0)], 300)
    out.append(d.want("ukhc.r143.direction", "fail", "6 m/s backwards"))
    d = Drive("pavement_driven", straight(1, 800, 13.41, "town", walk=True), 18, "drives on the pavement at 9 m/s")
    d.add("ego", "car", weave(1, [(-90, 1.75), (20, 1.75), (45, 3.6), (75, 3.6), (100, 1.75), (1400, 1.75)]), 9.0, 70)
    out.append(d.want("ukhc.r145.off-road", "fail", "4.5 - 3.5 = 1.0 m over the kerb"))
    two = straight(1, 1600, 17.88, "town", lanes=2)
    d = Drive("astride", two, 30, "astride the line between two lanes for 13 s")
    d.add("ego", "car", weave(1, [(-90, 5.25), (0, 5.25), (30, 3.5), (200, 3.5), (230, 5.25), (1400, 5.25)]), 14.0, 70)
    out.append(d.want("ukhc.r131.keep-in-lane", "fail", "13 s"))
    d = Drive("stood_across_night", straight(1, 800, 13.41, "town"), 88, "stands for 74 s", hz=5, light="night")
    d.add(
        "ego",
        "car",
        weave(1, [(-90, 1.75), (60, 1.75), (95, -2.2), (1400, -2.2)]),
        [(0, 8), (9, 8), (12, 4), (14, 0)],
        70,
    )
    d.want("ukhc.r239.parked-with-traffic", "not fail", "half over the middle line, but as its lane is driven")
    out.append(d.want("ukhc.r248.parked-at-night", "not fail"))
    return out


def speeds() -> list[Drive]:
    w = straight(1, 1600, 26.82, place=VALE)
    d = Drive("speed_lorry_scotland", w, 20, "a lorry in Scotland at 46 mph on a single carriageway", nation="gb-sct")
    d.more = {"vehicle_class": "goods_over_7t5"}
    d.add("ego", "truck", OWN, 20.5, 40)
    return [d.want("ukhc.r124.speed-limit", "fail", "40 mph is its limit there")]


def drives() -> list[Drive]:
    return [*obstructions(), *lamps(), *sides(), *speeds()]
