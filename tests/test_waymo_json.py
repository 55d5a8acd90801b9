"""Waymo scenarios as JSON (Nocturne, GPUDrive) become scenarios of ScenarioNet: the same states, in one frame, and they are judged."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from drivelint.formats import load_map, read_source
from tests.formats.logs import actors, read, states
from tests.shared_data import shared
from tests.waymo_json import write

FILES = ("gpudrive_w4", "gpudrive_w407", "nocturne_n171", "nocturne_n65")


def content(name: str) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(shared(f"perception/waymo_json/{name}.json").read_text(encoding="utf-8"))
    return found


def write_scenario(name: str, folder: Path) -> Path:
    return write(shared(f"perception/waymo_json/{name}.json"), folder)


def place(points: Any, step: int) -> tuple[float, float]:
    """Return the place of a step, given as columns or as a list."""
    return (
        (points["x"][step], points["y"][step]) if isinstance(points, dict) else (points[step]["x"], points[step]["y"])
    )


@pytest.mark.sample(2, ci=2)
@pytest.mark.parametrize("name", FILES)
def test_every_valid_state_is_there_and_no_other(name: str, tmp_path: Path) -> None:
    told, trace = content(name)["objects"], read(write_scenario(name, tmp_path))
    by_step = {(row["actor_id"], round(row["t_ns"] / 1e8)): row for row in states(trace)}
    expected = {
        (str(each.get("id", number)), step): (each, step)
        for number, each in enumerate(told)
        for step in np.flatnonzero(each["valid"]).tolist()
    }
    assert set(by_step) == set(expected)
    n = 0
    for key, (each, step) in expected.items():
        row = by_step[key]
        if row["x_m"] is None or row["yaw_rad"] is None:
            continue
        n += 1
        assert (row["x_m"], row["y_m"]) == pytest.approx(place(each["position"], step), abs=1e-3)
        heading = np.radians(each["heading"][step]) if name.startswith("nocturne") else each["heading"][step]
        assert abs((row["yaw_rad"] - heading + np.pi) % (2 * np.pi) - np.pi) < 1e-6
    assert n > 0.995 * len(expected)


@pytest.mark.parametrize("name", FILES)
def test_the_recorder_is_waymos_car(name: str, tmp_path: Path) -> None:
    (ego,) = (row for row in actors(read(write_scenario(name, tmp_path))).values() if row["is_ego"])
    assert (ego["length_m"], ego["width_m"]) == (pytest.approx(5.286), pytest.approx(2.332))


@pytest.mark.sample(2, ci=2)
@pytest.mark.parametrize(
    ("name", "n_lanes", "n_left_out"),
    [("gpudrive_w4", 37, 0), ("gpudrive_w407", 76, 0), ("nocturne_n171", 210, 2), ("nocturne_n65", 74, 0)],
)
def test_the_maps_are_built_of_lines_alone(name: str, n_lanes: int, n_left_out: int, tmp_path: Path) -> None:
    found = load_map(read_source(write_scenario(name, tmp_path)))
    assert found.tables["lanelet"].num_rows == n_lanes
    assert found.tables["map_quality"]["check_id"].to_pylist().count("invalid_lane") == n_left_out
    widths = found.tables["lanelet"]["width_m"].to_numpy()
    assert 2.5 < np.median(widths) < 5.5
    assert found.tables["lane_link"].num_rows > 0.9 * n_lanes


def test_the_lights_of_nocturne_stand_where_lanes_begin(tmp_path: Path) -> None:
    told, path = content("nocturne_n171")["tl_states"], write_scenario("nocturne_n171", tmp_path)
    rows = load_map(read_source(path)).tables["traffic_signal"].to_pylist()
    assert len(rows) == len(told) == 11
    assert [row["lane_s_m"] for row in rows] == pytest.approx([0.0] * 11, abs=0.5)
    stop_points = sorted((light["x"][0], light["y"][0]) for light in told.values())
    assert np.array(sorted((row["x_m"], row["y_m"]) for row in rows)) == pytest.approx(np.array(stop_points), abs=1e-3)
    shown = [row["state"] for row in read(path).tables["signal_state"].to_pylist()]
    assert set(shown) == {"red", None}
    assert shown.count(None) < 300  # a light is not seen all the time


@pytest.mark.slow
def test_one_command_judges_all_of_them(tmp_path: Path) -> None:
    folder = tmp_path / "scenarios"
    folder.mkdir()
    for name in FILES:
        write_scenario(name, folder)
    command = [
        sys.executable,
        "-m",
        "drivelint",
        "check",
        str(folder),
        "--out",
        str(tmp_path / "out"),
        "--fail-on",
        "never",
        "--no-annotate",
        "--format",
        "json",
    ]
    done = subprocess.run(command, capture_output=True, text=True, timeout=560, check=False)
    assert done.returncode == 0, done.stderr
    summary = json.loads(done.stdout)
    assert summary["verdicts"]["error"] == 0
    assert len(summary["drives"]) == 4
