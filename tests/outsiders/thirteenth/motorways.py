"""Motorways of both countries."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np

from tests.outsiders.log import Size
from tests.outsiders.thirteenth.drive import DE, FAR, GB, TURNED, Drive, Wanted, draw
from tests.outsiders.thirteenth.following import Other
from tests.outsiders.thirteenth.motion import Across, Actor, Speeds, Way
from tests.outsiders.thirteenth.road import Lane, Section
from tests.outsiders.thirteenth.street import Street, change, in_lane, motorway

ENG = {**GB, "nation": "gb-eng"}
EXIT = in_lane(1) + 3.75
LORRY: dict[str, Any] = {"cls": "truck", "size": (16.5, 2.5, 4.0)}


def beside(
    name: str, ahead: float, v: Speeds, lane: int | Across, cls: str = "car", *, size: Size | None = None
) -> Other:
    """Somebody whose middle is so far ahead of the ego's at first."""

    def drawn(street: Street) -> Actor:
        across = lane if isinstance(lane, Sequence) else in_lane(lane, street.lanes)
        return street.go(name, cls, 300 + ahead, v, across, size=size)

    return drawn


def drive_on(
    name: str,
    lht: bool,
    lane: int,
    v: Speeds,
    wanted: Wanted,
    *,
    others: Sequence[Other] = (),
    n: int = 3,
    cls: str = "car",
    size: Size | None = None,
    ind: str | Sequence[tuple[float, str]] = "off",
    u: Across | None = None,
    mod: Callable[[Street], None] | None = None,
    s0: float = 300,
    seconds: float = 20,
    **more: Any,
) -> Drive:
    """The ego drives in a lane, or along u; mod: changes the road."""
    road = {key: more.pop(key) for key in ("frame", "curve", "limit") if key in more}
    street = motorway(lht, n, **road)
    if mod:
        mod(street)
    ego = street.go("ego", cls, s0, v, u or in_lane(lane, n), size=size, indicator=ind)
    conditions = more.pop("conditions", GB if lht else DE)
    actors = [ego, *(other(street) for other in others)]
    return draw(name, street.map, actors, seconds, wanted, conditions=conditions, **more)


def with_exit(street: Street) -> None:
    """A lane that leaves, from 700 m to 950 m, and its sign before it."""
    through, hard = [Lane(width=3.75)] * 3, Lane("shoulder", 3.0, "none")
    leaves = Lane("exit", 3.75, "solid")
    street.road.sections = [
        Section(0.0, [*through, hard], []),
        Section(700.0, [*through, leaves, hard], []),
        Section(950.0, [*through, hard], []),
    ]
    street.road.add_sign(690, 15, "332", "exit")


def turns_round(street: Street) -> None:
    """Lead those who go along it from the right-hand lane round into the left one, and back."""
    right, left = -in_lane(1), -in_lane(3)
    a = np.linspace(-np.pi / 2, np.pi / 2, 40)
    r = (left - right) / 2
    street.with_it = Way(
        np.r_[np.arange(-100, 500, 0.25), 500 + r * np.cos(a), np.arange(500, -100, -0.25)],
        np.r_[np.full(2400, right), (right + left) / 2 + r * np.sin(a), np.full(2400, left)],
    )


def reverses(street: Street) -> None:
    """Lead those who go along it the other way."""
    street.with_it = Way(street.with_it.x[::-1], street.with_it.y[::-1])


def distances() -> Iterator[Drive]:
    """Distances and braking on the Autobahn."""
    yield drive_on(
        "rg1_close",
        False,
        2,
        33,
        [("stvo.rg1", "fail", "10.5 m at 33 m/s, 12.5 m needed"), ("criticality.thw", "fail", "0.32 s")],
        others=[beside("l", 15, 33, 2)],
    )
    yield drive_on(
        "rg1_far",
        False,
        2,
        33,
        [("stvo.rg1", "pass", "70 m at equal speed"), ("criticality.thw", "pass", "2.1 s")],
        others=[beside("l", 75, 33, 2)],
        frame=TURNED,
        curve=1 / 3000,
    )
    yield drive_on(
        "rg1_slower_lead",
        False,
        2,
        36,
        [("stvo.rg1", "fail", "closes with 7 m/s to under 20 m")],
        others=[beside("l", 46, [(0, 36), (5, 36), (9, 29), (99, 29)], 2)],
        seconds=12,
    )
    yield drive_on(
        "rg2_brake",
        False,
        1,
        [(0, 33), (6, 33), (9, 18), (14, 30), (99, 30)],
        [
            ("stvo.rg2", "fail", "5 m/s2 with nobody there"),
            ("comfort.decel-iso15622", "fail", "mean over 2 s is about 5 m/s2 at over 20 m/s"),
        ],
    )
    yield drive_on(
        "rg2_gentle",
        False,
        1,
        [(0, 33), (6, 33), (14, 21), (99, 21)],
        [("stvo.rg2", "pass", "1.5 m/s2"), ("comfort.decel-iso15622", "pass", "1.5")],
    )


def lorry_distances() -> Iterator[Drive]:
    """Fifty metres on the Autobahn."""
    yield drive_on(
        "s4_40m",
        False,
        1,
        22,
        [("stvo.s4-truck", "fail", "40 m at 22 m/s"), ("stvo.rg1", "pass", "40 m at equal speed")],
        others=[beside("l", 40 + 8.25 + 6, 22, 1, "truck", size=(12, 2.5, 3.8))],
        conditions={**DE, "vehicle_class": "goods_over_7t5"},
        **LORRY,
    )
    yield drive_on(
        "s4_48m_trailer",
        False,
        1,
        22,
        [("stvo.s4-truck", "fail", "44 m to the trailer of the one ahead")],
        others=[
            beside("l", 50.5 + 8.25 + 5, 22, 1, "truck", size=(10, 2.5, 3.8)),
            beside("lt", 50.5 + 8.25 + 5 - 5 - 0.4 - 3, 22, 1, "trailer", size=(6, 2.4, 3)),
        ],
        conditions={**DE, "vehicle_class": "goods_over_7t5"},
        frame=TURNED,
        **LORRY,
    )
    yield drive_on(
        "s4_55m",
        False,
        1,
        22,
        [("stvo.s4-truck", "pass", "55 m")],
        others=[beside("l", 55 + 8.25 + 2.25, 22, 1)],
        conditions={**DE, "vehicle_class": "bus"},
        cls="bus",
        size=(16.5, 2.5, 3.5),
    )


def speeds() -> Iterator[Drive]:
    """Speeds on the Autobahn."""
    yield drive_on("rg3_fast", False, 2, 38, [("stvo.rg3", "fail", "38 m/s, limit 33.33")], limit=33.33)
    yield drive_on(
        "rg3_lorry",
        False,
        1,
        24.5,
        [("stvo.rg3", "fail", "24.5 m/s, 22.22 for a lorry over 7.5 t")],
        cls="truck",
        conditions={**DE, "vehicle_class": "goods_over_7t5"},
        limit=33.33,
        frame=TURNED,
    )
    yield drive_on("rg3_ok", False, 2, 33.5, [("stvo.rg3", "pass", "within 3 km/h")], limit=33.33)
    yield drive_on(
        "rg4_crawl", False, 1, 15, [("stvo.rg4", "fail", "15 m/s, limit 36.1, nobody there")], limit=36.11, seconds=30
    )
    yield drive_on(
        "rg4_behind_slow",
        False,
        1,
        15,
        [("stvo.rg4", "not fail", "behind a slow vehicle, with others beside")],
        others=[beside("l", 60, 15, 1), beside("m", 10, 15.5, 2), beside("m2", 62, 15.5, 2)],
        limit=36.11,
        seconds=30,
    )


def lane_changes() -> Iterator[Drive]:
    """Lane changes on the Autobahn."""
    yield drive_on(
        "rg6_cut",
        False,
        1,
        25,
        [("stvo.rg6", "fail", "follower 11 m/s faster, 33 m behind or less")],
        others=[beside("b", -38, 36, 2)],
        u=change(1, 2, 1.5),
        seconds=10,
        ind="left",
    )
    yield drive_on(
        "rg6_free",
        False,
        1,
        32,
        [("stvo.rg6", "pass", "120 m behind, slower")],
        others=[beside("b", -120, 30, 2)],
        u=change(1, 2, 4),
        seconds=14,
        ind="left",
    )
    yield drive_on(
        "x_rg6_lorry",
        False,
        1,
        24,
        [("stvo.rg6", "fail", "follower 12 m/s faster, under 30 m")],
        others=[beside("b", -33, 36, 2, "car"), beside("t", 60, 22, 1, "truck")],
        u=[(0, in_lane(1)), (1, in_lane(1)), (6, in_lane(2))],
        seconds=12,
        cls="truck",
        ind="left",
        frame=FAR,
    )


def passing() -> Iterator[Drive]:
    """Passing on either side on the Autobahn."""
    yield drive_on(
        "ri2_right",
        False,
        1,
        34,
        [("stvo.ri2", "fail", "passes on the right with 7 m/s more")],
        others=[beside("a", 50, 27, 2)],
    )
    yield drive_on(
        "ri2_queue_slow",
        False,
        1,
        15,
        [("stvo.ri2", "not fail", "queue at 40 km/h passed with 14 km/h more")],
        others=[
            beside("a", 25, 11, 2),
            beside("b", 40, 11, 2),
            beside("c", 55, 11, 2),
            beside("d", 70, 11, 2),
            beside("e", 30, 11, 3),
            beside("f", 50, 11, 3),
        ],
        seconds=24,
    )
    yield drive_on(
        "ri2_left", False, 2, 34, [("stvo.ri2", "not fail", "on the left")], others=[beside("a", 50, 27, 1)], frame=FAR
    )
    yield drive_on(
        "x_ri2_twice",
        False,
        2,
        33,
        [("stvo.ri2", "fail", "passes a car in lane 3 on the right while passing a lorry on the left")],
        others=[beside("a", 60, 28, 3, "car"), beside("b", 80, 24, 1, "truck")],
        seconds=20,
    )


def standing() -> Iterator[Drive]:
    """Standing, turning and reversing on the Autobahn."""
    yield drive_on(
        "ri1_stand",
        False,
        1,
        [(0, 20), (5, 20), (13, 0), (99, 0)],
        [
            ("stvo.ri1", "fail", "stands with nobody ahead"),
            ("ukhc.r240.no-stopping", "fail", "17 s at a stand on a motorway lane"),
        ],
        seconds=30,
    )
    yield drive_on(
        "ri1_queue",
        False,
        1,
        [(0, 15), (5, 15), (11, 0), (99, 0)],
        [("stvo.ri1", "not fail", "stands 15 m behind a queue")],
        others=[beside("q", 132, [(0, 4), (4, 0), (99, 0)], 1), beside("q2", 140, 0, 2)],
        seconds=24,
    )
    yield drive_on(
        "ri1_queue8",
        False,
        1,
        [(0, 15), (5, 15), (11, 0), (99, 0)],
        [("stvo.ri1", "not fail", "queue"), ("ukhc.r240.no-stopping", "not fail", "8.4 m behind a standing queue")],
        others=[beside("q", 125, [(0, 4), (4, 0), (99, 0)], 1), beside("q2", 140, 0, 2)],
        seconds=24,
    )
    yield drive_on(
        "ri3_back",
        False,
        1,
        [(0, 15), (4, 15), (9, 0), (10, 0), (12, -3), (17, -3), (19, 0), (99, 0)],
        [("stvo.ri3", "fail", "reverses at 3 m/s"), ("ukhc.r263.no-reverse", "fail", "reverses on a motorway")],
    )
    yield drive_on(
        "ri3_wrong",
        False,
        1,
        25,
        [
            ("stvo.ri3", "not pass", "against the traffic all along: or the map is wrong"),
            ("ukhc.r143.direction", "not pass", "the same"),
        ],
        frame=TURNED,
        mod=reverses,
        u=[(0, -in_lane(1))],
        s0=700,
    )
    yield drive_on(
        "ri3_turn_round",
        False,
        1,
        [(0, 14), (12, 14), (15, 3), (19.2, 3), (23, 12), (99, 12)],
        [
            ("stvo.ri3", "fail", "turns round on the carriageway and drives back"),
            ("ukhc.r143.direction", "fail", "against the traffic on a motorway"),
        ],
        mod=turns_round,
        u=[(0, 0.0)],
        seconds=31,
        s0=300,
    )


def lorries() -> Iterator[Drive]:
    """Great Britain: who may use which lane, and how fast."""
    yield drive_on(
        "gb_lorry_right",
        True,
        3,
        24,
        [("ukhc.r265.right-lane-ban", "fail", "lorry over 7.5 t in lane 3 of 3")],
        others=[beside("a", 20, 23, 2)],
        conditions={**ENG, "vehicle_class": "goods_over_7t5"},
        **LORRY,
    )
    yield drive_on(
        "gb_towing_right",
        True,
        4,
        25,
        [("ukhc.r265.right-lane-ban", "fail", "car with trailer in lane 4 of 4")],
        others=[beside("t", -5.5, 25, 4, "trailer", size=(5.5, 2.2, 2.4))],
        n=4,
        conditions={**GB, "vehicle_class": "car_towing"},
        frame=TURNED,
    )
    yield drive_on(
        "gb_lorry_middle",
        True,
        2,
        24,
        [("ukhc.r265.right-lane-ban", "pass", "lane 2 of 3")],
        conditions={**GB, "vehicle_class": "goods_over_7t5"},
        **LORRY,
    )
    yield drive_on(
        "gb_lorry_two_lanes",
        True,
        2,
        24,
        [("ukhc.r265.right-lane-ban", "not fail", "two lanes only")],
        n=2,
        conditions={**GB, "vehicle_class": "goods_over_7t5"},
        **LORRY,
    )
    yield drive_on(
        "gb_lorry_over_speed",
        True,
        1,
        28,
        [("ukhc.r124.speed-limit", "fail", "28 m/s = 62.6 mph, 60 for goods over 7.5 t on a motorway")],
        conditions={**GB, "vehicle_class": "goods_over_7t5"},
        limit=31.29,
        **LORRY,
    )
    yield drive_on("gb_70plus", True, 2, 32.2, [("ukhc.r124.speed-limit", "fail", "72 mph")], limit=31.29)


def hard_shoulders() -> Iterator[Drive]:
    """Great Britain: hard shoulders, stopping and reversing."""
    yield drive_on(
        "gb_shoulder",
        True,
        1,
        22,
        [("ukhc.r269.hard-shoulder", "fail", "drives along it")],
        u=[(0, in_lane(1)), (3, in_lane(1)), (7, in_lane(1) + 3.4)],
    )
    yield drive_on(
        "gb_shoulder_haz_drive",
        True,
        1,
        18,
        [("ukhc.r269.hard-shoulder", "not pass", "drives 15 s along it at 18 m/s without stopping")],
        u=[(0, in_lane(1)), (3, in_lane(1)), (7, in_lane(1) + 3.4)],
        ind=[(0, "off"), (4, "hazard")],
        frame=FAR,
    )
    yield drive_on(
        "gb_breakdown",
        True,
        1,
        [(0, 22), (4, 22), (12, 0), (99, 0)],
        [
            ("ukhc.r269.hard-shoulder", "not fail", "stops with hazard lights"),
            ("ukhc.r116.hazards", "not fail", "standing, on a motorway"),
        ],
        u=[(0, in_lane(1)), (4, in_lane(1)), (8, in_lane(1) + 3.4)],
        ind=[(0, "off"), (4, "hazard")],
        seconds=30,
    )
    yield drive_on(
        "gb_stop_lane",
        True,
        1,
        [(0, 22), (4, 22), (12, 0), (21, 0), (26, 10), (99, 20)],
        [("ukhc.r240.no-stopping", "fail", "9 s at a stand in lane 1")],
        seconds=30,
    )
    yield drive_on(
        "gb_reverse",
        True,
        1,
        [(0, 12), (3, 12), (8, 0), (10, 0), (11, -1.5), (16, -1.5), (17, 0), (99, 0)],
        [("ukhc.r263.no-reverse", "fail", "5 s at 1.5 m/s backwards")],
        hz=5,
        frame=TURNED,
        seconds=22,
    )
    yield drive_on(
        "x_shoulder_half",
        True,
        1,
        22,
        [("ukhc.r269.hard-shoulder", "not fail", "centre 0.4 m inside lane 1")],
        u=[(0, in_lane(1)), (3, in_lane(1)), (7, in_lane(1) + 1.475)],
    )
    yield drive_on(
        "x_shoulder_centre",
        True,
        1,
        22,
        [("ukhc.r269.hard-shoulder", "fail", "centre 0.4 m beyond the edge for 10 s")],
        u=[(0, in_lane(1)), (3, in_lane(1)), (7, in_lane(1) + 2.275)],
        frame=TURNED,
    )


def exits() -> Iterator[Drive]:
    """Great Britain: exits."""
    yield drive_on(
        "exit_no_signal",
        True,
        1,
        25,
        [("ukhc.exit-sign-signal", "fail", "passes the exit sign without indicator, leaves")],
        mod=with_exit,
        u=[(0, in_lane(1)), (17, in_lane(1)), (20.5, EXIT)],
        seconds=25.2,
        ind=[(0, "off"), (16.5, "left")],
    )
    yield drive_on(
        "exit_signal",
        True,
        1,
        25,
        [("ukhc.exit-sign-signal", "not fail", "left indicator on from before the sign")],
        mod=with_exit,
        u=[(0, in_lane(1)), (17, in_lane(1)), (20.5, EXIT)],
        seconds=25.2,
        ind=[(0, "off"), (9, "left")],
        frame=TURNED,
    )
    yield drive_on(
        "exit_signal_stays",
        True,
        1,
        25,
        [("ukhc.signal-then-leaves", "fail", "signals beside the exit lane, does not leave")],
        mod=with_exit,
        seconds=30,
        ind=[(0, "off"), (14, "left"), (25, "off")],
    )
