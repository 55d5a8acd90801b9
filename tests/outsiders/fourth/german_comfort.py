"""Germany: how gently it drives, and how close it comes to others."""

from __future__ import annotations

import math

from tests.outsiders.fourth.drive import Drive
from tests.outsiders.fourth.faults import noise
from tests.outsiders.fourth.movement import Actor, east, ego, slow, way
from tests.outsiders.fourth.places import GENTLE, V50, V100, L
from tests.outsiders.fourth.worlds import BEND, bend, bridge, crossroads, two_lane


def german_comfort() -> list[Drive]:
    rural, town = two_lane("rural", V100), two_lane("town", V50, walk=True)
    queue_at = 245.5  # where the centre of a car stands that ends a queue
    late = slow(queue_at - 9.5 - 2, 25.0, 0.0, 8.5)
    across = crossroads(V50, "wesn")
    up = way(1.75, -80, math.pi / 2)
    return [
        Drive(
            "de_races_away",
            "A driver starts with 5.5 m/s2.",
            "fail comfort.accel-iso15622 comfort.nuplan | pass stvo.rg3",
            town,
            [ego(way(50, L), 0.0, 3.0, (13.0, 5.5))],
            15.0,
        ),
        Drive(
            "de_drives_gently",
            "A driver slows and speeds up gently on an empty road.",
            "pass comfort.accel-iso15622 comfort.decel-iso15622 comfort.jerk-iso15622 comfort.lateral comfort.nuplan "
            "stvo.rg3",
            rural,
            [ego(way(0, L), 20.0, *GENTLE)],
            25.0,
        ),
        Drive(
            "de_gentle_at_2hz",
            "A driver slows and speeds up gently; the log has two steps a second.",
            "not fail comfort.accel-iso15622 comfort.decel-iso15622 comfort.jerk-iso15622 comfort.lateral "
            "comfort.nuplan",
            rural,
            [ego(way(0, L), 20.0, *GENTLE)],
            25.0,
            rate=2.0,
        ),
        Drive(
            "de_gentle_trembling",
            "A driver slows and speeds up gently; the log has 5 cm of noise on the positions.",
            "not fail comfort.accel-iso15622 comfort.decel-iso15622 comfort.jerk-iso15622 comfort.lateral "
            "comfort.nuplan stvo.rg3",
            rural,
            [ego(way(0, L), 20.0, *GENTLE)],
            25.0,
            faults=[noise(0.05, 7)],
        ),
        Drive(
            "de_bend_too_fast_4",
            "A car takes a bend of 62 m radius at 16 m/s.",
            "fail comfort.lateral | not fail comfort.nuplan | pass stvo.rg3",
            bend(),
            [ego(BEND, 16.0)],
            18.0,
        ),
        Drive(
            "de_bus_bend_too_fast",
            "A bus takes a bend of 62 m radius at 13.2 m/s.",
            "fail comfort.lateral | pass stvo.rg3",
            bend(),
            [ego(BEND, 13.2, kind="bus")],
            20.0,
        ),
        Drive(
            "de_brakes_late_for_queue",
            "A driver brakes with 8.5 m/s2 and stops 2 m behind a standing car.",
            "fail criticality.drac criticality.ttc criticality.ttb comfort.decel-iso15622 | pass no-collision",
            rural,
            [ego(way(5, L), 25.0, *late), east("queue", "car", queue_at, L, 0.0)],
        ),
        Drive(
            "de_brakes_early_for_queue",
            "A driver brakes with 1.5 m/s2 and stops 3 m behind a standing car.",
            "pass criticality.drac criticality.ttc criticality.ttb | not fail criticality.thw criticality.mttc",
            rural,
            [ego(way(5, L), 22.0, *slow(queue_at - 12.5, 22.0, 0.0, 1.5)), east("queue", "car", queue_at, L, 0.0)],
            25.0,
        ),
        Drive(
            "de_creeps_in_queue",
            "A driver creeps at 3 m/s 1.8 m behind another whose kind the log does not know.",
            "not fail criticality.thw criticality.ttc criticality.drac",
            town,
            [ego(way(50, L), 3.0), east("lead", None, 56.3, L, 3.0)],
        ),
        Drive(
            "de_under_bridge",
            "A driver goes under a bridge at the moment at which a car crosses above.",
            "not fail criticality.pet no-collision criticality.ttc | pass stvo.rg3",
            bridge(V100),
            [ego(way(80, L), 22.0), Actor("above", "car", way(301.75, -221.75, math.pi / 2), 22.0, z=7.0)],
        ),
        Drive(
            "de_crosses_close_behind",
            "A driver crosses half a second behind a car on the other road.",
            "fail criticality.pet | pass no-collision",
            across,
            [ego(up, 8.0), east("crossing", "car", 4.9 - 12 * 8.89, L, 12.0)],
        ),
        Drive(
            "de_crosses_long_after",
            "A driver crosses four seconds behind a car; the log has two steps a second.",
            "pass criticality.pet no-collision",
            across,
            [ego(up, 8.0), east("crossing", "car", 4.9 - 12 * 5.39, L, 12.0)],
            rate=2.0,
        ),
    ]
