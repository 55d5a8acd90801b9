"""How near an actor without a place can have been, from where it was seen before and where it is seen next."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.ingested import ingested
from tests.scenes import drive, moving, road, times, verdict_rows


@pytest.mark.parametrize("actor_id", ["ego", "b"])
@pytest.mark.parametrize(("off_m", "verdict"), [(1.0, "unknown"), (60.0, "pass")])
def test_who_jumps_onto_the_other_may_have_met_it(actor_id: str, off_m: float, verdict: str) -> None:
    """150 m apart all along, but for one sample that puts one of them upon, or near, the other."""
    way, t = road(((2000.0, 0.0),)), times(20.0)
    actors = {"ego": moving("ego", way, t, 100 + 10 * t, way.ego_d), "b": moving("b", way, t, 250 + 10 * t, way.ego_d)}
    other = actors["b" if actor_id == "ego" else "ego"]
    actors[actor_id] = replace(
        actors[actor_id], x=np.where(np.arange(len(t)) == 100, other.x + off_m, actors[actor_id].x)
    )
    scene = ingested(drive(list(actors.values()), way.environment))
    assert [row["verdict"] for row in verdict_rows([scene], rules=["ukhc.no-collision"])] == [verdict]
