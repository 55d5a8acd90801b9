"""Others that come from beside into the ego's lane."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tests.derive.marked import ease, marked, offsets, tables, tapering
from tests.scenes import LANE, Actor, Road, drive, judged, moving, rows, times

ROW = dict[str, Any]


def cuts(way: Road, *actors: Actor, egos: tuple[str, ...] = ("ego",)) -> list[ROW]:
    return rows(tables(way, *actors, egos=egos, of=("cut_in",)), "FROM cut_in ORDER BY ego_id, occurrence")


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize("of", ["in", "out"])
def test_one_cuts_in_from_either_side(hand: str, of: str) -> None:
    way = marked(hand, lanes=2)
    t = times(14.0)
    mine, its = (1.5, 0.5) if of == "in" else (0.5, 1.5)
    ego = moving("ego", way, t, 100 + 12 * t, offsets(way, t, 99.0, start=mine))
    other = moving("x", way, t, 95 + 13 * t, offsets(way, t, 7.0, start=its, to=mine))
    (found,) = cuts(way, ego, other)
    left = (hand == "rht") == (of == "in")
    assert (found["object_id"], found["side"], found["begin_seen"]) == ("x", "left" if left else "right", True)
    lane = abs(mine) * LANE * np.sign(way.own)
    inside = LANE / 2 + 0.9 * np.cos(other.yaw) + 2.4 * np.abs(np.sin(other.yaw)) - np.abs(other.y - lane)
    k = int(np.argmax(inside > 0.3))
    assert found["t_ns"] == round(t[k] * 1e9)
    assert found["in_place_ns"] == round(t[np.abs(other.y - lane) < LANE / 2][0] * 1e9)
    assert found["gap_m"] == pytest.approx(-5 + t[k] - 4.8, abs=0.2)
    assert found["ego_speed_mps"] == pytest.approx(12.0)
    assert found["speed_mps"] == pytest.approx(13.0, abs=0.2)


@pytest.mark.ci
def test_what_is_no_cut_in() -> None:
    """Out of the lane; behind the ego; far ahead; a wobble of 0.25 m; the ego's own change; one that turns in across."""
    way = marked("rht", lanes=2)
    t = times(14.0)
    stay = offsets(way, t, 99.0)
    ego = moving("ego", way, t, 100 + 12 * t, stay)
    leaves = moving("leaves", way, t, 140 + 12 * t, offsets(way, t, 4.0))
    behind = moving("behind", way, t, 60 + 12 * t, offsets(way, t, 4.0, start=0.5, to=1.5))
    far = moving("far", way, t, 270 + 12 * t, offsets(way, t, 4.0, start=0.5, to=1.5))
    wobbles = moving("wobbles", way, t, 120 + 12 * t, -0.5 * LANE - 0.9 * ease((t - 4) / 4))
    across = moving("across", way, t[40:80], 200 + 1.0 * t[40:80], -12 + 2 * (t[40:80] - 4))
    assert not cuts(way, ego, leaves, behind, far, wobbles)
    # whose track begins and ends on the road: before and after it somebody may have come in
    assert {row["object_id"] for row in cuts(way, ego, across)} == {None}
    changes = moving("ego", way, t, 100 + 12 * t, offsets(way, t, 4.0))
    assert not cuts(way, changes, moving("x", way, t, 130 + 12 * t, offsets(way, t, 99.0, start=0.5)))


def test_where_lanes_merge_nobody_cuts_in() -> None:
    """The one ahead drives straight on; it is the ego's lane that becomes its lane."""
    way = tapering()
    t = times(12.0)
    ego = moving("ego", way, t, 150 + 10 * t, offsets(way, t, 99.0))
    other = moving("x", way, t, 220 + 12 * t, offsets(way, t, 99.0, start=0.5))
    con = tables(way, ego, other, of=("cut_in",))
    assert not rows(con, "FROM cut_in")
    # it does become the one ahead in the lane
    placed = rows(con, "SELECT DISTINCT abs(d_m) < 0.1 AS inside FROM pair ORDER BY ALL")
    assert [row["inside"] for row in placed] == [False, True]


@pytest.mark.ci
def test_where_it_was_not_seen_to_come() -> None:
    way = marked("rht", lanes=2)
    t = times(14.0)
    ego = moving("ego", way, t, 100 + 12 * t, offsets(way, t, 99.0))
    other = moving("x", way, t, 130 + 12 * t, offsets(way, t, 5.0, start=0.5, to=1.5))
    (whole,) = cuts(way, ego, other)
    at = whole["t_ns"] / 1e9
    (found,) = cuts(way, ego, other.lost((t > at - 0.55) & (t < at + 0.55)))
    assert (found["begin_seen"], found["t_ns"]) == (False, round((at + 0.6) * 1e9))
    keep = (t < at - 0.55) | (t > at + 0.55)
    (found,) = cuts(way, ego.keep(keep), other.keep(keep))
    assert (found["begin_seen"], found["t_ns"]) == (False, round((at + 0.6) * 1e9))
    # where it came from is not in the log; it had 7 s: nobody cuts in for so long, and it may have come at any time
    for unseen in (other.keep(t > at + 0.3), other.lost((t > at - 4) & (t < at + 3))):
        assert [row["object_id"] for row in cuts(way, ego, unseen)] == [None]


def test_each_ego_has_its_own_cut_ins() -> None:
    way = marked("rht", lanes=2)
    t = times(14.0)
    slow = moving("a", way, t, 100 + 12 * t, offsets(way, t, 99.0))
    fast = moving("b", way, t, 60 + 12 * t, offsets(way, t, 99.0, start=0.5))
    other = moving("x", way, t, 130 + 12 * t, offsets(way, t, 5.0, start=0.5, to=1.5))
    found = cuts(way, slow, fast, other, egos=("a", "b"))
    assert [(row["ego_id"], row["object_id"]) for row in found] == [("a", "x")]


@pytest.mark.ci
def test_where_it_cannot_be_told_who_is_ahead_somebody_may_have_come_in() -> None:
    way = marked("rht", lanes=2)
    t = times(14.0)
    ego = moving("ego", way, t, 100 + 12 * t, offsets(way, t, 99.0))
    other = moving("x", way, t, 130 + 12 * t, offsets(way, t, 5.0, start=0.5, to=1.5))
    # it was seen 0.85 m beside the lane: for 0.3 s after that it cannot be in
    for lost, at in ((t < 99, 0.0), (t > 3.95, 4.3), ((t > 1.95) & (t < 4.05), 2.3)):
        found = cuts(way, ego, other.lost(lost))
        assert (found[0]["object_id"], found[0]["t_ns"] / 1e9, found[0]["begin_seen"]) == (None, at, False)
        assert (found[0]["gap_m"], found[0]["side"], found[0]["in_place_ns"]) == (None, None, None)
        assert [row["object_id"] for row in found[1:]] == ["x"] * (at == 2.3)
    (only,) = cuts(way, ego, other.lost((t > 1.95) & (t < 2.95)))
    assert only["object_id"] == "x"
    assert [row["object_id"] for row in cuts(way, ego.lost((t > 8) & (t < 10)), other)] == ["x", None]


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize(
    ("what", "reach", "to", "cut"),
    [
        ("reaches over the line as it overtakes, then moves in", 0.4, 1.5, True),
        ("reaches over by less than counts, then moves in", 0.2, 1.5, True),
        ("overtakes in the lane itself", 1.2, 1.2, True),
        ("reaches over the line and stays so", 0.4, None, False),
    ],
)
def test_who_overtakes_over_the_line_cuts_in(hand: str, what: str, reach: float, to: float | None, cut: bool) -> None:
    """The ego keeps to the far edge of its lane; the other is ahead from 6 s on and moves in at 8 s."""
    way = marked(hand, lanes=2)
    t = times(20.0)
    side = np.sign(way.own)
    ego = moving("ego", way, t, 100 + 15 * t, side * (2 * LANE - 0.95))
    s = 70 + np.where(t < 9, 20 * t, 180 + 15 * (t - 9))
    narrow = to is not None and to < 1.5  # a motorcycle within the lane
    begin = LANE + reach - (0.4 if narrow else 0.9)
    d = begin if to is None or narrow else begin + (1.5 * LANE - begin) * ease((t - 8) / 2)
    size = {"kind": "motorcycle", "length": 2.2, "width": 0.8} if narrow else {}
    found = cuts(way, ego, moving("x", way, t, s, side * d, **size))
    assert [row["object_id"] for row in found] == ["x"] * cut
    if cut:
        assert (found[0]["side"], found[0]["begin_seen"]) == ("left" if hand == "rht" else "right", True)
        assert 6.0 < found[0]["t_ns"] / 1e9 < 9.0
        assert found[0]["in_place_ns"] >= found[0]["t_ns"]


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize(("v", "verdict"), [(15.0, "fail"), (12.0, "pass")])
def test_dropping_back_from_one_that_reached_over(hand: str, v: float, verdict: str) -> None:
    """It moves in at 8 s, some 10 m ahead; the ego keeps its speed, or lets the gap grow."""
    way = marked(hand, lanes=2)
    t = times(24.0)
    side = np.sign(way.own)
    slow = np.where(t < 9, 15 * t, 135 + v * (t - 9))
    ego = moving("ego", way, t, 100 + slow, side * (2 * LANE - 0.95))
    s = 70 + np.where(t < 9, 20 * t, 180 + 15 * (t - 9))
    d = LANE - 0.5 + (0.5 * LANE + 0.5) * ease((t - 8) / 2)
    scene = drive([ego, moving("x", way, t, s, side * d)], way.environment)
    found = [row for row in judged([scene], rules=["ukhc.r168.drop-back"]) if row["object_id"] == "x"]
    assert [row["verdict"] for row in found] == [verdict]


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize(("stays", "verdict"), [(False, "fail"), (True, "pass")])
def test_one_between_for_a_moment_restores_no_gap(hand: str, stays: bool, verdict: str) -> None:
    """The cutter stays 14 m ahead; a motorcycle comes between the two, and goes out again on the other side, or stays."""
    way = marked(hand, lanes=2)
    t = times(30.0)
    ego = moving("ego", way, t, 60 + 18 * t, offsets(way, t, 99.0))
    x = moving("x", way, t, 60 + 18.8 + 18 * t, offsets(way, t, 4.0, 3.0, start=0.5, to=1.5))
    goes = 0.0 if stays else 1.2 * ease((t - 11) / 1.5)
    d = offsets(way, t, 9.0, 2.0, start=0.5, to=1.5) + np.sign(way.own) * LANE * goes
    m = moving("m", way, t, 60 + 9.0 + 18 * t, d, kind="motorcycle", length=2.2, width=0.8)
    found = judged([drive([ego, x, m], way.environment)], rules=["ukhc.r168.drop-back"])
    assert [row["verdict"] for row in found if row["object_id"] == "x"] == [verdict]
