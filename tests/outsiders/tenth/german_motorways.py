"""Germany: the Autobahn."""

from __future__ import annotations

from tests.outsiders.tenth.actors import flipped, noise
from tests.outsiders.tenth.drive import Drive
from tests.outsiders.tenth.road import Lane
from tests.outsiders.tenth.streets import bahn, street

GAP = "stvo.rg1"
BRAKE = "stvo.rg2"
LIMIT = "stvo.rg3"
SLOW = "stvo.rg4"
CHANGE = "stvo.rg6"
STAND = "stvo.ri1"
RIGHT = "stvo.ri2"
BACK = "stvo.ri3"
LORRY = "stvo.s4-truck"


def german_motorways() -> list[Drive]:
    return [*lorries(), *gaps(), *standing()]


def lorries() -> list[Drive]:
    """Lorries and buses."""
    out = []
    s = bahn(start=(100.0, 0.0, 0.4))
    d = Drive("de_autobahn_lorry_thirty_metres_l", s.xml, 24, conditions={"vehicle_class": "goods_over_7t5"})
    d.ego(s.way(2), 60, 22.0, cls="truck")
    d.add("v", "truck", s.way(2), 101.5, 22.0)
    d.want(LORRY, "fail", "The lorry keeps 30 m behind another at 79 km/h, not 50.")
    d.want(LIMIT, "pass", "79 km/h are within 80.")
    out.append(d)

    s = bahn(3, start=(100.0, 0.0, -0.4))
    d = Drive("de_autobahn_coach_cut_in_on_l", s.xml, 26)
    d.ego(s.way(3), 60, [(0, 21.5), (5, 21.5), (6.5, 20.0), (16, 20.0), (20, 21)], cls="bus")
    d.add("v", "car", s.way(2), 80, [(0, 24.0), (20, 24.0)], [(0, 0), (3.0, 0), (6.0, -3.75)])
    d.want(LORRY, "fail", "Three seconds after a car came in the gap is 33 m, and 50 m only seven seconds after.")
    d.want(LIMIT, "pass", "The bus does 77 km/h.")
    d.want("ukhc.r168.drop-back", "pass", "The gap of two seconds is there again within ten seconds.")
    out.append(d)

    s = bahn(speed=None, start=(0.0, 0.0, 2.0))
    d = Drive("de_autobahn_lorry_at_hundred_l", s.xml, 24, conditions={"vehicle_class": "goods_over_7t5"})
    d.ego(s.way(2), 60, 27.6, cls="truck", change=noise(3, 0.05, 0.05))
    d.want(LIMIT, "fail", "A lorry does 99 km/h, 80 are allowed, though the road has no limit for cars.")
    out.append(d)

    s = bahn(speed=None, start=(0.0, 0.0, -2.0))
    d = Drive("de_autobahn_car_at_two_hundred_l", s.xml, 24, hz=20.0)
    d.ego(s.way(1), 60, 55.0)
    d.add("o", "van", s.way(2), 500, 33.0)
    d.want(LIMIT, "not fail", "198 km/h where no limit holds.")
    out.append(d)
    return out


def gaps() -> list[Drive]:
    """Distances and lane changes."""
    out = []
    s = bahn(start=(0.0, 0.0, 1.0), pieces=[(300.0, 0.0), (1600.0, 1 / 1400)])
    d = Drive("de_autobahn_pushes_in_bend_l", s.xml, 24)
    d.ego(s.way(1), 60, 32.0)
    d.add("v", "car", s.way(1), 73.5, 32.0)
    d.want(GAP, "fail", "It drives 9 m behind a car at 115 km/h.")
    d.want("criticality.thw", "fail", "That is 0.3 s.")
    out.append(d)

    s = bahn(start=(0.0, 0.0, 1.7))
    d = Drive("de_autobahn_brakes_for_nothing_l", s.xml, 24)
    d.ego(s.way(2), 60, [(0, 30), (8, 30), (10.5, 18.0), (17, 18), (24, 23)])
    d.add("behind", "car", s.way(2), 0, [(0, 30), (8.8, 30), (11.5, 17.5), (24, 17.5)])
    d.want(BRAKE, "fail", "It brakes at nearly 5 m/s2 on a free Autobahn.")
    d.want("comfort.jerk-iso15622", "fail", "At 30 m/s the braking grows by 4.8 m/s2 within a second.")
    out.append(d)

    s = bahn(start=(0.0, 0.0, 1.7))
    d = Drive("de_autobahn_brakes_with_the_one_ahead_l", s.xml, 24)
    d.ego(s.way(2), 60, [(0, 30), (8.6, 30), (11.2, 17.5), (24, 17.5)])
    d.add("v", "van", s.way(2), 115, [(0, 30), (8, 30), (10.5, 18.0), (24, 18)])
    d.want(BRAKE, "not fail", "The van ahead brakes just as hard a moment before.")
    d.want("ukhc.no-collision", "pass", "They do not touch.")
    out.append(d)

    s = bahn(3, start=(0.0, 0.0, -1.7), speed=(130, "km/h"))
    d = Drive("de_autobahn_pulls_out_before_fast_car_l", s.xml, 24)
    d.ego(s.way(2), 260, 26.0, [(0, 0), (6, 0), (10, 3.75)], lamps=[(0, "off"), (5, "left"), (10, "off")])
    d.add("fast", "car", s.way(1), 168, [(0, 36), (7, 36), (9.5, 26), (24, 26)])
    d.want(CHANGE, "fail", "The car behind is 28 m off and 10 m/s faster when it begins to come over.")
    out.append(d)

    d = Drive("de_autobahn_follower_appears_late_l", s.xml, 24)
    d.ego(s.way(2), 260, 26.0, [(0, 0), (6, 0), (10, 3.75)], lamps=[(0, "off"), (5, "left"), (10, "off")])
    d.add("fast", "car", s.way(1), 168, [(0, 36), (7, 36), (9.5, 26), (24, 26)], span=(5.6, 24.0), change=flipped)
    d.want(CHANGE, "not pass", "As before, but the car is recorded from just before only, and backwards.")
    out.append(d)

    s = bahn(3, start=(0.0, 0.0, -1.7), speed=(130, "km/h"))
    d = Drive("de_autobahn_overtakes_on_the_right_l", s.xml, 26)
    d.ego(s.way(3), 60, 31.0)
    d.add("o", "car", s.way(2), 160, 25.0)
    d.want(RIGHT, "fail", "It gets ahead of a single car to its left at 112 km/h.")
    out.append(d)

    d = Drive("de_autobahn_past_queue_on_the_right_l", s.xml, 40)
    d.ego(s.way(3), 60, 12.0)
    for i in range(6):
        d.add(f"q{i}", "car" if i % 2 else "truck", s.way(2), 100 + 20 * i, 8.5)
    d.add("q7", "van", s.way(1), 130, 9.0).add("q8", "car", s.way(1), 150, 9.0)
    d.want(RIGHT, "pass", "It passes a slow queue on its left, 13 km/h faster than that.")
    out.append(d)

    a, b = Lane("driving", 3.75, "broken"), Lane("driving", 3.75, "solid")
    s = street(
        "de",
        (a, Lane("driving", 3.75, "broken"), Lane("entry", 3.5, "solid")),
        (),
        kind="motorway",
        speed=(120, "km/h"),
        length=1500,
        middle="solid",
        start=(0.0, 0.0, 0.3),
        parts=[(400.0, (a, b), (), "solid")],
    )
    d = Drive("de_autobahn_slip_road_gets_ahead_l", s.xml, 24)
    d.ego(s.way(3), 30, [(0, 22), (8, 31), (24, 31)], [(0, 0), (8.0, 0), (11.5, 3.6)], lamps=[(0, "left"), (12, "off")])
    d.add("t", "truck", s.way(2), 55, 22.0)
    d.want(RIGHT, "not fail", "On the way in one may be faster than those on the Autobahn.")
    out.append(d)
    return out


def standing() -> list[Drive]:
    """Slow, standing, backwards."""
    out = []
    s = bahn(3, start=(0.0, 0.0, 0.0), speed=(130, "km/h"))
    d = Drive("de_autobahn_crawls_on_free_road_l", s.xml, 40)
    d.ego(s.way(3), 60, 17.0)
    d.add("o", "car", s.way(1), 20, 33.0)
    d.want(SLOW, "fail", "It does 61 km/h on a free Autobahn for 40 s.")
    out.append(d)

    d = Drive("de_autobahn_stops_in_middle_lane_l", s.xml, 36)
    d.ego(s.way(2), 60, [(0, 25), (6, 25), (18, 0), (28, 0), (36, 10)])
    d.add("o", "car", s.way(3), 500, 25.0)
    d.want(STAND, "fail", "It comes to stand with nobody ahead.")
    d.want("ukhc.r240.no-stopping", "fail", "It stands for ten seconds on a motorway.")
    out.append(d)

    d = Drive("de_autobahn_stops_behind_jam_l", s.xml, 36)
    d.ego(s.way(2), 60, [(0, 25), (6, 25), (18, 0), (28, 0), (36, 5)])
    d.add("o", "truck", s.way(2), 376, [(0, 0), (27, 0), (34, 5)])
    d.want(STAND, "pass", "It stands 8 m behind a standing lorry.")
    d.want("ukhc.r240.no-stopping", "pass", "It stands in a queue.")
    out.append(d)

    d = Drive("de_autobahn_backs_up_to_the_exit_l", s.xml, 30)
    d.ego(s.way(3, wrong=True), 900, [(0, 0), (4, 0), (7, 3.4), (28, 3.4)], reverse=True, lamps=[(0, "hazard")])
    d.want(BACK, "fail", "It reverses in the right lane at 12 km/h.")
    d.want("ukhc.r263.no-reverse", "fail", "And so on any motorway.")
    out.append(d)
    return out
