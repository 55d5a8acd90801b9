"""British motorways."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from tests.outsiders.first.chapter import Spec, scene
from tests.outsiders.first.maps import motorway
from tests.outsiders.first.movement import ahead, car, out_and_back, to_stop


def motorways() -> Iterator[Spec]:
    m = motorway(1, (70.0, "mph"))
    left, middle, hard = 9.1, 5.5, 12.6
    on: dict[str, Any] = {"road_type": "motorway"}
    yield scene(
        "hard_shoulder",
        "The ego drives along the hard shoulder past slow traffic.",
        "fail r269.hard-shoulder",
        m,
        [car(ahead(m, 100, hard), 20.0), car(ahead(m, 200, left), 12.0), car(ahead(m, 220, left), 12.0)],
        20,
        **on,
    )
    yield scene(
        "motorway_reversing",
        "The ego has missed its exit, stops in the left lane, and reverses.",
        "fail r263.no-reverse r143.direction",
        m,
        [car(ahead(m, 100, left), [(0, 20), (12, 20), (18, 0), (20, 0), (23, -5), (33, -5)])],
        33,
        **on,
    )
    yield scene(
        "motorway_breakdown",
        "The ego breaks down: hazard lights on, it rolls onto the hard shoulder and stays there.",
        "not fail r240.no-stopping r269.hard-shoulder r116.hazards",
        m,
        [
            car(
                m.along((100, left), (200, left), (270, hard), (600, hard)),
                to_stop(20, 260, 1.4),
                lamps=[(0.0, "off"), (3.0, "hazard")],
            )
        ],
        34,
        **on,
    )
    lorry: dict[str, Any] = {**on, "vehicle_class": "goods_over_7t5"}
    yield scene(
        "lorry_middle_lane",
        "The ego, a big lorry, overtakes in the middle lane at 56 mph.",
        "pass r265.right-lane-ban r124.speed-limit",
        m,
        [car(ahead(m, 100, middle), 25.0, "truck"), car(ahead(m, 160, left), 22.0, "truck")],
        25,
        **lorry,
    )
    yield scene(
        "motorway_astride",
        "The ego drives astride two lanes for half a kilometre.",
        "fail r131.keep-in-lane",
        m,
        [car(out_and_back(m, 100, 150, 230, 730, 810, left, 7.3), 28.0)],
        28,
        **on,
    )
