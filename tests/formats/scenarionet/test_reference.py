"""The reference scenarios: every state against a second reading with `pickle` itself, the maps against the tracks, verdicts by `check`."""

from __future__ import annotations

import io
import json
import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely

from drivelint.drive.trace import Trace
from drivelint.formats import load_map, read_source
from drivelint.formats.scenarionet.ego_clock import track_at_steps
from drivelint.road.map_reader import MapTables
from tests.formats.logs import classes, egos, log, read, size
from tests.formats.maps import checks, hand, lanelets, values
from tests.shared_data import shared

pytestmark = pytest.mark.ci

FOLDER = "perception/scenarionet"
NUSCENES = ("sd_nuscenes_v1.0-mini_scene-0553", "sd_nuscenes_v1.0-mini_scene-1077", "sd_nuscenes_v1.0-mini_scene-1094")
WAYMO = "sd_waymo_v1.2_eb4b91b10ca94ff2"
SCENARIOS = (*NUSCENES, WAYMO)


class Reading(pickle.Unpickler):
    """A second reading: CPython's own, with numpy's own functions and nothing else."""

    def find_class(self, module: str, name: str) -> Any:
        allowed = {"_reconstruct", "ndarray", "dtype", "scalar", "defaultdict", "int"}
        assert module.split(".", maxsplit=1)[0] in {"numpy", "collections", "builtins"}
        assert name in allowed
        return super().find_class(module.replace("numpy.core", "numpy._core"), name)


def second(name: str) -> dict[str, Any]:
    found: dict[str, Any] = Reading(io.BytesIO(shared(f"{FOLDER}/{name}.pkl").read_bytes())).load()
    return found


def first(name: str) -> Trace:
    return read(shared(f"{FOLDER}/{name}.pkl"))


def on_map(name: str) -> MapTables:
    return load_map(read_source(shared(f"{FOLDER}/{name}.pkl")))


def columns(trace: Trace) -> dict[str, dict[str, np.ndarray]]:
    table = trace.tables["actor_state"]
    names = ("t_ns", "x_m", "y_m", "z_m", "yaw_rad", "vx_mps", "vy_mps")
    values = {name: table[name].to_numpy(zero_copy_only=False).astype(np.float64) for name in names}
    who = np.array(table["actor_id"].to_pylist())
    return {actor: {name: column[who == actor] for name, column in values.items()} for actor in np.unique(who)}


@pytest.mark.parametrize("name", SCENARIOS)
def test_every_state_is_that_of_a_second_reading(name: str) -> None:
    told, got = second(name), columns(first(name))
    ts = np.asarray(told["metadata"]["ts"], np.float64)
    present = {i: np.asarray(t["state"]["valid"]).ravel() > 0 for i, t in told["tracks"].items()}
    assert set(got) == {i for i, valid in present.items() if valid.any()}
    ego = told["metadata"]["sdc_id"]
    for actor, mine in got.items():
        if actor == ego and name in NUSCENES:
            continue
        valid, state = present[actor], told["tracks"][actor]["state"]
        assert mine["t_ns"] == pytest.approx(np.round(ts[valid] * 1e9), abs=1)
        known = np.isfinite(mine["x_m"])  # a place that jumps is not believed
        assert known.sum() >= len(known) - 10
        for k, axis in enumerate(("x_m", "y_m", "z_m")):
            assert mine[axis][known] == pytest.approx(state["position"][valid][known, k].astype(np.float64), abs=1e-3)
        heading = np.asarray(state["heading"], np.float64).ravel()[valid]
        off = (mine["yaw_rad"] - heading + np.pi) % (2 * np.pi) - np.pi
        assert np.abs(off[np.isfinite(off)]).max(initial=0.0) < 1e-6 or name == WAYMO
        assert np.isfinite(off).sum() >= len(off) - 10


@pytest.mark.parametrize("name", NUSCENES)
def test_the_ego_of_nuscenes_is_on_the_way_that_it_recorded(name: str) -> None:
    """The middle of its box is 1.385 m ahead of the rear axle's way, and the way is not left."""
    told, got = second(name), columns(first(name))["ego"]
    state = told["tracks"]["ego"]["state"]
    axle = np.column_stack([got["x_m"] - 1.385 * np.cos(got["yaw_rad"]), got["y_m"] - 1.385 * np.sin(got["yaw_rad"])])
    way = shapely.LineString(state["position"][:-3, :2])
    assert shapely.distance(shapely.points(axle[:-3]), way).max() < 0.3
    assert np.abs(got["z_m"] - 0.78).max() < 1e-9


@pytest.mark.parametrize(
    ("name", "lost_messages", "shift_s", "worst"),
    [(NUSCENES[1], 7, 0.058, (27.0, 4.7)), (NUSCENES[2], 9, 0.003, (26.3, 5.8))],
)
def test_the_ego_of_nuscenes_leaps_no_more(
    name: str, lost_messages: int, shift_s: float, worst: tuple[float, float]
) -> None:
    """The greatest change of speed from step to step, as the scenario has it and with the time of lost messages."""
    told = second(name)
    state, ts = told["tracks"]["ego"]["state"], told["metadata"]["ts"]
    found = track_at_steps(state["position"][:, :2], state["heading"], ts, 0.02)
    assert found.lost_messages == lost_messages
    assert found.shift_s == pytest.approx(shift_s, abs=0.001)

    def greatest(place: np.ndarray) -> float:
        speed = np.hypot(*np.diff(place, axis=0).T) / 0.1
        return float(np.nanmax(np.abs(np.diff(speed))) / 0.1)

    assert greatest(state["position"][:-8, :2]) == pytest.approx(worst[0], abs=0.1)
    assert greatest(found.place[:-8]) < worst[1] + 1.0


@pytest.mark.parametrize("name", SCENARIOS)
def test_egos_and_classes(name: str) -> None:
    trace = first(name)
    (ego,) = egos(trace)
    sides, word, reach = ((4.08, 1.73), "car", 40.0) if name in NUSCENES else ((5.286, 2.332), "vehicle", 75.0)
    assert size(trace, ego)[:2] == pytest.approx(sides)
    assert (classes(trace)[ego], log(trace)["sensor_range_m"]) == (word, reach)
    assert set(classes(trace).values()) >= ({"car", "bus"} if name in NUSCENES else set())
    assert trace.embedded_map is not None


@pytest.mark.parametrize("name", NUSCENES)
def test_the_last_velocity_is_that_of_the_motion(name: str) -> None:
    """It is 0 in every track of the scenario."""
    told, got = second(name), columns(first(name))
    n = 0
    for actor, mine in got.items():
        state = told["tracks"][actor]["state"]
        last = np.flatnonzero(np.asarray(state["valid"]).ravel() > 0)[-1]
        assert (state["velocity"][last] == 0.0).all()
        x, y = mine["x_m"], mine["y_m"]
        way = np.hypot(x[-1] - x[-2], y[-1] - y[-2]) if len(x) > 1 else 0.0
        if way > 0.2 and np.isfinite(mine["vx_mps"][-1]):
            assert np.hypot(mine["vx_mps"][-1], mine["vy_mps"][-1]) == pytest.approx(way / 0.1, abs=0.15 * way / 0.1)
            n += 1
    assert n >= 4


def test_the_lights_of_waymo() -> None:
    told, trace = second(WAYMO), first(WAYMO)
    rows = trace.tables["signal_state"].to_pylist()
    assert len(rows) == 14 * 199
    words = {"GO": "green", "STOP": "red", "ARROW_STOP": "red", "UNKNOWN": None}
    for name, light in told["dynamic_map_states"].items():
        expected = [word and words[word.removeprefix("LANE_STATE_")] for word in light["state"]["object_state"]]
        assert [row["state"] for row in rows if row["signal_id"] == name] == expected
    stands = values(on_map(WAYMO), "traffic_signal", "signal_id lanelet_id x_m y_m", kind="traffic_light")
    assert {name for name, *_ in stands} == set(told["dynamic_map_states"]) - {
        "204"
    }  # of that lane the map has one point
    for name, lane, x, y in stands:
        place = told["dynamic_map_states"][name]["stop_point"]
        assert (lane, x, y) == (name, pytest.approx(place[0]), pytest.approx(place[1]))


@pytest.mark.parametrize(
    ("name", "side", "n_lanes", "off_m"),
    [
        (NUSCENES[0], "rht", 421, 0.7),
        (NUSCENES[1], "lht", 212, 0.5),
        (NUSCENES[2], "lht", 288, 0.3),
        (WAYMO, "rht", 102, 0.3),
    ],
)
def test_cars_drive_on_the_lanes(name: str, side: str, n_lanes: int, off_m: float) -> None:
    """Each moving car is on a lane that runs as it drives, and near its middle; the lanes alone tell the same side as the place does."""
    trace, found = first(name), on_map(name)
    assert hand(found) == (side, "attribute")
    assert [check for check in checks(found) if check.startswith("handedness")] == []
    assert found.tables["lanelet"].num_rows == n_lanes
    points = {key: found.tables["lane_point"][key].to_numpy() for key in ("x_m", "y_m", "tx", "ty", "half_width_m")}
    wheels = {"car", "bus", "truck", "vehicle", "van"}
    kinds = classes(trace)
    along, beside = [], []
    for row in trace.tables["actor_state"].to_pylist()[::7]:
        if kinds[row["actor_id"]] not in wheels or None in (row["x_m"], row["vx_mps"], row["yaw_rad"]):
            continue
        if np.hypot(row["vx_mps"], row["vy_mps"]) < 3.0:
            continue
        dx, dy = row["x_m"] - points["x_m"], row["y_m"] - points["y_m"]
        left = points["tx"] * dy - points["ty"] * dx
        on = (np.abs(points["tx"] * dx + points["ty"] * dy) < 2.5) & (np.abs(left) < points["half_width_m"])
        if on.any():
            cos = points["tx"][on] * np.cos(row["yaw_rad"]) + points["ty"][on] * np.sin(row["yaw_rad"])
            along.append(cos.max())
            beside.append(np.abs(left[on][cos > 0.9]).min(initial=np.inf))
    assert len(along) > 80
    assert np.mean(np.array(along) > 0.9) > 0.94  # one car of 1094 turns round
    assert np.median([each for each in beside if np.isfinite(each)]) < off_m


def test_neighbours_are_those_that_waymo_names() -> None:
    """Waymo names neighbours that go the same way. Where a lane has only one on a side, along all of it, the shapes tell the same."""
    told = second(WAYMO)["map_features"]
    same = n = 0
    for name, row in lanelets(on_map(WAYMO)).items():
        for side in ("left", "right"):
            named = told[name][f"{side}_neighbor"]
            shared_points = (
                int(named[0]["self_end_index"]) - int(named[0]["self_start_index"]) if len(named) == 1 else 0
            )
            if shared_points > 0.9 * len(told[name]["polyline"]) and row["junction_id"] is None:
                n += 1
                same += row[f"{side}_id"] == named[0]["feature_id"] and row[f"{side}_against"] is False
    assert n > 40
    assert same >= 0.95 * n


def test_widths_are_those_that_waymo_tells() -> None:
    """`width` of the scenario is measured to points of the lines, not to the lines, so that it may be a little more."""
    told = second(WAYMO)["map_features"]
    off = []
    for name, width in values(on_map(WAYMO), "lanelet", "lanelet_id width_m", junction_id=None):
        both = told[name]["width"]
        if (both > 0.0).all() and both.max() < 2.2 and told[name]["left_boundaries"] and told[name]["right_boundaries"]:
            off.append(width - float(both.sum(axis=1).mean()))
    assert len(off) > 25
    assert np.abs(np.median(off)) < 0.05
    assert np.quantile(np.abs(off), 0.9) < 0.2


@pytest.mark.slow
def test_one_command_judges_a_folder_of_them(tmp_path: Path) -> None:
    """Verdicts that were counted when the reader was written; nobody breaks a rule surely, and no verdict is an error."""
    folder = tmp_path / "waymo"
    folder.mkdir()
    for name in (WAYMO, NUSCENES[0]):
        (folder / f"{name}.pkl").symlink_to(shared(f"{FOLDER}/{name}.pkl"))
    (folder / "dataset_summary.pkl").write_bytes(pickle.dumps({}))
    command = [
        sys.executable, "-m", "drivelint", "check", str(folder), "--out", str(tmp_path / "out"), "--no-annotate", "--format", "json",
    ]  # fmt: skip
    done = subprocess.run(command, capture_output=True, text=True, timeout=500, check=False)
    assert done.returncode == 0, done.stderr
    summary = json.loads(done.stdout)
    assert summary["verdicts"]["error"] == summary["verdicts"]["fail"] == 0
    assert summary["verdicts"]["pass"] >= 40
    assert {drive["file_name"] for drive in summary["drives"]} == {f"{WAYMO}.pkl", f"{NUSCENES[0]}.pkl"}
