"""Keeping to a lane, a side and the road."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from tests.outsiders.first.chapter import Spec, scene
from tests.outsiders.first.maps import RURAL, bridge, urban
from tests.outsiders.first.movement import ahead, car, line, out_and_back
from tests.outsiders.first.road import Lane


def lanes() -> Iterator[Spec]:
    yield scene(
        "wrong_side",
        "For half a minute the ego drives on the wrong side of an empty road.",
        "fail r143.direction",
        RURAL,
        [car(RURAL.along((200, 1.75), (230, 1.75), (310, -1.75), (2000, -1.75)), 20.0)],
        35,
    )
    yield scene(
        "astride_centre",
        "The ego drives astride the centre line for 15 s.",
        "not pass r131.keep-in-lane",
        RURAL,
        [car(out_and_back(RURAL, 200, 230, 300, 600, 680, out=0.0), 20.0)],
        30,
    )
    yield scene(
        "reversing_slowly",
        "The ego reverses twenty-odd metres at walking pace.",
        "not fail r143.direction no-collision",
        RURAL,
        [car(ahead(RURAL, 200), [(0, 0), (2, 0), (4, -1.5), (18, -1.5), (20, 0)], start=60)],
        24,
    )
    wide = urban(1, Lane(2.2, "parking", "none"))
    arc = [(150 + 4.4 * math.sin(a), 4.4 * math.cos(a)) for a in np.linspace(0, math.pi, 40)]
    yield scene(
        "turning_round",
        "The ego, a taxi, turns round in a wide street at walking pace.",
        "not fail r143.direction r145.off-road r131.keep-in-lane",
        wide,
        [car(line([(110, 4.4), *arc, (60, -4.4)], 0.5), 2.5)],
        30,
    )
    yield scene(
        "bridge",
        "Under a bridge the ego passes beneath a lorry that crosses above it.",
        "pass no-collision | not fail criticality.pet contact-signature",
        bridge(),
        [
            car(bridge().along((200, 1.75), (1000, 1.75)), 20.0),
            car(bridge().roads["above"].along((275, 1.75), (1000, 1.75)), 15.0, "truck"),
        ],
        25,
    )
    yield scene(
        "bridge_without_heights",
        "The same bridge, but the log has no heights.",
        "not fail no-collision criticality.pet",
        bridge(),
        [
            car(bridge().along((200, 1.75), (1000, 1.75)), 20.0, no_height=True),
            car(bridge().roads["above"].along((275, 1.75), (1000, 1.75)), 15.0, "truck", no_height=True),
        ],
        25,
    )
    yield scene(
        "horse_close_and_fast",
        "The ego passes a horse at 28 mph, a metre away.",
        "fail r215.horse",
        RURAL,
        [car(ahead(RURAL, 200, 0.9), 12.5), car(ahead(RURAL, 280, 3.1), 1.8, "animal")],
        16,
    )
    yield scene(
        "horse_slow_and_wide",
        "The ego slows down to 8 mph and passes a horse with three metres to spare.",
        "pass r215.horse | not fail r143.direction r163.obstruction-give-way",
        RURAL,
        [car(out_and_back(RURAL, 200, 205, 235, 275, 310, out=-1.7), 3.6), car(ahead(RURAL, 235, 3.1), 1.5, "animal")],
        36,
    )
    yield scene(
        "night_no_headlights",
        "The ego drives along a dark country road at night with its headlights off.",
        "fail r113.headlights",
        RURAL,
        [car(ahead(RURAL, 200), 20.0)],
        15,
        events=[(0.0, "headlights", "off")],
        light="night",
    )
    trailer = [car(ahead(RURAL, 206), 25.5), car(ahead(RURAL, 200), 25.5, "trailer")]
    yield scene(
        "caravan_too_fast",
        "The ego tows a caravan at 57 mph on a single carriageway (limit for it: 50).",
        "fail r124.speed-limit | not fail no-collision",
        RURAL,
        trailer,
        15,
        vehicle_class="car_towing",
    )
