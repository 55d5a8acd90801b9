"""Velocities of 123D logs: which are measured, which stand for none, and which the converter filled in."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from drivelint.drive.trace import IngestOptions, Recording
from drivelint.formats.d123 import reader
from drivelint.formats.probe import Probe
from tests.formats.d123.files import Box, Ego, Frame, ego_states, times, write_log
from tests.formats.logs import quality, read, states

N = 40
V = tuple[float, float, float] | None


def recorded(folder: Path) -> Recording:
    """Return what the reader hands over, before velocities are derived."""
    return reader.read(Probe(folder, b"", IngestOptions()))


def velocities(recording: Recording, name: str) -> np.ndarray:
    rows = recording.states.actor == recording.states.ids.index(name)
    return recording.states.velocity[:, rows]


def write(folder: Path, boxes: list[list[Box]], **options: object) -> Path:
    frames = [Frame(t, row) for t, row in zip(times(len(boxes)), boxes, strict=True)]
    return write_log(folder, frames, ego_states(len(boxes)), **options)  # type: ignore[arg-type]


def way(k: int) -> float:
    """Return where somebody is who speeds up: at 0.1 k seconds, with 2 m/s2 from 5 m/s."""
    t = 0.1 * k
    return 20.0 + 5.0 * t + t * t


def test_zeros_of_all_boxes_that_move_stand_for_none(tmp_path: Path) -> None:
    folder = write(tmp_path / "log", [[Box("a", way(k), 3.0), Box("p", 50.0, 9.0)] for k in range(N)])
    assert np.isnan(velocities(recorded(folder), "p")).all()
    trace = read(folder)
    assert states(trace, "a")[20]["vx_mps"] == pytest.approx(9.0, abs=0.2)
    assert states(trace, "p")[20]["vx_mps"] == pytest.approx(0.0, abs=1e-9)
    assert quality(trace)["velocity_not_recorded"]["n"] == 2 * N


def test_zeros_of_who_is_parked_are_measured_where_others_have_velocities(tmp_path: Path) -> None:
    rows = [[Box("a", way(k), 3.0, (5.1 + 0.2 * k, 0.0, 0.0)), Box("p", 50.0, 9.0)] for k in range(N)]
    folder = write(tmp_path / "log", rows)
    assert (velocities(recorded(folder), "p") == 0.0).all()
    assert velocities(recorded(folder), "a")[0] == pytest.approx([5.1 + 0.2 * k for k in range(N)])
    assert "velocity_not_recorded" not in quality(read(folder))


def test_zeros_are_zeros_where_everybody_is_parked(tmp_path: Path) -> None:
    folder = write(tmp_path / "log", [[Box("p", 50.0, 9.0), Box("q", 60.0, 9.0)] for _ in range(N)])
    assert (velocities(recorded(folder), "p") == 0.0).all()


def test_a_zero_of_who_is_seen_once_is_none(tmp_path: Path) -> None:
    """Converters write zero where a box has no neighbour in time."""
    rows = [[Box("a", way(k), 3.0, (5.1 + 0.2 * k, 0.0, 0.0))] for k in range(N)]
    rows[7].append(Box("once", 40.0, -6.0))
    rows[8].append(Box("fast", 40.0, -6.0, (3.0, 0.0, 0.0)))
    got = recorded(write(tmp_path / "log", rows))
    assert np.isnan(velocities(got, "once")).all()
    assert velocities(got, "fast")[0] == [3.0]


@pytest.mark.parametrize("noise_mps", [0.0, 0.05])
def test_velocities_that_are_the_way_between_boxes_are_filled_in(tmp_path: Path, noise_mps: float) -> None:
    """They are those of a centred difference; measured ones differ from it."""
    t = [us * 1e-6 for us in times(N)]
    noise = np.random.default_rng(1).normal(0.0, noise_mps, N)
    v = [(way(k + 1) - way(k - 1)) / (t[k + 1] - t[k - 1]) + noise[k] if 0 < k < N - 1 else 0.0 for k in range(N)]
    got = recorded(write(tmp_path / "log", [[Box("a", way(k), 3.0, (v[k], 0.0, 0.0))] for k in range(N)]))
    assert np.isnan(velocities(got, "a")).all() == (noise_mps == 0.0)


def test_a_box_without_a_velocity(tmp_path: Path) -> None:
    rows = [[Box("a", way(k), 3.0, None if k == 5 else (5.1 + 0.2 * k, 0.0, 0.0))] for k in range(N)]
    got = velocities(recorded(write(tmp_path / "log", rows)), "a")
    assert np.flatnonzero(np.isnan(got[0])).tolist() == [5]


def test_velocities_of_a_data_set_that_are_not_along_the_map(tmp_path: Path) -> None:
    rows = [[Box("a", 20.0, way(k), (5.1 + 0.2 * k, 0.0, 0.0), yaw=math.pi / 2)] for k in range(N)]
    folder = write(tmp_path / "log", rows, dataset="kitti360")
    assert np.isnan(velocities(recorded(folder), "a")).all()
    assert states(read(folder), "a")[20]["vy_mps"] == pytest.approx(9.0, abs=0.2)


def egos(motion: list[list[float] | None], turn_rps: float = 0.0) -> list[Ego]:
    return [Ego(t, way(k), 0.0, turn_rps * 0.1 * k, m) for k, (t, m) in enumerate(zip(times(N), motion, strict=True))]


def ego_velocity(tmp_path: Path, motion: list[list[float] | None], turn_rps: float = 0.0) -> np.ndarray:
    frames = [Frame(t, [Box("p", 50.0, 9.0)]) for t in times(N)]
    return velocities(recorded(write_log(tmp_path / "log", frames, egos(motion, turn_rps))), "ego")


def test_an_ego_without_motion_has_no_velocity(tmp_path: Path) -> None:
    assert np.isnan(ego_velocity(tmp_path, [None] * N)).all()


def test_a_measured_velocity_of_the_ego_is_read(tmp_path: Path) -> None:
    got = ego_velocity(tmp_path, [[5.1 + 0.2 * k, 0, 0, 0, 0, 0, 0, 0, 0] for k in range(N)])
    assert got[0] == pytest.approx([5.1 + 0.2 * k for k in range(N)])


def test_a_velocity_of_the_ego_that_was_filled_in_is_not_read(tmp_path: Path) -> None:
    t = [us * 1e-6 for us in times(N)]
    v = [(way(min(k + 1, N - 1)) - way(max(k - 1, 0))) / (t[min(k + 1, N - 1)] - t[max(k - 1, 0)]) for k in range(N)]
    assert np.isnan(ego_velocity(tmp_path, [[x, 0, 0, 0, 0, 0, 0, 0, 0] for x in v])).all()


def test_an_ego_that_turns_and_says_that_it_does_not(tmp_path: Path) -> None:
    """How its middle swings around the IMU is then not known."""
    motion: list[list[float] | None] = [[5.1 + 0.2 * k, 0, 0, 0, 0, 0, 0, 0, 0] for k in range(N)]
    assert np.isnan(ego_velocity(tmp_path, motion, turn_rps=0.1)).all()


def test_zeros_of_an_ego_that_moves(tmp_path: Path) -> None:
    frames = [Frame(t, [Box("p", 50.0, 9.0)]) for t in times(N)]
    trace = read(write_log(tmp_path / "log", frames, egos([[0.0] * 9] * N)))
    assert states(trace, "ego")[20]["vx_mps"] == pytest.approx(9.0, abs=0.2)
