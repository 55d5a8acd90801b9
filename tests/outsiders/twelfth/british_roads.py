"""Great Britain: limits, lights, horn and hazard lights."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.twelfth.cast import (
    GB,
    N1,
    O1,
    ego,
)
from tests.outsiders.twelfth.drive import Actor, Drive, draw
from tests.outsiders.twelfth.maps import (
    dual,
    rural,
    town,
)
from tests.outsiders.twelfth.ways import Straight, Walk


def british_roads() -> Iterator[Drive]:
    yield draw(
        "gb_lorry_scotland_46",
        rural(tf=(-3000, 150, -77)),
        [ego(Straight(30, N1, 20.6), "truck")],
        {"nation": "gb-sct", "vehicle_class": "goods_over_7t5"},
        20,
        [
            (
                "ukhc.r124.speed-limit",
                "fail",
                "46 mph where a lorry over 7.5 t is allowed 40 mph in Scotland on a single carriageway",
            )
        ],
    )
    yield draw(
        "gb_caravan_57",
        rural(tf=(0, 0, 200)),
        [ego(Straight(60, N1, 25.4)), Actor("tr", "trailer", Straight(53.5, N1, 25.4))],
        {"nation": "gb", "vehicle_class": "car_towing"},
        18,
        [
            ("ukhc.r124.speed-limit", "fail", "a car with a caravan at 57 mph on a single carriageway, 50 mph allowed"),
            ("ukhc.no-collision", "not fail", "its own trailer is no collision"),
        ],
    )
    yield draw(
        "gb_coach_dual_68",
        dual(),
        [
            ego(Straight(20, 2 + 3.65 * 1.5, 30.4), "bus", noise=0.05),
            Actor("c", "car", Straight(90, 2 + 3.65 * 0.5, 31)),
        ],
        GB,
        25,
        [("ukhc.r124.speed-limit", "fail", "a bus at 68 mph on a dual carriageway, 60 mph allowed")],
    )
    yield draw(
        "gb_town_36_wet_night",
        town(tf=(5, 5, 15)),
        [ego(Straight(20, N1, 16.1)), Actor("w", "pedestrian", Walk([(0, 300, 4.5), (20, 318, 4.5)]))],
        {"nation": "gb", "weather": "wet", "light": "night"},
        25,
        [
            ("ukhc.r124.speed-limit", "fail", "36 mph in a 30 limit"),
            ("ukhc.r113.headlights", "not pass", "night, and whether the headlights are on is not recorded"),
        ],
        hz=5,
    )
    yield draw(
        "gb_night_dark_rural",
        rural(),
        [ego(Straight(20, N1, 21)), Actor("o", "car", Straight(700, O1, 22, way=-1))],
        {"nation": "gb", "light": "night"},
        18,
        [("ukhc.r113.headlights", "fail", "21 m/s at night on a 60 mph road with the headlights off")],
        events=[(0, "headlights", "off")],
    )
    yield draw(
        "gb_night_town_dark",
        town(),
        [ego(Straight(20, N1, 11))],
        {"nation": "gb", "light": "night"},
        18,
        [
            ("ukhc.r115.dipped-headlights", "fail", "at night in a 30 mph street without headlights"),
            ("ukhc.r113.headlights", "not fail", "30 mph: the street may be lit"),
        ],
        events=[(0, "headlights", "off")],
    )
    q = [Actor(f"q{i}", "car", Straight(110 + 7.5 * i, N1, 0)) for i in range(3)]
    yield draw(
        "gb_horn_in_queue",
        town(),
        [ego(Straight(102.5, N1, 0)), *q],
        GB,
        15,
        [("ukhc.r112.horn", "fail", "stands in a queue that stands, sounds the horn, nobody moves")],
        events=[(0, "horn", "off"), (5, "horn", "on"), (6.2, "horn", "off")],
    )
    yield draw(
        "gb_horn_reversing_van",
        town(),
        [
            ego(Straight(100, N1, 0)),
            Actor("v", "van", Straight(116, N1, [(0, 0), (3, 0), (4, -1.6), (7, -1.6), (8, 0)])),
        ],
        GB,
        15,
        [
            ("ukhc.r112.horn", "not fail", "stands, but a van rolls back towards it: a danger"),
            ("ukhc.no-collision", "pass", "the van stops short"),
        ],
        events=[(0, "horn", "off"), (5, "horn", "on"), (6.2, "horn", "off")],
    )
    yield draw(
        "gb_hazards_on_the_move",
        rural(),
        [ego(Straight(20, N1, 17), ind=[(0, "off"), (4, "hazard"), (15, "off")])],
        GB,
        20,
        [("ukhc.r116.hazards", "fail", "drives 11 s with hazard lights on a single carriageway with nobody ahead")],
    )
