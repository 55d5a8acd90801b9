"""Germany: motorways."""

from __future__ import annotations

from tests.outsiders.fourth.drive import Drive
from tests.outsiders.fourth.faults import jump, noise, turned
from tests.outsiders.fourth.movement import KMH, east, ego, slow, way
from tests.outsiders.fourth.places import V100, V130, F, M
from tests.outsiders.fourth.worlds import motorway


def german_motorways() -> list[Drive]:
    auto, fast, free = motorway(V130), motorway(None), motorway(V100)
    return [
        Drive(
            "de_motorway_6m_at_130",
            "A driver follows at 130 km/h with 6 m between, on a motorway without a limit.",
            "fail stvo.rg1 criticality.thw | not fail stvo.rg3",
            fast,
            [ego(way(100, F), 36.0), east("lead", "car", 110.5, F, 36.0)],
        ),
        Drive(
            "de_motorway_cut_in_restored",
            "A car moves in 5 m ahead and the driver lets off until there is room again.",
            "not fail stvo.rg1 stvo.rg2 stvo.rg4 | pass no-collision",
            fast,
            [
                ego(way(100, M), 30.0, 3.0, (26.0, 1.5)),
                east("cutter", "car", 109.5, F, 30.0, 3.0, (31.0, 0.5), shifts=((60, 150, -3.75),)),
            ],
        ),
        Drive(
            "de_brakes_for_nothing_4",
            "A driver brakes from 33 to 20 m/s with 5 m/s2 on a free motorway before another.",
            "fail stvo.rg2 comfort.decel-iso15622 comfort.jerk-iso15622",
            fast,
            [ego(way(200, M), 33.0, 5.0, (20.0, 5.0)), east("behind", "car", 140, M, 33.0, 5.8, (19.0, 5.0))],
        ),
        Drive(
            "de_speeds_heading_turned",
            "A driver does 130 km/h where 100 are allowed; the log has the heading turned round.",
            "not pass stvo.rg3",
            free,
            [ego(way(100, F), V130)],
            faults=[turned("ego")],
        ),
        Drive(
            "de_crawls_on_motorway",
            "A driver does 60 km/h for half a minute on a free motorway with a limit of 130.",
            "fail stvo.rg4 | pass stvo.rg3",
            auto,
            [ego(way(100, M), 60 * KMH)],
            30.0,
        ),
        Drive(
            "de_behind_slow_lorry_4",
            "A driver follows a lorry that does 60 km/h on a motorway with a limit of 130.",
            "not fail stvo.rg4 | pass stvo.rg1 criticality.thw",
            auto,
            [ego(way(100, M), 60 * KMH), east("lorry", "truck", 143, M, 60 * KMH)],
            30.0,
        ),
        Drive(
            "de_pulls_out_before_fast_car",
            "A driver moves over 25 m before a car at 144 km/h, which has to brake hard.",
            "fail stvo.rg6 | pass no-collision",
            fast,
            [
                ego(way(300, M, shifts=((112, 210, 3.75),)), 28.0, lamp=((1.0, 9.0, "far"),)),
                east("fast", "car", 208, F, 40.0, 5.0, (28.0, 7.0)),
            ],
        ),
        Drive(
            "de_pulls_out_trembling",
            "A driver moves over 60 m before another; the log has 5 cm of noise.",
            "pass stvo.rg6 | not fail stvo.ri3",
            fast,
            [
                ego(way(300, M, shifts=((112, 210, 3.75),)), 28.0, lamp=((1.0, 9.0, "far"),)),
                east("follower", "car", 235, F, 28.0),
            ],
            faults=[noise(0.05, 11)],
        ),
        Drive(
            "de_pulls_out_follower_turned",
            "A driver moves over before a fast car whose heading is logged turned round.",
            "not pass stvo.rg6",
            fast,
            [
                ego(way(300, M, shifts=((112, 210, 3.75),)), 28.0, lamp=((1.0, 9.0, "far"),)),
                east("fast", "car", 208, F, 40.0, 5.0, (28.0, 7.0)),
            ],
            faults=[turned("fast")],
        ),
        Drive(
            "de_stops_on_motorway",
            "A driver stops on the lane of an empty motorway and stands for 15 s.",
            "fail stvo.ri1 | pass stvo.rg2",
            auto,
            [ego(way(100, M), 25.0, 4.0, (0.0, 3.0))],
            28.0,
        ),
        Drive(
            "de_stops_in_jam_track_jumps",
            "A driver stops behind a jam; the car ahead's track jumps off for half a second.",
            "not fail stvo.ri1 no-collision",
            auto,
            [ego(way(100, M), 20.0, *slow(200, 20.0, 0.0, 1.5)), east("jam", "car", 309, M, 0.0)],
            28.0,
            faults=[jump("jam", 5.0, 5.5, 0.0, 3.0)],
        ),
        Drive(
            "de_passes_on_the_right",
            "A driver overtakes a car on its right at 120 km/h, 18 km/h faster.",
            "fail stvo.ri2",
            auto,
            [ego(way(100, M), 33.0), east("slower", "car", 150, F, 28.0)],
        ),
        Drive(
            "de_passes_jam_on_the_right",
            "A driver goes on the right past a queue, 54 against 40 km/h.",
            "not fail stvo.ri2",
            auto,
            [ego(way(100, M), 15.0), *[east(f"queue{i}", "car", 120 + 18 * i, F, 11.0) for i in range(5)]],
        ),
        Drive(
            "de_passes_unsized_on_the_right",
            "A driver overtakes on the right a vehicle of unknown size and kind.",
            "not pass stvo.ri2",
            auto,
            [ego(way(100, M), 33.0), east("slower", None, 150, F, 28.0, size=(None, None, None))],
        ),
        Drive(
            "de_reverses_on_motorway",
            "A driver reverses along the lane of a motorway.",
            "fail stvo.ri3 r263.no-reverse",
            auto,
            [ego(way(100, M), 0.0, 2.0, (-4.0, 1.0), start=200.0)],
        ),
        Drive(
            "de_lorry_25m",
            "A lorry of more than 7.5 t follows another at 79 km/h with 25 m between.",
            "fail stvo.s4-truck | pass stvo.rg3",
            auto,
            [ego(way(100, M), 22.0, kind="truck"), east("lead", "truck", 137, M, 22.0)],
            conditions={"vehicle_class": "goods_over_7t5"},
        ),
        Drive(
            "de_lorry_weight_unknown",
            "A lorry of unknown weight follows another at 79 km/h with 25 m between.",
            "not pass stvo.s4-truck",
            auto,
            [ego(way(100, M), 22.0, kind="truck"), east("lead", "truck", 137, M, 22.0)],
        ),
    ]
