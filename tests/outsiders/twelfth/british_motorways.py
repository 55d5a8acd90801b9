"""Great Britain: motorways."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.twelfth.cast import (
    GB,
    M1,
    M2,
    M3,
    MS,
    ego,
)
from tests.outsiders.twelfth.drive import Actor, Drive, draw
from tests.outsiders.twelfth.maps import (
    exit_motorway,
    mway,
)
from tests.outsiders.twelfth.ways import Straight


def british_motorways() -> Iterator[Drive]:
    yield draw(
        "gb_hazards_queue_motorway",
        mway(),
        [ego(Straight(100, M2, [(0, 30), (3, 30), (13, 5), (25, 5)]), ind=[(0, "off"), (3.5, "hazard"), (14, "off")])]
        + [
            Actor(f"j{i}", c, Straight(420 + 14 * i, y, 3))
            for i, (c, y) in enumerate([("car", M2), ("truck", M1), ("van", M3), ("car", M2)])
        ],
        GB,
        25,
        [
            ("ukhc.r116.hazards", "not fail", "warns those behind of a jam ahead on a motorway"),
            ("ukhc.no-collision", "pass", "slows to 5 m/s well behind the jam"),
        ],
    )
    yield draw(
        "gb_mway_reverse",
        mway(),
        [
            ego(Straight(500, M1, [(0, 12), (4, 0), (6, 0), (8, -3), (16, -3), (18, 0)])),
            Actor("t", "truck", Straight(200, M2, 22)),
        ],
        GB,
        20,
        [
            ("ukhc.r263.no-reverse", "fail", "30 m backwards in the left lane"),
            ("ukhc.r143.direction", "fail", "backwards on a motorway"),
        ],
    )
    yield draw(
        "gb_mway_ghost_ego",
        mway(),
        [
            ego(Straight(1300, M3, 24, way=-1)),
            Actor("c", "car", Straight(100, M1, 29)),
            Actor("d", "car", Straight(60, M2, 31)),
        ],
        GB,
        25,
        [
            ("ukhc.r143.direction", "fail", "against the traffic in the right-hand lane"),
            ("ukhc.r263.no-reverse", "not fail", "drives forwards"),
        ],
    )
    yield draw(
        "gb_shoulder_cruise",
        mway(),
        [ego(Straight(50, M1, 24, moves=[(3, 3, MS)]))]
        + [Actor(f"j{i}", "car", Straight(200 + 20 * i, M1, 15)) for i in range(4)],
        GB,
        25,
        [
            ("ukhc.r269.hard-shoulder", "fail", "past a queue on the hard shoulder at 24 m/s for 18 s"),
            ("ukhc.r240.no-stopping", "pass", "never stands"),
        ],
    )
    yield draw(
        "gb_shoulder_breakdown",
        mway(tf=(9, 9, 250)),
        [
            ego(
                Straight(50, M1, [(0, 25), (4, 25), (13, 0)], moves=[(5, 4, MS)]),
                ind=[(0, "off"), (3, "left"), (7, "hazard")],
            )
        ],
        GB,
        40,
        [
            ("ukhc.r269.hard-shoulder", "not fail", "stops there with hazard lights: a breakdown"),
            ("ukhc.r240.no-stopping", "not fail", "not on the carriageway"),
        ],
    )
    yield draw(
        "gb_mway_stands",
        mway(),
        [ego(Straight(50, M1, [(0, 22), (8, 0)])), Actor("c", "car", Straight(20, M2, 29))],
        GB,
        30,
        [("ukhc.r240.no-stopping", "fail", "stands 22 s in the left lane, nobody ahead")],
    )
    yield draw(
        "gb_lorry_lane_three",
        mway(),
        [ego(Straight(50, M2, 24.5, moves=[(4, 4, M3)]), "truck"), Actor("t", "truck", Straight(110, M2, 23))],
        {"nation": "gb", "vehicle_class": "goods_over_7t5"},
        25,
        [("ukhc.r265.right-lane-ban", "fail", "a lorry over 7.5 t in the right-hand of three lanes")],
    )
    yield draw(
        "gb_tailgate_null_25hz",
        mway(),
        [ego(Straight(50, M2, 28)), Actor("l", None, Straight(64, M2, 28), size=(4.6, 1.9, None), noise=0.03)],
        GB,
        12,
        [
            ("ukhc.r126.thinking-gap", "fail", "9.5 m behind one of class NULL at 28 m/s"),
            ("criticality.thw", "fail", "0.34 s"),
        ],
        hz=25,
    )
    yield draw(
        "gb_tailgate_no_size",
        mway(),
        [ego(Straight(50, M2, 28)), Actor("l", "car", Straight(63, M2, 28), size=(None, None, None))],
        GB,
        12,
        [
            (
                "ukhc.r126.thinking-gap",
                "not pass",
                "centres are 13 m apart, thinking distance 19 m: whatever its length it is too close",
            ),
            ("criticality.thw", "not pass", "less than 0.46 s whatever its length"),
        ],
    )
    yield draw(
        "gb_drop_back_not",
        mway(),
        [ego(Straight(50, M1, 30)), Actor("c", "car", Straight(76.4, M2, 30, moves=[(2, 3, M1)]))],
        GB,
        26,
        [
            ("ukhc.r168.drop-back", "fail", "0.73 s behind the one that moved in, held for 20 s"),
            ("criticality.thw", "fail", "0.73 s, longer than 5 s after the cut-in"),
        ],
    )
    yield draw(
        "gb_mway_jump_lead",
        mway(),
        [ego(Straight(50, M2, 28)), Actor("l", "car", Straight(150, M2, 28), jump=(8.0, -85.0, 0.0))],
        GB,
        16,
        [
            ("ukhc.no-collision", "not fail", "the track ahead jumps back by 85 m, boxes never meet"),
            ("ukhc.r126.thinking-gap", "not pass", "10.6 m behind at 28 m/s after the jump, whoever that is"),
        ],
    )
    yield draw(
        "gb_exit_silent",
        exit_motorway(),
        [ego(Straight(30, M1, 27, moves=[(18, 4, M1 + 3.65)]))],
        GB,
        22,
        [("ukhc.exit-sign-signal", "fail", "leaves by the exit without a signal")],
    )
    yield draw(
        "gb_exit_signalled",
        exit_motorway(tf=(500, 100, 44)),
        [ego(Straight(30, M1, 27, moves=[(18, 4, M1 + 3.65)]), ind=[(0, "off"), (6, "left"), (23, "off")])],
        GB,
        22,
        [
            ("ukhc.exit-sign-signal", "pass", "signals from 190 m on, before both signs"),
            ("ukhc.r269.hard-shoulder", "pass", "never on the shoulder"),
        ],
    )
    yield draw(
        "gb_exit_bluff",
        exit_motorway(),
        [ego(Straight(30, M1, 27), ind=[(0, "off"), (14, "left"), (21, "off")])],
        GB,
        32,
        [("ukhc.signal-then-leaves", "fail", "signals left beside the exit lane and goes straight on")],
    )
