"""Converts states from a log's own frame and reference point to the right-handed map frame and box centres."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from drivelint.arrays import rotate_vectors
from drivelint.drive.box_centre import lever_to_centre, velocity_of_centre, yaw_rates

if TYPE_CHECKING:
    from drivelint.drive.trace import States
    from drivelint.formats.tables.mapping import Mapping

_COLUMN_OF_QUANTITY = {
    "x": "x_m", "y": "y_m", "z": "z_m", "yaw": "yaw_rad", "vx": "vx_mps", "vy": "vy_mps",
    "ax": "ax_mps2", "ay": "ay_mps2", "length": "length_m", "width": "width_m", "height": "height_m",
}  # fmt: skip


def convert_to_map_frame(states: States, mapping: Mapping) -> None:
    """Replace the mapping's quantities (SI, log's frame and reference point) by the columns of `STATE_COLUMNS` and `SIZE_COLUMNS`.

    Order: axes and heading are flipped, velocities along the vehicle's axes are turned into the world frame, and the reference
    point is moved to the box centre. The centre's velocity is that of the reference point plus yaw rate times lever arm. The yaw
    rate is the log's, or the derivative of the heading. Accelerations are only turned, not moved to the centre.
    """
    log = states.numbers
    unknown_values = np.full(len(states), np.nan)
    if mapping.frame.flip_y:
        for name in {"y", "vy", "ay"} & log.keys():
            log[name] = -log[name]
    if "yaw" in log:
        sign = -1.0 if mapping.frame.flip_yaw else 1.0
        log["yaw"] = sign * log["yaw"] + (np.pi / 2.0 if mapping.frame.yaw_zero == "north" else 0.0)
        if "yaw_rate" in log:
            log["yaw_rate"] = sign * log["yaw_rate"]
    if "speed" in log:
        log["vx"], log["vy"] = log["speed"] * np.cos(log["yaw"]), log["speed"] * np.sin(log["yaw"])
    elif mapping.frame.velocity == "vehicle":
        for east, north in (("vx", "vy"), ("ax", "ay")):
            if east in log:
                log[east], log[north] = rotate_vectors(log[east], log[north], log["yaw"])
    if mapping.reference.point != "centre":
        _move_to_box_centre(states, mapping)
    states.numbers = {column: log.get(quantity, unknown_values) for quantity, column in _COLUMN_OF_QUANTITY.items()}


def _move_to_box_centre(states: States, mapping: Mapping) -> None:
    log = states.numbers
    zero = np.zeros(len(states))
    forward = -0.5 * log["length"] if mapping.reference.point == "front_bumper" else log["forward"]
    lever = lever_to_centre(forward, log.get("left", zero), log["yaw"])
    log["x"], log["y"] = log["x"] + lever[0], log["y"] + lever[1]
    if "z" in log:
        log["z"] = log["z"] + log.get("up", zero)
    if "vx" in log:
        turning = log["yaw_rate"] if "yaw_rate" in log else yaw_rates(states, log["yaw"])
        log["vx"], log["vy"] = velocity_of_centre(np.stack([log["vx"], log["vy"]]), lever, turning)
