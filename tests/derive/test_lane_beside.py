"""What lies beyond a lane's boundary where the map names no neighbour, and beside the lanes: roads of one direction, hard shoulders."""

from __future__ import annotations

import math
from typing import Any

import pytest

from tests.derive.jointed_road import jointed
from tests.derive.marked import apart
from tests.scenes import (
    LANE,
    Road,
    derived,
    drive,
    moving,
    road,
    rows,
    standing,
    swing,
    times,
    verdict_rows,
)

HANDS = pytest.mark.parametrize("hand", ["rht", "lht"])


def beside(way: Road) -> list[dict[str, Any]]:
    con = derived(
        drive([moving("ego", way, times(1.0), 10 * times(1.0), way.ego_d)], way.environment), tables=["lane_beside"]
    )
    return rows(con, "FROM lane_beside ORDER BY lanelet_id, side, s_start_m")


@HANDS
@pytest.mark.parametrize("gap", [0.0, 0.3, 1.2, 1.9])
def test_the_road_that_comes_the_other_way(hand: str, gap: float) -> None:
    way = apart(hand, gap)
    found = beside(way)
    inner = "left" if hand == "rht" else "right"
    assert {(r["lanelet_id"][0], r["side"], r["beside_id"][0], r["against"], r["drivable"]) for r in found} == {
        ("1", inner, "2", True, True),
        ("2", inner, "1", True, True),
    }
    assert {(round(r["gap_m"], 2), round(r["width_m"], 2)) for r in found} == {(gap, LANE)}
    mine = [(r["s_start_m"], r["s_end_m"]) for r in found if r["lanelet_id"][0] == "1"]
    assert mine[0][0] == 0
    assert mine[-1][1] == pytest.approx(600)
    assert [a for a, _ in mine[1:]] == pytest.approx([b for _, b in mine[:-1]])


@pytest.mark.ci
@HANDS
def test_an_overtake_on_such_a_map_is_one_in_an_opposing_lane(hand: str) -> None:
    """The same verdicts as on a map that names the opposing lane."""
    verdicts = []
    for way in (road(hand=hand), apart(hand, centre="broken")):
        t = times(25.0)
        s = 50 + 12 * t
        ego = moving("ego", way, t, s, swing(way, s, 100, 220))
        vbp = standing("vbp", way, t, 160, way.ego_d)
        ov = moving("ov", way, t, 560 - 8 * t, way.oncoming_d)
        con = derived(drive([ego, vbp, ov], way.environment), tables=["overtake", "registration"])
        (found,) = rows(con, "FROM overtake")
        assert (found["opposing"], found["status"], found["ov_id"]) == (True, "completed", "ov")
        (fits,) = rows(con, "FROM registration")
        assert fits["ok"]
        of = verdict_rows(
            [drive([ego, vbp, ov], way.environment)], rules=["ukhc.r162.safe-distance-ahead", "ukhc.overtake-zone"]
        )
        verdicts.append([(r["rule_id"], r["verdict"], r["observed"]) for r in of])
    for one, other in zip(*verdicts, strict=True):
        assert one[:2] == other[:2]
        assert one[2] == pytest.approx(other[2], abs=0.1)


@pytest.mark.ci
@HANDS
def test_where_only_the_two_directions_go_on_there_is_no_junction(hand: str) -> None:
    way = jointed(hand)
    t = times(33.0)
    s = 5 + 12 * t
    ego, vbp = moving("ego", way, t, s, swing(way, s, 100, 195)), standing("vbp", way, t, 150, way.ego_d)
    con = derived(drive([ego, vbp], way.environment), tables=["junction_passage", "overtake_place", "_road_half"])
    halves = {(r["road_id"], r["of_road_id"], r["turned"]) for r in rows(con, "FROM _road_half")}
    assert halves == {("5", "1", True), ("4", "2", True)}
    (passage,) = rows(con, "FROM junction_passage")
    assert passage["branches"] == 2
    (place,) = rows(con, "FROM overtake_place")
    assert math.isinf(place["junction_m"])
