"""Who is beside the ego, how far apart; who passes whom; who is there and has no place."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from shapely import affinity
from shapely.geometry import Polygon, box

from tests.scenes import LANE, Actor, Road, derived, drive, judged, moving, road, rows, seconds, standing, swing, times

HANDS = pytest.mark.parametrize("hand", ["rht", "lht"])


def outline(actor: Actor, k: int) -> Polygon:
    assert actor.length
    assert actor.width
    upright = box(-actor.length / 2, -actor.width / 2, actor.length / 2, actor.width / 2)
    return affinity.translate(
        affinity.rotate(upright, actor.yaw[k], origin=(0, 0), use_radians=True), actor.x[k], actor.y[k]
    )


@pytest.mark.parametrize("curvature", [0.0, 1 / 90, -1 / 90])
def test_gaps_and_clearances_are_those_of_the_boxes(curvature: float) -> None:
    """A weaving car beside a weaving ego: across the lane as on a straight road, box to box as shapely says."""
    way = road(((500.0, curvature),))
    t = times(20.0)
    ego = moving("ego", way, t, 60 + 10 * t, way.own + 0.3 * np.sin(t))
    other = moving("x", way, t, 52 + 10.8 * t, way.own + 2.9 + 0.2 * np.cos(t))
    con = derived(drive([ego, other], way.environment), tables=["beside"])
    found = {row["t_ns"]: row for row in rows(con, "FROM beside")}
    assert 80 < len(found) < 130
    for k, at in enumerate(t):
        row = found.get(round(at * 1e9))
        # stations grow faster outside of a bend: along the lane's own centre line
        stretch = 1 - way.own * curvature
        ahead = (0.8 * at - 8) * stretch
        if abs(ahead) < 4.6:
            assert row is not None
            assert row["clearance_m"] == pytest.approx(outline(ego, k).distance(outline(other, k)), abs=1e-6)
            assert row["ahead_m"] == pytest.approx(ahead, abs=0.25)
            assert row["side"] == "left"
            assert (row["along"], row["on_carriageway"], row["actor_class"]) == (True, True, "car")
            if not curvature:
                halves = [0.9 * abs(math.cos(a.yaw[k])) + 2.4 * abs(math.sin(a.yaw[k])) for a in (ego, other)]
                apart = 2.9 + 0.2 * math.cos(at) - 0.3 * math.sin(at)
                assert row["gap_m"] == pytest.approx(apart - sum(halves), abs=1e-6)
                assert row["ego_lat_mps"] == pytest.approx(ego.vy[k], abs=1e-6)
                assert row["lat_mps"] == pytest.approx(-other.vy[k], abs=1e-6)
        elif abs(ahead) > 5.2:
            assert row is None


SIDES = [
    ("bicycle", 1.4, "left", True),
    ("bicycle", -1.6, "right", True),
    ("pedestrian", -2.6, "right", False),  # on the verge
    ("car", 3.5, "left", True),
    (None, 3.5 + LANE, "left", True),  # two lanes over
]


@pytest.mark.parametrize(("kind", "d", "side", "on"), SIDES)
def test_any_road_user_on_either_side(kind: str | None, d: float, side: str, on: bool) -> None:
    way = road(lanes=(2, 1))
    t = times(1.0)
    ego = moving("ego", way, t, 100 + 10 * t, way.own)
    other = moving("x", way, t, 101 + 9 * t, way.own + d, kind=kind, length=1.8, width=0.6)
    found = rows(derived(drive([ego, other], way.environment), tables=["beside"]), "FROM beside ORDER BY t_ns")
    assert len(found) == len(t)
    assert {(row["actor_class"], row["side"], row["on_carriageway"]) for row in found} == {(kind, side, on)}
    assert found[0]["gap_m"] == pytest.approx(abs(d) - 1.2)
    assert (found[0]["ego_speed_mps"], found[0]["speed_mps"]) == pytest.approx((10.0, 9.0))


def test_who_may_be_beside_is_a_row_without_numbers() -> None:
    """Lost while beside: nobody may say that he is gone; lost far away he cannot be here yet."""
    way = road()
    t = times(4.0)
    ego = moving("ego", way, t, 100 + 10 * t, way.own)
    near = moving("near", way, t, 100 + 10 * t, way.other).lost(t > 2.05)
    far = moving("far", way, t, 400 + 10 * t, way.other).lost(t > 2.05)
    sizeless = replace(moving("sizeless", way, t, 112 + 10 * t, way.other), length=None)
    walker = moving("walker", way, t, 102 + 10 * t, -5.0, kind="pedestrian").lost(t > 2.05)
    con = derived(drive([ego, near, far, sizeless, walker], way.environment), tables=["beside", "hidden"])
    found = rows(con, "FROM beside ORDER BY object_id, t_ns")
    blind = {row["object_id"] for row in found if row["gap_m"] is None}
    assert blind == {"near", "sizeless", "walker"}
    unseen = [row for row in found if row["object_id"] == "near" and row["t_ns"] > 2.05e9]
    assert len(unseen) == 20
    assert all(row["side"] is None and row["along"] is None and row["on_carriageway"] is None for row in unseen)
    hidden = rows(con, "FROM hidden WHERE object_id = 'far' ORDER BY t_ns")
    # 300 m away along the road at the last sample, going the ego's way: 5 cm nearer after 0.1 s at the most
    assert hidden[0]["least_m"] == pytest.approx(300 - 4.8 - 0.05, abs=1e-3)
    assert {row["vehicle"] for row in rows(con, "FROM hidden WHERE object_id = 'walker'")} == {False}


def test_seen_again_soon_it_was_not_far() -> None:
    """0.5 s without a place, 40 m ahead before and after: braking with 10 m/s2 it was 39.5 m away at least."""
    way = road()
    t = times(4.0)
    ego = moving("ego", way, t, 100 + 10 * t, way.own)
    other = moving("x", way, t, 140 + 10 * t, way.own).lost((t > 1.95) & (t < 2.45))
    con = derived(drive([ego, other], way.environment), tables=["beside", "hidden"])
    least = [row["least_m"] for row in rows(con, "FROM hidden ORDER BY t_ns")]
    assert least == pytest.approx([40 - 4.8 - 5 * (0.1 * min(k, 6 - k)) ** 2 for k in (1, 2, 3, 4, 5)], abs=1e-6)
    assert not rows(con, "FROM beside")


def test_without_a_map_the_own_way_tells_who_is_beside() -> None:
    t = times(0.5)
    way = road()
    ego, other = moving("ego", way, t, 100 + 10 * t, way.own), moving("x", way, t, 100 + 10 * t, way.other)
    far = moving("far", way, t, 130 + 10 * t, way.other)
    found = rows(derived(drive([ego, other, far], None), tables=["beside"]), "FROM beside")
    assert {row["object_id"] for row in found} == {"x"}
    assert [row["gap_m"] for row in found] == pytest.approx([LANE - 1.8] * len(t))
    assert len(found) == len(t)


# ---- passing


def passings(way: Road, *actors: Actor, egos: tuple[str, ...] = ("ego",)) -> list[dict[str, object]]:
    con = derived(drive(actors, way.environment, egos=egos), tables=["passing"])
    return rows(con, "FROM passing ORDER BY ego_id, occurrence")


@HANDS
def test_the_ego_passes_a_parked_car_round_the_overtaking_side(hand: str) -> None:
    way = road(hand=hand)
    t = times(20.0)
    s = 50 + 12 * t
    ego = moving("ego", way, t, s, swing(way, s, 150, 230))
    parked = standing("x", way, t, 200, way.own)
    (found,) = passings(way, ego, parked)
    assert found["side"] == ("right" if hand == "rht" else "left")
    assert (found["ego_passes"], found["same_lane"], found["whole"]) == (True, True, True)
    assert found["t_ns"] == 12_600_000_000  # 201.2 m, 1.2 m past; at 200.0 m the fronts are level
    assert seconds([found], "t_from_ns")[0] == pytest.approx((195.2 - 50) / 12, abs=0.1)
    assert seconds([found], "t_to_ns")[0] == pytest.approx((204.8 - 50) / 12, abs=0.1)
    assert found["gap_m"] == pytest.approx(3.5 - 1.8, abs=1e-6)
    assert (found["ego_speed_mps"], found["speed_mps"]) == pytest.approx((12.0, 0.0))


@pytest.mark.ci
def test_of_a_passing_cut_by_the_log_or_a_hole_the_least_gap_is_only_what_was_seen() -> None:
    way = road(lanes=(0, 2))
    t = times(10.0)
    ego = moving("ego", way, t, 100 + 10 * t, -1.5 * LANE)
    fast = moving("x", way, t, 80 + 15 * t, -0.5 * LANE)
    for begin, end in ((3.5, 10.0), (0.0, 4.5)):
        keep = (t > begin - 0.05) & (t < end + 0.05)
        (found,) = passings(way, ego.keep(keep), fast.keep(keep))
        assert (found["t_ns"], found["whole"]) == (4_100_000_000, False)
        assert found["gap_m"] == pytest.approx(1.7)
    keep = (t < 3.45) | (t > 4.45)
    (found,) = passings(way, ego.keep(keep), fast.keep(keep))  # the order has changed all the same
    assert (found["t_ns"], found["whole"]) == (4_500_000_000, False)
    blind = fast.lost((t > 3.45) & (t < 4.45))
    (found,) = passings(way, ego, blind)
    assert (found["t_unseen_ns"], found["t_ns"], found["whole"]) == (3_400_000_000, 4_500_000_000, False)
    (own,) = passings(way, ego.lost((t > 3.45) & (t < 4.45)), fast)
    assert (own["t_unseen_ns"], own["t_ns"], own["whole"]) == (3_400_000_000, 4_500_000_000, False)
    (whole,) = passings(way, ego, fast.lost((t > 1) & (t < 2)))
    assert (whole["t_unseen_ns"], whole["t_ns"]) == (None, 4_100_000_000)
    all_of_it = fast.lost((t > 2.45) & (t < 5.55))
    (found,) = passings(way, ego, all_of_it)
    assert (found["t_unseen_ns"], found["t_ns"]) == (2_400_000_000, 5_600_000_000)
    assert (found["whole"], found["gap_m"]) == (False, None)


def test_each_ego_has_its_own_passings() -> None:
    way = road(lanes=(0, 2))
    t = times(10.0)
    slow = moving("a", way, t, 100 + 10 * t, -1.5 * LANE)
    fast = moving("b", way, t, 80 + 15 * t, -0.5 * LANE)
    found = passings(way, slow, fast, egos=("a", "b"))
    assert [(row["ego_id"], row["object_id"], row["ego_passes"], row["side"]) for row in found] == [
        ("a", "b", False, "left"),
        ("b", "a", True, "right"),
    ]


@pytest.mark.ci
def test_who_has_no_place_beside_the_ego_may_have_been_passed() -> None:
    way = road(lanes=(1, 2))
    t = times(12.0)
    ego = moving("ego", way, t, 100 + 15 * t, -1.5 * LANE)
    slow = moving("x", way, t, 160 + 5 * t, -0.5 * LANE)
    # from 40 m ahead to 40 m behind: braking with 10 m/s2 it stops 1.25 m on, and the ego is near after 1.9 s
    blind = slow.lost((t > 1.95) & (t < 9.95))
    ever = slow.lost(t > -1)
    for other, begin, end in ((blind, 3.8, 8.2), (slow.lost(t < 9.95), 0.0, 8.2), (ever, 0.0, 12.0)):
        (found,) = passings(way, ego, other)
        assert (found["ego_passes"], found["side"], found["same_lane"], found["whole"]) == (None, None, None, False)
        assert (found["occurrence"], found["gap_m"]) == (0, None)
        assert seconds([found], "t_from_ns") == seconds([found], "t_unseen_ns") == [begin]
        assert seconds([found], "t_to_ns") == seconds([found], "t_ns") == [end]
    # ahead before and after, or seen just before and just after, there is no doubt
    assert [row["ego_passes"] for row in passings(way, ego, slow.lost((t > 1.95) & (t < 3.45)))] == [True]
    assert [row["ego_passes"] for row in passings(way, ego, slow.lost((t > 3.45) & (t < 8.45)))] == [True]
    oncoming = moving("o", way, t, 300 - 5 * t, 0.5 * LANE)
    assert not passings(way, ego, oncoming.lost((t > 4.95) & (t < 11.45)))


STEADY = "ukhc.r168.when-overtaken"


def overtaken(hand: str, *, drift: float, out: bool = True, at: float = 6.0, follows: float = 22.0) -> str:
    """Return the verdict on an ego at 18 m/s that moves over by `drift` metres in the 2 s after `at`, before a car that comes up.

    The car is out in the opposing lane, and 15 m behind the ego at 7 s, or follows in the ego's lane, at `follows` m/s.
    """
    way = road(((900.0, 0.0),), hand)
    t = times(20.0)
    u = np.clip((t - at) / 2, 0, 1)
    ego = moving("ego", way, t, 80 + 18 * t, way.own + way.over * drift * u * u * (3 - 2 * u))
    behind = 80 + 18 * 7 - 4.8 - 15 + follows * (t - 7)
    if not out:
        behind = 80 + 18 * t - 20
    other = moving("x", way, t, behind, np.full(len(t), way.other if out else way.own))
    (row,) = judged([drive([ego, other], way.environment)], rules=[STEADY])
    return str(row["verdict"])


@pytest.mark.ci
@pytest.mark.parametrize("hand", ["rht", "lht"])
def test_steady_as_soon_as_somebody_out_in_the_opposing_lane_comes_up(hand: str) -> None:
    assert overtaken(hand, drift=0.7) == "fail"
    assert overtaken(hand, drift=0.0) == "pass"
    assert overtaken(hand, drift=-0.7) == "pass"  # it makes room
    assert overtaken(hand, drift=0.7, at=1.0) == "pass"  # 33 m and more behind
    assert overtaken(hand, drift=0.7, out=False) == "not_applicable"
