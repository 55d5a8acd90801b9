"""Great Britain: limits, gaps, sides of the road, lamps."""

from __future__ import annotations

import numpy as np

from tests.outsiders.eleventh.drive import Drive
from tests.outsiders.eleventh.motion import Actor, actor, ego, gone, line, towed, track
from tests.outsiders.eleventh.places import STRAIGHT, N, near
from tests.outsiders.eleventh.road import GB, simple


def british_roads() -> list[Drive]:
    plain, way = simple(GB, STRAIGHT, speed=60)
    towing = track(way, 16, 100, 25.4, lat=near(GB))
    lorry = actor("l", "truck", track(way, 20, 94, 21, lat=near(GB)))
    town, street = simple(GB, [(500.0, 0.0)], kind="town", speed=30, verge="sidewalk")
    short, _ = simple(GB, [(260.0, 0.0)], speed=60)
    return [
        Drive(
            "gb_towing_57",
            plain,
            [ego(towing), actor("tr", "trailer", towed(towing, 5.0))],
            conditions={"vehicle_class": "car_towing"},
            expect=[
                ("ukhc.r124.speed-limit", "fail", "57 mph with a trailer on a single carriageway, where 50 is allowed")
            ],
        ),
        Drive(
            "gb_towing_unsaid",
            plain,
            [ego(towing.copy()), actor("tr", "trailer", towed(towing, 5.0))],
            expect=[
                (
                    "ukhc.r124.speed-limit",
                    "not pass",
                    "57 mph with a trailer behind it, though the log names no class of vehicle; 50 is allowed",
                )
            ],
        ),
        Drive(
            "gb_lorry_56",
            plain,
            [ego(track(way, 16, 100, 25.2, lat=near(GB), hz=5), "truck")],
            conditions={"vehicle_class": "goods_over_7t5"},
            expect=[("ukhc.r124.speed-limit", "fail", "a heavy lorry at 56 mph; 50 in England, 40 in Scotland")],
        ),
        Drive(
            "gb_tailgating",
            plain,
            [
                ego(track(way, 20, 60, 21, lat=near(GB), hz=20)),
                actor("l", "car", track(way, 20, 72, 21, lat=near(GB), hz=20)),
            ],
            expect=[
                ("ukhc.r126.thinking-gap", "fail", "7.6 m at 21 m/s; thinking takes 14 m"),
                ("criticality.thw", "fail", "0.36 s"),
            ],
        ),
        Drive(
            "gb_behind_long_trailer",
            plain,
            [
                ego(track(way, 20, 60, 21, lat=near(GB))),
                lorry,
                Actor("tr", "trailer", (12.0, 2.4, 3.0), towed(lorry.rows, 12.0)),
            ],
            expect=[("criticality.thw", "fail", "13.8 m to the trailer's rear at 21 m/s are 0.66 s")],
        ),
        Drive(
            "gb_child_runs",
            town,
            [
                ego(track(street, 14, 60, 12.4, [(4.5, -7.5)], near(GB))),
                actor(
                    "k", "pedestrian", track(line(131, 5.2, -np.pi / 2), 14, 0.0, 0.0, [(3.9, 4.0), (4.6, 0)], hz=10)
                ),
            ],
            expect=[
                ("ukhc.no-collision", "pass", "stops in time for the child"),
                ("ukhc.r124.speed-limit", "pass", "28 mph"),
                ("ukhc.contact-signature", "not fail", "hard braking, no contact"),
                ("comfort.decel-iso15622", "fail", "7.5 m/s2 for over a second"),
            ],
        ),
        Drive(
            "gb_wrong_side",
            plain,
            [ego(track(way, 26, 60, 17, lat=[(0, N), (3, N), (6, -N)]))],
            expect=[("ukhc.r143.direction", "fail", "20 s at 17 m/s in the opposing lane for nothing")],
        ),
        Drive(
            "gb_wrong_way",
            plain,
            [
                ego(track(way, 26, 1250, 16, lat=near(GB), way=-1)),
                actor("o", "car", gone(track(way, 26, 40, 16, lat=[(0, N), (3, N), (6, 0.2), (20, 0.2), (23, N)]), 14)),
            ],
            expect=[
                (
                    "ukhc.r143.direction",
                    "fail",
                    "drives against its lane all along: the lane is that of the oncoming traffic",
                )
            ],
        ),
        Drive(
            "gb_hazards_on",
            short,
            [ego(track(way, 20, 60, 18, lat=near(GB)), lamps=[(2, 20, "hazard")])],
            expect=[
                ("ukhc.r116.hazards", "fail", "hazard lights on at 18 m/s on a country road; the map ends halfway")
            ],
        ),
        Drive(
            "gb_night_dark",
            plain,
            [ego(track(way, 20, 60, 18, lat=near(GB)))],
            conditions={"light": "night"},
            events=[(0.0, "headlights", "on"), (6.0, "headlights", "off")],
            expect=[("ukhc.r113.headlights", "fail", "night, 60 mph road, headlights off from 6 s on")],
        ),
    ]
