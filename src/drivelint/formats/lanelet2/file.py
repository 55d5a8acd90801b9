"""Loads the file of a Lanelet2 map with the library lanelet2, by its local coordinates if it has any (Autoware)."""

from __future__ import annotations

import math
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from lxml import etree

from drivelint.errors import MapError
from drivelint.formats import safe_xml

if TYPE_CHECKING:
    from drivelint.arrays import Floats
    from drivelint.road.map_reader import MapOptions, MapSource
    from drivelint.road.quality import MapQuality


_EARTH_RADIUS_M = 6_378_137.0


def load_map_and_is_local(source: MapSource, request: MapOptions, quality: MapQuality) -> tuple[Any, bool]:
    """Return the library's map, and whether its coordinates are local; elements that the library cannot read are in `quality`.

    Errors: `MapError` if the library is not installed, the file is not a Lanelet2 map, or latitude and longitude of the log's
    origin are needed but not given.
    """
    try:
        import lanelet2
    except ImportError as error:
        raise MapError(
            f"map {source.name} is a Lanelet2 map, and the package lanelet2 is not installed: pip install 'drivelint[lanelet2]'"
        ) from error
    root = safe_xml.parse_map(source)  # unlike the library, this refuses entities
    local = root.find("node/tag[@k='local_x']") is not None
    if local:
        _set_lat_lon_from_local(root, quality)
        if request.origin is not None:
            message = "the map has local coordinates: these are used, and --map-origin is ignored"
            quality.add("map_origin_unused", "info", None, message)
    elif request.origin is None:
        raise MapError(
            f"map {source.name} is in latitude and longitude: set the point that is 0,0 in the log with --map-origin LAT,LON"
        )
    latitude, longitude = (0.0, 0.0) if local or request.origin is None else request.origin
    origin = lanelet2.io.Origin(latitude, longitude)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "map.osm"
        path.write_bytes(etree.tostring(root) if local else source.content)
        try:
            layers, errors = lanelet2.io.loadRobust(str(path), lanelet2.projection.LocalCartesianProjector(origin))
        except RuntimeError as error:
            raise MapError(f"map {source.name} cannot be read as Lanelet2: {' '.join(str(error).split())}") from error
    for message in errors:
        quality.add("invalid_element", "error", None, " ".join(str(message).split()))
    return layers, local


def _set_lat_lon_from_local(root: etree._Element, quality: MapQuality) -> None:
    """Set the latitude and longitude of every node from its local coordinates.

    In Autoware's maps, latitude and longitude are empty or of another frame; the library uses them to decide which bound of a lane is the
    left one and in which direction it runs. A node without local coordinates has no place.
    """
    n_lost = 0
    first: tuple[float, float] | None = None
    for node in root.iterfind("node"):
        tags = {tag.get("k"): tag for tag in node.iterfind("tag")}
        x, y = (safe_xml.number_or_nan(tags[k].get("v") if k in tags else None) for k in ("local_x", "local_y"))
        if not (math.isfinite(x) and math.isfinite(y)):
            n_lost += 1
            x = y = math.nan
        elif first is None:
            first = x, y
        for k, value in (("local_x", x), ("local_y", y)):
            (tags[k] if k in tags else etree.SubElement(node, "tag", k=k)).set("v", repr(value))
        east, north = (0.0, 0.0) if first is None or math.isnan(x) else (x - first[0], y - first[1])
        node.set("lon", repr(math.degrees(east / _EARTH_RADIUS_M)))
        node.set("lat", repr(math.degrees(north / _EARTH_RADIUS_M)))
    if n_lost:
        message = "nodes lack local_x and local_y, which the other nodes have: the elements that use them are left out"
        quality.add("unplaced_node", "warning", None, message, n_lost)


def line_points(bound: Any) -> Floats:
    """Return the points (n, 2) of a line, in local coordinates where the nodes have them (Autoware)."""
    return np.array(
        [
            (float(p.attributes["local_x"]), float(p.attributes["local_y"]))
            if "local_x" in p.attributes
            else (p.x, p.y)
            for p in bound
        ],
        np.float64,
    ).reshape(-1, 2)


def attribute(element: Any, name: str) -> str:
    """Return the text of a tag; an empty text if the element does not have this tag."""
    return str(element.attributes[name]) if name in element.attributes else ""
