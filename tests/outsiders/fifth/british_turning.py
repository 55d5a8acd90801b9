"""Great Britain: stop signs and turning."""

from __future__ import annotations

from tests.outsiders.fifth.cast import (
    CAR,
    MOTO,
    drive,
    ego,
)
from tests.outsiders.fifth.drive import Drive, draw
from tests.outsiders.fifth.places import (
    NORTH,
    SOUTH,
    lit,
    tee,
)
from tests.outsiders.fifth.ways import Speed


def british_turning() -> list[Drive]:
    found: list[Drive] = []
    place = tee()
    way = place.path(0, 1)
    at = place.front(0, way, 1.0)
    found.append(
        draw(
            "gb_stop_rolled_g",
            "Rolls over the line at 2.4 m/s.",
            "fail r171.stop-sign",
            place.world,
            [ego(way, Speed(9, 5).at(at - 30).to(2.4, 1.6).hold(5).to(8, 1.3), 28, ind=((4, 20, "left"),))],
        )
    )
    place = tee()
    way = place.path(0, 2)
    at = place.front(0, way, 1.0)
    found.append(
        draw(
            "gb_stop_kept_g",
            "Halts behind the line and lets the car pass.",
            "pass r171.stop-sign performance.precise-stop",
            place.world,
            [
                ego(
                    way,
                    Speed(9, 5).stop_at(at - 2.2 - 0.35, 1.5).till(20).to(6, 1.4).hold(4).to(9, 1),
                    34,
                    ind=((8, 27, "right"),),
                ),
                drive("car", "car", CAR, place.path(1, 2), Speed(10, 5), 34),
            ],
        )
    )
    place = tee()
    way = place.path(0, 1)
    at = place.front(0, way, 1.0)
    found.append(
        draw(
            "gb_stop_too_early_g",
            "Halts 17 m before the line and rolls over it at 4 m/s.",
            "fail r171.stop-sign",
            place.world,
            [
                ego(
                    way,
                    Speed(8, 5).stop_at(at - 2.2 - 17, 1.5).till(18).to(4, 1.0).hold(12),
                    34,
                    ind=((6, 30, "left"),),
                )
            ],
        )
    )
    place = lit(False, walk=2.0)
    way = place.path(0, SOUTH)
    other = place.path(2, 0)
    here = way.near(-1.0, -1.0)
    then = 12.0
    mid = place.ways[0, SOUTH]
    here = way.near(*mid.pose(mid.length / 2, 1.75)[:2])
    there = other.near(*mid.pose(mid.length / 2, 1.75)[:2])
    found.append(
        draw(
            "gb_right_turn_forces_g",
            "Turns right about a second before an oncoming car, which has to brake hard.",
            "fail r180.right-turn-gap",
            place.world,
            [
                ego(way, Speed(6.5, here - 6.5 * then), 24, ind=((5, 15, "right"),)),
                drive(
                    "car",
                    "car",
                    CAR,
                    other,
                    Speed(12.5, there - 3.0 - 12.5 * 13.7).hold(11.6).to(7, 3.8).hold(5).to(10, 1),
                    24,
                ),
            ],
        )
    )
    place = lit(False, walk=2.0)
    way = place.path(0, SOUTH)
    other = place.path(2, 0)
    at = place.front(0, way, 0)
    found.append(
        draw(
            "gb_right_turn_waits_g",
            "Waits until both oncoming vehicles are through.",
            "pass r180.right-turn-gap no-collision",
            place.world,
            [
                ego(
                    way,
                    Speed(8, 10).stop_at(at + 1.5, 1.6).till(24).to(6, 1.5).hold(5).to(9, 1),
                    40,
                    ind=((9, 31, "right"),),
                ),
                drive("car", "car", CAR, other, Speed(10, 0), 40, t1=26),
                drive("moto", None, MOTO, other, Speed(11, -60), 40, t0=6, t1=26),
            ],
        )
    )
    place = lit(False, walk=2.0)
    a, bend = (place.arms[1], place.ways[0, SOUTH])
    way = (
        place.arms[0].path((120, place.t_in), (0, place.t_in))
        + bend.path((0, 1.75), (bend.length, -0.4))
        + a.path((0, -0.4), (8, -0.4), (35, place.t_out), (120, place.t_out))
    )
    found.append(
        draw(
            "gb_corner_cut_g",
            "Enters the side road with half of the car on its wrong side.",
            "fail r180.corner-cut",
            place.world,
            [ego(way, Speed(6.5, 30), 32, ind=((5, 18, "right"),))],
        )
    )
    place = lit(False, walk=2.0, w=4.2)
    way = place.path(0, NORTH, dmid=-1.4, dout=-1.15)
    found.append(
        draw(
            "gb_left_turn_wide_g",
            "2.35 m from the near edge of the road it turns into, nobody there.",
            "fail r183.keep-in",
            place.world,
            [ego(way, Speed(5.5, 40), 34, ind=((5, 20, "left"),))],
        )
    )
    place = lit(False, walk=2.0)
    way = place.path(0, NORTH)
    found.append(
        draw(
            "gb_left_turn_tidy_g",
            "0.85 m from the near edge.",
            "pass r183.keep-in | not fail r182.no-pass-before-turn",
            place.world,
            [ego(way, Speed(6, 30), 30, ind=((5, 20, "left"),))],
        )
    )
    return found
