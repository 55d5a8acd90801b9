"""MCAP logs of one drive: a file, or a folder of files as `ros2 bag record` splits them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import yaml

from drivelint.errors import TraceError
from drivelint.formats.mcap.reader import Container
from drivelint.formats.mcap.summary import read_index
from drivelint.formats.ros2.types import message_kind

if TYPE_CHECKING:
    from pathlib import Path

METADATA_FILE = "metadata.yaml"
_ROOT = "rosbag2_bagfile_information"
OSI_SCHEMAS: Final = frozenset({"osi3.GroundTruth", "osi3.SensorView"})
ROAD_USERS: Final = "road users"
ODOMETRY: Final = "odometry"
ROS_ROLES: Final = {
    "derived_object_msgs/ObjectArray": ROAD_USERS,
    "autoware_perception_msgs/TrackedObjects": ROAD_USERS,
    "vision_msgs/Detection3DArray": ROAD_USERS,
    "nav_msgs/Odometry": ODOMETRY,
    "tf2_msgs/TFMessage": "frames",
    "carla_msgs/CarlaEgoVehicleInfo": "ego",
    "carla_msgs/CarlaWorldInfo": "map",
    "autoware_vehicle_msgs/TurnIndicatorsReport": "lights",
    "autoware_vehicle_msgs/HazardLightsReport": "lights",
    "autoware_vehicle_msgs/ControlModeReport": "declared events",
    "autoware_vehicle_msgs/Engage": "declared events",
}
FOXGLOVE_ROLES: Final = {
    "foxglove.SceneUpdate": ROAD_USERS,
    "foxglove.FrameTransform": "frames",
    "foxglove.FrameTransforms": "frames",
}
"""Schema, of ROS as `message_kind` names it, -> what is read from its messages."""


def is_bag(path: Path) -> bool:
    """Say whether `path` is a folder that rosbag2 recorded."""
    try:
        with (path / METADATA_FILE).open("rb") as file:
            return _ROOT.encode() in file.read(65536)
    except OSError:
        return False


def mcap_files(path: Path) -> list[Path]:
    """Return the MCAP files of a drive in the order of recording.

    Errors: `TraceError` for a bag whose description cannot be read, that is no MCAP, or of which files are missing.
    """
    if not path.is_dir():
        return [path]
    try:
        information = yaml.safe_load((path / METADATA_FILE).read_bytes())[_ROOT]
        storage, names = information.get("storage_identifier"), information["relative_file_paths"]
    except (OSError, yaml.YAMLError, KeyError, TypeError, AttributeError, ValueError, RecursionError) as error:
        raise TraceError(
            f"{path}: its {METADATA_FILE} cannot be read ({type(error).__name__}: {error}): reindex the bag"
        ) from error
    if not isinstance(names, list) or not names or not all(isinstance(name, str) for name in names):
        raise TraceError(f"{path}: its {METADATA_FILE} lists no files: reindex the bag")
    if storage not in {None, "mcap"}:
        raise TraceError(
            f"{path}: a bag in {storage}: convert it to MCAP (ros2 bag convert, with storage_id: mcap), and give that"
        )
    found = []
    for name in names:
        # older recorders list a file by its name only, or below the folder's own name
        file = next((each for each in (path / name, path / name.rsplit("/", 1)[-1]) if each.is_file()), None)
        if file is None:
            raise TraceError(f"{path}: {name}, a part of this bag, is missing: copy the whole folder")
        if not file.stat().st_size:
            raise TraceError(
                f"{path}: {name}, a part of this bag, is empty (0 bytes): copy it again, or reindex the bag"
            )
        found.append(file)
    if unlisted := sorted(each.name for each in path.glob("*.mcap") if each not in found):
        raise TraceError(
            f"{path}: its {METADATA_FILE} does not list {unlisted[0]}: reindex the bag, or take the file out of its folder"
        )
    return found


def message_family(path: Path) -> str:
    """Return what kind of messages a drive's log holds: `osi`, `ros2`, `foxglove`, or `none` of them.

    The index at the end of the file is asked first, the whole file only where that says nothing: each reader then finds
    out for itself whether it was right to ask. A log may hold several: OSI counts first, it is the truth.
    """
    parts = mcap_files(path)
    for schemas in (_indexed, _recorded):
        found = {message_kind(name) for file in parts for name in schemas(file)}
        if found & OSI_SCHEMAS:
            return "osi"
        for name, roles in (("ros2", ROS_ROLES), ("foxglove", FOXGLOVE_ROLES)):
            if {roles.get(schema) for schema in found} & {ROAD_USERS, ODOMETRY}:
                return name
    return "none"


def _indexed(file: Path) -> set[str]:
    """Return the schemas that the index lists; none where it is not there or damaged."""
    return {schema.name for schema in read_index(file).schemas.values()}


def _recorded(file: Path) -> set[str]:
    """Return the schemas that stand among the data. Errors: `TraceError` for a damaged file."""
    container = Container(file, salvage=True)
    for _ in container.packets():
        pass
    return {schema.name for schema in container.schemas.values()}
