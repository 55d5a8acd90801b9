"""Great Britain: country roads and towns."""

from __future__ import annotations

from tests.outsiders.tenth.drive import Drive
from tests.outsiders.tenth.road import Lane
from tests.outsiders.tenth.streets import lane_road, street, town

THINK = "ukhc.r126.thinking-gap"
SOLID = "ukhc.r129.no-cross-solid"
WRONG = "ukhc.r143.direction"
CYCLE = "ukhc.r163.cyclist"
HORSE = "ukhc.r215.horse"


def british_roads() -> list[Drive]:
    return [*rural(), *more_rural()]


def rural() -> list[Drive]:
    """Overtaking."""
    out = []
    s = lane_road(start=(0.0, 0.0, 0.3))
    d = Drive("gb_rural_overtake_before_oncoming_l", s.xml, 26)
    d.ego(s.way(1), 60, [(0, 20), (5, 20), (8, 25), (26, 25)], [(0, 0), (5, 0), (8, -3.5), (12.0, -3.5), (15.0, 0)])
    d.add("slow", "truck", s.way(1), 110, 15.0)
    d.add("on", "car", s.way(-1), 350, [(0, 24), (9, 24), (13, 4), (17, 4), (22, 15)])
    d.want(
        "ukhc.r162.safe-distance-ahead",
        "fail",
        "The oncoming car is 370 m off when it pulls out and has to brake at 5 m/s2 for it.",
    )
    d.want("ukhc.r163.pull-out-separation", "fail", "It pulls out 17 m behind the lorry at 20 m/s.")
    d.want("rss.opposite", "fail", "In the opposing lane, both at 24 m/s and more, with less than 200 m between them.")
    out.append(d)

    s = lane_road(start=(0.0, 0.0, 1.3))
    d = Drive("gb_rural_overtake_of_tractor_clear_road_l", s.xml, 30, hz=5.0)
    d.ego(s.way(1), 20, [(0, 18), (4, 18), (8, 21), (30, 21)], [(0, 0), (4, 0), (7, -3.6), (13.5, -3.6), (17.0, 0)])
    d.add("tractor", "vehicle", s.way(1), 165, 5.0)
    d.want("ukhc.r162.safe-distance-ahead", "not fail", "Nobody comes.")
    d.want(WRONG, "pass", "It is in the opposing lane to overtake only.")
    out.append(d)

    s = lane_road("solid", width=4.2, start=(0.0, 0.0, -2.3))
    d = Drive("gb_rural_solid_line_past_slow_cyclist_l", s.xml, 30)
    d.ego(s.way(1), 60, [(0, 12), (30, 12)], [(0, 0), (6, 0), (9.5, -3.0), (15.5, -3.0), (19.0, 0)])
    d.add("b", "bicycle", s.way(1), 168, 3.0, 1.2)
    d.want(SOLID, "pass", "It passes a cyclist who does 7 mph over a solid line.")
    d.want(CYCLE, "pass", "With about 3 m to spare.")
    out.append(d)

    s = lane_road(start=(0.0, 0.0, 2.0))
    d = Drive("gb_rural_cyclist_in_a_hurry_l", s.xml, 22)
    d.ego(s.way(1), 60, 22.0, [(0, 0), (4, 0), (6.5, -1.3), (10.5, -1.3), (13.0, 0)])
    d.add("b", "bicycle", s.way(1), 200, 6.0, 1.2)
    d.want(CYCLE, "fail", "At 49 mph it passes a cyclist with about 1.3 m between them.")
    out.append(d)

    s = town(start=(0.0, 0.0, 2.0), length=400)
    d = Drive("gb_town_bus_close_past_cyclist_l", s.xml, 26)
    d.ego(s.way(1), 40, 9.5, -0.6, cls="bus")
    d.add("b", "bicycle", s.way(1), 120, 4.5, 1.25)
    d.want(CYCLE, "fail", "The bus leaves a cyclist less than half a metre.")
    out.append(d)

    s = lane_road(start=(0.0, 0.0, 0.0))
    d = Drive("gb_rural_horse_at_twenty_l", s.xml, 26)
    d.ego(s.way(1), 60, [(0, 14), (4, 14), (7, 9), (26, 9)], [(0, 0), (6, 0), (9, -3.0), (16, -3.0), (19, 0)])
    d.add("h", "animal", s.way(1), 180, 1.8, 1.0)
    d.want(HORSE, "fail", "It passes a horse at 20 mph.")
    out.append(d)

    s = lane_road(start=(0.0, 0.0, 0.0))
    d = Drive("gb_rural_horse_slow_and_wide_l", s.xml, 40)
    d.ego(
        s.way(1),
        60,
        [(0, 14), (4, 14), (9, 3.6), (30, 3.6), (36, 10)],
        [(0, 0), (9, 0), (14, -3.4), (27, -3.4), (31, 0)],
    )
    d.add("h", "animal", s.way(1), 178, 1.0, 1.0)
    d.want(HORSE, "pass", "It passes the horse at 8 mph with more than 2.5 m.")
    out.append(d)
    return out


def more_rural() -> list[Drive]:
    """Signs, lines, following."""
    out = []
    s = lane_road(start=(0.0, 0.0, 0.8))
    s.road.sign("no_overtaking_1", "632", "gb", 150.0, 4.4, "+")
    d = Drive("gb_rural_no_overtaking_sign_l", s.xml, 26)
    d.ego(s.way(1), 60, 22.0, [(0, 0), (6, 0), (9, -3.6), (13.5, -3.6), (16.5, 0)])
    d.add("van", "van", s.way(1), 150, 13.0)
    d.want("ukhc.r165.no-overtaking-sign", "fail", "It pulls out to overtake a moving van 40 m behind the sign.")
    out.append(d)

    lane = Lane("driving", 3.6, "solid")
    s = street(
        "gb",
        (lane,),
        (lane,),
        speed=(60, "mph"),
        length=1000,
        start=(0.0, 0.0, -0.8),
        parts=[(330.0, (lane,), (lane,), "solid")],
    )
    d = Drive("gb_rural_not_back_before_solid_l", s.xml, 26)
    d.ego(s.way(1), 60, 23.0, [(0, 0), (6, 0), (9, -3.6), (14.5, -3.6), (17.5, 0)])
    d.add("van", "van", s.way(1), 140, 15.0)
    d.want("ukhc.r128.back-before-solid", "fail", "It is still out when the line becomes solid at 330 m.")
    d.want(SOLID, "not pass", "From 330 m on it is on the wrong side of a solid line.")
    out.append(d)

    s = lane_road(start=(0.0, 0.0, -1.8))
    d = Drive("gb_rural_six_metres_behind_van_l", s.xml, 24)
    d.ego(s.way(1), 60, 21.0)
    d.add("van", "van", s.way(1), 72, 21.0)
    d.want(THINK, "fail", "It drives 7 m behind a van at 47 mph all the time.")
    d.want("criticality.thw", "fail", "That is a third of a second.")
    out.append(d)

    s = lane_road(start=(0.0, 0.0, 2.9))
    d = Drive("gb_rural_speeds_up_when_overtaken_l", s.xml, 26)
    d.ego(s.way(1), 120, [(0, 18), (6, 18), (12, 23.5), (26, 23.5)])
    d.add(
        "o",
        "motorcycle",
        s.way(1),
        70,
        [(0, 20), (3, 20), (8, 27), (26, 27)],
        [(0, 0), (1, 0), (4, -3.5), (17, -3.5), (20, 0)],
    )
    d.want(
        "ukhc.r168.when-overtaken", "fail", "It speeds up by 5 m/s while a motorcycle comes past in the opposing lane."
    )
    out.append(d)

    s = lane_road(start=(0.0, 0.0, 2.9))
    d = Drive("gb_rural_does_not_drop_back_l", s.xml, 34)
    d.ego(s.way(1), 60, 20.0)
    d.add("o", "van", s.way(1), 42, [(0, 26), (6.5, 26), (9, 20.0), (34, 20.0)], [(0, -3.6), (4.5, -3.6), (7.5, 0)])
    d.want("ukhc.r168.drop-back", "fail", "A van moved in ahead; the gap of under two seconds stays as it is for 25 s.")
    out.append(d)

    s = town(start=(0.0, 0.0, 0.3), length=400)
    d = Drive("gb_town_round_parked_lorry_against_oncoming_l", s.xml, 26)
    d.ego(s.way(1), 60, 10.0, [(0, 0), (5, 0), (8, -3.0), (11.2, -3.0), (14, 0)])
    d.add("p", "truck", s.way(1), 162, 0.0, 0.4)
    d.add("on", "car", s.way(-1), 70, [(0, 11.5), (9, 11.5), (12, 3.5), (15, 3.5), (18, 10)], 0.2)
    d.want(
        "ukhc.r163.obstruction-give-way",
        "fail",
        "The oncoming car has to brake hard because the ego goes round a standing lorry.",
    )
    d.want(
        "rss.opposite", "fail", "In the opposing lane with 76 m to one who comes at 11.5 m/s, less than RSS asks for."
    )
    out.append(d)

    s = town(start=(0.0, 0.0, 0.3), length=400)
    d = Drive("gb_town_pavement_past_queue_l", s.xml, 24)
    d.ego(s.way(1), 40, 8.5, [(0, 0), (5, 0), (8, 2.6), (12, 2.6), (15, 0)])
    d.add("q", "van", s.way(1), 118, 0.0, -0.2)
    d.want("ukhc.r145.off-road", "fail", "It drives along the pavement at 19 mph to get past a van.")
    out.append(d)
    return out
