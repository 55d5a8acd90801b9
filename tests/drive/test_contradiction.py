"""What contradicts itself in a track is unknown: jumps, positions that stand while the velocity moves on, headings turned round."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.drive.actor_traces import WAY, T, checks, column, read, unknown
from tests.ingested import ingested
from tests.scenes import drive, moving, standing


def test_a_plain_track_stays_as_it_is() -> None:
    other = moving("x", WAY, T, 200 + 20 * T - 1.5 * T**2, WAY.ego_d)
    trace = read(other)
    assert not checks(trace)
    assert np.array_equal(column(trace, "yaw_rad"), other.yaw)
    assert not unknown(trace)


def test_one_sample_elsewhere_is_unknown_with_its_neighbours() -> None:
    other = moving("x", WAY, T, 200 + 10 * T, WAY.ego_d)
    away = replace(other, x=np.where(np.arange(len(T)) == 50, 0.0, other.x))
    trace = read(away)
    assert unknown(trace) == [49, 50, 51]
    assert "track_parted" not in checks(trace)


@pytest.mark.parametrize(("off_m", "upon"), [(0.0, True), (4.0, True), (9.0, False), (-600.0, False)])
@pytest.mark.parametrize("at", [50, 0, 99])
def test_a_sample_upon_another_actor_is_said(at: int, off_m: float, upon: bool) -> None:
    """Off the ego by so much: boxes of 4.8 m and 1.9 m overlap within 5.2 m between their middles at the most."""
    other = moving("x", WAY, T, 200 + 10 * T, WAY.ego_d)
    there = np.arange(len(T)) == at
    trace = read(replace(other, x=np.where(there, 100 + 10 * T + off_m, other.x)))
    said = [row for row in trace.tables["quality"].to_pylist() if row["check_id"] == "jumps_onto"]
    assert [(row["actor_id"], row["n"], row["t_first_ns"]) for row in said] == [("x", 1, at * 10**8)] * upon
    assert not upon or "overlaps ego" in said[0]["message"]


def test_the_ego_that_jumps_onto_another_is_said_and_a_parted_track_is_not_upon_itself() -> None:
    other, there = moving("x", WAY, T, 200 + 10 * T, WAY.ego_d), np.arange(len(T)) == 50
    ego = moving("ego", WAY, T, 100 + 10 * T, WAY.ego_d)
    trace = ingested(drive([replace(ego, x=np.where(there, other.x, ego.x)), other], WAY.environment)).trace
    assert {(r["check_id"], r["actor_id"]) for r in trace.tables["quality"].to_pylist()} >= {("jumps_onto", "ego")}
    parted = replace(other, y=other.y + 5.0 * (T > 4.95))
    trace = read(parted)
    assert "track_parted" in checks(trace)
    assert "jumps_onto" not in checks(trace)


@pytest.mark.parametrize("derived", [False, True])
def test_a_second_elsewhere_is_unknown(derived: bool) -> None:
    other = moving("x", WAY, T, 200 + 10 * T, WAY.ego_d)
    there = (T > 3.95) & (T < 5.05)
    away = replace(other, x=np.where(there, other.x + 80, other.x))
    if derived:
        away = replace(away, vx=np.full(len(T), np.nan), vy=np.full(len(T), np.nan))
    trace = read(away)
    assert set(range(39, 52)) <= set(unknown(trace)) <= set(range(37, 54))
    assert "track_parted" not in checks(trace)


def test_a_track_that_goes_on_elsewhere_is_another_actors() -> None:
    other = moving("x", WAY, T, 200 + 10 * T, WAY.ego_d)
    away = replace(other, x=np.where(T > 4.95, other.x + 300, other.x))
    trace = read(away)
    assert {"teleport", "track_parted"} <= checks(trace)
    assert trace.tables["actor"]["actor_id"].to_pylist() == ["ego", "x", "x#2"]
    assert {r["length_m"] for r in trace.tables["actor"].to_pylist()} == {4.8}
    assert len(column(trace, "x_m")) == 50
    assert np.nanmin(column(trace, "x_m", "x#2")) > 540
    # the ego that is named keeps its name
    trace = read(replace(away, actor_id="y"), egos=("y",))
    assert trace.tables["actor"]["actor_id"].to_pylist() == ["ego", "y"]


@pytest.mark.parametrize(
    ("ahead", "left", "same"), [(6.0, 0.0, True), (-6.0, 0.5, True), (14.0, 0.0, False), (0.0, 5.0, False)]
)
def test_a_place_put_right_along_the_lane_is_the_same_actor(ahead: float, left: float, same: bool) -> None:
    """At 5 s it is elsewhere from one sample to the next and drives on as before."""
    other, after = moving("x", WAY, T, 200 + 15 * T, WAY.ego_d), T > 4.95
    trace = read(replace(other, x=other.x + ahead * after, y=other.y + left * after))
    assert trace.tables["actor"]["actor_id"].to_pylist() == ["ego", "x", *([] if same else ["x#2"])]
    assert unknown(trace) == [49, 50] if same else not np.isfinite(column(trace, "x_m", "x")[49])


def test_positions_that_stand_while_the_velocity_moves_on_are_unknown() -> None:
    other = moving("x", WAY, T, 200 + 20 * T, WAY.ego_d)
    still = (T > 3.95) & (T < 6.05)
    frozen = replace(other, x=np.where(still, other.x[40], other.x))
    trace = read(frozen)
    assert set(range(41, 61)) <= set(unknown(trace))
    for_ever = replace(other, x=np.full(len(T), 300.0))
    assert len(unknown(read(for_ever))) == len(T)


def test_what_crashes_within_a_sample_is_known() -> None:
    """20 m/s are lost from one sample to the next; the velocity says so at once."""
    x = 200 + 20 * np.minimum(T, 5.0)
    v = np.where(T < 5.0, 20.0, 0.0)
    other = replace(moving("x", WAY, T, x, WAY.ego_d), vx=v)
    assert not unknown(read(other))


def test_noise_contradicts_nobody() -> None:
    rng = np.random.default_rng(1)
    other = moving("x", WAY, T, 200 + 10 * T, WAY.ego_d)
    noisy = replace(other, x=other.x + rng.normal(0, 0.3, len(T)), y=other.y + rng.normal(0, 0.3, len(T)))
    assert not unknown(read(noisy))
    parked = standing("x", WAY, T, 300.0, WAY.ego_d)
    trembling = replace(
        parked, x=parked.x + rng.normal(0, 0.1, len(T)), vx=np.full(len(T), np.nan), vy=np.full(len(T), np.nan)
    )
    trace = read(trembling)
    assert np.array_equal(column(trace, "yaw_rad"), trembling.yaw)


@given(st.integers(0, 90), st.integers(3, 100), st.floats(1.1, 30.0), st.sampled_from([1, -1]))
def test_a_heading_turned_round_is_turned_back(first: int, n: int, speed: float, sense: int) -> None:
    other = moving("x", WAY, T, 600 + sense * speed * T, WAY.ego_d)
    flip = (np.arange(len(T)) >= first) & (np.arange(len(T)) < first + n)
    if flip.all():
        return
    turned = read(replace(other, yaw=np.where(flip, other.yaw + np.pi, other.yaw)))
    off = np.abs(np.angle(np.exp(1j * (column(turned, "yaw_rad") - other.yaw))))
    assert off.max() < 1e-6


def test_who_reverses_keeps_the_heading() -> None:
    """Forwards at 5 m/s, to a standstill, back at 3 m/s."""
    s = 300 + np.where(T < 4, 5 * T, np.where(T < 6, 20.0, 20 - 3 * (T - 6)))
    other = replace(moving("x", WAY, T, s, WAY.ego_d), yaw=np.zeros(len(T)))
    trace = read(other)
    assert np.array_equal(column(trace, "yaw_rad"), np.zeros(len(T)))
    # nobody reverses at 12 m/s
    s = 500 + np.where(T < 4, 5 * T, np.where(T < 6, 20.0, 20 - 12 * (T - 6)))
    trace = read(replace(moving("x", WAY, T, s, WAY.ego_d), yaw=np.zeros(len(T))))
    assert np.abs(column(trace, "yaw_rad")[70:]) == pytest.approx(np.pi)


@pytest.mark.parametrize("later", [False, True])
def test_who_is_seen_to_set_off_backwards_may_be_fast(later: bool) -> None:
    """Forwards, a standstill, back at up to 11 m/s, gaining 3 m/s every second; or the other way about."""
    speed = np.where(T < 3, 6.0 - 2 * T, -np.clip(3 * (T - 4), 0, 11))
    if later:
        speed = -speed[::-1]
        speed = np.where(T[-1] - 3 < T, 2 * (T - T[-1] + 3), -np.clip(3 * (T[-1] - 4 - T), 0, 11))
    s = 500 + np.cumsum(speed) * 0.1
    other = replace(moving("x", WAY, T, s, WAY.ego_d), yaw=np.zeros(len(T)))
    assert np.array_equal(column(read(other), "yaw_rad"), np.zeros(len(T)))
    # with its box turned meanwhile it is a heading turned round
    back = replace(other, yaw=np.where(speed < -0.5, np.pi, 0.0))
    assert np.abs(column(read(back), "vx_mps")).max() > 10
    # nor is it reversing if nobody saw it go forwards
    alone = read(other.keep(speed <= 0))
    assert np.abs(column(alone, "yaw_rad")).max() == pytest.approx(np.pi)


def test_who_only_reverses_keeps_the_heading() -> None:
    """From a standstill back at up to 4 m/s: the ego alone, and beside another that drives forwards."""
    s = 300 - np.cumsum(np.clip(T - 2, 0, 4)) * 0.1
    back = replace(moving("ego", WAY, T, s, WAY.ego_d), yaw=np.zeros(len(T)))
    for company in ((), (moving("x", WAY, T, 200 + 10 * T, WAY.ego_d),)):
        trace = ingested(drive([back, *company], WAY.environment)).trace
        assert np.array_equal(column(trace, "yaw_rad", "ego"), np.zeros(len(T)))
        assert not {"yaw_mismatch", "heading_turned"} & set(trace.tables["quality"]["check_id"].to_pylist())


def test_a_heading_across_the_motion_is_unknown_unless_it_slides() -> None:
    other = moving("x", WAY, T, 200 + 15 * T, WAY.ego_d)
    across = replace(other, yaw=np.where((T > 3.95) & (T < 6.05), np.pi / 2, other.yaw))
    trace = read(across)
    assert np.flatnonzero(np.isnan(column(trace, "yaw_rad"))).tolist() == list(range(40, 61))
    assert not unknown(trace)
    slides = replace(other, yaw=np.clip(T - 4, 0, 1.2))
    assert not np.isnan(column(read(slides), "yaw_rad")).any()
