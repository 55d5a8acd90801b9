"""Lines crossed step by step, and lanes changed, on roads of two lanes each way."""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import numpy as np
import pytest

from drivelint.formats import load_map
from drivelint.road.map_reader import MapSource
from tests.derive.marked import ease, marked, offsets, tables, tapering
from tests.formats.opendrive import xodr
from tests.scenes import (
    LANE,
    Actor,
    Road,
    drive,
    judged,
    limited,
    linked,
    moving,
    plan,
    road,
    rows,
    seconds,
    standing,
    swing,
    times,
)

HANDS = pytest.mark.parametrize("hand", ["rht", "lht"])
ROW = dict[str, Any]


# ---- line_step


@HANDS
def test_every_step_over_the_centre_line(hand: str) -> None:
    """A wobble over a solid line to one that comes the other way; its furthest corner by hand."""
    way = marked(hand)
    t = times(10.0)
    d = way.own - np.sign(way.own) * 1.2 * ease((t - 3) / 1.5) * (1 - ease((t - 6) / 1.5))
    ego = moving("ego", way, t, 100 + 10 * t, d)
    found = rows(tables(way, ego), "FROM line_step ORDER BY t_ns")
    out = np.abs(d - way.own) + 0.9 * np.cos(ego.yaw) + 2.4 * np.abs(np.sin(ego.yaw)) - LANE / 2
    assert seconds(found, "t_ns") == pytest.approx(list(t[out > 0.05]))
    assert [row["out_m"] for row in found] == pytest.approx(list(out[out > 0.05]), abs=1e-6)
    assert {(r["side"], r["marking"], r["forbidden"], r["beyond"]) for r in found} == {
        ("left" if hand == "rht" else "right", "solid", True, "opposing")
    }
    assert {r["middle"] for r in found} == {True}
    assert {(r["t_since_ns"], r["begin_seen"], r["manoeuvre"]) for r in found} == {(found[0]["t_ns"], True, False)}
    assert {(r["passing_id"], r["passing_known"], r["access"]) for r in found} == {(None, True, False)}


@pytest.mark.parametrize(("centre", "may"), [("solid broken", True), ("broken solid", False)])
def test_of_a_double_line_the_nearer_one_counts(centre: str, may: bool) -> None:
    """OpenDRIVE names the two of a centre line from left to right: where one driver may cross it, the other may not."""
    way = marked("rht", centre)
    t = times(1.0)
    one = rows(tables(way, moving("ego", way, t, 100 + 10 * t, -0.5)), "FROM line_step")
    other = rows(tables(way, moving("ego", way, t, 500 - 10 * t, 0.5)), "FROM line_step")
    assert {row["forbidden"] for row in one} == {not may}
    assert {row["forbidden"] for row in other} == {may}


@pytest.mark.ci
def test_over_the_edge() -> None:
    t = times(1.0)
    for beyond, what in ((None, None), ("shoulder", "shoulder"), ("none", None)):
        way = marked("rht", beyond=beyond)
        found = rows(tables(way, moving("ego", way, t, 100 + 10 * t, -3.0)), "FROM line_step")
        assert {(r["side"], r["marking"], r["beyond"], r["middle"]) for r in found} == {("right", "solid", what, False)}


@HANDS
def test_round_whom_it_goes(hand: str) -> None:
    """A parked car is passed from 60 m (10 m and 5 s) before it to 60 m behind; one that drives on is none, nor one beyond the verge."""
    way = marked(hand)
    t = times(30.0)
    s = 50 + 10 * t
    ego = moving("ego", way, t, s, swing(way, s, 120, 260))
    parked = standing("parked", way, t, 190, way.own * 1.4)
    far = standing("verge", way, t, 150, way.own * 4.5)
    con = tables(way, ego, parked, far)
    found = rows(con, "FROM line_step ORDER BY t_ns")
    assert {row["manoeuvre"] for row in found} == {True}
    for row in found:
        at = 50 + row["t_ns"] / 1e8
        gap = abs(at - 190) - 4.8
        if abs(gap - 60) > 1:  # its speed is a little more than 10 m/s as it swings out
            assert (row["passing_id"] == "parked") is (gap <= 60), at
    blind = rows(tables(way, ego, parked.lost(t > 2.0), far), "FROM line_step ORDER BY t_ns")
    assert {(row["passing_id"], row["passing_known"]) for row in blind} == {(None, False)}


WHOM = [
    ("bicycle", 4.4, True),
    ("bicycle", 4.6, False),
    ("car", 0.4, True),
    ("car", 0.6, False),
    ("animal", 2.0, True),
    ("pedestrian", 0.0, False),
    ("vehicle", 0.4, True),
    ("vehicle", 4.4, None),  # it may be a bicycle
    ("vehicle", 4.6, False),
    (None, 0.0, None),
    (None, 4.4, None),
    (None, 4.6, False),
    ("object", 0.4, True),
    ("object", 0.6, None),  # a thing that moves may be anything
]


@pytest.mark.parametrize(("kind", "speed", "counts"), WHOM)
def test_whom_one_may_pass_over_a_line(kind: str | None, speed: float, counts: bool | None) -> None:
    way = marked("rht")
    t = times(1.0)
    ego = moving("ego", way, t, 100 + 6 * t, -0.5)
    other = moving("x", way, t, 110 + speed * t, -3.0, kind=kind, length=1.8, width=0.6)
    found = rows(tables(way, ego, other), "FROM line_step")
    assert {row["passing_id"] for row in found} == ({"x"} if counts else {None})
    assert {row["passing_known"] for row in found} == {counts is not None}


def leaving(way: Road, speed: float, turn: float, on: float = 40.0) -> Actor:
    """Return an ego that drives 200 m near the middle of the road and turns off over its other side by `turn`, for `on` metres."""
    towards = way.over
    bend = 12.0  # radius of the turn
    arc = turn * bend
    t = times((200 + arc + on) / speed, period=0.5 / speed)
    way_m = np.minimum(speed * t, 200 + arc + on)
    before = np.minimum(way_m, 200.0)
    angle = np.clip(way_m - 200.0, 0, arc) / bend
    after = np.maximum(way_m - 200.0 - arc, 0)
    x = 100 + before + bend * np.sin(angle) + after * math.cos(turn)
    d = bend * (1 - np.cos(angle)) + after * math.sin(turn)
    y = towards * (d - 0.5)
    return Actor("ego", t, x, y, towards * angle, np.gradient(x, t), np.gradient(y, t))


def accesses(way: Road, ego: Actor) -> set[bool | None]:
    """Return what is said of access in the 25 m before the ego is off the lanes and the 10 m after that."""
    found = rows(tables(way, ego), "FROM line_step ORDER BY t_ns")
    x = dict(zip(np.round(ego.t_s * 1e9).astype(int).tolist(), ego.x.tolist(), strict=True))
    off = float(ego.x[np.abs(ego.y) > LANE][0])
    return {row["access"] for row in found if off - 25 < x[row["t_ns"]] < off + 10}


@pytest.mark.ci
@HANDS
def test_access_to_a_way_beside_the_road(hand: str) -> None:
    """Slowly round a corner to the other side of the road is access; before that by more than 30 m it is none."""
    way = marked(hand)
    ego = leaving(way, 5.0, math.pi / 2)
    assert accesses(way, ego) == {True}
    found = rows(tables(way, ego), "FROM line_step ORDER BY t_ns")
    assert found[0]["access"] is None  # it may have come out of one
    x = dict(zip(np.round(ego.t_s * 1e9).astype(int).tolist(), ego.x.tolist(), strict=True))
    assert {row["access"] for row in found if 135 < x[row["t_ns"]] < 265} == {False}
    # the log ends before it is there
    cut = rows(tables(way, ego.keep(ego.x < 300)), "FROM line_step ORDER BY t_ns")
    assert cut[-1]["access"] is None


@HANDS
@pytest.mark.parametrize(
    ("speed", "turn", "on", "access"),
    [
        (8.5, 1.0, 40.0, True),
        (9.5, 1.0, 40.0, None),  # fast, and yet it turned off
        (20.0, 0.15, 80.0, False),  # it runs off the road
        (5.0, 0.15, 50.0, None),  # slowly over the verge: whether that is a way is not known
    ],
)
def test_what_plainly_shows_access(hand: str, speed: float, turn: float, on: float, access: bool | None) -> None:
    way = marked(hand)
    assert accesses(way, leaving(way, speed, turn, on)) == {access}


def test_along_the_verge_and_back_is_no_access() -> None:
    way = marked("rht")
    t = times(60.0)
    s = 100 + 5 * t
    ego = moving("ego", way, t, s, -0.5 + 5.5 * ease((s - 200) / 40) * (1 - ease((s - 280) / 40)))
    assert {row["access"] for row in rows(tables(way, ego), "FROM line_step") if 10 < row["t_ns"] / 1e9 < 50} == {False}
    # it stands there
    there = moving("ego", way, t, np.minimum(s, 260), -0.5 + 5.5 * ease((np.minimum(s, 260) - 200) / 40))
    assert True in {row["access"] for row in rows(tables(way, there), "FROM line_step")}


@pytest.mark.ci
@HANDS
def test_who_comes_back_from_over_the_line_was_on_no_way_beyond_it(hand: str) -> None:
    """A log of 40 m: over the line by 0.5 m in its middle, and back; where the log ends before that, nobody knows."""
    way = marked(hand)
    t = times(8.0)
    bump = ease((t - 2) / 2) * (1 - ease((t - 4) / 2))
    ego = moving("ego", way, t, 200 + 5 * t, way.own + way.over * 1.35 * bump)
    found = rows(tables(way, ego), "FROM line_step ORDER BY t_ns")
    assert {row["access"] for row in found} == {False}
    cut = rows(tables(way, ego.keep(t < 4.05)), "FROM line_step ORDER BY t_ns")
    assert {row["access"] for row in cut} == {None}
    late = rows(tables(way, ego.keep(t > 3.95)), "FROM line_step ORDER BY t_ns")
    assert {row["access"] for row in late} == {None}


def turning_round(way: Road, radius: float = 4.7) -> Actor:
    """Return an ego that drives 200 m in its lane, turns round over the other side of the road and drives back along that."""
    arc = math.pi * radius
    t = times(90.0)
    way_m = 5.0 * t
    angle = np.clip((way_m - 200) / radius, 0, math.pi)
    x = 100 + np.minimum(way_m, 200) + radius * np.sin(angle) - np.maximum(way_m - 200 - arc, 0)
    home = ease((way_m - 200 - arc) / 30)  # from beside its new lane into it
    off = -2.5 + radius * (1 - np.cos(angle))
    y = way.over * (off + (LANE / 2 - off) * home)
    vx, vy = np.gradient(x, t), np.gradient(y, t)
    return Actor("ego", t, x, y, np.arctan2(vy, vx), vx, vy)


@HANDS
@pytest.mark.parametrize("radius", [4.7, 5.2])
@pytest.mark.parametrize("beyond", ["shoulder", "parking", "biking", "sidewalk", None])
def test_turning_round_is_no_access(hand: str, beyond: str | None, radius: float) -> None:
    """Its middle is off the lanes for a moment, before it is across the road or after that."""
    way = marked(hand, beyond=beyond)
    found = rows(tables(way, turning_round(way, radius)), "FROM line_step ORDER BY t_ns")
    over = {row["access"] for row in found if row["side"] == ("left" if hand == "rht" else "right")}
    assert False in over or beyond in {"sidewalk", None}
    assert True not in over


@HANDS
@pytest.mark.parametrize("beyond", ["shoulder", "stop", "parking", "border", "restricted", "biking"])
def test_a_stop_along_the_other_side_is_no_access(hand: str, beyond: str) -> None:
    """On a strip of the road itself: whoever parks there, or sets off from there, has not reached or left premises."""
    way = marked(hand, beyond=beyond)
    t = times(60.0)
    s = np.minimum(100 + 5 * t, 260)
    across = ease((s - 200) / 40)
    there = moving("ego", way, t, s, way.over * (-0.5 + 5.75 * across))
    assert accesses(way, there) == {False}
    away = moving("ego", way, t, 100 + 260 - s[::-1], way.over * (-0.5 + 5.75 * across[::-1]))
    found = rows(tables(way, away), "FROM line_step ORDER BY t_ns")
    assert {row["access"] for row in found if 40 < row["t_ns"] / 1e9 < 47} == {False}


@HANDS
def test_over_the_shoulder_to_premises_is_access(hand: str) -> None:
    """Across it and on; where the log ends on it, at an angle, it may be on the way there."""
    way = marked(hand, beyond="shoulder")
    ego = leaving(way, 5.0, math.pi / 2)
    assert accesses(way, ego) == {True}
    assert accesses(way, ego.keep(np.abs(ego.y) < 1.8 * LANE)) == {None}


def test_off_on_the_near_side_is_no_reason_to_cross_the_middle() -> None:
    way = marked("rht")
    t = times(30.0)
    s = 100 + 6 * t
    x, y = s, np.where(s < 220, -0.5, -0.5 - np.maximum(s - 220, 0) * 1.2)
    yaw = np.where(s < 220, 0.0, -math.atan(1.2))
    ego = Actor("ego", t, x, y, yaw, np.gradient(x, t), np.gradient(y, t))
    found = [
        row
        for row in rows(tables(way, ego), "FROM line_step ORDER BY t_ns")
        if row["side"] == "left" and 6e9 < row["t_ns"] < 22e9
    ]
    assert {row["access"] for row in found} == {False}


@HANDS
@pytest.mark.parametrize(("reach", "excuses"), [(1.6, True), (0.9, True), (0.6, False), (0.0, False), (-0.3, False)])
def test_who_leaves_room_enough_is_no_reason_to_cross(hand: str, reach: float, excuses: bool) -> None:
    """`reach`: how far a parked car stands in the lane of 3.5 m; the ego is 1.8 m wide and leaves it a metre."""
    way = marked(hand)
    t = times(1.0)
    side = np.sign(way.own)
    ego = moving("ego", way, t, 100 + 6 * t, side * 0.5)
    parked = standing("x", way, t, 115, float(side * (LANE - reach + 0.9)))
    assert {row["passing_id"] for row in rows(tables(way, ego, parked), "FROM line_step")} == (
        {"x"} if excuses else {None}
    )


@pytest.mark.ci
@HANDS
def test_parked_cars_do_not_excuse_overtaking_one_that_drives(hand: str) -> None:
    """Both stand or drive in the lane; overtaking the one that drives needs the line all along."""
    way = marked(hand)
    t = times(30.0)
    s = 50 + 14 * t
    ego = moving("ego", way, t, s, swing(way, s, 120, 330))
    parked = standing("parked", way, t, 190, float(np.sign(way.own) * (LANE - 0.7)))
    slow = moving("slow", way, t, 130 + 5 * t, way.own)
    alone = {row["passing_id"] for row in rows(tables(way, ego, parked), "FROM line_step")}
    both = {row["passing_id"] for row in rows(tables(way, ego, parked, slow), "FROM line_step")}
    assert (alone, both) == ({None, "parked"}, {None})
    queue = standing("queue", way, t, 230, way.own)
    assert "queue" in {row["passing_id"] for row in rows(tables(way, ego, parked, queue), "FROM line_step")}


# ---- lane_change


@HANDS
@pytest.mark.parametrize("to", ["in", "out"])
def test_a_lane_change_to_either_side(hand: str, to: str) -> None:
    way = marked(hand, lanes=2)
    t = times(16.0)
    d = offsets(way, t, 6.0) if to == "in" else offsets(way, t, 6.0, start=0.5, to=1.5)
    ego = moving("ego", way, t, 100 + 12 * t, d)
    ahead = moving("ahead", way, t, 160 + 12 * t, offsets(way, t, 99.0, start=0.5 if to == "in" else 1.5))
    behind = moving("behind", way, t, 70 + 13 * t - 1.5 * np.clip(t - 7.5, 0, 1) ** 2, ahead.y)
    same = moving("same", way, t, 130 + 12 * t, offsets(way, t, 99.0, start=1.5 if to == "in" else 0.5))
    con = tables(way, ego, ahead, behind, same)
    (found,) = rows(con, "FROM lane_change")
    left = (hand == "rht") == (to == "in")
    inner, outer = ("1.0.-1", "1.0.-2") if hand == "rht" else ("1.0.1", "1.0.2")
    assert found["side"] == ("left" if left else "right")
    assert (found["from_lanelet_id"], found["to_lanelet_id"]) == ((outer, inner) if to == "in" else (inner, outer))
    moved = np.abs(d - d[0])
    extent = 0.9 * np.cos(ego.yaw) + 2.4 * np.abs(np.sin(ego.yaw))
    assert found["t_start_ns"] == round(t[moved + extent - LANE / 2 > 0.05][0] * 1e9)
    assert found["t_cross_ns"] == pytest.approx(8e9, abs=1.1e8)
    assert found["t_done_ns"] == round(t[(moved - extent > LANE / 2 - 0.05)][0] * 1e9)
    start = int(np.searchsorted(t, found["t_start_ns"] / 1e9 - 0.01))
    front = 100 + 12 * t[start] + 2.4
    assert (found["begin_seen"], found["known"], found["merge"]) == (True, True, False)
    assert (found["leader_id"], found["follower_id"]) == ("ahead", "behind")
    assert found["leader_gap_m"] == pytest.approx(160 + 12 * t[start] - 2.4 - front, abs=0.1)
    assert found["follower_gap_m"] == pytest.approx(front - 4.8 - (70 + 13 * t[start]) - 2.4, abs=0.2)
    assert (found["leader_speed_mps"], found["follower_speed_mps"]) == pytest.approx((12.0, 13.0))
    assert found["ego_speed_mps"] == pytest.approx(12.0, abs=0.2)
    speed = behind.vx
    drops = [(speed[k - 5] - speed[k]) / 0.5 for k in range(start + 5, start + 41)]
    assert found["follower_decel_mps2"] == pytest.approx(max(drops), abs=1e-6)
    assert max(drops) > 2.0
    (line,) = rows(con, "SELECT DISTINCT t_since_ns, begin_seen, manoeuvre FROM line_step")
    assert tuple(line.values()) == (found["t_start_ns"], True, True)
    assert {row["side"] for row in rows(con, "FROM line_step")} == {"left", "right"}
    assert {row["forbidden"] for row in rows(con, "FROM line_step")} == {False}


def test_neither_a_wobble_nor_an_overtake_is_a_lane_change() -> None:
    way = marked("rht", lanes=2)
    t = times(14.0)
    there_and_back = offsets(way, t, 3.0, to=1.05) + offsets(way, t, 8.0, start=0.0, to=0.45)
    assert not rows(tables(way, moving("ego", way, t, 100 + 12 * t, there_and_back)), "FROM lane_change")
    way = road()
    s = 50 + 12 * t
    ego = moving("ego", way, t, s, swing(way, s, 80, 160))
    assert not rows(tables(way, ego, standing("x", way, t, 140, way.own)), "FROM lane_change")


@pytest.mark.ci
def test_cut_by_the_log_or_by_a_hole() -> None:
    way = marked("rht", lanes=2)
    t = times(14.0)
    ego = moving("ego", way, t, 100 + 12 * t, offsets(way, t, 6.0))

    def seen(keep: Any) -> ROW:
        (found,) = rows(tables(way, ego.keep(keep)), "FROM lane_change")
        return found

    whole = seen(t > -1)
    begun = seen(t < 7.85)
    assert (begun["t_start_ns"], begun["t_cross_ns"], begun["t_done_ns"]) == (whole["t_start_ns"], None, None)
    assert (begun["to_lanelet_id"], begun["merge"], begun["side"]) == (None, None, "left")
    crossed = seen(t < 8.55)
    assert (crossed["t_cross_ns"], crossed["t_done_ns"]) == (whole["t_cross_ns"], None)
    late = seen(t > 7.55)
    assert (late["t_start_ns"], late["begin_seen"], late["t_done_ns"]) == (7_600_000_000, False, whole["t_done_ns"])
    hole = seen((t < 7.55) | (t > 8.35))
    assert (hole["t_start_ns"], hole["t_cross_ns"], hole["t_done_ns"]) == (
        whole["t_start_ns"],
        None,
        whole["t_done_ns"],
    )
    assert hole["to_lanelet_id"] == "1.0.-1"
    unseen = seen((t < 6.05) | (t > 10.05))
    assert (unseen["t_start_ns"], unseen["begin_seen"], unseen["t_cross_ns"]) == (10_100_000_000, False, None)
    barely = ego.keep(t < 7.15)  # 0.1 m over the line at the end may be a wobble
    assert not rows(tables(way, barely), "FROM lane_change")


def test_two_in_a_row_and_one_taken_back() -> None:
    way = marked("rht", lanes=3)
    t = times(20.0)
    ego = moving("ego", way, t, 50 + 12 * t, offsets(way, t, 3.0, 8.0, to=0.5, start=2.5))
    found = rows(tables(way, ego), "FROM lane_change ORDER BY occurrence")
    assert [(row["occurrence"], row["side"], row["from_lanelet_id"], row["to_lanelet_id"]) for row in found] == [
        (0, "left", "1.0.-3", "1.0.-2"),
        (1, "left", "1.0.-2", "1.0.-1"),
    ]
    assert found[0]["t_done_ns"] is None or found[0]["t_done_ns"] <= found[1]["t_cross_ns"]
    back = offsets(way, t, 3.0, start=1.5, to=0.9) + offsets(way, t, 8.0, start=0.0, to=0.6)
    found = rows(tables(way, moving("ego", way, t, 50 + 12 * t, back)), "FROM lane_change ORDER BY occurrence")
    assert [(row["side"], row["begin_seen"]) for row in found] == [("left", True), ("right", False)]
    assert found[0]["t_done_ns"] is None  # it was never wholly in the new lane
    assert found[1]["t_start_ns"] == found[0]["t_cross_ns"]
    assert found[1]["t_done_ns"] > found[1]["t_cross_ns"]


@cache
def ramp(hand: str, kind: str) -> Road:
    """Return 600 m of road with a second lane of this type that ends at 300 m."""
    one = (1, 2) if hand == "lht" else (-1, -2)
    long = linked(one[0])
    short = xodr.lane(one[1], f'<link/><width sOffset="0" a="{LANE}"/>', kind)
    text = xodr.xodr(
        xodr.road(
            geometry=plan(((600.0, 0.0),)), lanes=xodr.section(0, long, short) + xodr.section(300, long),
            length=600.0, attributes=f'rule="{hand.upper()}"', more=limited(60),
        )
    )  # fmt: skip
    return Road(load_map(MapSource(f"ramp-{hand}-{kind}.xodr", text.encode())), ((600.0, 0.0),))


@HANDS
@pytest.mark.parametrize("kind", ["onRamp", "entry", "driving"])
def test_a_merge_leaves_a_lane_that_only_leads_there(hand: str, kind: str) -> None:
    way = ramp(hand, kind)
    t = times(20.0)
    (found,) = rows(tables(way, moving("ego", way, t, 50 + 15 * t, offsets(way, t, 4.0))), "FROM lane_change")
    assert found["merge"] is True
    away = moving("ego", way, t, 10 + 12 * t, offsets(way, t, 4.0, start=0.5, to=1.5))
    (found,) = rows(tables(way, away), "FROM lane_change")
    assert found["merge"] is False


@pytest.mark.parametrize("to", [0.5, 1.5])
def test_of_two_lanes_that_go_on_as_one_the_narrowing_one_merges(to: float) -> None:
    """The map links both to the same lane; only one of them narrows to nothing."""
    way = tapering()
    t = times(12.0)
    ego = moving("ego", way, t, 20 + 12 * t, offsets(way, t, 2.0, to=to, start=2.0 - to))
    (found,) = rows(tables(way, ego), "FROM lane_change")
    assert found["merge"] is (to < 1)


def test_each_ego_has_its_own_changes() -> None:
    way = marked("rht", lanes=2)
    t = times(14.0)
    a = moving("a", way, t, 100 + 12 * t, offsets(way, t, 6.0))
    b = moving("b", way, t, 60 + 12 * t, offsets(way, t, 4.0, start=0.5, to=1.5))
    found = rows(tables(way, a, b, egos=("a", "b")), "FROM lane_change ORDER BY ego_id")
    assert [(row["ego_id"], row["occurrence"], row["side"]) for row in found] == [("a", 0, "left"), ("b", 0, "right")]


@HANDS
@pytest.mark.parametrize(("reach", "expected"), [(0.15, "fail"), (1.2, "pass")])
def test_parked_cars_that_leave_room_do_not_close_the_lane(hand: str, reach: float, expected: str) -> None:
    """On the wrong side of the road for 400 m, past cars on the verge that reach so far into its lane."""
    way = road(((800.0, 0.0),), hand)
    t = times(36.0)
    s = 20 + 15 * t
    ego = moving("ego", way, t, s, way.own + (way.other - way.own) * ease((s - 80) / 40) * (1 - ease((s - 500) / 40)))
    edge = -way.over * (LANE + 0.9 - reach)
    cars = [standing(f"p{k}", way, t, 150 + 80 * k, edge) for k in range(5)]
    found = judged([drive([ego, *cars], way.environment)], rules=["ukhc.r143.direction"])
    assert ("fail" in {row["verdict"] for row in found}) is (expected == "fail")
