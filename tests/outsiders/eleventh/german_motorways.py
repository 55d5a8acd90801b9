"""Germany: motorways."""

from __future__ import annotations

from tests.outsiders.eleventh.drive import Drive
from tests.outsiders.eleventh.motion import actor, ego, gone, late, track
from tests.outsiders.eleventh.places import INNER, SHOULDER, bahn, on


def german_motorways() -> list[Drive]:
    plain, way = bahn()
    return [
        Drive(
            "de_close",
            plain,
            [ego(track(way, 20, 100, 33, lat=on(1))), actor("a", "car", track(way, 20, 114, 33, lat=on(1)))],
            expect=[("stvo.rg1", "fail", "9.6 m behind at 33 m/s"), ("criticality.thw", "fail", "0.29 s")],
        ),
        Drive(
            "de_cut_in_drops_back",
            plain,
            [
                ego(track(way, 24, 100, 31, [(8, -1.0), (12, 0)], on(1))),
                actor(
                    "a",
                    "car",
                    track(way, 24, 112, 31.5, [(8, 1), (12, 0)], lat=[(0, -INNER[0]), (5, -INNER[0]), (8, -INNER[1])]),
                ),
            ],
            expect=[
                ("stvo.rg1", "not fail", "somebody cuts in and it drops back at once, a second later"),
                ("ukhc.no-collision", "pass", "clear"),
            ],
        ),
        Drive(
            "de_brake_for_nothing",
            plain,
            [
                ego(track(way, 20, 100, 33, [(7, -5), (9.5, 0)], on(2))),
                actor("f", "car", track(way, 20, 20, 33, [(8, -4), (11.3, 0)], on(2))),
            ],
            expect=[("stvo.rg2", "fail", "brakes with 5 m/s2 for nobody")],
        ),
        Drive(
            "de_crawls",
            plain,
            [
                ego(track(way, 40, 100, 16.5, lat=on(1))),
                actor("f", "van", gone(track(way, 40, 20, 17.5, lat=on(2)), 9)),
            ],
            expect=[("stvo.rg4", "fail", "60 km/h where 130 are recommended, nobody ahead")],
        ),
        Drive(
            "de_change_before_fast",
            plain,
            [
                ego(track(way, 20, 200, 29, lat=[(0, -INNER[2]), (6, -INNER[2]), (9.5, -INNER[1])])),
                actor("f", "car", late(track(way, 20, 122, 39, [(6.2, -7), (7.63, 0)], on(1)), 2.0)),
            ],
            expect=[("stvo.rg6", "fail", "changes lane 14 m before a car that comes at 39 m/s")],
        ),
        Drive(
            "de_stops",
            plain,
            [ego(track(way, 36, 100, 27, [(3, -1.8)], on(2)))],
            expect=[
                ("stvo.ri1", "fail", "stops on the carriageway for nothing"),
                ("ukhc.r240.no-stopping", "fail", "stands 15 s on a motorway"),
            ],
        ),
        Drive(
            "de_breakdown",
            plain,
            [
                ego(
                    track(way, 40, 100, 27, [(2, -1.8)], [(0, -INNER[2]), (3, -INNER[2]), (8, -SHOULDER)]),
                    lamps=[(2.5, 40, "hazard")],
                )
            ],
            expect=[
                ("stvo.ri1", "not fail", "breaks down, on the shoulder with hazard lights"),
                ("ukhc.r269.hard-shoulder", "not fail", "an emergency, hazard lights"),
            ],
        ),
        Drive(
            "de_undertakes",
            plain,
            [
                ego(track(way, 26, 100, 34, lat=on(2), hz=20)),
                actor("a", "car", track(way, 26, 160, 28, lat=on(1), hz=20)),
            ],
            expect=[("stvo.ri2", "fail", "passes a car in the middle lane on the right at 34 against 28 m/s")],
        ),
        Drive(
            "de_queue_on_the_right",
            plain,
            [
                ego(track(way, 30, 100, 12.5, lat=on(2))),
                *[
                    actor(f"q{i}", "car" if i % 2 else "truck", track(way, 30, 140 + 22 * i, 9, lat=on(1)))
                    for i in range(6)
                ],
            ],
            expect=[
                ("stvo.ri2", "not fail", "passes a queue of 32 km/h on the right with 13 km/h more"),
                ("stvo.rg4", "not fail", "a jam"),
            ],
        ),
        Drive(
            "de_ghost",
            plain,
            [ego(track(way, 24, 2000, 25, lat=on(1), way=-1)), actor("o", "car", track(way, 24, 300, 30, lat=on(2)))],
            expect=[
                ("stvo.ri3", "fail", "against the traffic on a motorway"),
                ("ukhc.r143.direction", "fail", "the same"),
            ],
        ),
        Drive(
            "de_lorry_30m",
            plain,
            [ego(track(way, 24, 100, 24, lat=on(2)), "truck"), actor("a", "truck", track(way, 24, 141, 24, lat=on(2)))],
            conditions={"vehicle_class": "goods_over_7t5"},
            expect=[
                ("stvo.s4-truck", "fail", "30 m behind a lorry at 86 km/h, 50 m are due"),
                ("stvo.rg3", "fail", "86 km/h, 80 are allowed to lorries"),
            ],
        ),
    ]
