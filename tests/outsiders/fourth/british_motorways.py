"""Great Britain: motorways."""

from __future__ import annotations

from tests.outsiders.fourth.drive import Drive
from tests.outsiders.fourth.movement import MPH, east, ego, slow, way
from tests.outsiders.fourth.places import F, M
from tests.outsiders.fourth.worlds import entry_motorway, exit_motorway, motorway


def british_motorways() -> list[Drive]:
    three, two = motorway(70 * MPH, 3), motorway(70 * MPH)
    slow_lane = -9.375  # lane 3 of three
    exits, entry = exit_motorway(70 * MPH), entry_motorway(70 * MPH)
    leave = way(0, M, shifts=((320, 420, -3.75),), bends=((520, 0.0), (200, -1 / 400)))
    return [
        Drive(
            "gb_towing_at_68",
            "A car that tows a trailer does 68 mph on a motorway.",
            "fail r124.speed-limit | not fail no-collision | pass r265.right-lane-ban",
            three,
            [ego(way(200, slow_lane), 68 * MPH), east("trailer", "trailer", 195, slow_lane, 68 * MPH)],
            conditions={"vehicle_class": "car_towing"},
        ),
        Drive(
            "gb_hazards_before_motorway_queue",
            "A driver warns with hazards while slowing for a motorway queue.",
            "not fail r116.hazards r240.no-stopping",
            three,
            [
                ego(way(100, slow_lane), 28.0, *slow(390, 28.0, 0.0, 2.0), lamp=((9.0, 40.0, "hazard"),)),
                east("queue", "car", 498, slow_lane, 0.0),
            ],
            35.0,
        ),
        Drive(
            "gb_drops_back",
            "A car moves in 8 m ahead on a motorway and the driver drops back.",
            "not fail r126.thinking-gap | pass r168.drop-back",
            two,
            [
                ego(way(100, M), 29.0, 3.5, (25.0, 1.5), 10.0, (27.0, 0.5)),
                east("cutter", "car", 112.5, F, 29.0, 3.0, (31.0, 1.0), shifts=((60, 140, -3.75),)),
            ],
            25.0,
        ),
        Drive(
            "gb_stays_close",
            "A car moves in 8 m ahead on a motorway and the driver stays that close for 25 s.",
            "fail r126.thinking-gap r168.drop-back criticality.thw",
            two,
            [ego(way(100, M), 29.0), east("cutter", "car", 112.5, F, 29.0, shifts=((60, 140, -3.75),))],
            30.0,
        ),
        Drive(
            "gb_astride_4",
            "A driver rides on the line between two lanes of a motorway for 12 s.",
            "fail r131.keep-in-lane",
            two,
            [ego(way(100, M, shifts=((60, 120, 1.9), (480, 540, -1.9))), 30.0)],
        ),
        Drive(
            "gb_lorry_in_right_lane",
            "A lorry of more than 7.5 t drives in the right-hand one of three lanes.",
            "fail r265.right-lane-ban | pass r124.speed-limit",
            three,
            [ego(way(200, F), 24.0, kind="truck")],
            conditions={"vehicle_class": "goods_over_7t5"},
        ),
        Drive(
            "gb_on_hard_shoulder",
            "A driver drives past a jam on the hard shoulder for 10 s.",
            "fail r269.hard-shoulder",
            two,
            [
                ego(way(100, M, shifts=((10, 60, -3.5), (250, 300, 3.5))), 16.0),
                *[east(f"jam{i}", "car", 195 + 12 * i, M, 0.5) for i in range(4)],
            ],
            22.0,
        ),
        Drive(
            "gb_exit_unsignalled_4",
            "A driver leaves a motorway by its exit and never signals.",
            "fail exit-sign-signal",
            exits,
            [ego(leave, 25.0)],
            28.0,
        ),
        Drive(
            "gb_exit_signalled_4",
            "A driver signals before the exit sign, takes the exit lane and leaves.",
            "pass exit-sign-signal signal-then-leaves r269.hard-shoulder",
            exits,
            [ego(leave, 25.0, lamp=((7.0, 22.0, "near"),))],
            28.0,
        ),
        Drive(
            "gb_signals_exit_and_stays",
            "A driver signals left all along the exit and drives straight on.",
            "fail signal-then-leaves | not fail exit-sign-signal",
            exits,
            [ego(way(0, M), 25.0, lamp=((11.0, 22.0, "near"),))],
            32.0,
        ),
        Drive(
            "gb_merges_well",
            "A driver joins between two cars at their speed, each 45 m away.",
            "pass r126.thinking-gap no-collision | not fail r131.keep-in-lane r269.hard-shoulder r168.drop-back",
            entry,
            [
                ego(way(60, -9.375, shifts=((150, 260, 3.75),)), 27.0, lamp=((2.0, 11.0, "far"),)),
                east("before", "car", 112, M, 27.0),
                east("behind", "car", 12, M, 27.0),
            ],
            25.0,
        ),
    ]
