"""Messages written from columns are what Google's parser reads of them, whatever is in the columns."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyarrow as pa
from google.protobuf import descriptor_pb2, descriptor_pool, message_factory
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from drivelint.drive.trace import ACTOR_CLASSES, BRAKE_LIGHTS, INDICATORS
from drivelint.formats.osi.encode import encode_ground_truths, encode_traffic_light, moving_objects
from drivelint.formats.osi.schema import GROUND_TRUTH, descriptor_set

VECTORS = {
    "position": {"x": "x_m", "y": "y_m", "z": "z_m"},
    "orientation": {"yaw": "yaw_rad"},
    "velocity": {"x": "vx_mps", "y": "vy_mps"},
    "acceleration": {"x": "ax_mps2", "y": "ay_mps2"},
    "dimension": {"length": "length_m", "width": "width_m", "height": "height_m"},
}
OPTIONAL = {"z_m", "length_m", "width_m", "height_m"}
COLUMNS = [column for fields in VECTORS.values() for column in fields.values()]
value = st.one_of(st.just(float("nan")), st.floats(allow_nan=False, allow_infinity=False))
actor = st.fixed_dictionaries(
    {
        "number": st.integers(0, (1 << 64) - 1),
        "actor_class": st.integers(-1, len(ACTOR_CLASSES) - 1),
        "indicator": st.integers(-1, len(INDICATORS) - 1),
        "brake_light": st.integers(-1, len(BRAKE_LIGHTS) - 1),
        **dict.fromkeys(COLUMNS, value),
    }
)


def parsed(data: bytes) -> Any:
    pool = descriptor_pool.DescriptorPool()
    for file in descriptor_pb2.FileDescriptorSet.FromString(descriptor_set()).file:
        pool.Add(file)
    return message_factory.GetMessageClass(pool.FindMessageTypeByName(GROUND_TRUTH)).FromString(data)


def objects(rows: list[dict[str, Any]], *, heights: bool) -> pa.StructArray:
    return moving_objects(
        np.array([row["number"] for row in rows], np.uint64),
        {name: np.array([row[name] for row in rows], np.float64) for name in COLUMNS},
        {name: np.array([row[name] for row in rows], np.int8) for name in ("actor_class", "indicator", "brake_light")},
        log_has_heights=heights,
    )


def messages(t_ns: list[int], host: int | None, items: pa.StructArray, starts: NDArray[np.int64]) -> list[bytes]:
    found: list[bytes] = encode_ground_truths(np.array(t_ns, np.int64), host, items, starts).to_pylist()
    return found


@given(st.lists(actor, max_size=6), st.booleans())
def test_objects(rows: list[dict[str, Any]], heights: bool) -> None:
    cut = len(rows) // 2
    starts = np.array([0, cut, cut, len(rows)])
    first, none, rest = map(parsed, messages([1, 2, 3], None, objects(rows, heights=heights), starts))
    assert (len(first.moving_object), len(none.moving_object)) == (cut, 0)
    for k, (row, item) in enumerate(zip(rows, [*first.moving_object, *rest.moving_object], strict=True)):
        (data,) = messages([0], None, objects(rows, heights=heights), np.array([k, k + 1]))
        (alone,) = parsed(data).moving_object
        assert item.SerializeToString() == alone.SerializeToString()
        assert item.id.value == row["number"]
        for vector, fields in VECTORS.items():
            known = {name for name, column in fields.items() if not np.isnan(row[column])}
            if heights and vector == "position" and {"x", "y"} <= known:
                known |= {"z"}
            must = {name for name, column in fields.items() if column not in OPTIONAL}
            written = {f.name for f, _ in getattr(item.base, vector).ListFields()}
            assert written == (known if must <= known else set()), vector
            for name in written:
                got = getattr(getattr(item.base, vector), name)
                assert np.float64(got).tobytes() == np.float64(row[fields[name]]).tobytes()
        lights = item.vehicle_classification.light_state
        assert lights.HasField("indicator_state") == (row["indicator"] >= 0)
        assert lights.HasField("brake_light_state") == (row["brake_light"] >= 0)


@given(st.integers(-(1 << 62), 1 << 62), st.one_of(st.none(), st.integers(0, (1 << 64) - 1)))
def test_heads(t_ns: int, host: int | None) -> None:
    (data,) = messages([t_ns], host, objects([], heights=False), np.array([0, 0]))
    truth = parsed(data)
    assert truth.timestamp.seconds * 1_000_000_000 + truth.timestamp.nanos == t_ns
    assert 0 <= truth.timestamp.nanos < 1_000_000_000
    assert truth.HasField("host_vehicle_id") == (host is not None)
    assert truth.host_vehicle_id.value == (host or 0)


def test_ids_of_one_byte_and_of_two() -> None:
    row = dict.fromkeys(COLUMNS, 1.0) | {"actor_class": 0, "indicator": 0, "brake_light": -1}
    many = objects([row | {"number": k} for k in range(300)], heights=True)
    (whole,) = messages([0], 1, many, np.array([0, 300]))
    assert [item.id.value for item in parsed(whole).moving_object] == list(range(300))


def test_a_red_and_amber_light_is_two_bulbs_of_one_signal() -> None:
    bulbs = parsed(encode_traffic_light("s7", "red_amber", (3, 4))).traffic_light
    assert [(b.id.value, b.classification.color, b.classification.mode) for b in bulbs] == [(3, 2, 3), (4, 3, 3)]
    assert {(r.type, *r.identifier) for b in bulbs for r in b.source_reference} == {("net.asam.opendrive", "s7")}
