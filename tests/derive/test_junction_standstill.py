"""The ego stands: how long, and where."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest

from tests.derive.junction_scenes import ARM, R, cross, crosswalk, lit, signal, stop_line
from tests.scenes import Actor, Road, derived, drive, moving, rows, seconds, standing, times

if TYPE_CHECKING:
    from drivelint.engine.batch import Drive
    from tests.scenes import Row


def halting(
    way: Road, at: float, *, since: float = 5.0, until: float = 10.0, end: float = 20.0, name: str = "ego"
) -> Actor:
    """Come at 8 m/s, stand with the front at s = `at`, go on at 8 m/s; at the turns the mean of 0 and 8 is in the log."""
    t = times(end)
    s = at - 2.4 - 8 * np.clip(since - t, 0, None) + 8 * np.clip(t - until, 0, None)
    return moving(name, way, t, s, way.own)


def stands(told: Drive) -> list[Row]:
    con = derived(told, tables=["standstill"])
    return rows(con, "FROM standstill ORDER BY drive_id, ego_id, occurrence")


def only(told: Drive) -> Row:
    (row,) = stands(told)
    return row


def test_a_stop_on_the_open_road() -> None:
    way = cross()["we"]
    row = only(drive([halting(way, 100.0)], way.environment))
    assert seconds([row], "t_start_ns") == [pytest.approx(5.1)]
    assert seconds([row], "t_end_ns") == [pytest.approx(9.9)]
    assert (row["begin_seen"], row["end_seen"], row["occurrence"]) == (True, True, 0)
    assert (row["road_type"], row["lanelet_id"]) == ("rural", "1.0.-1")
    assert row["junction_m"] == pytest.approx(ARM - 100)
    for column in ("junction_id", "turn", "across", "crossing_id", "stop_line_id", "control", "state", "ahead_id"):
        assert row[column] is None, column
    assert row["ahead_known"] is True


@pytest.mark.ci
@pytest.mark.parametrize("hand", ["rht", "lht"])
def test_how_far_it_has_to_go_to_be_out(hand: str) -> None:
    """The junction ends at 215 m, the crossing at 103 m; the rear is 4.8 m behind the front."""
    way = cross(hand, (), (("1", crosswalk("walk", 100.0)),))["we"]
    inside, on, before = (only(drive([halting(way, at)], way.environment)) for at in (202.0, 104.0, 98.0))
    assert (inside["junction_clear_m"], inside["crossing_clear_m"]) == (pytest.approx(215 - 197.2), None)
    assert (on["junction_clear_m"], on["crossing_clear_m"]) == (None, pytest.approx(103 - 99.2))
    assert (before["junction_clear_m"], before["crossing_clear_m"]) == (None, None)


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize(
    ("at", "length", "inside"),
    [(186.5, 4.8, 1.5), (202.0, 4.8, 4.8), (217.0, 4.8, 2.8), (225.0, 18.0, 8.0), (220.0, 40.0, 30.0)],
)
def test_how_much_of_it_is_in_the_junction(hand: str, at: float, length: float, inside: float) -> None:
    """The junction is from 185 to 215 m."""
    way = cross(hand)["we"]
    ego = replace(halting(way, at), length=length)
    back = length / 2 - 2.4  # `halting` takes a car's front
    row = only(drive([replace(ego, x=ego.x - back)], way.environment))
    assert (row["junction_id"], row["junction_inside_m"]) == ("9", pytest.approx(inside, abs=0.01))


@pytest.mark.ci
def test_an_unknown_speed_does_not_hide_it() -> None:
    """One step in two has no speed: its way stands in. Without a position either, nobody knows."""
    way = cross()["we"]
    ego = halting(way, 100.0)
    whole = only(drive([ego], way.environment))
    some = np.arange(len(ego.t_s)) % 2 == 0
    blind = Actor(**{**ego.__dict__, "vx": np.where(some, np.nan, ego.vx)})
    row = only(drive([blind], way.environment))
    assert abs(row["t_start_ns"] - whole["t_start_ns"]) <= 1e8
    assert abs(row["t_end_ns"] - whole["t_end_ns"]) <= 1e8
    hidden = (ego.t_s > 7) & (ego.t_s < 7.3)
    lost = Actor(**{**ego.lost(hidden).__dict__, "vx": np.where(hidden, np.nan, ego.vx)})
    one, two = stands(drive([lost], way.environment))
    assert (one["end_seen"], two["begin_seen"]) == (False, False)


@pytest.mark.parametrize(
    ("at", "inside", "ahead"), [(ARM + 10, True, math.inf), (ARM + 0.1, True, math.inf), (ARM - 0.1, False, 0.1),
        (ARM + 2 * R + 4.7, True, math.inf), (ARM + 2 * R + 5, False, math.inf)]
)  # fmt: skip
def test_in_a_junction_by_either_bumper(at: float, inside: bool, ahead: float) -> None:
    way = cross()["we"]
    row = only(drive([halting(way, at, since=8.0, until=12.0, end=24.0)], way.environment))
    assert row["junction_id"] == ("9" if inside else None)
    assert row["turn"] == ("straight" if inside else None)
    assert row["across"] == (False if inside else None)
    assert row["junction_m"] == pytest.approx(ahead, abs=1e-6)


@pytest.mark.parametrize("hand", ["rht", "lht"])
def test_the_turn_in_which_it_stands(hand: str) -> None:
    way = cross(hand)["wn"]
    row = only(drive([halting(way, ARM + 10, since=8.0, until=12.0, end=24.0)], way.environment))
    assert (row["turn"], row["across"]) == ("left", hand == "rht")
    row = only(drive([halting(way, ARM + 10, since=8.0, until=20.0, end=18.0)], way.environment))
    assert (row["junction_id"], row["turn"], row["end_seen"]) == ("9", None, False)


@pytest.mark.parametrize(("at", "on"), [(99.9, False), (100.1, True), (107.7, True), (107.9, False)])
def test_on_a_crossing(at: float, on: bool) -> None:
    way = cross("rht", (), (("1", crosswalk("x", 100.0)),))["we"]
    row = only(drive([halting(way, at)], way.environment))
    assert row["crossing_id"] == ("x" if on else None)


@pytest.mark.parametrize(("at", "ahead"), [(159, None), (161, 19.0), (179.5, 0.5), (182.5, -2.5), (183.5, None)])
def test_at_a_stop_line(at: float, ahead: float | None) -> None:
    signals = (("1", stop_line("line", 180.0, -1.75)), ("1", signal("light", 179.0, "1000001")))
    way = cross("rht", signals)["we"]
    told = lit(
        drive([halting(way, at, since=8.0, until=12.0)], way.environment),
        "light",
        (0.0, "green"),
        (7.0, "red"),
        (10.0, "green"),
    )
    row = only(told)
    if ahead is None:
        assert (row["stop_line_id"], row["stop_line_m"], row["control"], row["state"]) == (None, None, None, None)
    else:
        assert (row["stop_line_id"], row["control"], row["state"]) == ("line", "traffic_light", "red")
        assert row["stop_line_m"] == pytest.approx(ahead, abs=1e-6)


def test_behind_somebody() -> None:
    way = cross()["we"]
    t = times(20)
    queue = standing("q", way, t, 106.4, way.own)
    row = only(drive([halting(way, 100.0), queue], way.environment))
    assert (row["ahead_id"], row["ahead_gap_m"], row["ahead_speed_mps"]) == ("q", pytest.approx(4.0), pytest.approx(0))
    assert row["ahead_known"] is True
    row = only(drive([halting(way, 100.0), queue.lost(t > 3)], way.environment))
    assert (row["ahead_id"], row["ahead_known"]) == (None, False)


def test_without_a_map() -> None:
    way = cross()["we"]
    row = only(drive([halting(way, 100.0)], None))
    assert (row["junction_id"], row["junction_m"], row["lanelet_id"]) == (None, None, None)
    assert row["ahead_known"], "nobody is ahead on its own way"


def test_each_ego_and_drive_for_itself() -> None:
    way = cross()["we"]
    one = drive(
        [halting(way, 100.0), halting(way, 60.0, name="other", until=12.0)], way.environment, egos=("ego", "other")
    )
    two = drive([halting(way, 120.0)], way.environment, drive_id="e")
    con = derived(one, two, tables=["standstill"])
    found = rows(con, "SELECT drive_id, ego_id, junction_m FROM standstill ORDER BY ALL")
    assert [(r["drive_id"], r["ego_id"], round(r["junction_m"])) for r in found] == [
        ("d", "ego", 85),
        ("d", "other", 125),
        ("e", "ego", 65),
    ]
