"""Great Britain: logs and maps that lack something."""

from __future__ import annotations

from tests.outsiders.third.cast import VAN, overtaker
from tests.outsiders.third.crossroads import junction, through
from tests.outsiders.third.drive import Drive, draw
from tests.outsiders.third.maps import EXIT_WAY, exit_map, straight, town
from tests.outsiders.third.movement import SIZES, N, car, ego, who
from tests.outsiders.third.ways import EAST, WEST


def british_oddities() -> list[Drive]:
    cyclist = who("cyclist", None, EAST, (0, 30), 4, 2.6, size=SIZES["bicycle"])
    lead = car(EAST, (0, 13.5), 25)
    return [
        draw(
            "gb_tailgates_2_hz",
            "The ego follows a car at 56 mph, 9 m behind it; the log has two steps a second.",
            "fail r126.thinking-gap criticality.thw",
            straight(),
            [ego(EAST, (0, 0), 25), lead],
            20,
            0.5,
        ),
        draw(
            "gb_somebody_on_two_wheels",
            "The ego passes close by somebody whose class the log does not know.",
            "not pass r163.cyclist",
            town(),
            [ego(EAST, (0, -40), 12.5, [(3, N), (5, 0.8), (11, 0.8), (13, N)]), cyclist],
            15,
        ),
        draw(
            "gb_light_not_logged",
            "The ego drives past a light whose state is not in the log.",
            "not pass r175.red | not fail r176.green-exit-clear",
            junction(lights="WNES"),
            [ego(through("W", "ahead"), (5, -2), 11)],
            12,
        ),
        draw(
            "gb_exit_indicator_unknown",
            "The ego leaves the motorway; whether it signals is not known.",
            "unknown exit-sign-signal r116.hazards | not pass signal-then-leaves",
            exit_map(),
            [ego(EXIT_WAY, (0, -100), 24, [(5.5, -1.75), (9.5, 1.75)], blink=None)],
            18,
        ),
        draw(
            "gb_map_ends_early",
            "The ego begins to tail a car after the end of the map.",
            "not pass r126.thinking-gap r143.direction",
            straight(until=150),
            [ego(EAST, (0, 0), [(0, 26), (6, 26), (9, 20)]), car(EAST, (0, 60), 20)],
            22,
        ),
        draw(
            "gb_oncoming_heading_turned",
            "The ego overtakes and nearly hits an oncoming car, whose heading the log has turned round.",
            "not pass r126.ds-disjoint r162.safe-distance-ahead rss.opposite",
            straight(),
            [overtaker(), VAN, car(WEST, (15.0, -345), 25, flipped=True)],
            20,
        ),
        draw(
            "gb_noisy_positions",
            "The ego keeps its lane beside a double white line; positions tremble by 5 cm.",
            "not fail r129.no-cross-solid r143.direction contact-signature | pass no-collision",
            straight("solid solid"),
            [ego(EAST, (0, 0), 20, 1.4, noise=0.05), car(WEST, (8, -160), 20, 1.5, noise=0.05)],
            14,
        ),
        draw(
            "gb_unknown_size",
            "The ego drives through the back of a car whose size is not known.",
            "not pass no-collision r126.thinking-gap criticality.ttc",
            town(),
            [ego(EAST, (0, 0), 13), car(EAST, (0, 60), [(0, 8)], size=None)],
            16,
        ),
    ]
