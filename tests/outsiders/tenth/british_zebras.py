"""Great Britain: zebras."""

from __future__ import annotations

from tests.outsiders.tenth.actors import noise
from tests.outsiders.tenth.drive import Drive
from tests.outsiders.tenth.streets import zebra

ON = "ukhc.r195.zebra-on"
STILL = "ukhc.r191.no-stopping"
CUT = "ukhc.r191.crossing-overtake"


def british_zebras() -> list[Drive]:
    return [*zebras(), *more_zebras()]


def zebras() -> list[Drive]:
    """One lane each way."""
    out = []
    s = zebra(start=(12.0, -40.0, 0.7))
    d = Drive("gb_zebra_walker_nearly_over_l", s.xml, 18)
    d.ego(s.way(1), 40, 10.0, -0.15)
    d.add("bus", "bus", s.way(-1), 150, 0.0)
    d.add("w", "pedestrian", s.walk(150.4, -5, 6), 0, [(0, 0), (4.75, 0), (5.15, 1.4)])
    d.want(ON, "fail", "The walker is still on the ego's half when its front comes onto the zebra at 10 m/s.")
    d.want("criticality.pet", "fail", "The walker has left the ego's way for a fifth of a second only.")
    out.append(d)

    s = zebra(start=(0.0, 0.0, 2.2))
    d = Drive("gb_zebra_half_way_wait_l", s.xml, 24)
    d.ego(s.way(1), 20, 9.0)
    d.add(
        "w",
        "pedestrian",
        s.walk(150, -5, 6),
        0,
        [(0, 0), (3, 0), (3.4, 1.4), (6.0, 1.4), (6.4, 0), (17.5, 0), (17.9, 1.3)],
    )
    d.want(ON, "not fail", "The walker stands in the other half, as on an island, from long before the ego passes.")
    out.append(d)

    s = zebra(start=(0.0, 0.0, -1.0))
    d = Drive("gb_zebra_stops_two_metres_on_it_l", s.xml, 22)
    d.ego(s.way(1), 62.8, [(0, 9.0), (7.46, 9.0), (11.46, 0.0), (17, 0.0), (20, 5.0)])
    d.add("w", "pedestrian", s.walk(151.2, 5, -6), 0, [(0, 0), (8.2, 0), (8.6, 1.2)])
    d.want(ON, "fail", "Its front goes 1 m and more over the zebra's edge while the walker is on its half.")
    d.want(STILL, "not fail", "It stands there for somebody in its way.")
    out.append(d)

    s = zebra(start=(5.0, 5.0, 0.2))
    d = Drive("gb_zebra_waits_goes_behind_walker_l", s.xml, 26)
    d.ego(s.way(1), 55.5, [(0, 9.0), (7.8, 9.0), (12.0, 0.0), (15.0, 0.0), (18.0, 5.0)])
    d.add("w", "pedestrian", s.walk(150, 5, -7), 0, [(0, 0), (9.0, 0), (9.4, 1.3)])
    d.want(ON, "pass", "The ego stands before the zebra and goes when the walker has left its half.")
    d.want("ukhc.no-collision", "pass", "Nobody is touched.")
    out.append(d)

    s = zebra(own=2, other=0, start=(-80.0, 0.0, 0.4))
    d = Drive("gb_zebra_one_way_overtakes_in_zigzag_l", s.xml, 20)
    d.ego(s.way(1), 48, 11.0)
    d.add("slow", "van", s.way(2), 90.0, 5.8)
    d.want(CUT, "fail", "It gets past a moving van within the 18 m before the crossing.")
    out.append(d)

    s = zebra(own=2, other=0, start=(-80.0, 0.0, 3.0))
    d = Drive("gb_zebra_one_way_past_one_that_gives_way_l", s.xml, 20)
    d.ego(s.way(1), 40, 8.5)
    d.add("kind", "car", s.way(2), 87, [(0, 8), (4, 8), (9, 0), (16, 0), (19, 6)])
    d.add("w", "pedestrian", s.walk(150, 8.4, -4), 0, [(0, 0), (8.6, 0), (9.0, 1.0)])
    d.want(CUT, "fail", "It goes past a car that has stopped to let somebody over.")
    d.want(ON, "not pass", "Somebody is on the zebra when it comes onto it.")
    out.append(d)

    s = zebra(width=3.6, start=(0.0, 90.0, 0.0))
    d = Drive("gb_zebra_past_parked_van_l", s.xml, 20)
    d.ego(s.way(1), 40, 8.0, [(0, 0), (7, 0), (10.0, -2.3), (12.2, -2.3), (15.5, 0)])
    d.add("parked", "van", s.way(1), 134, 0.0, 0.7)
    d.want(CUT, "not fail", "A parked vehicle may be passed before a crossing.")
    d.want("ukhc.r163.obstruction-give-way", "not fail", "Nobody comes the other way.")
    out.append(d)

    s = zebra(start=(0.0, 0.0, -2.4), long=4.5)
    d = Drive("gb_zebra_stands_on_it_to_look_at_map_l", s.xml, 30)
    d.ego(s.way(1), 70, [(0, 8.0), (8.0, 8.0), (12.0, 0.0), (23.5, 0.0), (26.0, 5.0)])
    d.want(STILL, "fail", "It stands on the zebra for 11 s with nobody in its way.")
    out.append(d)

    s = zebra(start=(0.0, 0.0, -0.4))
    d = Drive("gb_zebra_queue_end_on_it_l", s.xml, 32)
    d.ego(s.way(1), 70, [(0, 8.0), (8.0, 8.0), (12.0, 0.0), (22.5, 0.0), (26.0, 5.0)])
    d.add("lead", "car", s.way(1), 157.5, [(0, 0), (21.5, 0), (25, 5)])
    d.want("ukhc.r192.keep-clear", "fail", "It stands on the zebra for 10 s behind a car, 3 m off.")
    d.want(STILL, "not fail", "It stands in a queue.")
    out.append(d)
    return out


def more_zebras() -> list[Drive]:
    """Records that are not so good, and odd places."""
    out = []
    s = zebra(start=(30.0, 0.0, 0.9))
    d = Drive("gb_zebra_somebody_of_no_class_l", s.xml, 18)
    d.ego(s.way(1), 40, 10.0, 0.2)
    d.add("who", None, s.walk(150, 5.5, -5), 0, [(0, 0), (7.35, 0), (7.65, 1.6)], size=(0.5, 0.5, None))
    d.want(ON, "not pass", "Somebody of no known class is on the ego's half of the zebra.")
    out.append(d)

    s = zebra(start=(0.0, 0.0, 0.3), kind="plain")
    d = Drive("gb_crossing_of_no_kind_l", s.xml, 18)
    d.ego(s.way(1), 44, 10.0, -0.2)
    d.add("w", "pedestrian", s.walk(150, -5, 6), 0, [(0, 0), (4.4, 0), (4.8, 1.4)])
    d.want(ON, "not pass", "Somebody is on the ego's half of a crossing of which the map does not say what it is.")
    out.append(d)

    s = zebra(start=(300.0, 10.0, 2.8))
    d = Drive("gb_zebra_two_hertz_walker_on_it_l", s.xml, 20, hz=2.0)
    d.ego(s.way(1), 33.2, 9.6, -0.2)
    d.add("w", "pedestrian", s.walk(149.5, -4.5, 7), 0, [(0, 0), (5.75, 0), (6.15, 1.25)])
    d.want(ON, "fail", "The walker is on the ego's half when its front comes onto the zebra, and for a moment longer.")
    out.append(d)

    s = zebra(start=(0.0, 0.0, 0.1), own=2, other=2)
    d = Drive("gb_zebra_four_lanes_trembling_recorder_l", s.xml, 22)
    d.ego(s.way(2), 30, 11.0, change=noise(5))
    d.add("w", "pedestrian", s.walk(150, -8.5, 9), 0, [(0, 0), (2.6, 0), (3.0, 1.35)], change=noise(6))
    d.want(ON, "fail", "The walker is on the ego's side of a four lane zebra when it drives onto it.")
    out.append(d)

    s = zebra(start=(0.0, 0.0, 2.1))
    d = Drive("gb_zebra_walker_appears_on_it_l", s.xml, 18)
    d.ego(s.way(1), 40, 10.5, -0.2)
    d.add("w", "pedestrian", s.walk(150, 2.9, 9), 0, [(0, 0), (10.0, 0), (10.4, 1.2)], span=(9.0, 18.0))
    d.want(ON, "fail", "A walker, seen a second and more before, is on the ego's half when it comes onto the zebra.")
    out.append(d)
    return out
