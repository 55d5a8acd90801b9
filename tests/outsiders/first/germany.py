"""German motorways, roads and junctions."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from tests.outsiders.first.chapter import Spec, scene
from tests.outsiders.first.maps import crossroads, motorway, rural, urban
from tests.outsiders.first.movement import SIZE, Actor, ahead, car, route, still, to_stop


def germany() -> Iterator[Spec]:
    free, limited = motorway(-1, None), motorway(-1, (120.0, "km/h"))
    left, middle, right = 1.8, 5.5, 9.1
    on: dict[str, Any] = {"road_type": "motorway"}
    lorry: dict[str, Any] = {**on, "vehicle_class": "goods_over_7t5"}

    def chase(gap: float, v: float, kind: str = "car", **more: Any) -> list[Actor]:
        return [
            car(ahead(free, 100, right), v, kind),
            car(ahead(free, 100 + gap + SIZE[kind][0] / 2 + 2.25, right), v, **more),
        ]

    yield scene(
        "de_tailgating",
        "The ego follows 5 m behind a car at 130 km/h.",
        "fail stvo.rg1 criticality.thw",
        free,
        chase(5, 36),
        20,
        **on,
    )
    yield scene(
        "de_following",
        "The ego follows 65 m behind a car at 120 km/h.",
        "pass stvo.rg1 criticality.thw | not fail stvo.rg4",
        free,
        chase(65, 33),
        20,
        **on,
    )
    yield scene(
        "de_cut_in_on_ego",
        "A car moves in 9 m ahead; the ego lets off and has its distance again within three seconds.",
        "not fail stvo.rg1 stvo.rg2",
        free,
        [
            car(ahead(free, 100, middle), [(0, 30), (3.5, 30), (6, 26)]),
            car(free.along((113.5, left), (150, left), (260, middle), (2500, middle)), 30.0),
        ],
        20,
        **on,
    )
    yield scene(
        "de_brakes_for_nothing",
        "The ego brakes hard on an empty motorway.",
        "fail stvo.rg2",
        free,
        [car(ahead(free, 100, right), [(0, 33), (5, 33), (8, 17), (12, 17), (18, 30)])],
        22,
        **on,
    )
    deer = still("animal", 330, -right, 1.5, size=(1.5, 0.5, 1.2))
    yield scene(
        "de_brakes_for_deer",
        "The ego brakes hard for a deer that stands in its lane.",
        "not fail stvo.rg2 stvo.ri1 | pass no-collision",
        free,
        [car(ahead(free, 100, right), to_stop(30, 210, 5.0)), deer],
        20,
        **on,
    )
    yield scene(
        "de_crawls",
        "The ego crawls at 50 km/h along an empty motorway.",
        "fail stvo.rg4",
        limited,
        [car(ahead(limited, 100, right), 14.0)],
        30,
        **on,
    )
    change = free.along((300, middle), (350, middle), (460, left), (2500, left))
    yield scene(
        "de_cuts_in",
        "The ego moves left 15 m in front of a car that is 70 km/h faster.",
        "fail stvo.rg6",
        free,
        [car(change, 28.0), car(ahead(free, 226, left), [(0, 48), (2, 48), (5, 27)])],
        16,
        **on,
    )
    yield scene(
        "de_stops",
        "The ego stops on the motorway to have a look at the view.",
        "fail stvo.ri1",
        free,
        [car(ahead(free, 100, right), to_stop(25, 220, 3.0, 15, 20))],
        38,
        **on,
    )
    yield scene(
        "de_undertakes",
        "The ego passes a car in the left lane on the right, at 125 against 100 km/h.",
        "fail stvo.ri2",
        free,
        [car(ahead(free, 100, middle), 35.0), car(ahead(free, 150, left), 28.0)],
        18,
        **on,
    )
    jam = [car(ahead(free, s, left), 11.0) for s in (130, 150, 170, 190, 210)]
    yield scene(
        "de_passes_queue_on_right",
        "The ego passes a queue in the left lane on the right, 14 km/h faster.",
        "not fail stvo.ri2",
        free,
        [car(ahead(free, 100, middle), 15.0), *jam],
        30,
        **on,
    )
    slip = motorway(-1, None, 2, entry=True)
    yield scene(
        "de_entry_lane",
        "On the way in, the ego passes a lorry on the right and moves in ahead of it.",
        "not fail stvo.ri2",
        slip,
        [
            car(slip.along((100, 9.1), (480, 9.1), (600, 5.5), (2500, 5.5)), [(0, 24), (3, 24), (7, 30)]),
            car(ahead(slip, 150, 5.5), 22.0, "truck"),
        ],
        26,
        **on,
    )
    yield scene(
        "de_reverses",
        "The ego stops in the right lane of the motorway and reverses.",
        "fail stvo.ri3",
        free,
        [car(ahead(free, 100, right), [(0, 20), (12, 20), (18, 0), (20, 0), (23, -4), (31, -4)])],
        31,
        **on,
    )
    yield scene(
        "de_lorry_close",
        "The ego, a lorry, follows another at 25 m with 85 km/h.",
        "fail stvo.s4-truck",
        free,
        chase(25, 23.6, "truck"),
        20,
        **lorry,
    )
    street, country = urban(-1), rural(-1)
    yield scene(
        "de_cyclist_country",
        "Outside town the ego passes a cyclist 1.2 m away at 80 km/h.",
        "fail stvo.s5-passing",
        country,
        [car(ahead(country, 100, 0.7), 22.0), car(ahead(country, 250, 3.1), 6.0, "bicycle")],
        18,
    )
    yield scene(
        "de_cyclist_beside_at_lights",
        "A cyclist rides up beside the standing ego, stops, and both move off together.",
        "not fail stvo.s5-passing no-collision",
        street,
        [
            car(ahead(street, 150, 1.4), [(0, 0), (12, 0), (18, 9)]),
            car(ahead(street, 120, 3.1), [(0, 5), (4, 5), (8, 0), (12, 0), (15, 4.5)], "bicycle"),
        ],
        26,
    )
    yield scene(
        "de_town_53",
        "The ego drives at 52 km/h in town: within what the police take off.",
        "not fail stvo.rg3",
        street,
        [car(ahead(street, 20), 52 / 3.6)],
        15,
    )
    halt = crossroads(-1, "stop")
    yield scene(
        "de_stop_rolled",
        "The ego rolls over the line at a German stop sign.",
        "fail stvo.rin1",
        halt,
        [car(route(halt, "S SN N", 100, 200), [(0, 10), (7, 10), (10.5, 3), (14, 3), (17, 8)])],
        24,
    )
    yield scene(
        "de_stop_kept",
        "The ego stands four seconds before a German stop line.",
        "pass stvo.rin1",
        halt,
        [car(route(halt, "S SN N", 100, 200), to_stop(10, 96.3, 2.0, 4.5, 8))],
        30,
    )
    yield scene(
        "de_left_across",
        "The ego turns left in front of an oncoming motorcycle, which misses it by a second.",
        "fail criticality.pet | pass no-collision",
        halt,
        [car(route(halt, "W WN N", 60, 150), 6.0), car(route(halt, "E EW W", 143, 100), 12.0, "motorcycle")],
        20,
    )
