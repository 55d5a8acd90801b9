"""Map formats, recognised by the content of a file and never by its name."""

from __future__ import annotations

import math
import re
from importlib import import_module
from typing import TYPE_CHECKING

from drivelint.errors import MapError, UsageError
from drivelint.formats import limits
from drivelint.formats.files import is_utf8
from drivelint.formats.limits import read_within_limits
from drivelint.formats.probe import wrapping_and_remedy
from drivelint.formats.search import is_pipe_or_device
from drivelint.phrases import escape_invisible, path_hint
from drivelint.road.ground import BYTES_PER_SQUARE, SQUARE_SIDE_M, approximate_square_count
from drivelint.road.map_reader import MapOptions, MapSource, MapTables
from drivelint.road.tree_parts import CrowdedPlaceError

if TYPE_CHECKING:
    from pathlib import Path

MAX_MAP_BYTES = 512 * 2**20  # a city with 2,000 km of lanes takes about 200 MB: a larger file is a mistake or an attack

# the first byte of a map from an OSI trace: the tag of lane_boundary, lane, reference_line, logical_lane_boundary or logical_lane
OSI_MAP_FIRST_BYTES = (b"\x4a", b"\x52", b"\x8a", b"\x92", b"\x9a")
_XML_PROLOG_PART = re.compile(
    r"\s*(?:<\?.*?\?>|<!--.*?-->|<!DOCTYPE[^\[>]*(?:\[.*?\]\s*)?>)", re.DOTALL | re.IGNORECASE
)
_ROOT_TAG = re.compile(r"\s*<(?:[\w.-]+:)?([A-Za-z_][\w.-]*)")
_UNSUPPORTED_ROOTS = {
    "openscenario": "an OpenSCENARIO scenario, not its road network",
    "html": "an HTML page, as a failed download leaves behind",
}


READERS_BY_ROOT = {
    "opendrive": "opendrive.reader",
    "commonroad": "commonroad.lanelets",
    "osm": "lanelet2.reader",
    "net": "sumo.net",
}
"""Root element, lower case -> the module that reads such a map: `read(source, options)` returns `MapTables`."""
READERS_BY_BEGINNING = {b"{": "argoverse2.lanes", b"ARROW1": "d123.lanes", b"\x80": "scenarionet.lanes"}
"""The first bytes of a map that is not XML -> the module that reads it: JSON, Arrow's file format, a pickle."""


def read_source(path: Path) -> MapSource:
    """Return the name and bytes of a map file. Errors: `MapError` if it is missing, unreadable, empty or too large."""
    try:
        size = path.stat().st_size
        if is_pipe_or_device(path):
            raise MapError(f"map {path}: a pipe or a device: write its output to a file, and give that file")
        content = path.read_bytes() if size <= MAX_MAP_BYTES else b""
    except FileNotFoundError:
        raise MapError(
            f"map {path} does not exist: {path_hint(path) or 'give the path of an OpenDRIVE file with --map'}"
        ) from None
    except OSError as error:
        raise MapError(
            f"map {path} cannot be read ({error.strerror or error}): give a readable OpenDRIVE file with --map"
        ) from error
    if size > MAX_MAP_BYTES:
        raise _too_large_error(str(path), size)
    if not content:
        raise MapError(f"map {path} is empty: give the complete file")
    if (remedy := wrapping_and_remedy(content)) is not None:
        raise MapError(f"map {path}: {remedy}")
    if not is_utf8(path.name):
        raise MapError(
            f"map {escape_invisible(path.name)}: its name is not UTF-8, which the result files require: rename it"
        )
    return MapSource(path.name, content)


def _too_large_error(name: str, size: int) -> MapError:
    return MapError(f"map {name} has {size} bytes, but at most {MAX_MAP_BYTES} are read: use a smaller extract")


def load_map(
    source: MapSource,
    *,
    offset: tuple[float, float] = (0, 0),
    handedness: str = "auto",
    voted_handedness: str | None = None,
    origin: tuple[float, float] | None = None,
) -> MapTables:
    """Return the map as the tables of `schemas/map.sql`.

    `offset` (metres) is added to all coordinates. `handedness` is the user's option; `voted_handedness`, derived from the traces, is used
    only if neither the option nor the map states a side. `origin`: latitude and longitude (degrees) of the log's point 0,0.
    Errors: `MapError` for an unknown format or unreadable content, `UsageError` for an invalid option.
    """
    if handedness not in {"auto", "lht", "rht"}:
        raise UsageError(f"handedness {handedness!r} is not known: use auto, lht or rht")
    if not all(math.isfinite(v) for v in offset):
        raise UsageError(f"map offset {offset} is not two finite numbers of metres")
    if len(source.content) > MAX_MAP_BYTES:
        raise _too_large_error(source.name, len(source.content))
    side = None if handedness == "auto" else handedness
    request = MapOptions((float(offset[0]), float(offset[1])), side, voted_handedness, origin)

    def read() -> MapTables:
        tables: MapTables
        try:
            tables = import_module(f"drivelint.formats.{_reader_module(source)}").read(source, request)
        except CrowdedPlaceError as error:
            raise MapError(
                f"map {source.name}: {error}, more than in any road network: give a map without duplicates"
            ) from None
        _refuse_too_many_grid_squares(source, tables)
        return tables

    return read_within_limits(read, f"map {source.name}", len(source.content), MapError)


def _refuse_too_many_grid_squares(source: MapSource, tables: MapTables) -> None:
    """Raise `MapError` if the grid squares under the lanes would take more memory in the database than reading the file may take."""
    squares, largest = (
        approximate_square_count(tables.tables["lane_point"]),
        limits.memory_limit_bytes(len(source.content)),
    )
    if squares * BYTES_PER_SQUARE > largest:
        lanes = tables.tables["lanelet"].num_rows
        raise MapError(
            f"map {source.name}: its {lanes} lanes cover {squares:.0f} squares of {SQUARE_SIDE_M:g} m, and each takes "
            f"{BYTES_PER_SQUARE} bytes: more than the limit of {largest >> 20} MiB for a map of {len(source.content)} "
            "bytes: give a smaller part of the map"
        )


def _reader_module(source: MapSource) -> str:
    if source.content[:1] in OSI_MAP_FIRST_BYTES:
        return "osi.map_lanes"
    for beginning, reader in READERS_BY_BEGINNING.items():
        if source.content.startswith(beginning):
            return reader
    root = root_element_name(source.content)
    if root is None:
        head = source.content[:24]
        raise MapError(f"map {source.name} is not XML (it begins with {head!r}): give an OpenDRIVE file (.xodr)")
    if root.lower() not in READERS_BY_ROOT:
        looks = _UNSUPPORTED_ROOTS.get(root.lower(), f"XML with the root element <{root}>")
        raise MapError(
            f"map {source.name} looks like {looks}; supported: OpenDRIVE (root element <OpenDRIVE>), "
            "CommonRoad (<commonRoad>), Lanelet2 (<osm>), SUMO networks (<net>) and maps of 123D (Arrow)"
        )
    return READERS_BY_ROOT[root.lower()]


def root_element_name(content: bytes) -> str | None:
    """Return the root element's name without its namespace, or None if the content is not XML."""
    head = content[:65536]
    encoding = "utf-16" if head[:2] in {b"\xff\xfe", b"\xfe\xff"} else "utf-8"
    text = head.decode(encoding, errors="replace").lstrip("\ufeff")
    at = 0
    while skipped := _XML_PROLOG_PART.match(text, at):
        at = skipped.end()
    match = _ROOT_TAG.match(text, at)
    return match.group(1) if match else None
