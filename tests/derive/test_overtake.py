"""The overtake: excursions, who is passed, its moments and how it ends, safe distance ahead, danger spaces, opportunities."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from shapely import affinity
from shapely.geometry import box

from drivelint.engine.batch import Drive
from drivelint.reasons.reason_text import sentence
from tests.derive.overtake_scene import scene
from tests.scenes import LANE, Actor, Road, derived, drive, moving, road, rows, standing, swing, times

MPH = 0.44704
Row = dict[str, Any]


def table_rows(actors: list[Actor], way: Road, table: str) -> list[Row]:
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
    (found,) = table_rows(actors, way, "overtake")
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
    vbp = moving("vbp", way, t, 600 + 2 * v_av + 40 + v_vbp * (t - 2), way.ego_d, length=l_vbp)
    ov = moving("ov", way, t, 1900 - v_ov * t, way.oncoming_d)
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


def _speeding_up(hand: str, far: float, until_s: float) -> Drive:
    """It pulls out at 10 s with 9.5 m/s, and speeds up by 2 m/s2 from 14 s on."""
    way, t = road(((3000.0, 0.0),), hand), times(40.0)
    v = np.clip(9.5 + 2.0 * (t - 14), 9.5, 25.0)
    s = 50 + np.concatenate([[0.0], np.cumsum((v[1:] + v[:-1]) / 2 * np.diff(t))])
    out = float(np.interp(10.0, t, s))
    back = float(np.interp(22.0, t, s))
    seen = slice(0, round(until_s / 0.1))
    ego = moving("ego", way, t[seen], s[seen], swing(way, s, out, back)[seen])
    vbp = moving("vbp", way, t[seen], (out + 20 + 9 * (t - 10))[seen], way.ego_d)
    ov = moving("ov", way, t[seen], (out + far + 25 * (10 - t))[seen], way.oncoming_d)
    return drive([ego, vbp, ov], way.environment)


@pytest.mark.sample(0, ci=1)
@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize("beside", ["parked", "cyclist", "horse"])
def test_of_several_that_come_the_worst_counts(beside: str, hand: str) -> None:
    """A cyclist or a horse that comes slowly is met first: it counts. A car parked at the opposing kerb does not. Neither hides anybody."""
    way, (ego, vbp, ov) = scene(hand)
    t = ego.t_s
    edge_d = way.oncoming_d + np.sign(way.oncoming_d) * 1.2
    others = {
        "parked": standing("near", way, t, 330.0, edge_d, turned=math.pi),
        "cyclist": moving("near", way, t, 400 - 3 * t, edge_d, kind="bicycle", length=1.8, width=0.6),
        "horse": moving("near", way, t, 400 - 3 * t, way.oncoming_d, kind="animal", length=2.4, width=0.8),
    }
    near, fast = others[beside], moving("fast", way, t, 560 - 8 * t, way.oncoming_d)
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


def spaces(a: Actor, k: int, reach: float, forward: int) -> tuple[Any, Any]:
    """Return an actor's box, turned as it is, and its danger space: from the middle of its front bumper along the road."""
    own = affinity.rotate(box(a.x[k] - 2.4, a.y[k] - 0.9, a.x[k] + 2.4, a.y[k] + 0.9), a.yaw[k], use_radians=True)
    x, y = a.x[k] + 2.4 * math.cos(a.yaw[k]), a.y[k] + 2.4 * math.sin(a.yaw[k])
    return own, box(min(x, x + forward * reach), y - 0.9, max(x, x + forward * reach), y + 0.9)


def depth_of(polygon: Any, other_polygon: Any) -> float:
    """How far one polygon must be moved to be clear of the other; negative: how far they are apart, along the axis that says most."""
    depths = []
    for edges in (np.diff(np.array(p.exterior.coords), axis=0) for p in (polygon, other_polygon)):
        for along in edges / np.linalg.norm(edges, axis=1)[:, None]:
            a, b = (np.array(p.exterior.coords) @ along for p in (polygon, other_polygon))
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
    vbp = moving("vbp", way, t, 140 + 4 * t, way.ego_d)
    ov = moving("ov", way, t, 480 - 9 * t, way.oncoming_d)  # they meet while the ego is still out
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
