"""A parked car in the ego's way whose states cannot be read: what was a collision is unknown then, in every format, and never a pass."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import drivelint
from tests.faults import drives
from tests.faults.drives import Car, Frame
from tests.formats.foxglove import foxglove_log
from tests.formats.logs import read
from tests.formats.osi import osi_log
from tests.formats.ros2 import ros_log
from tests.formats.sumo import fcd_text

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    Row = dict[str, Any]
    Write = Callable[[Path, list[Frame]], Path]

PARKED: Final = Car("1", 20.0, 0.0, vx=0.0)
WIDE: Final = """
description = "wide table of the tests"
[time]
column = "t"
[columns]
actor_id = "name{k}"
x = "x{k}"
y = "y{k}"
yaw = "yaw{k}"
length = 4.5
width = 1.8
[ego]
ids = ["0"]
"""


def scene(*, alone: bool = False) -> list[Frame]:
    """Return the ego's drive into the parked car; beside them, if not `alone`, a car in a lane of its own."""
    return [
        frame._replace(cars=[frame.cars[0], PARKED, *frame.cars[2:]][: 2 if alone else 3]) for frame in drives.drive()
    ]


def csv_where(garble: Callable[[str], str]) -> Write:
    """Return what writes CSV with other lines of the parked car."""

    def write(path: Path, frames: list[Frame]) -> Path:
        found = drives.csv(path, frames)
        lines = found.read_text(encoding="utf-8").splitlines()
        found.write_text(
            "\n".join(garble(line) if ",1,20" in line else line for line in lines) + "\n", encoding="utf-8"
        )
        return found

    return write


def csv_by_actor(path: Path, frames: list[Frame]) -> Path:
    """Write CSV car by car, with cut lines of the parked one: nothing tells their times."""
    found = csv_where(_cut)(path, frames)
    head, *lines = found.read_text(encoding="utf-8").splitlines()
    found.write_text("\n".join([head, *sorted(lines, key=lambda line: line.split(",")[1])]) + "\n", encoding="utf-8")
    return found


def _cut(line: str) -> str:
    return line.rpartition(",")[0]


def wide_csv(path: Path, frames: list[Frame]) -> Path:
    """Write a row per frame, in which the parked car has no name."""
    lines = ["t," + ",".join(f"name{k},x{k},y{k},yaw{k}" for k in range(len(frames[0].cars)))]
    for frame in frames:
        cells = (f"{'' if car.name == '1' else car.name},{car.x},{car.y},{car.yaw}" for car in frame.cars)
        lines.append(f"{frame.t_s:.3f},{','.join(cells)}")
    found = path.with_suffix(".csv")
    found.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return found


def parquet_without(column: str) -> Write:
    """Return what writes canonical Parquet in which the parked car has nothing in a column."""

    def write(path: Path, frames: list[Frame]) -> Path:
        found = drives.parquet(path, frames)
        pq.write_table(_without(pq.read_table(found), column), found)
        return found

    return write


def _without(table: pa.Table, column: str) -> pa.Table:
    rows = [row | ({column: None} if row["actor_id"] == "1" else {}) for row in table.to_pylist()]
    return pa.Table.from_pylist(rows, table.schema)


def mapped_parquet(path: Path, frames: list[Frame]) -> Path:
    """Write Parquet that is read through the mapping of the CSV tables, without the parked car's id."""
    names = {"actor_id": "id", "x_m": "x", "y_m": "y", "yaw_rad": "yaw", "vx_mps": "vx", "vy_mps": "vy"}
    table = _without(drives.table(frames), "actor_id").rename_columns(names | {"t_ns": "t"})
    found = path.with_suffix(".parquet")
    pq.write_table(table.set_column(0, "t", pa.array([t / 1e9 for t in table["t"].to_pylist()])), found)
    return found


def _truths_without_id(frames: list[Frame]) -> list[Any]:
    found = drives.truths(frames)
    for truth in found:
        truth.moving_object[1].ClearField("id")
    return found


def osi_mcap(path: Path, frames: list[Frame]) -> Path:
    return osi_log.write(path.with_suffix(".mcap"), osi_log.truths(_truths_without_id(frames)))


def osi_file(path: Path, frames: list[Frame]) -> Path:
    messages = [truth.SerializeToString() for truth in _truths_without_id(frames)]
    found = path.with_suffix(".osi")
    found.write_bytes(b"".join(len(each).to_bytes(4, "little") + each for each in messages))
    return found


def foxglove(path: Path, frames: list[Frame]) -> Path:
    """Write a scene in which the parked car is told once, without an id: it stays."""
    messages = drives.scenes([frame._replace(cars=[car for car in frame.cars if car.name != "1"]) for frame in frames])
    messages[3][3]["entities"].append(foxglove_log.entity("", frames[3].t_s, PARKED.x))
    return foxglove_log.write(path.with_suffix(".mcap"), messages)


def ros(path: Path, frames: list[Frame]) -> Path:
    def name(car: Car) -> str:
        return "" if car.name == "1" else car.name

    messages = [
        ros_log.detections(frame.t_s, *(ros_log.detection(name(car), car.x, car.y, ("car", 1.0)) for car in frame.cars))
        for frame in frames
    ]
    return ros_log.write(path.with_suffix(".mcap"), messages)


def sumo(path: Path, frames: list[Frame]) -> Path:
    rows = [
        {"time": f"{frame.t_s:.2f}", "id": "" if car.name == "1" else car.name, "x": car.x + 2.25, "y": car.y, "angle": 90.0,
         "type": "DEFAULT_VEHTYPE", "speed": car.vx}
        for frame in frames
        for car in frame.cars
    ]  # fmt: skip
    found = path.with_suffix(".csv")
    found.write_text(fcd_text.csv(rows), encoding="utf-8")
    return found


NEED_NO_MAPPING: Final[dict[str, Write]] = {
    "parquet without id": parquet_without("actor_id"),
    "parquet without time": parquet_without("t_ns"),
    "osi-mcap": osi_mcap,
    "osi-file": osi_file,
    "foxglove": foxglove,
    "ros": ros,
    "sumo": sumo,
}
MAPPED: Final[dict[str, Write]] = {
    "cut lines": csv_where(_cut),
    "no time": csv_where(lambda line: "x" + line),
    "no id": csv_where(lambda line: line.replace(",1,", ",,")),
    "by actor": csv_by_actor,
    "parquet": mapped_parquet,
}


def verdicts(tmp_path: Path, writers: dict[str, Write], **options: Any) -> dict[str, tuple[bool, set[str]]]:
    """Return, for each log, whether its drive is lossy, and the verdicts, with somebody else on the road and without."""
    logs = [
        write(tmp_path / f"{name}, {'alone' if alone else 'with another'}", scene(alone=alone))
        for name, write in writers.items()
        for alone in (False, True)
    ]
    result = drivelint.check(logs, rules="ukhc.no-collision", ego="0", annotate=False, robustness=False, **options)
    rows = result.verdicts.arrow().to_pylist()
    return {
        drive["file_name"].rpartition(".")[0]: (
            drive["lossy"],
            {row["verdict"] for row in rows if row["drive_id"] == drive["drive_id"]},
        )
        for drive in result.drives.arrow().to_pylist()
    }


def mapping(tmp_path: Path, text: str = drives.MAPPING) -> str:
    path = tmp_path / "mapping.toml"
    path.write_text(text, encoding="utf-8")
    return str(path)


@pytest.mark.ci
def test_the_whole_logs_show_the_collision(tmp_path: Path) -> None:
    found = verdicts(tmp_path, {"csv": drives.csv}, mapping=mapping(tmp_path))
    found |= verdicts(tmp_path, {"osi-mcap": drives.osi_mcap, "foxglove": drives.foxglove})
    assert all("fail" in seen and not lossy for lossy, seen in found.values())


def test_states_that_cannot_be_read(tmp_path: Path) -> None:
    found = verdicts(tmp_path, NEED_NO_MAPPING)
    first = found.pop("foxglove, with another")
    assert found == dict.fromkeys(found, (True, {"unknown"}))
    assert first == (True, {"pass", "unknown"})  # a pass up to the message without an id
    assert len(found) == 2 * len(NEED_NO_MAPPING) - 1


def test_rows_of_tables_that_cannot_be_read(tmp_path: Path) -> None:
    found = verdicts(tmp_path, MAPPED, mapping=mapping(tmp_path))
    assert found == dict.fromkeys(found, (True, {"unknown"}))
    assert len(found) == 2 * len(MAPPED)


@pytest.mark.ci
def test_a_wide_table_with_somebody_without_a_name(tmp_path: Path) -> None:
    found = verdicts(tmp_path, {"wide": wide_csv}, mapping=mapping(tmp_path, WIDE))
    assert found == dict.fromkeys(found, (True, {"unknown"}))


@pytest.mark.parametrize(
    ("lines", "lost_spans"),
    [
        ([31], [(999_999_999, 1_000_000_001)]),
        ([30], [(899_999_999, 1_000_000_001)]),
        ([30, 33, 90], [(899_999_999, 1_100_000_001), (2_899_999_999, 3_000_000_001)]),
        ([0], [(None, 1)]),
        ([118, 119], [(3_899_999_999, None)]),
    ],
)
def test_lines_without_a_time_were_recorded_between_their_neighbours(
    tmp_path: Path, lines: list[int], lost_spans: list[tuple[int | None, int | None]]
) -> None:
    path = drives.csv(tmp_path / "log", scene())
    head, *rows = path.read_text(encoding="utf-8").splitlines()
    path.write_text("\n".join([head, *("oops" if k in lines else row for k, row in enumerate(rows))]), encoding="utf-8")
    trace = read(path, mapping=mapping(tmp_path), ego="0")
    found = [row for row in trace.tables["quality"].to_pylist() if row["check_id"] == "lost_time"]
    assert [(row["t_first_ns"], row["t_last_ns"]) for row in found] == lost_spans
