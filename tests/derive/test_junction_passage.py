"""The ego's ways through junctions: when, by which lanelets, which turn, and what governs the way in."""

from __future__ import annotations

from dataclasses import replace
from itertools import permutations
from typing import TYPE_CHECKING

import numpy as np
import pytest

from drivelint.arrays import replace_columns
from tests.cropping import beyond, cropped
from tests.derive.junction_scenes import ARM, TURN, R, cross, signal, star
from tests.scenes import Actor, Road, derived, drive, judged, moving, rows, times

if TYPE_CHECKING:
    from drivelint.road.map_reader import MapTables
    from tests.scenes import Row

LENGTH = {"right": TURN, "straight": 2 * R, "left": TURN}


def going(way: Road, *, v: float = 8.0, s0: float = 120.0, end: float = 18.0, name: str = "ego") -> Actor:
    """Drive in the way's own lane at v; its centre enters the junction at s = 185."""
    t = times(end)
    return moving(name, way, t, s0 + v * t, way.own)


def passages(*actors: Actor, way: Road, **options: object) -> list[Row]:
    con = derived(drive(actors, way.environment, **options), tables=["junction_passage"])  # type: ignore[arg-type]
    return rows(con, "FROM junction_passage ORDER BY ego_id, occurrence")


def turned(a: str, b: str) -> str:
    return {1: "right", 2: "straight", 3: "left"}[("wsen".index(b) - "wsen".index(a)) % 4]


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize("name", ["".join(p) for p in permutations("wsen", 2)])
def test_every_way_through_a_crossroads(hand: str, name: str) -> None:
    way = cross(hand)[name]
    (row,) = passages(going(way), way=way)
    turn = turned(*name)
    assert (row["turn"], row["branches"], row["junction_id"], row["occurrence"]) == (turn, 4, "9", 0)
    assert row["turn_rad"] == pytest.approx({"left": 1, "straight": 0, "right": -1}[turn] * np.pi / 2, abs=1e-3)
    assert row["across"] == (turn == ("right" if hand == "lht" else "left"))
    # the front bumper is 2.4 m ahead of the centre, the rear one as far behind; the log has a step every 0.8 m
    assert row["t_in_ns"] / 1e9 == pytest.approx((ARM - 2.4 - 120) / 8, abs=0.1)
    assert row["t_out_ns"] / 1e9 == pytest.approx((ARM + LENGTH[turn] + 2.4 - 120) / 8, abs=0.1)
    assert row["from_lanelet_id"].split(".")[0] == {"w": "1", "e": "2", "s": "3", "n": "4"}[name[0]]
    assert row["to_lanelet_id"].split(".")[0] == {"w": "1", "e": "2", "s": "3", "n": "4"}[name[1]]
    assert len(row["via_lanelet_id"].split(".")[0]) == 2
    # no signal of these kinds in the whole map: nobody can tell
    assert (row["control"], row["minor"]) == (None, None)


@pytest.mark.ci
@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize("deep", [1.5, 3.0])
def test_a_turn_that_cuts_the_corner_is_that_turn_however_deep(hand: str, deep: float) -> None:
    """From 16 m before the junction on it is so far beside its way; by 3 m its centre is in the opposing lane."""
    name = "wn" if hand == "rht" else "ws"
    way = cross(hand)[name]
    t = times(24.0)
    s = 110 + 6 * t
    on = np.clip((s - (ARM - 16)) / 12, 0, 1) * np.clip((ARM + TURN + 14 - s) / 12, 0, 1)
    ego = moving("ego", way, t, s, way.own + (-np.sign(way.own) * deep) * on)
    (row,) = passages(ego, way=way)
    (mild,) = passages(moving("ego", way, t, s, way.own), way=way)
    for column in ("turn", "across", "junction_id", "from_lanelet_id", "to_lanelet_id", "branches"):
        assert row[column] == mild[column]
    assert row["t_in_ns"] / 1e9 == pytest.approx((ARM - 2.4 - 110) / 6, abs=0.25)
    assert row["t_out_ns"] is not None
    corner = [row["verdict"] for row in judged([drive([ego], way.environment)], rules=["ukhc.r180.corner-cut"])]
    assert corner == ["fail"]


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize(
    ("arms", "way", "turn", "straightest"),
    [
        ((180, -50, 60), (1, 3), 60, -50),
        ((180, -50, 60), (1, 2), -50, -50),
        ((180, -50, 60), (2, 3), -70, 50),
        ((180, 0, -25), (1, 3), -25, 0),
        ((180, 80, -95), (1, 3), -95, 80),
        ((180, 10, -20), (1, 2), 10, 10),
    ],
)
def test_the_straightest_way_out(
    hand: str, arms: tuple[float, ...], way: tuple[int, int], turn: float, straightest: float
) -> None:
    road = star(hand, arms)[way]
    (row,) = passages(going(road), way=road)
    assert np.degrees(row["turn_rad"]) == pytest.approx(turn, abs=0.1)
    assert np.degrees(row["straightest_rad"]) == pytest.approx(straightest, abs=0.1)


def test_first_and_last_step_are_exact() -> None:
    way = cross()["we"]
    ego = going(way)
    con = derived(drive([ego], way.environment), tables=["junction_passage", "ego_state"])
    (row,) = rows(con, "FROM junction_passage")
    steps = rows(con, "FROM ego_state ORDER BY t_ns")
    front = {r["t_ns"]: r["x_m"] + 2.4 for r in steps}
    assert row["t_in_ns"] == min(t for t, x in front.items() if x >= -R)
    assert row["t_out_ns"] == min(t for t, x in front.items() if x - 4.8 >= R)
    assert row["t_first_ns"] == min(r["t_ns"] for r in steps if r["x_m"] >= -R)


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize("name", ["we", "ws", "wn"])
def test_the_turn_is_known_as_soon_as_its_centre_is_on_the_lane_after_it(hand: str, name: str) -> None:
    """The log ends with its rear still in the junction; 0.2 s before that it shows no turn yet."""
    way = cross(hand)[name]
    out = (ARM + LENGTH[turned(*name)] - 120) / 8
    (row,) = passages(going(way, end=round(out + 0.15, 1)), way=way)
    assert (row["t_out_ns"], row["turn"]) == (None, turned(*name))
    assert row["across"] == (turned(*name) == ("right" if hand == "lht" else "left"))
    (row,) = passages(going(way, end=round(out - 0.1, 1)), way=way)
    assert (row["turn"], row["across"]) == (None, None)


def standing_in_it(hand: str, name: str, *, end: float = 26.7, rolls: bool = False) -> str:
    """Return the verdict on an ego that stands 12 s in a junction without lights, 3 m behind a queue past it.

    `rolls`: the queue does, until the ego is in. The log ends with the ego's rear still inside.
    """
    way = cross(hand)[name]
    t = times(end)
    s = np.interp(t, [0, 10, 13, 22, 30], [120, 190, 196, 196, 228])
    ego = moving("ego", way, t, s, way.own)
    ahead = np.interp(t, [0, 11, 20, 30], [190 if rolls else 203.8, 203.8, 203.8, 260])
    queue = moving("q", way, t, ahead, way.own)
    found = judged([drive([ego, queue], way.environment)], rules=["ukhc.r151.side-roads-clear"])
    return str(found[0]["verdict"])


@pytest.mark.ci
@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize("rolls", [False, True])
def test_straight_on_into_a_junction_behind_a_queue(hand: str, rolls: bool) -> None:
    assert standing_in_it(hand, "we", rolls=rolls, end=27.2) == "fail"
    # turning across the oncoming traffic it may wait for that
    assert standing_in_it(hand, "wn" if hand == "rht" else "ws", rolls=rolls, end=27.2) == "unknown"
    # it stands there still as the log ends: it may be about to turn
    assert standing_in_it(hand, "we", rolls=rolls, end=21.0) == "unknown"


SIGNS = [("206", "stop", True), ("205", "give_way", True), ("1000001", "traffic_light", False), ("274", "none", False)]


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize(("code", "control", "minor"), SIGNS)
def test_what_governs_the_way_in(hand: str, code: str, control: str, minor: bool) -> None:
    signals = (("1", signal("a", 170.0, code)), ("3", signal("far", 100.0, "205", orientation="-")))
    way = cross(hand, signals)["we"]
    (row,) = passages(going(way), way=way)
    assert (row["control"], row["minor"]) == (control, minor)


@pytest.mark.ci
@pytest.mark.parametrize(("of", "control"), [("1", "traffic_light"), ("3", None)])
def test_a_map_without_signs_tells_only_of_lights(of: str, control: str | None) -> None:
    """A light on the way in governs it; where it stands on another way in, a sign may stand on this one."""
    way = cross("rht", ((of, signal("a", 170.0, "1000001")),))["we"]
    (row,) = passages(going(way), way=replace(way, environment=without_signs(way.environment)))
    assert row["control"] == control


def without_signs(environment: MapTables) -> MapTables:
    about = replace_columns(environment.tables["environment"], {"signs_mapped": [False]})
    return replace(environment, tables={**environment.tables, "environment": about})


@pytest.mark.parametrize(("s", "orientation", "control"), [(136, "+", "stop"), (134, "+", "none"), (170, "-", "none")])
def test_only_what_holds_for_the_last_fifty_metres(s: float, orientation: str, control: str) -> None:
    way = cross("rht", (("1", signal("a", s, "206", orientation=orientation)),))["we"]
    (row,) = passages(going(way), way=way)
    assert row["control"] == control


@pytest.mark.ci
@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize(
    ("code", "begins", "control"),
    [("206", 165, "stop"), ("206", 175, None), ("274", 134, "none"), ("274", 136, None), ("206", 134, "stop")],
)
def test_where_the_map_begins_shortly_before_the_junction(
    hand: str, code: str, begins: float, control: str | None
) -> None:
    """What stood at 170 m is in the map or was cut off with what lies before; 50 m before the junction is far enough."""
    signals = (("1", signal("a", 170.0, code)), ("3", signal("far", 100.0, "205", orientation="-")))
    way = cross(hand, signals)["we"]
    x, y, heading = (float(v) for v in way.at(begins))
    short = replace(way, environment=cropped(way.environment, "short", beyond(x, y, heading, -1e-9)))
    (row,) = passages(going(way, s0=max(begins, 120.0) + 1), way=short)
    assert row["control"] == control


def test_a_signal_on_the_connecting_lane_holds_for_who_takes_it() -> None:
    ways = cross("rht", (("12", signal("turn", 3.0, "1000001")), ("1", signal("gw", 180.0, "205"))))
    (left,) = passages(going(ways["wn"]), way=ways["wn"])
    (right,) = passages(going(ways["ws"]), way=ways["ws"])
    assert (left["control"], right["control"]) == ("traffic_light", "give_way")


def test_each_ego_by_its_own_way() -> None:
    ways = cross()
    other = going(ways["ns"], name="other", s0=90.0)
    found = passages(going(ways["wn"]), other, way=ways["we"], egos=("ego", "other"))
    assert [(r["ego_id"], r["turn"]) for r in found] == [("ego", "left"), ("other", "straight")]


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize("length", [6.0, 14.0])
def test_it_is_out_when_its_trailer_is(hand: str, length: float) -> None:
    way = cross(hand)["we"]
    ego = going(way)
    behind = 2.4 + 0.5 + length / 2
    trailer = moving("t", way, ego.t_s, 120 - behind + 8 * ego.t_s, way.own, length=length, kind="trailer")
    (row,) = passages(ego, trailer, way=way)
    assert row["t_out_ns"] / 1e9 == pytest.approx((ARM + 2 * R + behind + length / 2 - 120) / 8, abs=0.11)
