"""The part of ASAM OSI 3 that we write, and that we read where the log brings no schema, as protobuf descriptors.

Names, numbers and nesting are OSI's. What is written is the smaller part: its bytes stand in logs whose hash is known.
"""

from __future__ import annotations

from functools import cache
from typing import Any, Final

from google.protobuf import descriptor_pb2, descriptor_pool, message_factory

_F = descriptor_pb2.FieldDescriptorProto
_SCALARS = {
    "bool": _F.TYPE_BOOL,
    "double": _F.TYPE_DOUBLE,
    "int64": _F.TYPE_INT64,
    "uint32": _F.TYPE_UINT32,
    "uint64": _F.TYPE_UINT64,
    "string": _F.TYPE_STRING,
}
_LIGHTS = "MovingObject.VehicleClassification.LightState"
Messages = dict[str, tuple[tuple[str, int, str], ...]]
MESSAGES: Final[Messages] = {
    "InterfaceVersion": (
        ("version_major", 1, "uint32"), ("version_minor", 2, "uint32"), ("version_patch", 3, "uint32"),
    ),
    "Identifier": (("value", 1, "uint64"),),
    "Timestamp": (("seconds", 1, "int64"), ("nanos", 2, "uint32")),
    "Vector3d": (("x", 1, "double"), ("y", 2, "double"), ("z", 3, "double")),
    "Dimension3d": (("length", 1, "double"), ("width", 2, "double"), ("height", 3, "double")),
    "Orientation3d": (("roll", 1, "double"), ("pitch", 2, "double"), ("yaw", 3, "double")),
    "BaseMoving": (
        ("dimension", 1, "Dimension3d"), ("position", 2, "Vector3d"), ("orientation", 3, "Orientation3d"),
        ("velocity", 4, "Vector3d"), ("acceleration", 5, "Vector3d"),
    ),
    "MovingObject": (
        ("id", 1, "Identifier"), ("base", 2, "BaseMoving"), ("type", 3, "MovingObject.Type"),
        ("vehicle_classification", 6, "MovingObject.VehicleClassification"),
    ),
    "MovingObject.VehicleClassification": (
        ("type", 1, "MovingObject.VehicleClassification.Type"), ("light_state", 2, _LIGHTS),
    ),
    _LIGHTS: (
        ("indicator_state", 1, f"{_LIGHTS}.IndicatorState"), ("brake_light_state", 7, f"{_LIGHTS}.BrakeLightState"),
    ),
    "ExternalReference": (("type", 2, "string"), ("identifier", 3, "string[]")),
    "TrafficLight": (
        ("id", 1, "Identifier"), ("classification", 3, "TrafficLight.Classification"),
        ("source_reference", 5, "ExternalReference[]"),
    ),
    "TrafficLight.Classification": (
        ("color", 1, "TrafficLight.Classification.Color"), ("mode", 3, "TrafficLight.Classification.Mode"),
    ),
    "GroundTruth": (
        ("version", 1, "InterfaceVersion"), ("timestamp", 2, "Timestamp"), ("host_vehicle_id", 3, "Identifier"),
        ("moving_object", 5, "MovingObject[]"), ("traffic_light", 7, "TrafficLight[]"),
    ),
    "MapAsamOpenDrive": (("map_reference", 1, "string"), ("open_drive_xml_content", 2, "string")),
}  # fmt: skip
"""Message -> (field, number, type); `[]` repeats, dots nest."""


def _numbered(prefix: str, *words: str) -> dict[str, int]:
    """Return the values of an enumeration, numbered from 0."""
    return {f"{prefix}_{word}": number for number, word in enumerate(words)}


_VEHICLES: Final = _numbered(
    "TYPE", "UNKNOWN", "OTHER", "SMALL_CAR", "COMPACT_CAR", "MEDIUM_CAR", "LUXURY_CAR", "DELIVERY_VAN", "HEAVY_TRUCK",
    "SEMITRAILER", "TRAILER", "MOTORBIKE", "BICYCLE", "BUS", "TRAM", "TRAIN", "WHEELCHAIR", "SEMITRACTOR", "STANDUP_SCOOTER",
)  # fmt: skip
_VEHICLE_TYPE = "MovingObject.VehicleClassification.Type"
_MODE = "TrafficLight.Classification.Mode"
ENUMS: Final[dict[str, dict[str, int]]] = {
    "MovingObject.Type": _numbered("TYPE", "UNKNOWN", "OTHER", "VEHICLE", "PEDESTRIAN", "ANIMAL"),
    _VEHICLE_TYPE: {name: number for name, number in _VEHICLES.items() if number in {0, 1, 4, 6, 7, 9, 10, 11, 12}},
    f"{_LIGHTS}.IndicatorState": _numbered("INDICATOR_STATE", "UNKNOWN", "OTHER", "OFF", "LEFT", "RIGHT", "WARNING"),
    f"{_LIGHTS}.BrakeLightState": _numbered("BRAKE_LIGHT_STATE", "UNKNOWN", "OTHER", "OFF", "NORMAL", "STRONG"),
    "TrafficLight.Classification.Color": _numbered("COLOR", "UNKNOWN", "OTHER", "RED", "YELLOW", "GREEN"),
    _MODE: _numbered("MODE", "UNKNOWN", "OTHER", "OFF", "CONSTANT", "FLASHING"),
}
_READ_MESSAGES: Final[Messages] = {
    **MESSAGES,
    "GroundTruth": (
        *MESSAGES["GroundTruth"], ("traffic_sign", 6, "TrafficSign[]"), ("road_marking", 8, "RoadMarking[]"),
        ("lane_boundary", 9, "LaneBoundary[]"), ("lane", 10, "Lane[]"), ("proj_string", 14, "string"),
        ("reference_line", 17, "ReferenceLine[]"), ("logical_lane_boundary", 18, "LogicalLaneBoundary[]"),
        ("logical_lane", 19, "LogicalLane[]"), ("proj_frame_offset", 20, "GroundTruth.ProjFrameOffset"),
    ),
    "GroundTruth.ProjFrameOffset": (("position", 1, "Vector3d"), ("yaw", 2, "double")),
    _LIGHTS: (
        *MESSAGES[_LIGHTS], ("head_light", 4, f"{_LIGHTS}.GenericLightState"),
        ("high_beam", 5, f"{_LIGHTS}.GenericLightState"),
    ),
    "BaseStationary": (
        ("dimension", 1, "Dimension3d"), ("position", 2, "Vector3d"), ("orientation", 3, "Orientation3d"),
    ),
    "LogicalLaneAssignment": (("assigned_lane_id", 1, "Identifier"), ("s_position", 2, "double")),
    "TrafficLight": (*MESSAGES["TrafficLight"], ("base", 2, "BaseStationary")),
    "TrafficLight.Classification": (
        *MESSAGES["TrafficLight.Classification"], ("icon", 2, "uint32"), ("assigned_lane_id", 5, "Identifier[]"),
        ("is_out_of_service", 6, "bool"), ("logical_lane_assignment", 7, "LogicalLaneAssignment[]"),
    ),
    "TrafficSignValue": (("value", 1, "double"), ("value_unit", 2, "uint32")),
    "TrafficSign": (("id", 1, "Identifier"), ("main_sign", 2, "TrafficSign.MainSign")),
    "TrafficSign.MainSign": (
        ("base", 1, "BaseStationary"), ("classification", 2, "TrafficSign.MainSign.Classification"),
    ),
    "TrafficSign.MainSign.Classification": (
        ("variability", 1, "uint32"), ("type", 2, "uint32"), ("value", 3, "TrafficSignValue"),
        ("assigned_lane_id", 5, "Identifier[]"), ("is_out_of_service", 7, "bool"), ("country", 8, "string"),
        ("code", 10, "string"), ("sub_code", 11, "string"),
        ("logical_lane_assignment", 12, "LogicalLaneAssignment[]"),
    ),
    "RoadMarking": (
        ("id", 1, "Identifier"), ("base", 2, "BaseStationary"), ("classification", 3, "RoadMarking.Classification"),
    ),
    "RoadMarking.Classification": (
        ("type", 1, "uint32"), ("traffic_main_sign_type", 2, "uint32"), ("assigned_lane_id", 6, "Identifier[]"),
        ("is_out_of_service", 7, "bool"), ("country", 8, "string"), ("code", 10, "string"),
        ("logical_lane_assignment", 12, "LogicalLaneAssignment[]"),
    ),
    "ReferenceLine": (("id", 1, "Identifier"),),
    "LogicalLaneBoundary": (
        ("id", 1, "Identifier"), ("boundary_line", 2, "LogicalLaneBoundary.LogicalBoundaryPoint[]"),
        ("reference_line_id", 3, "Identifier"), ("physical_boundary_id", 4, "Identifier[]"),
        ("passing_rule", 5, "uint32"),
    ),
    "LogicalLaneBoundary.LogicalBoundaryPoint": (("position", 1, "Vector3d"), ("s_position", 2, "double")),
    "LogicalLane": (
        ("id", 1, "Identifier"), ("type", 2, "uint32"),
        ("physical_lane_reference", 4, "LogicalLane.PhysicalLaneReference[]"),
        ("reference_line_id", 5, "Identifier"), ("start_s", 6, "double"), ("end_s", 7, "double"),
        ("move_direction", 8, "uint32"), ("right_adjacent_lane", 9, "LogicalLane.LaneRelation[]"),
        ("left_adjacent_lane", 10, "LogicalLane.LaneRelation[]"), ("right_boundary_id", 12, "Identifier[]"),
        ("left_boundary_id", 13, "Identifier[]"), ("predecessor_lane", 14, "LogicalLane.LaneConnection[]"),
        ("successor_lane", 15, "LogicalLane.LaneConnection[]"), ("traffic_rule", 17, "LogicalLane.TrafficRule[]"),
    ),
    "LogicalLane.PhysicalLaneReference": (("physical_lane_id", 1, "Identifier"),),
    "LogicalLane.LaneRelation": (
        ("other_lane_id", 1, "Identifier"), ("start_s", 2, "double"), ("end_s", 3, "double"),
    ),
    "LogicalLane.LaneConnection": (("other_lane_id", 1, "Identifier"),),
    "LogicalLane.TrafficRule": (
        ("traffic_rule_type", 1, "uint32"), ("traffic_rule_validity", 2, "LogicalLane.TrafficRule.Validity"),
        ("speed_limit", 3, "LogicalLane.TrafficRule.SpeedLimit"),
    ),
    "LogicalLane.TrafficRule.Validity": (
        ("start_s", 1, "double"), ("end_s", 2, "double"),
        ("valid_for_type", 3, "LogicalLane.TrafficRule.Validity.TypeValidity[]"),
    ),
    "LogicalLane.TrafficRule.Validity.TypeValidity": (("type", 1, "uint32"), ("vehicle_type", 2, "uint32")),
    "LogicalLane.TrafficRule.SpeedLimit": (("speed_limit_value", 1, "TrafficSignValue"),),
    "LaneBoundary": (
        ("id", 1, "Identifier"), ("boundary_line", 2, "LaneBoundary.BoundaryPoint[]"),
        ("classification", 3, "LaneBoundary.Classification"),
    ),
    "LaneBoundary.BoundaryPoint": (("position", 1, "Vector3d"),),
    "LaneBoundary.Classification": (("type", 1, "uint32"),),  # an enumeration whose numbers are read
    "Lane": (("id", 1, "Identifier"), ("classification", 2, "Lane.Classification")),
    "Lane.Classification": (
        ("type", 1, "uint32"), ("centerline", 3, "Vector3d[]"), ("centerline_is_driving_direction", 4, "bool"),
        ("left_adjacent_lane_id", 5, "Identifier[]"), ("right_adjacent_lane_id", 6, "Identifier[]"),
        ("lane_pairing", 7, "Lane.Classification.LanePairing[]"), ("right_lane_boundary_id", 8, "Identifier[]"),
        ("left_lane_boundary_id", 9, "Identifier[]"), ("subtype", 12, "uint32"),
    ),
    "Lane.Classification.LanePairing": (
        ("antecessor_lane_id", 1, "Identifier"), ("successor_lane_id", 2, "Identifier"),
    ),
    "SensorView": (
        ("timestamp", 2, "Timestamp"), ("global_ground_truth", 7, "GroundTruth"),
        ("host_vehicle_id", 8, "Identifier"),
    ),
}  # fmt: skip
_READ_ENUMS: Final[dict[str, dict[str, int]]] = {
    **ENUMS,
    _VEHICLE_TYPE: _VEHICLES,
    f"{_LIGHTS}.GenericLightState": _numbered(
        "GENERIC_LIGHT_STATE", "UNKNOWN", "OTHER", "OFF", "ON",
        "FLASHING_BLUE", "FLASHING_BLUE_AND_RED", "FLASHING_AMBER",
    ),
    _MODE: {**ENUMS[_MODE], "MODE_COUNTING": 5},
}  # fmt: skip
PACKAGE: Final = "osi3"
GROUND_TRUTH: Final = f"{PACKAGE}.GroundTruth"
OPEN_DRIVE: Final = f"{PACKAGE}.MapAsamOpenDrive"
OPEN_DRIVE_REFERENCE: Final = "net.asam.opendrive"
"""Type of an `ExternalReference` to what is in an OpenDRIVE map."""
LIGHT_REFERENCE: Final = "drivelint.light"
"""Type of ours that names the light to which a bulb belongs that refers to no OpenDRIVE signal."""
VERSION: Final = (3, 7, 0)
"""The version of OSI that is written."""


def _file(messages: Messages, enums: dict[str, dict[str, int]]) -> descriptor_pb2.FileDescriptorProto:
    file = descriptor_pb2.FileDescriptorProto(name="osi_written.proto", package=PACKAGE, syntax="proto2")
    made: dict[str, Any] = {}

    def add(name: str, kind: str) -> Any:
        outer, _, own = name.rpartition(".")
        home = made[outer] if outer else file
        field = {"message": ("nested_type" if outer else "message_type"), "enum": "enum_type"}[kind]
        made[name] = getattr(home, field).add(name=own)
        return made[name]

    for name in messages:
        add(name, "message")
    for name, values in enums.items():
        enum = add(name, "enum")
        for word, number in values.items():
            enum.value.add(name=word, number=number)
    for name, fields in messages.items():
        for field, number, kind in fields:
            plain = kind.removesuffix("[]")
            item = made[name].field.add(name=field, number=number)
            item.label = _F.LABEL_REPEATED if kind != plain else _F.LABEL_OPTIONAL
            item.type = _SCALARS.get(plain, _F.TYPE_ENUM if plain in enums else _F.TYPE_MESSAGE)
            if plain not in _SCALARS:
                item.type_name = f".{PACKAGE}.{plain}"
    return file


@cache
def descriptor_set() -> bytes:
    """Return the serialised `FileDescriptorSet` for an MCAP schema record."""
    return _serialised(_file(MESSAGES, ENUMS))


@cache
def reader_descriptor_set() -> bytes:
    """Return the serialised `FileDescriptorSet` by which messages are read that come without one."""
    return _serialised(_file(_READ_MESSAGES, _READ_ENUMS))


@cache
def _pool() -> descriptor_pool.DescriptorPool:
    pool = descriptor_pool.DescriptorPool()
    pool.Add(_file(_READ_MESSAGES, _READ_ENUMS))
    return pool


def message_class(name: str) -> Any:
    """Return the class of a message that is read, such as GroundTruth: for one message; thousands are decoded by columns."""
    return message_factory.GetMessageClass(_pool().FindMessageTypeByName(f"{PACKAGE}.{name}"))


def _serialised(file: descriptor_pb2.FileDescriptorProto) -> bytes:
    return descriptor_pb2.FileDescriptorSet(file=[file]).SerializeToString(deterministic=True)
