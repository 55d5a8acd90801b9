"""Germany, right-hand traffic."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tests.outsiders.second.drive import MOTORWAY, Drive
from tests.outsiders.second.movement import FAR, KMH, NEAR, TRUCK, Actor, across, bike, ego, truck, walker
from tests.outsiders.second.worlds import World, bend, crossroads, lane, motorway, straight, town

Events = Sequence[tuple[float, str, str]]
AUTO = MOTORWAY | {"engaged": "yes"}
ON = ((0.0, "engaged", "on"),)
LORRY = MOTORWAY | {"vehicle_class": "goods_over_7t5"}


def german() -> list[Drive]:
    free, fast, slow = motorway(1, None), motorway(1, ("120", "km/h")), motorway(1, ("80", "km/h"))
    one, two, three = lane(1), lane(2), lane(3)
    v50 = 50 * KMH
    rural, street = straight(1, ("100", "km/h")), town(1)
    stop = crossroads(1, control="206")
    plain = crossroads(1)
    late = [(0, 25), (5, 25), (8.5, 7), (20, 7)]
    crossed = [(6, one), (10, two)]

    def alks(name: str, *actors: Actor, seconds: float = 20, events: Events = (), world: World = slow) -> Drive:
        return Drive("de_alks_" + name, world, actors, seconds, AUTO, (*ON, *events))

    def way(name: str, *actors: Actor, world: World = free, seconds: float = 20, **more: Any) -> Drive:
        return Drive("de_mway_" + name, world, actors, seconds, MOTORWAY | more)

    def road(name: str, world: World, *actors: Actor, seconds: float = 20, **more: Any) -> Drive:
        return Drive("de_" + name, world, actors, seconds, **more)

    return [
        alks("tailgates", ego((0, 100), v50, one), Actor("lead", (0, 114.5), v50, one), seconds=25),
        alks("follows_well", ego((0, 100), v50, one), Actor("lead", (0, 134.5), v50, one)),
        alks(
            "cut_in_collision",
            ego((4.5, 200), 25, one),
            Actor("cutter", (4.5, 224.5), 18, [(3, two), (6, one)], lamp=((0, "right"),)),
            seconds=7.8,
        ),
        alks(
            "cut_in_braked",
            ego((4.5, 200), [(0, 25), (5, 25), (8, 16), (20, 16)], one),
            Actor("cutter", (4.5, 228.5), 18, [(3, two), (6, one)], lamp=((0, "right"),)),
        ),
        alks(
            "cut_in_gap_kept_short",
            ego((0, 100), v50, one),
            Actor("cutter", (0, 114.5), v50, [(3, two), (6, one)], lamp=((0, "right"),)),
            seconds=27,
        ),
        alks("emergency_undeclared", ego((0, 100), late, one), events=((0.0, "emergency_manoeuvre", "off"),)),
        alks(
            "emergency_declared",
            ego((0, 100), late, one),
            Actor("lead", (0, 150), [(0, 25), (4.4, 25), (7.8, 7), (20, 7)], one),
            events=(
                (0.0, "emergency_manoeuvre", "off"),
                (5.0, "emergency_manoeuvre", "on"),
                (9.0, "emergency_manoeuvre", "off"),
            ),
        ),
        alks(
            "mrm_hard_and_dark",
            ego((0, 100), [(0, 22), (5, 22), (9, 0), (20, 0)], one),
            events=((0.0, "minimal_risk_manoeuvre", "off"), (5.0, "minimal_risk_manoeuvre", "on")),
        ),
        alks(
            "mrm_gentle",
            ego((0, 100), [(0, 20), (5, 20), (15, 0), (22, 0)], one, lamp=((0, "off"), (5.0, "hazard"))),
            seconds=22,
            events=((0.0, "minimal_risk_manoeuvre", "off"), (5.0, "minimal_risk_manoeuvre", "on")),
        ),
        alks("lane_change_unsignalled", ego((0, 100), 25, crossed)),
        alks("lane_change_signalled", ego((0, 100), 22, crossed, lamp=((0, "off"), (3.5, "left"), (10, "off")))),
        alks(
            "lane_change_dawdled",
            ego(
                (0, 100),
                22,
                [(6, one), (9, (one + two) / 2), (17, (one + two) / 2), (20, two)],
                lamp=((0, "off"), (3.5, "left"), (20, "off")),
            ),
            seconds=25,
        ),
        alks("lane_change_lamp_unknown", ego((0, 100), 22, crossed, lamp=None)),
        way("tailgate_120", ego((0, 100), 33, two), Actor("lead", (0, 110.5), 33, two)),
        way("follow_half_speedo", ego((0, 100), 33, two), Actor("lead", (0, 170), 33, two)),
        way(
            "deer",
            ego((3, 190), [(0, 30), (3, 30), (8, 0), (14, 0), (20, 12), (25, 16)], one),
            walker("deer", (5, -14), 1.5, across(285, 1), kind="animal", size=(1.6, 0.5, 1.4)),
            seconds=25,
            world=fast,
        ),
        way("speeding", ego((0, 50), 45, three), world=fast),
        way("crawl", ego((0, 50), 12, one), world=fast, seconds=40),
        way(
            "cuts_out_before_faster",
            ego((6, 300), 25, [(5, one), (9, two)], lamp=((0, "left"),)),
            Actor("faster", (6, 255), [(0, 45), (6, 45), (9, 24), (20, 24)], two),
        ),
        way("stops_for_nothing", ego((0, 100), [(0, 25), (5, 25), (15, 0), (30, 0)], one), seconds=30),
        way(
            "stops_for_queue",
            ego((20, 491.75), [(0, 25), (5, 25), (17, 0), (25, 0)], one),
            Actor("last", (0, 500), 0, one),
            Actor("second", (0, 507), 0, one),
            Actor("beside", (0, 498), 0, two),
            seconds=25,
            world=fast,
        ),
        way(
            "breakdown",
            ego(
                (0, 100),
                [(0, 25), (5, 25), (17, 0), (27, 0)],
                [(6, one), (11, lane(0))],
                lamp=((0, "off"), (4, "hazard")),
            ),
            seconds=27,
        ),
        way("undertakes", ego((0, 100), 33, two), Actor("slower", (0, 150), 27, three)),
        way(
            "queue_passed_on_right",
            ego((0, 100), 12.5, one),
            *[Actor(f"q{n}", (0, 110 + 15.0 * n), 10, two if n % 2 else three) for n in range(6)],
            world=slow,
        ),
        way("reverses", ego((0, 100), [(0, 15), (6, 0), (8, 0), (10, -3), (20, -3)], one)),
        way(
            "wrong_way",
            ego((0, 900), -28, three, facing=-1),
            Actor("one", (0, 200), 28, two),
            Actor("two", (0, 300), 27, one),
        ),
        way("tailgate_heading_turned", ego((0, 100), 33, two, turned=(-1, 99)), Actor("lead", (0, 110.5), 33, two)),
        Drive(
            "de_mway_lorry_30m",
            free,
            [ego((0, 100), 22.2, one, **TRUCK), truck("lead", (0, 146), 22.2, one)],
            20,
            LORRY,
        ),
        Drive(
            "de_mway_lorry_brief_cut_in",
            free,
            [ego((5.5, 200), 22.2, one, **TRUCK), Actor("cutter", (5.5, 250.25), 33, [(4, two), (7, one)])],
            15,
            LORRY,
        ),
        way(
            "lorry_unknown_kind",
            ego((0, 100), 22.2, one, kind=None, size=(16.0, 2.5, 3.8)),
            truck("lead", (0, 141), 22.2, one),
        ),
        way(
            "tailgate_off_the_map",
            ego((0, 50), 33, two),
            Actor("lead", (0, 114.5), [(0, 33), (8.5, 33), (10, 27), (17, 27), (19, 33), (25, 33)], two),
            world=motorway(1, None, length=300),
            seconds=25,
        ),
        road("cyclist_close_town", street, ego((0, 50), 12, -1.0), bike("cyclist", (0, 100), 5)),
        road(
            "cyclist_wide_town",
            street,
            ego((0, 50), 12, [(1, NEAR), (4, 0.1), (10, 0.1), (13, NEAR)]),
            bike("cyclist", (0, 100), 5),
        ),
        road(
            "cyclist_close_rural",
            rural,
            ego((0, 50), 22, [(2, NEAR), (4, -0.4), (8, -0.4), (10, NEAR)]),
            bike("cyclist", (0, 150), 6),
        ),
        road(
            "cyclist_drew_up",
            street,
            ego((0, 100), [(0, 0), (16, 0), (21, 6), (26, 6)]),
            Actor("ahead", (0, 108), [(0, 0), (14, 0), (18, 8), (26, 8)]),
            bike("cyclist", (10, 100.5), [(0, 4), (5, 4), (9, 0), (16, 0), (21, 4), (26, 4)], -3.2),
            seconds=26,
        ),
        road("stop_sign_kept", stop, ego((8, -3.65), [(0, 10), (7, 0), (11.5, 0), (15, 8), (20, 8)])),
        road(
            "late_braking",
            rural,
            ego((12, 293.5), [(0, 20), (6, 20), (9.6, 0), (15, 0)]),
            Actor("standing", (0, 300), 0),
            seconds=15,
        ),
        road(
            "gentle_approach",
            rural,
            ego((18, 290.5), [(0, 20), (5, 20), (17, 0), (22, 0)]),
            Actor("standing", (0, 300), 0),
            seconds=22,
        ),
        road(
            "crossing_half_a_second",
            plain,
            ego((6.6, 7.1), 10),
            Actor("other", (6.0, 16.9), 10, line=plain.way["NS"]),
            seconds=12,
        ),
        road(
            "overtake_into_oncoming",
            rural,
            ego((4, 200), 22, [(3.5, NEAR), (6.5, FAR), (10.5, FAR), (13.5, NEAR)]),
            Actor("tractor", (4, 230), 12, kind="vehicle"),
            Actor("oncoming", (14, 422), -25, FAR, facing=-1),
        ),
        road(
            "no_response",
            rural,
            ego((0, 50), [(0, 25), (11, 25), (16, 10), (24, 10)]),
            Actor("lead", (0, 164.5), [(0, 25), (5, 25), (9, 10), (24, 10)]),
            seconds=24,
        ),
        road("bend_too_fast", bend(1, ("100", "km/h")), ego((0, 20), 24), seconds=15),
        road("noise", rural, ego((0, 50), 20), Actor("lead", (0, 94.5), 20), noise=0.05),
    ]
