"""Finds the map of a log in a folder of maps, for logs of several places."""

from __future__ import annotations

import csv
from fnmatch import fnmatchcase
from functools import cache
from typing import TYPE_CHECKING, Final

from drivelint.errors import MapError
from drivelint.formats.map_registry import READERS_BY_ROOT, read_source, root_element_name
from drivelint.globs import glob_length_problem
from drivelint.phrases import name_list
from drivelint.road.geo_reference import is_same_reference, opendrive_geo_reference

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from drivelint.road.map_reader import MapSource

MANIFEST_FILE: Final = "maps.csv"
_HEAD_BYTES = 65536
_ARGOVERSE_LANES_KEY: Final = b'"lane_segments"'
"""A key that the JSON of every Argoverse map contains, and other JSON files do not."""


class MapFolder:
    """The maps of a folder; each is read when it is needed.

    Errors: `MapError` if the folder does not exist or has no maps, or if the manifest is invalid.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        if not folder.is_dir():
            raise MapError(f"--map-dir {folder}: no such folder")
        self._files = {file.relative_to(folder).as_posix(): file for file in sorted(folder.rglob("*")) if _is_map(file)}
        if not self._files:
            raise MapError(
                f"--map-dir {folder}: no map in this folder (OpenDRIVE, CommonRoad, SUMO, Lanelet2 or Argoverse 2)"
            )
        self._manifest = self._read_manifest()
        self._source = cache(lambda name: read_source(self._files[name]))

    def for_log(self, log: Path) -> MapSource | None:
        """Return the log's map by the manifest, else the only map with the name of the log or of its folder; None: there is none."""
        for pattern, name in self._manifest:
            if fnmatchcase(log.name, pattern):
                return self._source(name)
        for stem in (log.stem, log.resolve().parent.name):
            same = [name for name, file in self._files.items() if file.stem == stem]
            if len(same) == 1:
                return self._source(same[0])
        return None

    def with_reference(self, reference: str) -> MapSource | None:
        """Return the map with this geo reference; None: not exactly one map has it."""
        names = [
            source for source in self.sources() if is_same_reference(opendrive_geo_reference(source) or "", reference)
        ]
        return names[0] if len(names) == 1 else None

    def sources(self) -> Sequence[MapSource]:
        """Return every map, sorted by name."""
        return [self._source(name) for name in self._files]

    def _read_manifest(self) -> list[tuple[str, str]]:
        file = self.folder / MANIFEST_FILE
        if not file.is_file():
            return []
        with file.open(encoding="utf-8-sig", newline="") as lines:
            rows = csv.DictReader(lines, skipinitialspace=True)
            if not {"log", "map"} <= set(rows.fieldnames or ()):
                raise MapError(f"{file}: write the columns log,map: a file name (or a glob) and the map it belongs to")
            pairs = [(row["log"] or "", row["map"] or "") for row in rows]
        for n, (pattern, name) in enumerate(pairs, 2):
            if problem := glob_length_problem(pattern):
                raise MapError(f"{file}:{n}: the glob in the column log has {problem}")
            if name not in self._files:
                raise MapError(
                    f"{file}:{n}: there is no map {name!r} in {self.folder}; it has {name_list(list(self._files))}"
                )
        return pairs


def _is_map(file: Path) -> bool:
    suffix = file.suffix.lower()
    if not file.is_file() or suffix not in {".xodr", ".xml", ".osm", ".json"}:
        return False
    if suffix == ".json":
        return _ARGOVERSE_LANES_KEY in file.read_bytes()
    with file.open("rb") as content:
        return (root_element_name(content.read(_HEAD_BYTES)) or "").lower() in READERS_BY_ROOT
