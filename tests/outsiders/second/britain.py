"""Great Britain, left-hand traffic."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from tests.outsiders.second.drive import MOTORWAY, Drive
from tests.outsiders.second.movement import FAR, NEAR, Actor, Knots, Line, across, bike, ego, truck, walker
from tests.outsiders.second.road import sign
from tests.outsiders.second.worlds import World, bridge, crossroads, lane, motorway, motorway_exit, straight, town

Events = Sequence[tuple[float, str, str]]


def british() -> list[Drive]:
    rural, street = straight(-1, ("60", "mph")), town(-1)
    way70 = motorway(-1, ("70", "mph"))
    one, two, three = lane(1), lane(2), lane(3)
    zebra, pelican = town(-1, zebra=True), town(-1, light=True)
    cross, stop, lit = crossroads(-1), crossroads(-1, control="206"), crossroads(-1, control="light")
    ban = straight(-1, ("60", "mph"), signals=sign(30, 100, -4, -1, "276"))
    double = straight(-1, ("60", "mph"), middle=[(0, "solid solid")])
    soon_double = straight(-1, ("60", "mph"), middle=[(0, "broken"), (430, "solid solid")])
    drop = straight(-1, None)
    drop.roads[0].limits = [(0, "60", "mph"), (500, "30", "mph")]
    above, leaving = bridge(-1), motorway_exit(-1)
    horse: dict[str, Any] = {"kind": "animal", "size": (2.4, 0.7, 2.4)}
    towing = MOTORWAY | {"vehicle_class": "car_towing"}

    def gb(name: str, world: World, *actors: Actor, seconds: float = 20, events: Events = (), **more: Any) -> Drive:
        extra: dict[str, Any] = {key: more.pop(key) for key in ("rate", "noise", "lights") if key in more}
        return Drive("gb_" + name, world, actors, seconds, more, events, **extra)

    def trailer(at: tuple[float, float], v: Knots, u: Knots) -> Actor:
        return Actor("caravan", (at[0], at[1] - 5.6), v, u, kind="trailer", size=(5.0, 2.2, 2.4))

    out_and_back = [(3.3, NEAR), (6.3, FAR), (9.2, FAR), (11.5, NEAR)]
    turn_speed = [(0, 9), (4, 9), (6.5, 5.5), (20, 5.5)]
    return [
        gb("tailgates_60", rural, ego((0, 50), 26), Actor("lead", (0, 62.5), 26)),
        gb(
            "queue_rolls",
            street,
            ego((0, 50), [(0, 0), (2, 0), (5, 2), (14, 2), (16, 0), (25, 0)]),
            Actor(
                "van",
                (0, 58),
                [(0, 0), (1.5, 0), (4.5, 2), (13.5, 2), (15.5, 0), (25, 0)],
                kind="van",
                size=(5, 2, 2.2),
            ),
            seconds=25,
        ),
        gb("tailgates_2hz", rural, ego((0, 50), 26), Actor("lead", (0, 60.5), 26), rate=2),
        gb(
            "noisy_queue",
            street,
            ego((0, 50), 0),
            Actor("ahead", (0, 56.0), 0),
            Actor("behind", (0, 44.0), 0),
            noise=0.05,
        ),
        gb(
            "cut_in_never_dropped_back",
            way70,
            ego((0, 50), 30, one),
            Actor("cutter", (0, 66.5), 30, [(3, two), (6, one)]),
            seconds=25,
        ),
        gb(
            "cut_in_dropped_back",
            way70,
            ego((4.5, 200), [(0, 29), (5, 29), (9, 26), (20, 26)], one),
            Actor("cutter", (4.5, 226.5), 31, [(3, two), (6, one)]),
            seconds=22,
        ),
        gb(
            "cut_in_then_vanishes",
            way70,
            ego((0, 50), 30, one),
            Actor("cutter", (0, 66.5), 30, [(3, two), (6, one)], there=(-1, 9)),
            seconds=22,
        ),
        gb("forty_in_thirty", street, ego((0, 50), 18)),
        gb("hundred_unknown_limit", straight(-1, None), ego((0, 50), 45)),
        gb("caravan_right_lane", way70, ego((0, 50), 26, three), trailer((0, 50), 26, three), **towing),
        gb(
            "hard_shoulder",
            way70,
            ego((0, 50), 15, lane(0)),
            *[Actor(f"q{n}", (0, 100 + 30.0 * n), 5, one) for n in range(4)],
            **MOTORWAY,
        ),
        gb(
            "hard_shoulder_breakdown",
            way70,
            ego(
                (0, 50),
                [(0, 25), (4, 25), (16, 0), (28, 0)],
                [(5, one), (10, lane(0))],
                lamp=((0, "off"), (3.5, "left"), (11, "hazard")),
            ),
            seconds=28,
            **MOTORWAY,
        ),
        gb("motorway_stop", way70, ego((0, 100), [(0, 22), (4, 22), (12, 0), (28, 0)], one), seconds=28, **MOTORWAY),
        gb("hazards_in_town", street, ego((0, 50), 12, lamp=((0, "hazard"),))),
        gb("night_lit", street, ego((0, 50), 12), light="night", events=((0.0, "headlights", "off"),)),
        gb(
            "horn_standing",
            street,
            ego((0, 50), 0, -2.4),
            seconds=15,
            events=((0.0, "horn", "off"), (8.0, "horn", "on"), (9.5, "horn", "off")),
        ),
        gb(
            "zebra_not_given",
            zebra,
            ego((8, 296.25), 10),
            walker("walker", (7.9, -3.0), [(0, 1.3), (7.2, 1.3), (7.9, 0), (10, 0), (11, 1.3)], across(300, -1)),
            seconds=16,
        ),
        gb(
            "zebra_given",
            zebra,
            ego((8, 294.5), [(0, 10), (2, 10), (7, 0), (13, 0), (17, 9), (20, 9)]),
            walker("walker", (9, 0), [(0, 1.2), (20, 1.2)], across(300, -1)),
        ),
        gb(
            "zebra_overtaking",
            zebra,
            ego((9, 296.25), 9, [(4, NEAR), (6.5, FAR), (10.5, FAR), (13, NEAR)]),
            Actor("waiting", (6, 294), [(0, 8), (1, 8), (5, 0), (18, 0)]),
            walker("walker", (9, -1.0), [(0, 1.2), (8.3, 1.2), (9, 0), (11, 0), (12, 1.2)], across(300, -1)),
            seconds=16,
        ),
        gb("zebra_parked_on", zebra, ego((10, 300), [(0, 8), (2, 8), (7, 0), (19, 0), (23, 8)]), seconds=24),
        gb(
            "zebra_blocked_by_queue",
            zebra,
            ego((10, 300), [(0, 8), (2, 8), (7, 0), (18, 0), (22, 6), (24, 6)]),
            Actor("ahead", (10, 307), [(0, 8), (1, 8), (6, 0), (16.5, 0), (20.5, 7), (24, 7)]),
            Actor("further", (10, 315), [(0, 8), (5, 0), (15, 0), (19, 8), (24, 8)]),
            seconds=24,
        ),
        gb(
            "light_red",
            pelican,
            ego((8, 293.25), 10),
            walker("walker", (8, 1.5), 1.2, across(300, -1)),
            seconds=16,
            lights={"10": ((0.0, "red"),)},
        ),
        gb(
            "light_green_still_crossing",
            pelican,
            ego((8.3, 296.25), 9),
            walker("slow", (8.2, -3.0), [(0, 0.7), (7.5, 0.7), (8.2, 0), (10, 0), (11, 0.7)], across(300, -1)),
            seconds=16,
            lights={"10": ((0.0, "red"), (5.0, "green"))},
        ),
        gb("stop_sign_kept", stop, ego((7.5, -3.75), [(0, 10), (7, 0), (9, 0), (13, 8), (20, 8)])),
        gb(
            "stop_sign_second_in_queue",
            stop,
            ego((8, -10.5), [(0, 8), (7, 0), (12, 0), (15, 3.5), (20, 4)]),
            Actor("first", (8, -3.6), [(0, 8), (6, 0), (10, 0), (14, 8), (20, 8)]),
        ),
        gb(
            "side_road_blocked",
            cross,
            ego((10, 12.5), [(0, 7), (3, 7), (8, 0), (19, 0), (24, 5)]),
            Actor("ahead", (10, 20), [(0, 7), (2, 7), (7, 0), (17.5, 0), (22, 6)]),
            Actor("further", (10, 27), [(0, 7), (1, 7), (6, 0), (16, 0), (21, 7)]),
            seconds=24,
        ),
        gb(
            "right_turn_before_oncoming",
            cross,
            ego((6, 12.5), [(0, 8), (3, 5), (15, 5)], line=cross.way["WS"], lamp=((0, "right"), (8, "off"))),
            Actor("oncoming", (7.0, 8.75), 12, line=cross.way["EW"]),
            seconds=15,
        ),
        gb(
            "right_turn_corner_cut",
            cross,
            ego(
                (6, 12.5),
                [(0, 8), (3, 5), (15, 5)],
                [(3.2, NEAR), (6, 1.2), (8.5, 1.2), (12, NEAR)],
                line=cross.way["WS"],
                lamp=((0, "right"), (8, "off")),
            ),
            seconds=15,
        ),
        gb(
            "left_turn_across_cyclist",
            cross,
            ego((8, 10.5), turn_speed, -1.5, line=cross.way["WN"], lamp=((0, "left"), (10, "off"))),
            bike("cyclist", (9.2, 5.6), 5, -3.2, line=cross.way["WE"]),
            seconds=15,
        ),
        gb(
            "left_turn_before_walker",
            cross,
            ego((9, 24.4), [(0, 9), (4, 5), (15, 5)], line=cross.way["WN"], lamp=((0, "left"), (10, "off"))),
            walker("walker", (9.9, 5.5), 1.3, Line((5, 15, math.pi), [])),
            seconds=15,
        ),
        gb(
            "left_turn_wide",
            cross,
            ego(
                (6, 0),
                [(0, 8), (4, 5), (18, 5)],
                [(6, NEAR), (9.5, -0.4), (10.5, -0.4), (13, NEAR)],
                line=cross.way["WN"],
            ),
            seconds=18,
        ),
        gb(
            "overtake_oncoming_near",
            rural,
            ego((4, 200), 24, out_and_back),
            truck("lorry", (4, 226), 15, size=(8.0, 2.4, 3.2)),
            Actor("oncoming", (11.6, 382.4), [(0, -26), (8.5, -26), (11.5, -11), (16, -11)], FAR, facing=-1),
            seconds=16,
        ),
        gb(
            "overtake_clear",
            rural,
            ego((4, 200), 24, [(4, NEAR), (7, FAR), (12, FAR), (15, NEAR)]),
            truck("lorry", (4, 245), 15, size=(8.0, 2.4, 3.2)),
            Actor("oncoming", (4, 1200), -22, FAR, facing=-1),
        ),
        gb(
            "overtake_double_white",
            double,
            ego((4, 200), 26, [(3.4, NEAR), (6.4, FAR), (11, FAR), (14, NEAR)]),
            Actor("slower", (4, 230), 20),
        ),
        gb(
            "double_white_slow_cyclist",
            double,
            ego((5, 200), 10, [(4, NEAR), (7, 0.3), (13, 0.3), (16, NEAR)]),
            bike("cyclist", (5, 235), 3),
        ),
        gb(
            "back_too_late",
            soon_double,
            ego((4, 300), 24, [(3.5, NEAR), (6.5, FAR), (12, FAR), (15, NEAR)]),
            Actor("slower", (4, 330), 17),
        ),
        gb(
            "no_overtaking_sign",
            ban,
            ego((4, 200), 26, [(3.4, NEAR), (6.4, FAR), (11, FAR), (14, NEAR)]),
            Actor("slower", (4, 230), 19),
        ),
        gb(
            "pulls_out_before_overtaker",
            rural,
            ego((5, 250), 20, [(4.5, NEAR), (7.5, FAR), (13, FAR), (16, NEAR)]),
            Actor("slower", (5, 280), 14),
            Actor("overtaker", (5, 226), [(0, 29), (5, 29), (7.5, 19), (20, 19)], [(0, FAR), (20, FAR)]),
        ),
        gb(
            "speeds_up_when_overtaken",
            rural,
            ego((0, 200), [(0, 18), (6, 18), (11, 24), (20, 24)]),
            Actor("overtaker", (0, 160), 25, [(1, NEAR), (4, FAR), (15, FAR), (18, NEAR)]),
        ),
        gb("horse_fast_and_close", rural, ego((0, 50), 12, -0.8), Actor("horse", (0, 150), 1.6, -3.0, **horse)),
        gb(
            "parked_car_forces_oncoming",
            street,
            ego((8, 290), 8, [(5, NEAR), (7.2, 0.9), (10.5, 0.9), (13, NEAR)]),
            Actor("parked", (0, 300), 0, -2.6),
            Actor("oncoming", (12, 342), [(0, -12), (7.5, -12), (11, 0), (15, 0), (19, -8)], FAR, facing=-1),
        ),
        gb(
            "astride",
            way70,
            ego((0, 50), 28, [(3, one), (5, (one + two) / 2), (20, (one + two) / 2), (22, one)]),
            seconds=25,
            **MOTORWAY,
        ),
        gb("wrong_side", rural, ego((0, 50), 20, FAR), seconds=25),
        gb(
            "along_the_footway",
            street,
            ego((5, 100), 9, [(4, NEAR), (7, -4.4), (12, -4.4), (15, NEAR)]),
            Actor("queue", (0, 145), 0),
        ),
        gb(
            "onto_a_drive",
            town(-1),
            ego(
                (14, 100),
                [(0, 8), (4, 8), (9, 2), (20, 2), (24, 0)],
                line=Line((0, 0, 0), [(100, 0), (6 * math.pi / 2, 1 / 6)]),
            ),
            seconds=25,
        ),
        gb(
            "rear_end",
            rural,
            ego((8, 296.0), [(0, 18), (6, 18), (9, 5), (15, 5)]),
            Actor("standing", (0, 300), 0),
            seconds=8.4,
        ),
        gb(
            "bump_that_the_boxes_miss",
            rural,
            ego((8, 200), [(0, 14), (8, 14), (8.1, 10), (12, 6)]),
            Actor("hit", (8, 204.7), [(0, 13.5), (4, 13.5), (7.8, 9), (8, 9), (8.1, 13), (12, 8)]),
            seconds=14,
        ),
        gb(
            "under_a_bridge",
            above,
            ego((8, 300), 20),
            truck("above", (8, 0), 15, line=above.way["above"], ground=7.0),
            seconds=15,
        ),
        gb(
            "reverses_unrecorded",
            street,
            ego((0, 100), [(0, 0), (4, 0), (6, -1.5), (11, -1.5), (13, 0), (18, 0)]),
            seconds=18,
        ),
        gb(
            "motorway_reverse_only",
            way70,
            ego((0, 300), [(0, 0), (3, 0), (5, -3), (16, -3)], one),
            Actor("beside", (0, 100), 28, two),
            seconds=16,
            **MOTORWAY,
        ),
        gb(
            "green_into_standing_queue",
            lit,
            ego((12, 12.0), [(0, 8), (4, 8), (10, 0), (24, 0), (29, 5)]),
            Actor("ahead", (0, 20), [(0, 0), (22, 0), (27, 6), (30, 6)]),
            Actor("further", (0, 27), [(0, 0), (20, 0), (25, 7), (30, 7)]),
            seconds=29,
            lights={str(10 * n): ((0.0, "green" if n in (1, 3) else "red"),) for n in range(1, 5)},
        ),
        gb(
            "cyclist_drew_up",
            street,
            ego((0, 100), [(0, 0), (16, 0), (21, 3), (26, 3)]),
            Actor("ahead", (0, 108), [(0, 0), (14, 0), (18, 5), (26, 5)]),
            bike("cyclist", (10, 100.5), [(0, 4), (5, 4), (9, 0), (15, 0), (19, 4), (26, 5)], -3.2),
            seconds=26,
        ),
        gb(
            "hard_shoulder_with_hazards",
            way70,
            ego(
                (0, 50),
                [(0, 25), (4, 25), (16, 0), (28, 0)],
                [(5, one), (10, lane(0))],
                lamp=((0, "off"), (3.5, "hazard")),
            ),
            seconds=28,
            **MOTORWAY,
        ),
        gb(
            "reverses_to_park",
            street,
            ego(
                (0, 60),
                [(0, 7), (3, 7), (8, 0), (10, 0), (12, -1.2), (17, -1.2), (19, 0), (24, 0)],
                [(12, NEAR), (17, -2.2)],
            ),
            Actor("parked", (0, 104), 0, -2.5),
            seconds=24,
        ),
        gb(
            "exit_unsignalled",
            leaving,
            ego((0, 20), 26, [(9, 1.875), (14, -1.875)], line=leaving.way["off"]),
            seconds=30,
            **MOTORWAY,
        ),
        gb(
            "exit_unsignalled_early",
            leaving,
            ego((0, 20), 26, [(6, 1.875), (11, -1.875)], line=leaving.way["off"]),
            seconds=30,
            **MOTORWAY,
        ),
        gb(
            "exit_signalled",
            leaving,
            ego(
                (0, 20),
                26,
                [(9, 1.875), (14, -1.875)],
                line=leaving.way["off"],
                lamp=((0, "off"), (5, "left"), (25, "off")),
            ),
            seconds=30,
            **MOTORWAY,
        ),
        gb(
            "signals_exit_and_goes_on",
            leaving,
            ego((0, 20), 26, 1.875, lamp=((0, "off"), (8, "left"), (24, "off"))),
            seconds=30,
            **MOTORWAY,
        ),
        gb(
            "parked_against_the_flow",
            street,
            ego((10, 100), [(0, -8), (3, -8), (10, 0), (78, 0)], [(3, FAR), (8, -2.4)], facing=-1),
            seconds=78,
        ),
    ]
