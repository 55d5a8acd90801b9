"""Great Britain: motorways."""

from __future__ import annotations

from tests.outsiders.tenth.drive import Drive
from tests.outsiders.tenth.road import Lane
from tests.outsiders.tenth.streets import back, gb_motorway, street, town

SPEED = "ukhc.r124.speed-limit"
THINK = "ukhc.r126.thinking-gap"
WRONG = "ukhc.r143.direction"


def british_motorways() -> list[Drive]:
    return [*motorways(), *more_motorways()]


def motorways() -> list[Drive]:
    """Motorways."""
    out = []
    s = gb_motorway(start=(0.0, 0.0, 0.1))
    d = Drive("gb_motorway_shoulder_past_jam_l", s.xml, 30)
    d.ego(s.way(3), 60, 15.0, [(0, 0), (4, 0), (8, 3.4), (22, 3.4), (26, 0)])
    for i in range(4):
        d.add(f"q{i}", "car", s.way(3), 200 + 14 * i, 3.0)
    d.want("ukhc.r269.hard-shoulder", "fail", "It drives along the hard shoulder past a jam.")
    out.append(d)

    s = gb_motorway(start=(0.0, 0.0, 1.1))
    d = Drive("gb_motorway_breaks_down_on_shoulder_l", s.xml, 45)
    d.ego(
        s.way(3),
        60,
        [(0, 26), (6, 26), (18, 0.0), (45, 0)],
        [(0, 0), (6, 0), (10, 3.4)],
        lamps=[(0, "left"), (9, "hazard")],
    )
    d.want("ukhc.r269.hard-shoulder", "not fail", "It stops there at once with hazard lights on.")
    d.want(
        "ukhc.r240.no-stopping",
        "not fail",
        "It stands on the shoulder as one that has broken down, not on the carriageway.",
    )
    out.append(d)

    s = gb_motorway(start=(0.0, 0.0, -1.1))
    d = Drive("gb_motorway_stands_in_middle_lane_l", s.xml, 45)
    d.ego(s.way(2), 60, [(0, 24), (6, 24), (18, 0.0), (33, 0), (43, 12)])
    d.add("far", "truck", s.way(3), 20, 22.0)
    d.want("ukhc.r240.no-stopping", "fail", "It stands in the middle lane for 15 s with nobody before it.")
    out.append(d)

    s = gb_motorway(start=(0.0, 0.0, 2.1))
    d = Drive("gb_motorway_lorry_in_right_lane_l", s.xml, 30, conditions={"vehicle_class": "goods_over_7t5"})
    d.ego(s.way(2), 60, 23.5, [(0, 0), (5, 0), (10, -3.65)], cls="truck")
    d.add("v", "van", s.way(2), 190, 21.0)
    d.want("ukhc.r265.right-lane-ban", "fail", "A lorry of over 7.5 t moves to the third lane.")
    out.append(d)

    s = gb_motorway(start=(0.0, 0.0, 0.9))
    d = Drive("gb_motorway_ghost_driver_l", s.xml, 24)
    d.ego(back(s, 1), 200, 26.0)
    d.add("on", "car", s.way(2), 300, 29.0)
    d.want(WRONG, "fail", "It drives against the traffic of a motorway.")
    out.append(d)
    return out


def more_motorways() -> list[Drive]:
    """Slip roads, limits, signals."""
    out = []
    s = gb_motorway(start=(0.0, 0.0, 0.9))
    d = Drive("gb_motorway_at_eighty_two_l", s.xml, 24, hz=25.0)
    d.ego(s.way(2), 60, [(0, 30), (4, 30), (12, 36.6), (24, 36.6)])
    d.want(SPEED, "fail", "It reaches 82 mph where 70 are allowed.")
    out.append(d)

    a, b = Lane("driving", 3.65, "broken"), Lane("driving", 3.65, "solid")
    s_parts = [
        (500.0, (a, Lane("driving", 3.65, "broken"), Lane("exit", 3.5, "solid")), (), "solid"),
        (760.0, (a, b), (), "solid"),
    ]
    s = street(
        "gb",
        (a, b),
        (),
        kind="motorway",
        speed=(70, "mph"),
        length=1500,
        middle="solid",
        start=(0.0, 0.0, -0.2),
        parts=s_parts,
    )
    s.road.sign("exit_1", "333", "de", 640.0, 11.8, "+")
    early = street(
        "gb",
        (a, b),
        (),
        kind="motorway",
        speed=(70, "mph"),
        length=1500,
        middle="solid",
        start=(0.0, 0.0, -0.2),
        parts=s_parts,
    )
    early.road.sign("exit_1", "333", "de", 520.0, 11.8, "+")
    d = Drive("gb_motorway_exit_without_signal_l", early.xml, 17)
    d.ego(s.way(2), 350, 26.0, [(0, 0), (7, 0), (10.5, 3.6)])
    d.want("ukhc.exit-sign-signal", "fail", "It passes the exit sign and takes the exit without a signal.")
    out.append(d)

    d = Drive("gb_motorway_signals_exit_and_stays_l", s.xml, 26)
    d.ego(s.way(2), 350, 26.0, lamps=[(0, "off"), (4.0, "left"), (17.5, "off")])
    d.want("ukhc.signal-then-leaves", "fail", "It signals left beside the exit lane all along and goes straight on.")
    out.append(d)

    s = town(length=600)
    d = Drive("gb_town_hazards_on_while_driving_l", s.xml, 24)
    d.ego(s.way(1), 40, [(0, 10), (20, 10), (24, 8)], lamps=[(0, "hazard"), (19, "off")])
    d.want("ukhc.r116.hazards", "fail", "It drives through a town with hazard lights on.")
    out.append(d)

    s = gb_motorway(start=(0.0, 0.0, 3.0))
    d = Drive("gb_motorway_night_no_headlights_l", s.xml, 24, conditions={"light": "night"})
    d.ego(s.way(3), 40, 27.0)
    d.says(0.0, "headlights", "off").says(15.0, "headlights", "on").says(0.0, "horn", "off")
    d.want("ukhc.r113.headlights", "fail", "It drives at night on a motorway without headlights for 15 s.")
    d.want("ukhc.r112.horn", "not fail", "The horn never sounds.")
    out.append(d)

    s = gb_motorway(start=(0.0, 0.0, 3.0))
    d = Drive("gb_motorway_tailgates_with_trailer_ahead_l", s.xml, 24)
    d.ego(s.way(2), 40, 28.0)
    d.add("t", "truck", s.way(2), 71, 28.0, size=(9.0, 2.5, 3.8))
    d.add("tt", "trailer", s.way(2), 61, 28.0, size=(9.5, 2.5, 3.8))
    d.want(THINK, "fail", "It is 14 m behind a lorry's trailer at 63 mph, the thinking distance is 19 m or more.")
    d.want("criticality.thw", "fail", "That is 0.5 s.")
    out.append(d)

    s = gb_motorway(start=(0.0, 0.0, -3.0))
    d = Drive("gb_motorway_lead_comes_out_of_nothing_l", s.xml, 22)
    d.ego(s.way(3), 40, 27.0)
    d.add("c", "car", s.way(3), 58, 27.0, span=(5.0, 22.0), size=(None, None, None))
    d.want(
        THINK,
        "not pass",
        "For 17 s it follows something of unknown size, whose middle is 18 m ahead: less than 16 m from box to box.",
    )
    out.append(d)
    return out
