"""Links between lanelets, in the direction of travel.

Every link that the file declares, at a lane, a road's end or a junction, means that two lane ends touch. Directions are
applied once, to the touching ends; so it does not matter which side declares a link, or whether both sides do.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely

from drivelint.formats.opendrive.junctions import END, START
from drivelint.formats.opendrive.lanelet import LaneKey, Lanelet, lanelet_id
from drivelint.road.tree_parts import query_in_parts

if TYPE_CHECKING:
    from collections.abc import Iterator

    from drivelint.formats.opendrive.junctions import Connection
    from drivelint.formats.opendrive.lanes import BuiltLanes
    from drivelint.formats.opendrive.network import LaneSection, Network, Road
    from drivelint.road.quality import MapQuality

REPORTED_GAP_M = 0.5  # linked ends further apart than this are reported
TOUCH_DISTANCE_M = 0.1  # a lane that begins this close to another's end, in the same direction, should be linked to it
MIN_TOUCH_HEADING_COS = 0.98
LaneEnd = tuple[LaneKey, str]
Link = tuple[Lanelet, Lanelet]  # the second continues the first
_OPPOSITE_END = {START: END, END: START}


def lanelet_links(net: Network, lanes: BuiltLanes, quality: MapQuality) -> list[Link]:
    """Return the links, each once, ordered by ids; links to missing lanes and over gaps are reported in `quality`."""
    declared = {key for road in net.roads.values() for key in road.lane_keys}
    touching: set[tuple[LaneEnd, LaneEnd]] = set()
    for a, b in _declared_contacts(net, quality):
        if b[0] in declared:
            touching.add((min(a, b), max(a, b)))
        else:
            _report_missing_link(lanes, a, f"lane {lanelet_id(b[0])}, which does not exist", quality)
    link_by_ids: dict[tuple[str, str], Link] = {}
    for a, b in sorted(_contacts_through_short_lanes(touching, lanes.short)):
        link = _directed_link(a, b, lanes, quality)
        if link is not None:
            link_by_ids[link[0].lanelet_id, link[1].lanelet_id] = link
    result = [link_by_ids[key] for key in sorted(link_by_ids)]
    for source, target in result:
        gap = float(np.hypot(*(source.line.centre[-1] - target.line.centre[0])))
        if gap > REPORTED_GAP_M:
            name = source.lanelet_id
            message = f"lane {target.lanelet_id} begins {gap:.2f} m away from the end of lane {name} that it continues"
            quality.add("link_gap", "warning" if source.drivable else "info", name, message)
    _report_unlinked_touching_ends(sorted(lanes.built.values(), key=lambda lane: lane.key), link_by_ids, quality)
    return result


def _declared_contacts(net: Network, quality: MapQuality) -> Iterator[tuple[LaneEnd, LaneEnd]]:
    for road in net.roads.values():
        for side in (1, -1):
            lane_sections = road.sections_on_side(side)
            for before, lane_section, after in zip(
                [None, *lane_sections], lane_sections, [*lane_sections[1:], None], strict=False
            ):
                for lane in lane_section.lanes:
                    if lane.number * side > 0 and lane.invalid is None:
                        key = (road.road_id, lane_section.section, lane.number)
                        yield from _contacts_of_end(net, road, (key, START), lane.predecessors, before, quality=quality)
                        yield from _contacts_of_end(net, road, (key, END), lane.successors, after, quality=quality)
    for connection in net.connections:
        yield from _junction_contacts(net, connection, quality)


def _contacts_of_end(
    net: Network,
    road: Road,
    lane_end: LaneEnd,
    targets: tuple[int, ...],
    next_section: LaneSection | None,
    *,
    quality: MapQuality,
) -> Iterator[tuple[LaneEnd, LaneEnd]]:
    """Yield the contacts of a lane's end with lane ends in the next section of its road, or in the next road."""
    key, end = lane_end
    if next_section is not None:
        for target in targets:
            yield (key, end), ((road.road_id, next_section.section, target), _OPPOSITE_END[end])
        return
    join = road.links.get(end)
    if join is None or join.is_junction or not targets:
        return
    other_road = net.roads.get(join.element_id)
    if other_road is None:
        yield from (((key, end), ((join.element_id, 0, target), START)) for target in targets)
        return
    back = [e for e, link in other_road.links.items() if not link.is_junction and link.element_id == road.road_id]
    contact = join.contact or (back[0] if len(back) == 1 else None)
    if contact is None:
        name = lanelet_id(key)
        message = f"lane {name} continues in road {join.element_id}, but the file does not state at which end"
        quality.add("missing_link", "error", name, message)
        return
    for target in targets:
        yield (key, end), (_lane_key_at_end(other_road, contact, target), contact)


def _lane_key_at_end(road: Road, contact: str, lane_no: int) -> LaneKey:
    lane_sections = road.sections_on_side(lane_no)
    if not lane_sections:
        return (road.road_id, 0, lane_no)
    return (road.road_id, lane_sections[0 if contact == START else -1].section, lane_no)


def _junction_contacts(net: Network, connection: Connection, quality: MapQuality) -> Iterator[tuple[LaneEnd, LaneEnd]]:
    incoming, connecting = net.roads.get(connection.incoming), net.roads.get(connection.connecting)
    if incoming is None or connecting is None:
        absent = connection.incoming if incoming is None else connection.connecting
        message = f"junction {connection.junction_id} connects road {absent}, which does not exist"
        quality.add("missing_link", "error", absent, message, max(len(connection.lanes), 1))
        return
    end, contact = _end_at_junction(incoming, connecting, connection), connection.contact
    for source, target in connection.lanes:
        yield (_lane_key_at_end(incoming, end, source), end), (_lane_key_at_end(connecting, contact, target), contact)


def _end_at_junction(incoming: Road, connecting: Road, connection: Connection) -> str:
    """Return which end of the incoming road is at the junction: as this road or the connecting road states, else the nearer end."""
    ends = [e for e, join in incoming.links.items() if join.is_junction and join.element_id == connection.junction_id]
    if len(ends) == 1:
        return ends[0]
    back = connecting.links.get(connection.contact)
    if back is not None and not back.is_junction and back.element_id == incoming.road_id and back.contact is not None:
        return back.contact
    at = _road_end_xy(connecting, connection.contact)
    return min((START, END), key=lambda e: float(np.hypot(*(_road_end_xy(incoming, e) - at))))


def _road_end_xy(road: Road, end: str) -> np.ndarray:
    s = np.array([0.0 if end == START else road.length_m])
    line = road.plan.evaluate(s, np.clip(s, 1e-6, max(road.length_m - 1e-6, 1e-6)))
    return np.array([line.x[0], line.y[0]])


def _contacts_through_short_lanes(
    touching: set[tuple[LaneEnd, LaneEnd]], short: set[LaneKey]
) -> set[tuple[LaneEnd, LaneEnd]]:
    """Return the contacts; where a section was left out as too short, the lanes at its two ends touch each other instead."""
    result = set(touching)
    for key in sorted(short):
        beside: dict[str, set[LaneEnd]] = {START: set(), END: set()}
        for pair in [p for p in result if key in {p[0][0], p[1][0]}]:
            result.discard(pair)
            for first, second in (pair, pair[::-1]):
                if first[0] == key and second[0] != key:
                    beside[first[1]].add(second)
        result |= {(min(a, b), max(a, b)) for a in beside[START] for b in beside[END]}
    return result


def _directed_link(a: LaneEnd, b: LaneEnd, lanes: BuiltLanes, quality: MapQuality) -> Link | None:
    """Return the link in the direction of travel; None if a lane was left out or the directions contradict each other (reported)."""
    first, second = lanes.built.get(a[0]), lanes.built.get(b[0])
    if first is None or second is None:
        for end, far_end in ((a, b), (b, a)):
            if far_end[0] in lanes.failed and end[0] in lanes.built:
                _report_missing_link(lanes, end, f"lane {lanelet_id(far_end[0])}, which could not be built", quality)
        return None
    leaves, enters = _exit_end(first) == a[1], _exit_end(second) != b[1]
    if leaves and enters:
        return first, second
    if not leaves and not enters:
        return second, first
    if not (first.bidirectional or second.bidirectional) and first.drivable and second.drivable:
        message = (
            f"{first.lanelet_id} and {second.lanelet_id} are linked, but have opposite directions: the link is ignored"
        )
        quality.add("direction_conflict", "warning", first.lanelet_id, message)
    return None


def _exit_end(lane: Lanelet) -> str:
    return END if lane.along > 0 else START


def _report_missing_link(lanes: BuiltLanes, end: LaneEnd, target: str, quality: MapQuality) -> None:
    lane = lanes.built.get(end[0])
    if end[0] in lanes.narrow:
        return
    severity = "error" if lane is None or lane.drivable else "warning"
    name = lanelet_id(end[0])
    quality.add("missing_link", severity, name, f"lane {name} is linked at its {end[1]} to {target}")


def _report_unlinked_touching_ends(
    lanes: list[Lanelet], links: dict[tuple[str, str], Link], quality: MapQuality
) -> None:
    """Report drivable lanes that another lane continues without a link: chains of lanes would end there."""
    lanes = [lane for lane in lanes if lane.drivable]
    if not lanes:
        return
    ends, starts = ([lane.line.centre[k] for lane in lanes] for k in (-1, 0))
    touching = query_in_parts(
        shapely.STRtree(shapely.points(starts)), shapely.points(ends), "dwithin", TOUCH_DISTANCE_M
    )
    for i, j in (pair for part in touching for pair in sorted(np.stack(part, axis=1).tolist())):
        a, b = lanes[i], lanes[j]
        same = float((a.line.tangent[-1] * b.line.tangent[0]).sum()) > MIN_TOUCH_HEADING_COS
        if same and (a.lanelet_id, b.lanelet_id) not in links:
            message = f"lane {b.lanelet_id} begins where lane {a.lanelet_id} ends, but the map does not link them"
            quality.add("unlinked_end", "error", a.lanelet_id, message)
