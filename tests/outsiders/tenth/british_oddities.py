"""Great Britain: dual carriageways, a bridge, a roundabout, records that are wrong."""

from __future__ import annotations

import math

from tests.outsiders.tenth.actors import flipped, jump, noise, without
from tests.outsiders.tenth.drive import Drive
from tests.outsiders.tenth.road import Lane, Road, Section, xodr
from tests.outsiders.tenth.streets import FOOT, street, town
from tests.outsiders.tenth.ways import join

SPEED = "ukhc.r124.speed-limit"
WRONG = "ukhc.r143.direction"
HIT = "ukhc.no-collision"


def british_oddities() -> list[Drive]:
    """Dual carriageways, bridges, a roundabout, records that are wrong."""
    out = []
    green = Lane("median", 4.0, "solid")
    two = (Lane("driving", 3.65, "broken"), Lane("driving", 3.65, "solid"))
    s = street(
        "gb", two, (green, *two), kind="rural", speed=(70, "mph"), length=1200, middle="solid", start=(0.0, 0.0, 1.0)
    )
    d = Drive("gb_dual_pulls_out_before_faster_car_l", s.xml, 24)
    d.ego(s.way(2), 200, 22.0, [(0, 0), (6, 0), (9, -3.65), (20, -3.65), (23, 0)])
    d.add("slow", "truck", s.way(2), 285, 16.5)
    d.add("fast", "car", s.way(1), 113, [(0, 31), (6.5, 31), (8.5, 21.8), (24, 21.8)])
    d.want(
        "ukhc.r162.not-being-overtaken",
        "fail",
        "A car 9 m/s faster is three seconds off in the passing lane when it pulls out.",
    )
    out.append(d)

    s = street(
        "gb", two, (green, *two), kind="rural", speed=(70, "mph"), length=1200, middle="solid", start=(0.0, 0.0, 1.9)
    )
    d = Drive("gb_dual_astride_two_lanes_l", s.xml, 28)
    d.ego(s.way(2), 100, 24.0, [(0, 0), (4, 0), (7, -1.8), (24, -1.8), (27, 0)])
    d.want("ukhc.r131.keep-in-lane", "fail", "It drives astride the lane line for 17 s.")
    out.append(d)

    low = street("gb", two, (), kind="motorway", speed=(70, "mph"), length=800, middle="solid")
    high = Road(
        2,
        (400.0, -300.0, math.pi / 2),
        [(700.0, 0.0)],
        [Section(0.0, (Lane("driving", 3.5, "solid"),), (Lane("driving", 3.5, "solid"),))],
        "LHT",
        "rural",
        (60, "mph"),
        z=7.0,
    )
    d = Drive("gb_motorway_under_bridge_l", xodr([low.road, high]), 22)
    d.ego(low.way(2), 60, 29.0, z=0.8)
    d.add("above", "bus", high.way(1.75), 137, 14.0, z=8.6)
    d.want(HIT, "not fail", "A bus goes over a bridge, eight metres above, at the same moment.")
    d.want(SPEED, "pass", "It does 65 mph on the motorway; the road above has another limit.")
    d.want(WRONG, "pass", "It drives as its lane is driven; the road above is another one.")
    out.append(d)

    ring = [
        Road(
            i + 1,
            (x, 0.0, h),
            [(math.pi * 19, -1 / 19)],
            [Section(0.0, (Lane("driving", 5.0, "solid"),), (), "solid")],
            "LHT",
            "town",
            (30, "mph"),
            links=f'<predecessor elementType="road" elementId="{2 - i}" contactPoint="end"/>'
            f'<successor elementType="road" elementId="{2 - i}" contactPoint="start"/>',
        )
        for i, (x, h) in enumerate(((19.0, -math.pi / 2), (-19.0, math.pi / 2)))
    ]
    d = Drive("gb_roundabout_wrong_way_round_l", xodr(ring), 20)
    d.ego(join(ring[1].way(2.5, back=True), ring[0].way(2.5, back=True)), 6, 6.6)
    d.want(WRONG, "fail", "It goes round the ring of a roundabout the wrong way at 15 mph.")
    out.append(d)

    s = town(start=(0.0, 0.0, 0.3), length=400)
    d = Drive("gb_town_drives_through_parked_car_l", s.xml, 20, hz=5.0)
    d.ego(s.way(1), 40, 12.5)
    d.add("p", "car", s.way(1), 160, 0.0, 0.3, size=(4.1, 1.7, 1.5))
    d.want(HIT, "fail", "Its box goes through that of a standing car.")
    d.want("criticality.ttc", "fail", "It drives at 12.5 m/s up to and into a standing car.")
    d.want("criticality.drac", "fail", "Just before, no ordinary braking avoids it.")
    d.want("criticality.ttb", "fail", "It does not brake at all.")
    out.append(d)

    s = town(start=(0.0, 0.0, 0.8), length=400)
    d = Drive("gb_town_brakes_for_child_l", s.xml, 20)
    d.ego(s.way(1), 40, [(0, 12.8), (6, 12.8), (7.7, 0), (13, 0), (16, 6)])
    d.add("child", "pedestrian", s.walk(136, 5.2, -5.5), 0, [(0, 0), (5.2, 0), (5.6, 2.4)], size=(0.4, 0.4, 1.1))
    d.want(HIT, "pass", "It stops 4 m before the child.")
    d.want(
        "comfort.decel-iso15622", "fail", "It brakes at 7.5 m/s2, whatever the reason, over two seconds more than 5."
    )
    out.append(d)

    s = town(start=(0.0, 0.0, 0.8), length=400)
    d = Drive("gb_town_car_jumps_in_record_l", s.xml, 20)
    d.ego(s.way(1), 40, 11.0, change=noise(9))
    d.add("o", "car", s.way(-1), 60, 11.0, change=jump(6.0, 0.0, 35.0))
    d.add("z", "bus", s.way(1), 190, 11.0, change=without(4.0, 9.0))
    d.want(SPEED, "pass", "It does 25 mph; the record trembles.")
    d.want(HIT, "not fail", "Nobody is touched, though one jumps and one is lost for a while.")
    out.append(d)

    s = street(
        "gb",
        (Lane("driving", 3.3, "none"), FOOT),
        (Lane("driving", 3.3, "none"), FOOT),
        kind="town",
        speed=(20, "mph"),
        length=400,
    )
    d = Drive("gb_town_twenty_at_twenty_six_heading_turned_l", s.xml, 22)
    d.ego(s.way(1), 40, 11.6, change=flipped)
    d.want(SPEED, "fail", "It does 26 mph where 20 are allowed, whichever way its heading is recorded.")
    out.append(d)
    return out
