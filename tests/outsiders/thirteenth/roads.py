"""Keeping to the road, speeds, lamps, the horn, comfort."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.thirteenth.drive import DE, GB, NIGHT, TURNED, Drive, draw
from tests.outsiders.thirteenth.following import following, went
from tests.outsiders.thirteenth.street import N, two_way


def keeping_to_it() -> Iterator[Drive]:
    """Lanes, sides and footways."""
    yield following("astride", 15, [("ukhc.r131.keep-in-lane", "not fail", "keeps its lane")])
    yield following(
        "wrong_side",
        13,
        [("ukhc.r143.direction", "fail", "drives 20 s in the opposing lane with nobody there")],
        u=[(0, 1.75), (2, 1.75), (5, -1.75)],
        seconds=28,
    )
    yield following(
        "wrong_side_de",
        13,
        [("ukhc.r143.direction", "fail", "drives 20 s in the opposing lane (no law asked)")],
        u=[(0, 1.75), (2, 1.75), (5, -1.75)],
        seconds=28,
        lht=False,
        conditions=DE,
        frame=TURNED,
    )
    yield following(
        "footway",
        9,
        [("ukhc.r145.off-road", "fail", "two wheels 0.8 m on the footway at 9 m/s")],
        u=[(0, 1.75), (3, 1.75), (6, 3.4), (9, 3.4), (12, 1.75)],
        walk=2.0,
        kind="town",
        limit=13.41,
    )
    yield following(
        "footway_slow",
        [(0, 6), (3, 2.5), (12, 2.5), (99, 2.5)],
        [("ukhc.r145.off-road", "not fail", "5.6 mph over the footway")],
        u=[(0, 1.75), (5, 1.75), (8, 3.8)],
        walk=2.0,
        kind="town",
        limit=13.41,
    )


def limits() -> Iterator[Drive]:
    """Speed limits."""
    yield following("speed_town", 15, [("ukhc.r124.speed-limit", "fail", "33.6 mph in 30")], kind="town", limit=13.41)
    yield following(
        "speed_town_ok", 13.6, [("ukhc.r124.speed-limit", "pass", "30.4 mph in 30")], kind="town", limit=13.41
    )
    yield following(
        "speed_lorry_sct",
        20,
        [
            (
                "ukhc.r124.speed-limit",
                "fail",
                "20 m/s = 44.7 mph, 40 for goods over 7.5 t on single carriageways in Scotland",
            )
        ],
        conditions={"nation": "gb-sct", "weather": "dry", "light": "day", "vehicle_class": "goods_over_7t5"},
        cls="truck",
        size=(16.5, 2.5, 4.0),
        seconds=20,
    )
    yield following(
        "speed_towing",
        24,
        [("ukhc.r124.speed-limit", "fail", "53.7 mph, 50 for cars that tow on single carriageways")],
        conditions={**GB, "vehicle_class": "car_towing"},
        others=[went("tr", "trailer", 200 - 2.25 - 0.6 - 2.75, 24, 1.75, size=(5.5, 2.2, 2.4))],
    )


def lamps() -> Iterator[Drive]:
    """Lamps and the horn."""
    yield following(
        "hazards_on",
        14,
        [("ukhc.r116.hazards", "fail", "hazards at 14 m/s on a single carriageway")],
        ind=[(0, "off"), (4, "hazard")],
        frame=TURNED,
    )
    yield following(
        "hazards_stand",
        [(0, 8), (4, 0), (99, 0)],
        [("ukhc.r116.hazards", "pass", "on only when standing")],
        ind=[(0, "off"), (5, "hazard")],
    )
    yield following(
        "horn_standing",
        [(0, 8), (4, 0), (99, 0)],
        [("ukhc.r112.horn", "fail", "horn at a stand with nobody about")],
        events=[(0, "horn", "off"), (8, "horn", "on"), (9, "horn", "off")],
    )
    yield following(
        "horn_moving",
        12,
        [("ukhc.r112.horn", "pass", "moving")],
        events=[(0, "horn", "off"), (5, "horn", "on"), (6, "horn", "off")],
    )
    yield following(
        "night_dark",
        18,
        [("ukhc.r113.headlights", "fail", "headlights go off on a rural road at night")],
        conditions=NIGHT,
        events=[(0, "headlights", "on"), (6, "headlights", "off")],
    )
    yield following(
        "night_town_off",
        12,
        [("ukhc.r115.dipped-headlights", "fail", "off in town at night")],
        conditions=NIGHT,
        kind="town",
        limit=13.41,
        events=[(0, "headlights", "off")],
    )
    yield following(
        "night_on",
        12,
        [("ukhc.r115.dipped-headlights", "pass", "on")],
        conditions=NIGHT,
        kind="town",
        limit=13.41,
        events=[(0, "headlights", "on")],
    )


def comfort() -> Iterator[Drive]:
    """Comfort."""
    yield following(
        "acc_hard",
        [(0, 4), (3, 4), (7, 18), (99, 18)],
        [("comfort.accel-iso15622", "fail", "3.5 m/s2 at up to 18 m/s"), ("comfort.nuplan", "fail", "3.5 > 2.4")],
    )
    yield following(
        "acc_gentle",
        [(0, 4), (3, 4), (13, 16), (99, 16)],
        [("comfort.accel-iso15622", "pass", "1.2 m/s2"), ("comfort.nuplan", "pass", "1.2 m/s2")],
        soft=1.2,
    )
    yield following(
        "jerky",
        [(0, 22), (6, 22), (8.5, 10), (99, 10)],
        [("comfort.jerk-iso15622", "fail", "from 0 to 4.8 m/s2 within 0.5 s"), ("comfort.nuplan", "fail", "4.8 m/s2")],
        soft=0.5,
    )
    yield following(
        "lateral_bend", 14, [("comfort.lateral", "fail", "14^2/50 = 3.9 m/s2")], curve=1 / 50, seconds=7.5, length=310
    )
    yield following(
        "lateral_bus",
        11.7,
        [("comfort.lateral", "fail", "11.7^2/50 = 2.7 m/s2, 2.5 for a bus")],
        curve=-1 / 50,
        seconds=8,
        length=310,
        cls="bus",
        size=(12, 2.5, 3.2),
    )
    yield following(
        "lateral_car_ok",
        11.5,
        [("comfort.lateral", "pass", "2.65 m/s2, 3 for a car")],
        curve=1 / 50,
        seconds=7.5,
        length=310,
    )


def by_hand() -> Iterator[Drive]:
    """Roads of more lanes, parking, limits that change."""
    street = two_way(n=2, opposing=2, kind="town", limit=17.88, length=1200, frame=TURNED)
    yield draw(
        "astride_long",
        street.map,
        [street.go("ego", "car", 100, 15, [(0, N), (2, N), (5, 3.5), (21, 3.5), (24, N)])],
        28,
        [("ukhc.r131.keep-in-lane", "fail", "16 s astride the lane line")],
    )
    street = two_way(n=2, opposing=2, kind="town", limit=17.88, length=1200)
    yield draw(
        "lane_change_slow",
        street.map,
        [street.go("ego", "car", 100, 15, [(0, N), (5, N), (11, 5.25)])],
        20,
        [("ukhc.r131.keep-in-lane", "not fail", "a lane change of 6 s")],
    )
    street = two_way(kind="town", limit=13.41, length=400, walk=2.0)
    yield draw(
        "park_night_against",
        street.map,
        [street.go("ego", "car", 100, [(0, 6), (10, 6), (13, 3), (15, 0), (99, 0)], [(0, N), (7, N), (13, -2.3)])],
        90,
        [
            ("ukhc.r248.parked-at-night", "fail", "75 s on the lane facing against"),
            ("ukhc.r239.parked-with-traffic", "fail", "same"),
        ],
        hz=5,
        conditions=NIGHT,
        events=[(0, "headlights", "on")],
    )
    street = two_way(kind="town", limit=13.41, length=400, walk=2.0, frame=TURNED)
    yield draw(
        "park_day_with",
        street.map,
        [street.go("ego", "car", 100, [(0, 4), (4, 0), (99, 0)], 2.3)],
        75,
        [("ukhc.r239.parked-with-traffic", "pass", "faces with the traffic")],
        hz=5,
    )
    street = two_way(kind="town", limit=17.88, length=900, frame=TURNED)
    street.road.types = [(0.0, "town", 17.88), (300.0, "town", 13.41)]
    ego = street.go("ego", "car", 150, 16.5, N)
    why = "37 mph after the limit drops to 30"
    yield draw("x_limit_changes", street.map, [ego], 18, [("ukhc.r124.speed-limit", "fail", why)])
    street = two_way(kind="town", limit=13.41, length=900)
    street.road.types = [(0.0, "town", 13.41), (200.0, "rural", 26.82)]
    ego = street.go("ego", "car", 100, [(0, 13), (7.5, 13), (12, 18), (99, 18)], N)
    why = "speeds up only after the limit rose"
    yield draw("x_limit_rises", street.map, [ego], 18, [("ukhc.r124.speed-limit", "pass", why)])


def cyclists() -> Iterator[Drive]:
    """Cyclists passed otherwise than in most drives."""
    for name, u, bike, frame, why in (
        ("x_bike_other_lane", 4.35, 2.2, TURNED, "passed on the left, 0.95 m, the cyclist in the other lane"),
        ("x_bike_lane2_near", 1.75, 4.0, (0.0, 0.0, 0.0), "1.05 m, the ego in lane 2, cyclist in lane 1"),
    ):
        street = two_way(n=2, kind="town", limit=17.88, length=900, frame=frame)
        actors = [street.go("ego", "car", 150, 12, u), street.go("b", "bicycle", 190, 5, bike)]
        yield draw(name, street.map, actors, 16, [("ukhc.r163.cyclist", "fail", why)])
    street = two_way(length=900)
    yield draw(
        "x_bike_centre",
        street.map,
        [street.go("ego", "car", 150, 10, 2.4), street.go("b", "bicycle", 190, 4, 0.3)],
        14,
        [("ukhc.r163.cyclist", "fail", "0.9 m on the near side of a cyclist by the middle")],
        hz=20,
    )
    yield draw(
        "x_bike_lowrate",
        street.map,
        [street.go("ego", "car", 150, 16, [(0, N), (1, N), (2.5, 0.9)]), street.go("b", "bicycle", 190, 4, 2.9)],
        12,
        [("ukhc.r163.cyclist", "fail", "0.8 m at 2 Hz")],
        hz=2,
    )
