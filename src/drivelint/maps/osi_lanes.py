"""Lanes that an OSI trace carries itself (`lane` and `lane_boundary` of its first ground truth).

OSI says left and right along the centre line's points, which may run against the traffic; here all is turned into the
direction of travel. An intersection is one area with pairs of lanes that lead into and out of it: a way is drawn for
each pair, as smooth as their ends allow.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

from drivelint import osi_schema
from drivelint.errors import MapError
from drivelint.maps.bounded import BoundedLane, build, side_driven_on, tables
from drivelint.maps.contract import Environment, MapSource, Request, environment_id
from drivelint.maps.quality import Quality
from drivelint.maps.tables import from_rows

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

_DRIVING, _NONDRIVING, _INTERSECTION = 2, 3, 4
_SUBTYPES = {
    3: "biking", 4: "sidewalk", 5: "parking", 6: "stop", 7: "restricted", 8: "border", 9: "shoulder", 10: "exit", 11: "entry",
    12: "onRamp", 13: "offRamp", 14: "connectingRamp",
}  # fmt: skip
_DRIVEN = frozenset({"exit", "entry", "onRamp", "offRamp", "connectingRamp"})
_MARKINGS = {2: "none", 3: "solid", 4: "broken", 5: "botts_dots", 8: "grass", 12: "curb"}
_CUT_M = 0.2  # a side that ends further than this from the lane's end is not whole
_NEAR_M = 5.0  # a lane that begins further away from where another ends does not follow it
_WAY_POINTS = 13


@dataclass(frozen=True)
class _Lane:
    """A lane of the trace turned into the direction of travel: its message, centre line, bounds (n, 2), neighbours."""

    message: Any
    centre: Floats
    left: Floats
    right: Floats
    turned: bool


class OsiLanesReader:
    """OSI ground truth with lanes that have boundaries."""

    format = "osi"

    def read(self, source: MapSource, request: Request) -> Environment:
        """Return the map's tables; `MapError` where no lane can be built."""
        quality = Quality()
        truth = osi_schema.message("GroundTruth").FromString(source.content)
        bounds = {b.id.value: b for b in truth.lane_boundary}
        found = {lane.id.value: _turned(lane, bounds) for lane in truth.lane}
        plain = {i: lane for i, lane in found.items() if lane is not None}
        ways = list(_ways(truth.lane, plain))
        lanes = build([*_lanes(plain, bounds, ways), *ways], request.offset, quality)
        if not any(lane.drivable for lane in lanes):
            raise MapError(
                f"map {source.name}: the trace's own lanes have no boundaries, so nothing can be placed on them"
            )
        sides = side_driven_on(lanes)
        how = "option" if request.handedness != "auto" else "lanes" if sides else "default"
        handedness = request.handedness if how == "option" else sides or "rht"
        if how == "default":
            message = (
                "nothing in the lanes says which side is driven on: right-hand traffic is a guess; give --handedness"
            )
            quality.add("handedness_default", "warning", None, message)
        name = environment_id(source, request.offset, handedness, guessed=how == "default")
        rows: dict[str, list[dict[str, Any]]] = {
            "environment": [
                {
                    "name": source.name, "sha256": source.sha256, "format": self.format,
                    "offset_x_m": request.offset[0], "offset_y_m": request.offset[1], "handedness": handedness,
                    "handedness_source": how, "geo_reference": None,
                }
            ],
            "traffic_signal": [], "stop_line": [], "road_object": [], "crossing": [],
        }  # fmt: skip
        result = tables(name, lanes) | {table: from_rows(table, name, content) for table, content in rows.items()}
        result["map_quality"] = quality.table(name)
        return Environment(name, handedness, how, result)


def _xy(points: Iterable[Any]) -> Floats:
    return np.array([(p.x, p.y) for p in points], np.float64).reshape(-1, 2)


def _turned(lane: Any, bounds: Mapping[int, Any]) -> _Lane | None:
    """Return a lane in the direction of travel; None for an area, or a lane without both bounds."""
    said = lane.classification
    centre = _xy(said.centerline)
    if len(centre) < 2 or (said.type == _INTERSECTION and len(said.lane_pairing) > 1):
        return None
    sides = [_bound(centre, ids, bounds) for ids in (said.left_lane_boundary_id, said.right_lane_boundary_id)]
    left, right = sides
    if left is None or right is None:
        return None
    if said.centerline_is_driving_direction:
        return _Lane(lane, centre, left, right, turned=False)
    return _Lane(lane, centre[::-1], right[::-1], left[::-1], turned=True)


def _bound(centre: Floats, ids: Iterable[Any], bounds: Mapping[int, Any]) -> Floats | None:
    """Return one side's points in the order of the centre line; None: fewer than two beside it."""
    parts = [_xy(p.position for p in bounds[i.value].boundary_line) for i in ids if i.value in bounds]
    if not parts:
        return None
    line = shapely.LineString(centre)
    points = np.vstack(parts)
    station = np.asarray(shapely.line_locate_point(line, shapely.points(points)), np.float64)
    order = np.argsort(station, kind="stable")
    points, station = points[order], station[order]
    # of what lies before or beyond the lane only the nearest point belongs to it
    inside = (station > 1e-6) & (station < line.length - 1e-6)
    first, last = points[station <= 1e-6], points[station >= line.length - 1e-6]
    kept = np.vstack([_nearest(first, centre[:1]), points[inside], _nearest(last, centre[-1:])])
    return _whole(kept, centre) if len(kept) > 1 else None


def _whole(side: Floats, centre: Floats) -> Floats:
    """Return a side (n, 2) led on beside the centre line (m, 2) to both of its ends: what is cut off is no gap in the road.

    esmini draws a boundary up to its last marked point, which may be metres before the lane's end.
    """
    way = np.gradient(centre, axis=0)
    left = np.column_stack([-way[:, 1], way[:, 0]]) / np.maximum(np.hypot(*way.T), 1e-9)[:, None]
    line = shapely.LineString(centre)
    at = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(centre, axis=0).T))])
    begin, end = (float(line.project(shapely.Point(p))) for p in (side[0], side[-1]))
    missing = (at < begin - _CUT_M), (at > end + _CUT_M)
    before, after = (
        centre[m] + left[m] * _offset(p, centre, left, s, at)
        for m, p, s in zip(missing, (side[0], side[-1]), (begin, end), strict=True)
    )
    return np.vstack([before, side, after])


def _offset(point: Floats, centre: Floats, left: Floats, station: float, at: Floats) -> float:
    """Return how far a point is to the left of the centre line."""
    k = int(np.argmin(np.abs(at - station)))
    return float(np.dot(point - centre[k], left[k]))


def _nearest(points: Floats, to: Floats) -> Floats:
    """Return the one point (1, 2) nearest to another (1, 2), or none (0, 2)."""
    if not len(points):
        return points
    return points[[int(np.argmin(np.hypot(*(points - to).T)))]]


def _kind(said: Any) -> tuple[str, bool]:
    if said.type in {_DRIVING, _INTERSECTION}:
        kind = _SUBTYPES.get(said.subtype, "driving")
        return (kind if kind in _DRIVEN else "driving"), True
    return _SUBTYPES.get(said.subtype, "none") if said.type == _NONDRIVING else "none", False


def _lanes(plain: Mapping[int, _Lane], bounds: Mapping[int, Any], ways: Sequence[BoundedLane]) -> Iterable[BoundedLane]:
    """Yield the lanes; where one ends at an intersection, the ways drawn from it follow."""
    linked = _linked(plain)
    for i, lane in plain.items():
        said = lane.message.classification
        kind, drivable = _kind(said)
        ids = [said.left_lane_boundary_id, said.right_lane_boundary_id]
        beside = [said.left_adjacent_lane_id, said.right_adjacent_lane_id]
        if lane.turned:
            ids, beside = ids[::-1], beside[::-1]
        neighbours = [_neighbour(lane, side, plain) for side in beside]
        yield BoundedLane(
            str(i), lane.left, lane.right, kind, drivable,
            junction_id=f"j{i}" if said.type == _INTERSECTION else None,
            successors=(
                *(str(b) for a, b in linked if a == i),
                *(way.lanelet_id for way in ways if way.lanelet_id.split(".")[1] == str(i)),
            ),
            left_id=neighbours[0][0], left_against=neighbours[0][1],
            right_id=neighbours[1][0], right_against=neighbours[1][1],
            left_marking=_marking(ids[0], bounds), right_marking=_marking(ids[1], bounds),
        )  # fmt: skip


def _linked(plain: Mapping[int, _Lane]) -> list[tuple[int, int]]:
    """Return (a, b) where b follows a, as either of the two says: esmini names some links only at the later lane."""
    pairs = set()
    for i, lane in plain.items():
        names = ["antecessor_lane_id", "successor_lane_id"]
        before, after = names[::-1] if lane.turned else names
        for pair in lane.message.classification.lane_pairing:
            if pair.HasField(before):
                pairs.add((getattr(pair, before).value, i))
            if pair.HasField(after):
                pairs.add((i, getattr(pair, after).value))
    return sorted((a, b) for a, b in pairs if a in plain and b in plain and _follows(plain[a], plain[b]))


def _neighbour(lane: _Lane, ids: Sequence[Any], plain: Mapping[int, _Lane]) -> tuple[str | None, bool | None]:
    for i in ids:
        if i.value in plain:
            other = plain[i.value]
            same = float(np.dot(lane.centre[-1] - lane.centre[0], other.centre[-1] - other.centre[0])) > 0
            return str(i.value), not same
    return None, None


def _marking(ids: Iterable[Any], bounds: Mapping[int, Any]) -> str | None:
    """Return the marking of a side; None where it is not known or changes along the lane."""
    kinds = {bounds[i.value].classification.type for i in ids if i.value in bounds}
    return _MARKINGS.get(next(iter(kinds))) if len(kinds) == 1 else None


def _follows(lane: _Lane, other: _Lane) -> bool:
    return bool(np.linalg.norm(lane.centre[-1] - other.centre[0]) < _NEAR_M)


def _ways(messages: Iterable[Any], plain: Mapping[int, _Lane]) -> Iterable[BoundedLane]:
    """Yield a lane for each pair that an intersection's area joins, and let the lane before lead to it."""
    for area in messages:
        if area.classification.type != _INTERSECTION or area.id.value in plain:
            continue
        pairs = {(p.antecessor_lane_id.value, p.successor_lane_id.value) for p in area.classification.lane_pairing}
        for into, out in sorted(pairs):
            way = _way(plain.get(into), plain.get(out))
            if way is not None:
                yield BoundedLane(
                    f"{area.id.value}.{into}.{out}", *way, junction_id=f"j{area.id.value}", successors=(str(out),)
                )


def _way(a: _Lane | None, b: _Lane | None) -> tuple[Floats, Floats] | None:
    """Return both bounds of a smooth way from where a lane ends to where another begins; None: not two lanes for driving."""
    if a is None or b is None or not (_kind(a.message.classification)[1] and _kind(b.message.classification)[1]):
        return None
    left, right = (_curve(p[-1], p[-1] - p[-2], q[0], q[1] - q[0]) for p, q in ((a.left, b.left), (a.right, b.right)))
    return left, right


def _curve(start: Floats, leaving: Floats, end: Floats, arriving: Floats) -> Floats:
    """Return points (n, 2) of the cubic with these ends and directions, each (1, 2)."""
    reach = float(np.linalg.norm(end - start))
    v0 = leaving / max(float(np.linalg.norm(leaving)), 1e-9) * reach
    v1 = arriving / max(float(np.linalg.norm(arriving)), 1e-9) * reach
    u = np.linspace(0.0, 1.0, _WAY_POINTS)[:, None]
    return (
        (2 * u**3 - 3 * u**2 + 1) * start
        + (u**3 - 2 * u**2 + u) * v0
        + (3 * u**2 - 2 * u**3) * end
        + (u**3 - u**2) * v1
    )
