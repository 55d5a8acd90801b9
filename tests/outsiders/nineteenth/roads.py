"""Footways, limits, parking, the declared speed."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.nineteenth.cast import OWN
from tests.outsiders.nineteenth.drive import Actor, Drive, draw
from tests.outsiders.nineteenth.maps import (
    KMH_100,
    LONG,
    STREET,
    country,
    street,
)

MPH = 0.44704  # m/s


def footways_and_limits() -> Iterator[Drive]:
    """Footways, limits."""
    yield draw(
        "footway_fast",
        "gb-eng",
        street(),
        [Actor("ego", "car", STREET, 50, 9, [(3, OWN), (5, -3.4), (7, -3.4), (9, OWN)])],
        16,
        [("ukhc.r145.off-road", "fail", "0.8 m onto the footway at 9 m/s")],
    )
    yield draw(
        "limit_34",
        "gb-eng",
        street(),
        [Actor("ego", "car", STREET, 40, [(0, 13), (5, 13), (7, 34 * MPH), (8.5, 34 * MPH), (11, 13), (30, 13)], OWN)],
        18,
        [("ukhc.r124.speed-limit", "fail", "34 mph for 1.5 s where 30 holds")],
    )
    yield draw(
        "limit_lorry_sct",
        "gb-sct",
        country(),
        [Actor("ego", "truck", LONG, 60, 46 * MPH, OWN)],
        20,
        [("ukhc.r124.speed-limit", "fail", "46 mph; 40 for lorries over 7.5 t on single carriageways in Scotland")],
        cond={"vehicle_class": "goods_over_7t5"},
    )
    yield draw(
        "limit_de_truck",
        "de",
        country(limit=KMH_100),
        [Actor("ego", "truck", LONG, 60, 19.2, OWN)],
        18,
        [("stvo.rg3", "fail", "69 km/h; 60 for over 7.5 t")],
        cond={"vehicle_class": "goods_over_7t5", "carriageway": "single", "area": "open"},
    )


def parking_and_choice() -> Iterator[Drive]:
    """Parking, the chosen speed."""
    yield draw(
        "parked_wrong",
        "gb-eng",
        street(),
        [Actor("ego", "car", STREET, 60, [(0, 9), (6, 9), (12, 0), (90, 0)], [(5, OWN), (10, 1.9)])],
        80,
        [
            ("ukhc.r239.parked-with-traffic", "fail", "stands 68 s facing the traffic"),
            ("ukhc.r248.parked-at-night", "fail", "at night"),
        ],
        hz=5,
        cond={"light": "night"},
        events=[(0, "headlights", "off")],
    )
    yield draw(
        "chosen_speed",
        "gb-eng",
        country(),
        [Actor("ego", "car", LONG, 60, [(0, 20), (10, 20), (14, 23), (40, 23)], OWN)],
        24,
        [
            ("declared.r125.chosen-speed-kept", "fail", "23 m/s from 14 s; 21 chosen till 16 s"),
            ("declared.r152.speed-reason", "fail", "the second has no reason"),
        ],
        events=[(0, "chosen_speed", "21; wet road"), (16, "chosen_speed", "24")],
    )
