"""Scenarios with anything in any place: they are read, or refused in one line; so are their maps."""

from __future__ import annotations

import copy
import pickle
import random
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from drivelint.errors import MapError, TraceError
from drivelint.formats import load_map
from drivelint.road.map_reader import MapSource
from tests.formats.logs import read
from tests.formats.scenarionet.scenario_file import boundary, lane, light, line, put, scenario, straight, track

JUNK: list[Any] = [
    None, 5, -1, 10**400, 1e308, float("nan"), float("inf"), True, "x", "", b"x", [], {}, (), [None], [[1.0], [2.0, 3.0]], [["a", "b"]],
    {"a": 1}, {1: 2}, np.zeros(0), np.zeros((0, 3)), np.zeros((2, 2, 2)), np.array(["a"]), np.array(7.0), np.full((5, 3), np.nan),
    np.full(21, np.inf), np.full((21, 3), 1e300), np.array([1, 2, 3], np.uint64), [(1.0, 2.0, 3.0)] * 3, [[1.0, 2.0]] * 3, np.float64(3.0),
]  # fmt: skip


def whole() -> dict[str, Any]:
    east = np.column_stack([np.arange(0.0, 101.0, 10.0), np.zeros(11), np.full(11, 2.0)])
    features = {
        "1": lane(
            east,
            left_boundaries=[boundary("l", 10)],
            right_boundaries=[boundary("r", 10)],
            exit_lanes=[2],
            speed_limit_mph=30.0,
        ),
        "2": lane(
            east + np.array([100.0, 0.0, 0.0]),
            entry_lanes=[1],
            polygon=[[99.0, -2.0], [201.0, -2.0], [201.0, 2.0], [99.0, 2.0]],
        ),
        "l": line(east + np.array([0.0, 1.8, 0.0])),
        "r": line(east - np.array([0.0, 1.8, 0.0]), "ROAD_EDGE_BOUNDARY"),
        "s": {"type": "STOP_SIGN", "lane": [1], "position": np.array([90.0, -4.0, 1.0])},
        "c": {
            "type": "CROSSWALK",
            "polygon": np.array([[50.0, -3.0, 0.0], [54.0, -3.0, 0.0], [54.0, 6.0, 0.0], [50.0, 6.0, 0.0]]),
        },
    }
    tracks = {
        "ego": track(straight(21, 10.0), length=1.73, width=4.08),
        "a": track(straight(21, 5.0, y=4.0), kind="CYCLIST"),
    }
    lights = {"1": light(["LANE_STATE_GO"] * 21, 1, (40.0, 0.3, 0.0))}
    return scenario(tracks, features=features, lights=lights, map="boston-seaport")


def places(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Return the way to every value inside a value."""
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    return [each for key, part in inner for each in [(*path, key), *places(part, (*path, key))]]


def with_junk(content: dict[str, Any], path: tuple[Any, ...], junk: Any) -> dict[str, Any]:
    changed = copy.deepcopy(content)
    at: Any = changed
    for key in path[:-1]:
        at = at[key]
    at[path[-1]] = junk
    return changed


CONTENT = whole()
PLACES = [path for path in places(CONTENT) if len(path) < 6]


@pytest.mark.sample(6, ci=24)
@pytest.mark.parametrize("dataset", ["waymo", "nuscenes"])
@pytest.mark.parametrize("path", PLACES, ids=lambda path: "/".join(map(str, path)))
@pytest.mark.filterwarnings("error")
def test_anything_in_any_place(path: tuple[Any, ...], dataset: str, tmp_path: Path) -> None:
    content = with_junk(CONTENT, ("metadata", "dataset"), dataset)
    chance = random.Random("/".join(map(str, path)))  # noqa: S311 - junk, no secret
    refused = []
    for junk in chance.sample(JUNK, 6):
        changed = put(tmp_path, with_junk(content, path, junk))
        for reader, error in (
            (read, TraceError),
            (lambda file: load_map(MapSource("a.pkl", file.read_bytes())), MapError),
        ):
            try:
                reader(changed)
            except error as told:
                refused.append(str(told))
    assert [text for text in refused if "\n" in text] == []


@pytest.mark.ci
@pytest.mark.filterwarnings("error")
def test_damaged_bytes(tmp_path: Path) -> None:
    content = pickle.dumps(CONTENT, 4)
    chance = random.Random(3)  # noqa: S311 - damage, no secret
    path = tmp_path / "sd_1.pkl"
    told = 0
    for _ in range(300):
        damaged = bytearray(content)
        for _ in range(chance.randrange(1, 6)):
            damaged[chance.randrange(20, len(damaged))] = chance.randrange(256)
        path.write_bytes(damaged)
        try:
            read(path)
        except TraceError as error:
            told += "\n" not in str(error)
        try:
            load_map(MapSource("sd_1.pkl", bytes(damaged)))
        except MapError as error:
            told += "\n" not in str(error)
    assert told > 50
