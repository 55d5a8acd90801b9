"""What convert writes, read by a reader that is not ours, and what it refuses to do."""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING, Any, Literal

import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drivelint.convert import ConvertRequest, convert
from drivelint.drive.trace import IngestOptions
from drivelint.errors import TraceError, UsageError
from drivelint.formats import read_trace
from drivelint.formats.osi.writer import assign_osi_ids
from drivelint.formats.protobuf.wire import varint
from drivelint.result.publishing import OutputError
from tests.convert.stock_reader import messages
from tests.formats.osi import osi_log
from tests.shared_data import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.drive.trace import Trace

FIXTURE = ROOT / "fixtures" / "overtake"
ROAD = FIXTURE / "road.xodr"
SAFE: dict[str, Any] = {"mapping": str(FIXTURE / "mapping.toml"), "map": ROAD}
STATE = {
    "t_ns": 0, "actor_id": "a", "x_m": 1.5, "y_m": -2.25, "z_m": 0.5, "yaw_rad": 0.1, "vx_mps": 3.0, "vy_mps": 0.0,
    "ax_mps2": -0.5, "ay_mps2": 0.25, "indicator": "left", "brake_light": "strong",
}  # fmt: skip


def folder(
    path: Path, states: list[dict[str, Any]], actors: list[dict[str, Any]], **tables: list[dict[str, Any]]
) -> str:
    """Write a canonical folder."""
    path.mkdir()
    columns = {name: pa.array([row.get(name) for row in states]) for name in STATE}
    pq.write_table(pa.table(columns), path / "actor_state.parquet")
    for name, rows in {"actor": actors, **tables}.items():
        pq.write_table(pa.Table.from_pylist(rows), path / f"{name}.parquet")
    return str(path)


def again(path: Path) -> Trace:
    return read_trace(path, IngestOptions(need_ego=False))


def targets(path: Path) -> list[tuple[Literal["mcap", "parquet"], Path]]:
    return [("mcap", path / "m"), ("parquet", path / "p")]


def test_a_frame_as_others_read_it(tmp_path: Path) -> None:
    big = str((1 << 64) - 1)
    states = [STATE | {"actor_id": "7"}, {"t_ns": 0, "actor_id": big, "x_m": 4.0, "y_m": 5.0, "yaw_rad": None}]
    actors: list[dict[str, Any]] = [
        {"actor_id": "7", "actor_class": "van", "length_m": 5.0, "width_m": 2.0, "height_m": 2.5, "is_ego": True},
        {
            "actor_id": big,
            "actor_class": "pedestrian",
            "length_m": None,
            "width_m": None,
            "height_m": None,
            "is_ego": False,
        },
    ]
    written = convert(ConvertRequest(folder(tmp_path / "drive", states, actors), "mcap", tmp_path / "out"))
    ((topic, log_time, truth),) = messages(written.path)
    assert (topic, log_time, truth.host_vehicle_id.value) == ("ground_truth", 0, 7)
    assert (truth.timestamp.seconds, truth.timestamp.nanos, truth.version.version_major) == (0, 0, 3)
    walker, van = truth.moving_object  # in order of their ids as texts
    base = van.base
    assert (van.id.value, walker.id.value) == (7, (1 << 64) - 1)
    assert (base.position.x, base.position.y, base.position.z, base.orientation.yaw) == (1.5, -2.25, 0.5, 0.1)
    assert (base.velocity.x, base.velocity.y, base.acceleration.x, base.acceleration.y) == (3.0, 0.0, -0.5, 0.25)
    assert (base.dimension.length, base.dimension.width, base.dimension.height) == (5.0, 2.0, 2.5)
    lights = van.vehicle_classification.light_state
    assert (van.type, van.vehicle_classification.type) == (2, 6)
    assert (lights.indicator_state, lights.brake_light_state) == (3, 4)
    assert (walker.type, walker.HasField("vehicle_classification")) == (3, False)
    assert [walker.base.HasField(name) for name in ("dimension", "orientation", "velocity", "acceleration")] == [
        False
    ] * 4


def test_what_osi_cannot_say_comes_back(tmp_path: Path) -> None:
    """Names, an actor without states, classes, several egos, heights known of some, events, signals, a clock before zero."""
    states = [
        STATE | {"t_ns": t, "actor_id": name, "x_m": 1.5 + 3.0 * t * 1e-9, "z_m": z}
        for name, z in (("Ego", 0.5), ("cone", None))
        for t in range(-200_000_000, 300_000_000, 100_000_000)
    ]
    states[3]["x_m"] = states[3]["y_m"] = states[3]["z_m"] = None
    actors: list[dict[str, Any]] = [
        {"actor_id": "Ego", "actor_class": "car", "length_m": 4.5, "width_m": 1.8, "height_m": None, "is_ego": True},
        {"actor_id": "cone", "actor_class": "object", "length_m": 0.4, "width_m": 0.4, "height_m": 0.7, "is_ego": True},
        {
            "actor_id": "ghost",
            "actor_class": None,
            "length_m": None,
            "width_m": None,
            "height_m": None,
            "is_ego": False,
        },
    ]
    signals = [
        {"signal_id": "s1", "t_ns": 100_000_000 * k, "state": state}
        for k, state in enumerate(["red", "red_amber", "amber", "green", "flashing", "off", None])
    ]
    events = [{"actor_id": "Ego", "t_ns": 50_000_000, "event": "mirror_check", "value": None}]
    log = [
        {
            "sensor_range_m": 80.0,
            "utc_start_ns": 1_700_000_000_000_000_000,
            "map_offset_x_m": 0.1,
            "map_offset_y_m": -2.0,
        }
    ]
    holds = [{"condition": "weather", "value": "wet"}, {"condition": "engaged", "value": "yes"}]
    given_folder = folder(
        tmp_path / "d", states, actors, signal_state=signals, declared_event=events, data_log=log, drive_condition=holds
    )
    original = again(tmp_path / "d")
    mcap = convert(ConvertRequest(given_folder, "mcap", tmp_path / "m")).path
    back = again(mcap)
    for name in ("actor", "actor_state", "signal_state", "declared_event", "drive_condition"):
        assert back.tables[name].num_rows
        assert back.tables[name].drop_columns("drive_id") == original.tables[name].drop_columns("drive_id"), name
    for name in ("sensor_range_m", "utc_start_ns", "map_offset_x_m", "map_offset_y_m", "t_start_ns"):
        assert back.tables["data_log"][name] == original.tables["data_log"][name]
    assert back.map_offset == (0.1, -2.0)
    read = messages(mcap)
    assert [m for m in read if m[0] == "declared_event"] == [("declared_event", 250_000_000, {**events[0]})]
    frames = [m for m in read if m[0] == "ground_truth"]
    assert [time for _, time, _ in frames] == [100_000_000 * k for k in range(9)]
    assert (frames[0][2].timestamp.seconds, frames[0][2].timestamp.nanos) == (-1, 800_000_000)


def test_findings_are_carried_but_not_those_about_the_ego(tmp_path: Path) -> None:
    log = osi_log.write(tmp_path / "log.mcap", osi_log.truths(osi_log.drive(20, v=(0.0, 0.0))))
    for to, out in targets(tmp_path):
        path = convert(ConvertRequest(str(log), to, out)).path
        checks = {row["check_id"]: row for row in again(path).tables["quality"].to_pylist()}
        assert checks["velocity_derived"]["message"].startswith("velocity 0 throughout"), to
        other = read_trace(path, IngestOptions(ego="2")).tables["quality"].to_pylist()
        about = [row["message"] for row in other if row["check_id"] == "no_indicator"]
        assert len(about) == 1
        assert "ego (2)" in about[0]


def test_map_and_offset_go_along(tmp_path: Path) -> None:
    for to, out in targets(tmp_path):
        written = convert(ConvertRequest(str(FIXTURE / "safe.csv"), to, out, map_offset=(0.25, -0.5), **SAFE))
        trace = again(written.path)
        assert (trace.embedded_map, trace.map_offset) == (ROAD.read_bytes(), (0.25, -0.5))
        assert trace.tables["data_log"]["map_offset_x_m"].to_pylist() == [0.25]


def test_the_map_of_the_place_goes_along(tmp_path: Path) -> None:
    """From a folder of maps, the one on which the drive lies."""
    maps = tmp_path / "maps"
    maps.mkdir()
    (maps / "here.xodr").write_bytes(ROAD.read_bytes())
    elsewhere = ROAD.read_text(encoding="utf-8").replace('x="0.0"', 'x="90000.0"')
    assert elsewhere != ROAD.read_text(encoding="utf-8")
    (maps / "there.xodr").write_text(elsewhere, encoding="utf-8")
    for to, out in targets(tmp_path):
        given = ConvertRequest(str(FIXTURE / "safe.csv"), to, out, map_dir=maps, mapping=SAFE["mapping"])
        assert again(convert(given).path).embedded_map == ROAD.read_bytes()


def test_a_converted_log_assumes_nothing_of_who_is_not_recorded(tmp_path: Path) -> None:
    for to, out in targets(tmp_path):
        given = ConvertRequest(str(FIXTURE / "safe.csv"), to, out, visibility="line-of-sight", **SAFE)
        assert again(convert(given).path).tables["data_log"]["in_sight"].to_pylist() == [False]


def test_what_a_check_states_does_not_go_along(tmp_path: Path) -> None:
    for to, out in targets(tmp_path):
        given = ConvertRequest(str(FIXTURE / "safe.csv"), to, out, env=("weather=wet",), handedness="lht", **SAFE)
        written = convert(given)
        assert again(written.path).tables["drive_condition"].num_rows == 0, to
        said = [note for note in written.notes if "not part of the converted log" in note]
        assert [note.split()[0] for note in said] == ["--handedness", "--env"], to


@pytest.mark.parametrize("to", ["mcap", "parquet"])
def test_same_bytes_every_time(tmp_path: Path, to: Any) -> None:
    digests = []
    for out in (tmp_path / "a" / "x", tmp_path / "b" / "x"):
        convert(ConvertRequest(str(FIXTURE / "safe.csv"), to, out, **SAFE))
        digests.append({file.name: hashlib.sha256(file.read_bytes()).hexdigest() for file in out.iterdir()})
    assert digests[0] == digests[1]
    convert(ConvertRequest(str(FIXTURE / "safe.csv"), to, tmp_path / "a" / "x", **SAFE))  # over its own earlier result
    assert {f.name for f in (tmp_path / "a" / "x").iterdir()} == digests[0].keys()


def test_a_full_disk_leaves_nothing_behind(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(sink: Any, *_: object, **_options: object) -> int:
        sink.write(b"half")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("drivelint.formats.osi.writer.write_and_count_messages", full)
    with pytest.raises(OutputError, match=r"safe\.mcap: cannot be written: No space left") as error:
        convert(ConvertRequest(str(FIXTURE / "safe.csv"), "mcap", tmp_path, **SAFE))
    assert error.value.exit_code == 75
    assert list(tmp_path.iterdir()) == []


def test_an_earlier_map_does_not_stay(tmp_path: Path) -> None:
    convert(ConvertRequest(str(FIXTURE / "safe.csv"), "parquet", tmp_path / "d", **SAFE))
    convert(ConvertRequest(str(FIXTURE / "near_miss.csv"), "parquet", tmp_path / "d", mapping=SAFE["mapping"]))
    assert again(tmp_path / "d").embedded_map is None


@pytest.mark.parametrize(
    ("trace", "to", "out", "message"),
    [
        ("d", "parquet", "d", "would overwrite the log itself"),
        ("d/actor_state.parquet", "parquet", "d", "would overwrite the log itself"),
        ("log.mcap", "mcap", ".", "would overwrite the log itself"),
        ("drive.csv", "mcap", ".", r"drive\.mcap exists and was not written by convert"),
        ("drive.csv", "parquet", "notes", "holds other files"),
        ("log.mcap", "parquet", "d", "holds other files"),
        ("log.mcap", "parquet", "drive.csv", "is a file"),
        (".", "mcap", "new", "convert takes one at a time"),
    ],
)
def test_nothing_else_is_overwritten(tmp_path: Path, trace: str, to: Any, out: str, message: str) -> None:
    folder(tmp_path / "d", [STATE], [{"actor_id": "a"}])
    log = osi_log.write(tmp_path / "log.mcap", osi_log.truths(osi_log.drive(3)))
    (tmp_path / "drive.mcap").write_bytes(log.read_bytes())
    (tmp_path / "drive.csv").write_bytes((FIXTURE / "safe.csv").read_bytes())
    (tmp_path / "notes").mkdir()
    (tmp_path / "notes" / "map.xodr").write_text("mine", encoding="utf-8")
    before = {file: file.read_bytes() for file in tmp_path.rglob("*") if file.is_file()}
    with pytest.raises(UsageError, match=message):
        convert(ConvertRequest(str(tmp_path / trace), to, tmp_path / out, mapping=SAFE["mapping"]))
    assert {file: file.read_bytes() for file in tmp_path.rglob("*") if file.is_file()} == before


def test_a_map_that_osi_cannot_hold(tmp_path: Path) -> None:
    text = ROAD.read_text(encoding="utf-8").replace("<header", "<!-- Straße --><header", 1)
    road = tmp_path / "latin.xodr"
    road.write_bytes(('<?xml version="1.0" encoding="ISO-8859-1"?>' + text.partition("?>")[2]).encode("latin-1"))
    order = ConvertRequest(str(FIXTURE / "safe.csv"), "mcap", tmp_path / "out", map=road, mapping=SAFE["mapping"])
    with pytest.raises(UsageError, match=r"latin\.xodr is not UTF-8"):
        convert(order)
    assert not (tmp_path / "out").exists()
    parquet = convert(ConvertRequest(order.trace, "parquet", tmp_path / "p", map=road, mapping=order.mapping))
    assert again(parquet.path).embedded_map == road.read_bytes()


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("drivelint.trace", {"map_offset_m": "[1.0]"}, "record drivelint.trace cannot be read"),
        ("drivelint.trace", {"map_offset_m": "1,2"}, "record drivelint.trace cannot be read"),
        ("drivelint.actors", {"1": '{"actor_id": "0"}'}, "gives two actors one name"),
        ("drivelint.actors", {"1": '{"actor_id": "x", "actor_class": "lorry"}'}, "'lorry' is no actor class"),
        ("drivelint.actors", {"1": "{}"}, "drivelint.actors, actor 1 cannot be read"),
    ],
)
def test_records_that_do_not_fit(tmp_path: Path, name: str, content: dict[str, str], message: str) -> None:
    from mcap.writer import Writer

    path = tmp_path / "log.mcap"
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start()
        writer.add_metadata(name, content)
        schema = writer.register_schema("osi3.GroundTruth", "protobuf", osi_log.DESCRIPTOR_SET)
        channel = writer.register_channel("t", "protobuf", schema)
        for item in osi_log.truths(osi_log.drive(3)):
            writer.add_message(channel, item.log_time, item.data, item.log_time)
        writer.finish()  # type: ignore[no-untyped-call]
    with pytest.raises(TraceError, match=message) as error:
        again(path)
    assert "\n" not in str(error.value)


@pytest.mark.ci
@given(st.sets(st.one_of(st.integers(0, 1 << 65).map(str), st.text()), min_size=1).map(sorted))
def test_every_actor_has_a_number_of_its_own(actors: list[str]) -> None:
    numbers = assign_osi_ids(actors)
    assert len(set(numbers.values())) == len(actors)
    assert all(0 <= number < 1 << 64 for number in numbers.values())


@given(st.integers(0, (1 << 64) - 1))
def test_varint(value: int) -> None:
    groups = varint(value)
    assert sum((byte & 0x7F) << 7 * k for k, byte in enumerate(groups)) == value
    assert [byte >> 7 for byte in groups] == [1] * (len(groups) - 1) + [0]
