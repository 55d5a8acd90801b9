"""Recognises a folder that `ros2 bag record` wrote, without reading its logs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from pathlib import Path

METADATA_FILE: Final = "metadata.yaml"
METADATA_ROOT_KEY: Final = "rosbag2_bagfile_information"


def is_bag(path: Path) -> bool:
    """Return whether `path` is a folder that rosbag2 recorded."""
    try:
        with (path / METADATA_FILE).open("rb") as file:
            return METADATA_ROOT_KEY.encode() in file.read(65536)
    except OSError:
        return False
