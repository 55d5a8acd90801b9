"""The box of the vehicle that records Argoverse 2, a Ford Fusion Hybrid. The datasets do not contain its box.

The poses of a log are those of the `egovehicle` frame: its origin is the centre of the rear axle, x points ahead, z up (Argoverse's
maintainers in argoverse-api issue 286). Size and place of the box are from py123d's `av2_ford_fusion_hybrid`, which states the car's data
sheet and lidar points on the car as its sources. The same log read through 123D thus has the same ego.
The category EGO_VEHICLE of some annotation files is a placeholder of 4.877 x 2.0 x 1.473 m with its centre at the rear axle.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from drivelint.drive.trace import ASSUMED_SIZE_CHECK, QualityFinding
from drivelint.formats.coordinate_frames import Poses

if TYPE_CHECKING:
    from drivelint.arrays import Floats

EGO_BOX_SIZE_M: Final = (4.869, 1.852 + 0.275, 1.476)
"""Length, width (body plus mirrors) and height."""
BOX_CENTRE_FROM_REAR_AXLE_M: Final = (1.339, 0.0, 0.438)
"""The centre of the box in the egovehicle frame."""


def box_poses(rear_axle: Poses) -> Poses:
    """Return the poses of the vehicle's box for these poses of its egovehicle frame."""
    n = len(rear_axle.place)
    return rear_axle.compose(Poses(np.tile(BOX_CENTRE_FROM_REAR_AXLE_M, (n, 1)), np.tile([0.0, 0.0, 0.0, 1.0], (n, 1))))


def box_centres(x_m: Floats, y_m: Floats, yaw_rad: Floats) -> tuple[Floats, Floats]:
    """Return x and y of the box centre for these places and headings of the rear axle, on level ground."""
    ahead = BOX_CENTRE_FROM_REAR_AXLE_M[0]
    return x_m + ahead * np.cos(yaw_rad), y_m + ahead * np.sin(yaw_rad)


def assumed_size_finding(ego_id: str) -> QualityFinding:
    """Return the finding that the ego's size is assumed, not recorded."""
    message = "size of Argoverse's Ford Fusion from its documentation, not recorded"
    return QualityFinding(ASSUMED_SIZE_CHECK, "info", message, actor_id=ego_id)
