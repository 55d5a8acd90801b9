"""What belongs to the ego: the trailer that it draws, the id under which its track goes on; and who does not, however close."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from tests.derive.junction_scenes import cross, crosswalk
from tests.derive.marked import marked
from tests.derive.trailer_scene import drawn
from tests.scenes import Actor, Road, derived, drive, judged, moving, road, rows, saying, standing, times

if TYPE_CHECKING:
    import duckdb
    from numpy.typing import NDArray

    from drivelint.engine.batch import Drive

HANDS = pytest.mark.parametrize("hand", ["lht", "rht"])
CRASH = "ukhc.no-collision"
BEND = ((150.0, 0.0), (60.0, 1 / 40), (300.0, 0.0))


def parts(scene: Drive) -> dict[str, str]:
    con = derived(scene, tables=["_ego_part"])
    return {row["object_id"]: row["part"] for row in rows(con, "FROM _ego_part")}


def there(con: duckdb.DuckDBPyConnection) -> set[str]:
    return {row["object_id"] for row in rows(con, "SELECT DISTINCT object_id FROM pair")}


@pytest.mark.parametrize(("hitch", "length"), [(0.5, 6.0), (1.2, 4.0), (-1.0, 12.0)])
@pytest.mark.parametrize("kind", ["trailer", None])
@HANDS
def test_the_trailer_is_the_ego(hand: str, kind: str | None, hitch: float, length: float) -> None:
    """Round a bend of 40 m: behind a drawbar, and over a fifth wheel, where the boxes overlap."""
    way = road(BEND, hand)
    t = times(20.0)
    ego = moving("ego", way, t, 40 + 10 * t, way.own, length=6.0, width=2.4)
    scene = drive([ego, drawn("t", ego, hitch, length, kind=kind)], way.environment)
    touches = hitch < 0
    if kind == "trailer" or touches:
        assert parts(scene) == {"t": "trailer"}
        con = derived(scene, tables=["pair", "conflict", "ego_state", "unplaced"])
        assert not rows(con, "FROM pair")
        assert not rows(con, "FROM conflict")
        for row in rows(con, "FROM ego_state"):
            assert row["combination_m"] == pytest.approx(6 + length + 2 * hitch, abs=0.4)
            assert row["front_s_m"] - row["rear_s_m"] == pytest.approx(row["combination_m"], abs=0.5)
        assert {row["verdict"] for row in judged([scene], rules=[CRASH])} == {"not_applicable"}
    else:
        assert parts(scene) == {}


@pytest.mark.ci
@HANDS
def test_the_trailer_s_box_is_the_ego_s(hand: str) -> None:
    """Who stands in its way is struck though the ego is past, and the ego's rear is the trailer's."""
    way = road(((600.0, 0.0),), hand)
    t = times(10.0)
    ego = moving("ego", way, t, 100 + 10 * t, way.own)
    behind = moving("behind", way, t, 60 + 10 * t, way.own)
    wide = replace(drawn("t", ego, kind="trailer"), width=3.0)
    beside = standing("beside", way, t, 150, way.own + 2.2, width=1.6)
    scene = drive([ego, wide, behind, beside], way.environment)
    con = derived(scene, tables=["pair", "ego_state"])
    assert there(con) == {"behind", "beside"}
    gap = "SELECT e.rear_s_m - p.front_s_m AS gap_m FROM pair p JOIN ego_state e USING (drive_id, ego_id, t_ns)"
    assert {round(r["gap_m"], 1) for r in rows(con, f"{gap} WHERE object_id = 'behind'")} == {28.2}
    found = {row["object_id"]: row["verdict"] for row in judged([scene], rules=[CRASH])}
    assert found == {"behind": "pass", "beside": "fail"}
    # while the trailer is not placed, nobody knows
    lost = drive([ego, wide.lost((t > 4) & (t < 6)), behind, beside], way.environment)
    found = {row["object_id"]: row["verdict"] for row in judged([lost], rules=[CRASH])}
    assert found["behind"] == "unknown"


@pytest.mark.parametrize(
    ("kind", "expected"),
    [("car", "car_towing"), ("bus", None), ("motorcycle", None), ("van", None), ("truck", None), (None, None)],
)
@HANDS
def test_a_car_that_draws_a_trailer_is_one_that_tows(hand: str, kind: str | None, expected: str | None) -> None:
    way = road(((600.0, 0.0),), hand)
    t = times(10.0)
    ego = moving("ego", way, t, 100 + 10 * t, way.own, kind=kind)
    con = derived(drive([ego, drawn("t", ego, kind="trailer")], way.environment), tables=["ego_condition"])
    assert {row["vehicle_class"] for row in rows(con, "FROM ego_condition")} == {expected}


@pytest.mark.parametrize(("mph", "expected"), [(49, "pass"), (58, "fail")])
@HANDS
def test_a_car_with_a_trailer_keeps_to_its_own_limit(hand: str, mph: float, expected: str) -> None:
    """R124: 50 mph on a single carriageway, though its sign says 60, which holds for the same car without."""
    way = road(((600.0, 0.0),), hand)
    t = times(10.0)
    ego = moving("ego", way, t, 100 + mph * 0.44704 * t, way.own)
    alone, towing = drive([ego], way.environment), drive([ego, drawn("t", ego, kind="trailer")], way.environment)
    limit = ["ukhc.r124.speed-limit"]
    assert {row["verdict"] for row in judged([saying(alone, nation="gb")], rules=limit)} == {"pass"}
    assert {row["verdict"] for row in judged([saying(towing, nation="gb")], rules=limit)} == {expected}


@pytest.mark.parametrize("unseen", [False, True])
@HANDS
def test_its_rear_is_past_a_mark_when_the_trailer_s_is(hand: str, unseen: bool) -> None:
    """A crossing at 100 m, 3 m wide, and a junction from 185 to 215 m: the ego's rear is 2.4 m behind its middle, the trailer's 9.4 m."""
    way = cross(hand, (), (("1", crosswalk("walk", 100.0)),))["we"]
    t = times(24.0)
    ego = moving("ego", way, t, 60 + 8 * t, way.own)
    trailer = drawn("t", ego, kind="trailer")
    if unseen:
        trailer = trailer.lost((t > 5) & (t < 20.5))
    for parts_, reach in (([ego], 2.4), ([ego, trailer], 9.4)):
        con = derived(drive(parts_, way.environment), tables=["crossing_passage", "junction_passage"])
        (over,) = rows(con, "FROM crossing_passage")
        (through,) = rows(con, "FROM junction_passage")
        assert over["t_in_ns"] / 1e9 == pytest.approx((100 - 2.4 - 60) / 8, abs=0.11)
        assert over["t_out_ns"] / 1e9 == pytest.approx((103 + reach - 60) / 8, abs=0.11)
        assert through["t_in_ns"] / 1e9 == pytest.approx((185 - 2.4 - 60) / 8, abs=0.11)
        assert through["t_out_ns"] / 1e9 == pytest.approx((215 + reach - 60) / 8, abs=0.11)


@pytest.mark.parametrize(("trailer", "left_s"), [(False, 5 + 3.3 / 10), (True, 5 + (9.4 + 0.9) / 10)])
def test_common_ground_is_left_when_the_trailer_leaves_it(trailer: bool, left_s: float) -> None:
    """The other goes north at 5 m/s and is at the ego's lane at 8 s: until its front touches the side of the wider of the two boxes."""
    t = times(12.0)
    east, north = Road(None, ((1000.0, 0.0),), (0.0, 0.0, 0.0)), Road(None, ((1000.0, 0.0),), (0.0, 0.0, math.pi / 2))  # type: ignore[arg-type]
    ego, other = moving("ego", east, t, -50 + 10 * t, 0.0), moving("other", north, t, -40 + 5 * t, 0.0)
    scene = [ego, other, drawn("t", ego, kind="trailer")] if trailer else [ego, other]
    (row,) = rows(derived(drive(scene, None), tables=["conflict"]), "FROM conflict")
    assert (row["object_id"], row["ego_first"]) == ("other", True)
    half_m = 1.1 if trailer else 0.9
    assert row["pet_s"] == pytest.approx(8 - (2.4 + half_m) / 5 - left_s, abs=1e-6)


@HANDS
def test_the_trailer_is_not_somebody_else_to_brake_for(hand: str) -> None:
    """The ego is across in time, its trailer is not, and the oncoming car brakes for that."""
    ways = cross(hand)
    t = times(30.0)
    way = ways["wn".translate(str.maketrans("ns", "sn")) if hand == "lht" else "wn"]
    ego = moving("ego", way, t, 120 + 8 * t, way.own)
    speed = np.clip(14.0 - 6.0 * np.clip(t - 8.0, 0, None), 0, 14.0)
    came = np.concatenate([[0.0], np.cumsum((speed[1:] + speed[:-1]) / 2 * np.diff(t))])
    other = moving("o", ways["ew"], t, 56 + came, ways["we"].own)
    trailer = drawn("t", ego, length=8.0, kind="trailer")
    for actors, pet_s in (([ego, other], 0.51), ([ego, trailer, other], -0.59)):
        con = derived(drive(actors, ways["we"].environment), tables=["forced_braking"])
        (row,) = rows(con, "FROM forced_braking")
        assert (row["object_id"], row["other_cause"]) == ("o", None)
        assert row["pet_s"] == pytest.approx(pet_s, abs=0.11)


TAILGATERS = [
    ("a car at half a metre", 0.5, "car", "ego"),
    ("a vehicle at half a metre", 0.5, "vehicle", "ego"),
    ("a truck at a decimetre and a half, which brakes away", 0.15, "truck", "brakes"),
    ("a trailer that stays behind", 0.5, "trailer", "brakes"),
    ("a trailer of another lane", 0.5, "trailer", "beside"),
]


@pytest.mark.parametrize(("what", "gap", "kind", "how"), TAILGATERS)
@HANDS
def test_who_is_no_trailer(hand: str, what: str, gap: float, kind: str, how: str) -> None:
    way = road(((600.0, 0.0),), hand)
    t = times(15.0)
    ego = moving("ego", way, t, 60 + 15 * t, way.own)
    s = 60 + 15 * t - 4.8 - gap - (np.maximum(t - 10, 0) ** 2 if how == "brakes" else 0)
    other = moving("x", way, t, s, way.other if how == "beside" else way.own, kind=kind)
    scene = drive([ego, other], way.environment)
    assert parts(scene) == {}
    assert there(derived(scene, tables=["pair"])) == {"x"}


@pytest.mark.ci
@HANDS
def test_a_tailgater_round_a_bend_is_none_either(hand: str) -> None:
    """Its box follows the lane, not the ego's hitch, and does not touch."""
    way = road(BEND, hand)
    t = times(20.0)
    ego = moving("ego", way, t, 40 + 10 * t, way.own)
    for kind in ("car", "vehicle", None):
        assert parts(drive([ego, moving("x", way, t, 40 + 10 * t - 5.1, way.own, kind=kind)], way.environment)) == {}


def test_who_is_struck_and_pushed_is_no_trailer() -> None:
    """It stood there, was struck from behind and shoved on; seen from it, the ego came from behind and touched it from then on."""
    way = road(((600.0, 0.0),))
    t = times(12.0)
    pusher = np.where(t < 4, 15 * t, 60 + 8 * (t - 4))
    struck = moving("ego", way, t, 164.8 + np.where(t < 4, 0, 8 * (t - 4)), way.own)
    scene = drive([struck, moving("x", way, t, 100 + pusher, way.own, kind="vehicle")], way.environment)
    assert parts(scene) == {}


# ---- ids


def renamed(
    way: Road, at: NDArray[np.float64], early: NDArray[np.bool_], late: NDArray[np.bool_], **more: Any
) -> list[Actor]:
    """Return one vehicle under two ids: in the samples of the one mask, and in those of the other."""
    whole = moving("ego", way, at, 50 + 18 * at, way.own)
    return [whole.keep(early), replace(whole.keep(late), actor_id="next", **more)]


@pytest.mark.ci
@pytest.mark.parametrize("overlap", [-1, 0, 1, 2])
@pytest.mark.parametrize("ego", ["ego", "next"])
@HANDS
def test_the_ego_under_another_id_is_no_collision(hand: str, ego: str, overlap: int) -> None:
    """The tracks share samples, or there is a sample between them: seen from either of the two."""
    way = road(((600.0, 0.0),), hand)
    t = times(12.0)
    k = np.arange(len(t))
    both = [*renamed(way, t, k < 60, k >= 60 - overlap), moving("other", way, t, 520 - 15 * t, way.other)]
    scene = drive(both, way.environment, egos=[ego])
    assert parts(scene) == {("next" if ego == "ego" else "ego"): "successor" if ego == "ego" else "predecessor"}
    con = derived(scene, tables=["pair", "conflict", "lost_object", "unplaced"])
    assert there(con) == {"other"}
    assert not rows(con, "FROM conflict")
    assert {row["object_id"] for row in judged([scene], rules=[CRASH])} <= {"other"}
    assert "fail" not in {row["verdict"] for row in judged([scene], rules=[CRASH])}


OTHERS = [
    ("beside", {"shift": (0.0, 3.5)}),
    ("a length ahead", {"shift": (5.0, 0.0)}),
    ("into the ego, half over it", {"shift": (2.5, 0.3)}),
    ("a truck", {"length": 9.0}),
    ("a walker", {"kind": "pedestrian", "length": 0.5, "width": 0.5}),
]


@pytest.mark.parametrize(("what", "change"), OTHERS)
@HANDS
def test_who_appears_where_the_ego_ends_is_somebody(hand: str, what: str, change: dict[str, Any]) -> None:
    way = road(((600.0, 0.0),), hand)
    t = times(12.0)
    k = np.arange(len(t))
    more = dict(change)
    dx, dy = more.pop("shift", (0.0, 0.0))
    first, then = renamed(way, t, k < 60, k >= 59, **more)
    scene = drive([first, replace(then, x=then.x + dx, y=then.y + dy)], way.environment)
    assert parts(scene) == {}
    if what.startswith("into"):
        assert {row["verdict"] for row in judged([scene], rules=[CRASH])} == {"fail"}


def test_who_was_there_before_is_no_successor() -> None:
    """A real collision: its track begins long before the ego's ends."""
    way = road(((600.0, 0.0),))
    t = times(12.0)
    ego = moving("ego", way, t, 50 + 10 * t, way.own).keep(t < 6)
    other = moving("next", way, t, 50 + 10 * t, way.own).keep(t > 4)
    assert parts(drive([ego, other], way.environment)) == {}
    assert "fail" in {r["verdict"] for r in judged([drive([ego, other], way.environment)], rules=[CRASH])}


@HANDS
@pytest.mark.parametrize(("kind", "turned"), [("trailer", 0.0), ("trailer", 0.25), ("car", 0.25)])
def test_a_trailer_that_swings_over_the_footway_is_the_ego_there(hand: str, kind: str, turned: float) -> None:
    """Its tail 0.4 m further out than the road is wide; a car behind on the same way is not the ego."""
    way = marked(hand, beyond="sidewalk")
    t = times(12.0)
    ego = moving("ego", way, t, 60 + 8 * t, way.own, length=6.0, width=2.0)
    out = np.sign(way.own)
    far = 3.0 + (0.5 if kind == "trailer" else 12.0)
    behind = moving("t", way, t, 60 + 8 * t - far - 3.0, way.own, length=6.0, width=2.2, kind=kind)
    swung = replace(behind, yaw=behind.yaw - out * turned, y=behind.y + out * 3.0 * math.sin(turned))
    found = rows(derived(drive([ego, swung], way.environment), tables=["ego_footway"]), "FROM ego_footway")
    assert {row["depth_m"] > 0 for row in found} == {kind == "trailer" and turned > 0}
