"""Finds the map of each drive; each map is read once.

From a folder of maps, each drive gets the first of these that exists:

1. the map that `maps.csv` (columns log, map) names,
2. the map with the name of the log or of its folder,
3. the map in the log,
4. the only map with the log's geo reference,
5. the only map with lanes at the drive's positions.

A drive in coordinates of another geo reference is transformed into the map's.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING, Final

import numpy as np
import pyarrow.compute as pc

from drivelint.arrays import floats
from drivelint.drive.finish import with_drive_condition_from_map, with_quality_finding
from drivelint.drive.trace import NOT_IN_FOLDER_CHECK, QualityFinding
from drivelint.engine import common_frame, map_fit
from drivelint.engine.map_folder import MANIFEST_FILE, MapFolder
from drivelint.errors import MapError, UsageError
from drivelint.formats.map_registry import load_map, read_source
from drivelint.phrases import name_list
from drivelint.road import geo_reference
from drivelint.road.driving_side import correction_hint, opposite_side
from drivelint.road.map_reader import MapSource

if TYPE_CHECKING:
    from pathlib import Path

    import pyarrow as pa
    import shapely

    from drivelint.drive.trace import DriveInput, Trace
    from drivelint.engine.map_fit import LaneHeadings
    from drivelint.road.map_reader import MapTables

MOVING_MPS = 1.0
FITS_PROJECTION_FINDING: Final = QualityFinding(
    "fits_projection",
    "info",
    "the log does not state its frame: it fits the map in the coordinates of the map's projection",
)
OFF_MAP_M = 50.0  # a drive that is farther than this from all lanes of a map is at another place


class MapLibrary:
    """Finds the environment (map) of each drive: the user's map, or the map in its log; `None` if there is neither.

    A drive without a map in the user's folder is judged without a map: `doubts_on_map` reports it.

    Errors: `MapError` for a map or folder that cannot be read, `UsageError` for options that exclude each other.
    """

    def __init__(self, options: DriveInput) -> None:
        if options.map and options.map_dir:
            raise UsageError("--map and --map-dir exclude each other: use one of them")
        self._options = options
        self._given = read_source(options.map) if options.map else None
        self._map_folder = MapFolder(options.map_dir) if options.map_dir else None
        self._ground = cache(map_fit.lane_areas)
        self._lanes = cache(map_fit.one_way_lanes)
        self._loaded: dict[tuple[str, tuple[float, float], str | None], MapTables] = {}
        self._unread: dict[Path, str] = {}
        self._without_map: dict[Path, str] = {}

    def read_user_map(self) -> None:
        """Read the map of `--map` before any drive, to report an unreadable map early. Errors: `MapError`, `UsageError`."""
        if self._given is not None:
            self._load_map(self._given, None, None)

    def nation_of_user_map(self) -> str | None:
        """Return the nation of the map of `--map`; None: no map, or no nation in it. Errors: `MapError`, `UsageError`."""
        return None if self._given is None else self._load_map(self._given, None, None).nation

    def find(self, trace: Trace) -> tuple[MapTables | None, Trace]:
        """Return the environment of one drive, and the drive in the environment's frame.

        The user's `--map-offset` takes precedence over the offset in the log. Errors: `MapError` if the map cannot be read, or is of
        another place.
        """
        source = self.find_source(trace)
        if source is None:
            return None, trace
        environment = self._load_map(source, trace, None)
        trace, trouble = self._moved_into_map_frame_or_evidence_of_other_place(environment, trace)
        if trouble:
            raise MapError(
                f"map {_file_name(environment)} is of another place than {trace.path.name}: {trouble}; "
                "set the right --map, or --map-offset"
            )
        if environment.lanes_source == "default":
            assert environment.lanes is not None  # noqa: S101 - `lanes` is None only where the map gives each lane's direction
            headings = self._lane_headings(environment, trace.tables["actor_state"], map_fit.DRIVING_SIDE_VOTE_SAMPLES)
            if voted := map_fit.vote_handedness(environment.lanes, headings):
                environment = self._load_map(source, trace, voted)
        return environment, with_drive_condition_from_map(trace, "nation", environment.nation)

    def _moved_into_map_frame_or_evidence_of_other_place(
        self, environment: MapTables, trace: Trace
    ) -> tuple[Trace, str | None]:
        """Return the drive in the map's frame, and the evidence that it is at another place, or None.

        These coordinates are tried, and the first that fit the map are used:

        1. the coordinates transformed by the geo references,
        2. the coordinates as recorded (tried first if log and map have the same reference and the log has no offset, because such a log
           mostly uses the coordinates of the map file, without its `<offset>`),
        3. for a log without a reference, projected coordinates, as SUMO's `--fcd-output.utm` writes them.
        """
        refusal = None
        try:
            candidates = [common_frame.move_into_map_frame(trace, environment), trace]
        except MapError as error:
            candidates, refusal = [trace], str(error)
        theirs = environment.tables["environment"]["geo_reference"][0].as_py() or ""
        if not any(trace.geo_offset) and geo_reference.is_same_reference(trace.geo_reference or "", theirs):
            candidates.reverse()
        ground = self._ground(environment)
        troubles = [
            _evidence_of_other_place(environment, ground, candidate.tables["actor_state"]) for candidate in candidates
        ]
        fitting = next(
            (candidate for candidate, trouble in zip(candidates, troubles, strict=True) if not trouble), None
        )
        if fitting is None and trace.geo_reference is None and common_frame.is_far_from_projection(environment):
            projected = common_frame.move_into_map_frame(replace(trace, geo_reference=theirs), environment)
            if not _evidence_of_other_place(environment, ground, projected.tables["actor_state"]):
                fitting = with_quality_finding(projected, FITS_PROJECTION_FINDING)
        return (trace, refusal or troubles[0]) if fitting is None else (fitting, None)

    def find_source(self, trace: Trace) -> MapSource | None:
        """Return the source of the map that `find` uses for a drive. Errors: as `find`."""
        embedded = MapSource("embedded", trace.embedded_map) if trace.embedded_map is not None else None
        if self._map_folder is None:
            return self._given or embedded
        return (
            self._map_folder.for_log(trace.path)
            or embedded
            or (self._map_folder.with_reference(trace.geo_reference) if trace.geo_reference else None)
            or self._only_fitting_map(self._map_folder, trace)
        )

    def uses_map_in_log(self, trace: Trace) -> bool:
        """Return whether `find` uses the map in the log."""
        if trace.embedded_map is None or self._given is not None:
            return False
        return self._map_folder is None or not self._map_folder.for_log(trace.path)

    def doubts_on_map(self, trace: Trace, environment: MapTables | None) -> dict[str, str]:
        """Return check id -> why the map may be wrong or missing for this drive: driving side, geo reference, unreadable maps.

        Errors: `MapError` if the traffic shows that the lanes have the wrong direction.
        """
        if environment is None:
            return {NOT_IN_FOLDER_CHECK: text} if (text := self._without_map.get(trace.path)) else {}
        texts = {
            "handedness_disagrees": self._driving_side_doubt(trace, environment),
            "map_unread": self._unread.get(trace.path),
        }
        reference, theirs = trace.geo_reference, environment.tables["environment"]["geo_reference"][0].as_py()
        if reference and theirs and geo_reference.is_conflicting_reference(reference, theirs):
            texts["geo_reference_differs"] = (
                f"the log's coordinates are {reference!r}, the map's {theirs!r}: if they are not of one place and frame, set the "
                "right --map or --map-offset"
            )
        return {check: text for check, text in texts.items() if text}

    def _driving_side_doubt(self, trace: Trace, environment: MapTables) -> str | None:
        side, source = environment.handedness, environment.handedness_source
        if (environment.lanes_source or source) in {"default", "traces"}:
            return None
        headings = self._lane_headings(environment, trace.tables["actor_state"], map_fit.DRIVING_SIDE_CHECK_SAMPLES)
        if road := map_fit.road_with_reversed_traffic(self._lanes(environment), headings):
            raise MapError(
                f"map {_file_name(environment)}: the traffic of {trace.path.name} runs against its lanes, on road {road} both ways: "
                f"the side of the road ({side} by {source}) or the lanes' direction is wrong; "
                f"{correction_hint(side, source)}, or use another map"
            )
        if map_fit.vote_handedness(side, headings) in {None, side}:
            return None
        statement = "--handedness says" if source == "option" else f"the map states (by {source})"
        return (
            f"{statement} {side}, the traces fit {opposite_side(side)}: "
            f"of {len(headings.agree)} headings examined, {int((~headings.agree).sum())} are "
            f"against the direction of their lane. {side} is used. If that is wrong, every direction is wrong: "
            f"{correction_hint(side, source)}."
        )

    def _lane_headings(self, environment: MapTables, states: pa.Table, max_positions: int) -> LaneHeadings:
        speed = np.hypot(floats(states["vx_mps"]), floats(states["vy_mps"]))
        moving = states.select(["x_m", "y_m", "yaw_rad"]).filter(np.nan_to_num(speed) > MOVING_MPS)
        x_m, y_m, yaw_rad = (floats(moving[name]) for name in ("x_m", "y_m", "yaw_rad"))
        return map_fit.compare_headings_with_lanes(self._lanes(environment), x_m, y_m, yaw_rad, max_positions)

    def _only_fitting_map(self, maps: MapFolder, trace: Trace) -> MapSource | None:
        """Return the only readable map that fits the drive's positions; None: no map fits.

        Errors: `MapError` if several maps fit.
        """
        fitting = []
        unread: list[MapError] = []
        for source in maps.sources():
            try:
                environment = self._load_map(source, trace, None)
            except MapError as error:
                unread.append(error)
                continue
            if not self._moved_into_map_frame_or_evidence_of_other_place(environment, trace)[1]:
                fitting.append(source)
        if len(fitting) == 1:
            if unread:  # an unreadable map may be the right one
                self._unread[trace.path] = (
                    f"{fitting[0].name} is the only map of the place among those that can be read; {len(unread)} cannot, the first: "
                    f"{unread[0]}"
                )
            return fitting[0]
        besides = f" ({len(unread)} could not be read, the first: {unread[0]})" if unread else ""
        if fitting:
            raise MapError(
                f"{maps.folder}: {name_list([s.name for s in fitting])} are all of the place of {trace.path.name}{besides}: "
                f"name its map in {maps.folder / MANIFEST_FILE}"
            )
        self._without_map[trace.path] = (
            f"no map in {maps.folder.name} is of the place of {trace.path.name}{besides}: it is judged without one: "
            f"name its map in {MANIFEST_FILE}"
        )
        return None

    def _load_map(self, source: MapSource, trace: Trace | None, voted_handedness: str | None) -> MapTables:
        """Return a map, shifted by the offset of the user, else of the log. `trace` None: the user's offset only."""
        offset = self._options.map_offset or (trace and trace.map_offset) or (0.0, 0.0)
        key = (source.sha256, offset, voted_handedness)
        if key not in self._loaded:
            self._loaded[key] = load_map(
                source,
                offset=offset,
                handedness=self._options.handedness,
                voted_handedness=voted_handedness,
                origin=self._options.map_origin,
            )
        return self._loaded[key]


def _file_name(environment: MapTables) -> str:
    """Return the name of the map's file, or of the log that contains the map."""
    return str(environment.tables["environment"]["name"][0].as_py())


def _evidence_of_other_place(environment: MapTables, lanes: shapely.STRtree, states: pa.Table) -> str | None:
    """Return the evidence that the map and the drive are at different places, or None."""
    drive, roads = _coordinate_bounds(states), _coordinate_bounds(environment.tables["lane_point"])
    if drive is None or roads is None:
        return None
    apart = max(drive[0] - roads[1], roads[0] - drive[1], drive[2] - roads[3], roads[2] - drive[3])
    if apart > OFF_MAP_M:
        return (
            f"its lanes lie in x {roads[0]:.0f}..{roads[1]:.0f}, y {roads[2]:.0f}..{roads[3]:.0f} m, "
            f"the drive in x {drive[0]:.0f}..{drive[1]:.0f}, y {drive[2]:.0f}..{drive[3]:.0f} m"
        )
    n_examined, n_on_map = map_fit.count_examined_and_on_map(lanes, floats(states["x_m"]), floats(states["y_m"]))
    if n_examined and not n_on_map:
        return f"none of the {n_examined} examined positions is on a lane or other area of the map"
    return None


def _coordinate_bounds(table: pa.Table) -> tuple[float, float, float, float] | None:
    x, y = pc.min_max(table["x_m"]).as_py(), pc.min_max(table["y_m"]).as_py()
    if x["min"] is None or y["min"] is None:
        return None
    return x["min"], x["max"], y["min"], y["max"]
