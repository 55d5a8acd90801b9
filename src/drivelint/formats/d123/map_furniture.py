"""The furniture of a 123D map: lights, crossings, road lines, and the layers that are not read."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np

from drivelint.formats.d123 import facts
from drivelint.formats.d123.map_layers import RoadLineFeatures
from drivelint.formats.d123.markings import RoadLine
from drivelint.road.boundary_lanes import BoundedLane, crossings, signal_row
from drivelint.road.quality import SIGNS_UNMAPPED_CHECK

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.arrays import Floats
    from drivelint.formats.d123.map_layers import MapLayers
    from drivelint.road.quality import MapQuality
    from drivelint.road.tables import Rows

_READ_LAYERS: Final = frozenset({"LANE", "LANE_GROUP", "INTERSECTION", "CROSSWALK", "ROAD_LINE"})
_LEAST_HEIGHT_DIFFERENCE_OF_LEVELS_M: Final = 3.0  # a crossing so far above or below a lane is not on it


def road_lines(layers: MapLayers, quality: MapQuality) -> list[RoadLine]:
    """Return the road lines in the order of the map."""
    types = layers.features("ROAD_LINE", RoadLineFeatures, quality)
    return [
        RoadLine(types[name].road_line_type, points)
        for name, points in layers.outlines("ROAD_LINE", quality).items()
        if name in types
    ]


def light_rows(lanes: Sequence[BoundedLane], light_lanes: set[int]) -> Rows:
    """Return a row of `traffic_signal` for each lane with a light, which is placed where the lane begins.

    In Waymo's data, the stopping points of lights are the first points of their lanes. The light's id is the lane's, as in the log.
    """
    rows = [
        signal_row(
            lane, 0.0, lane.line.centre[0], signal_id=lane.lanelet_id, kind="traffic_light", dynamic=True,
            turns=["left", "right", "straight", "u_turn"],
        )
        for lane in lanes
        if int(lane.lanelet_id) in light_lanes
    ]  # fmt: skip
    return sorted(rows, key=lambda row: str(row["signal_id"]))


def crossing_rows(
    layers: MapLayers, lanes: Sequence[BoundedLane], offset: tuple[float, float], quality: MapQuality
) -> Rows:
    """Return the rows of `crossing`; lanes on another level than the crossing are left out."""
    outlines = layers.outlines("CROSSWALK", quality)
    rows = crossings([_crossing_as_lane(name, ring) for name, ring in outlines.items()], lanes, offset, quality)
    by_id = {lane.lanelet_id: lane for lane in lanes}
    heights = {
        str(name): float(ring[:, 2].mean())
        for name, ring in outlines.items()
        if ring.shape[1] == 3 and layers.header.get("map_has_z")
    }
    return [
        row
        for row in rows
        if _is_crossing_on_level(row, by_id[row["lanelet_id"]], heights.get(row["crossing_id"], np.nan))
    ]


def _crossing_as_lane(crossing_id: int, ring: Floats) -> BoundedLane:
    """Return a crossing as a lane whose bounds are the two halves of the outline."""
    half = (len(ring) + 1) // 2
    return BoundedLane(str(crossing_id), ring[half - 1 :, :2][::-1], ring[:half, :2], "crossing")


def _is_crossing_on_level(crossing: dict[str, Any], lane: BoundedLane, height_m: float) -> bool:
    s = (crossing["s_start_m"] + crossing["s_end_m"]) / 2.0
    return not abs(float(np.interp(s, lane.line.s, lane.z)) - height_m) >= _LEAST_HEIGHT_DIFFERENCE_OF_LEVELS_M


def report_missing_content(layers: MapLayers, about: facts.DatasetFacts, quality: MapQuality) -> None:
    """Report the gaps of a map of 123D: missing signs, layers that are not read, and estimated bounds of lanes."""
    message = "a map of 123D has no signs: the right of way at a junction without a light is not known"
    quality.add(SIGNS_UNMAPPED_CHECK, "info", None, message)
    counts = {name: layers.n_objects(name) for name in facts.LAYER_NUMBERS if name not in _READ_LAYERS}
    unread = [f"{n} of {name.lower().replace('_', ' ')}" for name, n in counts.items() if n]
    if unread:
        message = f"objects of layers that are not read: {', '.join(unread)}"
        quality.add("layers_unread", "info", None, message, sum(counts.values()))
    if layers.unknown_layer_numbers:
        message = f"layers that 123D does not define: {', '.join(map(str, layers.unknown_layer_numbers))}: their objects are not read"
        quality.add("unknown_word", "warning", None, message, len(layers.unknown_layer_numbers))
    if about.estimated_bounds:
        message = (
            f"the converter estimated bounds {about.estimated_bounds}: near such a bound, an actor that seems "
            "to be outside may be inside, or the reverse"
        )
        quality.add("estimated_bounds", "warning", None, message)
