"""Since when the nearest vehicle ahead is that, and how it came."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pyarrow.compute as pc
import pytest

from tests.derive.junction_scenes import cross
from tests.scenes import LANE, Actor, derived, drive, judged, moving, road, rows, standing, swing, times

HANDS = pytest.mark.parametrize("hand", ["rht", "lht"])


def lanes(hand: str, n: int = 2) -> tuple[int, int]:
    return (0, n) if hand == "rht" else (n, 0)


def shift(t: np.ndarray, begin: float, lasts: float = 2.0) -> np.ndarray:
    """Return 0..1 over `lasts` seconds from `begin`."""
    u: np.ndarray = np.clip((t - begin) / lasts, 0.0, 1.0)
    return u


@HANDS
def test_one_that_comes_in_without_turning_joins_as_it_gets_into_the_ego_s_way(hand: str) -> None:
    """Simulators move vehicles sideways with straight headings: over the line long before the two boxes are in line, 1.8 m apart."""
    way = road(hand=hand, lanes=lanes(hand))
    t = times(10.0)
    sign = 1 if hand == "rht" else -1
    slow, fast = -1.5 * LANE * sign, -0.5 * LANE * sign
    ego = moving("ego", way, t, 100 + 10 * t, slow)
    other = moving("x", way, t, 130 + 10 * t, fast + (slow - fast) * shift(t, 2.0, 4.0))
    con = derived(drive([ego, replace(other, yaw=ego.yaw)], way.environment), tables=["lead"])
    found = rows(con, "FROM lead ORDER BY t_ns")
    joins = next(k for k, row in enumerate(found) if row["object_id"] == "x")
    assert t[joins] == pytest.approx(4.0, abs=0.15)
    assert {row["joined"] for row in found[joins:]} == {True}
    assert {row["t_since_ns"] for row in found[joins:]} == {found[joins]["t_ns"]}


@HANDS
def test_a_lead_that_cut_in_joined_then(hand: str) -> None:
    """From the lane beside into the ego's: turned by 10 degrees, it is 2.6 m across, and in when its centre is 3.0 m from the lane's."""
    way = road(hand=hand, lanes=lanes(hand))
    t = times(8.0)
    sign = 1 if hand == "rht" else -1
    slow, fast = -1.5 * LANE * sign, -0.5 * LANE * sign
    ego = moving("ego", way, t, 100 + 10 * t, slow)
    old = moving("old", way, t, 200 + 10 * t, slow)
    other = moving("x", way, t, 130 + 10 * t, fast + (slow - fast) * shift(t, 3.0))
    con = derived(drive([ego, old, other], way.environment), tables=["lead"])
    found = rows(con, "FROM lead ORDER BY t_ns")
    assert len(found) == len(t)
    joins = next(k for k, row in enumerate(found) if row["object_id"] == "x")
    assert t[joins] == pytest.approx(3.3)
    assert [row["object_id"] for row in found] == ["old"] * joins + ["x"] * (len(t) - joins)
    assert {row["joined"] for row in found[:joins]} == {False}  # the log begins there
    assert {row["joined"] for row in found[joins:]} == {True}
    assert {row["t_since_ns"] for row in found[joins:]} == {found[joins]["t_ns"]}
    assert {row["t_since_ns"] for row in found[:joins]} == {0}


def test_the_ego_that_changes_lanes_joins_its_new_lead() -> None:
    way = road(lanes=(0, 2))
    t = times(8.0)
    ego = moving("ego", way, t, 100 + 10 * t, -1.5 * LANE + LANE * shift(t, 3.0))
    lead = moving("x", way, t, 150 + 10 * t, -0.5 * LANE)
    found = rows(derived(drive([ego, lead], way.environment), tables=["lead"]), "FROM lead ORDER BY t_ns")
    assert {(row["object_id"], row["joined"]) for row in found} == {(None, None), ("x", True)}
    assert next(row["t_ns"] for row in found if row["object_id"]) == pytest.approx(4e9, abs=1e8)


def test_how_it_came_is_not_known_after_a_hole_or_where_it_had_no_place() -> None:
    way = road()
    t = times(8.0)
    ego = moving("ego", way, t, 100 + 10 * t, way.own)
    lead = moving("x", way, t, 150 + 10 * t, way.own)
    keep = (t < 3.05) | (t > 3.95)
    found = rows(
        derived(drive([ego.keep(keep), lead.keep(keep)], way.environment), tables=["lead"]), "FROM lead ORDER BY t_ns"
    )
    assert {(row["t_since_ns"], row["joined"]) for row in found} == {(0, False), (4_000_000_000, None)}
    blind = lead.lost((t > 2.95) & (t < 3.45))
    found = rows(derived(drive([ego, blind], way.environment), tables=["lead"]), "FROM lead ORDER BY t_ns")
    assert not [row for row in found if 2.95 < row["t_ns"] / 1e9 < 3.45]  # nobody is claimed absent
    assert {(row["t_since_ns"], row["joined"]) for row in found} == {(0, False), (3_500_000_000, None)}


def test_one_without_a_place_far_away_leaves_the_near_lead() -> None:
    """Unseen from 3 s on, 200 m ahead: braking with 10 m/s2 it stops after 5 m, where the lead comes as near as that only after 20 s."""
    way = road()
    t = times(24.0)
    ego = moving("ego", way, t, 100 + 10 * t, way.own)
    lead = moving("x", way, t, 130 + 10 * t, way.own)
    lost = moving("far", way, t, 300 + 10 * t, way.own).lost(t > 2.95)
    found = rows(derived(drive([ego, lead, lost], way.environment), tables=["lead"]), "FROM lead ORDER BY t_ns")
    assert {row["object_id"] for row in found} == {"x"}
    # its rear is at 326.6 m after 2.9 s, so at 331.6 m where it stops: the lead's rear is there at 20.4 s
    assert found[-1]["t_ns"] == 20_300_000_000


def test_one_off_the_lanes_with_a_place_hides_nobody() -> None:
    way = road()
    t = times(1.0)
    ego = moving("ego", way, t, 100 + 10 * t, way.own)
    beside_road = moving("x", way, t, 130 + 10 * t, 8.0)
    found = rows(derived(drive([ego, beside_road], way.environment), tables=["lead"]), "FROM lead")
    assert [row["object_id"] for row in found] == [None] * len(t)
    # but beyond the map's end it may well be on the road: 590 m is 10 m short of that
    ego = standing("ego", way, t, 590, way.own)
    beyond = moving("x", way, t, 640 + 10 * t, way.own)
    assert not rows(derived(drive([ego, beyond], way.environment), tables=["lead"]), "FROM lead")


def test_the_wrong_way_round_and_the_ego_beside_its_lane() -> None:
    """Parked against the traffic it leads, as oncoming; overtaking it, the ego is not in its lane."""
    way = road()
    t = times(20.0)
    s = 50 + 12 * t
    ego = moving("ego", way, t, s, swing(way, s, 100, 200, share=1.0))
    parked = standing("x", way, t, 280, way.own, turned=math.pi)
    found = rows(derived(drive([ego, parked], way.environment), tables=["lead"]), "FROM lead ORDER BY t_ns")
    assert {row["oncoming"] for row in found if row["object_id"]} == {True}
    out = [row["in_lane"] is False for row in found]
    assert out[: round((100 - 50) / 1.2)] == [False] * round((100 - 50) / 1.2)
    assert all(out[k] for k in range(len(t)) if 122 < s[k] < 198)
    assert not any(out[k] for k in range(len(t)) if s[k] > 222)


def test_each_ego_has_its_own_lead() -> None:
    way = road()
    t = times(1.0)
    cars = [moving(name, way, t, at + 10 * t, way.own) for name, at in (("a", 100), ("b", 140), ("c", 200))]
    con = derived(drive(cars, way.environment, egos=["a", "b"]), tables=["lead"])
    found = rows(con, "SELECT DISTINCT ego_id, object_id, joined FROM lead ORDER BY ALL")
    assert [tuple(row.values()) for row in found] == [("a", "b", False), ("b", "c", False)]


def test_one_without_a_heading_is_a_doubt_ahead_and_not_behind() -> None:
    way = road()
    t = times(0.5)
    ego = moving("ego", way, t, 300 + 10 * t, way.own)
    for s, told in ((350, False), (250, True)):
        other = standing("x", way, t, s, way.own, turned=math.nan)
        con = derived(drive([ego, other], way.environment), tables=["lead"])
        assert bool(rows(con, "FROM lead")) is told


@pytest.mark.parametrize("hand", ["right", "left"])
def test_one_that_comes_in_the_lane_in_which_the_ego_overtakes_is_ahead_of_it(hand: str) -> None:
    """Out of its lane the ego has no lead there, and yet one in its way; once back, that one is beside its way."""
    way = road(lanes=(1, 1), hand=hand)
    t = times(12.0)
    s = 50 + 12 * t
    ego = moving("ego", way, t, s, swing(way, s, 70, 150, share=1.0))
    other = moving("x", way, t, 400 - 12 * t, -way.own)
    con = derived(drive([ego, other], way.environment), tables=["lead", "vehicle_ahead"])
    assert {row["object_id"] for row in rows(con, "FROM lead")} == {None}
    ahead = {row["t_ns"]: row for row in rows(con, "FROM vehicle_ahead WHERE object_id = 'x'")}
    for k, at in enumerate(t):
        beside = abs(float(ego.y[k] - other.y[k]))
        if beside < 1.5 or beside > 2.6:
            assert (round(float(at) * 1e9) in ahead) == (beside < 1.5 and ego.x[k] < other.x[k]), at
    assert all(row["oncoming"] and not row["nearest"] for row in ahead.values())
    assert ahead[4_000_000_000]["gap_m"] == pytest.approx(400 - 48 - (50 + 48) - 4.8, abs=0.01)
    assert not rows(con, "FROM vehicle_ahead WHERE NOT known")
    # one that is short and of no known class may be a vehicle: every such step is unknown
    small = replace(other, kind=None, length=2.0)
    con = derived(drive([ego, small], way.environment), tables=["_lane_ahead", "vehicle_ahead"])
    near = {row["t_ns"] for row in rows(con, "FROM _lane_ahead WHERE gap_m < lead_reach_m(12.0)")}
    unknown = {row["t_ns"] for row in rows(con, "FROM vehicle_ahead WHERE NOT known")}
    assert near
    assert near == unknown
    assert not rows(con, "FROM vehicle_ahead WHERE object_id = 'x'")


@pytest.mark.parametrize(("v", "ahead"), [(0.0, False), (2.0, True)])
@pytest.mark.parametrize("hand", ["right", "left"])
def test_the_end_of_a_turned_box_meets_only_who_comes(hand: str, v: float, ahead: bool) -> None:
    """A lorry of 12 m is back in its lane with its front; its rear, 15 degrees off, still lies in that of one that faces it."""
    way = road(lanes=(1, 1), hand=hand)
    t = times(1.0)
    side = math.copysign(1.0, way.own)
    turned = side * math.pi / 12
    # the middle of the front lies in the middle of its lane
    ego = moving("ego", way, t, 100 + 0 * t, way.own - 6 * math.sin(turned) + 0 * t, length=12.0, width=2.5)
    ego = replace(ego, yaw=ego.yaw + turned, vx=5 * np.cos(ego.yaw + turned), vy=5 * np.sin(ego.yaw + turned))
    ego = replace(ego, x=ego.x + ego.vx * (t - 0.5), y=ego.y + ego.vy * (t - 0.5))
    other = moving("x", way, t, 112 - 2 * (t - 0.5), -way.own)
    if not v:
        other = replace(other, x=0 * t + other.x[5], y=0 * t + other.y[5], vx=0 * t, vy=0 * t)
    con = derived(drive([ego, other], way.environment), tables=["_lane_ahead"])
    assert bool(rows(con, "FROM _lane_ahead WHERE object_id = 'x' AND t_ns = 500000000")) == ahead


@pytest.mark.parametrize("turned", [math.pi / 2, math.pi / 3, -2.0])
def test_the_speed_of_one_ahead_is_that_along_the_lane(turned: float) -> None:
    """A bus slides over the lane ahead at 18 m/s, turned so: away from the ego it goes with the cosine of that."""
    way = road()
    t = times(8.0)
    ego = moving("ego", way, t, 100 + 18 * t, way.own)
    s, d = 190 + 18 * math.cos(turned) * (t - 4), way.own + 18 * math.sin(turned) * (t - 4)
    bus = replace(moving("bus", way, t, s, d, length=11.0, width=2.5), yaw=np.full(len(t), turned))
    found = rows(
        derived(drive([ego, bus], way.environment), tables=["vehicle_ahead"]),
        "FROM vehicle_ahead WHERE object_id = 'bus'",
    )
    assert found
    for row in found:
        assert row["speed_mps"] == pytest.approx(18 * abs(math.cos(turned)), abs=0.02)
        assert row["oncoming"] == (abs(turned) > math.pi / 2)
        if row["accel_mps2"] is not None:
            assert row["accel_mps2"] == pytest.approx(0, abs=0.1)
    if turned == math.pi / 2:
        worst = [
            r
            for r in judged([drive([ego, bus], way.environment)], rules=["criticality.ttc"])
            if r["object_id"] == "bus"
        ]
        assert "pass" not in {row["verdict"] for row in worst}


@pytest.mark.ci
@HANDS
def test_who_crosses_the_egos_way_by_a_lane_of_his_own_is_no_lead(hand: str) -> None:
    """The ego waits to turn across those who come straight on; one who stands there, or comes along the ego's own way, is ahead."""
    ways = cross(hand)
    t = times(24.0)
    turn, beside = ("wn", "ns") if hand == "rht" else ("ws", "sn")
    waits = 178.0 + 8 * np.clip(t - 16.0, 0.0, None)

    def ahead(*others: Actor, way: str = turn) -> list[dict[str, object]]:
        ego = moving("ego", ways[way], t, waits, ways[way].own)
        con = derived(drive([ego, *others], ways[way].environment), tables=["lead"])
        return [row for row in rows(con, "FROM lead ORDER BY t_ns") if row["t_ns"] < 16_000_000_000]

    comes = moving("x", ways["ew"], t, 120 + 8 * t, ways["ew"].own)
    across = moving("y", ways[beside], t, 100 + 8 * t, ways[beside].own)
    assert [row["object_id"] for row in ahead(comes, across)] == [None] * 160
    assert {row["object_id"] for row in ahead(standing("s", ways["ew"], t, 204.0, ways["ew"].own))} == {"s"}
    wrong = ahead(moving("w", ways["we"], t, 290 - 6 * t, ways["we"].own), way="we")
    assert {(row["object_id"], row["oncoming"]) for row in wrong} == {("w", True)}


@pytest.mark.sample(0, ci=2)
@pytest.mark.parametrize(
    ("linked", "s", "d", "told"),
    [
        (True, 180.0, -1.75, {"x"}),
        (False, 180.0, -1.75, set()),
        (False, 180.0, 1.75, {None}),
        (False, 140.0, -1.75, {"x"}),
    ],
)
def test_beyond_a_lane_whose_link_is_missing_nobody_knows_who_leads(
    linked: bool, s: float, d: float, told: set[str | None]
) -> None:
    """The lane is cut at 150 m; without the link the corridor ends there, though the next lane goes straight on."""
    way = road(cuts=(150.0,))
    tables = way.environment.tables
    environment = replace(
        way.environment, tables=tables if linked else tables | {"lane_link": tables["lane_link"].slice(0, 0)}
    )
    t = times(0.3)
    ego, other = moving("ego", way, t, 100 + 10 * t, way.own), moving("x", way, t, s + 10 * t, d)
    found = rows(derived(drive([ego, other], environment), tables=["lead"]), "FROM lead")
    assert {row["object_id"] for row in found} == told


@pytest.mark.sample(0, ci=2)
@pytest.mark.parametrize(
    ("s", "d", "told"), [(147.0, -1.75, set()), (160.0, -1.75, {"x"}), (140.0, -1.75, {"x"}), (147.0, 2.5, {None})]
)
def test_in_a_hole_between_two_lanes_nobody_knows_who_leads(s: float, d: float, told: set[str | None]) -> None:
    """The lanes are cut at 150 m, and those before drawn to about 145 m only."""
    way = road(cuts=(150.0,))
    tables = way.environment.tables
    points, lanelets = tables["lane_point"], tables["lanelet"]
    short = pc.is_in(points["lanelet_id"], lanelets.filter(pc.less(lanelets["length_m"], 200))["lanelet_id"])
    kept = points.filter(pc.or_(pc.invert(short), pc.less(points["s_m"], 145)))
    assert 0 < points.num_rows - kept.num_rows < 20
    t = times(0.3)
    ego, other = moving("ego", way, t, 100 + 10 * t, way.own), standing("x", way, t, s, d)
    holed = replace(way.environment, tables=tables | {"lane_point": kept})
    found = rows(derived(drive([ego, other], holed), tables=["lead"]), "FROM lead")
    assert {row["object_id"] for row in found} == told
