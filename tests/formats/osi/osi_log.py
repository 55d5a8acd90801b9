"""Writes small OSI logs as MCAP from a schema of our own: the fields of OSI 3 that are read, and some that are not."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from google.protobuf import descriptor_pb2, descriptor_pool, message_factory
from mcap.writer import CompressionType, Writer

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

_F = descriptor_pb2.FieldDescriptorProto
_SCALARS = {
    "double": _F.TYPE_DOUBLE,
    "uint64": _F.TYPE_UINT64,
    "int64": _F.TYPE_INT64,
    "uint32": _F.TYPE_UINT32,
    "string": _F.TYPE_STRING,
    "bool": _F.TYPE_BOOL,
}
# message -> its fields: name, number, type; a * means repeated, an upper-case type is a message, E: an enumeration
MESSAGES = {
    "Identifier": "value 1 uint64",
    "Timestamp": "seconds 1 int64, nanos 2 uint32",
    "Vector3d": "x 1 double, y 2 double, z 3 double",
    "Dimension3d": "length 1 double, width 2 double, height 3 double",
    "Orientation3d": "roll 1 double, pitch 2 double, yaw 3 double",
    "BaseMoving": "dimension 1 Dimension3d, position 2 Vector3d, orientation 3 Orientation3d, velocity 4 Vector3d, "
    "acceleration 5 Vector3d, base_polygon 7 *Vector3d",
    "LightState": "indicator_state 1 E:Indicator, brake_light_state 4 E:Brake, head_light 20 E:Generic, high_beam 21 E:Generic",
    "VehicleClassification": "type 1 E:VehicleType, light_state 2 LightState",
    "MovingObject": "id 1 Identifier, base 2 BaseMoving, type 3 E:ObjectType, vehicle_classification 6 VehicleClassification, "
    "model_reference 7 string",
    "BaseStationary": "dimension 1 Dimension3d, position 2 Vector3d, orientation 3 Orientation3d",
    "LightClassification": "color 1 E:Color, icon 2 uint32, mode 3 E:Mode, assigned_lane_id 5 *Identifier, "
    "is_out_of_service 6 bool",
    "ExternalReference": "reference 1 string, type 2 string, identifier 3 *string",
    "TrafficLight": "id 1 Identifier, base 2 BaseStationary, classification 3 LightClassification, source_reference 5 *ExternalReference",
    "GroundTruth": "timestamp 2 Timestamp, host_vehicle_id 3 Identifier, moving_object 5 *MovingObject, traffic_light 7 *TrafficLight, "
    "country_code 13 uint32",
    "SensorView": "timestamp 2 Timestamp, global_ground_truth 9 GroundTruth, host_vehicle_id 10 Identifier",
    "MapAsamOpenDrive": "map_reference 1 string, open_drive_xml_content 2 string",
}
# enumeration -> its names and numbers
ENUMS = {
    "ObjectType": "TYPE_UNKNOWN 0, TYPE_OTHER 1, TYPE_VEHICLE 2, TYPE_PEDESTRIAN 3, TYPE_ANIMAL 4",
    "VehicleType": "VT_TYPE_UNKNOWN 0, TYPE_CAR 4, TYPE_HEAVY_TRUCK 7, TYPE_BICYCLE 11",
    "Indicator": "INDICATOR_STATE_UNKNOWN 0, INDICATOR_STATE_OTHER 1, INDICATOR_STATE_OFF 2, INDICATOR_STATE_LEFT 3, "
    "INDICATOR_STATE_RIGHT 4, INDICATOR_STATE_WARNING 5",
    "Brake": "BRAKE_LIGHT_STATE_UNKNOWN 0, BRAKE_LIGHT_STATE_OFF 2, BRAKE_LIGHT_STATE_NORMAL 3, BRAKE_LIGHT_STATE_STRONG 4",
    "Generic": "GENERIC_LIGHT_STATE_UNKNOWN 0, GENERIC_LIGHT_STATE_OTHER 1, GENERIC_LIGHT_STATE_OFF 2, GENERIC_LIGHT_STATE_ON 3, "
    "GENERIC_LIGHT_STATE_FLASHING_AMBER 6",
    "Color": "COLOR_UNKNOWN 0, COLOR_RED 2, COLOR_YELLOW 3, COLOR_GREEN 4",
    "Mode": "MODE_UNKNOWN 0, MODE_OFF 2, MODE_CONSTANT 3, MODE_FLASHING 4",
}


def _file() -> descriptor_pb2.FileDescriptorProto:
    file = descriptor_pb2.FileDescriptorProto(name="osi_small.proto", package="osi3", syntax="proto2")
    for name, text in ENUMS.items():
        enum = file.enum_type.add(name=name)
        for word, number in map(str.split, text.split(", ")):
            enum.value.add(name=word, number=int(number))
    for name, text in MESSAGES.items():
        message = file.message_type.add(name=name)
        for field, number, kind in map(str.split, text.split(", ")):
            plain = kind.lstrip("*")
            label = _F.LABEL_REPEATED if kind.startswith("*") else _F.LABEL_OPTIONAL
            item = message.field.add(name=field, number=int(number), label=label)
            if plain in _SCALARS:
                item.type = _SCALARS[plain]
            elif plain.startswith("E:"):
                item.type, item.type_name = _F.TYPE_ENUM, f".osi3.{plain[2:]}"
            else:
                item.type, item.type_name = _F.TYPE_MESSAGE, f".osi3.{plain}"
    return file


FILE = _file()
DESCRIPTOR_SET = descriptor_pb2.FileDescriptorSet(file=[FILE]).SerializeToString()
_POOL = descriptor_pool.DescriptorPool()
_POOL.Add(FILE)


def message(name: str) -> Any:
    """Return a new message of the small schema."""
    return message_factory.GetMessageClass(_POOL.FindMessageTypeByName(f"osi3.{name}"))()


def moving(
    truth: Any,
    number: int,
    x: float,
    y: float = 0.0,
    *,
    yaw: float = 0.0,
    v: tuple[float, float] | None = (10.0, 0.0),
    a: tuple[float, float] | None = None,
    size: tuple[float, float, float] = (4.5, 1.8, 1.5),
    kind: int = 2,
    vehicle: int = 4,
    indicator: int = 0,
    brake: int = 0,
    head: int | None = None,
    beam: int | None = None,
) -> Any:
    """Add a moving object to a ground truth and return it."""
    item = truth.moving_object.add()
    item.id.value = number
    item.type = kind
    item.base.position.x, item.base.position.y, item.base.position.z = x, y, 0.75
    item.base.orientation.yaw = yaw
    item.base.dimension.length, item.base.dimension.width, item.base.dimension.height = size
    if v is not None:
        item.base.velocity.x, item.base.velocity.y = v
    if a is not None:
        item.base.acceleration.x, item.base.acceleration.y = a
    if vehicle:
        item.vehicle_classification.type = vehicle
    if kind == 2:
        item.vehicle_classification.light_state.indicator_state = indicator
        item.vehicle_classification.light_state.brake_light_state = brake
    if head is not None:
        item.vehicle_classification.light_state.head_light = head
    if beam is not None:
        item.vehicle_classification.light_state.high_beam = beam
    return item


def frame(t_ns: int, *, host: int | None = 0) -> Any:
    """Return an empty ground truth at a time."""
    truth = message("GroundTruth")
    truth.timestamp.seconds, truth.timestamp.nanos = divmod(t_ns, 1_000_000_000)
    if host is not None:
        truth.host_vehicle_id.value = host
    return truth


@dataclass(frozen=True)
class Out:
    """One message to write: message type, topic, log time and bytes."""

    name: str
    topic: str
    log_time: int
    data: bytes


def truths(frames: Iterable[Any], topic: str = "ground_truth", name: str = "GroundTruth") -> list[Out]:
    """Return messages on a topic, their log time counted by hundreds of milliseconds."""
    return [Out(f"osi3.{name}", topic, i * 100_000_000, f.SerializeToString()) for i, f in enumerate(frames)]


def write(
    path: Path,
    messages: Iterable[Out],
    *,
    compression: CompressionType = CompressionType.ZSTD,
    use_chunking: bool = True,
    enable_crcs: bool = True,
    enable_data_crcs: bool = True,
    chunk_size: int = 1024 * 1024,
    descriptor_set: bytes = DESCRIPTOR_SET,
    encoding: str = "protobuf",
) -> Path:
    """Write messages to an MCAP file."""
    with path.open("wb") as file:
        writer = Writer(
            file,
            compression=compression,
            use_chunking=use_chunking,
            enable_crcs=enable_crcs,
            enable_data_crcs=enable_crcs and enable_data_crcs,
            chunk_size=chunk_size,
        )
        writer.start()
        channels: dict[tuple[str, str], int] = {}
        for item in messages:
            key = (item.name, item.topic)
            if key not in channels:
                schema = writer.register_schema(item.name, encoding, descriptor_set)
                channels[key] = writer.register_channel(item.topic, encoding, schema)
            writer.add_message(channels[key], item.log_time, item.data, item.log_time)
        writer.finish()  # type: ignore[no-untyped-call]
    return path


def drive(n: int = 30, *, step_ns: int = 100_000_000, actors: int = 3, **options: Any) -> list[Any]:
    """Return frames of cars that drive east at 10 m/s, each in its own lane, actor 0 being the host."""
    frames = []
    for i in range(n):
        truth = frame(i * step_ns)
        for k in range(actors):
            moving(truth, k, 10.0 * i * step_ns * 1e-9, 4.0 * k, **options)
        frames.append(truth)
    return frames
