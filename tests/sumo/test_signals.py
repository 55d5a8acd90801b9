"""Lights with heads for single turns: whom SUMO lets go passes, who goes on its red fails."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.sumo import crossroads, world

if TYPE_CHECKING:
    from pathlib import Path

needs_sumo = pytest.mark.skipif(
    world.tool("sumo") is None or world.tool("netconvert") is None,
    reason="SUMO is not installed (pip install eclipse-sumo, or set SUMO_HOME)",
)


@needs_sumo
def test_heads_of_shared_lanes_are_those_of_the_turn(tmp_path: Path) -> None:
    crossroads.simulate(tmp_path, seconds=150, seed=1)
    for road in ("c.xodr", "c.net.xml"):
        found = crossroads.compared(tmp_path, road)
        assert set(found.lawful) == {"pass"}
        assert set(found.on_red) == {"fail"}
        assert min(found.lawful.total(), found.lawful_turns.total(), found.on_red.total()) >= 3
