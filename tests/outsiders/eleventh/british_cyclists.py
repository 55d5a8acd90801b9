"""Great Britain: cyclists on country roads."""

from __future__ import annotations

from tests.outsiders.eleventh.drive import Drive
from tests.outsiders.eleventh.motion import Actor, ego, noisy, towed, track, turned
from tests.outsiders.eleventh.places import BENDS, STRAIGHT, beside, cyclist, near
from tests.outsiders.eleventh.road import GB, simple


def british_cyclists() -> list[Drive]:
    plain, way = simple(GB, STRAIGHT, speed=60)
    bends, winding = simple(GB, BENDS, speed=50)
    lined, along = simple(GB, STRAIGHT, speed=50, middle=[(0, "solid solid")])
    lorry = track(way, 20, 20, 12.5, lat=beside(-0.6, 8.5, post=4.5))
    sizeless = cyclist(way, 20, 82, 5.2)
    sizeless.rows, sizeless.size = (turned(sizeless.rows), (None, None, None))
    return [
        Drive(
            "gb_cyclist_close",
            plain,
            [ego(track(way, 20, 20, 12.5, lat=beside(0.6, 9))), cyclist(way, 20, 85, 5.3)],
            expect=[("ukhc.r163.cyclist", "fail", "0.85 m at 12.5 m/s")],
        ),
        Drive(
            "gb_cyclist_fast",
            plain,
            [ego(track(way, 16, 20, 24.5, lat=beside(-0.15, 6.1))), cyclist(way, 16, 135, 5.6)],
            expect=[("ukhc.r163.cyclist", "fail", "1.6 m at 55 mph; more than 1.5 m (2 m) above 30 mph")],
        ),
        Drive(
            "gb_cyclist_good",
            plain,
            [ego(track(way, 22, 20, 12.0, lat=beside(-1.4, 10))), cyclist(way, 22, 88, 5.2)],
            expect=[("ukhc.r163.cyclist", "pass", "2.8 m at 12 m/s"), ("ukhc.no-collision", "pass", "clear")],
        ),
        Drive(
            "gb_cyclist_bend",
            bends,
            [ego(noisy(track(winding, 24, 60, 15.5, lat=beside(0.6, 11)), 0.05, 7)), cyclist(winding, 24, 170, 5.4)],
            expect=[("ukhc.r163.cyclist", "fail", "0.85 m on a bend at 15.5 m/s, with 5 cm of noise")],
        ),
        Drive(
            "gb_cyclist_peloton",
            plain,
            [
                ego(track(way, 22, 20, 11.5, lat=beside(0.2, 10.5, pre=6, post=5))),
                *[cyclist(way, 22, 78 + 3 * (i // 2), 6.0, 2.8 - 1.0 * (i % 2), name=f"c{i}") for i in range(6)],
            ],
            expect=[("ukhc.r163.cyclist", "fail", "0.4 m beside the outer row of six riders")],
        ),
        Drive(
            "gb_cyclist_no_size",
            plain,
            [ego(track(way, 20, 20, 13, lat=beside(0.5, 8))), sizeless],
            expect=[
                (
                    "ukhc.r163.cyclist",
                    "not pass",
                    "about 0.75 m beside a cyclist without size, whose box is turned by pi",
                )
            ],
        ),
        Drive(
            "gb_solid_slow_cyclist",
            lined,
            [ego(track(along, 34, 20, 7.5, lat=beside(-1.3, 16))), cyclist(along, 34, 88, 3.2)],
            expect=[
                ("ukhc.r129.no-cross-solid", "not fail", "passing a cyclist at 3.2 m/s is allowed over a solid line"),
                ("ukhc.r163.cyclist", "pass", "2.7 m at 7.5 m/s"),
            ],
        ),
        Drive(
            "gb_solid_quick_cyclist",
            lined,
            [ego(track(along, 26, 20, 15, lat=beside(-1.3, 10))), cyclist(along, 26, 95, 7.5)],
            expect=[
                ("ukhc.r129.no-cross-solid", "fail", "the cyclist rides at 7.5 m/s, above 10 mph"),
                ("ukhc.r163.cyclist", "pass", "2.7 m"),
            ],
        ),
        Drive(
            "gb_cyclist_patience",
            plain,
            [ego(track(way, 24, 20, 16, [(3, -3.2), (6, 0)], near(GB))), cyclist(way, 24, 110, 6.3, 1.9)],
            expect=[
                ("ukhc.r163.cyclist", "not fail", "stays 15 m behind the cyclist"),
                ("ukhc.no-collision", "pass", "behind"),
                ("criticality.ttc", "not fail", "slows down in good time"),
            ],
        ),
        Drive(
            "gb_wide_trailer_cyclist",
            plain,
            [
                ego(lorry, "truck"),
                Actor("tr", "trailer", (7.5, 3.4, 3.0), towed(lorry, 9.8)),
                cyclist(way, 20, 82, 5.2),
            ],
            conditions={"vehicle_class": "goods_over_7t5"},
            expect=[
                ("ukhc.no-collision", "pass", "nobody touches anybody"),
                ("ukhc.r163.cyclist", "not pass", "the lorry leaves 1.7 m, but its trailer, 3.4 m wide, only 1.25 m"),
            ],
        ),
    ]
