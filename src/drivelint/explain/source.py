"""Opens the drive of a verdict without derived tables, from the kept database or from its log."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import duckdb

from drivelint.arrays import replace_columns
from drivelint.drive.finish import TRACE_TABLES
from drivelint.drive.trace import Trace
from drivelint.engine.batch import Drive, drive_with_map
from drivelint.engine.map_library import MapLibrary
from drivelint.engine.robustness.copies import with_drive_id
from drivelint.errors import DriveLintError, UsageError
from drivelint.formats import read_trace
from drivelint.road.map_reader import MapTables
from drivelint.sql import declarations, store

if TYPE_CHECKING:
    import pyarrow as pa

    from drivelint.result.request import RunRequest

DATABASE_FILE = "drivelint.duckdb"


def open_judged_drive_and_source_text(
    folder: Path,
    run_options: RunRequest,
    drive_id: str,
    ego_id: str,
    *,
    trace: Path | None,
    map_: Path | None,
    map_sha256: str | None = None,
) -> tuple[Drive, str]:
    """Return the drive that was judged, with one ego, and its source in words.

    `trace`, `map_`: the paths of log and map if they were moved. `map_sha256`: the hash of the map's content; None: not compared.
    Errors: `UsageError` if there is neither a kept database nor a log at its path, or if the log or the map has another content.
    """
    database = folder / DATABASE_FILE
    if trace is None and database.is_file():
        try:
            return _drive_from_database(database, drive_id, ego_id), f"the kept database {database.name}"
        except duckdb.Error as error:
            raise UsageError(
                f"{database}: {str(error).splitlines()[0]}: check the drives again with --keep-db"
            ) from error
    return _drive_and_source_text_from_log(run_options, drive_id, ego_id, trace=trace, map_=map_, map_sha256=map_sha256)


def _drive_and_source_text_from_log(
    run_options: RunRequest,
    drive_id: str,
    ego_id: str,
    *,
    trace: Path | None,
    map_: Path | None,
    map_sha256: str | None,
) -> tuple[Drive, str]:
    path = trace or Path(run_options.traces.get(drive_id, ""))
    if not path.exists() or not (trace or drive_id in run_options.traces):
        raise UsageError(
            f"the log of {drive_id} is no longer at {path}, and the result contains no database (check --keep-db): "
            "give its new path with --trace FILE"
        )
    drive = _read_drive(run_options, path, map_, drive_id, ego_id)
    if drive.environment and map_sha256 not in {None, *drive.environment.tables["environment"]["sha256"].to_pylist()}:
        name = drive.environment.tables["environment"]["name"][0].as_py()
        raise UsageError(
            f"map {name} has changed since {drive_id} was judged: give the old map with --map, or check the drives again"
        )
    return drive, f"the log {path.name}, read again"


def _read_drive(run_options: RunRequest, path: Path, map_: Path | None, drive_id: str, ego_id: str) -> Drive:
    map_path = map_ or run_options.map
    if map_path is not None and not map_path.exists():
        raise UsageError(f"the map {map_path} does not exist any more: give its new path with --map FILE")
    run_options = replace(
        run_options, ego=ego_id, map=map_path, map_dir=None if map_path is not None else run_options.map_dir
    )
    log = read_trace(path, run_options.ingest_options())
    if log.drive_id.rpartition("-")[2] != drive_id.rpartition("-")[2]:
        raise UsageError(
            f"{path} is the log {log.drive_id}, but {drive_id} was judged: give the right log with --trace"
        )
    if log.drive_id != drive_id:  # the same content under another name
        log = with_drive_id(log, drive_id)
    return drive_with_map(log, MapLibrary(run_options))


def with_ego(drive: Drive, ego_id: str) -> Drive:
    """Return the drive with this actor as its ego."""
    actors = drive.trace.tables["actor"]
    is_ego = [name == ego_id for name in actors["actor_id"].to_pylist()]
    tables = {**drive.trace.tables, "actor": replace_columns(actors, {"is_ego": is_ego})}
    return replace(drive, trace=replace(drive.trace, tables=tables))


def _drive_from_database(file: Path, drive_id: str, ego_id: str) -> Drive:
    with store.open_without_creating_tables(file, read_only=True) as con:
        tables = {name: _rows_with_key(con, name, "drive_id", drive_id) for name in TRACE_TABLES}
        if not tables["data_log"].num_rows:
            raise DriveLintError(f"{file}: does not contain the drive {drive_id}: check the drives again")
        place = tables["data_log"]["environment_id"][0].as_py()
        environment = None
        if place is not None:
            # nothing is derived from map_quality
            names = [name for name in declarations.column_comments("map") if name != "map_quality"]
            road = {name: _rows_with_key(con, name, "environment_id", place) for name in names}
            hand = road["environment"].to_pylist()[0]
            environment = MapTables(place, hand["handedness"], hand["handedness_source"], road)
    return with_ego(Drive(Trace(drive_id, file, tables, None, None, []), environment), ego_id)


def _rows_with_key(con: duckdb.DuckDBPyConnection, table: str, key: str, value: str) -> pa.Table:
    return con.execute(f"SELECT * FROM {table} WHERE {key} = ? ORDER BY ALL", [value]).to_arrow_table()
