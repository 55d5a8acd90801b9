"""Reads the ego's box relative to its rear axle from Autoware's parameters `vehicle_info`.

Autoware's nodes that need the box declare the parameters at their start, and ROS 2 then publishes them on `/parameter_events`.
So a bag that was recorded from the start contains them. Their meaning:
https://autowarefoundation.github.io/autoware-documentation/main/design/autoware-interfaces/components/vehicle-dimensions/
"""

from __future__ import annotations

from math import isfinite, nan
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from drivelint.drive.trace import QualityFinding
from drivelint.formats.ros2.messages import VEHICLE_LENGTH_NAMES
from drivelint.phrases import name_list

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping
    from typing import Any

    from numpy.typing import NDArray

    from drivelint.arrays import Mask
    from drivelint.formats.ros2.cdr import Table

AXLE_FRAME: Final = b"base_link"
"""Autoware's frame on the ground, below the middle of the rear axle."""
_HEIGHT_NAME: Final = "vehicle_height"
_WHOLE, _DOUBLE = 2, 3
"""The values of `rcl_interfaces/ParameterType` for integers and doubles."""
_SAME_LENGTH_TOLERANCE_M: Final = 0.001
"""Lengths that differ by less are equal: some are recorded in single precision."""
_LARGEST_BOX_SIDE_M: Final = 50.0
"""A longer or wider box is implausible."""


class VehicleBox(NamedTuple):
    """The box of a vehicle, in metres. `size`: length, width and height (NaN: unknown).

    `centre`: the box centre in the axle frame: ahead, left, up (0 if the height is unknown)."""

    size: tuple[float, float, float]
    centre: tuple[float, float, float]
    source: str
    """The node or topic from which the box comes."""

    def text(self) -> str:
        """Return the box in words."""
        (length, width, _), (ahead, left, _) = self.size, self.centre
        side = f" and {abs(left):.2f} m to the {'left' if left > 0.0 else 'right'}" if abs(left) >= 0.005 else ""
        return f"{length:.2f} m by {width:.2f} m, its centre {ahead:.2f} m ahead of base_link{side}"


def is_axle_frame(frames: NDArray[Any]) -> Mask:
    """Return for each frame name whether it is `AXLE_FRAME`, with or without a robot's name as prefix."""
    names = np.unique(frames)
    last = np.array([name.rpartition(b"/")[2] for name in names.tolist()], "S")
    result: Mask = np.isin(frames, names[last == AXLE_FRAME])
    return result


def vehicle_box(
    parameters: Iterable[Table], dimensions: Iterable[tuple[str, Table]]
) -> tuple[VehicleBox | None, list[QualityFinding]]:
    """Return the ego's box and findings. The box is None if no source gives one, or if sources differ.

    `parameters`: parameter events of nodes; `dimensions`: topic and messages of recorded dimensions. Lengths of several nodes are not
    combined into a box, because the nodes may mean different vehicles.
    """
    lengths_by_source = {**_lengths_by_node(parameters), **_lengths_by_topic(dimensions)}
    boxes = [
        box
        for source, lengths in sorted(lengths_by_source.items())
        if (box := _box_of_lengths(source, lengths)) is not None
    ]
    if not boxes:
        return None, []
    measures = np.array([[*box.size[:2], *box.centre[:2]] for box in boxes])
    if (np.ptp(measures, axis=0) > _SAME_LENGTH_TOLERANCE_M).any():
        message = f"{name_list([box.source for box in boxes])} give the ego different sizes, and none is used: set it with --ego-size"
        return None, [QualityFinding("ego_size", "warning", message, len(boxes))]
    return boxes[0], []


def _lengths_by_node(parameters: Iterable[Table]) -> dict[str, dict[str, float]]:
    """Return node -> name of a length -> its last value in metres."""
    values_by_node: dict[str, dict[str, float]] = {}
    for events in parameters:
        nodes = events.column("node")
        for change in ("new_parameters", "changed_parameters"):
            items = events.items(change)
            for i, name, value in _length_parameters(items):
                values_by_node.setdefault(nodes[items.parent[i]].decode("utf-8", "replace"), {})[name] = value
    return values_by_node


def _length_parameters(items: Table) -> Iterator[tuple[int, str, float]]:
    """Yield row, name and value of each parameter that is a length of the vehicle."""
    names, kind = items.column("name"), items.column("value.type")
    is_length = np.isin(names, [name.encode() for name in (*VEHICLE_LENGTH_NAMES, _HEIGHT_NAME)]) & np.isin(
        kind, (_WHOLE, _DOUBLE)
    )
    for i in np.flatnonzero(is_length).tolist():
        column = "value.double_value" if kind[i] == _DOUBLE else "value.integer_value"
        yield i, names[i].decode(), float(items.column(column)[i])


def _lengths_by_topic(dimensions: Iterable[tuple[str, Table]]) -> dict[str, dict[str, float]]:
    lengths: dict[str, dict[str, float]] = {}
    for topic, table in dimensions:
        if table.n:
            lengths[topic] = {name: float(table.column(name)[-1]) for name in VEHICLE_LENGTH_NAMES}
            lengths[topic][_HEIGHT_NAME] = float(table.columns.get("height", np.full(table.n, nan))[-1])
    return lengths


def _box_of_lengths(source: str, lengths: Mapping[str, float]) -> VehicleBox | None:
    """Return the box with these lengths; None if a length is missing, not a number, or implausible."""
    if not lengths.keys() >= set(VEHICLE_LENGTH_NAMES):
        return None
    base, front, rear, tread, left, right = (lengths[name] for name in VEHICLE_LENGTH_NAMES)
    length, width = front + base + rear, left + tread + right
    if not (0.0 < length < _LARGEST_BOX_SIDE_M and 0.0 < width < _LARGEST_BOX_SIDE_M and min(base, tread) > 0.0):
        return None
    height = lengths.get(_HEIGHT_NAME, nan)
    height = height if isfinite(height) and height > 0.0 else nan
    up = 0.5 * height if isfinite(height) else 0.0
    return VehicleBox((length, width, height), (0.5 * (front + base - rear), 0.5 * (left - right), up), source)
