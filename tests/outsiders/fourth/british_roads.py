"""Great Britain: limits, lamps, overtaking, and passing others."""

from __future__ import annotations

import math

from tests.outsiders.fourth.drive import Drive
from tests.outsiders.fourth.faults import lost, turned
from tests.outsiders.fourth.movement import MPH, east, ego, way, west
from tests.outsiders.fourth.places import ALWAYS_UNKNOWN, L
from tests.outsiders.fourth.worlds import two_lane


def british_roads() -> list[Drive]:
    rural, solid = two_lane("rural", 60 * MPH, 2500), two_lane("rural", 60 * MPH, centre="solid")
    town = two_lane("town", 30 * MPH, walk=True)
    overtake = ((120, 185, 3.5), (440, 500, -3.5))
    return [
        Drive(
            "gb_42_in_30",
            "A driver does 42 mph where 30 is allowed.",
            "fail r124.speed-limit",
            town,
            [ego(way(50, L), 42 * MPH)],
        ),
        Drive(
            "gb_lorry_unknown_at_56",
            "A lorry of unknown weight does 56 mph on a single carriageway with a limit of 60.",
            "not pass r124.speed-limit",
            rural,
            [ego(way(100, L), 56 * MPH, kind="truck")],
        ),
        Drive(
            "gb_30_and_a_half",
            "A driver does 30.6 mph where 30 is allowed.",
            "not fail r124.speed-limit",
            town,
            [ego(way(50, L), 30.6 * MPH)],
        ),
        Drive(
            "gb_map_ends_before_speeding",
            "A driver speeds up to 44 mph just after the map has ended.",
            "not pass r124.speed-limit",
            two_lane("town", 30 * MPH, 300.0, walk=True),
            [ego(way(150, L), 28 * MPH, 14.0, (44 * MPH, 2.0))],
            25.0,
        ),
        Drive(
            "gb_lamps_unlogged",
            "A driver drives through a town and the log does not know the lamps.",
            "not pass r116.hazards | pass r124.speed-limit",
            town,
            [ego(way(50, L), 12.0, lamp=ALWAYS_UNKNOWN)],
        ),
        Drive(
            "gb_overtakes_over_solid",
            "A driver overtakes a car at 29 mph across a solid middle line.",
            "fail r129.no-cross-solid",
            solid,
            [ego(way(100, L, shifts=((40, 90, 3.5), (230, 280, -3.5))), 20.0), east("slower", "car", 150, L, 13.0)],
        ),
        Drive(
            "gb_passes_parked_over_solid",
            "A driver goes across a solid line past a parked car.",
            "not fail r129.no-cross-solid r143.direction | pass no-collision",
            solid,
            [ego(way(5, L, shifts=((100, 125, 2.9), (163, 188, -2.9))), 8.0), east("parked", "car", 150, -2.4, 0.0)],
            30.0,
        ),
        Drive(
            "gb_passes_cyclist_over_solid",
            "A driver goes across a solid line past a cyclist at 9 mph with 1.9 m between.",
            "not fail r129.no-cross-solid r143.direction | pass r163.cyclist",
            solid,
            [
                ego(way(50, L, shifts=((40, 70, 1.75), (125, 155, -1.75))), 11.0),
                east("cyclist", "bicycle", 110, -3.1, 4.0),
            ],
        ),
        Drive(
            "gb_wrong_side_heading_turned",
            "A driver keeps to the wrong side for 25 s; the heading is logged turned round.",
            "not pass r143.direction",
            rural,
            [ego(way(100, L, shifts=((45, 75, 3.5),)), 15.0)],
            30.0,
            faults=[turned("ego")],
        ),
        Drive(
            "gb_drive_into_premises",
            "A driver turns slowly across the footway into a property.",
            "not fail r145.off-road r143.direction r131.keep-in-lane",
            town,
            [ego(way(100, L, bends=((12, 0), (6 * math.pi / 2, -1 / 6))), 2.0)],
            12.0,
        ),
        Drive(
            "gb_overtake_clear_4",
            "A driver overtakes; the oncoming car is still most of a mile away.",
            "pass r162.safe-distance-ahead r162.return-gap | not fail r143.direction r129.no-cross-solid rss.opposite",
            rural,
            [
                ego(way(100, L, shifts=overtake), 24.0),
                east("slower", "car", 250, L, 14.0),
                west("oncoming", "car", 2000, -L, 25.0),
            ],
            28.0,
        ),
        Drive(
            "gb_overtake_oncoming_close",
            "A driver overtakes and is back a second before the oncoming car is there.",
            "fail r162.safe-distance-ahead r126.ds-disjoint rss.opposite overtake-zone",
            rural,
            [
                ego(way(100, L, shifts=overtake), 24.0),
                east("slower", "car", 250, L, 14.0),
                west("oncoming", "car", 1140, -L, 25.0),
            ],
            28.0,
        ),
        Drive(
            "gb_overtake_oncoming_unsized",
            "A driver overtakes and is back a second before an oncoming vehicle of unknown size and kind.",
            "not pass r162.safe-distance-ahead r126.ds-disjoint rss.opposite",
            rural,
            [
                ego(way(100, L, shifts=overtake), 24.0),
                east("slower", "car", 250, L, 14.0),
                west("oncoming", None, 1140, -L, 25.0, size=(None, None, None)),
            ],
            28.0,
        ),
        Drive(
            "gb_speeds_up_when_overtaken_4",
            "While a car overtakes it, the ego speeds up with 1.2 m/s2.",
            "fail r168.when-overtaken | pass r124.speed-limit",
            rural,
            [
                ego(way(200, L), 15.0, 4.0, (21.0, 1.2)),
                east("overtaker", "car", 150, L, 24.0, shifts=((50, 100, 3.5), (330, 390, -3.5))),
            ],
            22.0,
        ),
        Drive(
            "gb_cyclist_close_4",
            "A driver passes a cyclist at 29 mph with 0.7 m between.",
            "fail r163.cyclist | pass no-collision",
            town,
            [ego(way(0, L, shifts=((40, 70, 0.55),)), 13.0), east("cyclist", "bicycle", 70, -3.1, 5.0)],
        ),
        Drive(
            "gb_cyclist_lost_beside",
            "A driver passes a cyclist close; the log loses the cyclist just while they are level.",
            "not pass r163.cyclist",
            town,
            [ego(way(0, L, shifts=((40, 70, 0.55),)), 13.0), east("cyclist", "bicycle", 70, -3.1, 5.0)],
            faults=[lost("cyclist", 7.6, 10.2)],
        ),
        Drive(
            "gb_forces_past_parked",
            "A driver goes round a parked car and an oncoming car has to brake hard and wait.",
            "fail r163.obstruction-give-way | pass no-collision",
            town,
            [
                ego(way(0, L, shifts=((108, 132, 2.8), (166, 190, -2.8))), 10.0),
                east("parked", "car", 150, -2.6, 0.0),
                west("oncoming", "car", 225 + 12 * 13.5, -L, 12.0, 13.5, (2.0, 5.0), 5.0, (10.0, 1.5)),
            ],
            26.0,
        ),
        Drive(
            "gb_horse_fast_4",
            "A driver passes a horse at 30 mph with 1 m between.",
            "fail r215.horse",
            rural,
            [ego(way(0, L, shifts=((40, 80, 0.8),)), 13.4), east("horse", "animal", 90, -2.95, 2.0)],
        ),
    ]
