"""Great Britain: horses on country roads."""

from __future__ import annotations

from tests.outsiders.eleventh.drive import Drive
from tests.outsiders.eleventh.motion import SIZES, Actor, actor, ego, late, track
from tests.outsiders.eleventh.places import BENDS, STRAIGHT, beside, horse, near
from tests.outsiders.eleventh.road import GB, simple


def british_horses() -> list[Drive]:
    bends, winding = simple(GB, BENDS)
    plain, way = simple(GB, STRAIGHT, speed=40)
    return [
        Drive(
            "gb_horse_fast",
            bends,
            [ego(track(winding, 22, 20, 9.2, lat=beside(-1.3, 10))), horse(winding, 22, 92, 2.0)],
            expect=[
                ("ukhc.r215.horse", "fail", "9.2 m/s past a horse; at most 4.47"),
                ("ukhc.no-collision", "pass", "2.7 m of room"),
            ],
        ),
        Drive(
            "gb_horse_near",
            plain,
            [ego(track(way, 26, 20, 3.7, lat=beside(0.4, 12))), horse(way, 26, 44, 1.7)],
            expect=[("ukhc.r215.horse", "fail", "about 1.1 m beside a horse; at least 2 m")],
        ),
        Drive(
            "gb_horse_good",
            plain,
            [
                ego(track(way, 30, 20, 8, [(2, -1.5), (4.8, 0), (22, 1.2)], beside(-1.2, 16, pre=7, post=3.5))),
                horse(way, 30, 66, 1.3),
            ],
            expect=[("ukhc.r215.horse", "pass", "3.8 m/s and 2.7 m"), ("ukhc.r124.speed-limit", "pass", "slow")],
        ),
        Drive(
            "gb_horses_abreast",
            plain,
            [
                ego(track(way, 26, 20, 4.0, lat=beside(-0.4, 11))),
                *[horse(way, 26, 46, 1.6, 2.7), horse(way, 26, 45.5, 1.6, 1.5, name="h2")],
            ],
            expect=[("ukhc.r215.horse", "fail", "the outer of two riders abreast has 0.65 m")],
        ),
        Drive(
            "gb_horse_null",
            plain,
            [
                ego(track(way, 22, 20, 9.5, lat=beside(0.5, 5.2, pre=3.5))),
                Actor("q", None, SIZES["animal"], track(way, 22, 60, 1.8, lat=near(GB, 2.6))),
            ],
            expect=[
                ("ukhc.r215.horse", "not pass", "1.4 m at 9.5 m/s past somebody who may be a horse (no class)"),
                ("ukhc.r163.cyclist", "not pass", "somebody of the size of a cyclist, no class, 0.85 m away"),
            ],
        ),
        Drive(
            "gb_horse_late",
            plain,
            [
                ego(track(way, 20, 20, 8.6, lat=beside(-0.2, 7))),
                actor("h", "animal", late(track(way, 20, 80, 1.0, lat=near(GB, 2.65)), 6.4)),
            ],
            expect=[("ukhc.r215.horse", "fail", "8.6 m/s and 1.7 m; the horse is recorded from just before the pass")],
        ),
        Drive(
            "gb_horse_two_hertz",
            plain,
            [
                ego(track(way, 24, 28, 7.5, lat=beside(-1.3, 11))),
                horse(way, 24, 95, 1.4, hz=2),
                actor("v", "van", track(way, 24, 12, 7.5, lat=near(GB))),
            ],
            expect=[("ukhc.r215.horse", "fail", "7.5 m/s past a horse that is recorded at 2 Hz, a van close behind")],
        ),
        Drive(
            "gb_horse_waits",
            plain,
            [ego(track(way, 24, 30, 12, [(1, -2.5), (5.2, 0)], near(GB))), horse(way, 24, 110, 1.5, 0.4)],
            expect=[
                ("ukhc.r215.horse", "not fail", "waits behind the horse and never passes it"),
                ("ukhc.no-collision", "pass", "stays well behind"),
                ("criticality.ttc", "pass", "never near"),
            ],
        ),
    ]
