"""What everybody is, and what is said of those whose class is not known."""

from __future__ import annotations

import numpy as np
import pytest

from drivelint.formats import load_map
from drivelint.road.map_reader import MapSource
from tests.derive.junction_scenes import cross, crosswalk
from tests.derive.marked import marked
from tests.formats.opendrive import xodr
from tests.scenes import LANE, Actor, Road, derived, drive, judged, moving, plan, road, rows, standing, times

HANDS = pytest.mark.parametrize("hand", ["rht", "lht"])
T = times(14)


def ride(way: Road, v: float = 10.0, s0: float = 20.0) -> Actor:
    return moving("ego", way, T, s0 + v * T, way.own)


@pytest.mark.parametrize(
    ("kind", "length", "v", "known"),
    [
        ("car", 4.8, 0.0, "car"),
        ("pedestrian", 0.5, 1.4, "pedestrian"),
        (None, 4.8, 10.0, "vehicle"),
        (None, 4.8, 0.0, "vehicle"),
        (None, 3.1, 10.0, "vehicle"),
        (None, 3.0, 10.0, None),
        (None, None, 10.0, None),
        ("object", 4.8, 0.0, "object"),
        ("object", 0.4, 0.0, "object"),
        ("object", 0.4, 0.05, "object"),  # 0.7 m in the whole log
        ("object", 0.4, 0.1, None),  # 1.4 m
        ("object", 4.8, 10.0, "vehicle"),
        ("vehicle", 0.5, 0.0, "vehicle"),
    ],
)
def test_what_somebody_is(kind: str | None, length: float | None, v: float, known: str | None) -> None:
    way = road()
    other = moving("x", way, T, 100 + v * T, way.own + 20, kind=kind, length=length, width=0.5)
    con = derived(drive([ride(way), other], way.environment), tables=["road_user", "state_dynamics"])
    assert rows(con, "SELECT actor_class FROM road_user WHERE actor_id = 'x'") == [{"actor_class": known}]
    found = rows(con, "SELECT DISTINCT actor_class FROM state_dynamics WHERE actor_id = 'x'")
    assert found == [{"actor_class": known}]


@HANDS
@pytest.mark.parametrize(
    ("kind", "d", "ahead"),
    [
        ("car", 0.0, True),
        ("object", 0.0, None),  # it stands in the lane ahead
        ("object", 1.0, None),
        ("object", 1.4, False),  # at the lane's edge, beside the ego's way
        ("object", 2.6, False),  # at the roadside
        (None, 0.0, None),
        ("pedestrian", 0.0, False),
    ],
)
def test_a_thing_in_the_way_is_not_nobody(hand: str, kind: str | None, d: float, ahead: bool | None) -> None:
    """No row of lead: somebody may be there; with a row and no name nobody is."""
    way = road(hand=hand)
    other = standing("x", way, T, 180, way.own - d * way.over, kind=kind, length=0.8, width=0.6)
    con = derived(drive([ride(way), other], way.environment), tables=["lead"])
    found = {row["t_ns"]: row["object_id"] for row in rows(con, "FROM lead")}
    for t in (1.0, 8.0, 13.0):
        expected = {True: "x", False: None}.get(ahead) if ahead is not None else "no row"
        assert found.get(round(t * 1e9), "no row") == expected


def test_a_thing_beyond_the_vehicle_ahead_or_far_away_does_not_matter() -> None:
    way = road(((900.0, 0.0),))
    near = moving("v", way, T, 60 + 10 * T, way.own)
    thing = standing("x", way, T, 300, way.own, kind="object", length=0.8, width=0.6)
    for others, name in (
        ([near, thing], "v"),
        ([standing("x", way, T, 500, way.own, kind="object", length=0.8)], None),
    ):
        con = derived(drive([ride(way), *others], way.environment), tables=["lead"])
        found = rows(con, "FROM lead")
        assert len(found) == len(T)
        assert {row["object_id"] for row in found} == {name}


@HANDS
def test_a_thing_in_the_way_is_no_kept_distance(hand: str) -> None:
    """Towards it at 10 m/s to within 0.6 s: the same as a car fails, as a thing it is not known; at the roadside it is nothing."""
    way = road(hand=hand)
    told = []
    for name, kind, d in (("car", "car", 0.0), ("thing", "object", 0.0), ("roadside", "object", 3.5)):
        other = standing("x", way, T, 168, way.own - d * way.over, kind=kind, length=0.8, width=0.8)
        told.append(drive([ride(way), other], way.environment, drive_id=name))
    said: dict[str, set[str]] = {}
    for row in judged(told, rules=["criticality.ttc"]):
        said.setdefault(row["drive_id"], set()).add(row["verdict"])
    assert "fail" in said["car"]
    assert said["thing"] == {"unknown"}
    assert said["roadside"] == {"pass"}


@HANDS
@pytest.mark.parametrize("kind", ["pedestrian", None, "object"])
def test_who_walks_in_the_mouth_of_the_side_road(hand: str, kind: str | None) -> None:
    """Somebody crosses the road that the ego turns into, some 6 m beyond the junction, just after it."""
    ways = cross(hand)
    way = ways["ws" if hand == "rht" else "wn"]
    t = times(20)
    ego = moving("ego", way, t, 100 + 8 * t, way.own)
    x, y, _ = way.at(np.array([185 + 23.6 + 6.0]), 0.0)
    walk = np.clip(1.4 * (t - 12.0), 0, 12) - 5.0
    still = np.zeros_like(t)
    who = Actor("w", t, x[0] + walk, y[0] + still, still, np.gradient(walk, t), still, 0.5, 0.5, kind)
    (row,) = judged([drive([ego, who], way.environment)], rules=["ukhc.h2.turn-pedestrian"])
    if kind == "pedestrian":
        assert (row["verdict"], row["object_id"]) == ("fail", "w")
    else:
        assert row["verdict"] == "unknown"
        assert "class" in row["reason"]


@HANDS
@pytest.mark.parametrize("kind", ["pedestrian", None, "object", "vehicle"])
@pytest.mark.parametrize("moves", [True, False])
def test_who_is_on_a_zebra_crossing(hand: str, kind: str | None, moves: bool) -> None:
    """Somebody on the ego's half as it comes: walking onto it, or standing there all the time."""
    ways = cross(hand, (), (("1", crosswalk("x", 100.0, said="ZebraCrossing")),))
    way = ways["we"]
    t = times(14)
    ego = moving("ego", way, t, 0.0 + 10 * t, way.own)
    side = 1.0 if hand == "lht" else -1.0
    across = np.where(t < 8.0, 5.0, 3.0) if moves else np.full(t.shape, 3.0)
    x, y, _ = way.at(101.5, side * across)
    still = np.zeros_like(t)
    who = Actor("w", t, np.broadcast_to(x, t.shape), y, still, still, still, 0.4, 0.4, kind)
    (row,) = judged([drive([ego, who], way.environment)], rules=["ukhc.r195.zebra-on"])
    assert row["verdict"] == {"pedestrian": "fail", "vehicle": "pass"}.get(kind or "", "unknown")


def cycle_road(hand: str, between: str | None, mark: str = "broken") -> Road:
    """Return a straight two-way road of one lane each way, beside each of them a cycle lane of 2 m, after `between` of 0.3 m."""
    inside = f'<width sOffset="0" a="{LANE}"/><roadMark sOffset="0" type="{mark}" width="0.1"/>'
    lanes = [xodr.lane(n, inside) for n in (1, -1)]
    for sign in (1, -1):
        kinds = [(between, 0.3)] if between else []
        for k, (kind, width) in enumerate([*kinds, ("biking", 2.0)], start=2):
            lanes.append(xodr.lane(sign * k, f'<width sOffset="0" a="{width}"/>', kind))
    lanes.sort(key=lambda text: -int(text.split('"')[1]))
    text = xodr.xodr(
        xodr.road(
            geometry=plan(((600.0, 0.0),)),
            lanes=xodr.section(0, *lanes),
            length=600.0,
            attributes=f'rule="{hand.upper()}"',
            more='<type s="0" type="town"><speed max="30" unit="mph"/></type>',
        )
    )
    return Road(load_map(MapSource("cycle.xodr", text.encode())), ((600.0, 0.0),))


@pytest.mark.sample(0, ci=2)
@HANDS
@pytest.mark.parametrize(
    ("between", "mark", "cycle_lane", "on_strip", "british", "german"),
    [
        (None, "broken", "broken", True, "fail", "fail"),
        (None, "solid", "solid", True, "fail", "unknown"),
        (None, "curb", None, False, "not_applicable", "not_applicable"),
        # what the map calls a border may be a kerb
        ("border", "solid", None, None, "unknown", "not_applicable"),
        ("border", "curb", None, False, "not_applicable", "not_applicable"),
        ("shoulder", "solid", None, True, "fail", "not_applicable"),
        ("sidewalk", "solid", None, False, "not_applicable", "not_applicable"),
    ],
)
def test_a_cyclist_on_a_cycle_lane(  # noqa: PLR0917
    hand: str, between: str | None, mark: str, cycle_lane: str | None, on_strip: bool | None, british: str, german: str
) -> None:
    """Passed at 1.05 m: on the carriageway's lane it counts, on a track behind a verge or kerb it does not."""
    way = cycle_road(hand, between, mark)
    side, d = -way.over, 2.0 if between else 1.8  # the rider is 2.25 m beside the ego's centre
    ego = moving("ego", way, T, 20 + 10 * T, side * d)
    other = moving("b", way, T, 60 + 5 * T, side * (d + 2.25), kind="bicycle", length=1.8, width=0.6)
    told = drive([ego, other], way.environment)
    con = derived(told, tables=["beside"])
    found = rows(con, "FROM beside")
    assert found
    assert {(r["cycle_lane"], r["on_carriageway"]) for r in found} == {(cycle_lane, cycle_lane is not None)}
    assert {r["on_strip"] for r in found} == {on_strip}
    assert all(r["clearance_m"] == pytest.approx(1.05, abs=0.01) for r in found)
    said = {r["rule_id"]: r["verdict"] for r in judged([told], rules=["ukhc.r163.cyclist", "stvo.s5-passing"])}
    assert said == {"ukhc.r163.cyclist": british, "stvo.s5-passing": german}


@HANDS
@pytest.mark.parametrize("kind", ["shoulder", "stop", "parking", "border", "restricted"])
@pytest.mark.parametrize(
    ("gap", "slow", "expected"),
    [(0.75, False, "fail"), (2.05, False, "pass"), (0.75, True, "unknown"), (2.05, True, "not_applicable")],
)
def test_a_cyclist_beside_the_lanes(hand: str, kind: str, gap: float, slow: bool, expected: str) -> None:
    """Passed on the strip outside the edge line as on the lane; a bicycle that stands there may be parked."""
    way = marked(hand, beyond=kind)
    side, speed = -way.over, 0.0 if slow else 5.0
    ego = moving("ego", way, T, 20 + 16 * T, side * (LANE - 0.3 - 0.9))
    other = moving("b", way, T, 60 + speed * T, side * (LANE - 0.3 + gap + 0.3), kind="bicycle", length=1.8, width=0.6)
    told = drive([ego, other], way.environment)
    assert {r["on_strip"] for r in rows(derived(told, tables=["beside"]), "FROM beside")} == {True}
    assert {r["verdict"] for r in judged([told], rules=["ukhc.r163.cyclist"])} == {expected}
