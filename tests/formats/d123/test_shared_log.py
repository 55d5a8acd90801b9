"""A log of Argoverse 2 read through 123D is the published log, which a second reading holds (argoverse2/test_published.py)."""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import numpy as np
import pytest
import shapely

from drivelint.formats import expand_traces
from drivelint.formats.map_registry import load_map, read_source
from tests.formats.logs import actors, log, read, states
from tests.formats.maps import lanelets, links, points, values
from tests.shared_data import shared

LOG = "perception/d123/av2-sensor_val/adcf7d18-0510-35b0-a2fa-b4cea13a6d76"
SOURCE = "perception/av2/adcf7d18"
PLACE = ("x_m", "y_m", "z_m")
SIZE = ("length_m", "width_m", "height_m")


def test_everybody_is_where_and_as_fast_as_in_the_data_set() -> None:
    trace, source = read(shared(LOG)), read(shared(SOURCE))
    rows, expected = ({(r["actor_id"], r["t_ns"] // 1000): r for r in states(each)} for each in (trace, source))
    assert rows.keys() == expected.keys()
    assert len(rows) == 12_234
    for key, row in rows.items():
        assert [row[name] for name in PLACE] == pytest.approx([expected[key][name] for name in PLACE], abs=1e-3), key
        assert abs(math.remainder(row["yaw_rad"] - expected[key]["yaw_rad"], math.tau)) < 1e-6, key
    for key in [key for key in rows if key[0] == "ego"][5:-5]:
        velocity = [expected[key][name] for name in ("vx_mps", "vy_mps")]
        assert [rows[key][name] for name in ("vx_mps", "vy_mps")] == pytest.approx(velocity, abs=0.15)
    who, others = actors(trace), actors(source)
    for name, row in others.items():
        assert who[name]["actor_class"] == row["actor_class"]
        assert [who[name][side] for side in SIZE] == pytest.approx([row[side] for side in SIZE], abs=0.05)
    assert log(trace)["utc_start_ns"] is None


@cache
def maps() -> tuple[Any, Any]:
    (path,) = (shared(SOURCE) / "map").glob("log_map_archive_*.json")
    return load_map(read_source(shared(LOG) / "map.arrow")), load_map(read_source(path))


def test_lanes_are_those_of_the_data_set() -> None:
    found, expected = maps()
    columns = "lanelet_id lane_type left_id left_against right_id right_against"
    assert sorted(values(found, "lanelet", columns)) == sorted(values(expected, "lanelet", columns))
    inside = [{name for name, row in lanelets(each).items() if row["junction_id"]} for each in (found, expected)]
    assert inside[0] == inside[1]
    assert set(links(found)) == set(links(expected))
    marks = [set(values(each, "lane_boundary", "lanelet_id side marking")) for each in (found, expected)]
    assert marks[0] == marks[1]
    ours, theirs = points(found), points(expected)
    for name, way in theirs.items():
        for side in ("left", "right"):
            here, there = (np.array([[p[f"{side}_x_m"], p[f"{side}_y_m"]] for p in line]) for line in (ours[name], way))
            assert shapely.hausdorff_distance(shapely.LineString(here), shapely.LineString(there)) < 1e-3
        assert [ours[name][k]["z_m"] for k in (0, -1)] == pytest.approx([way[k]["z_m"] for k in (0, -1)], abs=0.02)


def test_the_log_is_found_and_lies_on_its_map() -> None:
    folder = shared(LOG)
    assert expand_traces([str(folder.parents[1])]) == [folder]
    assert read(folder).embedded_map == (folder / "map.arrow").read_bytes()
