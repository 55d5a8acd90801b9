"""A sighting that is in doubt bounds nothing: what is known of a hidden actor rests on the other sightings, or is not known."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pyarrow as pa
import pytest

from tests.scenes import drive, moving, road, times, verdict_rows

if TYPE_CHECKING:
    from drivelint.engine.batch import Drive

T = times(8.0)
HANDS = pytest.mark.parametrize("hand", ["rht", "lht"])
PLACES = pytest.mark.parametrize(
    ("quantity", "code"), [("position", "position_step"), ("existence", "held_track"), ("identity", "same_body")]
)


def doubted(scene: Drive, actor: str, quantity: str, code: str, span: tuple[float, float] = (0.0, 8.0)) -> Drive:
    """Return the drive with a doubt about a quantity of an actor in this span."""
    table = scene.trace.tables["doubt"]
    row = {
        "drive_id": scene.trace.drive_id,
        "actor_id": actor,
        "quantity": quantity,
        "code": code,
        "t_from_ns": round(span[0] * 1e9),
        "t_to_ns": round(span[1] * 1e9),
    }
    scene.trace.tables["doubt"] = pa.concat_tables([table, pa.Table.from_pylist([row], schema=table.schema)])
    return scene


@HANDS
@pytest.mark.parametrize(("quantity", "code"), [("position", "position_step"), ("identity", "same_body")])
def test_a_rule_does_not_pass_by_a_sighting_in_doubt(hand: str, quantity: str, code: str) -> None:
    """The car ahead is lost; only samples that are in doubt say that it had driven off before."""
    way = road(((1500.0, 0.0),), hand)
    s = 140 + 10 * T
    s[T > 1.95] += 20 * (T[T > 1.95] - 1.9) * 10
    other = moving("x", way, T, s, way.ego_d).keep(T < 2.55)
    ego = moving("ego", way, T, 100 + 10 * T, way.ego_d)
    rule = "ukhc.r126.stopping-gap"

    def late(scene: Drive) -> set[str]:
        return {
            row["verdict"]
            for row in verdict_rows([scene], rules=[rule])
            if row["t_end_ns"] is None or row["t_end_ns"] > 3e9
        }

    told = drive([ego, other], way.environment)
    told = doubted(told, "x", quantity, code, (1.95, 2.55))
    assert "unknown" in late(told)
    assert "pass" not in {
        row["verdict"] for row in verdict_rows([told], rules=[rule]) if (row["t_start_ns"] or 0) > 2.6e9
    }


@HANDS
@PLACES
def test_a_breach_that_rests_on_credible_samples_is_found(hand: str, quantity: str, code: str) -> None:
    """5 m behind a car at 10 m/s; another car's sightings are in doubt, and so are those of the first car later."""
    way = road(((1500.0, 0.0),), hand)
    lead = moving("x", way, T, 109.8 + 10 * T, way.ego_d).keep(T < 5.05)
    far = moving("y", way, T, 400 + 10 * T, way.ego_d).keep(T < 3.05)
    told = drive([moving("ego", way, T, 100 + 10 * T, way.ego_d), lead, far], way.environment)
    told = doubted(doubted(told, "y", quantity, code), "x", quantity, code, (4.05, 5.05))
    found = verdict_rows([told], rules=["ukhc.r126.stopping-gap"])
    assert "fail" in {row["verdict"] for row in found}
