"""Great Britain: motorways, lights and the horn."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.sixteenth.cast import GB, OWN, ego
from tests.outsiders.sixteenth.drive import Actor, Drive, draw
from tests.outsiders.sixteenth.maps import exit_road, motorway, rural, town
from tests.outsiders.sixteenth.ways import Motion, Path, along


def _motorways() -> Iterator[Drive]:
    yield draw(
        "gb-lorry-lane-3",
        motorway(length=3500, limit=31.29, width=3.65),
        [
            ego(along([(0, -5.625), (5, -5.625), (10, -1.875), (20, -1.875)], 24, 50), "truck"),
            Actor("a", "truck", along(-5.625, 20, 130)),
        ],
        {**GB, "vehicle_class": "goods_over_7t5"},
        25,
        [
            ("ukhc.r265.right-lane-ban", "fail", "lorry in the third lane"),
            ("ukhc.r124.speed-limit", "pass", "53.7 mph"),
        ],
        hz=5,
    )
    yield draw(
        "gb-towing-55",
        rural(),
        [ego(along(OWN, 24.6, 80)), Actor("t", "trailer", along(OWN, 24.6, 74.4))],
        {**GB, "vehicle_class": "car_towing"},
        15,
        [
            ("ukhc.r124.speed-limit", "fail", "car with trailer at 55 on a single carriageway, 50 allowed"),
            ("ukhc.no-collision", "not fail", "its own trailer, 0.85 m behind"),
        ],
    )
    yield draw(
        "gb-astride",
        motorway(lanes=2, length=3500, limit=31.29, width=3.65),
        [ego(along([(0, -1.8), (4, -1.8), (7, -3.65), (24, -3.65), (27, -1.8)], 27, 50))],
        GB,
        30,
        [("ukhc.r131.keep-in-lane", "fail", "17 s on the lane line")],
        hz=5,
    )


def _exits() -> Iterator[Drive]:
    yield draw(
        "gb-exit-late",
        exit_road(),
        [
            ego(
                Motion(Path(0, -9.125, 0, [(920, 0), (200, -1 / 248.175)]), 27, 50, [(0, 3.65), (19, 3.65), (24, 0)]),
                ind=[(0, "off"), (17.5, "right"), (30, "off")],
            )
        ],
        GB,
        38,
        [("ukhc.exit-sign-signal", "fail", "sign passed at 15.8 s")],
    )
    yield draw(
        "gb-signals-stays",
        exit_road(),
        [ego(along(-5.475, 27, 50), ind=[(0, "off"), (18, "right"), (33, "off")])],
        GB,
        40,
        [("ukhc.signal-then-leaves", "fail", "signals left beside the exit lane and goes on")],
    )


def _lamps_and_horn() -> Iterator[Drive]:
    yield draw(
        "gb-hazards-driving",
        rural(),
        [ego(along(OWN, 18, 50), ind=[(0, "off"), (5, "hazard"), (14, "off")])],
        GB,
        20,
        [("ukhc.r116.hazards", "fail", "hazard lights at 18 m/s on a rural road")],
    )
    yield draw(
        "gb-night-dark",
        rural(),
        [ego(along(OWN, 18, 50))],
        {**GB, "light": "night"},
        20,
        [("ukhc.r113.headlights", "fail", "off after 8 s at 60 mph road")],
        events=[(0, "headlights", "on"), (8, "headlights", "off")],
    )
    yield draw(
        "gb-night-town-dark",
        town(),
        [ego(along(OWN, 11, 50))],
        {**GB, "light": "night"},
        20,
        [
            ("ukhc.r115.dipped-headlights", "fail", "no headlights in town"),
            ("ukhc.r113.headlights", "not fail", "street may be lit"),
        ],
        events=[(0, "headlights", "off")],
    )
    yield draw(
        "gb-horn-standing",
        town(),
        [ego(along(OWN, [(0, 8), (4, 0), (20, 0)], 50))],
        GB,
        20,
        [("ukhc.r112.horn", "fail", "horn while standing, nobody there")],
        events=[(0, "horn", "off"), (9, "horn", "on"), (11, "horn", "off")],
    )


def _parked() -> Iterator[Drive]:
    yield draw(
        "gb-parked-against",
        town(),
        [ego(along(2.4, [(0, 3), (2, 3), (6, 0), (80, 0)], 50))],
        {**GB, "light": "night"},
        80,
        [
            ("ukhc.r239.parked-with-traffic", "not pass", "stands 74 s against the traffic"),
            ("ukhc.r248.parked-at-night", "not pass", "at night"),
        ],
        hz=2,
        events=[(0, "headlights", "on")],
    )


def british_roads() -> Iterator[Drive]:
    yield from _motorways()
    yield from _exits()
    yield from _lamps_and_horn()
    yield from _parked()
