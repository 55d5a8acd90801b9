"""Following, braking and running into."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from tests.outsiders.first.chapter import Spec, scene
from tests.outsiders.first.maps import RURAL, rural
from tests.outsiders.first.movement import Actor, ahead, car, still, to_stop


def following() -> Iterator[Spec]:
    tail = "r126.thinking-gap"

    def chase(gap: float, v: float = 25.0, **more: Any) -> list[Actor]:
        return [car(ahead(RURAL, 200), v), car(ahead(RURAL, 204.5 + gap), v, **more)]

    yield scene(
        "tailgating",
        "The ego follows at 56 mph with 8 m to spare.",
        f"fail {tail} r126.stopping-gap criticality.thw rss.longitudinal | not fail criticality.ttc",
        RURAL,
        chase(8),
        20,
    )
    yield scene(
        "following_well",
        "The ego follows at 56 mph at 3.2 s.",
        f"pass {tail} r126.stopping-gap criticality.thw criticality.ttc",
        RURAL,
        chase(80),
        20,
    )
    yield scene(
        "following_in_rain",
        "The ego follows at 56 mph at 3.2 s in the wet, where the stopping distance doubles.",
        f"fail r126.stopping-gap | pass {tail}",
        RURAL,
        chase(80),
        20,
        weather="wet",
    )
    yield scene(
        "tailgating_2hz_noise",
        "The same tailgating, logged twice a second with 5 cm of noise.",
        f"fail {tail}",
        RURAL,
        [replace(a, noise=0.05) for a in chase(8)],
        20,
        2.0,
    )
    yield scene(
        "noise_behind",
        "The ego follows at 3.2 s; the log has 5 cm of noise.",
        f"not fail {tail} contact-signature no-collision r143.direction criticality.mttc",
        RURAL,
        [replace(a, noise=0.05) for a in chase(80)],
        20,
    )
    yield scene(
        "tailgating_flipped",
        "The same tailgating; the log has the leader's heading turned round.",
        f"not pass {tail} criticality.thw",
        RURAL,
        chase(8, flipped=True),
        20,
    )
    yield scene(
        "tailgating_vanishing",
        "The same tailgating; the leader vanishes from the log after 6 s.",
        f"not pass {tail}",
        RURAL,
        chase(8, until=6.0),
        20,
    )
    yield scene(
        "late_braking",
        "The ego drives at a standing car at 25 m/s and brakes at 7 m/s2 in the last moment.",
        "fail criticality.ttc criticality.drac criticality.ttb comfort.decel-iso15622 comfort.nuplan | pass no-collision",
        RURAL,
        [car(ahead(RURAL, 200), to_stop(25, 193, 7.0)), still("car", 400, 1.75)],
        20,
    )
    yield scene(
        "gentle_stop",
        "The ego stops gently 4 m behind a standing car.",
        "pass criticality.ttc criticality.drac criticality.ttb comfort.decel-iso15622 comfort.nuplan no-collision",
        RURAL,
        [car(ahead(RURAL, 200), to_stop(20, 191.5, 1.6)), still("car", 400, 1.75)],
        22,
    )
    yield scene(
        "rear_end",
        "The ego brakes too late and runs into the back of a standing car.",
        "fail no-collision criticality.ttc",
        RURAL,
        [car(ahead(RURAL, 200), [(0, 20), (8.8, 20), (10, 10), (10.5, 0)], jolt=True), still("car", 400, 1.75)],
        14,
    )
    yield scene(
        "impact_between_boxes",
        "The ego loses 5.5 m/s within a tenth of a second 0.3 m behind a standing van.",
        "fail contact-signature",
        RURAL,
        [
            car(ahead(RURAL, 200), [(0, 6), (15.7, 6), (15.8, 0.5), (16.3, 0)], start=100.0, jolt=True),
            still("van", 399.9, 1.75),
        ],
        20,
    )
    tight = rural(1, bend=1 / 200.0, length=900)
    yield scene(
        "bend_too_fast",
        "The ego takes a bend of 200 m radius at 65 mph.",
        "fail comfort.lateral r124.speed-limit",
        tight,
        [car(ahead(tight, 20), 29.0)],
        24,
    )
