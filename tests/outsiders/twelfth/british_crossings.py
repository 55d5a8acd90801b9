"""Great Britain: crossings for those on foot."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.twelfth.cast import (
    GB,
    N1,
    ego,
    same,
    walk,
)
from tests.outsiders.twelfth.drive import Actor, Drive, draw
from tests.outsiders.twelfth.junction import Cross
from tests.outsiders.twelfth.maps import (
    one_way_zebra,
    pelican_street,
    zebra_street,
)
from tests.outsiders.twelfth.ways import Straight, Walk


def british_crossings() -> Iterator[Drive]:
    c = Cross(True, zebras={3: "zebra"})
    yield draw(
        "gb_turn_zebra_walker",
        c.map,
        [
            ego(c.drive(0, 3, 100, 5.0), ind=[(0, "left")]),
            Actor(
                "p",
                "pedestrian",
                Walk([(0, -6, -19), (9.0, -6, -19), (13.5, 0.35, -19), (16.5, 0.35, -19), (22, 7, -19)]),
            ),
        ],
        GB,
        25,
        [
            ("ukhc.r195.zebra-on", "fail", "over the zebra in the side road while somebody stands on its half"),
            ("ukhc.h2.turn-pedestrian", "not pass", "turned before somebody crossing"),
        ],
    )
    yield draw(
        "gb_zebra_near_half",
        zebra_street(),
        [ego(Straight(100, N1, 10)), walk((0, 200, 6), (7, 200, 6), (9, 200, 3.15), (11, 200, 3.15), (16, 200, -5))],
        GB,
        18,
        [("ukhc.r195.zebra-on", "fail", "somebody stands on its half at 3.15 m, it drives on")],
    )
    yield draw(
        "gb_zebra_far_half_left",
        zebra_street(tf=(0, 0, 77)),
        [ego(Straight(100, N1, 10)), walk((0, 200, 6), (2, 200, 6), (9, 200, -2.0), (12, 200, -6), (18, 202, -6))],
        GB,
        16,
        [("ukhc.r195.zebra-on", "pass", "who crossed has left its half")],
    )
    yield draw(
        "gb_zebra_night_dark_null",
        zebra_street(),
        [
            ego(Straight(100, N1, 11), noise=0.04),
            Actor(
                "p",
                None,
                Walk([(0, 200, -6), (4, 200, -6), (8, 200, 0.35), (11, 200, 0.35), (15, 200, 6)]),
                size=(0.5, 0.5, 1.7),
            ),
        ],
        {"nation": "gb", "light": "night", "weather": "wet"},
        16,
        [
            ("ukhc.r195.zebra-on", "not pass", "somebody of class NULL and the size of a person is on its half"),
            ("ukhc.r124.speed-limit", "pass", "25 mph"),
        ],
    )
    yield draw(
        "gb_zebra_overtaken",
        one_way_zebra(),
        [ego(Straight(100, 1.75, 11)), Actor("l", "car", Straight(141, 5.25, 6))],
        GB,
        15,
        [("ukhc.r191.crossing-overtake", "fail", "gets past a moving car 10 m before the zebra")],
    )
    yield draw(
        "gb_zebra_passed_stopped",
        one_way_zebra(),
        [
            ego(Straight(80, 1.75, [(0, 10), (20, 10)])),
            Actor("l", "van", Straight(193.5, 5.25, [(0, 0), (14, 0), (17, 6)])),
            walk((0, 200, 9), (8, 200, 9), (10.3, 200, 5.5), (13, 200, 4.2), (18, 200, -2)),
        ],
        GB,
        18,
        [
            ("ukhc.r191.crossing-overtake", "fail", "drives past a van that has stopped for somebody on the zebra"),
            ("ukhc.r195.zebra-on", "not pass", "somebody is on the zebra coming its way"),
        ],
    )
    yield draw(
        "gb_zebra_parked_on",
        zebra_street(),
        [ego(Straight(100, N1, [(0, 10), (7.5, 10), (12.5, 0), (26, 0), (28, 5)]), ind=[(0, "off")])],
        GB,
        32,
        [("ukhc.r191.no-stopping", "fail", "stands 13 s on the zebra, nobody near")],
    )
    yield draw(
        "gb_zebra_queue_on",
        zebra_street(),
        [
            ego(Straight(100, N1, [(0, 10), (7.5, 10), (12.5, 0), (26, 0), (28, 5)])),
            Actor("q", "car", Straight(208, N1, [(0, 0), (25, 0), (28, 6)])),
            Actor("q2", "bus", Straight(218, N1, [(0, 0), (23, 0), (28, 7)])),
        ],
        GB,
        32,
        [
            ("ukhc.r192.keep-clear", "fail", "stands 13 s on the zebra in a queue"),
            ("ukhc.r191.no-stopping", "not fail", "a queue is no stopping"),
        ],
    )
    yield draw(
        "gb_pelican_red",
        pelican_street(),
        [ego(Straight(90, N1, 11)), walk((0, 200, -6), (6, 200, -6), (9, 200, -1.5), (13, 200, 4), (16, 203, 6))],
        GB,
        15,
        [
            ("ukhc.r196.pelican", "fail", "over the crossing on red"),
            ("ukhc.r175.red", "fail", "over the stop line on red"),
        ],
        lights=same((0, "green"), (3, "amber"), (5, "red")),
    )
    yield draw(
        "gb_pelican_flashing",
        pelican_street(tf=(0, 0, 20)),
        [ego(Straight(100, N1, 9.5)), walk((0, 200, 6), (8, 200, 6), (9.6, 200, 3.2), (11.5, 200, 3.2), (16, 200, -6))],
        GB,
        17,
        [("ukhc.r196.pelican", "fail", "amber flashes and somebody is on its half")],
        lights=same((0, "red"), (6, "flashing"), (14, "green")),
    )
    yield draw(
        "gb_pelican_still_there",
        pelican_street(),
        [
            ego(Straight(100, N1, 9.5)),
            walk((0, 200, -6), (4, 200, -6), (9.2, 200, 0.35), (11.6, 200, 0.35), (15, 200, 6)),
        ],
        GB,
        17,
        [("ukhc.r198.still-crossing", "fail", "green for 2 s, somebody still stands on its half")],
        lights=same((0, "red"), (8, "green")),
    )
    yield draw(
        "gb_pelican_kept",
        pelican_street(),
        [
            ego(Straight(102.85, N1, [(0, 10), (6, 10), (11.6, 0.5), (12.2, 0), (17, 0), (20, 7)])),
            walk((0, 200, -6), (9, 200, -6), (16, 200, 5), (20, 200, 6)),
        ],
        GB,
        26,
        [("ukhc.r196.pelican", "pass", "waits on red"), ("ukhc.r175.red", "pass", "waits on red")],
        lights=same((0, "green"), (7, "red"), (16.5, "green")),
    )
