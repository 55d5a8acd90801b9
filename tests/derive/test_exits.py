"""Lanes that leave the main carriageway, and whether the ego takes them."""

from __future__ import annotations

import pytest

from drivelint.formats import load_map
from drivelint.reasons.reason_text import sentence
from drivelint.road.map_reader import MapSource
from tests import scenes
from tests.derive.exit_scenes import MAIN, exit_road, leaver
from tests.scenes import Actor, Road, derived, drive, moving, rows, standing, times
from tests.shared_data import shared


def stayer(way: Road) -> Actor:
    """Drive at 20 m/s in the through lane."""
    t = times(25.0)
    straight = Road(way.environment, ((MAIN + 250, 0.0),))
    return moving("ego", straight, t, 20 + 20 * t, straight.own)


@pytest.mark.parametrize(("hand", "side", "lane"), [("rht", "right", -2), ("lht", "left", 2)])
def test_the_lane_that_forks_off_is_the_exit_lane(hand: str, side: str, lane: int) -> None:
    way = exit_road(hand)
    con = derived(drive([stayer(way)], way.environment), tables=["_exit_lane"])
    found = rows(con, "SELECT lanelet_id, from_id, side FROM _exit_lane")
    assert [tuple(row.values()) for row in found] == [(f"1.0.{lane}", f"1.0.{lane // 2}", side)]


@pytest.mark.parametrize(("hand", "side"), [("rht", "right"), ("lht", "left")])
def test_an_exit_taken(hand: str, side: str) -> None:
    """The last sign before the crossing stands at 220 m; the front bumper comes by it 2.4 m before the centre."""
    way = exit_road(hand)
    ego = leaver(way)
    con = derived(drive([ego], way.environment), tables=["exit_taken", "exit_passed", "lane_departure", "ego_state"])
    (found,) = rows(con, "FROM exit_taken")
    (crossing,) = rows(con, "FROM lane_departure")
    assert (found["side"], found["sign_id"]) == (side, "exit1")
    assert found["lanelet_id"] == ("1.0.-2" if hand == "rht" else "1.0.2")
    assert found["t_ns"] == crossing["t_ns"]
    fronts = rows(con, "FROM ego_state ORDER BY t_ns")
    assert found["t_sign_ns"] == min(row["t_ns"] for row in fronts if row["front_s_m"] >= 220 - 1e-9)
    assert found["t_sign_ns"] / 1e9 == pytest.approx((220 - 2.4 - 20) / 20, abs=0.1)
    (passed,) = rows(con, "FROM exit_passed")
    assert (passed["taken"], passed["side"]) == (True, side)
    assert passed["t_gore_ns"] / 1e9 == pytest.approx((MAIN - 20) / 20, abs=0.15)


def test_an_exit_not_taken() -> None:
    way = exit_road()
    con = derived(drive([stayer(way)], way.environment), tables=["exit_taken", "exit_passed"])
    assert not rows(con, "FROM exit_taken")
    (found,) = rows(con, "FROM exit_passed")
    assert (found["taken"], found["t_near_ns"]) == (False, 0)
    assert found["t_gore_ns"] / 1e9 == pytest.approx((MAIN - 20) / 20, abs=0.11)


def test_a_road_without_signs() -> None:
    way = exit_road(signs=())
    con = derived(drive([leaver(way)], way.environment), tables=["exit_taken", "capability"])
    (found,) = rows(con, "FROM exit_taken")
    assert (found["sign_id"], found["t_sign_ns"]) == (None, None)
    (signs,) = rows(con, "FROM capability WHERE signal = 'exit_signs'")
    assert (signs["available"], sentence(signs["reason"])) == (False, "the map has exits, but no exit signs")


def test_who_is_in_the_exit_lane_already_crosses_nothing() -> None:
    way = exit_road()
    con = derived(
        drive([leaver(way, change_at=-100.0)], way.environment), tables=["exit_taken", "exit_passed", "excursion"]
    )
    assert not rows(con, "FROM exit_taken")
    assert not rows(con, "FROM excursion")
    (found,) = rows(con, "FROM exit_passed")
    assert found["taken"] is True


@pytest.mark.parametrize(("lit", "verdict"), [((7.0, 12.0), "pass"), ((12.2, 14.0), "fail"), (None, "unknown")])
def test_the_rule_of_the_last_exit_sign(lit: tuple[float, float] | None, verdict: str) -> None:
    """The sign is passed at 9.9 s."""
    way = exit_road()
    ego = leaver(way)
    if lit:
        lights = tuple("right" if lit[0] <= t <= lit[1] else "off" for t in ego.t_s)
        ego = Actor(**{**ego.__dict__, "indicator": lights})
    found = scenes.judged([drive([ego], way.environment)], rules=["ukhc.exit-sign-signal"])
    assert [row["verdict"] for row in found] == [verdict]


@pytest.mark.ci
def test_the_exit_of_a_reference_map() -> None:
    """Lane -3 begins at 100 m and leaves at 300 m; the two through lanes and the opposite side are no exits."""
    source = shared("maps/ut_highway_exit.xodr")
    environment = load_map(MapSource(source.name, source.read_bytes()))
    point = environment.tables["lane_point"].slice(0, 1).to_pylist()[0]
    way = Road(environment, ((10.0, 0.0),), (point["x_m"], point["y_m"], 0.0))
    con = derived(drive([standing("ego", way, times(0.2), 1.0, 0.0)], environment), tables=["_exit_lane"])
    found = rows(con, "SELECT lanelet_id, from_id, side FROM _exit_lane ORDER BY ALL")
    assert [tuple(row.values()) for row in found] == [("0.1.-3", "0.1.-2", "right"), ("0.2.-3", "0.2.-2", "right")]
