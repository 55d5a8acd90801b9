"""Where recorded drives were on the earth: every place in an annotated log against pyproj, from the log's own lines."""

from __future__ import annotations

import csv
import re
from typing import TYPE_CHECKING

import numpy as np
import pytest

from tests.annotate.runs import run, the
from tests.annotate.viewer import messages
from tests.road.earth import metres_apart
from tests.shared_data import shared

if TYPE_CHECKING:
    from pathlib import Path

LOGS = {
    "safe": ("overtake_case_study", "t_junction", "carla-testbench", None),
    "near_miss": ("overtake_case_study", "t_junction", "carla-testbench", None),
    "collision": ("overtake_case_study", "t_junction", "carla-testbench", None),
    "TEST003": ("cav_loop", "loop_geo_RHD", None, "116"),
}
"""Folder, map, mapping (None: the file beside the log) and ego of a log."""
MAP_OFFSET = {"t_junction": (2.618, 3.113), "loop_geo_RHD": (0.0, 0.0)}
"""What the study's authors add to the map's coordinates (m)."""


def ego_places(log: Path, ego: str | None) -> dict[int, tuple[float, float]]:
    """Return time (ns) and position (m, y to the left of x) of the ego's lines; without an id, it is agent number 1."""
    with log.open(newline="") as file:
        lines = [[cell.strip() for cell in line] for line in csv.reader(file)]
    head, *body = lines
    rows = [dict(zip(head, line, strict=False)) for line in body if len(line) >= len(head) and line[0]]
    mine = [row for row in rows if (row["agentNo"] == "1" if ego is None else row["agentID"] == ego)]
    return {round(float(row["time"]) * 1e9): (float(row["x"]), -float(row["y"])) for row in mine}


@pytest.mark.ci
@pytest.mark.sample(1)
@pytest.mark.parametrize("name", LOGS)
def test_a_recorded_drive_is_where_pyproj_puts_it(tmp_path: Path, name: str) -> None:
    pyproj = pytest.importorskip("pyproj")
    folder, road, mapping, ego = LOGS[name]
    log, network = shared(f"{folder}/{name}.csv"), shared(f"{folder}/{road}.xodr")
    at_hand = mapping or str(shared(f"{folder}/mapping.toml"))
    out = run(tmp_path, log, map=network, mapping=at_hand, ego=ego, handedness="lht", rules=("ukhc.no-collision",))
    reference = re.search(r"CDATA\[([^]]+)\]", network.read_text("utf-8"))
    assert reference
    to_earth = pyproj.Transformer.from_crs(reference[1].strip(), "EPSG:4326", always_xy=True)
    states = ego_places(log, ego)
    fixes = messages(the(out, name), "location")
    assert len(fixes) > 50
    times = np.array(sorted(states))
    x0, y0 = MAP_OFFSET[road]
    for fix in fixes:
        from_begin = times - times[0] - (fix.log_time - fixes[0].log_time)
        nearest = np.abs(from_begin).argmin()
        assert abs(from_begin[nearest]) < 2_000_000
        x, y = states[int(times[nearest])]
        there = to_earth.transform(x - x0, y - y0)
        assert metres_apart((fix.content.longitude, fix.content.latitude), there) < 1.0
