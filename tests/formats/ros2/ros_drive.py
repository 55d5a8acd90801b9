"""ROS 2 logs of a few road users."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from tests.formats.logs import read
from tests.formats.ros2 import ros_log as ros

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.drive.trace import Trace

T0 = 100.0

N = 40

TURN = math.pi / 3
"""The heading of those that do not drive east, so that the frames of a velocity differ."""


def trace_of(path: Path, messages: list[ros.Message], **options: Any) -> Trace:
    return read(ros.write(path / "log.mcap", messages), **options)


def ticks(n: int = N, dt: float = 0.05) -> list[float]:
    return [T0 + i * dt for i in range(n)]


def along(t_s: float, speed: float = 10.0, yaw: float = TURN) -> tuple[float, float]:
    """Return where somebody is who drives with that heading from the origin."""
    way = speed * (t_s - T0)
    return way * math.cos(yaw), way * math.sin(yaw)


def road_users(**options: Any) -> list[ros.Message]:
    """Return a car that comes towards the ego, and a pedestrian."""
    return [
        ros.things(
            t_s,
            ros.thing(9, 100.0 - along(t_s)[0], 100.0 - along(t_s)[1], TURN - math.pi, 10.0),
            ros.thing(12, 5.0, 5.0, classification=4, shape={"type": 3, "dimensions": [1.8, 0.3]}),
            **options,
        )
        for t_s in ticks()
    ]


def ego(dt: float = 0.05, n: int = N, **options: Any) -> list[ros.Message]:
    return [ros.odometry(t_s, *along(t_s), TURN, 10.0, **options) for t_s in ticks(n, dt)]
