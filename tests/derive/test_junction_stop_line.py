"""The ego's front over a stop line: when, how slowly, and what the light showed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from tests.derive.junction_scenes import ARM, cross, lit, signal, stop_line
from tests.scenes import Actor, Road, derived, drive, moving, rows, seconds, times

if TYPE_CHECKING:
    from drivelint.engine.batch import Drive
    from tests.scenes import Row

LINE = 180.0


def lined(code: str | None = "206", hand: str = "rht", at: float = LINE, way: str = "we") -> Road:
    """Return a way over a stop line at s = 180 of road 1; a sign or light of this code stands 2 m before it."""
    t = -1.75 if hand == "rht" else 1.75
    signals: tuple[tuple[str, str], ...] = (("1", stop_line("line", LINE, t)),)
    if code:
        signals += (("1", signal("sign", at - 2, code)),)
    return cross(hand, signals)[way]


def going(way: Road, *, v: float = 8.0, s0: float = 120.0, end: float = 12.0, name: str = "ego") -> Actor:
    t = times(end)
    return moving(name, way, t, s0 + v * t, way.own)


def stopping(way: Road, at: float, stand: float, t_end: float = 30.0, v: float = 8.0) -> Actor:
    """Come at 8 m/s, brake at 2 m/s2, stand with the front `at` metres before the line, and go on."""
    t = times(t_end)
    target = LINE - 2.4 - at
    t0 = 6.0
    moved = np.clip(t - t0 + 4, 0, 4)
    s = target - 16 + v * moved - moved**2
    s = np.where(t < t0 - 4, target - 16 - v * (t0 - 4 - t), s)
    gone = np.clip(t - t0 - stand, 0, None)
    return moving("ego", way, t, s + gone**2, way.own)


def crossings(told: Drive) -> list[Row]:
    con = derived(told, tables=["stop_line_crossing"])
    return rows(con, "FROM stop_line_crossing ORDER BY drive_id, ego_id, occurrence")


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize(
    ("code", "control"), [("206", "stop"), ("205", "give_way"), ("1000001", "traffic_light"), (None, None)]
)
def test_driving_over_it(hand: str, code: str | None, control: str | None) -> None:
    way = lined(code, hand)
    (row,) = crossings(drive([going(way)], way.environment))
    assert (row["stop_line_id"], row["control"], row["signal_id"]) == ("line", control, "sign" if code else None)
    assert row["lanelet_id"] == ("1.0.-1" if hand == "rht" else "1.0.1")
    # the front is at 122.4 + 8 t
    assert row["t_ns"] / 1e9 == pytest.approx(7.2, abs=1e-9)
    assert row["begin_seen"] is True
    assert row["speed_mps"] == pytest.approx(8)
    assert row["slowest_mps"] == pytest.approx(8)
    assert 0 <= row["slowest_front_m"] <= 3
    assert (row["stood_s"], row["state"], row["t_state_ns"]) == (0.0, None, None)


def test_the_other_direction_and_the_other_lane_have_no_line() -> None:
    ways = cross("rht", (("1", stop_line("line", LINE, -1.75)),))
    assert not crossings(drive([going(ways["ew"], s0=180.0)], ways["ew"].environment))
    assert not crossings(drive([going(ways["sn"])], ways["sn"].environment))


def test_before_the_line_is_not_over_it() -> None:
    way = lined()
    assert not crossings(drive([going(way, end=7.0)], way.environment))


def test_a_log_that_begins_past_it_does_not_cross_it() -> None:
    way = lined()
    assert not crossings(drive([going(way, s0=LINE - 2.0)], way.environment))


@pytest.mark.parametrize(("gap", "n"), [((6.5, 7.4), 1), ((2.0, 11.0), 1)])
def test_a_hole_over_the_line_hides_the_moment_not_the_fact(gap: tuple[float, float], n: int) -> None:
    way = lined()
    ego = going(way, end=16.0)
    found = crossings(drive([ego.keep((ego.t_s < gap[0]) | (ego.t_s > gap[1]))], way.environment))
    assert [row["begin_seen"] for row in found] == [False] * n
    assert found[0]["t_ns"] / 1e9 == pytest.approx(gap[1] + 0.1)


@pytest.mark.parametrize(("at", "stand", "stood"), [(0.5, 4.0, 4.0), (0.5, 1.0, 1.0), (2.0, 4.0, 0.0)])
def test_standing_before_it(at: float, stand: float, stood: float) -> None:
    way = lined()
    (row,) = crossings(drive([stopping(way, at, stand)], way.environment))
    assert row["slowest_mps"] == pytest.approx(0, abs=0.05)
    assert row["slowest_front_m"] == pytest.approx(at, abs=0.02)
    assert row["stood_s"] == pytest.approx(stood, abs=0.21)


def test_standing_too_far_away_is_not_seen_near_it() -> None:
    way = lined()
    (row,) = crossings(drive([stopping(way, 4.0, 4.0)], way.environment))
    assert row["slowest_mps"] > 1.0
    assert row["stood_s"] == 0.0


def test_rolling_over_it_slowly_is_not_standing() -> None:
    way = lined()
    t = times(40)
    s = LINE - 2.4 - 10 + 0.5 * t
    (row,) = crossings(drive([moving("ego", way, t, s, way.own)], way.environment))
    assert row["slowest_mps"] == pytest.approx(0.5)
    assert row["stood_s"] == 0.0


def test_with_the_speed_unknown_before_the_line_nobody_knows_how_slow_it_was() -> None:
    way = lined()
    ego = stopping(way, 0.5, 4.0)
    hidden = (ego.t_s > 5) & (ego.t_s < 11)
    blind = Actor(**{**ego.__dict__, "vx": np.where(hidden, np.nan, ego.vx)})
    (row,) = crossings(drive([blind], way.environment))
    assert (row["slowest_mps"], row["slowest_front_m"], row["stood_s"]) == (None, None, None)


def test_too_fast_for_a_step_in_the_last_metres() -> None:
    """40 m/s at 10 Hz: four metres a step."""
    way = lined()
    t = times(5)
    (row,) = crossings(drive([moving("ego", way, t, 14.0 + 40 * t, way.own)], way.environment))
    assert row["slowest_mps"] == pytest.approx(40)
    assert row["slowest_front_m"] > 3


def test_trembling_on_the_line_is_one_crossing_and_backing_off_two() -> None:
    way = lined()
    t = times(30)
    wobble = 0.02 * np.sin(5 * t)
    s = np.interp(t, [0, 5, 15, 30], [LINE - 42.4, LINE - 2.4, LINE - 2.4, LINE + 60]) + wobble
    assert len(crossings(drive([moving("ego", way, t, s, way.own)], way.environment))) == 1
    s = np.interp(t, [0, 5, 10, 12, 30], [LINE - 42.4, LINE - 1.4, LINE - 3.4, LINE - 3.4, LINE + 60])
    found = crossings(drive([moving("ego", way, t, s, way.own)], way.environment))
    assert [row["occurrence"] for row in found] == [0, 1]


LIGHT = [(0.0, "green"), (4.0, "amber"), (7.0, "red"), (20.0, "red_amber"), (22.0, "green")]


@pytest.mark.parametrize(
    ("s0", "state", "before", "since", "onset"),
    [
        (150.0, "green", None, None, None),
        (130.0, "amber", "green", 4.0, 180 - 132.4 - 32),
        (120.0, "red", "amber", 7.0, 180 - 122.4 - 32),
        (4.0, "red_amber", "red", 20.0, None),
        (-8.0, "green", "red_amber", 22.0, None),
    ],
)
def test_what_the_light_showed(
    s0: float, state: str, before: str | None, since: float | None, onset: float | None
) -> None:
    way = lined("1000001")
    (row,) = crossings(lit(drive([going(way, s0=s0, end=25.0)], way.environment), "sign", *LIGHT))
    assert (row["state"], row["state_before"]) == (state, before)
    assert seconds([row], "t_state_ns") == [since]
    assert row["amber_front_m"] == (None if onset is None else pytest.approx(onset, abs=0.05))
    assert row["amber_speed_mps"] == (None if onset is None else pytest.approx(8))


def test_an_amber_whose_onset_was_not_seen() -> None:
    way = lined("1000001")
    (row,) = crossings(lit(drive([going(way)], way.environment), "sign", (5.0, "amber"), (9.0, "red")))
    assert (row["state"], row["state_before"], row["t_state_ns"], row["amber_front_m"]) == ("amber", None, None, None)


@pytest.mark.parametrize(
    ("states", "state"),
    [
        (((7.5, "red"),), None),  # the first word comes after the ego
        (((0.0, "red"), (5.0, None)), None),
        (((0.0, "red"), (5.0, None), (7.0, "green")), "green"),
        (tuple((0.1 * k, "red") for k in range(200)), "red"),
        (tuple((0.1 * k, "red") for k in range(60)), None),  # recorded ten times a second, and then no more
        (((0.0, "red"), (0.0, "green")), None),
        (
            ((0.0, "red"), (23.0, "red_amber"), (24.0, "green")),
            "red",
        ),  # said at its changes, two of them a second apart
        (((0.0, "red"), (0.1, "red"), (23.0, "red_amber"), (24.0, "green")), None),
    ],
)
def test_a_state_that_nobody_knows(states: tuple[tuple[float, str | None], ...], state: str | None) -> None:
    way = lined("1000001")
    (row,) = crossings(lit(drive([going(way)], way.environment), "sign", *states))
    assert row["state"] == state
    if state is None:
        assert (row["t_state_ns"], row["amber_front_m"]) == (None, None)


def test_of_two_lights_the_recorded_one() -> None:
    signals = (
        ("1", stop_line("line", LINE, -1.75)),
        ("1", signal("a", 180.0, "1000001")),
        ("10", signal("b", 29.0, "1000001")),
    )
    way = cross("rht", signals)["we"]
    told = lit(drive([going(way)], way.environment), "b", (0.0, "red"))
    (row,) = crossings(told)
    assert (row["signal_id"], row["state"]) == ("b", "red")
    (row,) = crossings(drive([going(way)], way.environment))
    assert (row["signal_id"], row["state"]) == ("a", None)


def test_a_light_without_a_line_is_its_own() -> None:
    """On the incoming road where it stands, inside the junction where that begins; two heads of one way in are one."""
    way = cross("rht", (("1", signal("near", 179.0, "1000001")), ("10", signal("far", 25.0, "1000001"))))["we"]
    (row,) = crossings(drive([going(way)], way.environment))
    assert (row["stop_line_id"], row["signal_id"], row["control"]) == ("near", "near", "traffic_light")
    assert row["t_ns"] / 1e9 == pytest.approx((179 - 122.4) / 8, abs=0.1)
    way = cross("rht", (("10", signal("far", 25.0, "1000001")),))["we"]
    (row,) = crossings(drive([going(way)], way.environment))
    assert row["t_ns"] / 1e9 == pytest.approx((ARM - 122.4) / 8, abs=0.1)
    assert row["stop_line_id"] == "far"


def test_a_signal_of_somewhere_else_does_not_govern_it() -> None:
    (row,) = crossings(drive([going(lined("206", at=148.0))], lined("206", at=148.0).environment))
    assert row["control"] is None
    far = cross("rht", (("1", stop_line("line", LINE, -1.75)), ("2", signal("next", 2.0, "206"))))["we"]
    (row,) = crossings(drive([going(far)], far.environment))
    assert row["control"] is None


def test_each_ego_and_drive_with_its_own_light() -> None:
    way = lined("1000001")
    ego, other = going(way), going(way, name="other", s0=110.0)
    one = lit(drive([ego, other], way.environment, egos=("ego", "other")), "sign", (0.0, "green"), (8.0, "red"))
    two = lit(drive([ego], way.environment, drive_id="e"), "sign", (0.0, "amber"))
    con = derived(one, two, tables=["stop_line_crossing"])
    found = rows(con, "FROM stop_line_crossing ORDER BY drive_id, ego_id")
    assert [(r["drive_id"], r["ego_id"], r["state"]) for r in found] == [
        ("d", "ego", "green"), ("d", "other", "red"), ("e", "ego", "amber"),
    ]  # fmt: skip
