"""The drive in geographic coordinates, for a viewer's map: the ego's positions; findings, paths of egos and lanes as GeoJSON (RFC 7946)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import msgspec
import numpy as np
import shapely

from drivelint.annotate.result_messages import Message, headline
from drivelint.drive.order import MAX_GAP_PERIODS
from drivelint.formats.protobuf import wire

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    import pyarrow as pa
    from numpy.typing import NDArray

    from drivelint.annotate.clock import LogClock
    from drivelint.annotate.road import Road
    from drivelint.annotate.tracks import Tracks
    from drivelint.arrays import Floats
    from drivelint.road.geo_reference import GeoFrame

POSITION_INTERVAL_NS: Final = 200_000_000
"""The interval of positions: the first position in each fifth of a second is written."""
_SIMPLIFY_TOLERANCE_M: Final = 0.1  # tolerance of the simplified outlines of lanes
_DECIMALS_OF_DEGREES: Final = 7  # of a degree: a centimetre
_FINDING_FACTS: Final = ("finding_id", "rule_id", "profile", "severity", "margin", "unit", "ego_id", "object_id")
_STYLE_OF_KIND: Final = {
    "finding": {"color": "#e02020"},
    "way": {"color": "#2173f2"},
    "lane": {"color": "#808590", "weight": 1},
}


def location_messages(tracks: Tracks, geo: GeoFrame, clock: LogClock, frame: str) -> list[Message]:
    """Return the `foxglove.LocationFix` messages of the first ego; `frame`: its coordinate frame, empty if it has none.

    A map's projection has no heights above the ellipsoid: the altitude stays 0, and the type of the covariance 0, unknown.
    """
    rows = _thinned_rows(tracks, tracks.egos[0]) if tracks.egos else np.zeros(0, np.intp)
    degrees = geo.longitude_latitude(_positions(tracks, rows))
    is_known = np.isfinite(degrees).all(axis=1)
    times = clock.log_times(tracks.t_ns[rows])
    return [
        Message(time, wire.doubles(latitude, longitude) + wire.time(6, time) + wire.text(7, frame))
        for time, (longitude, latitude) in zip(times[is_known].tolist(), degrees[is_known].tolist(), strict=True)
    ]


def geojson_message(
    findings: pa.Table, tracks: Tracks, geo: GeoFrame, road: Road | None, sense_by_rule: Mapping[str, str]
) -> bytes:
    """Return a `foxglove.GeoJSON` with the drivable lanes near the paths of all actors, the paths of the egos, and the findings."""
    shapes = [*_lane_outlines(road, tracks), *_ego_paths(tracks)]
    degrees = geo.longitude_latitude(np.concatenate([points for _, _, points in shapes] or [np.zeros((0, 2))]))
    ends = np.cumsum([len(points) for _, _, points in shapes])[:-1]
    features = []
    for (kind, name, _), points in zip(shapes, np.split(degrees, ends), strict=False):
        if np.isfinite(points).all():
            line = _rounded_degrees(points)
            geometry = {"type": "LineString", "coordinates": line}
            if kind == "lane":
                geometry = {"type": "Polygon", "coordinates": [line]}
            features.append(_feature(kind, geometry, {"name": name}))
    for row in findings.to_pylist():
        if row["lon"] is not None and row["lat"] is not None:
            geometry = {"type": "Point", "coordinates": _rounded_degrees(np.array([row["lon"], row["lat"]]))}
            facts = {key: row[key] for key in _FINDING_FACTS if row[key] is not None}
            features.append(_feature("finding", geometry, {"name": headline(row, sense_by_rule), **facts}))
    return wire.nested(1, msgspec.json.encode({"type": "FeatureCollection", "features": features}))


def _feature(kind: str, geometry: dict[str, Any], facts: dict[str, Any]) -> dict[str, Any]:
    return {
        "type": "Feature",
        "geometry": geometry,
        "properties": {"kind": kind, **facts, "style": _STYLE_OF_KIND[kind]},
    }


def _lane_outlines(road: Road | None, tracks: Tracks) -> Iterator[tuple[str, str, Floats]]:
    is_known = np.isfinite(tracks.x) & np.isfinite(tracks.y)
    if road is None or not is_known.any():
        return
    for name, outline in road.drivable_outlines(tracks.x[is_known], tracks.y[is_known]):
        yield (
            "lane",
            name,
            shapely.get_coordinates(shapely.simplify(shapely.linearrings(outline), _SIMPLIFY_TOLERANCE_M)),
        )


def _ego_paths(tracks: Tracks) -> Iterator[tuple[str, str, Floats]]:
    """Yield each ego's path, split where its position is unknown for some time."""
    for name in tracks.egos:
        rows, steps = _thinned_rows(tracks, name), np.diff(tracks.times(name))
        gap = max(MAX_GAP_PERIODS * float(np.median(steps)), 2 * POSITION_INTERVAL_NS) if len(steps) else 0.0
        for piece in np.split(rows, np.flatnonzero(np.diff(tracks.t_ns[rows]) > gap) + 1):
            if len(piece) > 1:
                yield "way", name, _positions(tracks, piece)


def _thinned_rows(tracks: Tracks, name: str) -> NDArray[np.intp]:
    """Return the rows in which an actor has a position, at most one per `POSITION_INTERVAL_NS`."""
    span = tracks.rows_by_actor[name]
    rows = np.arange(span.start, span.stop)
    rows = rows[np.isfinite(tracks.x[rows]) & np.isfinite(tracks.y[rows])]
    _, first = np.unique((tracks.t_ns[rows] - tracks.t_ns[span.start]) // POSITION_INTERVAL_NS, return_index=True)
    return rows[first]


def _positions(tracks: Tracks, rows: NDArray[np.intp]) -> Floats:
    return np.stack([tracks.x[rows], tracks.y[rows]], axis=1)


def _rounded_degrees(degrees: Floats) -> Any:
    return np.round(degrees, _DECIMALS_OF_DEGREES).tolist()
