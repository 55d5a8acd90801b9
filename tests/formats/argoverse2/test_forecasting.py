"""Motion forecasting scenarios: tracks by step, the vehicle's own track moved to its middle, nobody's size."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any

import pytest

from drivelint.errors import TraceError
from drivelint.formats import expand_traces
from tests.formats.argoverse2.argoverse_log import START_NS, STEP_NS, road, scenario, straight, track
from tests.formats.logs import actors, log, quality, read, states

if TYPE_CHECKING:
    from pathlib import Path

STEPS = range(110)
ROWS = [*track("AV", STEPS, heading=0.1), *track("7", range(20, 80), y=4.0)]


def test_tracks_by_step(tmp_path: Path) -> None:
    trace = read(scenario(tmp_path / "s", ROWS))
    assert (log(trace)["format"], log(trace)["utc_start_ns"]) == ("argoverse2-forecasting", None)
    rows = states(trace, "7")
    assert [row["t_ns"] for row in rows] == [START_NS + k * STEP_NS for k in range(20, 80)]
    assert (rows[0]["x_m"], rows[0]["y_m"], rows[0]["yaw_rad"], rows[0]["vx_mps"]) == pytest.approx(
        (10.0, 4.0, 0.0, 5.0)
    )
    assert rows[0]["z_m"] is None
    assert (actors(trace)["7"]["actor_class"], actors(trace)["7"]["length_m"]) == ("vehicle", None)


def test_the_vehicle_that_records_is_the_ego(tmp_path: Path) -> None:
    """Its point is the rear axle."""
    trace = read(scenario(tmp_path / "s", ROWS))
    ego = actors(trace)["AV"]
    assert (ego["is_ego"], ego["actor_class"], ego["length_m"], ego["width_m"]) == (
        True,
        "car",
        4.869,
        pytest.approx(2.127),
    )
    first = states(trace, "AV")[0]
    assert (first["x_m"], first["y_m"]) == pytest.approx((1.339 * math.cos(0.1), 1.339 * math.sin(0.1)))
    assert quality(trace)["assumed_size"]["actor_id"] == "AV"
    assert "AV" not in quality(trace)["no_size"]["message"]


@pytest.mark.parametrize("without", [("start_timestamp",), ("num_timestamps", "end_timestamp")])
def test_without_stamps_steps_are_a_tenth_of_a_second(tmp_path: Path, without: tuple[str, ...]) -> None:
    trace = read(scenario(tmp_path / "s", ROWS, without))
    assert [row["t_ns"] for row in states(trace, "AV")] == [k * STEP_NS for k in STEPS]


def test_every_type_has_its_class(tmp_path: Path) -> None:
    """The ten of av2-api's `ObjectType`."""
    classes = {
        "vehicle": "vehicle", "pedestrian": "pedestrian", "motorcyclist": "motorcycle", "cyclist": "bicycle", "bus": "bus",
        "static": "object", "background": "object", "construction": "object", "riderless_bicycle": "object", "unknown": None,
    }  # fmt: skip
    rows = [
        row for i, word in enumerate(classes) for row in track(word, range(20), y=9.0 * i, speed=0.0, object_type=word)
    ]
    trace = read(scenario(tmp_path / "s", [*ROWS, *rows]))
    assert {name: actors(trace)[name]["actor_class"] for name in classes} == classes


def test_a_folder_has_its_map_and_city(tmp_path: Path) -> None:
    file = scenario(tmp_path / "s", ROWS)
    content = json.dumps(road(straight(1))).encode()
    (tmp_path / "s" / "log_map_archive_s.json").write_bytes(content)
    trace = read(tmp_path / "s")
    assert trace.embedded_map == content
    assert trace.geo_reference == "+proj=utm +zone=14 +datum=WGS84 +units=m +no_defs"
    assert trace.notes == []
    alone = read(file)
    assert alone.embedded_map is None
    assert alone.notes == ["its map log_map_archive_s.json is in the same folder: give the folder, or use --map"]
    assert [path.name for path in expand_traces([str(tmp_path)])] == ["s"]


def test_a_folder_without_a_map_or_with_two(tmp_path: Path) -> None:
    scenario(tmp_path / "s", ROWS)
    assert read(tmp_path / "s").notes == ["its map is missing: log_map_archive_*.json"]
    for name in "ab":
        (tmp_path / "s" / f"log_map_archive_{name}.json").write_text("{}")
    assert "2 maps" in quality(read(tmp_path / "s"))["own_map_unusable"]["message"]


@pytest.mark.parametrize("city", ["austin", "dearborn", "miami", "palo-alto", "pittsburgh", "washington-dc"])
def test_every_city_lies_on_the_earth(tmp_path: Path, city: str) -> None:
    trace = read(scenario(tmp_path / "s", [{**row, "city": city} for row in ROWS]))
    assert trace.geo_reference is not None


def test_a_city_that_argoverse_does_not_have(tmp_path: Path) -> None:
    trace = read(scenario(tmp_path / "s", [{**row, "city": "atlantis"} for row in ROWS]))
    assert trace.geo_reference is None


def test_a_scenario_without_its_vehicle_has_no_ego(tmp_path: Path) -> None:
    path = scenario(tmp_path / "s", track("7", STEPS))
    with pytest.raises(TraceError, match=r"no ego: the log's ego 'AV' has no states"):
        read(path)
    assert not actors(read(path, need_ego=False))["7"]["is_ego"]


def test_numbers_that_are_none_and_rows_without_a_track(tmp_path: Path) -> None:
    rows = [
        *track("AV", STEPS),
        *track("7", range(30), y=4.0, position_x=math.nan),
        {**track("8", [9])[0], "track_id": None},
    ]
    trace = read(scenario(tmp_path / "s", rows))
    assert {row["x_m"] for row in states(trace, "7")} == {None}
    assert len(states(trace, "7")) == 30
    found = {row["check_id"]: row for row in trace.tables["quality"].to_pylist()}
    assert (found["dropped_row"]["n"], found["lost_time"]["t_first_ns"]) == (1, START_NS + 9 * STEP_NS - 1)


def test_a_track_twice_at_a_step(tmp_path: Path) -> None:
    trace = read(scenario(tmp_path / "s", [*ROWS, *track("7", [40], y=9.0)]))
    at = next(row for row in states(trace, "7") if row["t_ns"] == START_NS + 40 * STEP_NS)
    assert at["y_m"] is None


def test_broken_scenarios_are_named_in_one_line(tmp_path: Path) -> None:
    path = scenario(tmp_path / "cut", ROWS)
    path.write_bytes(path.read_bytes()[:-40])
    two = [{**row, "scenario_id": "other"} for row in ROWS]
    scenario(tmp_path / "folder", ROWS)
    scenario(tmp_path / "folder", two, name="scenario_t.parquet")
    scenario(tmp_path / "columns", ROWS, ["heading"])
    cases: list[tuple[Path, str]] = [
        (path, "not readable as Parquet"),
        (scenario(tmp_path / "two", [*ROWS, *two]), "has 2 scenarios"),
        (tmp_path / "folder", "2 scenarios in one folder"),
        (tmp_path / "columns", "no column heading"),
        (scenario(tmp_path / "text", [{**row, "position_x": "east"} for row in ROWS]), "'position_x' is string"),
    ]
    for broken, message in cases:
        with pytest.raises(TraceError, match=message) as error:
            read(broken)
        assert str(error.value).startswith(str(broken))
        assert "\n" not in str(error.value)


def test_another_table_is_none(tmp_path: Path) -> None:
    path: Any = scenario(tmp_path / "s", ROWS, ["object_type"], name="table.parquet")
    with pytest.raises(TraceError, match="mapping"):
        read(path)
