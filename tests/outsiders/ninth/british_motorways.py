"""Great Britain: motorways."""

from __future__ import annotations

from tests.outsiders.ninth.drive import Drive, draw
from tests.outsiders.ninth.maps import MOTORWAY_M, dual, lane
from tests.outsiders.ninth.movement import ego, who
from tests.outsiders.ninth.road import Map, Signal


def _beside_an_exit() -> list[Drive]:
    def exit_map() -> Map:
        signs = Signal(480, -11.5, "exit", lanes=(-2, -2)), Signal(560, -15.0, "exit", lanes=(-2, -2))
        return dual(1400, exit_lane=(500, 820)).having(*signs)

    on = lane(0, 2, MOTORWAY_M)
    return [
        draw(
            "gb_leaves_without_a_signal_k",
            "The ego leaves a motorway without a signal.",
            "fail exit-sign-signal",
            exit_map(),
            [ego(on, 140, 26, [(17, 0), (21, -3.65)])],
            25,
        ),
        draw(
            "gb_signals_and_stays_k",
            "The ego signals beside an exit lane and stays on the motorway.",
            "fail signal-then-leaves",
            exit_map(),
            [ego(on, 140, 26, indicator=[(0, "off"), (13.2, "near"), (25, "off")])],
            27,
        ),
    ]


def british_motorways() -> list[Drive]:
    """Return its drives."""
    return [
        draw(
            "gb_ghost_driver_k",
            "The ego drives against the traffic of a motorway.",
            "fail r143.direction rss.opposite",
            dual(1600, lanes=3),
            [
                ego(lane(2, 3, MOTORWAY_M, against=True), 200, 27),
                who("honest", "car", lane(2, 3, MOTORWAY_M), 200, 30, [(17, 0), (20, -3.65)]),
            ],
            22,
        ),
        draw(
            "gb_lorry_in_lane_three_k",
            "A heavy lorry overtakes in the right-hand lane of three; positions tremble by 3 cm.",
            "fail r265.right-lane-ban",
            dual(1400, lanes=3),
            [
                ego(lane(1, 3, MOTORWAY_M), 60, 25, [(3, 0), (7, 3.65), (19, 3.65), (23, 0)], kind="truck"),
                who("slow", "truck", lane(1, 3, MOTORWAY_M), 140, 20),
            ],
            26,
            noise=0.03,
            vehicle_class="goods_over_7t5",
        ),
        draw(
            "gb_motorway_phone_stop_k",
            "The ego stops in a lane of an empty motorway and sounds its horn.",
            "fail r240.no-stopping r112.horn",
            dual(1400, lanes=3),
            [ego(lane(0, 3, MOTORWAY_M), 60, [(6, 25), (16, 0), (33, 0), (40, 8)])],
            40,
            rate=5,
            events=[(0, "horn", "off"), (22, "horn", "on"), (24, "horn", "off")],
        ),
        *_beside_an_exit(),
    ]
