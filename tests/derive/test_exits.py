"""Lanes that leave the main carriageway, and whether the ego takes them."""

from __future__ import annotations

import pytest

from drivelint.formats import load_map
from drivelint.road.map_reader import MapSource
from tests.derive.exit_scenes import MAIN, exit_road
from tests.scenes import Actor, Road, derived, drive, moving, rows, standing, times
from tests.shared_data import shared


def stayer(way: Road) -> Actor:
    """Drive at 20 m/s in the through lane."""
    t = times(25.0)
    straight = Road(way.environment, ((MAIN + 250, 0.0),))
    return moving("ego", straight, t, 20 + 20 * t, straight.ego_d)


@pytest.mark.parametrize(("hand", "side", "lane"), [("rht", "right", -2), ("lht", "left", 2)])
def test_the_lane_that_forks_off_is_the_exit_lane(hand: str, side: str, lane: int) -> None:
    way = exit_road(hand)
    con = derived(drive([stayer(way)], way.environment), tables=["_exit_lane"])
    found = rows(con, "SELECT lanelet_id, from_id, side FROM _exit_lane")
    assert [tuple(row.values()) for row in found] == [(f"1.0.{lane}", f"1.0.{lane // 2}", side)]


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
