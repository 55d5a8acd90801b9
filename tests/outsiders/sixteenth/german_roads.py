"""Germany: streets and roads outside towns."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.sixteenth.cast import DE, OWN, ego
from tests.outsiders.sixteenth.drive import Actor, Drive, draw
from tests.outsiders.sixteenth.junction import crossroads, through
from tests.outsiders.sixteenth.maps import rural, town
from tests.outsiders.sixteenth.ways import Motion, along


def _walkers_and_cyclists() -> Iterator[Drive]:
    yield draw(
        "s5-open-narrow",
        rural(limit=27.78),
        [
            ego(along([(0, OWN), (2, OWN), (5, -0.05), (13, -0.05), (16, OWN)], 20, 20), noise=0.02),
            Actor("c", "bicycle", along(-3, 5, 140), noise=0.02),
        ],
        DE,
        20,
        [("stvo.s5-passing", "fail", "1.75 m beside a bicycle, rural")],
        turned=2,
        shift=(-3000, 800),
    )
    yield draw(
        "s5-walker",
        rural(limit=27.78),
        [ego(along([(0, OWN), (3, OWN), (6, -1), (13, -1)], 15, 20)), Actor("p", "pedestrian", along(-3.2, 1.4, 130))],
        DE,
        20,
        [("stvo.s5-passing", "fail", "somebody walks along: 1.0 m")],
    )


def _close_calls() -> Iterator[Drive]:
    yield draw(
        "ttc-late-braking",
        rural(limit=27.78),
        [ego(along(OWN, [(0, 22), (5.2, 22), (7.2, 10), (20, 10)], 50)), Actor("a", "truck", along(OWN, 10, 134.65))],
        DE,
        20,
        [
            ("criticality.ttc", "fail", "14 m at 12 m/s closing"),
            ("criticality.drac", "fail", "5 m/s2"),
            ("criticality.ttb", "fail", "0.4 s"),
            ("ukhc.no-collision", "pass", "2 m left"),
        ],
    )
    yield draw(
        "mttc-lead-brakes",
        rural(limit=27.78),
        [
            ego(along(OWN, [(0, 18), (6.9, 18), (9.4, 0)], 50)),
            Actor("a", "car", along(OWN, [(0, 18), (6, 18), (9, 0), (16, 0)], 67.5)),
        ],
        DE,
        16,
        [("criticality.mttc", "fail", "lead brakes with 6: 1.4 s and less at their accelerations")],
    )
    yield draw(
        "ttc-standing-van",
        town(limit=13.89, footways=False),
        [
            ego(along(OWN, [(0, 13), (5, 13), (6.9, 0), (14, 0)], 50)),
            Actor("v", "van", along(OWN, 0, 133.6), ind=[(0, "hazard")]),
        ],
        DE,
        14,
        [("criticality.ttc", "fail", "13.3 m at 13 m/s"), ("criticality.drac", "fail", "6.3")],
        hz=20,
    )
    yield draw(
        "pet-one",
        crossroads(limit=13.89),
        [ego(Motion(through("W", "E"), 12, 121.75)), Actor("a", "car", Motion(through("S", "N"), 10, 134.475))],
        DE,
        30,
        [("criticality.pet", "fail", "0.8 s between the two"), ("ukhc.no-collision", "pass", "clear")],
    )


def _stop_signs() -> Iterator[Drive]:
    yield draw(
        "stop-brief",
        crossroads(limit=13.89, stop=True),
        [ego(Motion(through("W", "E"), [(0, 10), (6, 10), (10, 0), (10.3, 0), (15.3, 8), (34, 8)], 204.45))],
        DE,
        34,
        [("stvo.rin1", "not pass", "0.3 s"), ("ukhc.r171.stop-sign", "pass", "0.3 s, 0.3 m before the line")],
        hz=20,
        turned=0.7,
    )
    yield draw(
        "stop-rolls",
        crossroads(limit=13.89, stop=True),
        [ego(Motion(through("W", "E"), [(0, 10), (6, 10), (10, 1.2), (15, 8), (34, 8)], 201.75))],
        DE,
        34,
        [("stvo.rin1", "fail", "0 s"), ("ukhc.r171.stop-sign", "fail", "0 s, 0.3 m before the line")],
        hz=20,
        turned=0.7,
    )
    yield draw(
        "stop-short",
        crossroads(limit=13.89, stop=True),
        [ego(Motion(through("W", "E"), [(0, 10), (6, 10), (10, 0), (12.5, 0), (17.5, 8), (34, 8)], 202.75))],
        DE,
        34,
        [("performance.precise-stop", "fail", "2.0 m")],
        hz=20,
        turned=0.7,
    )


def german_roads() -> Iterator[Drive]:
    yield from _walkers_and_cyclists()
    yield from _close_calls()
    yield from _stop_signs()
