"""Germany: a system that drives by itself on a motorway."""

from __future__ import annotations

import math

from tests.outsiders.third.cast import SLOW_1, SLOW_2
from tests.outsiders.third.drive import Drive, draw
from tests.outsiders.third.maps import motorway
from tests.outsiders.third.movement import KMH, car, ego, who
from tests.outsiders.third.ways import EAST


def german_systems() -> list[Drive]:
    change = [(6, SLOW_1), (10, SLOW_2)]
    fast = 120 * KMH
    return [
        draw(
            "de_cuts_in_left",
            "The ego moves left close before a much faster car.",
            "fail stvo.rg6 alks-r157.r79.lane-change",
            motorway(2, math.inf),
            [
                ego(EAST, (0, 0), 25, [(3, SLOW_1), (6, SLOW_2)], blink=((2.5, 6.0, "far"),)),
                car(EAST, (3, 75 - 42), [(0, 38), (3.4, 38), (7, 23)], SLOW_2),
            ],
            12,
            engaged="yes",
        ),
        draw(
            "de_changes_properly",
            "The ego signals for four seconds, changes left and passes a lorry.",
            "pass stvo.rg6 stvo.rg3 alks-r157.r79.lane-change no-collision | not fail stvo.ri2",
            motorway(2, fast),
            [
                ego(EAST, (0, 0), 30, change, blink=((3.2, 10.0, "far"),)),
                who("lorry", "truck", EAST, (0, 160), 22, SLOW_1),
                car(EAST, (0, -90), 30, SLOW_2),
            ],
            26,
            engaged="yes",
        ),
        draw(
            "de_brakes_undeclared",
            "The ego brakes with 8 m/s2 for a stopping car and declares no emergency.",
            "fail alks-r157.emergency comfort.decel-iso15622 comfort.nuplan | not fail stvo.rg2",
            motorway(2, fast),
            [
                ego(EAST, (0, 0), [(0, 28), (5, 28), (8.4, 0.8), (9, 0)], SLOW_1),
                car(EAST, (0, 55), [(0, 28), (4, 28), (7.5, 0)], SLOW_1),
            ],
            14,
            events=[(0, "engaged", "on"), (0, "emergency_manoeuvre", "off")],
        ),
        draw(
            "de_hard_minimal_risk",
            "In a minimal risk manoeuvre the ego brakes with 6 m/s2, without hazard lights.",
            "fail alks-r157.mrm alks-r157.mrm-hazards",
            motorway(2, fast),
            [ego(EAST, (0, 0), [(0, 28), (4, 28), (8.7, 0)], SLOW_1)],
            14,
            events=[(0, "engaged", "on"), (0, "minimal_risk_manoeuvre", "off"), (3.5, "minimal_risk_manoeuvre", "on")],
        ),
        draw(
            "de_ignores_cut_in",
            "A car moves in slowly at 40 m and the ego runs into it without braking.",
            "fail alks-r157.cut-in no-collision criticality.ttc",
            motorway(2, fast),
            [
                ego(EAST, (0, 0), 16, SLOW_1),
                car(EAST, (0, 60), 8, [(1, SLOW_2), (5, SLOW_1)], blink=((0.0, 5.0, "near"),)),
            ],
            7.4,
            events=[(0, "engaged", "on")],
        ),
    ]
