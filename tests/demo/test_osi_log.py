"""Scenes as OSI in MCAP: what a stock reader finds, and that ingest makes of it what the scene is."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

import pytest
from google.protobuf import descriptor_pb2, descriptor_pool, message_factory
from mcap.reader import make_reader

from drivelint.drive.trace import IngestOptions
from drivelint.formats import read_trace
from tests.demo.actors import car, pedestrian
from tests.demo.line import straight
from tests.demo.osi_log import osi_mcap
from tests.demo.road import Road
from tests.demo.scene import Scene
from tests.demo.scene_drive import drive_of_scene
from tests.demo.scenes import all_scenes

if TYPE_CHECKING:
    from pathlib import Path

SCENE = Scene(
    "walk",
    "A car brakes for somebody on foot.",
    Road((straight(100.0),)),
    car().starts(10.0).drives(5.0).then_drives(0.0, at_s=1.0, rate=2.5).signals("nearside", 0.5, 1.5),
    (pedestrian().starts(40.0).drives(1.0),),
    3.0,
)


def test_a_stock_reader_finds_every_message_with_checksums_on() -> None:
    reader = make_reader(io.BytesIO(osi_mcap(SCENE)), validate_crcs=True)
    messages = list(reader.iter_messages(topics=["ground_truth"]))
    assert [m.log_time for _, _, m in messages] == [k * 100_000_000 for k in range(31)]
    schema, channel, last = messages[-1]
    assert schema is not None
    assert (schema.name, schema.encoding, channel.message_encoding) == ("osi3.GroundTruth", "protobuf", "protobuf")
    files = descriptor_pb2.FileDescriptorSet.FromString(schema.data)
    pool = descriptor_pool.DescriptorPool()
    for file in files.file:
        pool.Add(file)
    truth: Any = message_factory.GetMessageClass(pool.FindMessageTypeByName(schema.name)).FromString(last.data)
    ego, walker = truth.moving_object
    assert (ego.id.value, truth.host_vehicle_id.value, walker.id.value) == (1, 1, 2)
    assert (ego.base.position.x, ego.base.position.y) == pytest.approx((20.0, 1.75), abs=1e-3)
    assert (ego.type, ego.vehicle_classification.type) == (2, 4)
    assert walker.type == 3
    assert not walker.HasField("vehicle_classification")
    metadata = {record.name: record.metadata for record in reader.iter_metadata()}
    assert metadata["net.asam.osi.trace"]["description"] == SCENE.shows


def test_lights_are_told_as_they_are(tmp_path: Path) -> None:
    path = tmp_path / "walk.mcap"
    path.write_bytes(osi_mcap(SCENE))
    rows = read_trace(path, IngestOptions()).tables["actor_state"].to_pylist()
    ego = {row["t_ns"] // 10**8: (row["indicator"], row["brake_light"]) for row in rows if row["actor_id"] == "1"}
    assert ego[4] == ("off", "off")
    assert ego[5] == ("left", "off")
    assert ego[12] == ("left", "on")
    assert ego[15] == ("off", "on")
    assert {(row["indicator"], row["brake_light"]) for row in rows if row["actor_id"] == "2"} == {(None, None)}


@pytest.mark.sample(10, ci=18)
@pytest.mark.parametrize("scene", all_scenes(), ids=lambda scene: scene.name)
def test_a_scene_in_memory_is_what_ingest_reads(scene: Scene, tmp_path: Path) -> None:
    path = tmp_path / f"{scene.name}.mcap"
    path.write_bytes(osi_mcap(scene))
    read = read_trace(path, IngestOptions())
    made = drive_of_scene(scene).trace
    assert made.drive_id == read.drive_id
    assert {name: table.to_pylist() for name, table in made.tables.items()} == {
        name: table.to_pylist() for name, table in read.tables.items()
    }
    serious = [row for row in read.tables["quality"].to_pylist() if row["severity"] != "info"]
    assert serious == [] or scene.name in {"collision", "collision-25mph", "overtake-two-too-many"}
