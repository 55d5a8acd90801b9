"""The ROS 2 messages that are read, with their roles, usual topics and the fields that are read.

The guide on traces lists them, and a test compares the two lists.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

if TYPE_CHECKING:
    from drivelint.formats.protobuf.descriptors import FieldTree

ROAD_USERS_ROLE: Final = "road users"
ODOMETRY_ROLE: Final = "odometry"
DETECTIONS_ROLE: Final = "road users without ids"
EGO_SIZE_ROLE: Final = "ego's size"

CARLA_OBJECTS: Final = "derived_object_msgs/ObjectArray"
PREDICTED_OBJECTS: Final = "autoware_perception_msgs/PredictedObjects"
TRACKED_OBJECTS: Final = "autoware_perception_msgs/TrackedObjects"
DETECTED_OBJECTS: Final = "autoware_perception_msgs/DetectedObjects"
VISION_DETECTIONS: Final = "vision_msgs/Detection3DArray"
ODOMETRY: Final = "nav_msgs/Odometry"
TRANSFORMS: Final = "tf2_msgs/TFMessage"
EGO_INFO: Final = "carla_msgs/CarlaEgoVehicleInfo"
WORLD_INFO: Final = "carla_msgs/CarlaWorldInfo"
PARAMETER_EVENTS: Final = "rcl_interfaces/ParameterEvent"
VEHICLE_DIMENSIONS: Final = "autoware_adapi_v1_msgs/VehicleDimensions"
LIGHT_GROUPS: Final = "autoware_perception_msgs/TrafficLightGroupArray"
OLD_LIGHT_GROUPS: Final = "autoware_perception_msgs/TrafficSignalArray"
TURN_INDICATORS: Final = "autoware_vehicle_msgs/TurnIndicatorsReport"
HAZARD_LIGHTS: Final = "autoware_vehicle_msgs/HazardLightsReport"
CONTROL_MODE: Final = "autoware_vehicle_msgs/ControlModeReport"
ENGAGE: Final = "autoware_vehicle_msgs/Engage"

STAMP_FIELDS: Final[FieldTree] = {"sec": None, "nanosec": None, "nsec": None}
HEADER_FIELDS: Final[FieldTree] = {"stamp": STAMP_FIELDS, "frame_id": None}
XYZ_FIELDS: Final[FieldTree] = {"x": None, "y": None, "z": None}
POSE_FIELDS: Final[FieldTree] = {"position": XYZ_FIELDS, "orientation": {**XYZ_FIELDS, "w": None}}
_HYPOTHESIS_FIELDS: Final[FieldTree] = {"class_id": None, "score": None}
VEHICLE_LENGTH_NAMES: Final = (
    "wheel_base", "front_overhang", "rear_overhang", "wheel_tread", "left_overhang", "right_overhang",
)  # fmt: skip
"""The parameters of Autoware's `vehicle_info`, in metres, that state a vehicle's box relative to its rear axle."""


class MessageType(NamedTuple):
    """A message type that is read. `role`: the word for it in the output of `inspect`; `topic`: its usual topic."""

    role: str
    topic: str
    fields: FieldTree


def _autoware_object_fields(prefix: str, **kinematics: FieldTree | None) -> FieldTree:
    """Return the fields of Autoware's road users; names of kinematic fields begin with `prefix`."""
    return {
        "header": HEADER_FIELDS,
        "objects": {
            "object_id": {"uuid": None}, "classification": {"label": None, "probability": None},
            "kinematics": {
                f"{prefix}pose_with_covariance": {"pose": POSE_FIELDS},
                f"{prefix}twist_with_covariance": {"twist": {"linear": XYZ_FIELDS}},
                f"{prefix}acceleration_with_covariance": {"accel": {"linear": XYZ_FIELDS}},
                **kinematics,
            },
            "shape": {"type": None, "footprint": {"points": {"x": None, "y": None}}, "dimensions": XYZ_FIELDS},
        },
    }  # fmt: skip


_LIGHT_ELEMENT_FIELDS: Final[FieldTree] = {"color": None, "shape": None, "status": None}
MESSAGE_TYPES: Final[dict[str, MessageType]] = {
    PREDICTED_OBJECTS: MessageType(ROAD_USERS_ROLE, "/perception/object_recognition/objects", _autoware_object_fields("initial_")),
    TRACKED_OBJECTS: MessageType(
        ROAD_USERS_ROLE,
        "/perception/object_recognition/tracking/objects",
        _autoware_object_fields("", orientation_availability=None),
    ),
    DETECTED_OBJECTS: MessageType(DETECTIONS_ROLE, "/perception/object_recognition/detection/objects", {}),
    CARLA_OBJECTS: MessageType(
        ROAD_USERS_ROLE,
        "/carla/[<role name>/]objects",
        {
            "header": HEADER_FIELDS,
            "objects": {
                "header": {"frame_id": None}, "id": None, "pose": POSE_FIELDS, "twist": {"linear": XYZ_FIELDS},
                "accel": {"linear": XYZ_FIELDS},
                "shape": {"type": None, "dimensions": None}, "classification": None,
            },
        },
    ),
    VISION_DETECTIONS: MessageType(
        ROAD_USERS_ROLE,
        "any",
        {
            "header": HEADER_FIELDS,
            "detections": {
                "header": {"frame_id": None}, "results": {"hypothesis": _HYPOTHESIS_FIELDS, "id": None, "score": None},
                "bbox": {"center": POSE_FIELDS, "size": XYZ_FIELDS}, "id": None, "tracking_id": None,
            },
        },
    ),
    ODOMETRY: MessageType(
        ODOMETRY_ROLE,
        "/localization/kinematic_state",
        {
            "header": HEADER_FIELDS, "child_frame_id": None, "pose": {"pose": POSE_FIELDS},
            "twist": {"twist": {"linear": XYZ_FIELDS, "angular": XYZ_FIELDS}},
        },
    ),
    TRANSFORMS: MessageType(
        "frames",
        "/tf",
        {
            "transforms": {
                "header": HEADER_FIELDS, "child_frame_id": None,
                "transform": {"translation": XYZ_FIELDS, "rotation": {**XYZ_FIELDS, "w": None}},
            },
        },
    ),
    PARAMETER_EVENTS: MessageType(
        EGO_SIZE_ROLE,
        "/parameter_events",
        {
            "node": None,
            **{
                f"{change}_parameters": {"name": None, "value": {"type": None, "integer_value": None, "double_value": None}}
                for change in ("new", "changed")
            },
        },
    ),
    VEHICLE_DIMENSIONS: MessageType(EGO_SIZE_ROLE, "/api/vehicle/dimensions", dict.fromkeys((*VEHICLE_LENGTH_NAMES, "height"))),
    LIGHT_GROUPS: MessageType(
        "traffic lights",
        "/perception/traffic_light_recognition/traffic_signals",
        {"stamp": STAMP_FIELDS, "traffic_light_groups": {"traffic_light_group_id": None, "elements": _LIGHT_ELEMENT_FIELDS}},
    ),
    OLD_LIGHT_GROUPS: MessageType(
        "traffic lights",
        "/perception/traffic_light_recognition/traffic_signals",
        {"stamp": STAMP_FIELDS, "signals": {"traffic_signal_id": None, "elements": _LIGHT_ELEMENT_FIELDS}},
    ),
    TURN_INDICATORS: MessageType("lights", "/vehicle/status/turn_indicators_status", {"stamp": STAMP_FIELDS, "report": None}),
    HAZARD_LIGHTS: MessageType("lights", "/vehicle/status/hazard_lights_status", {"stamp": STAMP_FIELDS, "report": None}),
    CONTROL_MODE: MessageType("declared events", "/vehicle/status/control_mode", {"stamp": STAMP_FIELDS, "mode": None}),
    ENGAGE: MessageType("declared events", "/autoware/engage", {"stamp": STAMP_FIELDS, "engage": None}),
    EGO_INFO: MessageType("ego", "/carla/<role name>/vehicle_info", {"id": None, "rolename": None}),
    WORLD_INFO: MessageType("map", "/carla/world_info", {"map_name": None, "opendrive": None}),
}  # fmt: skip
"""Message type, as `message_kind` returns it -> its role, usual topic and fields."""
