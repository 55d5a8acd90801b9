"""Great Britain: junctions without lights."""

from __future__ import annotations

from tests.outsiders.tenth.actors import without
from tests.outsiders.tenth.drive import Drive
from tests.outsiders.tenth.junction import FOUR, TEE, Cross
from tests.outsiders.tenth.road import Lane
from tests.outsiders.tenth.streets import street
from tests.outsiders.tenth.ways import line

STOP = "ukhc.r171.stop-sign"
TURN = "ukhc.r180.right-turn-gap"
FOOT = "ukhc.h2.turn-pedestrian"
LEFT = [(0.0, "left")]
RIGHT = [(0.0, "right")]


def british_junctions() -> list[Drive]:
    return [*unlit(), *stops(), *boxes()]


def unlit() -> list[Drive]:
    """Without lights."""
    out = []
    c = Cross("gb", TEE, turn=-0.6)
    c.give("S")
    d = Drive("gb_tee_left_before_walker_l", c.xml, 24)
    d.ego(c.way("E", "S"), 84, [(0, 8), (6, 8), (7.5, 5), (24, 5)], lamps=LEFT)
    arm = c.arms["S"]
    d.add("w", "pedestrian", line(arm.point(3.0, -6.0), arm.point(3.0, 7.0)), 0, [(0, 0), (8.75, 0), (9.15, 1.2)])
    d.want(FOOT, "fail", "It turns left into the side road about a second before a walker who crosses it.")
    d.want("criticality.pet", "fail", "There is one second between the two.")
    out.append(d)

    d = Drive("gb_tee_left_lets_walker_over_l", c.xml, 30)
    d.ego(c.way("E", "S"), 80, [(0, 8), (6, 8), (10.5, 0), (17.5, 0), (20, 5)], lamps=LEFT)
    d.add("w", "pedestrian", line(arm.point(3.0, -6.0), arm.point(3.0, 7.0)), 0, [(0, 0), (5.6, 0), (6, 1.2)])
    d.want(FOOT, "pass", "It waits before the junction until the walker is over.")
    out.append(d)

    d = Drive("gb_tee_left_swings_wide_l", c.xml, 24)
    swing = [(0.0, 0.0), (10.0, 0.0), (14.0, -1.6), (18.5, -1.6), (22.0, 0.0)]
    d.ego(c.way("E", "S"), 76, [(0, 6), (24, 6)], swing, lamps=LEFT)
    d.want("ukhc.r183.keep-in", "fail", "It comes out of its left turn 2.4 m off the near edge, over the middle line.")
    out.append(d)

    d = Drive("gb_tee_right_cuts_corner_l", c.xml, 24)
    way = c.way("W", "S")
    d.ego(way, 84, [(0, 6.5), (24, 6.5)], [(0, 0), (7.0, 0), (11.0, -2.7), (13.4, -2.7), (16.5, 0.0)], lamps=RIGHT)
    d.want("ukhc.r180.corner-cut", "fail", "It comes into the side road with its whole width on the wrong side.")
    out.append(d)

    d = Drive("gb_tee_right_lorry_before_motorcycle_l", c.xml, 26)
    d.ego(c.way("W", "S"), 80, [(0, 7), (7, 7), (9, 5), (26, 5)], lamps=RIGHT, cls="truck")
    d.add("m", "motorcycle", c.way("E", "W"), 10, 10.0)
    d.want(TURN, "fail", "A long lorry is still across the lane when, or just before, a motorcycle gets there.")
    out.append(d)

    d = Drive("gb_tee_right_oncoming_lost_l", c.xml, 26)
    d.ego(c.way("W", "S"), 80, [(0, 7), (7, 7), (9, 5), (26, 5)], lamps=RIGHT)
    d.add("m", "car", c.way("E", "W"), 22, 12.0, change=without(9.5, 26))
    d.want(TURN, "not pass", "The oncoming car vanishes from the record when it is two seconds off.")
    out.append(d)

    d = Drive("gb_tee_blocks_side_road_l", c.xml, 36)
    d.ego(c.way("W", "E"), 102, [(0, 8), (4, 8), (10, 0), (24, 0), (28, 5)])
    d.add("q", "bus", c.way("W", "E"), 160.0, [(0, 5), (4, 0), (22.5, 0), (26, 5)])
    d.add("q2", "car", c.way("S", "E"), 142, 0.0)
    d.want("ukhc.r151.side-roads-clear", "fail", "It stands in the mouth of the side road for 14 s behind a bus.")
    out.append(d)
    return out


def stops() -> list[Drive]:
    """Stop signs."""
    out = []
    c = Cross("gb", TEE, turn=1.1)
    c.stop("S", kind=("601.1", "gb"))
    d = Drive("gb_stop_sign_rolls_over_l", c.xml, 26)
    d.ego(c.way("S", "W"), 90, [(0, 9), (3, 9), (8, 1.2), (9.5, 1.2), (13, 6)], lamps=LEFT)
    d.want(STOP, "fail", "It rolls over the line at walking pace and never stands.")
    out.append(d)

    d = Drive("gb_stop_sign_stands_behind_another_only_l", c.xml, 34)
    d.ego(c.way("S", "W"), 90, [(0, 9), (3, 9), (6.7, 0), (12, 0), (15, 4), (19, 4)], lamps=LEFT)
    d.add("first", "car", c.way("S", "W"), 145.5, [(0, 0), (11, 0), (14, 6)])
    d.want(STOP, "fail", "It stood 13 m off as the second in the queue, and goes over the line at 4 m/s.")
    out.append(d)

    d = Drive("gb_stop_sign_halts_l", c.xml, 30, hz=20.0)
    d.ego(c.way("S", "W"), 92.0, [(0, 9), (3, 9), (9, 0), (12, 0), (15, 5)], lamps=LEFT)
    d.want(STOP, "pass", "It halts just before the line for three seconds.")
    out.append(d)

    d = Drive("gb_stop_sign_halts_beyond_the_line_l", c.xml, 30)
    d.ego(c.way("S", "W"), 95.6, [(0, 9), (3, 9), (9, 0), (12, 0), (15, 5)], lamps=LEFT)
    d.want(STOP, "fail", "Its first halt is 2.8 m beyond the line.")
    out.append(d)
    return out


def boxes() -> list[Drive]:
    """Queues in junctions, and other ways of being in the way."""
    out = []
    c = Cross("gb", FOUR, turn=-1.0, reach=15.0)
    d = Drive("gb_cross_no_lights_stands_in_it_l", c.xml, 36)
    d.ego(c.way("S", "N"), 76, [(0, 9), (7, 9), (13, 0.0), (25, 0), (29, 5)])
    d.add("q", "truck", c.way("S", "N"), 178.0, [(0, 0), (24, 0), (28, 5)])
    d.want("ukhc.r151.side-roads-clear", "fail", "It stands in the middle of the junction for 12 s behind a lorry.")
    out.append(d)

    s = street("gb", (Lane("driving", 3.4, "none"),), (Lane("driving", 3.4, "none"),), kind="town", speed=(30, "mph"))
    d = Drive("gb_map_ends_soon_in_town_l", s.xml, 30)
    d.ego(s.way(1), 680, 14.9)
    d.want("ukhc.r124.speed-limit", "fail", "It drives at 33 mph where 30 are allowed, until and after the map ends.")
    out.append(d)
    return out
