"""The automated driver on a motorway."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from tests.outsiders.thirteenth.drive import DE, FAR, GB, TURNED, Drive, Wanted
from tests.outsiders.thirteenth.motion import Speeds
from tests.outsiders.thirteenth.motorways import beside, drive_on
from tests.outsiders.thirteenth.street import change, in_lane


def system(name: str, v: Speeds, wanted: Wanted, *, lht: bool = True, **more: Any) -> Drive:
    """It drives in the middle one of three lanes."""
    conditions = {**(GB if lht else DE), "engaged": "yes"}
    return drive_on(name, lht, 2, v, wanted, conditions=conditions, **more)


def gaps() -> Iterator[Drive]:
    """Distances and those who cut in."""
    yield system(
        "alks_gap_bad",
        14,
        [("alks-r157.follow-gap", "fail", "14 m at 14 m/s, over 20 m asked")],
        others=[beside("l", 14 + 4.5, 14, 2)],
    )
    yield system(
        "alks_gap_ok",
        14,
        [("alks-r157.follow-gap", "pass", "24 m at 14 m/s")],
        others=[beside("l", 24 + 4.5, 14, 2)],
        frame=TURNED,
    )
    yield system(
        "alks_crawl",
        [(0, 2), (99, 2)],
        [("alks-r157.follow-gap", "fail", "1.3 m at 2 m/s, 2 m asked")],
        others=[beside("l", 1.3 + 4.5, 2, 2)],
    )
    yield system(
        "alks_cutin_hit",
        15,
        [
            (
                "alks-r157.cut-in",
                "fail",
                "runs into a slower vehicle that is in its lane with 2 s to go, having moved over for 1.8 s",
            ),
            ("ukhc.no-collision", "fail", "hits it"),
        ],
        others=[beside("c", 40, [(0, 9), (99, 9)], [(0, in_lane(1)), (2.0, in_lane(1)), (7, in_lane(2))])],
        seconds=12,
    )
    yield system(
        "alks_cutin_ok",
        [(0, 15), (4, 15), (7.5, 8), (12, 8), (15, 9), (99, 9)],
        [("alks-r157.cut-in", "pass", "brakes"), ("alks-r157.emergency", "not fail", "2 m/s2")],
        others=[beside("c", 40, [(0, 9), (99, 9)], [(0, in_lane(1)), (2.0, in_lane(1)), (7, in_lane(2))])],
        seconds=20,
    )
    yield system(
        "alks_cutin_gap_bad",
        12,
        [("alks-r157.cut-in-gap", "fail", "6 m at 12 m/s still after ten seconds")],
        others=[beside("c", 6 + 4.5, 12, [(0, in_lane(1)), (2.0, in_lane(1)), (5, in_lane(2))])],
        seconds=22,
    )


def manoeuvres() -> Iterator[Drive]:
    """Emergencies and minimal risk manoeuvres."""
    yield system(
        "alks_hard_undeclared",
        [(0, 16), (6, 16), (8, 3), (99, 3)],
        [("alks-r157.emergency", "fail", "6.5 m/s2 undeclared")],
        events=[(0, "emergency_manoeuvre", "off")],
        seconds=14,
    )
    yield system(
        "alks_hard_declared",
        [(0, 16), (6, 16), (8, 3), (99, 3)],
        [("alks-r157.emergency", "pass", "declared")],
        events=[
            (0, "emergency_manoeuvre", "off"),
            (5.9, "emergency_manoeuvre", "on"),
            (8.5, "emergency_manoeuvre", "off"),
        ],
        seconds=14,
    )
    yield system(
        "alks_mrm_hard",
        [(0, 16), (5, 16), (8.2, 0), (99, 0)],
        [("alks-r157.mrm", "fail", "5 m/s2 for 3 s"), ("alks-r157.mrm-hazards", "fail", "no hazard lights")],
        events=[(0, "minimal_risk_manoeuvre", "off"), (4.5, "minimal_risk_manoeuvre", "on")],
        seconds=14,
    )
    yield system(
        "alks_mrm_good",
        [(0, 16), (5, 16), (12, 0), (99, 0)],
        [("alks-r157.mrm", "pass", "2.3 m/s2"), ("alks-r157.mrm-hazards", "pass", "at once")],
        events=[(0, "minimal_risk_manoeuvre", "off"), (4.5, "minimal_risk_manoeuvre", "on")],
        ind=[(0, "off"), (4.5, "hazard")],
        seconds=18,
    )


def lane_changes() -> Iterator[Drive]:
    """Lane changes."""
    yield system(
        "alks_lc_early",
        15,
        [
            ("alks-r157.r79.lane-change", "fail", "indicator on for about 2.3 s only before it reaches the line"),
            ("alks-r157.r79.lane-change-done", "pass", "under 3 s over the line"),
        ],
        u=change(2, 3, 6),
        ind=[(0, "off"), (5, "right"), (11, "off")],
    )
    yield system(
        "alks_lc_good",
        15,
        [("alks-r157.r79.lane-change", "pass", "3 to 5 s"), ("alks-r157.r79.lane-change-done", "pass", "fast enough")],
        u=change(2, 3, 6),
        ind=[(0, "off"), (3.2, "right"), (11, "off")],
        frame=FAR,
    )
    yield system(
        "alks_lc_slow",
        15,
        [("alks-r157.r79.lane-change-done", "fail", "over 6 s over the line")],
        u=[(0, in_lane(2)), (4, in_lane(2)), (28, in_lane(3))],
        ind=[(0, "off"), (9, "right"), (29, "off")],
        seconds=32,
    )
    yield system(
        "alks_lc_none_de", 15, [("alks-r157.r79.lane-change", "fail", "no indicator")], u=change(2, 3, 6), lht=False
    )
