"""Messages written from columns are what Google's parser reads of them, whatever is in the columns."""

from __future__ import annotations

from typing import Any

import numpy as np
from google.protobuf import descriptor_pb2, descriptor_pool, message_factory
from hypothesis import given
from hypothesis import strategies as st

from drivelint.drive.trace import ACTOR_CLASSES, BRAKE_LIGHTS, INDICATORS
from drivelint.formats.osi import encode
from drivelint.formats.osi.encode import Objects, ground_truth_head, moving_objects, traffic_light
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


def objects(rows: list[dict[str, Any]], *, heights: bool) -> Objects:
    return Objects(
        np.array([row["number"] for row in rows], np.uint64),
        {name: np.array([row[name] for row in rows], np.float64) for name in COLUMNS},
        {name: np.array([row[name] for row in rows], np.int8) for name in ("actor_class", "indicator", "brake_light")},
        heights,
    )


@given(st.lists(actor, max_size=6), st.booleans())
def test_objects(rows: list[dict[str, Any]], heights: bool) -> None:
    data, starts = moving_objects(objects(rows, heights=heights))
    content = data.tobytes()
    assert (starts[0], starts[-1], len(starts)) == (0, len(content), len(rows) + 1)
    truth = parsed(content)
    assert len(truth.moving_object) == len(rows)
    for k, (row, item) in enumerate(zip(rows, truth.moving_object, strict=True)):
        (alone,) = parsed(content[starts[k] : starts[k + 1]]).moving_object
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
    truth = parsed(ground_truth_head(t_ns, host))
    assert truth.timestamp.seconds * 1_000_000_000 + truth.timestamp.nanos == t_ns
    assert 0 <= truth.timestamp.nanos < 1_000_000_000
    assert truth.HasField("host_vehicle_id") == (host is not None)
    assert truth.host_vehicle_id.value == (host or 0)


def test_rows_are_laid_out_in_batches(monkeypatch: Any) -> None:
    row = dict.fromkeys(COLUMNS, 1.0) | {"actor_class": 0, "indicator": 0, "brake_light": -1}
    many = objects([row | {"number": k} for k in range(300)], heights=True)  # ids of one byte and of two
    whole = moving_objects(many)[0].tobytes()
    monkeypatch.setattr(encode, "BLOCK_ROWS", 7)
    assert moving_objects(many)[0].tobytes() == whole
    assert [item.id.value for item in parsed(whole).moving_object] == list(range(300))


def test_a_red_and_amber_light_is_two_bulbs_of_one_signal() -> None:
    bulbs = parsed(traffic_light("s7", "red_amber", (3, 4))).traffic_light
    assert [(b.id.value, b.classification.color, b.classification.mode) for b in bulbs] == [(3, 2, 3), (4, 3, 3)]
    assert {(r.type, *r.identifier) for b in bulbs for r in b.source_reference} == {("net.asam.opendrive", "s7")}
