"""Germany: stopping, passing on the right, and going back."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.sixteenth.cast import DE, FAST, MIDDLE, SHOULDER, SLOW, ego
from tests.outsiders.sixteenth.drive import Actor, Drive, draw
from tests.outsiders.sixteenth.maps import motorway
from tests.outsiders.sixteenth.ways import Motion, against, along


def _stopping() -> Iterator[Drive]:
    yield draw(
        "ri1-queue",
        motorway(),
        [
            ego(along(SLOW, [(0, 20), (5, 20), (20, 0), (40, 0)], 50)),
            Actor("a", "truck", along(SLOW, [(0, 20), (3, 20), (16, 0)], 123.25)),
            Actor("b", "car", along(MIDDLE, [(0, 18), (14, 0)], 70)),
        ],
        DE,
        40,
        [("stvo.ri1", "pass", "queue"), ("ukhc.r240.no-stopping", "not fail", "queue")],
        hz=5,
    )
    yield draw(
        "ri1-far-behind-queue",
        motorway(),
        [ego(along(SLOW, [(0, 20), (5, 20), (20, 0), (45, 0)], 50)), Actor("a", "truck", along(SLOW, 0, 368.25))],
        DE,
        45,
        [
            ("stvo.ri1", "fail", "60 m behind the queue"),
            ("ukhc.r240.no-stopping", "fail", "stands 25 s with 60 m free"),
        ],
        hz=5,
    )
    yield draw(
        "breakdown-on-shoulder",
        motorway(),
        [
            ego(
                along([(0, SLOW), (5, SLOW), (9, SHOULDER)], [(0, 25), (5, 25), (15, 0), (45, 0)], 50),
                ind=[(0, "off"), (3, "right"), (9, "hazard")],
            )
        ],
        DE,
        45,
        [
            ("stvo.ri1", "not fail", "breakdown, hazard lights on at once"),
            ("ukhc.r269.hard-shoulder", "not fail", "breakdown, hazard lights"),
        ],
        hz=5,
    )
    yield draw(
        "shoulder-as-lane",
        motorway(),
        [
            ego(along([(0, SLOW), (4, SLOW), (8, SHOULDER), (20, SHOULDER), (24, SLOW)], 22, 50)),
            Actor("a", "truck", along(SLOW, 16, 130)),
        ],
        DE,
        25,
        [
            ("ukhc.r269.hard-shoulder", "fail", "drives 12 s along the shoulder past a lorry"),
            ("stvo.ri2", "fail", "gets ahead of a lorry on the right"),
        ],
        hz=5,
    )


def _right_side() -> Iterator[Drive]:
    yield draw(
        "ri2-queue-fine",
        motorway(),
        [
            ego(along(SLOW, 14, 50)),
            Actor("q0", "car", along(MIDDLE, 9.5, 75)),
            Actor("q1", "car", along(MIDDLE, 9.5, 100)),
            Actor("q2", "car", along(MIDDLE, 9.5, 125)),
            Actor("q3", "car", along(MIDDLE, 9.5, 150)),
        ],
        DE,
        20,
        [("stvo.ri2", "pass", "queue of four at 9.5, ego 4.5 faster")],
    )
    yield draw(
        "ri2-queue-too-fast",
        motorway(),
        [
            ego(along(SLOW, 17, 50)),
            Actor("q0", "car", along(MIDDLE, 9.5, 75)),
            Actor("q1", "car", along(MIDDLE, 9.5, 100)),
            Actor("q2", "car", along(MIDDLE, 9.5, 125)),
            Actor("q3", "car", along(MIDDLE, 9.5, 150)),
        ],
        DE,
        20,
        [("stvo.ri2", "fail", "7.5 faster than the queue")],
    )
    yield draw(
        "ri2-two-lanes-over",
        motorway(),
        [ego(along(SLOW, 31, 50)), Actor("a", "car", along(FAST, 26, 90))],
        DE,
        20,
        [("stvo.ri2", "fail", "one in the leftmost lane is passed from two lanes to its right")],
    )
    yield draw(
        "ri2-weaves",
        motorway(),
        [
            ego(along([(0, MIDDLE), (2, MIDDLE), (5, SLOW), (13, SLOW), (16, MIDDLE)], 32, 50), noise=0.02),
            Actor("a", "van", along(MIDDLE, 26, 95), noise=0.02),
        ],
        DE,
        24,
        [("stvo.ri2", "fail", "moves right, past a van, back")],
    )


def _backwards() -> Iterator[Drive]:
    yield draw(
        "ri3-wrong-way",
        motorway(),
        [ego(Motion(against(2000), 25, 0, 1.875)), Actor("a", "car", along(SLOW, 28, 900))],
        DE,
        12,
        [
            ("stvo.ri3", "not pass", "against the traffic at 25 m/s"),
            ("ukhc.r143.direction", "not pass", "against the traffic"),
        ],
    )
    yield draw(
        "ri3-shoulder-back",
        motorway(),
        [ego(along(SHOULDER, [(0, 0), (3, 0), (5, -3), (20, -3), (22, 0)], 400), ind=[(0, "hazard")])],
        DE,
        30,
        [("ukhc.r263.no-reverse", "fail", "reverses 50 m along the hard shoulder")],
    )


def german_motorways() -> Iterator[Drive]:
    yield from _stopping()
    yield from _right_side()
    yield from _backwards()
