"""Time: speed and acceleration across holes, indicators."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.scenes import Actor, derived, drive, moving, road, rows, times


def straight(t: list[float] | np.ndarray, speed: float = 10.0, actor_id: str = "ego") -> Actor:
    """Drive at constant speed from the origin."""
    way = road()
    at = np.asarray(t, float)
    return moving(actor_id, way, at, 5 + speed * at, way.own)


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
