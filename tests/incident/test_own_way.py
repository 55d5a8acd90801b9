"""Without a map the ego's own way is its lane: an offset from the middle of it says nothing, and is left empty."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import drivelint
from drivelint.demo import ROAD_FILE
from drivelint.incident import IncidentRequest, judge_parties_again
from drivelint.incident.motion import MotionOfParties


@pytest.mark.ci
@pytest.mark.parametrize("has_map", [True, False])
def test_offsets_from_the_lane(tmp_path: Path, has_map: bool) -> None:
    drivelint.write_demo(tmp_path / "demo")
    result = drivelint.check(
        tmp_path / "demo" / "collision.mcap", map=tmp_path / "demo" / ROAD_FILE if has_map else None,
        rules="ukhc.no-collision", robustness=False, annotate=False, out=tmp_path / "out",
    )  # fmt: skip
    ways = [actor["path"] for row in result.scenes.rows() for actor in row["actors"] if actor["path"]]
    assert ways
    assert any(point["d_m"] is not None for way in ways for point in way) == has_map
    case = judge_parties_again(IncidentRequest(result.findings.rows()[0]["finding_id"], tmp_path / "out"))
    assert (
        any(np.isfinite(offset).any() for offset in MotionOfParties.of_steps(case.ego_rows.steps, 0).lane_offset)
        == has_map
    )
