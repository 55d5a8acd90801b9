"""Great Britain: those who are met when turning, queues and roundabouts."""

from __future__ import annotations

from tests.outsiders.fifth.cast import (
    BIKE,
    BUS,
    CAR,
    VAN,
    drive,
    ego,
    turned,
    walk,
)
from tests.outsiders.fifth.drive import Drive, draw
from tests.outsiders.fifth.places import (
    EAST,
    NORTH,
    Cross,
    lit,
)
from tests.outsiders.fifth.roundabout import Round
from tests.outsiders.fifth.ways import Speed


def british_corners() -> list[Drive]:
    found: list[Drive] = []
    place = lit(False, walk=2.0, w=4.5)
    way = place.path(0, NORTH)
    other = place.path(0, EAST, din=1.5, dout=1.5)
    begins = place.arms[0].pose(0, place.t_in)
    edge, edge_too = (way.near(*begins[:2]), other.near(*begins[:2]))
    found.append(
        draw(
            "gb_left_hook_g",
            "Turns left across the cyclist beside it, who brakes hard.",
            "fail h3.no-cut-across r182.no-pass-before-turn",
            place.world,
            [
                ego(way, Speed(9.5, edge - 9.5 * 9).hold(7.5).to(6, 2.2).hold(5).to(9, 1), 24, ind=((7, 14, "left"),)),
                drive(
                    "bike",
                    "bicycle",
                    BIKE,
                    other,
                    Speed(5.6, edge_too - 5.0 - 5.6 * 9).hold(9.1).to(2.0, 3.2).hold(3).to(5, 1),
                    24,
                ),
            ],
        )
    )
    place = lit(False, walk=2.0, w=4.5)
    way = place.path(0, NORTH)
    other = place.path(0, EAST, din=1.5, dout=1.5)
    found.append(
        draw(
            "gb_left_waits_bike_g",
            "Lets the cyclist go and turns behind.",
            "pass h3.no-cut-across r182.no-pass-before-turn",
            place.world,
            [
                ego(
                    way,
                    Speed(7, edge - 85).hold(5).to(4.2, 0.8).hold(7).to(3.6, 0.5).hold(8).to(8, 1),
                    36,
                    ind=((6, 28, "left"),),
                ),
                drive("bike", "bicycle", BIKE, other, Speed(5.6, edge_too - 52), 36),
            ],
        )
    )
    place = lit(False, walk=2.0, w=4.5)
    way = place.path(0, NORTH)
    other = place.path(0, EAST, din=1.5, dout=1.5)
    bike = drive(
        "bike", None, BIKE, other, Speed(5.6, edge_too - 5.0 - 5.6 * 9).hold(9.1).to(2.0, 3.2).hold(3).to(5, 1), 24
    )
    found.append(
        draw(
            "gb_left_hook_nameless_g",
            "The same hook with a two-wheeler of no class, drawn backwards.",
            "not pass h3.no-cut-across",
            place.world,
            [
                ego(way, Speed(9.5, edge - 9.5 * 9).hold(7.5).to(6, 2.2).hold(5).to(9, 1), 24, ind=((7, 14, "left"),)),
                turned(bike),
            ],
        )
    )
    place = lit(False, walk=2.0)
    way = place.path(0, NORTH)
    here = way.near(*place.arms[3].pose(3.5, place.t_out)[:2])
    found.append(
        draw(
            "gb_turns_before_walker_g",
            "Squeezes through before a walker who is already on the road into which it turns.",
            "fail h2.turn-pedestrian | pass no-collision",
            place.world,
            [
                ego(way, Speed(6, here - 6 * 14), 26, ind=((6, 16, "left"),)),
                walk([place.arms[3].pose(3.5, -6)[:2], place.arms[3].pose(3.5, 6)[:2]], 1.4, 10.2, until=26),
            ],
        )
    )
    place = lit(False, walk=2.0)
    way = place.path(0, NORTH)
    at = place.front(0, way, 0)
    found.append(
        draw(
            "gb_turns_after_walker_g",
            "Waits until the walker has left the road.",
            "pass h2.turn-pedestrian no-collision",
            place.world,
            [
                ego(
                    way,
                    Speed(7, 20).stop_at(at + 3, 1.5).till(25).to(5, 1.2).hold(5).to(8, 1),
                    40,
                    ind=((9, 30, "left"),),
                ),
                walk([place.arms[3].pose(3.5, 6)[:2], place.arms[3].pose(3.5, -6)[:2]], 1.3, 14.0, until=40),
            ],
        )
    )
    for name, _hold, exp, why in (
        ("blocks", 0.0, "fail", "stands 20 s in the junction behind a queue"),
        ("leaves_room", 22.0, "not fail", "waits before the junction until there is room"),
    ):
        place = Cross((180, 270, 0), walk=2.0, length=160)
        way = place.path(0, 2)
        beyond = way.near(*place.arms[2].pose(2, place.t_out)[:2])
        at = place.front(0, way, 0)
        stop = beyond - 7.5 if name == "blocks" else at - 4
        found.append(
            draw(
                f"gb_queue_{name}_g",
                f"{why}.",
                f"{exp} r151.side-roads-clear",
                place.world,
                [
                    ego(way, Speed(6, 40).stop_at(stop, 1.2).till(46).to(7, 1.2), 58, hz=5),
                    *[
                        drive(
                            f"q{i}",
                            "car",
                            CAR,
                            way,
                            Speed(0, beyond + 6.6 * i - 0.6).hold(42 - 2 * i).to(7, 1.2),
                            58,
                            hz=5,
                        )
                        for i in range(4)
                    ],
                ],
            )
        )
    ring = Round()
    way = ring.wrong_way(2, 0)
    found.append(
        draw(
            "gb_roundabout_wrong_way_g",
            "Anticlockwise round a British roundabout.",
            "fail r143.direction",
            ring.world,
            [ego(way, Speed(7, 20), 26)],
        )
    )
    ring = Round()
    way = ring.path(2, 3)
    found.append(
        draw(
            "gb_roundabout_three_quarters_g",
            "Clockwise all the way.",
            "pass r143.direction | not fail r180.right-turn-gap",
            ring.world,
            [
                ego(
                    way,
                    Speed(6.2, 30).hold(5).to(4.5, 0.8).hold(16).to(6, 0.5),
                    36,
                    ind=((3, 18, "right"), (18, 26, "left")),
                ),
                drive("bus", "bus", BUS, ring.path(1, 3), Speed(5, 75), 36),
            ],
        )
    )
    ring = Round()
    way = ring.path(2, 0)
    other = ring.path(3, 1)
    spot = ring.ways[2][1].pose(ring.ways[2][1].length - 6, 2.3)
    speed, merges = (way.near(*spot[:2]), other.near(*spot[:2]))
    found.append(
        draw(
            "gb_roundabout_barges_in_g",
            "Clockwise.",
            "pass r143.direction no-collision",
            ring.world,
            [
                ego(way, Speed(6, speed - 6 * 11), 24),
                drive(
                    "van",
                    "van",
                    VAN,
                    other,
                    Speed(6.5, merges - 7.2 - 6.5 * 11).hold(9.6).to(3.5, 2.6).hold(2).to(6, 1),
                    24,
                ),
            ],
        )
    )
    return found
