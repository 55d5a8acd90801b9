"""Roads over each other: heights where they are recorded, and what the map tells where they are not."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa
import pytest

from tests import blinding
from tests.derive.bridge_scenes import bridge, lifted
from tests.scenes import derived, drive, judged, moving, road, rows, standing, times

if TYPE_CHECKING:
    from drivelint.engine.batch import Drive
    from tests.scenes import Row

HANDS = pytest.mark.parametrize("hand", ["lht", "rht"])
CRASH = "ukhc.no-collision"


def crossing(hand: str, rise_m: float | None = None, meet_s: float = 6.0) -> Drive:
    """Return the ego on the lower road at 15 m/s and a car that crosses over it in the very moment, 300 m on."""
    low, high = bridge(hand, rise_m)
    t = times(12.0)
    ego = moving("ego", low, t, 300 - 15 * (meet_s - t), low.own)
    over = moving("over", high, t, 200 + 15 * (t - meet_s), high.own)
    return drive([ego, over], low.environment)


def said(scene: Drive, *rules: str) -> list[Row]:
    return judged([scene], rules=rules)


def verdicts(scene: Drive, *rules: str) -> set[str]:
    return {row["verdict"] for row in said(scene, *rules)}


@pytest.mark.ci
@HANDS
def test_a_car_on_the_bridge_is_no_collision(hand: str) -> None:
    """By height, by the map's heights, or by a map that does not say."""
    by_height = lifted(crossing(hand), {"ego": 0.0, "over": 6.0})
    for scene in (by_height, crossing(hand, 6.0), crossing(hand)):
        assert verdicts(scene, CRASH) == {"unknown"}
        found = rows(derived(scene, tables=["pair", "conflict"]), "FROM pair WHERE off_level ORDER BY t_ns")
        assert all(row["x_m"] is None and row["s_m"] is None and (row["clearance_m"] or 1) > 0 for row in found)
        assert any(row["clearance_m"] is None for row in found)
        # over the running lane and one lane's width to each side: 10.5 m and its length at 15 m/s
        assert 0.8 <= len(found) / 10 <= 1.4
        assert not rows(derived(scene, tables=["conflict"]), "FROM conflict")


@pytest.mark.ci
@HANDS
def test_on_one_level_it_is_one(hand: str) -> None:
    """The log's heights are the same, or the map's: there is a crossing without a junction."""
    level = lifted(crossing(hand), {"ego": 0.0, "over": 0.8}, slope=0.001)
    for scene in (level, crossing(hand, 0.0)):
        assert verdicts(scene, CRASH) == {"fail"}
        assert rows(derived(scene, tables=["conflict"]), "FROM conflict")


@HANDS
def test_who_follows_the_ego_s_own_road_under_the_bridge_is_met(hand: str) -> None:
    """Its centre is on both roads in plan, its heading is the lower one's."""
    low, _ = bridge(hand)
    t = times(12.0)
    ego = moving("ego", low, t, 200 + 15 * t, low.own)
    ahead = moving("ahead", low, t, 230 + 15 * t, low.own)
    con = derived(drive([ego, ahead], low.environment), tables=["lead"])
    found = rows(con, "FROM lead")
    assert len(found) == len(t)
    assert {row["object_id"] for row in found} == {"ahead"}
    crash = drive([ego, standing("ahead", low, t, 300, low.own)], low.environment)
    assert verdicts(crash, CRASH) == {"fail"}


@pytest.mark.ci
@HANDS
def test_who_stands_on_the_bridge_is_not_nobody(hand: str) -> None:
    """It stands over the ego's lane 100 m ahead: neither a lead nor a free road."""
    low, high = bridge(hand)
    t = times(2.0)
    ego = moving("ego", low, t, 200 + 10 * t, low.own)
    over = standing("over", high, t, 200 - high.own, high.own)
    scene = drive([ego, over], low.environment)
    for known in (scene, lifted(scene, {"ego": 0.0, "over": 7.0})):
        con = derived(known, tables=["lead", "oncoming", "unplaced"])
        assert not rows(con, "FROM lead")
        assert {row["n_unplaced"] for row in rows(con, "FROM oncoming")} == {1}
        assert {row["code"] for row in rows(con, "FROM unplaced")} == {"off_level"}
    # a lead that is nearer is nearer
    near = moving("near", low, t, 230 + 10 * t, low.own)
    found = rows(derived(drive([ego, over, near], low.environment), tables=["lead"]), "FROM lead")
    assert {row["object_id"] for row in found} == {"near"}
    assert len(found) == len(t)


@HANDS
def test_seen_from_the_bridge_it_is_the_same(hand: str) -> None:
    low, high = bridge(hand)
    t = times(6.0)
    ego = moving("ego", high, t, 155 + 15 * t, high.own)
    under = moving("under", low, t, 255 + 15 * t, low.own)
    scene = drive([ego, under], low.environment)
    assert verdicts(scene, CRASH) == {"unknown"}
    assert verdicts(lifted(scene, {"ego": 6.0, "under": 0.0}), CRASH) == {"unknown"}


@pytest.mark.parametrize("grade", [0.1, -0.1])
@HANDS
def test_a_hill_is_one_level(hand: str, grade: float) -> None:
    """A lead 300 m on and 30 m higher, boxes by their centre and by the ground: everybody is met."""
    way = road(((1200.0, 0.0),), hand)
    t = times(3.0)
    ego = moving("ego", way, t, 100 + 20 * t, way.own)
    lead = moving("lead", way, t, 400 + 20 * t, way.own, kind="truck", length=12.0)
    oncoming = moving("oncoming", way, t, 700 - 20 * t, way.other)
    scene = lifted(drive([ego, lead, oncoming], way.environment), {"ego": 0.0, "lead": 2.1, "oncoming": 0.75}, grade)
    con = derived(scene, tables=["pair", "lead", "oncoming"])
    assert not rows(con, "FROM pair WHERE off_level")
    assert {row["object_id"] for row in rows(con, "FROM lead")} == {"lead"}
    assert {row["object_id"] for row in rows(con, "FROM oncoming")} == {"oncoming"}


@HANDS
def test_a_height_that_nobody_measured_says_nothing(hand: str) -> None:
    """A flat simulation writes 0, or half of each box, all the while: the map has to tell."""
    for heights in ({"ego": 0.0, "over": 0.0}, {"ego": 0.75, "over": 2.0}):
        assert verdicts(lifted(crossing(hand), heights), CRASH) == {"unknown"}


@pytest.mark.ci
@HANDS
def test_without_a_map_height_alone_decides(hand: str) -> None:
    bare = replace(crossing(hand), environment=None)
    assert verdicts(bare, CRASH) == {"fail"}
    assert verdicts(lifted(bare, {"ego": 0.0, "over": 6.0}), CRASH) == {"unknown"}
    # who is beside the ego in plan is no contact on any level
    low, _ = bridge(hand)
    t = times(2.0)
    pair_ = [moving("ego", low, t, 100 + 10 * t, low.own), moving("high", low, t, 100 + 10 * t, low.own + 5)]
    assert verdicts(lifted(drive(pair_, None), {"ego": 0.0, "high": 6.0}), CRASH) == {"pass"}


@HANDS
def test_who_falls_through_the_ground_is_on_no_level(hand: str) -> None:
    """As a simulator may let it: 6 m down at the crossing, 60 m at the end, is no road under the ego's."""

    def sunk(depth_m: float) -> set[str]:
        def change(states: pa.Table) -> pa.Table:
            is_other = np.array(states["actor_id"].to_pylist()) == "over"
            fall = np.maximum(states["t_ns"].to_numpy() / 1e9 - 4.0, 0.0) / 8.0
            z = pa.array(np.where(is_other, 10.0 - 6.0 - depth_m * fall, 10.0 + fall))
            return states.set_column(states.schema.get_field_index("z_m"), "z_m", z)

        return verdicts(blinding.changed(crossing(hand), "actor_state", change), CRASH)

    assert sunk(0.0) == {"pass"}
    assert sunk(60.0) == {"unknown"}


@pytest.mark.ci
@HANDS
def test_without_heights_nothing_more_passes(hand: str) -> None:
    """The law: heights taken away, no pass appears; nobody is taken for one who is not there."""
    low, high = bridge(hand)
    t = times(12.0)
    ego = moving("ego", low, t, 210 + 15 * t, low.own)
    others = [
        moving("over", high, t, 110 + 15 * t, high.own),
        moving("back", high, t, 320 - 15 * t, high.other),
        moving("lead", low, t, 260 + 14 * t, low.own),
        moving("met", low, t, 580 - 15 * t, low.other),
        standing("stands", high, t, 200 + low.own, high.own),
        standing("beside", high, t, 200 - high.own, high.own),
    ]
    scene = drive([ego, *others], low.environment)
    known = lifted(
        scene,
        {a.actor_id: 6.0 if a.actor_id in {"over", "back", "stands", "beside"} else 0.0 for a in (ego, *others)},
        1e-4,
    )

    def passed(it: Drive) -> dict[tuple[object, ...], list[tuple[int, int]]]:
        found: dict[tuple[object, ...], list[tuple[int, int]]] = {}
        for r in judged([it], rules=["ukhc", "criticality", "rss", "stvo"]):
            if r["verdict"] == "pass":
                of = (r["rule_id"], r["profile"], r["object_id"])
                found.setdefault(of, []).append((r["t_start_ns"], r["t_end_ns"]))
        return found

    before, after = passed(known), passed(scene)
    assert before
    met: dict[object, list[int]] = {}
    for row in rows(derived(known, tables=["pair"]), "SELECT object_id, t_ns FROM pair"):
        met.setdefault(row["object_id"], []).append(row["t_ns"])
    new = [
        (of, begin, end)
        for of, spans in after.items()
        for begin, end in spans
        # an actor that the heights put on another level has no verdict at those steps
        for t_ns in ([at for at in met.get(of[2], []) if begin <= at <= end] if of[2] else [begin, end])
        if not any(first <= t_ns <= last for first, last in before.get(of, ()))
    ]
    assert new == []
