"""Germany: too fast, and too slow."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.sixteenth.cast import DE, MIDDLE, OWN, SLOW, ego
from tests.outsiders.sixteenth.drive import Actor, Drive, draw
from tests.outsiders.sixteenth.maps import motorway, rural
from tests.outsiders.sixteenth.ways import along


def _limits() -> Iterator[Drive]:
    yield draw(
        "rg3-lorry-95",
        motorway(limit=None),
        [ego(along(SLOW, 25.5, 50), "truck")],
        {**DE, "vehicle_class": "goods_over_7t5"},
        12,
        [("stvo.rg3", "fail", "lorry at 92 km/h on a motorway without limit, 80 allowed")],
    )
    yield draw(
        "rg3-coach-97",
        motorway(limit="none"),
        [ego(along(SLOW, 27, 50), "bus", noise=0.02)],
        DE,
        12,
        [("stvo.rg3", "not pass", "coach at 97 km/h: only if approved for 100"), ("stvo.rg4", "not fail", "over 80")],
    )
    yield draw(
        "rg3-bus-110",
        motorway(limit="none"),
        [ego(along(SLOW, 30.5, 50), "bus")],
        DE,
        12,
        [("stvo.rg3", "fail", "bus at 110, 100 at most")],
    )
    yield draw(
        "rg3-lane-limit",
        motorway(limits=[33.33, 33.33, 22.22]),
        [ego(along([(0, MIDDLE), (6, MIDDLE), (10, SLOW)], 29, 50), ind=[(0, "off"), (3, "right"), (10, "off")])],
        DE,
        16,
        [("stvo.rg3", "fail", "29 m/s in the lane of 22.2")],
        hz=8,
    )
    yield draw(
        "rg3-car-trailer-rural",
        rural(limit=27.78),
        [ego(along(OWN, 24.5, 50)), Actor("t", "trailer", along(OWN, 24.5, 44.4))],
        {**DE, "vehicle_class": "car_towing"},
        15,
        [("stvo.rg3", "fail", "car with trailer 88 km/h on a rural road, 80 allowed")],
    )


def _slow() -> Iterator[Drive]:
    yield draw(
        "rg4-slow-lorry-far-gone",
        motorway(length=4000, limit=33.33),
        [ego(along(SLOW, 15, 50)), Actor("a", "car", along(SLOW, [(0, 15), (5, 15), (12, 33), (50, 33)], 94.5))],
        DE,
        50,
        [("stvo.rg4", "fail", "the one ahead has sped up from 5 s on")],
        hz=5,
    )


def german_speeds() -> Iterator[Drive]:
    yield from _limits()
    yield from _slow()
