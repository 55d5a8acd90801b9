"""Copies of a drive: their errors are those that were asked for, and a part of a drive has those of the whole."""

from __future__ import annotations

from pathlib import Path
from statistics import NormalDist

import numpy as np
import pyarrow.compute as pc
import pytest

from drivelint.drive.trace import IngestOptions
from drivelint.engine.batch import Drive
from drivelint.engine.robustness.copies import COPIES_PER_BLOCK, MeasurementErrors, copies, crop
from drivelint.formats import read_trace

OVERTAKE = Path(__file__).parents[2] / "fixtures" / "overtake"
N = 400


@pytest.fixture(scope="module")
def drive() -> Drive:
    return Drive(read_trace(OVERTAKE / "near_miss.csv", IngestOptions(mapping=str(OVERTAKE / "mapping.toml"))), None)


def offsets(drive: Drive, errors: MeasurementErrors, numbers: range) -> dict[str, np.ndarray]:
    """Return actor -> (copies, x and y): how far its first state is from where it was."""
    ids, many = copies(drive, errors, numbers)
    states, whole = many.trace.tables["actor_state"], drive.trace.tables["actor_state"]
    found = {}
    for actor in pc.unique(whole["actor_id"]).to_pylist():
        (was, *_) = whole.filter(pc.equal(whole["actor_id"], actor)).select(["x_m", "y_m"]).to_pylist()
        mine = states.filter(pc.equal(states["actor_id"], actor))
        first = [
            mine.filter(pc.equal(mine["drive_id"], name)).slice(0, 1).select(["x_m", "y_m"]).to_pylist()[0]
            for name in ids
        ]
        found[actor] = np.array([[row["x_m"] - was["x_m"], row["y_m"] - was["y_m"]] for row in first])
    return found


@pytest.mark.ci
def test_positions_and_the_map_are_off_by_as_much_as_was_asked(drive: Drive) -> None:
    own = offsets(drive, MeasurementErrors(0.3, 0.0, 0.0), range(1, N + 1))
    for moved in own.values():
        assert moved.std(axis=0) == pytest.approx(0.3, rel=0.15)
        assert moved.mean(axis=0) == pytest.approx(0.0, abs=0.06)
    first, second = list(own.values())[:2]
    assert abs(np.corrcoef(first[:, 0], second[:, 0])[0, 1]) < 0.2  # actors err each for itself
    common = list(offsets(drive, MeasurementErrors(0.0, 0.0, 0.3), range(1, 40)).values())
    assert common[0] == pytest.approx(common[1])  # the map is off for all alike
    assert common[0].std() > 0.2


def test_a_clock_that_is_off_moves_an_actor_along_its_way(drive: Drive) -> None:
    ids, many = copies(drive, MeasurementErrors(0.0, 0.2, 0.0), range(1, 2))
    before, after = drive.trace.tables["actor_state"].to_pylist(), many.trace.tables["actor_state"].to_pylist()
    assert {row["drive_id"] for row in after} == set(ids)
    by_actor: dict[str, set[float]] = {}
    for was, now in zip(before, after, strict=True):
        assert was["t_ns"] == now["t_ns"]
        if was["vx_mps"]:
            by_actor.setdefault(was["actor_id"], set()).add(round((now["x_m"] - was["x_m"]) / was["vx_mps"], 6))
    assert by_actor
    assert all(len(delays) == 1 for delays in by_actor.values())  # one delay each, at all steps


def test_copy_0_is_the_drive_itself(drive: Drive) -> None:
    _, same = copies(drive, MeasurementErrors(), range(2))
    n = drive.n_states
    for name in ("x_m", "y_m", "vx_mps", "t_ns"):
        assert (
            same.trace.tables["actor_state"][name].slice(0, n).to_pylist()
            == drive.trace.tables["actor_state"][name].to_pylist()
        )
    assert same.n_states == 2 * n


def test_a_part_of_a_drive_has_the_errors_of_the_whole_however_many_copies_are_drawn(drive: Drive) -> None:
    times = drive.trace.tables["actor_state"]["t_ns"]
    middle = (pc.min(times).as_py() + pc.max(times).as_py()) // 2
    _, whole = copies(drive, MeasurementErrors(), range(1, 20))
    ids, part = copies(crop(drive, middle, middle + 2_000_000_000), MeasurementErrors(), range(7, 9))
    key = ["drive_id", "actor_id", "t_ns"]
    places = {
        tuple(row[k] for k in key): (row["x_m"], row["y_m"]) for row in whole.trace.tables["actor_state"].to_pylist()
    }
    rows = part.trace.tables["actor_state"].to_pylist()
    assert {row["drive_id"] for row in rows} == set(ids) == {f"{drive.trace.drive_id}~{n:05}" for n in (7, 8)}
    for row in rows:
        assert places[tuple(row[k] for k in key)] == (row["x_m"], row["y_m"])


def test_another_seed_draws_others(drive: Drive) -> None:
    one, other = (offsets(drive, MeasurementErrors(seed=seed), range(1, 3)) for seed in (0, 1))
    for actor, moved in one.items():
        assert np.abs(moved - other[actor]).min() > 0


def test_the_errors_of_a_block_are_one_from_each_range(drive: Drive) -> None:
    """As many equally probable ranges as there are copies in a block have one error each."""
    for block in range(2):
        numbers = range(1 + block * COPIES_PER_BLOCK, 1 + (block + 1) * COPIES_PER_BLOCK)
        for moved in offsets(drive, MeasurementErrors(1.0, 0.0, 0.0), numbers).values():
            for axis in range(2):
                probability = sorted(NormalDist().cdf(value) for value in moved[:, axis])
                assert [int(each * COPIES_PER_BLOCK) for each in probability] == list(range(COPIES_PER_BLOCK))


def test_errors_are_those_of_the_actor_whatever_the_file(drive: Drive, tmp_path: Path) -> None:
    (tmp_path / "other.csv").write_bytes((OVERTAKE / "near_miss.csv").read_bytes() + b"\n")
    other = Drive(read_trace(tmp_path / "other.csv", IngestOptions(mapping=str(OVERTAKE / "mapping.toml"))), None)
    assert other.trace.drive_id != drive.trace.drive_id
    one, two = (offsets(each, MeasurementErrors(), range(1, 4)) for each in (drive, other))
    assert one.keys() == two.keys()
    for actor, moved in one.items():
        assert np.array_equal(moved, two[actor])
