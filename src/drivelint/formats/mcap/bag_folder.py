"""Recognises the folder of a bag, as `ros2 bag record` leaves it, without reading its logs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from pathlib import Path

METADATA_FILE: Final = "metadata.yaml"
METADATA_ROOT: Final = "rosbag2_bagfile_information"


def is_bag(path: Path) -> bool:
    """Say whether `path` is a folder that rosbag2 recorded."""
    try:
        with (path / METADATA_FILE).open("rb") as file:
            return METADATA_ROOT.encode() in file.read(65536)
    except OSError:
        return False
