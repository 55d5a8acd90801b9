"""What lies beyond a lane's boundary where the map names no neighbour, and beside the lanes: roads of one direction, hard shoulders."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from drivelint.formats import load_map
from drivelint.road.map_reader import MapSource
from tests.derive.jointed_road import jointed
from tests.derive.marked import apart, ease, mark, marked, shouldered
from tests.formats.opendrive import xodr
from tests.scenes import (
    LANE,
    Road,
    derived,
    drive,
    judged,
    limited,
    moving,
    plan,
    road,
    rows,
    saying,
    standing,
    swing,
    times,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tests.scenes import Actor

HANDS = pytest.mark.parametrize("hand", ["rht", "lht"])
SOLID = "ukhc.r129.no-cross-solid"


def beside(way: Road) -> list[dict[str, Any]]:
    con = derived(
        drive([moving("ego", way, times(1.0), 10 * times(1.0), way.own)], way.environment), tables=["lane_beside"]
    )
    return rows(con, "FROM lane_beside ORDER BY lanelet_id, side, s_start_m")


def wobble(way: Road, by: float = 1.2, start: float = 100.0) -> Actor:
    """Return an ego that goes `by` metres towards the middle of the road and back, at 10 m/s."""
    t = times(10.0)
    d = way.own - np.sign(way.own) * by * ease((t - 3) / 1.5) * (1 - ease((t - 6) / 1.5))
    return moving("ego", way, t, start + 10 * t, d)


def said(way: Road, *actors: Actor, rules: Sequence[str] = (SOLID,)) -> set[str]:
    return {row["verdict"] for row in judged([drive(actors, way.environment)], rules=rules)}


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


def test_as_the_map_names_it() -> None:
    found = beside(road())
    assert {
        (r["lanelet_id"], r["side"], r["beside_id"], r["against"], r["s_start_m"], r["s_end_m"]) for r in found
    } == {
        ("1.0.-1", "left", "1.0.1", True, 0.0, 600.0),
        ("1.0.1", "left", "1.0.-1", True, 0.0, 600.0),
    }
    shoulders = beside(marked("rht", beyond="shoulder"))
    assert {(r["side"], r["lane_type"], r["drivable"]) for r in shoulders} == {
        ("left", "driving", True),
        ("right", "shoulder", False),
    }


def test_not_further_away_nor_where_there_is_none() -> None:
    assert not beside(apart("rht", 2.4))
    found = [r for r in beside(apart("rht", since=200.0)) if r["lanelet_id"][0] == "1"]
    assert min(r["s_start_m"] for r in found) == pytest.approx(200.0)


def divided(hand: str, kind: str, width: float, road_type: str = "rural", centre: str = "solid") -> Road:
    """Return a two-way road with a strip between its directions, drawn as a lane of its own, a line on either side of it."""
    inside = '<link><predecessor id="{0}"/><successor id="{0}"/></link><width sOffset="0" a="{1}"/>' + mark(centre)
    side = 1 if hand == "lht" else -1
    # the ego's lane lies at its usual place: the strip is on the other side of the reference line
    lanes = {side: ("driving", LANE), -side: (kind, width), -2 * side: ("driving", LANE)}
    parts = [xodr.lane(n, inside.format(n, w), what) for n, (what, w) in sorted(lanes.items(), reverse=True)]
    text = xodr.xodr(
        xodr.road(
            geometry=plan(((600.0, 0.0),)),
            lanes=xodr.section(0, *parts, centre=mark(centre)),
            length=600.0,
            attributes=f'rule="{hand.upper()}"',
            more=limited(60).replace("rural", road_type),
        )
    )
    name = f"divided-{hand}-{kind}-{width}-{road_type}-{centre}.xodr"
    return Road(load_map(MapSource(name, text.encode())), ((600.0, 0.0),))


@pytest.mark.sample(0, ci=2)
@HANDS
@pytest.mark.parametrize(
    ("kind", "width", "expected"),
    [
        ("restricted", 0.5, "fail"),
        ("border", 1.0, "fail"),
        ("restricted", 1.5, "unknown"),
        ("restricted", 2.5, "pass"),  # an island, or a reservation
        ("median", 0.5, "unknown"),
        ("median", 1.5, "pass"),
        ("none", 0.5, "fail"),
    ],
)
def test_a_narrow_strip_between_the_directions_is_looked_through(
    hand: str, kind: str, width: float, expected: str
) -> None:
    """Over the solid line on its near side; what a map calls a median may be one that nobody can cross."""
    way = divided(hand, kind, width)
    assert said(way, wobble(way)) == {expected}
    own = [r for r in beside(way) if r["lanelet_id"] == f"1.0.{'' if hand == 'lht' else '-'}1"]
    if kind != "none":
        through = expected != "pass"
        assert {(r["drivable"], r["against"], r["strip"]) for r in own} == {(through, True, kind if through else None)}
        assert {r["gap_m"] for r in own} == {width if through else 0.0}
    broken = divided(hand, kind, width, centre="broken")
    assert said(broken, wobble(broken)) == {"pass"}
    if kind == "median":
        motorway = divided(hand, kind, width, "motorway")
        assert said(motorway, wobble(motorway)) == {"pass"}


@pytest.mark.ci
@HANDS
@pytest.mark.parametrize("gap", [0.0, 0.9])
def test_over_a_solid_line_between_two_roads(hand: str, gap: float) -> None:
    way = apart(hand, gap)
    assert said(way, wobble(way)) == {"fail"}
    assert said(way, wobble(way, 0.5)) == {"pass"}
    assert said(apart(hand, gap, "broken"), wobble(way)) == {"pass"}


@pytest.mark.ci
@HANDS
def test_over_a_solid_line_with_nothing_beyond(hand: str) -> None:
    """It may be the middle of the road, or its edge; the directions of a motorway are apart."""
    way = apart(hand, 99.0)
    assert said(way, wobble(way)) == {"unknown"}
    assert said(way, wobble(way, 0.5)) == {"pass"}
    motorway = apart(hand, 99.0, kind="motorway")
    assert said(motorway, wobble(motorway)) == {"pass"}
    wide = apart(hand, 1.2)  # with what may be a central reservation
    assert said(wide, wobble(wide)) == {"unknown"}
    part = apart(hand, since=300.0)
    assert said(part, wobble(part)) == {"unknown"}
    assert said(part, wobble(part, start=400.0)) == {"fail"}


@pytest.mark.ci
@HANDS
def test_an_overtake_on_such_a_map_is_one_in_an_opposing_lane(hand: str) -> None:
    """The same verdicts as on a map that names the opposing lane."""
    verdicts = []
    for way in (road(hand=hand), apart(hand, centre="broken")):
        t = times(25.0)
        s = 50 + 12 * t
        ego = moving("ego", way, t, s, swing(way, s, 100, 220))
        vbp = standing("vbp", way, t, 160, way.own)
        ov = moving("ov", way, t, 560 - 8 * t, way.other)
        con = derived(drive([ego, vbp, ov], way.environment), tables=["overtake", "registration"])
        (found,) = rows(con, "FROM overtake")
        assert (found["opposing"], found["status"], found["ov_id"]) == (True, "completed", "ov")
        (fits,) = rows(con, "FROM registration")
        assert fits["ok"]
        of = judged(
            [drive([ego, vbp, ov], way.environment)], rules=["ukhc.r162.safe-distance-ahead", "ukhc.overtake-zone"]
        )
        verdicts.append([(r["rule_id"], r["verdict"], r["observed"]) for r in of])
    for one, other in zip(*verdicts, strict=True):
        assert one[:2] == other[:2]
        assert one[2] == pytest.approx(other[2], abs=0.1)


@pytest.mark.ci
def test_two_roads_side_by_side_are_a_single_carriageway() -> None:
    """Out of town a road of one direction is half of a dual carriageway, unless the other half touches it."""
    for gap, kind, carriageway in (
        (0.0, "rural", "single"),
        (1.5, "rural", None),
        (99.0, "rural", "dual"),
        (0.0, "motorway", "dual"),
        (0.0, "town", "single"),
        (99.0, "town", None),
    ):
        way = apart("lht", gap, kind=kind)
        con = derived(drive([wobble(way)], way.environment), tables=["ego_condition"])
        assert {r["carriageway"] for r in rows(con, "FROM ego_condition")} == {carriageway}


HARD = "ukhc.r269.hard-shoulder"


@pytest.mark.ci
@HANDS
@pytest.mark.parametrize(("share", "verdict"), [(1.0, "fail"), (0.6, "fail"), (0.0, "pass")])
def test_a_drive_on_the_hard_shoulder_fits_the_map_and_is_judged(hand: str, share: float, verdict: str) -> None:
    way = shouldered(hand)
    t = times(20.0)
    side = np.sign(way.own)
    ego = moving("ego", way, t, 50 + 20 * t, side * np.where(t < 20 * share + (share == 1), 1.5 * LANE, 0.5 * LANE))
    con = derived(drive([ego], way.environment), tables=["registration"])
    (found,) = rows(con, "FROM registration")
    assert (found["ok"], found["n_on_lane"], found["lateral_median_m"]) == (True, len(t), pytest.approx(0.0, abs=1e-6))
    assert said(way, ego, rules=[HARD]) == {verdict}
    # on it the wrong way round, or at its edge, the map does not fit
    back = moving("ego", way, t, 550 - 20 * t, side * np.full(t.shape, 1.5 * LANE))
    edge = moving("ego", way, t, 50 + 20 * t, side * np.full(t.shape, 1.5 * LANE + 1.3))
    assert [said(way, odd, rules=[HARD]) for odd in (back, edge)] == [{"unknown"}, {"unknown"}]


@HANDS
@pytest.mark.parametrize(
    ("slows", "hazard", "fails"),
    [
        (9.0, 12.0, False),  # it signals, rolls there, and puts the hazard lights on
        (9.0, 22.0, False),  # once it stands
        (9.0, 31.0, True),  # long after it stood
        (23.0, 31.0, True),  # it drives along it first
        (9.0, 99.0, True),
    ],
)
def test_a_breakdown_on_the_hard_shoulder(hand: str, slows: float, hazard: float, fails: bool) -> None:
    """At 20 m/s onto the shoulder, on it from 9.2 s on, slowing by 2.5 m/s2 from `slows` on."""
    way = shouldered(hand, 1, 900.0)
    t = times(45.0)
    v = 20 - 2.5 * np.clip(t - slows, 0, 8)
    s = 20 + np.concatenate([[0.0], np.cumsum((v[1:] + v[:-1]) / 2 * np.diff(t))])
    d = np.sign(way.own) * LANE * (0.5 + ease((t - 7.5) / 3.5))
    lights = tuple("hazard" if x >= hazard else ("right" if hand == "rht" else "left") if x > 5 else "off" for x in t)
    found = judged([drive([moving("ego", way, t, s, d, indicator=lights)], way.environment)], rules=[HARD])
    assert any(row["verdict"] == "fail" for row in found) is fails


def test_a_drive_on_the_footway_does_not_fit_the_map() -> None:
    way = marked("rht", beyond="sidewalk")
    ego = moving("ego", way, times(20.0), 50 + 20 * times(20.0), -1.5 * LANE)
    (found,) = rows(derived(drive([ego], way.environment), tables=["registration"]), "FROM registration")
    assert (found["ok"], found["n_on_lane"]) == (False, 0)
    assert '"seldom_on_lane"' in found["reason"]
    walker = moving("ego", way, times(20.0), 50 + times(20.0), -1.5 * LANE, kind="pedestrian")
    (found,) = rows(derived(drive([walker], way.environment), tables=["registration"]), "FROM registration")
    assert '"ego_not_a_vehicle"' in found["reason"]


BAN = "ukhc.r265.right-lane-ban"


@HANDS
@pytest.mark.parametrize(
    ("lanes", "length", "cuts", "lane", "verdict"),
    [
        (3, 600.0, (), 1, {"fail"}),  # one section, with which the map ends
        (3, 600.0, (), 2, {"pass"}),
        (3, 400.0, (), 1, {"unknown"}),  # one of them may be for joining
        (3, 600.0, (400.0,), 1, {"fail"}),
        (2, 600.0, (), 1, {"not_applicable"}),
        (2, 600.0, (400.0,), 1, {"not_applicable"}),
    ],
)
def test_the_lane_furthest_from_the_edge_where_the_map_ends(  # noqa: PLR0917
    hand: str, lanes: int, length: float, cuts: tuple[float, ...], lane: int, verdict: set[str]
) -> None:
    """`lane`: counted from the middle of the road; the rule is written for the left, and mirrors."""
    way = shouldered(hand, lanes, length, cuts)
    t = times(15.0)
    ego = moving("ego", way, t, 20 + 20 * t, np.sign(way.own) * LANE * (lane - 0.5), kind="truck")
    told = saying(drive([ego], way.environment), vehicle_class="goods_over_7t5")
    assert {row["verdict"] for row in judged([told], rules=[BAN])} == verdict


@pytest.mark.ci
@HANDS
def test_where_only_the_two_directions_go_on_there_is_no_junction(hand: str) -> None:
    way = jointed(hand)
    t = times(33.0)
    s = 5 + 12 * t
    ego, vbp = moving("ego", way, t, s, swing(way, s, 100, 195)), standing("vbp", way, t, 150, way.own)
    con = derived(drive([ego, vbp], way.environment), tables=["junction_passage", "overtake_place", "_road_half"])
    halves = {(r["road_id"], r["of_road_id"], r["turned"]) for r in rows(con, "FROM _road_half")}
    assert halves == {("5", "1", True), ("4", "2", True)}
    (passage,) = rows(con, "FROM junction_passage")
    assert passage["branches"] == 2
    (place,) = rows(con, "FROM overtake_place")
    assert math.isinf(place["junction_m"])
