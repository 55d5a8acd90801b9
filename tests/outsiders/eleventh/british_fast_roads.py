"""Great Britain: motorways and a dual carriageway."""

from __future__ import annotations

from tests.outsiders.eleventh.drive import Drive
from tests.outsiders.eleventh.motion import Actor, actor, ego, towed, track
from tests.outsiders.eleventh.places import INNER, SHOULDER, motorway
from tests.outsiders.eleventh.road import GB, Lane, Path, Section, road, signal, simple, whole


def british_fast_roads() -> list[Drive]:
    plain, way = motorway()
    dual, outer = simple(GB, [(1500.0, 0.0)], speed=70, near=2, far=2, median=3.0)
    rows = track(outer, 18, 100, 30, lat=[(0, 3 + 5.25)])
    path = Path(0, 0, 0, [(900.0, 0.0)])
    mid = [Lane("median", 2.0, "solid"), Lane(), Lane()]
    hard = Lane("shoulder", 3.2, "none")
    leaving = whole(
        road(
            1,
            path,
            [
                Section(
                    0.0,
                    [*mid[:2], Lane("driving", 3.5, "solid"), Lane("shoulder", 3.2, "none", succ=5)],
                    [*mid, hard],
                    [(0, "solid")],
                ),
                Section(
                    500.0,
                    [*mid, Lane("exit", 3.5, "solid"), Lane("shoulder", 3.2, "none", pred=4)],
                    [*mid, hard],
                    [(0, "solid")],
                ),
            ],
            GB,
            "motorway",
            70,
            signals=signal("5", 450, 10.5, "333", "de", name="exit"),
        )
    )
    return [
        Drive(
            "gb_shoulder",
            plain,
            [
                ego(
                    track(
                        way,
                        26,
                        100,
                        18,
                        lat=[(0, INNER[2]), (3, INNER[2]), (6, SHOULDER), (20, SHOULDER), (23, INNER[2])],
                    )
                ),
                *[
                    actor(f"q{i}", "car" if i else "bus", track(way, 26, 190 + 16 * i, 7, lat=[(0, INNER[2])]))
                    for i in range(4)
                ],
            ],
            expect=[("ukhc.r269.hard-shoulder", "fail", "passes a queue along the hard shoulder at 18 m/s")],
        ),
        Drive(
            "gb_motorway_reverse",
            plain,
            [ego(track(way, 24, 900, 3.2, lat=[(0, INNER[2])], way=-1, back=True))],
            expect=[
                ("ukhc.r263.no-reverse", "fail", "reverses at 3.2 m/s on a motorway"),
                ("ukhc.r143.direction", "fail", "the same"),
            ],
        ),
        Drive(
            "gb_coach_lane_three",
            plain,
            [
                ego(track(way, 20, 100, 27, lat=[(0, INNER[0])], hz=2), "bus"),
                actor("a", "car", track(way, 20, 150, 26, lat=[(0, INNER[1])], hz=2)),
            ],
            conditions={"vehicle_class": "bus"},
            expect=[("ukhc.r265.right-lane-ban", "fail", "a coach in the right-hand lane of three")],
        ),
        Drive(
            "gb_dual_lorry_67",
            dual,
            [ego(rows, "truck"), Actor("tr", "trailer", (8.0, 2.5, 3.6), towed(rows, 10.2))],
            conditions={"vehicle_class": "goods_over_7t5"},
            expect=[
                (
                    "ukhc.r124.speed-limit",
                    "fail",
                    "a heavy lorry with a trailer at 67 mph on a dual carriageway, 60 is allowed",
                )
            ],
        ),
        Drive(
            "gb_exit_silent",
            leaving,
            [
                ego(
                    track(path, 26, 100, 28, lat=[(0, INNER[1]), (15.5, INNER[1]), (19, INNER[2])]),
                    lamps=[(18, 20, "left")],
                )
            ],
            expect=[
                (
                    "ukhc.exit-sign-signal",
                    "fail",
                    "leaves by the exit lane and never signals; past the sign with the indicator off",
                )
            ],
        ),
    ]
