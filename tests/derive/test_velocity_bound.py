"""A jolt of the recorded velocity has bounds: what was credible before and after it, and what tyres allow in between."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pyarrow as pa
import pytest

from drivelint.engine.batch import Drive
from tests.scenes import drive, moving, road, times, verdict_rows

if TYPE_CHECKING:
    from drivelint.engine.batch import Drive

T = times(4.0)
RULES = ("criticality.ttc", "criticality.drac", "criticality.ttb")


def doubted(scene: Drive, actor: str) -> Drive:
    """Return the drive with a doubt about an actor's velocity from 1.45 s to 2.55 s."""
    table = scene.trace.tables["doubt"]
    whom = {"drive_id": scene.trace.drive_id, "actor_id": actor, "quantity": "velocity", "code": "common_jolt"}
    row = {**whom, "t_from_ns": 1_450_000_000, "t_to_ns": 2_550_000_000}
    scene.trace.tables["doubt"] = pa.concat_tables([table, pa.Table.from_pylist([row], schema=table.schema)])
    return scene


def queue(hand: str, gap: float, speed: float) -> Drive:
    """Return an ego at 5 m/s behind a car whose velocity is recorded as half of it for one sample."""
    way = road(hand=hand)
    lead = moving("x", way, T, 104.8 + gap + speed * T, way.ego_d)
    lead.vx[20] *= 0.5
    return drive([moving("ego", way, T, 100 + 5 * T, way.ego_d), lead], way.environment)


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize(
    ("gap", "speed", "verdict"),
    [(12.0, 5.0, "pass"), (3.0, 5.0, "unknown"), (1.0, 1.0, "fail")],
)
def test_a_jolt_decides_only_where_its_bounds_do(hand: str, gap: float, speed: float, verdict: str) -> None:
    """Behind a car at the same speed, near or far, and so near to a slow one that it is hit before the jolt is over."""
    told = queue(hand, gap, speed)
    found = verdict_rows([doubted(told, "x")], rules=RULES)
    assert {row["rule_id"]: row["verdict"] for row in found if row["object_id"] == "x"} == dict.fromkeys(RULES, verdict)
