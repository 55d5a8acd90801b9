"""Great Britain: what stands or comes in the way, and logs that are not to be trusted."""

from __future__ import annotations

import numpy as np

from tests.outsiders.eleventh.drive import Drive
from tests.outsiders.eleventh.motion import Actor, actor, ego, frozen, jumped, line, still, track
from tests.outsiders.eleventh.places import STRAIGHT, N, beside, near
from tests.outsiders.eleventh.road import GB, crossing, simple


def british_hindrances() -> list[Drive]:
    plain, way = simple(GB, STRAIGHT, speed=60)
    town, street = simple(GB, [(500.0, 0.0)], kind="town", speed=30, verge="sidewalk")
    narrow, lane = simple(GB, STRAIGHT, speed=60, w=2.6)
    zebra, over = simple(GB, [(400.0, 0.0)], kind="rural", speed=40, objects=crossing("5", 210, 7))
    return [
        Drive(
            "gb_obstruction_forces",
            plain,
            [
                ego(track(way, 24, 60, 14, lat=beside(-1.4, 10))),
                actor("p", "car", still(way, 200, 2.0, 24)),
                actor("o", "car", track(way, 24, 420, 17, [(7, -5.5), (10.2, 0.8)], lat=near(GB, -N), way=-1)),
            ],
            expect=[
                (
                    "ukhc.r163.obstruction-give-way",
                    "fail",
                    "the oncoming car brakes with 5.5 m/s2 for the ego, who passes a parked car",
                )
            ],
        ),
        Drive(
            "gb_obstruction_waits",
            plain,
            [
                ego(
                    track(
                        way,
                        34,
                        60,
                        12,
                        [(4.5, -1.7), (18, 1.5), (24, 0)],
                        [(0, N), (19, N), (22.5, -1.4), (26, -1.4), (29, N)],
                    )
                ),
                actor("p", "car", still(way, 178, 2.0, 34)),
                actor("o", "car", track(way, 34, 440, 16, lat=near(GB, -N), way=-1)),
            ],
            expect=[
                ("ukhc.r163.obstruction-give-way", "not fail", "waits until the oncoming car is past"),
                ("ukhc.no-collision", "pass", "clear"),
            ],
        ),
        Drive(
            "gb_pavement",
            town,
            [
                ego(track(street, 20, 40, 12, lat=[(0, N), (6, N), (8.5, 4.0), (11, 4.0), (13.5, N)])),
                actor("v", "van", still(street, 150, 0.6, 20)),
            ],
            expect=[("ukhc.r145.off-road", "fail", "drives on the pavement at 12 m/s, past a standing van")],
        ),
        Drive(
            "gb_dog",
            plain,
            [
                ego(track(way, 16, 60, 19, lat=near(GB))),
                Actor("d", "animal", (0.9, 0.3, 0.6), track(line(200, 6, -np.pi / 2), 16, -3.3, 1.0)),
            ],
            expect=[("ukhc.no-collision", "fail", "runs over a dog that walks across")],
        ),
        Drive(
            "gb_frozen_ahead",
            plain,
            [
                ego(track(way, 20, 60, 17, lat=near(GB))),
                actor("g", "car", frozen(track(way, 20, 95, 17, lat=near(GB)), 7)),
            ],
            expect=[
                (
                    "ukhc.no-collision",
                    "not pass",
                    "the track ahead freezes in the ego's lane at 7 s and the ego goes through it",
                ),
                (
                    "ukhc.r126.thinking-gap",
                    "not pass",
                    "nothing is known of the gap after that, and the frozen one is passed through",
                ),
            ],
        ),
        Drive(
            "gb_teleport",
            plain,
            [
                ego(track(way, 20, 60, 17, lat=near(GB))),
                actor("g", "car", jumped(track(way, 20, 150, 17, lat=near(GB)), 10, 0, 80.0)),
            ],
            expect=[
                ("ukhc.no-collision", "pass", "the one that jumps away was 90 m ahead"),
                ("ukhc.r126.thinking-gap", "not fail", "90 m, and then the one ahead is gone"),
            ],
        ),
        Drive(
            "gb_narrow_bus",
            narrow,
            [
                ego(track(lane, 20, 60, 16, lat=[(0, 1.3)], hz=25)),
                actor("o", "bus", track(lane, 20, 500, 15, lat=[(0, -1.35)], way=-1, hz=25)),
            ],
            expect=[
                ("ukhc.no-collision", "pass", "0.5 m between a bus and the ego on a narrow road"),
                ("ukhc.r143.direction", "pass", "keeps its side"),
            ],
        ),
        Drive(
            "gb_zebra_overtake",
            zebra,
            [
                ego(track(over, 20, 60, 16, lat=[(0, N), (4, N), (6.5, -N), (12, -N), (14, N)])),
                actor("b", "car", track(over, 20, 103.7, 11, lat=near(GB))),
            ],
            expect=[("ukhc.r191.crossing-overtake", "fail", "gets past a moving car within the zig-zags of a zebra")],
        ),
    ]
