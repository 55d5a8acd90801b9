"""Great Britain: traffic lights."""

from __future__ import annotations

from tests.outsiders.fifth.cast import (
    BUS,
    CAR,
    drive,
    ego,
    noisy,
)
from tests.outsiders.fifth.drive import Drive, draw, light
from tests.outsiders.fifth.places import (
    EAST,
    NORTH,
    SOUTH,
    lit,
)
from tests.outsiders.fifth.ways import Speed


def british_lights() -> list[Drive]:
    found: list[Drive] = []
    place = lit(walk=2.0)
    way = place.path(0, EAST)
    found.append(
        draw(
            "gb_red_run_g",
            "Over the line 5 s after the light turned red.",
            "fail r175.red | pass no-collision",
            place.world,
            [
                ego(way, Speed(11.5, 5), 20),
                drive("other", "car", CAR, place.path(1, 3), Speed(0, 100).hold(12).to(8, 2), 20),
            ],
            lights=light("L0", (0, "green"), (2, "amber"), (5, "red")),
        )
    )
    place = lit(walk=2.0)
    place.light(0, "L0b", s=-0.0 + 0.3)
    way = place.path(0, NORTH)
    found.append(
        draw(
            "gb_red_two_heads_g",
            "Both heads are red when it turns left.",
            "fail r175.red",
            place.world,
            [ego(way, Speed(9, 5).at(85).to(6, 1).hold(8).to(9, 1), 26, ind=((4, 19, "left"),))],
            lights=light("L0", (0, "amber"), (3, "red")) + light("L0b", (0, "amber"), (3, "red")),
        )
    )
    place = lit(walk=2.0)
    place.light(0, "L0b", s=0.3)
    way = place.path(0, EAST)
    found.append(
        draw(
            "gb_red_one_head_silent_g",
            "One head is red, the other is not in the log.",
            "not pass r175.red",
            place.world,
            [ego(way, Speed(10, 5), 22)],
            lights=light("L0", (0, "red")),
        )
    )
    place = lit(walk=2.0)
    way = place.path(0, EAST)
    at = place.front(0, way, 1.0)
    found.append(
        draw(
            "gb_amber_too_late_g",
            "Amber, not red, when it crosses the line.",
            "pass r175.red",
            place.world,
            [ego(way, Speed(12.5, 5), 18)],
            lights=light(
                "L0",
                (0, "green"),
                (round((at - 2.2 - 5) / 12.5 - 0.9, 1), "amber"),
                (round((at - 2.2 - 5) / 12.5 + 2.1, 1), "red"),
            ),
        )
    )
    place = lit(walk=2.0)
    way = place.path(0, SOUTH)
    at = place.front(0, way, 1.0)
    found.append(
        draw(
            "gb_red_amber_jump_g",
            "Goes over the line on red and amber.",
            "fail r175.red | not fail r180.corner-cut",
            place.world,
            [
                ego(
                    way,
                    Speed(9, 5).stop_at(at - 2.9, 1.6).till(19).to(6, 1.8).hold(6).to(9, 1.2),
                    34,
                    ind=((9, 24, "right"),),
                )
            ],
            lights=light("L0", (0, "red"), (18.7, "red_amber"), (22.5, "green")),
        )
    )
    place = lit(walk=2.0)
    way = place.path(0, EAST)
    at = place.front(0, way, 1.0)
    found.append(
        draw(
            "gb_stands_over_line_g",
            "Its front rolls 1.6 m over the line on red and stands there.",
            "fail r175.red",
            place.world,
            [ego(way, Speed(9, 5).stop_at(at - 2.2 + 1.6, 2).till(24).to(8, 1.5), 34, hz=5)],
            lights=light("L0", (0, "red"), (23, "red_amber"), (23.6, "green")),
        )
    )
    place = lit(walk=2.0, kind="object")
    way = place.path(0, EAST)
    at = place.front(0, way, 1.0)
    found.append(
        draw(
            "gb_stands_short_g",
            "Stands 2.4 m before the line.",
            "fail performance.precise-stop | pass r175.red",
            place.world,
            [ego(way, Speed(9, 5).stop_at(at - 2.2 - 2.4, 1.5).till(24).to(9, 1.2), 38)],
            lights=light("L0", (0, "red"), (22, "red_amber"), (23.4, "green")),
        )
    )
    place = lit(walk=2.0)
    way = place.path(0, EAST)
    at = place.front(0, way, 1.0)
    found.append(
        draw(
            "gb_waits_green_noise_g",
            "Waits for green, 0.9 m before the line.",
            "pass r175.red | not fail no-collision",
            place.world,
            [noisy(ego(way, Speed(9, 6).stop_at(at - 2.2 - 0.9, 1.5).till(24).to(9, 1.2), 38), 7)],
            lights=light("L0", (0, "red"), (22, "red_amber"), (23.2, "green")),
        )
    )
    place = lit(walk=2.0, length=160)
    way = place.path(0, EAST)
    beyond = way.near(*place.arms[2].pose(3, place.t_out)[:2])
    found.append(
        draw(
            "gb_green_exit_blocked_g",
            "Drives in on green behind a standing bus and stands in the junction.",
            "fail r176.green-exit-clear | pass r175.red",
            place.world,
            [
                ego(way, Speed(9, 10).stop_at(beyond - 8.2, 1.8).till(33).to(6, 1.5), 42),
                drive("queue", "bus", BUS, way, Speed(0, beyond + 1.2).hold(31).to(6, 1.2), 42),
                drive("queue2", "car", CAR, way, Speed(0, beyond + 11.2).hold(29).to(6, 1.2), 42),
            ],
            lights=light("L0", (0, "green")),
        )
    )
    return found
