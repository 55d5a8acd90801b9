"""What is in plain view is recorded: how far the ego's lane is seen in a bend, and what follows from it."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.scenes import LANE, derived, drive, moving, road, rows, standing, times, verdict_rows

if TYPE_CHECKING:
    from drivelint.engine.batch import Drive
    from tests.scenes import Road

LONG = road(((2000.0, 0.0),), lanes=(2, 2))
AHEAD = ("criticality.ttc", "criticality.thw", "criticality.drac", "criticality.ttb", "criticality.mttc")


def seen_ahead(way: Road, *, box: bool) -> dict[int, dict[str, Any]]:
    """Return step in tenths -> the row of `_sight` of an ego that drives along a lane; somebody far away is lost at 1 s."""
    t = times(3.0)
    ego = moving("ego", way, t, 10 + 1 * t, -0.5 * LANE)
    gone = moving("gone", way, t, 150 + 0 * t, -0.5 * LANE).without_position(t > 1.05)
    # in the lane on the right: inside of a bend to the right
    lorry = standing("lorry", way, t, 62, -1.5 * LANE, length=12.0, width=2.5)
    scene = drive([ego, gone, *([lorry] if box else [])], way.environment, in_sight=True, sensor_range_m=100.0)
    con = derived(scene, tables=["_sight", "hidden"])
    return {round(r["t_ns"] / 1e8): r for r in rows(con, "FROM _sight ORDER BY t_ns")}


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
    (row,) = (seen_ahead(way, box=True)[20],)
    # from the front of the ego, two steps of 2 m less at the most; along the lane's own middle, outside of the line
    assert first - 12 - 2.4 - 6 < row["lane_m"] <= (first - 12) * (1 + LANE / 120) - 2.4
    assert seen_ahead(way, box=False)[20]["lane_m"] > row["lane_m"] + 20


def follows_nobody(*, in_sight: bool) -> Drive:
    """Return 25 s at 15 m/s behind one that is 60 m ahead, goes away, and is not recorded again."""
    t = times(25.0)
    ego = moving("ego", LONG, t, 100 + 15 * t, -0.5 * LANE)
    lead = moving("x", LONG, t, 164.8 + 17 * t, -0.5 * LANE).keep(t < 3.05)
    return drive([ego, lead], LONG.environment, in_sight=in_sight, sensor_range_m=100.0)


@pytest.mark.parametrize("rule", AHEAD)
def test_a_lane_in_plain_view_is_judged(rule: str) -> None:
    strict = {r["verdict"] for r in verdict_rows([follows_nobody(in_sight=False)], rules=[rule])}
    assert "unknown" in strict
    found = verdict_rows([follows_nobody(in_sight=True)], rules=[rule])
    assert {r["verdict"] for r in found} == {"pass"}
    assert {r["assumes"] for r in found} == {"line_of_sight"}
    assert None in {r["object_id"] for r in found}


def test_the_reason_is_the_objects_own_track() -> None:
    """Two beside the ego are lost, the nearer one later: each verdict speaks of its own object."""
    t = times(12.0)
    ego = moving("ego", LONG, t, 100 + 15 * t, -0.5 * LANE)
    one, two = (
        moving(name, LONG, t, s + 15 * t, 0.5 * LANE).keep(t < end)
        for name, s, end in (("one", 101, 3.05), ("two", 106, 5.05))
    )
    found = verdict_rows([drive([ego, one, two], LONG.environment, in_sight=True)], rules=["rss.lateral"])
    told = {r["object_id"]: r["reason"] for r in found if r["verdict"] == "unknown"}
    assert "the track of object one ends at 3.000 s: record it for longer" in told["one"]
    assert "the track of object two ends at 5.000 s: record it for longer" in told["two"]


@pytest.mark.parametrize(
    ("kind", "speed", "advice"),
    [(None, 0.5, "record its class"), ("object", 0.0, "no better recording can decide this")],
)
def test_what_is_or_may_be_no_vehicle_in_the_lane_ahead(kind: str | None, speed: float, advice: str) -> None:
    t = times(4.0)
    ego = moving("ego", LONG, t, 100 + 5 * t, -0.5 * LANE)
    ahead = replace(moving("x", LONG, t, 127 + speed * t, -0.5 * LANE), kind=kind, length=0.5, width=0.5)
    found = verdict_rows([drive([ego, ahead], LONG.environment)], rules=["criticality.ttc"])
    assert [r["verdict"] for r in found] == ["unknown"]
    assert "object x" in found[0]["reason"]
    assert advice in found[0]["reason"]


def test_a_rule_about_the_ego_alone_assumes_nothing() -> None:
    found = verdict_rows([follows_nobody(in_sight=True)], rules=["ukhc.r124.speed-limit", "ukhc.no-collision"])
    assert {r["rule_id"]: r["assumes"] for r in found} == {
        "ukhc.r124.speed-limit": None,
        "ukhc.no-collision": "line_of_sight",
    }
    everybody = drive(
        [moving("ego", LONG, times(5.0), 100 + 15 * times(5.0), -0.5 * LANE)], LONG.environment, in_sight=True
    )
    assert {r["assumes"] for r in verdict_rows([everybody], rules=["ukhc.no-collision", *AHEAD])} == {None}


@pytest.mark.slow
@settings(max_examples=12, deadline=None)
@given(st.floats(5, 60), st.floats(-8, 8), st.floats(2, 12), st.floats(0.3, 8), st.sampled_from([-1.5, -0.5, 0.5, 1.5]))
def test_what_is_decided_without_the_assumption_is_decided_alike_with_it(
    gap: float, faster: float, ends_s: float, hole_s: float, lane: float
) -> None:
    t = times(20.0)
    ego = moving("ego", LONG, t, 100 + 12 * t, -0.5 * LANE)
    lead = moving("lead", LONG, t, 200 + 12 * t, -0.5 * LANE)
    other = moving("x", LONG, t, 104.8 + gap + (12 + faster) * t, lane * LANE).without_position(
        (t > ends_s) & (t < ends_s + hole_s)
    )
    rules = [*AHEAD, "ukhc.r126.thinking-gap", "ukhc.no-collision", "ukhc.r126.stopping-gap"]
    told = []
    for in_sight in (False, True):
        found: dict[str, set[str]] = {}
        for r in verdict_rows([drive([ego, lead, other], LONG.environment, in_sight=in_sight)], rules=rules):
            found.setdefault(r["rule_id"], set()).add(r["verdict"])
        told.append(found)
    strict, seen = told
    for rule, verdicts in strict.items():
        if "unknown" not in verdicts:
            assert seen[rule] == verdicts, rule
        if "fail" in verdicts:
            assert "fail" in seen[rule], rule
