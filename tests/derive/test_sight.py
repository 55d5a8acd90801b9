"""What is in plain view is recorded: from when on somebody is out of sight, how far the ego's lane is seen, and what follows from it."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.scenes import LANE, derived, drive, judged, moving, road, rows, standing, times

if TYPE_CHECKING:
    from drivelint.engine.batch import Drive

LONG = road(((2000.0, 0.0),), lanes=(2, 2))
AHEAD = ("criticality.ttc", "criticality.thw", "criticality.drac", "criticality.ttb", "criticality.mttc")


def ends(scene: Drive) -> list[tuple[str, bool, float, float]]:
    """Return (object, lost, time, time from which or until which it is out of sight), in seconds."""
    found = rows(derived(scene, tables=["_track_end"]), "FROM _track_end ORDER BY object_id, t_ns, lost")
    return [(r["object_id"], r["lost"], r["t_ns"] / 1e9, r["plain_ns"] / 1e9) for r in found]


def lost_behind(*, box: bool, in_sight: bool = True) -> Drive:
    """Return a drive past a lorry on the left, 30 m ahead, or past nothing: somebody ahead of it is lost at 3 s."""
    t = times(8.0)
    ego = moving("ego", LONG, t, 100 + 0.01 * t, -0.5 * LANE)
    far = moving("far", LONG, t, 160 + 0.01 * t, 1.5 * LANE).keep(t < 3.05)
    # half way to it
    lorry = standing("lorry", LONG, t, 130, 0.5 * LANE, length=12.0, width=2.5)
    return drive([ego, far, *([lorry] if box else [])], LONG.environment, in_sight=in_sight)


def test_who_goes_behind_a_box_is_out_of_sight_at_once() -> None:
    assert ends(lost_behind(box=True)) == [("far", True, 3.0, 3.0)]


def test_who_is_lost_in_plain_view_may_be_there_for_as_long_as_a_tracker_may_lose_it() -> None:
    assert ends(lost_behind(box=False)) == [("far", True, 3.0, 5.5)]
    assert ends(lost_behind(box=False, in_sight=False)) == []


def test_who_comes_into_view_was_not_there_before() -> None:
    """Out from behind the lorry, or from nowhere."""
    t = times(8.0)
    ego = moving("ego", LONG, t, 100 + 0.01 * t, -0.5 * LANE)
    lorry = standing("lorry", LONG, t, 130, 0.5 * LANE, length=12.0, width=2.5)
    new = moving("new", LONG, t, 160 + 0.01 * t, 1.5 * LANE).keep(t > 3.95)
    assert ends(drive([ego, lorry, new], LONG.environment, in_sight=True)) == [("new", False, 4.0, 3.5)]
    assert ends(drive([ego, new], LONG.environment, in_sight=True)) == [("new", False, 4.0, 1.5)]


def test_who_leaves_the_range_is_out_of_sight_at_once() -> None:
    t = times(8.0)
    ego = moving("ego", LONG, t, 100 + 10 * t, -0.5 * LANE)
    # 99.8 m away at 4 s, 100.3 m a tenth of a second later
    fast = moving("fast", LONG, t, 179.8 + 15 * t, -0.5 * LANE)
    assert ends(drive([ego, fast.keep(t < 4.05)], LONG.environment, in_sight=True, sensor_range_m=100.0)) == [
        ("fast", True, 4.0, 4.0)
    ]
    assert ends(drive([ego, fast.keep(t < 2.05)], LONG.environment, in_sight=True, sensor_range_m=100.0)) == [
        ("fast", True, 2.0, 4.5)
    ]


def test_a_hole_has_two_ends() -> None:
    t = times(10.0)
    ego = moving("ego", LONG, t, 100 + 10 * t, -0.5 * LANE)
    other = moving("x", LONG, t, 140 + 10 * t, -1.5 * LANE).lost((t > 2.95) & (t < 8.95))
    assert ends(drive([ego, other], LONG.environment, in_sight=True)) == [("x", True, 2.9, 5.4), ("x", False, 9.0, 6.5)]


def seen_ahead(bend: float, *, box: bool) -> dict[int, dict[str, Any]]:
    """Return step in tenths -> the row of `sight` of an ego that drives along a lane; somebody far away is lost at 1 s."""
    way = road(((40.0, 0.0), (300.0, bend)), lanes=(1, 2))
    t = times(3.0)
    ego = moving("ego", way, t, 10 + 1 * t, -0.5 * LANE)
    gone = moving("gone", way, t, 150 + 0 * t, -0.5 * LANE).lost(t > 1.05)
    # in the lane on the right: inside of a bend to the right
    lorry = standing("lorry", way, t, 62, -1.5 * LANE, length=12.0, width=2.5)
    scene = drive([ego, gone, *([lorry] if box else [])], way.environment, in_sight=True, sensor_range_m=100.0)
    con = derived(scene, tables=["_sight", "hidden"])
    return {round(r["t_ns"] / 1e8): r for r in rows(con, "FROM _sight ORDER BY t_ns")}


def test_a_straight_lane_is_seen_past_who_is_beside_it() -> None:
    (open_, past) = (seen_ahead(0.0, box=box)[20] for box in (False, True))
    assert open_["lane_m"] == pytest.approx(100 - 6 - 2.4, abs=2.1)
    assert past["lane_m"] == pytest.approx(open_["lane_m"])
    # all around it is the lorry that ends the view
    assert past["around_m"] == pytest.approx(math.hypot(62 - 12, LANE) - math.hypot(12.0, 2.5) / 2, abs=1e-6)
    assert open_["around_m"] == 100.0


@pytest.mark.parametrize(("into_m", "hides"), [(0.4, False), (0.6, True)])
def test_a_box_that_hardly_reaches_into_the_lane_hides_no_vehicle_in_it(into_m: float, hides: bool) -> None:
    way = road(((340.0, 0.0),), lanes=(1, 2))
    t = times(3.0)
    ego = moving("ego", way, t, 10 + 1 * t, -0.5 * LANE)
    gone = moving("gone", way, t, 150 + 0 * t, -0.5 * LANE).lost(t > 1.05)
    lorry = standing("lorry", way, t, 62, -LANE - 1.25 + into_m, length=12.0, width=2.5)
    scene = drive([ego, gone, lorry], way.environment, in_sight=True, sensor_range_m=100.0)
    row = rows(derived(scene, tables=["_sight"]), "FROM _sight ORDER BY t_ns DESC")[0]
    assert row["lane_m"] == pytest.approx(62 - 6 - 13 - 2.4)
    assert row["vehicle_lane_m"] == pytest.approx(row["lane_m"] if hides else 100 - 6 - 2.4, abs=2.1)


def test_behind_a_box_inside_a_bend_nobody_is_seen() -> None:
    """Rays from the ego's middle to the middle of the lane: the first that the lorry stops."""
    way = road(((40.0, 0.0), (300.0, -1 / 60)), lanes=(1, 2))
    ex, ey, _ = (float(v) for v in way.at(12.0, -0.5 * LANE))
    lx, ly, heading = (float(v) for v in way.at(62.0, -1.5 * LANE))

    def stopped(s: float) -> bool:
        px, py, _ = (float(v) for v in way.at(s, -0.5 * LANE))
        across = [
            (px - ex) * (cy - ey) - (py - ey) * (cx - ex)
            for a in (-6.0, 6.0)
            for b in (-1.25, 1.25)
            for cx, cy in [
                (lx + a * math.cos(heading) - b * math.sin(heading), ly + a * math.sin(heading) + b * math.cos(heading))
            ]
        ]
        between = 0 < (px - ex) * (lx - ex) + (py - ey) * (ly - ey) < (px - ex) ** 2 + (py - ey) ** 2
        return between and min(across) < 0 < max(across)

    first = next(s / 10 for s in range(121, 1200) if stopped(s / 10))
    (row,) = (seen_ahead(-1 / 60, box=True)[20],)
    # from the front of the ego, two steps of 2 m less at the most; along the lane's own middle, outside of the line
    assert first - 12 - 2.4 - 6 < row["lane_m"] <= (first - 12) * (1 + LANE / 120) - 2.4
    assert seen_ahead(-1 / 60, box=False)[20]["lane_m"] > row["lane_m"] + 20


def follows_nobody(*, in_sight: bool, seen_for_s: float = 3.0, gap: float = 60.0) -> Drive:
    """Return 25 s at 15 m/s behind one that is 60 m ahead, goes away, and is not recorded again."""
    t = times(25.0)
    ego = moving("ego", LONG, t, 100 + 15 * t, -0.5 * LANE)
    lead = moving("x", LONG, t, 104.8 + gap + 17 * t, -0.5 * LANE).keep(t < seen_for_s + 0.05)
    return drive([ego, lead], LONG.environment, in_sight=in_sight, sensor_range_m=100.0)


@pytest.mark.parametrize("rule", AHEAD)
def test_a_lane_in_plain_view_is_judged(rule: str) -> None:
    strict = {r["verdict"] for r in judged([follows_nobody(in_sight=False)], rules=[rule])}
    assert "unknown" in strict
    found = judged([follows_nobody(in_sight=True)], rules=[rule])
    assert {r["verdict"] for r in found} == {"pass"}
    assert {r["assumes"] for r in found} == {"line_of_sight"}
    assert None in {r["object_id"] for r in found}


@pytest.mark.parametrize("rule", AHEAD)
def test_one_lost_before_its_eyes_is_not_nobody(rule: str) -> None:
    """8 m ahead and lost: for 2.5 s it may well be there. Without the assumption for longer."""
    found = judged([follows_nobody(in_sight=True, gap=8.0)], rules=[rule])
    unknown = [r for r in found if r["verdict"] == "unknown"]
    assert unknown
    assert {r["assumes"] for r in unknown} == {None}
    # the reason says who it is
    assert any(
        "; the position of object x at that time is not known: its track ends at " in r["reason"] for r in unknown
    )
    con = derived(follows_nobody(in_sight=True, gap=8.0), tables=["vehicle_ahead"])
    ahead = {round(r["t_ns"] / 1e8): r for r in rows(con, "FROM vehicle_ahead ORDER BY t_ns")}
    assert all(k not in ahead or (not ahead[k]["known"] and ahead[k]["free_m"] < 15) for k in range(31, 56))
    assert ahead[57]["free_m"] > 70


def test_the_reason_is_the_objects_own_track() -> None:
    """Two beside the ego are lost, the nearer one later: each verdict speaks of its own object."""
    t = times(12.0)
    ego = moving("ego", LONG, t, 100 + 15 * t, -0.5 * LANE)
    one, two = (
        moving(name, LONG, t, s + 15 * t, 0.5 * LANE).keep(t < end)
        for name, s, end in (("one", 101, 3.05), ("two", 106, 5.05))
    )
    found = judged([drive([ego, one, two], LONG.environment, in_sight=True)], rules=["rss.lateral"])
    told = {r["object_id"]: r["reason"] for r in found if r["verdict"] == "unknown"}
    assert "the track of object one ends at 3.000 s: record it for longer" in told["one"]
    assert "the track of object two ends at 5.000 s: record it for longer" in told["two"]


@pytest.mark.parametrize(
    ("kind", "speed", "asked"),
    [(None, 0.5, "record its class"), ("object", 0.0, "no better recording can decide this")],
)
def test_what_is_or_may_be_no_vehicle_in_the_lane_ahead(kind: str | None, speed: float, asked: str) -> None:
    t = times(4.0)
    ego = moving("ego", LONG, t, 100 + 5 * t, -0.5 * LANE)
    ahead = replace(moving("x", LONG, t, 127 + speed * t, -0.5 * LANE), kind=kind, length=0.5, width=0.5)
    found = judged([drive([ego, ahead], LONG.environment)], rules=["criticality.ttc"])
    assert [r["verdict"] for r in found] == ["unknown"]
    assert "object x" in found[0]["reason"]
    assert asked in found[0]["reason"]


def test_a_rule_about_the_ego_alone_assumes_nothing() -> None:
    found = judged([follows_nobody(in_sight=True)], rules=["ukhc.r124.speed-limit", "ukhc.no-collision"])
    assert {r["rule_id"]: r["assumes"] for r in found} == {
        "ukhc.r124.speed-limit": None,
        "ukhc.no-collision": "line_of_sight",
    }
    everybody = drive(
        [moving("ego", LONG, times(5.0), 100 + 15 * times(5.0), -0.5 * LANE)], LONG.environment, in_sight=True
    )
    assert {r["assumes"] for r in judged([everybody], rules=["ukhc.no-collision", *AHEAD])} == {None}


@pytest.mark.slow
@settings(max_examples=12, deadline=None)
@given(st.floats(5, 60), st.floats(-8, 8), st.floats(2, 12), st.floats(0.3, 8), st.sampled_from([-1.5, -0.5, 0.5, 1.5]))
def test_what_is_decided_without_the_assumption_is_decided_alike_with_it(
    gap: float, faster: float, ends_s: float, hole_s: float, lane: float
) -> None:
    t = times(20.0)
    ego = moving("ego", LONG, t, 100 + 12 * t, -0.5 * LANE)
    lead = moving("lead", LONG, t, 200 + 12 * t, -0.5 * LANE)
    other = moving("x", LONG, t, 104.8 + gap + (12 + faster) * t, lane * LANE).lost(
        (t > ends_s) & (t < ends_s + hole_s)
    )
    rules = [*AHEAD, "ukhc.r126.thinking-gap", "ukhc.no-collision", "ukhc.r126.stopping-gap"]
    told = []
    for in_sight in (False, True):
        found: dict[str, set[str]] = {}
        for r in judged([drive([ego, lead, other], LONG.environment, in_sight=in_sight)], rules=rules):
            found.setdefault(r["rule_id"], set()).add(r["verdict"])
        told.append(found)
    strict, seen = told
    for rule, verdicts in strict.items():
        if "unknown" not in verdicts:
            assert seen[rule] == verdicts, rule
        if "fail" in verdicts:
            assert "fail" in seen[rule], rule
