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
