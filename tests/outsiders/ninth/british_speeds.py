"""Great Britain: speeds and distances."""

from __future__ import annotations

from tests.outsiders.ninth.drive import Drive, draw
from tests.outsiders.ninth.maps import MOTORWAY_M, country, dual_carriageway, lane, own, town
from tests.outsiders.ninth.movement import MPH, ego, oncoming, who


def british_speeds() -> list[Drive]:
    """Return its drives."""
    return [
        draw(
            "gb_lorry_at_58_k",
            "A heavy lorry drives at 58 mph on a single carriageway.",
            "fail r124.speed-limit",
            country(),
            [ego(own, 60, 58 * MPH, kind="truck")],
            20,
            vehicle_class="goods_over_7t5",
        ),
        draw(
            "gb_caravan_at_57_k",
            "A car with a caravan drives at 57 mph on a single carriageway.",
            "fail r124.speed-limit",
            country(),
            [ego(own, 60, 57 * MPH), who("caravan", "trailer", own, 53.2, 57 * MPH, size=(6.0, 2.2, 2.6))],
            20,
            vehicle_class="car_towing",
        ),
        draw(
            "gb_highland_lorry_at_47_k",
            "A heavy lorry drives at 47 mph on a single carriageway in Scotland.",
            "fail r124.speed-limit",
            country(),
            [ego(own, 60, 47 * MPH, kind="truck")],
            20,
            vehicle_class="goods_over_7t5",
            nation="gb-sct",
        ),
        draw(
            "gb_caravan_dual_68_k",
            "A car that tows drives at 68 mph on a dual carriageway.",
            "fail r124.speed-limit",
            dual_carriageway(),
            [ego(lane(0, 2, MOTORWAY_M), 60, 68 * MPH), who("slow", "truck", lane(0, 2, MOTORWAY_M), 300, 25)],
            20,
            vehicle_class="car_towing",
        ),
        draw(
            "gb_town_39_with_noise_k",
            "The ego drives at 39 mph where 30 are allowed; positions tremble by 5 cm.",
            "fail r124.speed-limit",
            town(),
            [ego(own, 60, 39 * MPH), oncoming("onc", "van", 300, 12, 12)],
            20,
            noise=0.05,
        ),
        draw(
            "gb_glued_to_the_van_k",
            "The ego follows a van at 54 mph, 6.5 m behind it.",
            "fail r126.thinking-gap criticality.thw | not fail criticality.ttc",
            country(),
            [ego(own, 60, 24), who("van", "van", own, 71.5, 24)],
            22,
        ),
        draw(
            "gb_follows_well_k",
            "The ego follows a van at 2.4 s.",
            "pass r126.thinking-gap criticality.thw criticality.ttc",
            country(),
            [ego(own, 60, 20), who("van", "van", own, 113, 20, [(4, 0), (8, 0.3), (12, -0.2)])],
            22,
        ),
        draw(
            "gb_brakes_at_the_last_moment_k",
            "The ego comes up to a slow lorry and brakes 22 m behind it.",
            "fail criticality.ttc criticality.drac criticality.ttb | pass no-collision",
            country(),
            [ego(own, 60, [(10, 25), (12, 9)]), who("lead", "truck", own, 249.7, 9)],
            20,
        ),
    ]
