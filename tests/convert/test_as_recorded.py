"""A converted log has what was recorded, what is doubted of it is said beside it, and who reads it doubts the same."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np
import pyarrow.parquet as pq
import pytest

from drivelint.convert import ConvertRequest, convert
from drivelint.drive.trace import IngestOptions
from drivelint.formats import read_trace
from drivelint.formats.osi.metadata import ego_independent_quality
from tests.convert.stock_reader import messages
from tests.formats.logs import LONG, mapping, table
from tests.formats.osi import osi_log

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from numpy.typing import NDArray

    from drivelint.drive.trace import Trace

Target: TypeAlias = Literal["mcap", "parquet"]
Rows: TypeAlias = "dict[str, NDArray[np.floating[Any]]]"
TO: tuple[Target, ...] = ("mcap", "parquet")
TABLES = ("actor", "actor_state", "signal_state", "declared_event")
N, STEP_S = 100, 0.1


def track(y: float = 4.0) -> Rows:
    """Return the states of a car that drives east at 10 m/s, by column."""
    t = np.arange(N) * STEP_S
    nothing = np.zeros(N)
    return {"t": t, "x": 10.0 * t, "y": nothing + y, "yaw": nothing.copy(), "vx": nothing + 10.0, "vy": nothing.copy()}


def jumps(b: Rows) -> None:
    b["x"][50] += 80.0


def goes_on_elsewhere(b: Rows) -> None:
    b["y"][50:] += 60.0


def stands_while_it_drives(b: Rows) -> None:
    b["x"][40:50] = b["x"][40]


def turns_round(b: Rows) -> None:
    b["yaw"][30:40] = np.pi


def lies_across(b: Rows) -> None:
    b["yaw"][30:40] = 1.5


def leads_astray(b: Rows) -> None:
    b["vx"][30:50] = 8.3


def never_moves(b: Rows) -> None:
    b["vx"][:] = 0.0


def is_twice(b: Rows) -> None:
    for name in b:
        b[name] = np.insert(b[name], 50, b[name][50])
    b["y"][50] += 2.0


def begins_again(b: Rows) -> None:
    for name, values in b.items():
        b[name] = np.r_[values[:60], values[30:]]
    b["y"][60:] += 1.0


DOUBTS: dict[str, Callable[[Rows], None]] = {
    "teleport": jumps,
    "track_parted": goes_on_elsewhere,
    "motion_unknown": stands_while_it_drives,
    "heading_turned": turns_round,
    "heading_unknown": lies_across,
    "velocity_unknown": leads_astray,
    "velocity_derived": never_moves,
    "duplicate_state": is_twice,
    "clock_restart": begins_again,
}
"""Check that doubts a track -> what is wrong with the track."""


def write_faulty_table(path: Path, check: str) -> Path:
    """Write a table of an ego and of a car with something wrong."""
    tracks = {"a": track(0.0), "b": track()}
    DOUBTS[check](tracks["b"])
    if check == "clock_restart":  # the clock is that of all
        begins_again(tracks["a"])
    rows = [
        (k, name, *values)
        for name, each in tracks.items()
        for k, values in enumerate(zip(*(column.tolist() for column in each.values()), strict=True))
    ]
    rows.sort(key=lambda row: row[0])  # in the order of recording, not of the clock
    lines = [f"{t:.3f},{name},{','.join(map(repr, values))}" for _, name, t, *values in rows]
    return table(path / "log.csv", ["t,id,x,y,yaw,vx,vy", *lines])


def quality_rows(trace: Trace) -> list[dict[str, Any]]:
    rows = ego_independent_quality(trace).drop_columns("drive_id").to_pylist()
    # Parquet's checksums cover less than MCAP's, and the reader of OSI says itself that a clock goes back
    return [row for row in rows if row["check_id"] not in {"unprotected", "clock_jump"}]


def same(first: Trace, second: Trace) -> None:
    """Require that two logs are the same to whoever judges them."""
    for name in TABLES:
        assert first.tables[name].drop_columns("drive_id") == second.tables[name].drop_columns("drive_id"), name
    assert quality_rows(first) == quality_rows(second)


@pytest.mark.sample(6, ci=12)
@pytest.mark.parametrize("to", TO)
@pytest.mark.parametrize("check", DOUBTS)
def test_what_is_doubted_stays_and_is_said(tmp_path: Path, check: str, to: Target) -> None:
    log, spec = write_faulty_table(tmp_path, check), mapping(tmp_path, LONG)
    original = read_trace(log, IngestOptions(mapping=spec))
    assert check in {row["check_id"] for row in quality_rows(original)}
    path = convert(ConvertRequest(str(log), to, tmp_path / "out", mapping=spec)).path
    recorded = [line.split(",") for line in log.read_text().splitlines()[1:]]
    expected = sorted((name, round(float(t) * 1e9), *map(float, values)) for t, name, *values in recorded)
    if to == "parquet":
        states = pq.read_table(path / "actor_state.parquet").to_pylist()
        columns = ("actor_id", "t_ns", "x_m", "y_m", "yaw_rad", "vx_mps", "vy_mps")
        kept = sorted(tuple(row[name] for name in columns) for row in states)
        said = pq.read_table(path / "quality.parquet")["check_id"].to_pylist()
        assert check in said
    else:
        kept = sorted(
            (
                "ab"[item.id.value - 1],
                truth.timestamp.seconds * 10**9 + truth.timestamp.nanos,
                *(item.base.position.x, item.base.position.y, item.base.orientation.yaw),
                *(item.base.velocity.x, item.base.velocity.y),
            )
            for topic, _, truth in messages(path)
            for item in truth.moving_object
            if topic == "ground_truth"
        )
    assert kept == expected
    same(read_trace(path, IngestOptions()), original)


@pytest.mark.parametrize("to", TO)
@pytest.mark.parametrize("restarts", [False, True])
def test_frames_in_which_nobody_is(tmp_path: Path, to: Target, restarts: bool) -> None:
    frames = osi_log.drive(40)
    for truth in frames[15:25] + frames[30:]:
        del truth.moving_object[:]
    if restarts:
        again = osi_log.drive(12)
        for truth in again:
            truth.timestamp.nanos += 50_000_000
        frames += again
    log = osi_log.write(tmp_path / "log.mcap", osi_log.truths(frames))
    original = read_trace(log, IngestOptions())
    (absent,) = (row for row in quality_rows(original) if row["check_id"] == "ego_absent")
    assert absent["message"].startswith("the ego 0 is absent for ")
    path = convert(ConvertRequest(str(log), to, tmp_path / "out")).path
    converted = read_trace(path, IngestOptions())
    same(converted, original)
    second = convert(ConvertRequest(str(path), "parquet" if to == "mcap" else "mcap", tmp_path / "other")).path
    same(read_trace(second, IngestOptions()), original)


@pytest.mark.parametrize("to", TO)
def test_an_ego_that_the_user_picked_is_no_recorder(tmp_path: Path, to: Target) -> None:
    """It may drive away before the log ends, in the converted log as in the log itself."""
    frames = osi_log.drive(40)
    for truth in frames:
        truth.ClearField("host_vehicle_id")
    for truth in frames[20:]:
        del truth.moving_object[1]
    log = osi_log.write(tmp_path / "log.mcap", osi_log.truths(frames))
    original = read_trace(log, IngestOptions(ego="1"))
    said = {row["check_id"]: row["message"] for row in original.tables["quality"].to_pylist()}
    assert "ego_absent" not in said
    assert "for the time of its track, 1.9 of 3.9 s of the log" in said["ego_chosen"]
    path = convert(ConvertRequest(str(log), to, tmp_path / "out", ego="1")).path
    same(read_trace(path, IngestOptions()), original)
    other = read_trace(path, IngestOptions(ego="2"))
    assert [row["actor_id"] for row in quality_rows(other) if row["check_id"] == "ego_chosen"] == ["2"]
    every = read_trace(log, IngestOptions(ego="all"))
    path = convert(ConvertRequest(str(log), to, tmp_path / "all", ego="all")).path
    same(read_trace(path, IngestOptions()), every)
