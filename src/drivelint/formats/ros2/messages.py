"""The ROS 2 messages that are read, with their roles, usual topics and the fields that are read.

The guide on traces lists them, and a test compares the two lists.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

if TYPE_CHECKING:
    from drivelint.formats.protobuf.descriptors import FieldTree

ROAD_USERS: Final = "road users"
ODOMETRY_ROLE: Final = "odometry"
DETECTIONS: Final = "road users without ids"
EGO_SIZE: Final = "ego's size"

CARLA_OBJECTS: Final = "derived_object_msgs/ObjectArray"
PREDICTED: Final = "autoware_perception_msgs/PredictedObjects"
TRACKED: Final = "autoware_perception_msgs/TrackedObjects"
DETECTED: Final = "autoware_perception_msgs/DetectedObjects"
VISION: Final = "vision_msgs/Detection3DArray"
ODOMETRY: Final = "nav_msgs/Odometry"
TRANSFORMS: Final = "tf2_msgs/TFMessage"
EGO_INFO: Final = "carla_msgs/CarlaEgoVehicleInfo"
WORLD_INFO: Final = "carla_msgs/CarlaWorldInfo"
PARAMETERS: Final = "rcl_interfaces/ParameterEvent"
DIMENSIONS: Final = "autoware_adapi_v1_msgs/VehicleDimensions"
LIGHT_GROUPS: Final = "autoware_perception_msgs/TrafficLightGroupArray"
OLD_LIGHT_GROUPS: Final = "autoware_perception_msgs/TrafficSignalArray"
TURN_INDICATORS: Final = "autoware_vehicle_msgs/TurnIndicatorsReport"
HAZARD_LIGHTS: Final = "autoware_vehicle_msgs/HazardLightsReport"
CONTROL_MODE: Final = "autoware_vehicle_msgs/ControlModeReport"
ENGAGE: Final = "autoware_vehicle_msgs/Engage"

STAMP: Final[FieldTree] = {"sec": None, "nanosec": None, "nsec": None}
HEADER: Final[FieldTree] = {"stamp": STAMP, "frame_id": None}
XYZ: Final[FieldTree] = {"x": None, "y": None, "z": None}
POSE: Final[FieldTree] = {"position": XYZ, "orientation": {**XYZ, "w": None}}
_HYPOTHESIS: Final[FieldTree] = {"class_id": None, "score": None}
VEHICLE_LENGTHS: Final = (
    "wheel_base", "front_overhang", "rear_overhang", "wheel_tread", "left_overhang", "right_overhang",
)  # fmt: skip
"""The parameters of Autoware's `vehicle_info`, in metres, that state a vehicle's box relative to its rear axle."""


class MessageType(NamedTuple):
    """A message type that is read. `role`: the word for it in the output of `inspect`; `topic`: its usual topic."""

    role: str
    topic: str
    fields: FieldTree


def _autoware_objects(prefix: str, **kinematics: FieldTree | None) -> FieldTree:
    """Return the fields of Autoware's road users; names of kinematic fields begin with `prefix`."""
    return {
        "header": HEADER,
        "objects": {
            "object_id": {"uuid": None}, "classification": {"label": None, "probability": None},
            "kinematics": {
                f"{prefix}pose_with_covariance": {"pose": POSE},
                f"{prefix}twist_with_covariance": {"twist": {"linear": XYZ}},
                f"{prefix}acceleration_with_covariance": {"accel": {"linear": XYZ}},
                **kinematics,
            },
            "shape": {"type": None, "footprint": {"points": {"x": None, "y": None}}, "dimensions": XYZ},
        },
    }  # fmt: skip


_ELEMENTS: Final[FieldTree] = {"color": None, "shape": None, "status": None}
MESSAGES: Final[dict[str, MessageType]] = {
    PREDICTED: MessageType(ROAD_USERS, "/perception/object_recognition/objects", _autoware_objects("initial_")),
    TRACKED: MessageType(
        ROAD_USERS,
        "/perception/object_recognition/tracking/objects",
        _autoware_objects("", orientation_availability=None),
    ),
    DETECTED: MessageType(DETECTIONS, "/perception/object_recognition/detection/objects", {}),
    CARLA_OBJECTS: MessageType(
        ROAD_USERS,
        "/carla/[<role name>/]objects",
        {
            "header": HEADER,
            "objects": {
                "header": {"frame_id": None}, "id": None, "pose": POSE, "twist": {"linear": XYZ}, "accel": {"linear": XYZ},
                "shape": {"type": None, "dimensions": None}, "classification": None,
            },
        },
    ),
    VISION: MessageType(
        ROAD_USERS,
        "any",
        {
            "header": HEADER,
            "detections": {
                "header": {"frame_id": None}, "results": {"hypothesis": _HYPOTHESIS, "id": None, "score": None},
                "bbox": {"center": POSE, "size": XYZ}, "id": None, "tracking_id": None,
            },
        },
    ),
    ODOMETRY: MessageType(
        ODOMETRY_ROLE,
        "/localization/kinematic_state",
        {
            "header": HEADER, "child_frame_id": None, "pose": {"pose": POSE},
            "twist": {"twist": {"linear": XYZ, "angular": XYZ}},
        },
    ),
    TRANSFORMS: MessageType(
        "frames",
        "/tf",
        {
            "transforms": {
                "header": HEADER, "child_frame_id": None,
                "transform": {"translation": XYZ, "rotation": {**XYZ, "w": None}},
            },
        },
    ),
    PARAMETERS: MessageType(
        EGO_SIZE,
        "/parameter_events",
        {
            "node": None,
            **{
                f"{change}_parameters": {"name": None, "value": {"type": None, "integer_value": None, "double_value": None}}
                for change in ("new", "changed")
            },
        },
    ),
    DIMENSIONS: MessageType(EGO_SIZE, "/api/vehicle/dimensions", dict.fromkeys((*VEHICLE_LENGTHS, "height"))),
    LIGHT_GROUPS: MessageType(
        "traffic lights",
        "/perception/traffic_light_recognition/traffic_signals",
        {"stamp": STAMP, "traffic_light_groups": {"traffic_light_group_id": None, "elements": _ELEMENTS}},
    ),
    OLD_LIGHT_GROUPS: MessageType(
        "traffic lights",
        "/perception/traffic_light_recognition/traffic_signals",
        {"stamp": STAMP, "signals": {"traffic_signal_id": None, "elements": _ELEMENTS}},
    ),
    TURN_INDICATORS: MessageType("lights", "/vehicle/status/turn_indicators_status", {"stamp": STAMP, "report": None}),
    HAZARD_LIGHTS: MessageType("lights", "/vehicle/status/hazard_lights_status", {"stamp": STAMP, "report": None}),
    CONTROL_MODE: MessageType("declared events", "/vehicle/status/control_mode", {"stamp": STAMP, "mode": None}),
    ENGAGE: MessageType("declared events", "/autoware/engage", {"stamp": STAMP, "engage": None}),
    EGO_INFO: MessageType("ego", "/carla/<role name>/vehicle_info", {"id": None, "rolename": None}),
    WORLD_INFO: MessageType("map", "/carla/world_info", {"map_name": None, "opendrive": None}),
}  # fmt: skip
"""Message type, as `message_kind` returns it -> its role, usual topic and fields."""
