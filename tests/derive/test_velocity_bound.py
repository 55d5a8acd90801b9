"""A jolt of the recorded velocity has bounds: what was credible before and after it, and what tyres allow in between."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa
import pytest

from drivelint.engine.batch import Drive
from tests.scenes import derived, drive, judged, moving, road, rows, times

if TYPE_CHECKING:
    from drivelint.engine.batch import Drive

T = times(4.0)
RULES = ("criticality.ttc", "criticality.drac", "criticality.ttb")


def doubted(told: Drive, actor: str, code: str = "common_jolt", span: tuple[float, float] = (1.45, 2.55)) -> Drive:
    """Return the drive with a doubt about an actor's velocity in this span."""
    table = told.trace.tables["doubt"]
    whom = {"drive_id": told.trace.drive_id, "actor_id": actor, "quantity": "velocity", "code": code}
    row = {**whom, "t_from_ns": round(span[0] * 1e9), "t_to_ns": round(span[1] * 1e9)}
    told.trace.tables["doubt"] = pa.concat_tables([table, pa.Table.from_pylist([row], schema=table.schema)])
    return told


def queue(hand: str = "rht", gap: float = 12.0, *, jolt: float = 0.5, speed: float = 5.0) -> Drive:
    """Return an ego at 5 m/s behind a car whose velocity is recorded as that share of it for one sample."""
    way = road(hand=hand)
    lead = moving("x", way, T, 104.8 + gap + speed * T, way.own)
    lead.vx[20] *= jolt
    return drive([moving("ego", way, T, 100 + 5 * T, way.own), lead], way.environment)


@pytest.mark.parametrize(
    ("code", "span"), [("velocity_bias", (1.45, 2.55)), ("common_jolt", (2.95, 4.0)), ("common_jolt", (0, 1.05))]
)
def test_what_is_no_jolt_or_has_no_end_in_the_log_has_no_bounds(code: str, span: tuple[float, float]) -> None:
    con = derived(doubted(queue(), "x", code, span), tables=["velocity_bound", "vehicle_ahead"])
    assert {(row["least_mps"], row["most_mps"]) for row in rows(con, "FROM velocity_bound")} == {(None, None)}
    ahead = rows(con, "FROM vehicle_ahead WHERE closing_more_mps + closing_less_mps > 0")
    assert {(row["closing_more_mps"], row["closing_less_mps"]) for row in ahead} == {(np.inf, np.inf)}


@pytest.mark.parametrize("toward", [False, True])
def test_closing_in_has_the_bounds_of_both(toward: bool) -> None:
    way = road()
    other = moving("x", way, T, 300 - 5 * T if toward else 120 + 5 * T, way.own)
    told = drive([moving("ego", way, T, 100 + 5 * T, way.own), other], way.environment)
    con = derived(doubted(doubted(told, "x"), "ego", span=(1.45, 2.05)), tables=["vehicle_ahead"])
    found = {row["t_ns"]: row for row in rows(con, "FROM vehicle_ahead WHERE nearest")}
    at = {k: (found[k * 10**8]["closing_more_mps"], found[k * 10**8]["closing_less_mps"]) for k in (10, 16, 24)}
    # at 1.6 s x has 2.4 m/s of room, and so has the ego; at 2.4 s x alone
    assert at[10] == (0, 0)
    assert at[16] == pytest.approx((4.8, 4.8))
    assert at[24] == pytest.approx((2.4, 2.4))


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize(
    ("gap", "speed", "verdict"),
    [(12.0, 5.0, "pass"), (3.0, 5.0, "unknown"), (1.0, 1.0, "fail")],
)
def test_a_jolt_decides_only_where_its_bounds_do(hand: str, gap: float, speed: float, verdict: str) -> None:
    """Behind a car at the same speed, near or far, and so near to a slow one that it is hit before the jolt is over."""
    told = queue(hand, gap, speed=speed)
    found = judged([doubted(told, "x")], rules=RULES)
    assert {row["rule_id"]: row["verdict"] for row in found if row["object_id"] == "x"} == dict.fromkeys(RULES, verdict)
