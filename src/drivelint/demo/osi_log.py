"""Writes a scene as ASAM OSI ground truth in MCAP: chunked, compressed, with checksums, without a clock."""

from __future__ import annotations

import io
import math
from typing import TYPE_CHECKING, Any, Final

from mcap.writer import CompressionType, Writer

from drivelint.demo.opendrive import MAKER
from drivelint.demo.osi_schema import ENUMS, GROUND_TRUTH, VERSION, descriptor_set, ground_truth_class

if TYPE_CHECKING:
    from drivelint.demo.motion import Track
    from drivelint.demo.scene import Scene

TOPIC: Final = "ground_truth"
HOST_ID: Final = 1
_CHUNK_BYTES = 1 << 18
_VEHICLES = {
    "car": "TYPE_MEDIUM_CAR",
    "van": "TYPE_DELIVERY_VAN",
    "truck": "TYPE_HEAVY_TRUCK",
    "bicycle": "TYPE_BICYCLE",
    "bus": "TYPE_BUS",
}
_INDICATORS = {"off": "OFF", "left": "LEFT", "right": "RIGHT", "hazard": "WARNING"}
_KIND, _VEHICLE = ENUMS["MovingObject.Type"], ENUMS["MovingObject.VehicleClassification.Type"]
_LIGHTS = "MovingObject.VehicleClassification.LightState"
_INDICATOR, _BRAKE = ENUMS[f"{_LIGHTS}.IndicatorState"], ENUMS[f"{_LIGHTS}.BrakeLightState"]


def mcap(scene: Scene) -> bytes:
    """Return the scene's log: one `osi3.GroundTruth` per sample, log time = sample time, the same bytes every time."""
    sink = io.BytesIO()
    writer = Writer(
        sink, chunk_size=_CHUNK_BYTES, compression=CompressionType.ZSTD, enable_crcs=True, enable_data_crcs=True
    )
    writer.start(library=MAKER)
    schema = writer.register_schema(GROUND_TRUTH, "protobuf", descriptor_set())
    version = ".".join(map(str, VERSION))
    channel = writer.register_channel(TOPIC, "protobuf", schema, {"net.asam.osi.trace.channel.osi_version": version})
    writer.add_metadata(
        "net.asam.osi.trace",
        {
            "version": version,
            "min_osi_version": version,
            "max_osi_version": version,
            "min_protobuf_version": "2.6.1",
            "max_protobuf_version": "2.6.1",
            "description": scene.shows,
        },
    )
    for k in range(len(scene.tracks[0].t_s)):
        t_ns = round(float(scene.tracks[0].t_s[k]) * 1e9)
        writer.add_message(channel, t_ns, _frame(scene, k, t_ns), t_ns)
    writer.finish()  # type: ignore[no-untyped-call]
    return sink.getvalue()


def _frame(scene: Scene, k: int, t_ns: int) -> bytes:
    truth = ground_truth_class()()
    version = truth.version
    version.version_major, version.version_minor, version.version_patch = VERSION
    truth.timestamp.seconds, truth.timestamp.nanos = divmod(t_ns, 1_000_000_000)
    truth.host_vehicle_id.value = HOST_ID
    for number, track in enumerate(scene.tracks, HOST_ID):
        _object(truth.moving_object.add(), number, track, k)
    data: bytes = truth.SerializeToString(deterministic=True)
    return data


def _object(item: Any, number: int, track: Track, k: int) -> None:
    """Fill in one moving object. Values are rounded, so that no machine's last bit shows in the file."""
    body, base = track.actor.body, item.base
    item.id.value = number
    base.dimension.length, base.dimension.width, base.dimension.height = body.length_m, body.width_m, body.height_m
    base.position.x, base.position.y = tenth_mm(float(track.x[k])), tenth_mm(float(track.y[k]))
    base.position.z = body.height_m / 2
    base.orientation.yaw = round(float(track.yaw[k]), 6) + 0.0
    speed, yaw = float(track.speed[k]), float(track.yaw[k])
    base.velocity.x, base.velocity.y = tenth_mm(speed * math.cos(yaw)), tenth_mm(speed * math.sin(yaw))
    if body.kind == "pedestrian":
        item.type = _KIND["TYPE_PEDESTRIAN"]
        return
    item.type = _KIND["TYPE_VEHICLE"]
    item.vehicle_classification.type = _VEHICLE[_VEHICLES[body.kind]]
    lights = item.vehicle_classification.light_state
    lights.indicator_state = _INDICATOR[f"INDICATOR_STATE_{_INDICATORS[str(track.light[k])]}"]
    lights.brake_light_state = _BRAKE[f"BRAKE_LIGHT_STATE_{'NORMAL' if track.brakes[k] else 'OFF'}"]


def tenth_mm(value: float) -> float:
    """Round to four decimals, without a sign on zero."""
    return round(value, 4) + 0.0
