"""The huge logs and maps in small: every one is a sound log or map, so that only its size can be why it is refused."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from drivelint.drive.trace import IngestOptions
from drivelint.formats import load_map, read_trace
from drivelint.road.map_reader import MapSource
from tests.hostile import huge

if TYPE_CHECKING:
    from collections.abc import Callable


@pytest.mark.parametrize("name", huge.LOGS)
def test_a_crowd_is_read_whole(name: str, tmp_path: Path) -> None:
    log, *words = huge.LOGS[name](tmp_path, 30)
    said = dict(zip(words[::2], words[1::2], strict=True))
    trace = read_trace(Path(log), IngestOptions(mapping=said.get("--mapping"), ego=said.get("--ego")))
    assert trace.tables["actor_state"].num_rows == 60
    assert trace.tables["actor"].num_rows == 30


@pytest.mark.parametrize("make", [make for _, make in huge.MAPS.values()], ids=huge.MAPS)
def test_every_lane_of_a_road_network_is_built(make: Callable[..., str]) -> None:
    found = load_map(MapSource("huge", make(3, 4).encode()))
    assert found.tables["lanelet"].num_rows == 12
    assert not [row for row in found.tables["map_quality"].to_pylist() if row["severity"] == "error"]
