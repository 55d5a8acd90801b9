"""The law behind `on_the`: which side of the road is driven on changes no verdict."""

from __future__ import annotations

import pytest

from tests.demo.scene_drive import drive_of_scene
from tests.demo.scenes import all_scenes
from tests.scenes import Row, verdict_rows

MIRRORED = ("near-miss", "collision-25mph", "signal-late", "overtake-two-in-one-go", "cyclist-at-1.0m")
SAME = ("rule_id", "profile", "object_id", "occurrence", "verdict", "reason_code", "t_ref_ns", "t_start_ns", "t_end_ns")


@pytest.mark.slow
def test_mirrored_scenes_have_the_same_verdicts() -> None:
    scenes = [scene for scene in all_scenes() if scene.name in MIRRORED]
    assert len(scenes) == len(MIRRORED)
    pairs = [[drive_of_scene(scene.driven_on_the(hand)) for hand in ("left", "right")] for scene in scenes]
    rows: dict[str, list[Row]] = {}
    for hand in (0, 1):  # the maps of a batch are those of its drives
        for row in verdict_rows([pair[hand] for pair in pairs], rules=["ukhc"], profiles=["relaxed", "nominal"]):
            rows.setdefault(row["drive_id"], []).append(row)
    for pair in pairs:
        one, other = (rows[each.trace.drive_id] for each in pair)
        assert [[row[c] for c in SAME] for row in one] == [[row[c] for c in SAME] for row in other]
        for a, b in zip(one, other, strict=True):
            assert (a["observed"] is None) == (b["observed"] is None)
            assert a["observed"] is None or a["observed"] == pytest.approx(b["observed"], abs=1e-3)
