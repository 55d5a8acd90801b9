"""Great Britain: motorways."""

from __future__ import annotations

from tests.outsiders.third.cast import ON_1, ON_2, ON_3, SLOW_1
from tests.outsiders.third.drive import Drive, draw
from tests.outsiders.third.maps import EXIT_WAY, START, exit_map, lane_of, motorway
from tests.outsiders.third.movement import car, ego, who
from tests.outsiders.third.ways import EAST, Way, line


def british_motorways() -> list[Drive]:
    queue = [car(EAST, (0, 400 - 9 * i), 0, ON_2, name=f"queue_{i}") for i in range(3)]
    crawl = [car(EAST, (0, 60 + 15 * i), 5, lane_of(2 - i % 2, 2), name=f"queue_{i}") for i in range(5)]
    leaves = [(5.5, -1.75), (9.5, 1.75)]
    return [
        draw(
            "gb_hazards_for_motorway_queue",
            "The ego warns with its hazard lights and stops behind a motorway queue.",
            "not fail r116.hazards r240.no-stopping r126.thinking-gap | pass r269.hard-shoulder",
            motorway(),
            [
                ego(EAST, (20, 390), [(0, 30), (4, 30), (17, 0)], ON_1, blink=((4.0, 19.0, "hazard"),)),
                car(EAST, (0, 400), 0, ON_1),
                *queue,
            ],
            26,
        ),
        draw(
            "gb_cut_in_drops_back",
            "A car moves in 20 m ahead and the ego drops back to two seconds.",
            "pass r168.drop-back criticality.ttc | not fail r126.thinking-gap",
            motorway(),
            [
                ego(EAST, (0, 0), [(0, 28), (4.5, 28), (8, 23.5), (14, 24), (18, 27)], ON_1),
                car(EAST, (0, 21), 29, [(2, ON_2), (6, ON_1)], blink=((0.0, 5.0, "near"),)),
            ],
            22,
        ),
        draw(
            "gb_cut_in_stays",
            "A car moves in 11 m ahead and the ego stays there for half a minute.",
            "fail r168.drop-back r126.thinking-gap criticality.thw",
            motorway(),
            [ego(EAST, (0, 0), 28, ON_1), car(EAST, (0, 15.5), 28, [(2, ON_2), (6, ON_1)])],
            34,
        ),
        draw(
            "gb_hard_shoulder_3",
            "The ego passes a crawling queue on the hard shoulder.",
            "fail r269.hard-shoulder",
            motorway(2),
            [ego(EAST, (0, 0), [(0, 8), (3, 8), (8, 17)], [(1, SLOW_1), (5, lane_of(0, 2))]), *crawl],
            16,
        ),
        draw(
            "gb_breakdown",
            "The ego breaks down, warns and stops on the hard shoulder.",
            "not fail r269.hard-shoulder r240.no-stopping",
            motorway(),
            [
                ego(
                    EAST,
                    (0, 0),
                    [(0, 25), (4, 25), (16, 0)],
                    [(4, ON_1), (9, lane_of(0, 3))],
                    blink=((3.0, 4.0, "near"), (4.0, 99.0, "hazard")),
                )
            ],
            30,
            events=[(0, "emergency_manoeuvre", "off"), (3, "emergency_manoeuvre", "on")],
        ),
        draw(
            "gb_motorway_reverse",
            "The ego stops on the motorway and reverses to an exit it has missed.",
            "fail r263.no-reverse r143.direction",
            motorway(),
            [ego(EAST, (7, 100), [(0, 15), (6, 0), (8, 0), (10, -3), (20, -3)], ON_1)],
            20,
        ),
        draw(
            "gb_motorway_stop_3",
            "The ego stops on an empty motorway for twelve seconds.",
            "fail r240.no-stopping",
            motorway(),
            [ego(EAST, (0, 0), [(0, 25), (3, 25), (13, 0), (26, 0), (36, 18)], ON_1)],
            36,
        ),
        draw(
            "gb_motorway_sheep",
            "The ego stops on a motorway for a sheep that stands in its lane.",
            "not fail r240.no-stopping r116.hazards | pass no-collision",
            motorway(),
            [
                ego(EAST, (15, 180), [(0, 25), (3, 25), (12, 0), (22, 0), (30, 15)], ON_1),
                who(
                    "sheep",
                    "animal",
                    line(192, ON_1 + 6, -90),
                    (10, 5.5),
                    [(0, 0), (5, 0), (6, 1), (10.5, 1), (11, 0), (17, 0), (18, 1.5)],
                    0,
                    size=(1.2, 0.5, 0.9),
                ),
            ],
            30,
        ),
        draw(
            "gb_lorry_in_lane_three",
            "A heavy lorry uses the right-hand lane of three.",
            "fail r265.right-lane-ban",
            motorway(),
            [ego(EAST, (0, 0), 22, ON_3, kind="truck"), who("truck", "truck", EAST, (0, 40), 20, ON_2)],
            20,
            vehicle_class="goods_over_7t5",
        ),
        draw(
            "gb_exit_without_signal",
            "The ego leaves the motorway without a signal.",
            "fail exit-sign-signal",
            exit_map(),
            [ego(EXIT_WAY, (0, -100), 24, leaves)],
            20,
        ),
        draw(
            "gb_signals_but_stays",
            "The ego signals to leave and drives on along the motorway.",
            "fail signal-then-leaves",
            exit_map(),
            [ego(Way(-START, 9.0, 0, [(1500, 0)], START), (0, -100), 24, -1.75, blink=((4.5, 14.0, "near"),))],
            24,
        ),
        draw(
            "gb_exit_properly",
            "The ego signals and leaves the motorway.",
            "pass exit-sign-signal signal-then-leaves | not fail r269.hard-shoulder",
            exit_map(),
            [ego(EXIT_WAY, (0, -100), 24, leaves, blink=((0.5, 11.0, "near"),))],
            18,
        ),
    ]
