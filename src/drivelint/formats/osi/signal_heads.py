"""Groups OSI's bulbs, each of which is a `TrafficLight` message, into the traffic lights that drivers see.

A bulb that refers to an OpenDRIVE signal belongs to that signal. Other bulbs form one light if they apply to the same lanes, show the
same icon, face the same direction and are next to each other.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from drivelint.arrays import wrap_angles
from drivelint.formats.osi.schema import LIGHT_REFERENCE, OPEN_DRIVE_REFERENCE

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

_LARGEST_DISTANCE_BETWEEN_BULBS_M: Final = 0.6  # largest distance between the centres of two bulbs of one light
_LARGEST_ANGLE_BETWEEN_BULBS_RAD: Final = 0.2


def light_by_bulb(bulbs: Iterable[Any]) -> dict[str, str]:
    """Return bulb id -> light id, for bulbs without an OpenDRIVE signal that form a light with other bulbs."""
    rows: dict[Any, list[Any]] = {}
    for bulb in bulbs:
        classification = bulb.classification
        refers = any(ref.type == OPEN_DRIVE_REFERENCE and ref.identifier for ref in bulb.source_reference)
        lanes = (
            tuple(sorted(i.value for i in classification.assigned_lane_id)),
            tuple(
                sorted(bulb_waiting.assigned_lane_id.value for bulb_waiting in classification.logical_lane_assignment)
            ),
        )
        if not refers and bulb.base.HasField("position"):
            rows.setdefault((lanes, classification.icon), []).append(bulb)
    light_ids: dict[str, str] = {}
    for row in rows.values():
        waiting = sorted(row, key=lambda bulb: bulb.id.value)
        while waiting:
            light = [waiting.pop(0)]
            for bulb in light:  # the list grows during the loop
                near = [bulb_waiting for bulb_waiting in waiting if _are_adjacent_bulbs(bulb, bulb_waiting)]
                light += near
                waiting = [bulb_waiting for bulb_waiting in waiting if bulb_waiting not in near]
            if len(light) > 1:
                light_ids |= {str(bulb.id.value): str(light[0].id.value) for bulb in light}
    return light_ids


def bulb_without_state(bulb: Any, light_ids: Mapping[str, str]) -> Any:
    """Return a copy of a bulb without colour and mode, and with a reference to its light. `light_ids`: bulb id -> light id."""
    map_bulb = type(bulb).FromString(bulb.SerializeToString())
    for field in ("color", "mode"):
        map_bulb.classification.ClearField(field)
    light = light_ids.get(str(bulb.id.value))
    if light is not None:
        reference = map_bulb.source_reference.add()
        reference.type = LIGHT_REFERENCE
        reference.identifier.append(light)
    return map_bulb


def _are_adjacent_bulbs(a: Any, b: Any) -> bool:
    p, q = a.base.position, b.base.position
    apart = math.dist((p.x, p.y, p.z), (q.x, q.y, q.z))
    turned = float(wrap_angles(np.array(a.base.orientation.yaw - b.base.orientation.yaw)))
    return apart <= _LARGEST_DISTANCE_BETWEEN_BULBS_M and abs(turned) <= _LARGEST_ANGLE_BETWEEN_BULBS_RAD
