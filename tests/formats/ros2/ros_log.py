"""Writes small ROS 2 logs: message definitions as text, messages as dicts, CDR and MCAP by code of the tests' own."""

from __future__ import annotations

import math
import struct
from typing import TYPE_CHECKING, Any

from mcap.writer import CompressionType, Writer

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

BASE = {
    "builtin_interfaces/Time": "int32 sec\nuint32 nanosec",
    "std_msgs/Header": "# when and where\nbuiltin_interfaces/Time stamp\nstring frame_id",
    "geometry_msgs/Point": "float64 x\nfloat64 y\nfloat64 z",
    "geometry_msgs/Point32": "float32 x\nfloat32 y\nfloat32 z",
    "geometry_msgs/Vector3": "float64 x\nfloat64 y\nfloat64 z",
    "geometry_msgs/Quaternion": "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1",
    "geometry_msgs/Pose": "Point position\nQuaternion orientation",
    "geometry_msgs/Twist": "Vector3  linear\nVector3  angular",
    "geometry_msgs/Accel": "Vector3 linear\nVector3 angular",
    "geometry_msgs/Polygon": "Point32[] points",
    "geometry_msgs/PoseWithCovariance": "Pose pose\nfloat64[36] covariance",
    "geometry_msgs/TwistWithCovariance": "Twist twist\nfloat64[36] covariance",
    "geometry_msgs/AccelWithCovariance": "Accel accel\nfloat64[36] covariance",
    "geometry_msgs/Transform": "Vector3 translation\nQuaternion rotation",
    "geometry_msgs/TransformStamped": "std_msgs/Header header\nstring child_frame_id\nTransform transform",
    "tf2_msgs/TFMessage": "geometry_msgs/TransformStamped[] transforms",
    "nav_msgs/Odometry": """
        std_msgs/Header header
        # Frame id the pose points to. The twist is in this coordinate frame.
        string child_frame_id
        geometry_msgs/PoseWithCovariance pose
        geometry_msgs/TwistWithCovariance twist
    """,
    "shape_msgs/SolidPrimitive": """
        uint8 BOX=1
        uint8 CYLINDER=3
        uint8 type
        float64[<=3] dimensions  # at most three
        uint8 BOX_X=0
        geometry_msgs/Polygon polygon
    """,
    "derived_object_msgs/Object": """
        std_msgs/Header header
        uint32 id
        uint8 detection_level
        uint8 OBJECT_TRACKED=1
        bool object_classified
        geometry_msgs/Pose pose
        geometry_msgs/Twist twist
        geometry_msgs/Accel accel
        geometry_msgs/Polygon polygon
        shape_msgs/SolidPrimitive shape
        uint8 classification
        uint8 CLASSIFICATION_CAR=6
        uint8 classification_certainty
        uint32 classification_age
    """,
    "derived_object_msgs/ObjectArray": "std_msgs/Header header\nObject[] objects",
    "carla_msgs/CarlaEgoVehicleInfoWheel": "float32 tire_friction\ngeometry_msgs/Vector3 position",
    "carla_msgs/CarlaEgoVehicleInfo": """
        uint32 id
        string type
        string rolename
        CarlaEgoVehicleInfoWheel[] wheels
        float32 max_rpm
    """,
    "carla_msgs/CarlaWorldInfo": "string map_name\nstring opendrive",
    "unique_identifier_msgs/UUID": "uint8[16] uuid",
    "autoware_perception_msgs/ObjectClassification": "uint8 CAR = 1\nuint8 label\nfloat32 probability",
    "autoware_perception_msgs/TrackedObjectKinematics": """
        uint8 AVAILABLE=2
        geometry_msgs/PoseWithCovariance pose_with_covariance
        geometry_msgs/TwistWithCovariance twist_with_covariance
        geometry_msgs/AccelWithCovariance acceleration_with_covariance
        uint8 orientation_availability
        bool is_stationary
    """,
    "autoware_perception_msgs/Shape": "uint8 type\ngeometry_msgs/Polygon footprint\ngeometry_msgs/Vector3 dimensions",
    "autoware_perception_msgs/TrackedObject": """
        unique_identifier_msgs/UUID object_id
        float32 existence_probability
        ObjectClassification[] classification
        TrackedObjectKinematics kinematics
        Shape shape
    """,
    "autoware_perception_msgs/TrackedObjects": "std_msgs/Header header\nTrackedObject[] objects",
    "autoware_vehicle_msgs/TurnIndicatorsReport": "uint8 DISABLE = 1\nbuiltin_interfaces/Time stamp\nuint8 report",
    "autoware_vehicle_msgs/HazardLightsReport": "uint8 DISABLE = 1\nbuiltin_interfaces/Time stamp\nuint8 report",
    "autoware_vehicle_msgs/ControlModeReport": "uint8 MANUAL = 4\nbuiltin_interfaces/Time stamp\nuint8 mode",
    "autoware_vehicle_msgs/Engage": "builtin_interfaces/Time stamp\nbool engage",
    "vision_msgs/ObjectHypothesis": "string class_id\nfloat64 score",
    "vision_msgs/ObjectHypothesisWithPose": "ObjectHypothesis hypothesis\ngeometry_msgs/PoseWithCovariance pose",
    "vision_msgs/BoundingBox3D": "geometry_msgs/Pose center\ngeometry_msgs/Vector3 size",
    "vision_msgs/Detection3D": """
        std_msgs/Header header
        vision_msgs/ObjectHypothesisWithPose[] results
        vision_msgs/BoundingBox3D bbox
        string id
    """,
    "vision_msgs/Detection3DArray": "std_msgs/Header header\nvision_msgs/Detection3D[] detections",
}  # fmt: skip
_SCALARS = {
    "bool": "B", "byte": "B", "uint8": "B", "int8": "b", "uint16": "H", "int16": "h", "uint32": "I", "int32": "i",
    "uint64": "Q", "int64": "q", "float32": "f", "float64": "d",
}  # fmt: skip


def fields(name: str, types: dict[str, str]) -> list[tuple[str, str, str | None]]:
    """Return (type, name, what stands in its brackets) of a message's members."""
    found = []
    for line in types[name].splitlines():
        words = line.split("#")[0].split()
        if not words or "=" in line.split("#")[0].replace("<=", ""):
            continue
        kind, _, rest = words[0].partition("[")
        if kind not in _SCALARS and kind != "string" and "/" not in kind:
            kind = f"{name.split('/', maxsplit=1)[0]}/{kind}"
        found.append((kind, words[1], rest.rstrip("]") if _ else None))
    return found


def definition(name: str, types: dict[str, str] = BASE) -> str:
    """Return the text of a message's definition and of all it uses, as rosbag2 writes it."""
    used: list[str] = []

    def visit(kind: str) -> None:
        for inner, _, _ in fields(kind, types):
            if inner in types and inner not in used:
                used.append(inner)
                visit(inner)

    visit(name)
    return types[name] + "".join(f"\n{'=' * 80}\nMSG: {kind}\n{types[kind]}" for kind in used)


def encode(name: str, value: dict[str, Any], types: dict[str, str] = BASE, order: str = "<") -> bytes:
    """Return a message in CDR; members that are not given are zero."""
    out = bytearray()

    def put(code: str, number: Any) -> None:
        size = struct.calcsize(code)
        out.extend(b"\0" * (-len(out) % size))
        out.extend(struct.pack(order + code, number))

    def put_value(kind: str, content: Any) -> None:
        if kind == "string":
            data = (content or "").encode() + b"\0"
            put("I", len(data))
            out.extend(data)
        elif kind in _SCALARS:
            put(_SCALARS[kind], content or 0)
        else:
            for inner, member, array in fields(kind, types):
                item = (content or {}).get(member)
                if array is None:
                    put_value(inner, item)
                elif array == "" or array.startswith("<="):
                    put("I", len(item or []))
                    for each in item or []:
                        put_value(inner, each)
                else:
                    for each in item or [0] * int(array):
                        put_value(inner, each)

    put_value(name, value)
    return bytes([0, 1 if order == "<" else 0, 0, 0]) + bytes(out)


Message = tuple[str, str, float, dict[str, Any]]
"""Topic, type, log time in seconds, content."""


def write(
    path: Path, messages: Iterable[Message], types: dict[str, str] = BASE, order: str = "<", encoding: str = "ros2msg"
) -> Path:
    """Write a log in the order given."""
    with path.open("wb") as file:
        writer = Writer(file, compression=CompressionType.NONE, chunk_size=4096)
        writer.start(profile="ros2")
        schemas: dict[str, int] = {}
        channels: dict[str, int] = {}
        for topic, name, t_s, content in messages:
            if name not in schemas:
                text = definition(name, types).encode()
                schemas[name] = writer.register_schema(name.replace("/", "/msg/"), encoding, text)
            if topic not in channels:
                channels[topic] = writer.register_channel(topic, "cdr", schemas[name])
            t_ns = round(t_s * 1e9)
            writer.add_message(channels[topic], t_ns, encode(name, content, types, order), t_ns)
        writer.finish()  # type: ignore[no-untyped-call]
    return path


def stamp(t_s: float) -> dict[str, int]:
    t_ns = round(t_s * 1e9)
    return {"sec": t_ns // 10**9, "nanosec": t_ns % 10**9}


def header(t_s: float, frame: str = "map") -> dict[str, Any]:
    return {"stamp": stamp(t_s), "frame_id": frame}


def turned(yaw: float) -> dict[str, float]:
    return {"z": math.sin(yaw / 2), "w": math.cos(yaw / 2)}


def xyz(x: float = 0.0, y: float = 0.0, z: float = 0.0) -> dict[str, float]:
    return {"x": x, "y": y, "z": z}


def pose(x: float, y: float, yaw: float = 0.0, z: float = 0.0) -> dict[str, Any]:
    return {"position": xyz(x, y, z), "orientation": turned(yaw)}


def thing(number: int, x: float, y: float, yaw: float = 0.0, speed: float = 0.0, **fields: Any) -> dict[str, Any]:
    """Return an Object of the CARLA bridge, a car 4.5 x 1.8 x 1.5 m that drives where it looks."""
    return {
        "id": number, "object_classified": 1, "pose": pose(x, y, yaw),
        "twist": {"linear": xyz(speed * math.cos(yaw), speed * math.sin(yaw))},
        "shape": {"type": 1, "dimensions": [4.5, 1.8, 1.5]}, "classification": 6, **fields,
    }  # fmt: skip


def things(t_s: float, *objects: dict[str, Any], topic: str = "/carla/objects", frame: str = "map") -> Message:
    return (
        topic,
        "derived_object_msgs/ObjectArray",
        t_s,
        {
            "header": header(t_s, frame),
            "objects": [{"header": header(t_s, frame), **each} for each in objects],
        },
    )


def odometry(
    t_s: float, x: float, y: float, yaw: float = 0.0, speed: float = 0.0, *, turning: float = 0.0, **options: Any
) -> Message:
    """Return where the ego is, its twist along its own axes."""
    topic, log_s = options.pop("topic", "/carla/hero/odometry"), options.pop("log_s", t_s)
    content = {
        "header": header(t_s, options.pop("frame", "map")),
        "child_frame_id": options.pop("child", "ego_vehicle"),
        "pose": {"pose": pose(x, y, yaw)},
        "twist": {"twist": {"linear": options.pop("twist", xyz(speed)), "angular": xyz(0, 0, turning)}},
    }
    assert not options
    return topic, "nav_msgs/Odometry", log_s, content


def transform(
    t_s: float, parent: str, child: str, x: float = 0.0, y: float = 0.0, *, yaw: float = 0.0, topic: str = "/tf"
) -> Message:
    item = {
        "header": header(t_s, parent), "child_frame_id": child,
        "transform": {"translation": xyz(x, y), "rotation": turned(yaw)},
    }  # fmt: skip
    return topic, "tf2_msgs/TFMessage", t_s, {"transforms": [item]}


def track(number: int, x: float, y: float, yaw: float = 0.0, speed: float = 0.0, **options: Any) -> dict[str, Any]:
    """Return an Autoware TrackedObject, its twist along its own axes."""
    kinematics = {
        "pose_with_covariance": {"pose": pose(x, y, yaw)},
        "twist_with_covariance": {"twist": {"linear": xyz(speed)}},
        "orientation_availability": options.pop("facing", 2),
    }
    return {
        "object_id": {"uuid": [*range(15), number]},
        "classification": options.pop("classes", [{"label": 0, "probability": 0.2}, {"label": 1, "probability": 0.8}]),
        "kinematics": kinematics,
        "shape": {"dimensions": xyz(4.5, 1.8, 1.5)},
    }


def tracks(t_s: float, *objects: dict[str, Any], frame: str = "map") -> Message:
    content = {"header": header(t_s, frame), "objects": list(objects)}
    return "/perception/objects", "autoware_perception_msgs/TrackedObjects", t_s, content


def report(name: str, t_s: float, **content: Any) -> Message:
    return f"/vehicle/{name}", f"autoware_vehicle_msgs/{name}", t_s, {"stamp": stamp(t_s), **content}


def detection(name: str, x: float, y: float, *results: tuple[str, float]) -> dict[str, Any]:
    return {
        "id": name,
        "results": [{"hypothesis": {"class_id": word, "score": score}} for word, score in results],
        "bbox": {"center": pose(x, y), "size": xyz(4.5, 1.8, 1.5)},
    }


def detections(t_s: float, *objects: dict[str, Any], frame: str = "map") -> Message:
    content = {"header": header(t_s, frame), "detections": list(objects)}
    return "/detections", "vision_msgs/Detection3DArray", t_s, content
