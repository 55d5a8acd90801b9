"""Footways: a lane of which nobody knows what it is for may be one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.derive.marked import marked
from tests.scenes import derived, drive, moving, rows, times


@pytest.mark.parametrize(
    ("beyond", "depths"), [("sidewalk", "some"), ("shoulder", "none"), ("pavment", "not known"), ("driving", "none")]
)
def test_an_ego_on_a_lane_of_an_unknown_type_may_be_on_a_footway(beyond: str, depths: str) -> None:
    way = marked("rht", beyond=beyond)
    t = times(5.0)
    ego = moving("ego", way, t, 60 + 8 * t, way.own, length=4.5, width=1.8)
    aside = replace(ego, y=ego.y + np.sign(way.own) * 2.5)  # its right side is 1.6 m into the lane beyond
    found = rows(derived(drive([aside], way.environment), tables=["ego_footway"]), "FROM ego_footway")
    told = {"not known" if row["depth_m"] is None else "some" if row["depth_m"] > 0 else "none" for row in found}
    assert told == {depths}
