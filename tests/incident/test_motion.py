"""Slowing, gaps and closing speeds of motions that are known."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pyarrow as pa
import pytest

from drivelint.incident.motion import MotionOfParties, is_slowing_known, rows_of_seconds_table, slowing_periods
from drivelint.incident.parties import relative_speed_text
from tests.incident.straight import STEP_S, steps


def braking(at_s: float, mps2: float, lasts_s: float = 10.0) -> MotionOfParties:
    """Return an ego at 20 m/s that brakes from `at_s`; the moment is at 10 s."""
    t = np.arange(0, 10.05, STEP_S)
    v = np.maximum(20 - mps2 * np.clip(t - at_s, 0, lasts_s), 0.0)
    x = np.concatenate([[0.0], np.cumsum((v[1:] + v[:-1]) / 2 * STEP_S)])
    return MotionOfParties.of_steps(steps(v, x, 300.0), 10_000_000_000)


def test_when_and_how_hard() -> None:
    (found,) = slowing_periods(braking(at_s=7.0, mps2=4.0), 0, 0.0)
    assert found.start_s == pytest.approx(-3.0, abs=0.11)
    assert found.end_s == pytest.approx(0.0)
    assert (found.from_mps, found.to_mps) == pytest.approx((20.0, 8.0))
    assert found.hardest_mps2 == pytest.approx(4.0)
    assert found.mean_mps2 == pytest.approx(4.0, abs=0.15)


def test_slowing_that_began_before_the_recording() -> None:
    """The first half second of the recording is part of it, though nothing before tells how hard it was."""
    (found,) = slowing_periods(braking(at_s=-1.0, mps2=2.0, lasts_s=3.0), 0, 0.0)
    assert found.start_s == pytest.approx(-10.0)
    assert found.from_mps == pytest.approx(18.0)


def test_what_is_no_braking_and_what_is_over() -> None:
    assert slowing_periods(braking(at_s=2.0, mps2=0.9), 0, 0.0) == []
    (over,) = slowing_periods(braking(at_s=2.0, mps2=3.0, lasts_s=1.0), 0, 0.0)
    assert over.end_s == pytest.approx(-7.0, abs=0.41)
    assert slowing_periods(braking(at_s=9.0, mps2=6.0), 0, -1.0) == []  # nothing after the last step before a contact


def test_gap_closing_and_side() -> None:
    motion = braking(at_s=100.0, mps2=1.0)
    i = motion.nearest_step(-5.0)
    assert i is not None
    ahead = 300.0 - 100.0
    assert motion.gap[i] == pytest.approx(ahead - 4.0)
    assert motion.closing[i] == pytest.approx(20.0 * ahead / math.hypot(ahead, 1.0))
    assert motion.turn[i] == 0.0


def test_no_slowing_is_said_only_where_all_of_it_is_known() -> None:
    v = np.full(101, 20.0)
    x = np.arange(101) * 2.0
    assert is_slowing_known(MotionOfParties.of_steps(steps(v, x, 300.0), 10_000_000_000), 0, 0.0)
    v[50] = np.nan
    assert not is_slowing_known(MotionOfParties.of_steps(steps(v, x, 300.0), 10_000_000_000), 0, 0.0)
    short = MotionOfParties.of_steps(steps(np.full(4, 20.0), x[:4], 300.0), 300_000_000)
    assert not is_slowing_known(short, 0, 0.0)


def test_rows_that_the_log_does_not_have() -> None:
    rows = rows_of_seconds_table(braking(at_s=100.0, mps2=1.0), -0.1)
    assert [row["t"] for row in rows] == [float(t) for t in range(-10, 0)] + [-0.1, 0.0]
    assert [row["t"] for row in rows if row["last_before"]] == [-0.1]
    assert math.isnan(rows[0]["accel"][0])  # there is no second before


def test_unknown_is_no_number() -> None:
    v = np.full(101, 20.0)
    v[50] = np.nan
    motion = MotionOfParties.of_steps(steps(v, np.arange(101) * 2.0, 300.0), 10_000_000_000)
    assert math.isnan(motion.speed[0][50])
    assert math.isnan(motion.mean_acceleration_mps2(0, 55, 1.0))
    assert not math.isnan(motion.mean_acceleration_mps2(0, 65, 1.0))


def test_speed_lost_in_an_impact_is_no_braking() -> None:
    """A walker at 1.6 m/s stands from one step to the next: no mean of half a second tells how hard that was."""
    v = np.where(np.arange(101) * STEP_S < 9.85, 1.6, 0.0)
    motion = MotionOfParties.of_steps(steps(v, np.arange(101) * 0.16, 300.0), 10_000_000_000)
    (lost,) = slowing_periods(motion, 0, 0.0)
    assert lost.sudden
    assert (lost.start_s, lost.end_s) == pytest.approx((-0.2, -0.1))
    last = rows_of_seconds_table(motion, -0.1)[-1]
    assert last["impact"] == [True, False]
    assert last["hardest"][0] == 0.0  # what is left of that second: nobody braked


def test_hardest_braking_of_a_second_that_its_mean_hides() -> None:
    motion = braking(at_s=7.0, mps2=4.0, lasts_s=0.5)
    (row,) = [row for row in rows_of_seconds_table(motion, None) if row["t"] == -2.0]
    assert row["hardest"][0] == pytest.approx(4.0)
    assert row["accel"][0] == pytest.approx(-2.0)


def test_relative_speed_of_ways_that_cross() -> None:
    """Boxes side by side do not come nearer however fast they pass each other."""
    table = steps(np.full(101, 5.0), np.full(101, 300.0), 300.0, -5.0)
    motion = MotionOfParties.of_steps(table, 0)
    assert motion.relative[0] == pytest.approx(10.0)
    assert motion.closing[0] == pytest.approx(0.0, abs=1e-9)
    assert "relative speed 10.0 m/s" in relative_speed_text(10.0, 3.8)
    assert "approach at 3.8 m/s" in relative_speed_text(10.0, 3.8)
    assert "near" not in relative_speed_text(10.0, 9.9)
    assert relative_speed_text(math.nan, 3.8) == "relative speed not known"


def test_acceleration_is_the_change_of_the_signed_speed() -> None:
    """Who rolls back ever slower accelerates forwards."""
    v = np.minimum(-4.0 + np.arange(101) * STEP_S, 0.0)
    table = steps(v, np.cumsum(v) * STEP_S, 300.0)
    table = table.set_column(table.column_names.index("speed_mps"), "speed_mps", pa.array(np.abs(v)))
    rows = {row["t"]: row for row in rows_of_seconds_table(MotionOfParties.of_steps(table, 0), None)}
    assert rows[2.0]["speed"][0] == pytest.approx(-2.0)
    assert rows[2.0]["accel"][0] == pytest.approx(1.0)


def test_the_last_step_before_a_contact_is_one_at_which_the_boxes_are_apart() -> None:
    motion = MotionOfParties.of_steps(steps(np.full(10, 5.0), np.arange(10) * 0.5, 300.0), 900_000_000)
    gap = np.full(10, 1.0)
    gap[6:] = [0.2, -0.1, -0.2, -0.3]
    assert replace(motion, gap=gap).last_step_apart_before(0.0) == 6
    assert replace(motion, gap=np.full(10, -0.1)).last_step_apart_before(0.0) == 8
    gap[7] = np.nan  # it may have been apart
    assert replace(motion, gap=gap).last_step_apart_before(0.0) == 7
    assert motion.last_step_apart_before(-0.9) is None
