"""Traffic lights of 123D logs: states by lane, and where the lights stand."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pyarrow as pa
import pytest

from drivelint.drive.trace import DriveInput
from drivelint.engine.batch import drive_with_map
from drivelint.engine.map_library import MapLibrary
from tests.formats.d123.files import (
    Box,
    Ego,
    Frame,
    arrow,
    ego_states,
    group,
    intersection,
    light_columns,
    straight,
    times,
    write_log,
    write_map,
)
from tests.formats.logs import quality, read
from tests.scenes import derived, rows

GREEN, YELLOW, RED, OFF, UNKNOWN = range(5)
Lights = Sequence[tuple[int, Sequence[tuple[int, int]]]]


def write(folder: Path, lights: Lights, **options: Any) -> Path:
    frames = [Frame(t, [Box("p", 50.0, 9.0)]) for t in times(6)]
    return write_log(folder, frames, ego_states(6), lights=lights, **options)


def light_colours(folder: Path) -> dict[tuple[str, int], str | None]:
    rows = read(folder).tables["signal_state"].to_pylist()
    return {(row["signal_id"], row["t_ns"] // 1_000_000): row["state"] for row in rows}


def test_states_by_lane(tmp_path: Path) -> None:
    lights = [(1_000_000, [(7, GREEN), (8, RED)]), (1_100_000, []), (1_200_000, [(7, YELLOW), (8, UNKNOWN), (9, OFF)])]
    assert light_colours(write(tmp_path / "log", lights)) == {
        ("7", 1000): "green", ("8", 1000): "red", ("7", 1200): "amber", ("8", 1200): None, ("9", 1200): "off",
    }  # fmt: skip


def test_a_state_that_is_not_known(tmp_path: Path) -> None:
    folder = write(tmp_path / "log", [(1_000_000, [(7, 9), (8, RED)])])
    assert light_colours(folder) == {("7", 1000): None, ("8", 1000): "red"}
    assert "does not define (9): 1" in quality(read(folder))["unknown_light_state"]["message"]


def test_lanes_and_states_that_differ_in_number(tmp_path: Path) -> None:
    folder = write(tmp_path / "log", [])
    columns = light_columns([(t, [(7, RED)]) for t in times(6)])
    column = "traffic_light_detections.status"
    columns[column] = pa.array([[RED], [RED], [], None, [RED], [RED]], columns[column].type)
    arrow(folder / "traffic_light_detections.arrow", columns, {})
    assert {t for _, t in light_colours(folder)} == {1000, 1100, 1400, 1500}
    found = quality(read(folder))
    assert found["malformed_row"]["n"] == 2
    assert found["lost_time"]["t_first_ns"] < 1_200_000_000
    assert found["lost_time"]["t_last_ns"] > 1_300_000_000


@pytest.mark.parametrize(("dataset", "state"), [("wod-motion", None), ("nuplan", "red")])
def test_a_light_that_never_changes_may_flash_where_that_is_written_alike(
    tmp_path: Path, dataset: str, state: str | None
) -> None:
    lights = [(t, [(7, RED), (8, RED if k < 3 else GREEN), (9, OFF)]) for k, t in enumerate(times(6))]
    folder = write(tmp_path / "log", lights, dataset=dataset)
    found = light_colours(folder)
    assert {found["7", t] for t in range(1000, 1600, 100)} == {state}
    assert (found["8", 1000], found["8", 1500], found["9", 1000]) == ("red", "green", "off")
    assert ("flashing_or_steady" in quality(read(folder))) == (state is None)


def signals(folder: Path) -> dict[str, Any]:
    """Return the lights of the log's own map by lane."""
    environment, _ = MapLibrary(DriveInput()).find(read(folder))
    assert environment is not None
    return {row["lanelet_id"]: row for row in environment.tables["traffic_signal"].to_pylist()}


def test_a_light_of_the_log_stands_where_its_lane_begins(tmp_path: Path) -> None:
    folder = write(tmp_path / "log", [(t, [(2, RED)]) for t in times(6)])
    write_map(folder / "map.arrow", [straight(1, -50, 20, 0.0, successor_ids=[2]), straight(2, 20, 90, 0.0)])
    (light,) = signals(folder).values()
    assert {name: light[name] for name in ("signal_id", "lanelet_id", "kind", "dynamic", "lane_s_m", "x_m", "y_m")} == {
        "signal_id": "2", "lanelet_id": "2", "kind": "traffic_light", "dynamic": True, "lane_s_m": 0.0, "x_m": 20.0, "y_m": 0.0,
    }  # fmt: skip
    assert light["turns"] == ["left", "right", "straight", "u_turn"]
    environment, _ = MapLibrary(DriveInput()).find(read(folder))
    assert environment is not None
    assert not environment.tables["environment"]["signs_mapped"][0].as_py()


def test_lanes_of_an_intersection_with_lights_have_lights(tmp_path: Path) -> None:
    """The map of the place says so; it stays the same file for every log whose lights it knows."""
    folder = write(tmp_path / "logs" / "nuplan_val" / "log", [(t, [(2, RED)]) for t in times(6)], dataset="nuplan")
    objects = [
        straight(1, -50, 20, 0.0, successor_ids=[2, 3], lane_group_id=1),
        straight(2, 20, 90, 0.0, lane_group_id=2), straight(3, 20, 90, 3.5, lane_group_id=2),
        group(1, [1], None), group(2, [2, 3], 5), intersection(5, [2], 1),
    ]  # fmt: skip
    path = write_map(tmp_path / "maps" / "nuplan" / "nuplan_PIT.arrow", objects, dataset="nuplan")
    trace = read(folder)
    assert trace.embedded_map == path.read_bytes()
    assert set(signals(folder)) == {"2", "3"}
    other = write(tmp_path / "logs" / "nuplan_val" / "other", [(t, [(1, RED)]) for t in times(6)], dataset="nuplan")
    assert read(other).embedded_map != path.read_bytes()
    assert set(signals(other)) == {"1", "2", "3"}


@pytest.mark.sample(1, ci=2)
@pytest.mark.parametrize(("state", "word"), [(RED, "red"), (GREEN, "green"), (UNKNOWN, None)])
def test_an_ego_that_drives_over_a_light(tmp_path: Path, state: int, word: str | None) -> None:
    """Its front passes x = 20, where the lane begins that the light is for."""
    moments = times(40)
    frames = [Frame(t, [Box("p", 50.0, 9.0)]) for t in moments]
    ego = [Ego(t, 0.8 * k, 0.0) for k, t in enumerate(moments)]
    lights = [(t, [(2, state), (3, GREEN)]) for t in moments]
    folder = write_log(tmp_path / "log", frames, ego, lights=lights)
    ways = [straight(1, -50, 20, 0.0, successor_ids=[2]), straight(2, 20, 90, 0.0), straight(3, 20, 90, 3.5)]
    write_map(folder / "map.arrow", ways)
    con = derived(drive_with_map(read(folder), MapLibrary(DriveInput())), tables=["stop_line_crossing"])
    (row,) = rows(con, "FROM stop_line_crossing")
    assert (row["control"], row["signal_id"], row["state"]) == ("traffic_light", "2", word)
