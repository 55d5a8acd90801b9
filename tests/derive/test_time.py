"""Time: the step grid, holes, speed and acceleration, exposure, indicators."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from tests.report.synthetic import table
from tests.scenes import Actor, derived, drive, moving, road, rows, seconds, standing, times


def straight(t: list[float] | np.ndarray, speed: float = 10.0, actor_id: str = "ego") -> Actor:
    """Drive at constant speed from the origin."""
    way = road()
    at = np.asarray(t, float)
    return moving(actor_id, way, at, 5 + speed * at, way.own)


def test_steps_are_numbered_and_a_hole_begins_a_new_segment() -> None:
    """Median period 0.1 s: up to 2.5 periods are continuous, exactly 0.25 s among them, 0.26 s are a hole."""
    t = [0.0, 0.1, 0.2, 0.3, 0.4, 0.65, 0.75, 0.85, 1.11, 1.21]
    con = derived(drive([straight(t)], None), tables=["step"])
    (clock,) = rows(con, "FROM clock")
    assert (clock["period_ns"], clock["max_gap_ns"]) == (100_000_000, 250_000_000)
    assert (clock["t_start_ns"], clock["t_end_ns"]) == (0, 1_210_000_000)
    steps = rows(con, "FROM step ORDER BY k")
    assert [row["k"] for row in steps] == list(range(10))
    assert seconds(steps, "t_ns") == t
    assert [row["seg"] for row in steps] == [0] * 8 + [1, 1]
    assert steps[0]["dt_ns"] is None
    assert [row["dt_ns"] for row in steps[1:]] == [round((b - a) * 1e9) for a, b in pairwise(t)]
    assert steps[-1]["travel_m"] == pytest.approx(12.1)


def test_a_log_of_one_sample_has_one_step() -> None:
    single = straight([0.0, 0.1]).keep(np.array([True, False]))
    con = derived(drive([single], None), tables=["step"])
    assert [(row["k"], row["seg"], row["dt_ns"], row["travel_m"]) for row in rows(con, "FROM step")] == [
        (0, 0, None, 0.0)
    ]
    assert rows(con, "FROM clock")[0]["period_ns"] == 100_000_000


def test_way_made_counts_only_between_known_positions() -> None:
    """Samples 3 to 5 have no position: the way from 2 to 6 is not made up."""
    t = times(1.0)
    lost = straight(t).lost((t > 0.25) & (t < 0.55))
    con = derived(drive([lost], None), tables=["step"])
    assert rows(con, "SELECT max(travel_m) AS m FROM step")[0]["m"] == pytest.approx(10.0 - 4 * 1.0)


def test_acceleration_is_a_backward_difference_and_unknown_across_a_hole() -> None:
    t = np.array([0.0, 0.1, 0.2, 0.3, 0.9, 1.0])
    speed = np.array([1.0, 2.0, 4.0, 3.0, 9.0, 9.5])
    ego = replace(straight(t), vx=speed * 0.6, vy=speed * 0.8)
    con = derived(drive([ego], None), tables=["state_dynamics"])
    found = rows(con, "FROM state_dynamics ORDER BY t_ns")
    assert [row["speed_mps"] for row in found] == pytest.approx(list(speed))
    expected = [None, 10.0, 20.0, -10.0, None, 5.0]
    for row, value in zip(found, expected, strict=True):
        assert row["accel_mps2"] == (None if value is None else pytest.approx(value))


def test_an_unknown_velocity_leaves_speed_and_the_next_difference_unknown() -> None:
    ego = straight(times(0.4))
    ego = replace(ego, vx=np.where(np.arange(5) == 2, np.nan, ego.vx))
    found = rows(derived(drive([ego], None), tables=["state_dynamics"]), "FROM state_dynamics ORDER BY t_ns")
    assert [row["speed_mps"] is None for row in found] == [False, False, True, False, False]
    assert [row["accel_mps2"] is None for row in found] == [True, False, True, True, False]


def test_exposure_leaves_holes_out_of_the_hours() -> None:
    t = np.concatenate([times(10.0), times(30.0, 20.0)])
    con = derived(drive([straight(t)], None), tables=["exposure"])
    (found,) = rows(con, "FROM exposure")
    assert found["hours"] == pytest.approx(20.0 / 3600)
    assert found["km"] == pytest.approx(0.3)
    assert found["n_steps"] == 202


def test_every_ego_has_its_own_clock() -> None:
    a, b = straight(times(2.0)), straight(times(2.0, period=0.2), actor_id="second")
    con = derived(drive([a, b], None, egos=["ego", "second"]), tables=["step"])
    assert {(row["ego_id"], row["period_ns"]) for row in rows(con, "FROM clock")} == {
        ("ego", 100_000_000),
        ("second", 200_000_000),
    }


LIGHTS: list[tuple[str, list[tuple[str, float, float, bool]]]] = [
    ("--<<<--", [("left", 0.2, 0.4, False)]),
    ("<<-->>-", [("left", 0.0, 0.1, True), ("right", 0.4, 0.5, False)]),
    ("--<<>>-", [("left", 0.2, 0.3, False), ("right", 0.4, 0.5, False)]),
    ("--?<<--", [("left", 0.3, 0.4, True)]),  # what was before is not known, so neither is when it came on
    ("--<?<--", [("left", 0.2, 0.2, False), ("left", 0.4, 0.4, True)]),
    ("--!!!--", []),  # hazard lights are neither side
    ("-!<<!--", [("left", 0.2, 0.3, False)]),
    ("-<-<-<-", [("left", 0.1, 0.1, False), ("left", 0.3, 0.3, False), ("left", 0.5, 0.5, False)]),
    ("-----<<", [("left", 0.5, 0.6, False)]),
    ("???????", []),
]


@pytest.mark.parametrize(("lights", "expected"), LIGHTS)
def test_indicator_stretches(lights: str, expected: list[tuple[str, float, float, bool]]) -> None:
    words = {"-": "off", "<": "left", ">": "right", "!": "hazard", "?": None}
    ego = replace(straight(times(0.6)), indicator=tuple(words[c] for c in lights))
    found = rows(derived(drive([ego], None), tables=["indicator_on"]), "FROM indicator_on ORDER BY occurrence")
    assert [
        (row["side"], row["t_on_ns"] / 1e9, row["t_off_ns"] / 1e9, row["at_log_start"]) for row in found
    ] == expected
    assert [row["occurrence"] for row in found] == list(range(len(found)))


def test_a_hole_ends_a_stretch_and_its_next_beginning_is_not_known() -> None:
    t = np.concatenate([times(1.0), times(3.0, 2.0)])
    ego = replace(straight(t), indicator=("off",) * 5 + ("left",) * 17)
    found = rows(derived(drive([ego], None), tables=["indicator_on"]), "FROM indicator_on ORDER BY occurrence")
    assert [(row["t_on_ns"] / 1e9, row["t_off_ns"] / 1e9, row["at_log_start"]) for row in found] == [
        (0.5, 1.0, False),
        (2.0, 3.0, True),
    ]


def test_a_standing_vehicle_makes_no_way() -> None:
    way = road()
    con = derived(drive([standing("ego", way, times(5.0), 50, way.own)], None), tables=["exposure"])
    assert rows(con, "FROM exposure")[0]["km"] == 0


def test_an_actor_is_recorded_in_stretches_without_a_hole() -> None:
    """A hole of the log, a lost time and places that are not known end a stretch, whichever actor's they are."""
    t = times(5.0)
    ego, other = straight(t), straight(t, actor_id="x").lost((t > 2.95) & (t < 3.45)).keep((t < 1.05) | (t > 1.45))
    seen = drive([ego, other, straight(t, actor_id="never").lost(t >= 0)], None)
    lost = {"drive_id": "d", "check_id": "lost_time", "severity": "warning", "n": 1, "message": ""}
    lost |= {"t_first_ns": 4_000_000_000, "t_last_ns": 4_100_000_000}
    seen = replace(seen, trace=replace(seen.trace, tables={**seen.trace.tables, "quality": table("quality", [lost])}))
    found = rows(derived(seen, tables=["recorded"]), "FROM recorded ORDER BY actor_id, t_from_ns")
    assert [(row["actor_id"], row["t_from_ns"] / 1e9, row["t_to_ns"] / 1e9) for row in found] == [
        ("ego", 0.0, 4.0), ("ego", 4.1, 5.0),
        ("x", 0.0, 1.0), ("x", 1.5, 2.9), ("x", 3.5, 4.0), ("x", 4.1, 5.0),
    ]  # fmt: skip


def test_a_clock_that_jitters_leaves_no_hole_in_the_acceleration_of_the_lead() -> None:
    """Half a second is then a little longer, and four steps are a little shorter, than at an even clock."""
    way = road()
    t = times(4.0) + np.tile([0.0, 1e-5, -1e-5, 0.0, -1e-5, 1e-5, 0.0], 6)[:41]
    ego = moving("ego", way, t, 100 + 10 * t, way.own)
    lead = moving("x", way, t, 130 + 10 * t - t * t / 4, way.own + 1.5, kind="motorcycle", width=0.6)
    further = moving("y", way, t, 160 + 10 * t - t * t / 4, way.own)
    con = derived(drive([ego, lead, further], way.environment), tables=["lead", "vehicle_ahead"])
    for name, n in (("lead", 34), ("vehicle_ahead", 68)):
        found = rows(con, f"SELECT accel_mps2 FROM {name} WHERE t_ns > 650_000_000 AND object_id IS NOT NULL")
        assert [row["accel_mps2"] for row in found] == pytest.approx([-0.5] * n, abs=0.1)
