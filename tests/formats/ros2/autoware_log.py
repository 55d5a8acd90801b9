"""Autoware's messages: predicted and detected objects, traffic lights, parameters of the vehicle."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tests.formats.ros2 import ros_log as ros

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence
    from pathlib import Path

_SHAPE = "uint8 BOUNDING_BOX=0\nuint8 CYLINDER=1\nuint8 POLYGON=2\n"
LIGHT_NUMBERS = """
    uint8 UNKNOWN = 0
    # colours
    uint8 RED = 1
    uint8 AMBER = 2
    uint8 GREEN = 3
    uint8 WHITE = 4
    # shapes
    uint8 CIRCLE = 1
    uint8 LEFT_ARROW = 2
    uint8 RIGHT_ARROW = 3
    uint8 UP_ARROW = 4
    uint8 UP_LEFT_ARROW=5
    uint8 UP_RIGHT_ARROW=6
    uint8 DOWN_ARROW = 7
    uint8 DOWN_LEFT_ARROW = 8
    uint8 DOWN_RIGHT_ARROW = 9
    uint8 CROSS = 10
    # lit or not
    uint8 SOLID_OFF = 1
    uint8 SOLID_ON = 2
    uint8 FLASHING = 3
"""
LIGHT_FIELDS = "uint8 color\nuint8 shape\nuint8 status\nfloat32 confidence"
_ARRAYS = "byte[] byte_array_value\nbool[] bool_array_value\nint64[] integer_array_value\nfloat64[] double_array_value"
TYPES = ros.BASE | {
    "builtin_interfaces/Duration": "int32 sec\nuint32 nanosec",
    "autoware_perception_msgs/Shape": _SHAPE + ros.BASE["autoware_perception_msgs/Shape"],
    "autoware_perception_msgs/PredictedPath": """
        geometry_msgs/Pose[<=100] path
        builtin_interfaces/Duration time_step
        float32 confidence
    """,
    "autoware_perception_msgs/PredictedObjectKinematics": """
        geometry_msgs/PoseWithCovariance initial_pose_with_covariance
        geometry_msgs/TwistWithCovariance initial_twist_with_covariance
        geometry_msgs/AccelWithCovariance initial_acceleration_with_covariance
        autoware_perception_msgs/PredictedPath[<=100] predicted_paths
    """,
    "autoware_perception_msgs/PredictedObject": """
        unique_identifier_msgs/UUID object_id
        float32 existence_probability
        ObjectClassification[] classification
        PredictedObjectKinematics kinematics
        Shape shape
    """,
    "autoware_perception_msgs/PredictedObjects": "std_msgs/Header header\nPredictedObject[] objects",
    "autoware_perception_msgs/DetectedObjectKinematics": """
        geometry_msgs/PoseWithCovariance pose_with_covariance
        bool has_position_covariance
        uint8 orientation_availability
        geometry_msgs/TwistWithCovariance twist_with_covariance
        bool has_twist
        bool has_twist_covariance
    """,
    "autoware_perception_msgs/DetectedObject": """
        float32 existence_probability
        ObjectClassification[] classification
        DetectedObjectKinematics kinematics
        Shape shape
    """,
    "autoware_perception_msgs/DetectedObjects": "std_msgs/Header header\nDetectedObject[] objects",
    "autoware_perception_msgs/TrafficLightElement": LIGHT_NUMBERS + LIGHT_FIELDS,
    "autoware_perception_msgs/TrafficLightGroup": "int64 traffic_light_group_id\nTrafficLightElement[] elements",
    "autoware_perception_msgs/TrafficLightGroupArray": (
        "builtin_interfaces/Time stamp\nTrafficLightGroup[] traffic_light_groups"
    ),
    "autoware_perception_msgs/TrafficSignal": "int64 traffic_signal_id\nTrafficLightElement[] elements",
    "autoware_perception_msgs/TrafficSignalArray": "builtin_interfaces/Time stamp\nTrafficSignal[] signals",
    "rcl_interfaces/ParameterValue": f"""
        uint8 type
        bool bool_value
        int64 integer_value
        float64 double_value
        string string_value
        {_ARRAYS}
        string[] string_array_value
    """,
    "rcl_interfaces/Parameter": "string name\nParameterValue value",
    "rcl_interfaces/ParameterEvent": """
        builtin_interfaces/Time stamp
        string node
        Parameter[] new_parameters
        Parameter[] changed_parameters
        Parameter[] deleted_parameters
    """,
    "autoware_adapi_v1_msgs/VehicleDimensions": "\n".join(
        f"# [m]\nfloat32 {name}"
        for name in (
            "wheel_radius", "wheel_width", "wheel_base", "wheel_tread", "front_overhang", "rear_overhang", "left_overhang",
            "right_overhang", "height",
        )
    ) + "\ngeometry_msgs/Polygon footprint",
}  # fmt: skip
PARAMETERS = {
    "wheel_radius": 0.383, "wheel_base": 2.79, "wheel_tread": 1.64, "front_overhang": 1.0, "rear_overhang": 1.1,
    "left_overhang": 0.128, "right_overhang": 0.128, "vehicle_height": 2.5, "max_steer_angle": 0.7,
}  # fmt: skip
"""Autoware's sample vehicle."""
OFF, ON, FLASHING = 1, 2, 3
RED, AMBER, GREEN, WHITE = 1, 2, 3, 4
CIRCLE, LEFT, RIGHT, UP, CROSS = 1, 2, 3, 4, 10


def write(path: Path, messages: Iterable[ros.Message], types: dict[str, str] = TYPES) -> Path:
    return ros.write(path, messages, types)


def prediction(number: int, x: float, y: float, yaw: float = 0.0, speed: float = 0.0, **options: Any) -> dict[str, Any]:
    """Return a PredictedObject, its twist along its own axes; `paths`: how many ways it may go, `poses`: of so many poses each."""
    path = [ros.pose(x + 0.5 + 5.0 * k, y + 1.0, 0.3) for k in range(options.pop("poses", 3))]
    paths = [{"path": path, "time_step": {"nanosec": 500_000_000}, "confidence": 0.5}] * options.pop("paths", 1)
    tracked = ros.track(number, x, y, yaw, speed, **options)
    kinematics = {
        f"initial_{name}": tracked["kinematics"][name] for name in ("pose_with_covariance", "twist_with_covariance")
    }
    return {
        **tracked,
        "kinematics": {**kinematics, "predicted_paths": paths},
        "shape": options.get("shape", tracked["shape"]),
    }


def predictions(
    t_s: float, *objects: dict[str, Any], topic: str = "/perception/object_recognition/objects", frame: str = "map"
) -> ros.Message:
    content = {"header": ros.header(t_s, frame), "objects": list(objects)}
    return topic, "autoware_perception_msgs/PredictedObjects", t_s, content


def detections(t_s: float, *objects: dict[str, Any], frame: str = "base_link") -> ros.Message:
    content = {"header": ros.header(t_s, frame), "objects": list(objects)}
    topic = "/perception/object_recognition/detection/objects"
    return topic, "autoware_perception_msgs/DetectedObjects", t_s, content


def element(color: int, shape: int = CIRCLE, status: int = ON) -> dict[str, Any]:
    return {"color": color, "shape": shape, "status": status, "confidence": 0.9}


def lights(
    t_s: float,
    groups: Mapping[int, Sequence[dict[str, Any]]],
    topic: str = "/perception/traffic_light_recognition/traffic_signals",
) -> ros.Message:
    rows = [{"traffic_light_group_id": number, "elements": list(of)} for number, of in groups.items()]
    name = "autoware_perception_msgs/TrafficLightGroupArray"
    return topic, name, t_s, {"stamp": ros.stamp(t_s), "traffic_light_groups": rows}


def parameters(t_s: float, node: str = "/planning/behavior_path_planner", /, **values: float) -> list[ros.Message]:
    """Return the events of a node that declares its parameters one by one."""
    return [
        (
            "/parameter_events", "rcl_interfaces/ParameterEvent", t_s,
            {"stamp": ros.stamp(t_s), "node": node, "new_parameters": [{"name": name, "value": {"type": 3, "double_value": value}}]},
        )
        for name, value in values.items()
    ]  # fmt: skip
