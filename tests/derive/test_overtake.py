"""The overtake: excursions, who is passed, its moments and how it ends, safe distance ahead, danger spaces, opportunities."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from shapely import affinity
from shapely.geometry import box

from drivelint.engine.batch import Drive
from drivelint.reasons.reason_text import sentence
from tests import scenes
from tests.derive.overtake_scene import crash, scene
from tests.scenes import LANE, Actor, Road, derived, drive, moving, road, rows, standing, swing, times

MPH = 0.44704
Row = dict[str, Any]


def one(actors: list[Actor], way: Road, table: str) -> list[Row]:
    return rows(derived(drive(actors, way.environment), tables=[table]), f"FROM {table} ORDER BY ALL")


def edge(way: Road, ego: Actor, k: int, *, outer: bool) -> float:
    """How far the furthest (or nearest) corner of a box on a straight road is beyond the centre line, by the corners themselves."""
    offsets = [
        ego.y[k] + a * ego.length / 2 * math.sin(ego.yaw[k]) + b * ego.width / 2 * math.cos(ego.yaw[k])
        for a in (1, -1)
        for b in (1, -1)
        if ego.length and ego.width
    ]
    beyond = [float(way.over * y) for y in offsets]
    return max(beyond) if outer else min(beyond)


@pytest.mark.parametrize("hand", ["rht", "lht"])
def test_a_completed_overtake(hand: str) -> None:
    way, actors = scene(hand)
    ego, vbp, ov = actors
    (found,) = one(actors, way, "overtake")
    n = len(ego.t_s)
    out = [edge(way, ego, k, outer=True) for k in range(n)]
    inner = [edge(way, ego, k, outer=False) for k in range(n)]
    k0 = next(k for k in range(n) if out[k] > 0.05)
    k1 = next(k for k in range(n) if inner[k] >= 0)
    k3 = next(k for k in range(k1, n) if out[k] <= 0.05)
    assert [found[f"t{i}_ns"] for i in (0, 1, 3)] == [round(ego.t_s[k] * 1e9) for k in (k0, k1, k3)]
    # the way back begins at s = 280; -0.1 m/s sideways is reached a little later
    assert 280 <= 50 + 12 * found["t2_ns"] / 1e9 <= 284
    assert (found["status"], found["passed"], found["opposing"], found["begin_seen"]) == ("completed", True, True, True)
    assert (found["vbp_id"], found["ov_id"], found["occurrence"]) == ("vbp", "ov", 0)
    assert found["side"] == (1 if hand == "rht" else -1)
    ego_front = max(ego.x[k0] + 2.4 * math.cos(ego.yaw[k0]) + b * 0.9 * abs(math.sin(ego.yaw[k0])) for b in (1, -1))
    assert found["vbp_gap_m"] == pytest.approx(vbp.x[k0] - 2.4 - ego_front, abs=1e-6)
    assert found["da_m"] == pytest.approx(ov.x[k0] - 2.4 - ego_front, abs=1e-6)
    assert found["v_av_mps"] == pytest.approx(math.hypot(ego.vx[k0], ego.vy[k0]))
    assert (found["v_vbp_mps"], found["v_ov_mps"]) == pytest.approx((4.0, 9.0))
    assert found["lane_width_m"] == pytest.approx(LANE)
    ego_rear = min(ego.x[k3] - 2.4 * math.cos(ego.yaw[k3]) + b * 0.9 * math.sin(ego.yaw[k3]) for b in (1, -1))
    assert found["t3_gap_m"] == pytest.approx(ego_rear - (vbp.x[k3] + 2.4), abs=1e-6)
    beta = math.atan2(abs(ego.y[k1] - ego.y[k0]), ego.x[k1] - ego.x[k0])
    assert found["pull_out_angle_rad"] == pytest.approx(beta, abs=1e-6)


def test_mirrored_scenes_give_mirrored_results() -> None:
    both = {}
    for hand in ("rht", "lht"):
        way, actors = scene(hand)
        con = derived(drive(actors, way.environment))
        both[hand] = {
            table: rows(con, f"FROM {table} ORDER BY ALL")
            for table in ("overtake", "overtake_sda", "overtake_step", "oncoming", "lead", "opportunity", "excursion")
        }
    for table, right in both["rht"].items():
        left = both["lht"][table]
        assert len(left) == len(right) > 0, table
        for a, b in zip(left, right, strict=True):
            for column, value in a.items():
                if column == "side":
                    assert value == -b[column]
                elif column.endswith("_d_m"):  # offsets change their sign with the side of the road
                    assert value == (b[column] if value is None else pytest.approx(-b[column], abs=1e-6)), (
                        table,
                        column,
                    )
                elif isinstance(value, float):
                    assert value == pytest.approx(b[column], abs=1e-6), (table, column)
                else:
                    assert value == b[column], (table, column)


def test_an_aborted_overtake() -> None:
    way, actors = scene(abort=True)
    (found,) = one(actors, way, "overtake")
    assert (found["status"], found["passed"], found["t1_ns"]) == ("aborted", False, None)
    furthest = int(np.argmax(way.over * actors[0].y)) * 100_000_000
    assert found["t0_ns"] < found["t2_ns"] < found["t3_ns"]
    assert abs(found["t2_ns"] - furthest) <= 300_000_000
    (observed,) = [row for row in one(actors, way, "overtake_sda") if row["profile"] == "observed"]
    assert observed["sda_m"] is None
    assert json.loads(observed["reason"])["code"] == "overtake_aborted"


@pytest.mark.parametrize("end", [9.0, 10.0, 12.0, 19.5])
def test_an_overtake_that_the_log_cuts_off(end: float) -> None:
    way, actors = scene()
    (whole,) = one(actors, way, "overtake")
    assert whole["t0_ns"] < 9e9 < whole["t1_ns"] < 12e9 < whole["t2_ns"] < 19.5e9 + 1.1e9 < whole["t3_ns"] + 2e9
    (found,) = one([a.keep(a.t_s < end + 0.01) for a in actors], way, "overtake")
    assert (found["status"], found["t3_ns"], found["t_end_ns"]) == ("truncated", None, round(end * 1e9))
    assert found["t2_ns"] is None  # whether it turned back for good is not known
    assert found["t1_ns"] == (whole["t1_ns"] if whole["t1_ns"] <= end * 1e9 else None)
    assert (found["t0_ns"], found["da_m"]) == (whole["t0_ns"], whole["da_m"])


@pytest.mark.parametrize("start", [9.0, 12.0])
def test_an_overtake_that_begins_before_the_log(start: float) -> None:
    way, actors = scene()
    late = [a.keep(a.t_s > start - 0.01) for a in actors]
    found = one(late, way, "overtake")
    assert not [row for row in found if row["begin_seen"]]
    if start == 9.0:  # its centre is still in its lane then
        assert [(row["status"], row["t0_ns"]) for row in found] == [("completed", 9_000_000_000)]
        assert {row["da_m"] for row in one(late, way, "overtake_sda")} == {None}


@pytest.mark.ci
@pytest.mark.parametrize(("hand", "lost_s", "n"), [("rht", 0.4, 1), ("lht", 0.4, 1), ("rht", 0.7, 2), ("lht", 0.7, 2)])
def test_a_short_hole_over_the_line_does_not_part_an_overtake(hand: str, lost_s: float, n: int) -> None:
    way, actors = scene(hand)
    (whole,) = one(actors, way, "overtake")
    middle = (whole["t0_ns"] + whole["t3_ns"]) / 2e9
    lost = [a.lost((a.t_s > middle) & (a.t_s < middle + lost_s - 0.05)) if a.actor_id == "ego" else a for a in actors]
    found = one(lost, way, "excursion")
    assert len(found) == n
    if n == 1:
        (held,) = one(lost, way, "overtake")
        assert {key: held[key] for key in ("t0_ns", "t3_ns", "passed", "da_m")} == {
            key: whole[key] for key in ("t0_ns", "t3_ns", "passed", "da_m")
        }


@pytest.mark.ci
def test_a_hole_before_t0_hides_where_it_began() -> None:
    way, actors = scene()
    (whole,) = one(actors, way, "overtake")
    t0 = whole["t0_ns"] / 1e9
    holed = [a.keep((a.t_s < t0 - 0.5) | (a.t_s > t0 + 0.15)) for a in actors]
    (found,) = one(holed, way, "overtake")
    assert found["begin_seen"] is False
    assert found["t0_ns"] > whole["t0_ns"]
    reasons = {sentence(row["reason"]) for row in one(holed, way, "overtake_sda")}
    assert reasons == {"the log does not show the beginning of the overtake: record the ego from before it"}


@pytest.mark.parametrize("hand", ["rht", "lht"])
def test_beside_a_parked_car_that_leaves_room_in_the_lane_the_ego_is_over_the_line_for_another_reason(
    hand: str,
) -> None:
    """The ego, 1.8 m wide, is 0.5 m over the line beside a car that leaves it 2.9 m of its lane, or 2.5 m."""
    way, (ego, _, ov) = scene(hand)
    astride = moving("ego", way, ego.t_s, ego.x, swing(way, ego.x, 170, 230, share=0.386))
    for reaches_in, passed in ((0.6, []), (1.0, ["parked"])):
        parked = standing("parked", way, ego.t_s, 200, np.sign(way.own) * (LANE + 0.9 - reaches_in))
        assert [row["vbp_id"] for row in one([astride, parked, ov], way, "overtake")] == passed


def test_the_one_parked_the_wrong_way_round_is_no_oncoming_vehicle() -> None:
    way, (ego, _, _) = scene()
    parked = standing("parked", way, ego.t_s, 200, way.own, turned=math.pi)
    assert {row["object_id"] for row in one([ego, parked], way, "oncoming")} == {None}


def test_a_change_of_lane_in_the_same_direction_is_not_opposing() -> None:
    way = road(lanes=(1, 2))
    t = times(25.0)
    s = 50 + 12 * t
    d = -1.5 * LANE + LANE * np.clip((s - 150) / 40, 0, 1)
    vbp = moving("vbp", way, t, 140 + 4 * t, -1.5 * LANE)
    con = derived(drive([moving("ego", way, t, s, d), vbp], way.environment), tables=["overtake", "lane_departure"])
    (found,) = rows(con, "FROM overtake")
    assert (found["opposing"], found["status"], found["passed"]) == (False, "lane_change", True)
    departures = rows(con, "FROM lane_departure ORDER BY t_ns")
    assert [(row["side"], row["back"]) for row in departures] == [("left", False)]


def test_nobody_ahead_is_no_overtake_but_a_departure() -> None:
    way, (ego, _, ov) = scene()
    con = derived(drive([ego, ov], way.environment), tables=["overtake", "lane_departure"])
    assert not rows(con, "FROM overtake")
    departures = rows(con, "FROM lane_departure ORDER BY t_ns")
    assert [(row["side"], row["back"], row["begin_seen"]) for row in departures] == [
        ("left", False, True),
        ("right", True, True),
    ]


@pytest.mark.ci
@pytest.mark.parametrize("hand", ["rht", "lht"])
def test_a_look_past_the_vehicle_ahead_is_no_overtake_if_all_of_it_was_seen(hand: str) -> None:
    """Its corner is 0.7 m over the line for seven seconds, its centre never; nobody is passed."""
    way = road(hand=hand)
    t = times(14.0)
    vbp = moving("vbp", way, t, 130 + 8 * t, way.own)
    ego = moving("ego", way, t, 60 + 8 * t, swing(way, 60 + 8 * t, 76, 130, share=0.45))
    (out,) = one([ego, vbp], way, "excursion")
    assert 0.6 < out["max_out_m"] < 0.9
    assert not one([ego, vbp], way, "overtake")
    # what was not seen may have been one
    for actors in ([ego, vbp.lost((t > 4) & (t < 5))], [ego, vbp.keep(t < 5)]):
        assert [row["status"] for row in one(actors, way, "overtake")] == ["aborted"]
    early, late = [ego.keep(t >= 4), vbp.keep(t >= 4)], [ego.keep(t <= 7), vbp.keep(t <= 7)]
    assert [(row["status"], row["begin_seen"]) for row in one(early, way, "overtake")] == [("aborted", False)]
    assert [row["status"] for row in one(late, way, "overtake")] == ["truncated"]


@pytest.mark.parametrize("reach", [0.3, 0.7])
@pytest.mark.parametrize("hand", ["rht", "lht"])
def test_an_ego_that_stays_at_the_line_overtakes_when_it_pulls_out(hand: str, reach: float) -> None:
    """From 60 to 300 m it is `reach` over the line behind the car ahead; the car that comes is near when it pulls out."""
    way = road(((1200.0, 0.0),), hand)
    t = times(40.0)
    s = 50 + 10 * t
    share = (LANE / 2 - 0.9 + reach) / LANE
    far, near = swing(way, s, 300, 400), swing(way, s, 60, 400, share=share)
    ego = moving("ego", way, t, s, way.own + (near - way.own) + (far - way.own) * (1 - share))
    vbp = moving("vbp", way, t, np.where(t < 24, 100 + 10 * t, 340 + 2 * (t - 24)), way.own)
    ov = moving("ov", way, t, 850 - 8 * t, way.other)
    (found,) = one([ego, vbp, ov], way, "overtake")
    # at 25 s it begins to move over; a tenth of a metre in a second is soon reached
    assert found["t0_ns"] / 1e9 == pytest.approx(25.2, abs=0.2)
    assert found["da_m"] == pytest.approx(800 - 18 * found["t0_ns"] / 1e9 - 4.8, abs=0.5)
    (nominal,) = [row for row in one([ego, vbp, ov], way, "overtake_sda") if row["profile"] == "nominal"]
    assert nominal["da_m"] is not None
    assert nominal["sda_m"] is not None


@pytest.mark.ci
@pytest.mark.parametrize("lacks", ["yaw", "length", "width"])
def test_who_lacks_heading_or_size_ahead_may_be_the_one(lacks: str) -> None:
    """Nearer than another who is placed: the overtake is not that one's alone."""
    way, (ego, vbp, ov) = scene()

    def without(actor: Actor) -> Actor:
        lost: dict[str, Any] = {lacks: actor.yaw * np.nan if lacks == "yaw" else None}
        return replace(actor, **lost)

    unknown = without(vbp)
    far = moving("far", way, ego.t_s, 260 + 4 * ego.t_s, way.own)
    for actors in ([ego, unknown, ov], [ego, unknown, ov, far]):
        (found,) = one(actors, way, "overtake")
        assert (found["vbp_id"], found["vbp_placed"], found["vbp_gap_m"]) == ("vbp", False, None)
    distant = moving("vbp", way, ego.t_s, 260 + 0.1 * ego.t_s, way.own)  # 105 m ahead at t0, and passed
    unknown = without(distant)
    assert [row["vbp_placed"] for row in one([ego, unknown, ov], way, "overtake")] == [False]
    beside = moving("vbp", way, ego.t_s, 140 + 4 * ego.t_s, way.own - 8 * way.over)
    unknown = without(beside)
    assert not one([ego, unknown, ov], way, "overtake")


@pytest.mark.ci
def test_who_comes_into_the_log_later_and_is_passed_was_there() -> None:
    way, (ego, vbp, ov) = scene()
    (whole,) = one([ego, vbp, ov], way, "overtake")
    late = vbp.keep(vbp.t_s * 1e9 > whole["t0_ns"] + 3e8)
    far = moving("vbp", way, ego.t_s, 230 + 1 * ego.t_s, way.own)
    for actor in (late, far.keep(far.t_s * 1e9 > whole["t0_ns"] + 3e8)):
        (found,) = one([ego, actor, ov], way, "overtake")
        assert (found["vbp_id"], found["vbp_placed"], found["vbp_gap_m"]) == ("vbp", False, None)
        assert (found["t0_ns"], found["passed"]) == (whole["t0_ns"], True)


@pytest.mark.parametrize("stops", [False, True])
def test_who_comes_into_the_log_later_towards_the_ego_is_not_overtaken(stops: bool) -> None:
    """The vehicle ahead is 105 m away and is passed; the oncoming one appears over the end of the map after t0, and may stop later."""
    way, (ego, _, _) = scene()
    t = ego.t_s
    far = moving("vbp", way, t, 260 + 0.1 * t, way.own)
    way_s = 590 - 9 * (np.minimum(t, 20) if stops else t)
    late = moving("ov", way, t, way_s, way.other).keep(t > 9.0)
    con = derived(drive([ego, far, late], way.environment), tables=["overtake", "unplaced"])
    found = rows(con, "FROM overtake")
    assert found[0]["t0_ns"] < 9e9
    assert rows(con, f"FROM unplaced WHERE object_id = 'ov' AND t_ns = {found[0]['t0_ns']}")
    assert [(row["vbp_id"], row["vbp_placed"]) for row in found] == [("vbp", True)]


@pytest.mark.ci
def test_what_may_be_an_overtake_is_not_surely_one() -> None:
    """The ego passes somebody, turns back behind it, or sways over the line for an oncoming car while one ahead is lost."""
    way, (ego, vbp, ov) = scene()
    (whole,) = one([ego, vbp, ov], way, "overtake")
    assert whole["sure"]
    _, aborted = scene(abort=True)
    assert [(row["sure"], row["status"]) for row in one(aborted, way, "overtake")] == [(True, "aborted")]
    late = vbp.keep(vbp.t_s * 1e9 > whole["t0_ns"] + 3e8)
    assert [(row["sure"], row["vbp_placed"]) for row in one([ego, late, ov], way, "overtake")] == [(True, False)]
    s = 50 + 12 * ego.t_s
    sways = moving("ego", way, ego.t_s, s, swing(way, s, 150, 190, share=0.4))
    lost = moving("vbp", way, ego.t_s, 80 + 12 * ego.t_s, way.own).keep(ego.t_s < 8.0)
    con = derived(drive([sways, lost, ov], way.environment), tables=["overtake_step"])
    assert {(row["vbp_id"], row["sure"]) for row in rows(con, "FROM overtake_step")} == {("vbp", False)}
    # one that stays astride for 3 s has pulled out, whoever is placed only later
    astride = moving("ego", way, ego.t_s, s, swing(way, s, 150, 240, share=0.4)).keep(ego.t_s >= 9.9)
    con = derived(drive([astride, vbp, ov], way.environment), tables=["overtake"])
    assert [(row["begin_seen"], row["sure"]) for row in rows(con, "FROM overtake")] == [(False, True)]
    found = scenes.judged([drive([sways, lost, ov], way.environment)], rules=["ukhc.r126.ds*"])
    assert not [row["reason"] for row in found if row["verdict"] == "fail"]


def test_a_wobble_over_the_line_is_an_excursion_and_nothing_else() -> None:
    way, (ego, vbp, ov) = scene()
    d = swing(way, ego.x, 70, 100, share=0.28)  # 0.1 m over
    con = derived(
        drive([moving("ego", way, ego.t_s, ego.x, d), vbp, ov], way.environment),
        tables=["overtake", "lane_departure", "excursion"],
    )
    (found,) = rows(con, "FROM excursion")
    assert 0.05 < found["max_out_m"] < 0.3
    assert found["centre_over"] is False
    assert not rows(con, "FROM overtake")
    assert not rows(con, "FROM lane_departure")


def safe_distance(  # noqa: PLR0917 - the formula's own symbols
    w: float, beta: float, theta: float, k: float, v_av: float, v_vbp: float, v_ov: float
) -> float:
    """MISSION.md, Numbers: the paper's Appendix A, written out once more."""
    pull = w / (v_av * math.sin(beta))
    passing = (k + (v_vbp - v_av * math.cos(beta)) * pull) / (v_av - v_vbp)
    cut = w / (v_av * math.sin(theta))
    mph = v_ov / MPH
    stopping = 0.300 * mph + (0.058 - 0.011 * mph + 0.015 * mph**2)
    return w / math.tan(beta) + v_av * passing + w / math.tan(theta) + stopping + v_ov * (pull + passing + cut)


@pytest.mark.ci
@settings(max_examples=8, deadline=None)
@example(
    14.5, 13.5, 17.0, 8.0, 12.0
)  # drawn once: on its way out over the lane the ego is a little faster, which is enough
@given(st.floats(5, 30), st.floats(0, 25), st.floats(1, 30), st.floats(3.8, 18.0), st.floats(3.5, 12))
def test_safe_distance_ahead_is_the_papers_formula(
    v_av: float, v_vbp: float, v_ov: float, l_av: float, l_vbp: float
) -> None:
    """Speeds and lengths as drawn, moved over a line within a straight road; angles and gaps of every profile."""
    assume(abs(v_av - v_vbp) > 0.5)
    way = road(((2000.0, 0.0),))
    t = times(6.0)
    s = 600 + v_av * t
    ego = moving("ego", way, t, s, swing(way, s, 600 + 2 * v_av, None, change=3 * v_av), length=l_av)
    vbp = moving("vbp", way, t, 600 + 2 * v_av + 40 + v_vbp * (t - 2), way.own, length=l_vbp)
    ov = moving("ov", way, t, 1900 - v_ov * t, way.other)
    con = derived(drive([ego, vbp, ov], way.environment), tables=["overtake_sda"])
    (o,) = rows(con, "FROM overtake")
    assert (o["l_av_m"], o["l_vbp_m"]) == pytest.approx((l_av, l_vbp))
    for row in rows(con, "SELECT * FROM overtake_sda JOIN profile USING (profile)"):
        if row["profile"] == "observed" or o["v_av_mps"] <= o["v_vbp_mps"]:
            assert row["sda_m"] is None
            assert row["zone"] is None
            cut_short = ("the log ends before the overtake is complete", "the overtake was aborted")
            assert sentence(row["reason"]).startswith(cut_short if v_av > v_vbp else "undefined")
            continue
        k = row["pull_out_headroom_m"] + l_vbp + row["cut_in_clearance_m"] + l_av
        expected = safe_distance(
            LANE, row["pull_out_angle_rad"], row["cut_in_angle_rad"], k, o["v_av_mps"], o["v_vbp_mps"], o["v_ov_mps"]
        )
        assert row["sda_m"] == pytest.approx(expected, rel=1e-9)
        assert sum_of_parts(row) == pytest.approx(expected, rel=1e-9)
        assert row["pull_out_m"] == pytest.approx(LANE / math.tan(row["pull_out_angle_rad"]))
        assert row["cut_in_m"] == pytest.approx(LANE / math.tan(row["cut_in_angle_rad"]))
        assert row["covered_m"] is None
        # the two come nearer to each other by what both drive
        manoeuvre = row["pull_out_m"] / math.cos(row["pull_out_angle_rad"]) + row["cut_in_m"] / math.cos(
            row["cut_in_angle_rad"]
        )
        seconds_out = (manoeuvre + row["passing_m"]) / o["v_av_mps"]
        assert row["oncoming_m"] == pytest.approx(o["v_ov_mps"] * seconds_out)
        spare = o["da_m"] - expected
        assert row["spare_m"] == pytest.approx(spare)
        assert row["spare_s"] == pytest.approx(spare / (o["v_av_mps"] + o["v_ov_mps"]))
        seconds = spare / (o["v_av_mps"] + o["v_ov_mps"])
        if '"may_speed_up"' in (row["reason"] or ""):
            assert spare <= 0
            assert row["zone"] is None
            continue
        assert row["zone"] == ("A" if spare <= 0 else "B" if seconds < 0.5 else "C" if seconds <= 2.5 else "D")


def sum_of_parts(row: dict[str, Any]) -> float:
    """What is required, from its parts: NULL is none."""
    names = ("pull_out_m", "passing_m", "cut_in_m", "oncoming_m", "covered_m", "stopping_m")
    return sum(row[name] or 0.0 for name in names)


def test_the_observed_profile_takes_what_this_overtake_had() -> None:
    way, actors = scene()
    con = derived(drive(actors, way.environment), tables=["overtake_sda"])
    (o,) = rows(con, "FROM overtake")
    (row,) = rows(con, "FROM overtake_sda WHERE profile = 'observed'")
    k = o["vbp_gap_m"] + o["l_vbp_m"] + o["t2_gap_m"] + o["l_av_m"]
    angles = o["pull_out_angle_rad"], o["cut_in_angle_rad"]
    made = np.cumsum(np.hypot(np.diff(actors[0].x), np.diff(actors[0].y)))
    k0, k3 = round(o["t0_ns"] / 1e8), round(o["t3_ns"] / 1e8)
    mean = (made[k3 - 1] - made[k0 - 1]) / (0.1 * (k3 - k0))
    expected = safe_distance(LANE, *angles, k, mean, o["v_vbp_mps"], o["v_ov_mps"])
    assert row["sda_m"] == pytest.approx(expected, rel=1e-6)
    assert sum_of_parts(row) == pytest.approx(row["sda_m"], rel=1e-9)


@pytest.mark.parametrize(("far", "verdict"), [(700.0, ("unknown", "pass")), (200.0, ("fail", "fail"))])
@pytest.mark.parametrize("hand", ["rht", "lht"])
def test_an_ego_that_speeds_up_to_overtake_is_not_held_to_its_speed_at_the_start(
    hand: str, far: float, verdict: tuple[str, str]
) -> None:
    """It pulls out at 9.5 m/s behind a tractor at 9 m/s, and is past it in some ten seconds: at 9.5 m/s it would take a minute."""
    found = _judged_speeding_up(hand, far, until_s=40.0)
    assert (found["nominal"]["verdict"], found["observed"]["verdict"]) == verdict
    assert ("its mean speed" in found["nominal"]["reason"]) == (verdict[0] == "unknown")


@pytest.mark.parametrize("until_s", [20.0, 13.0], ids=["it has sped up", "it has not yet sped up"])
@pytest.mark.parametrize(("far", "verdict"), [(700.0, "unknown"), (120.0, "fail")])
def test_nor_is_one_that_is_still_out_when_the_log_ends(far: float, verdict: str, until_s: float) -> None:
    found = _judged_speeding_up("lht", far, until_s)
    assert found["nominal"]["verdict"] == verdict
    assert ("until it was back" in found["nominal"]["reason"]) == (verdict == "unknown")


@pytest.mark.parametrize("until_s", [12.0, 14.0, 17.0])
def test_how_fast_it_could_still_have_been_is_that_of_full_acceleration_up_to_the_limit(until_s: float) -> None:
    """Held against an ego that speeds up step by step, for every mean speed in steps of 0.01 m/s."""
    con = derived(_speeding_up("lht", 700.0, until_s), tables=["overtake_sda"])
    (o,) = rows(con, "FROM overtake")
    (nominal,) = rows(con, "FROM profile WHERE profile = 'nominal'")
    (row,) = rows(con, "FROM overtake_sda WHERE profile = 'nominal'")
    ego = rows(con, f"SELECT t_ns, speed_mps, travel_m FROM ego_state WHERE t_ns >= {o['t0_ns']} ORDER BY t_ns")
    dt = 0.001
    v = np.minimum(ego[-1]["speed_mps"] + 3.5 * dt * np.arange(200_000), 60 * MPH)
    way = ego[-1]["travel_m"] - ego[0]["travel_m"] + np.concatenate([[0.0], np.cumsum(v[:-1] * dt)])
    gone_s = (ego[-1]["t_ns"] - ego[0]["t_ns"]) / 1e9
    k = nominal["pull_out_headroom_m"] + o["l_vbp_m"] + nominal["cut_in_clearance_m"] + o["l_av_m"]
    angles = nominal["pull_out_angle_rad"], nominal["cut_in_angle_rad"]

    def is_within_reach(mean: float) -> bool:
        pull, cut = (LANE / (mean * math.sin(angle)) for angle in angles)
        passing = (k + (o["v_vbp_mps"] - mean * math.cos(angles[0])) * pull) / (mean - o["v_vbp_mps"])
        needed = max(pull + passing + cut, gone_s)
        return bool(mean * needed <= way[round((needed - gone_s) / dt)])

    most = max(v for v in np.arange(o["v_av_mps"] + 0.01, 60 * MPH, 0.01) if is_within_reach(v))
    told = json.loads(row["reason"])["args"]
    assert most - (60 * MPH - o["v_av_mps"]) / 64 - 0.02 <= told["v_later_mps"] <= most + 0.02
    expected = safe_distance(LANE, *angles, k, told["v_later_mps"], o["v_vbp_mps"], o["v_ov_mps"])
    assert told["later_sda_m"] == pytest.approx(expected, rel=1e-6)


def _judged_speeding_up(hand: str, far: float, until_s: float) -> dict[str, Row]:
    return {row["profile"]: row for row in scenes.judged([_speeding_up(hand, far, until_s)], rules=[SDA])}


def _speeding_up(hand: str, far: float, until_s: float) -> Drive:
    """It pulls out at 10 s with 9.5 m/s, and speeds up by 2 m/s2 from 14 s on."""
    way, t = road(((3000.0, 0.0),), hand), times(40.0)
    v = np.clip(9.5 + 2.0 * (t - 14), 9.5, 25.0)
    s = 50 + np.concatenate([[0.0], np.cumsum((v[1:] + v[:-1]) / 2 * np.diff(t))])
    out = float(np.interp(10.0, t, s))
    back = float(np.interp(22.0, t, s))
    seen = slice(0, round(until_s / 0.1))
    ego = moving("ego", way, t[seen], s[seen], swing(way, s, out, back)[seen])
    vbp = moving("vbp", way, t[seen], (out + 20 + 9 * (t - 10))[seen], way.own)
    ov = moving("ov", way, t[seen], (out + far + 25 * (10 - t))[seen], way.other)
    return drive([ego, vbp, ov], way.environment)


@pytest.mark.sample(0, ci=1)
@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize("beside", ["parked", "cyclist", "horse"])
def test_of_several_that_come_the_worst_counts(beside: str, hand: str) -> None:
    """A cyclist or a horse that comes slowly is met first: it counts. A car parked at the opposing kerb does not. Neither hides anybody."""
    way, (ego, vbp, ov) = scene(hand)
    t = ego.t_s
    edge_d = way.other + np.sign(way.other) * 1.2
    others = {
        "parked": standing("near", way, t, 330.0, edge_d, turned=math.pi),
        "cyclist": moving("near", way, t, 400 - 3 * t, edge_d, kind="bicycle", length=1.8, width=0.6),
        "horse": moving("near", way, t, 400 - 3 * t, way.other, kind="animal", length=2.4, width=0.8),
    }
    near, fast = others[beside], moving("fast", way, t, 560 - 8 * t, way.other)
    told = [drive([ego, vbp, *who], way.environment) for who in ([near], [ov], [fast], [near, ov, fast])]
    sda = [
        {row["profile"]: row for row in rows(derived(d, tables=["overtake_sda"]), "FROM overtake_sda")} for d in told
    ]
    for profile, row in sda[-1].items():
        alone = [each[profile] for each in sda[:-1]]
        assert [each["ov_id"] for each in alone] == [None if beside == "parked" else "near", "ov", "fast"]
        least, worst = min((each["spare_m"], each["ov_id"]) for each in alone if each["ov_id"] is not None)
        assert (row["spare_m"], row["ov_id"]) == (pytest.approx(least), worst)
    steps = [rows(derived(d, tables=["overtake_step"]), "FROM overtake_step ORDER BY t_ns") for d in told]
    for column in ("ov_in_ds_av_m", "av_in_ds_ov_m", "ds_overlap_m"):
        for *alone, together in zip(*steps, strict=True):
            seen = [row[column] for row in alone if row["ov_id"] is not None]
            assert together[column] == (pytest.approx(max(seen)) if seen else None)


def test_without_anybody_the_distance_is_a_bound_and_the_limit_is_assumed() -> None:
    """The road ends at 600 m; SDA is worked out for an oncoming vehicle at 60 mph."""
    way, (ego, vbp, _) = scene()
    con = derived(drive([ego, vbp], way.environment), tables=["overtake_sda"])
    (o,) = rows(con, "FROM overtake")
    assert (o["ov_id"], o["free_reason"]) == (None, "map_end")
    assert o["v_ov_mps"] == pytest.approx(60 * MPH)
    front = 50 + 12 * o["t0_ns"] / 1e9 + 2.4
    assert o["da_m"] == pytest.approx(600 - front, abs=0.2)
    for row in rows(con, "FROM overtake_sda"):
        assert row["at_least"]
        assert row["nobody"]


def test_an_unlimited_road_gives_no_speed_to_assume() -> None:
    way = road(limit_mph=None)
    _, (ego, vbp, _) = scene()
    found = one([ego, vbp], way, "overtake_sda")
    assert {row["sda_m"] for row in found} == {None}
    assert "no speed limit" in " ".join(sentence(row["reason"]) for row in found)


def spaces(a: Actor, k: int, reach: float, forward: int) -> tuple[Any, Any]:
    """Return an actor's box, turned as it is, and its danger space: from the middle of its front bumper along the road."""
    own = affinity.rotate(box(a.x[k] - 2.4, a.y[k] - 0.9, a.x[k] + 2.4, a.y[k] + 0.9), a.yaw[k], use_radians=True)
    x, y = a.x[k] + 2.4 * math.cos(a.yaw[k]), a.y[k] + 2.4 * math.sin(a.yaw[k])
    return own, box(min(x, x + forward * reach), y - 0.9, max(x, x + forward * reach), y + 0.9)


def depth_of(one: Any, two: Any) -> float:
    """How far one polygon must be moved to be clear of the other; negative: how far they are apart, along the axis that says most."""
    depths = []
    for edges in (np.diff(np.array(p.exterior.coords), axis=0) for p in (one, two)):
        for along in edges / np.linalg.norm(edges, axis=1)[:, None]:
            a, b = (np.array(p.exterior.coords) @ along for p in (one, two))
            depths.append(min(a.max() - b.min(), b.max() - a.min()))
    return float(min(depths))


def stopping(v: float) -> float:
    mph = v / MPH
    return 0.3 * mph + 0.058 - 0.011 * mph + 0.015 * mph**2


def test_danger_spaces_on_a_straight_road_are_rectangles() -> None:
    """Inside each other by a positive amount exactly where the rectangles have an area in common."""
    way = road()
    t = times(30.0)
    s = 50 + 12 * t
    ego = moving("ego", way, t, s, swing(way, s, 150, 280))
    vbp = moving("vbp", way, t, 140 + 4 * t, way.own)
    ov = moving("ov", way, t, 480 - 9 * t, way.other)  # they meet while the ego is still out
    con = derived(drive([ego, vbp, ov], way.environment), tables=["overtake_step"])
    found = rows(con, "FROM overtake_step ORDER BY t_ns")
    (o,) = rows(con, "FROM overtake")
    assert found[0]["t_ns"] == o["t0_ns"]
    assert found[-1]["t_ns"] == o["t_end_ns"]
    seen = set()
    for row in found:
        k = round(row["t_ns"] / 1e8)
        sd_av, sd_ov = (stopping(math.hypot(a.vx[k], a.vy[k])) for a in (ego, ov))
        assert row["sd_av_m"] == pytest.approx(sd_av)
        stage = "pulling_out" if row["t_ns"] < o["t1_ns"] else "passing" if row["t_ns"] < o["t2_ns"] else "cutting_in"
        assert row["stage"] == stage
        av, ds_av = spaces(ego, k, sd_av, 1)
        passed, _ = spaces(vbp, k, 0, 1)
        other, ds_ov = spaces(ov, k, sd_ov, -1)
        pairs: list[tuple[str, Any, Any]] = [("vbp_in_ds_av_m", passed, ds_av)]
        if row["ov_id"] is not None:
            assert row["sd_ov_m"] == pytest.approx(sd_ov)
            pairs += [("ov_in_ds_av_m", other, ds_av), ("av_in_ds_ov_m", av, ds_ov), ("ds_overlap_m", ds_av, ds_ov)]
        for column, one_, two in pairs:
            depth = depth_of(one_, two)
            assert row[column] == pytest.approx(depth, abs=1e-6), (column, k)
            if abs(depth) > 1e-6:
                assert (row[column] > 0) is (one_.intersection(two).area > 0)
            if depth > 0:
                seen.add(column)
    assert seen == {"vbp_in_ds_av_m", "ov_in_ds_av_m", "av_in_ds_ov_m", "ds_overlap_m"}


def held_up(way: Road, t: NDArray[np.float64], speed: float = 10.0) -> list[Actor]:
    return [moving("ego", way, t, 50 + speed * t, way.own), moving("slow", way, t, 80 + speed * t, way.own)]


def test_an_opportunity_that_is_not_taken() -> None:
    """Held up for 20 s at 10 m/s under 60 mph, an empty road ahead; on a road of one way there is none."""
    way = road(((2000.0, 0.0),))
    t = times(20.0)
    found = one(held_up(way, t), way, "opportunity")
    assert {row["profile"] for row in found} == {"relaxed", "nominal", "aggressive"}
    for row in found:
        assert (row["object_id"], row["occurrence"], row["taken"]) == ("slow", 0, False)
        assert (row["t_start_ns"], row["t_end_ns"]) == (0, 20_000_000_000)
        assert row["zone"] == "D"
        assert row["t_best_ns"] is not None
    one_way = road(((2000.0, 0.0),), lanes=(0, 2))
    assert not one(held_up(one_way, t), one_way, "opportunity")


@pytest.mark.parametrize("rules", [("ukhc.r162.safe-distance-ahead", "ukhc.r126.ds-*")])
def test_the_rules_agree_with_the_tables(rules: tuple[str, ...]) -> None:
    way, actors = scene()
    verdicts = scenes.judged([drive(actors, way.environment)], rules=rules, profiles=["nominal"])
    assert {row["verdict"] for row in verdicts if "r162" in row["rule_id"]} == {"pass"}
    assert "error" not in {row["verdict"] for row in verdicts}


SDA = "ukhc.r162.safe-distance-ahead"


@pytest.mark.parametrize("then", ["end", "stand", "back"])
@pytest.mark.parametrize("hand", ["rht", "lht"])
def test_an_overtake_that_ends_in_a_head_on_crash_fails_by_default(hand: str, then: str) -> None:
    """The nominal plan is over in half of the time and has road enough; what was driven had not."""
    way = road(((2000.0, 0.0),), hand)
    found = {row["profile"]: row for row in scenes.judged([drive(crash(way, then), way.environment)], rules=[SDA])}
    assert {profile: row["verdict"] for profile, row in found.items()} == {"nominal": "pass", "observed": "fail"}
    assert found["nominal"]["margin"] > 100
    assert found["observed"]["observed"] == found["nominal"]["observed"]
    assert found["observed"]["margin"] < 0


@pytest.mark.parametrize("hand", ["rht", "lht"])
def test_what_was_driven_of_a_broken_off_overtake_is_the_least_that_it_needed(hand: str) -> None:
    way = road(((2000.0, 0.0),), hand)
    actors = crash(way, "end")
    con = derived(drive(actors, way.environment), tables=["overtake_sda"])
    (o,) = rows(con, "FROM overtake")
    (row,) = rows(con, "FROM overtake_sda WHERE profile = 'observed'")
    seconds = (o["t_end_ns"] - o["t0_ns"]) / 1e9
    front = {k: max(actors[0].x[k] + 2.4 * math.cos(actors[0].yaw[k]) + b * 0.9 * math.sin(actors[0].yaw[k]) for b in (1, -1))
             for k in (round(o["t0_ns"] / 1e8), round(o["t_end_ns"] / 1e8))}  # fmt: skip
    way_m = max(front.values()) - min(front.values())
    assert o["status"] == "truncated"
    assert row["sda_m"] == pytest.approx(way_m + 25 * seconds + stopping(25.0), abs=1e-6)
    assert row["zone"] == "A"
    assert "out of its lane" in sentence(row["reason"])


@pytest.mark.parametrize("end", [13.0, 15.0, 16.5])
def test_as_long_as_the_road_would_do_a_broken_off_overtake_is_unknown(end: float) -> None:
    way = road(((2000.0, 0.0),))
    actors = [a.keep(a.t_s < end + 0.05) for a in crash(way, "end")]
    found = {row["profile"]: row for row in scenes.judged([drive(actors, way.environment)], rules=[SDA])}
    assert {profile: row["verdict"] for profile, row in found.items()} == {"nominal": "pass", "observed": "unknown"}
    assert "the log ends before the overtake is complete" in found["observed"]["reason"]


def test_an_oncoming_vehicle_that_speeds_up_counts_with_the_way_that_it_made() -> None:
    """It comes at 5 m/s when the ego goes out, and at 35 m/s when they meet."""
    way = road(((2000.0, 0.0),))
    ego, vbp, _ = crash(way, "end")
    t = ego.t_s
    v = np.clip(5 + 12 * (t - 11), 5, 35)
    made = np.concatenate([[0.0], np.cumsum((v[1:] + v[:-1]) / 2 * np.diff(t))])
    ov = moving("ov", way, t, ego.x[-1] + 3 + made[-1] - made, way.other)
    (row,) = (r for r in one([ego, vbp, ov], way, "overtake_sda") if r["profile"] == "observed")
    assert row["da_m"] <= row["sda_m"]
    calm = moving("ov", way, t, ego.x[-1] + 3 + made[-1] - 5 * t, way.other)
    (row,) = (r for r in one([ego, vbp, calm], way, "overtake_sda") if r["profile"] == "observed")
    assert row["sda_m"] is None


@pytest.mark.ci
def test_a_profile_that_is_named_is_the_only_one() -> None:
    way, actors = scene()
    for asked in ([], ["relaxed"], ["nominal"], ["aggressive", "relaxed"]):
        found = scenes.judged([drive(actors, way.environment)], rules=[SDA], profiles=asked)
        assert {row["profile"] for row in found} == set(asked or ["nominal", "observed"])
