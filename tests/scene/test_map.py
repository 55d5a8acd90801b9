"""The map of a scene, as drivelint reads it."""

from __future__ import annotations

from pathlib import Path

import pytest

from drivelint.formats import load_map
from drivelint.road.map_reader import MapSource, MapTables
from tests.scene.scene_text import scene_of

SIDES = pytest.mark.parametrize(("side", "hand"), [("left", "lht"), ("right", "rht")])


def read(folder: Path, roads: str, side: str) -> MapTables:
    text = scene_of(folder, "{lane: main 1}", roads=roads, side=side).map_text
    return load_map(MapSource("map.xodr", text.encode()))


@SIDES
@pytest.mark.parametrize(
    ("roads", "lanes", "links"), [("country", 2, 0), ("town", 8 + 12, 24), ("ring", 8 + 4 + 12, 24)]
)
def test_a_map_is_read_without_a_doubt(  # noqa: PLR0917
    tmp_path: Path, side: str, hand: str, roads: str, lanes: int, links: int
) -> None:
    found = read(tmp_path, roads, side)
    assert found.handedness == hand
    assert found.tables["lanelet"].num_rows == lanes
    assert found.tables["lane_link"].num_rows == links
    doubts = found.tables["map_quality"].to_pylist()
    assert [row for row in doubts if row["severity"] != "info"] == []
