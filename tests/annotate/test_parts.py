"""The parts: the wire format against the protobuf library, Foxglove's types against its package, our schemas, the clock."""

from __future__ import annotations

import json
from functools import cache
from typing import Any

import numpy as np
import pytest
from google.protobuf import descriptor_pb2, descriptor_pool, message_factory, timestamp_pb2
from hypothesis import given, settings
from hypothesis import strategies as st

from drivelint.annotate import clock, result_messages
from drivelint.annotate.tracks import tracks
from drivelint.formats.foxglove import messages as foxglove
from drivelint.formats.protobuf import wire
from drivelint.resources import folder
from drivelint.sql.declarations import column_comments

VIEWER_TYPES = {"string", "number", "integer", "boolean", "array"}
"""What Foxglove's and Lichtblick's readers of JSON Schema take for a plain field; a list of types or null ends the channel."""


@cache
def message_class(name: str) -> Any:
    """Return the class of a Foxglove message, from our own declaration."""
    pool = descriptor_pool.DescriptorPool()
    for file in descriptor_pb2.FileDescriptorSet.FromString(foxglove.schema(name).data).file:
        pool.Add(file)
    return message_factory.GetMessageClass(pool.FindMessageTypeByName(f"foxglove.{name}"))


@pytest.mark.parametrize("name", ["SceneUpdate", "FrameTransform", "Log", "Event"])
def test_foxgloves_types_are_those_of_its_own_package(name: str) -> None:
    package = pytest.importorskip("foxglove.messages", reason="the package foxglove-sdk is not installed")

    def declared(data: bytes) -> dict[str, Any]:
        files = descriptor_pb2.FileDescriptorSet.FromString(data).file
        return {m.name: m for file in files if file.package == "foxglove" for m in file.message_type}

    assert declared(foxglove.schema(name).data) == declared(getattr(package, name).get_schema().data)


@pytest.mark.parametrize(("name", "theirs"), [("LocationFix", "LocationFix"), ("GeoJSON", "GeoJson")])
def test_what_is_written_of_a_place_is_declared_as_foxglove_declares_it(name: str, theirs: str) -> None:
    """Its optional fields of late (heading, velocity, colour) are not written, nor declared."""
    package = pytest.importorskip("foxglove.messages", reason="the package foxglove-sdk is not installed")
    schema = getattr(package, theirs).get_schema()
    assert schema.name == foxglove.schema(name).name

    def declared(data: bytes) -> Any:
        files = descriptor_pb2.FileDescriptorSet.FromString(data).file
        return next(m for file in files for m in file.message_type if m.name == name)

    mine, own = declared(foxglove.schema(name).data), declared(schema.data)
    assert {field.number for field in own.field} - {field.number for field in mine.field} <= {8, 9, 10, 11}
    assert all(field in own.field for field in mine.field)
    assert mine.enum_type == own.enum_type


@settings(deadline=None)
@given(st.integers(0, 2**63 - 1))
def test_times_are_read_back(t_ns: int) -> None:
    stamp = message_class("Log").FromString(wire.time(1, t_ns)).timestamp
    assert stamp.seconds * 10**9 + stamp.nanos == t_ns


@settings(deadline=None)
@given(st.lists(st.integers(0, 2**63 - 1), min_size=1, max_size=5))
def test_columns_of_times_are_read_back(times: list[int]) -> None:
    column = wire.timestamps(1, np.array(times, np.uint64))
    assert len({row.tobytes().__len__() for row in column}) == 1
    read = [message_class("Log").FromString(row.tobytes()).timestamp.ToNanoseconds() for row in column]
    assert read == times
    assert timestamp_pb2.Timestamp.FromString(column[0, 2:].tobytes()).ToNanoseconds() == times[0]


@settings(deadline=None)
@given(st.lists(st.tuples(*[st.floats(allow_nan=False)] * 3), max_size=4), st.integers(0, 2**20), st.text(max_size=300))
def test_fields_are_read_back(xyz: list[tuple[float, float, float]], whole: int, text: str) -> None:
    line = message_class("SceneUpdate")().entities.add().lines.add()
    line.ParseFromString(
        wire.points(5, np.array(xyz, np.float64).reshape(-1, 3)) + wire.indices(8, np.array([whole], np.uint32))
    )
    assert [(p.x, p.y, p.z) for p in line.points] == xyz
    assert list(line.indices) == [whole]
    log = message_class("Log").FromString(wire.text(3, text) + wire.integer(2, whole))
    assert log.message == text.encode("utf-8", "replace").decode()
    assert log.level == whole


@pytest.mark.parametrize("name", ["verdict", "finding"])
def test_our_messages_have_the_columns_of_the_table(name: str) -> None:
    content = json.loads((folder("schemas") / f"{name}-message.schema.json").read_bytes())
    assert {key: field["description"] for key, field in content["properties"].items()} == column_comments("verdict")[
        name
    ]
    assert {field["type"] for field in content["properties"].values()} <= VIEWER_TYPES
    sql = (folder("schemas") / "verdict.sql").read_text(encoding="utf-8").partition(f"CREATE TABLE {name} (")[2]
    needed = [
        line.split()[0] for line in sql.partition("\n);")[0].splitlines() if " NOT NULL" in line.partition("--")[0]
    ]
    assert content["required"] == needed
    assert (result_messages.message_schema(name).name, result_messages.message_schema(name).encoding) == (
        f"drivelint.{name.title()}",
        "jsonschema",
    )


def test_frames_give_their_log_times() -> None:
    times = clock.of_frames(np.array([20, 10, 10, 30], np.int64), np.array([2, 1, 9, 3], np.uint64))
    assert times.log_times(np.array([5, 10, 19, 20, 99], np.int64)).tolist() == [1, 1, 1, 2, 3]


def test_a_trace_that_begins_before_zero_is_moved() -> None:
    times = clock.of_trace(-5)
    assert (times.log_time_at(-5), times.log_time_at(0), times.shift_ns) == (0, 5, 5)
    assert clock.of_trace(5).log_time_at(7) == 7


def test_who_is_not_seen_for_long_has_no_place() -> None:
    import pyarrow as pa

    times = [0, 100, 200, 900]
    states = {"actor_id": ["a"] * 4, "t_ns": times, "x_m": [0.0, 1.0, None, 9.0], "y_m": [0.0] * 4, "z_m": [None] * 4}
    table = pa.table({**states, "z_m": pa.array([None] * 4, pa.float64()), "yaw_rad": [0.0] * 4})
    actor = {"actor_id": "a", "actor_class": None, "length_m": 4.0, "width_m": None, "height_m": None, "is_ego": True}
    found = tracks({"actor_state": table, "actor": pa.Table.from_pylist([actor])})
    x = found.poses_at("a", np.array([-1, 0, 150, 250, 600, 950], np.int64)).x
    assert np.nan_to_num(x, nan=-1).tolist() == [-1, 0, 1, -1, -1, 9]
    nobody = found.poses_at("b", np.array([0], np.int64))
    assert np.isnan(nobody.x).all()
