"""Locates the logs and the map of a result, and checks by hash that they are the files that were judged."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from drivelint.errors import UsageError
from drivelint.formats.files import identify
from drivelint.pack.bag import sha256_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.pack.finding_sql import Row
    from drivelint.result.request import RunRequest


def judged_drives(drives: Sequence[Row]) -> list[Row]:
    """Return the drives of a result that were judged."""
    return [drive for drive in drives if drive["status"] == "judged"]


def request_with_present_paths(
    check_request: RunRequest, drives: Sequence[Row], log_paths: Sequence[Path], map_: Path | None
) -> RunRequest:
    """Return a request with the present paths of its logs and map, after comparing each with its hash.

    `log_paths`, `map_`: present paths of files that were moved. Errors: `UsageError` for a log or map that is missing or has another hash.
    """
    path_by_digest = {identify(path).sha256: path for path in log_paths if path.exists()}
    if absent := [path for path in log_paths if not path.exists()]:
        raise UsageError(f"--trace {absent[0]}: is not there")
    digests = {drive["sha256"] for drive in judged_drives(drives)}
    if strange := sorted(str(path) for digest, path in path_by_digest.items() if digest not in digests):
        raise UsageError(f"{strange[0]} is another log: no drive of this result has its hash")
    traces = {}
    for drive in judged_drives(drives):
        name, digest = drive["drive_id"], drive["sha256"]
        path = path_by_digest.get(digest) or Path(check_request.traces.get(name, ""))
        if not path.exists() or (digest not in path_by_digest and name not in check_request.traces):
            raise UsageError(f"the log of {name} is not at {path} any more: name its new path with --trace FILE")
        if digest not in path_by_digest and identify(path).sha256 != digest:
            raise UsageError(
                f"{path} is another log than the one that was judged ({name}): name the right one with --trace"
            )
        traces[name] = str(path)
    map_ = _present_map_path(check_request, drives, map_)
    return replace(check_request, traces=traces, map=map_, map_dir=check_request.map_dir if map_ is None else None)


def _present_map_path(check_request: RunRequest, drives: Sequence[Row], map_: Path | None) -> Path | None:
    path = map_ or check_request.map
    if path is None:
        if check_request.map_dir is not None and not check_request.map_dir.is_dir():
            raise UsageError(
                f"the folder of maps {check_request.map_dir} is not there any more: name the new path of a map with --map"
            )
        return None
    if not path.is_file():
        raise UsageError(f"the map {path} is not there any more: name its new path with --map FILE")
    digests = {drive["map_sha256"] for drive in judged_drives(drives)}
    if sha256_of(path) not in digests:
        raise UsageError(f"{path} is another map than the one used for judging: name the right one with --map")
    return path
