"""This module finds the traces that a command line names, and identifies each by the hash of its content."""

from __future__ import annotations

import errno
import hashlib
import os
import re
from glob import glob
from pathlib import Path, PurePath
from typing import TYPE_CHECKING

from drivelint.drive.trace import Identity
from drivelint.drivelint_files import DrivelintFiles
from drivelint.errors import TraceError, UsageError
from drivelint.formats.folders import drive_files, drive_folders, is_drive_folder
from drivelint.formats.search import folder_tree, is_pipe_or_device, why_unreadable
from drivelint.phrases import escape_invisible, path_hint

if TYPE_CHECKING:
    from collections.abc import Sequence

TRACE_SUFFIXES = frozenset({".mcap", ".db3", ".parquet", ".csv", ".osi", ".pkl"})
"""The suffixes of traces for which a folder is searched. XML files are opened instead, because maps and routes are XML, too.

A pickle can contain anything: it counts only if its name is one that ScenarioNet gives to scenarios.
"""
MAP_SUFFIXES = frozenset({".xodr", ".osm"})
"""Suffixes of maps that no log format uses."""
_SEARCHED_SUFFIXES = TRACE_SUFFIXES | {".xml"}
_HEAD_BYTES = 4096
SCENARIO_INDEX_FILES = frozenset({"dataset_summary.pkl", "dataset_mapping.pkl"})
"""Index files that ScenarioNet writes beside its scenarios."""


def expand_traces(traces: Sequence[str], *, map_path: Path | None = None) -> list[Path]:
    """Return the traces that files, globs and folders name, sorted, each file once.

    A path that exists is taken literally, even if its name contains `[`, `*` or `?`. A folder that is one drive (`folders.FOLDER_KINDS`:
    canonical tables, rosbag2, Argoverse 2, 123D) is returned itself. Any other folder is searched, with its subfolders, for drive
    folders, for files of MCAP, Parquet, CSV, OSI, ScenarioNet and SUMO's FCD, and for CommonRoad scenarios with obstacles. Files that an
    earlier check or audit wrote there are left out. Unreadable subfolders, links to folders elsewhere and dead links are returned, too:
    `read_trace` reports why they cannot be judged.
    `map_path`: the map, which a glob may also find. It is left out if its suffix is in `MAP_SUFFIXES` and there are other traces.
    A CommonRoad scenario is both log and map, and is kept.
    Errors: `UsageError` for a URI or an empty name, `TraceError` for a name that matches nothing.
    """
    trace_by_key: dict[Path, Path] = {}
    for text in traces:
        for path in _traces_of_name(text):
            trace_by_key.setdefault(path.resolve(), path)
    if map_path is not None and map_path.suffix.lower() in MAP_SUFFIXES and len(trace_by_key) > 1:
        trace_by_key.pop(map_path.resolve(), None)
    if not SCENARIO_INDEX_FILES.issuperset(path.name for path in trace_by_key.values()):
        trace_by_key = {key: path for key, path in trace_by_key.items() if path.name not in SCENARIO_INDEX_FILES}
    return [trace_by_key[key] for key in sorted(trace_by_key, key=str)]


def maps_beside_traces(traces: Sequence[str]) -> list[Path]:
    """Return the files in the folders of traces that are maps by their names (OpenDRIVE, Lanelet2, SUMO networks), sorted."""
    folders = {path if path.is_dir() else path.parent for path in map(Path, traces) if _exists(path)}
    files = {file for folder in folders if why_unreadable(folder) is None for file in folder.iterdir()}
    return sorted(
        file for file in files if file.suffix.lower() in MAP_SUFFIXES or file.name.lower().endswith(".net.xml")
    )


def _traces_of_name(text: str) -> list[Path]:
    if not text.strip():
        raise UsageError("an empty trace name was given: give a file, a glob or a folder")
    path = Path(text)
    if _exists(path):
        return _traces_in_path(path)
    if re.match(r"[A-Za-z][A-Za-z0-9+.-]+://", text):
        raise UsageError(f"{text}: URIs are not supported: copy the log to this machine and give the path of the file")
    matches = [Path(match) for match in sorted(glob(text, recursive=True))]  # noqa: PTH207 (Path.glob refuses absolute patterns)
    if not matches:
        if re.search(r"[*?\[]", text):
            raise TraceError(f"{text}: no file matches this pattern: check the path")
        raise TraceError(f"{text}: no such file or folder: {path_hint(path) or 'check the path'}")
    return [file for match in matches for file in _traces_in_path(match)]


def _exists(path: Path) -> bool:
    try:
        return path.exists()
    except (OSError, ValueError):  # a pattern may be too long for a file name
        return False


def _traces_in_path(path: Path) -> list[Path]:
    """Return the logs of a folder, and the paths in it that may contain logs but cannot be searched. Reading such a path reports why."""
    if not path.is_dir() or why_unreadable(path) is not None or is_drive_folder(path):
        return [path]
    content = folder_tree(path, _SEARCHED_SUFFIXES)
    drives = drive_folders([*content.folders, *content.links])
    inside, own_files = frozenset(drives), DrivelintFiles(path)
    files = [
        file
        for file in content.files
        if file.suffix.lower() in _SEARCHED_SUFFIXES
        and inside.isdisjoint(file.parents)
        and file not in own_files
        and (is_log_name(file.name) or (file.suffix.lower() == ".xml" and _is_xml_log(file)))
    ]
    missed = [place for place in (*content.links, *content.unreadable) if inside.isdisjoint((place, *place.parents))]
    if not (drives or files or missed):
        raise TraceError(
            f"{path}: no trace in this folder (looked for {', '.join(sorted(TRACE_SUFFIXES))}, SUMO and CommonRoad .xml): check the path"
        )
    return drives + files + missed


def is_log_name(name: str) -> bool:
    """Return whether a file or URL has a suffix of traces; a pickle must have a name that ScenarioNet gives to scenarios."""
    file = PurePath(name)
    if file.suffix.lower() == ".pkl":
        return file.name.startswith("sd_") or file.stem.isdecimal()
    return file.suffix.lower() in TRACE_SUFFIXES


def _is_xml_log(file: Path) -> bool:
    """Return whether an XML file is a log. A file that cannot be opened counts as a log, so that reading it reports why."""
    from drivelint.formats.commonroad.scenario import has_obstacles
    from drivelint.formats.sumo.fcd import is_fcd

    try:
        with file.open("rb") as content:
            head = content.read(_HEAD_BYTES)
        return is_fcd(file, head) or has_obstacles(file, head)
    except OSError:
        return True


def is_utf8(path: str) -> bool:
    """Return whether a path is valid UTF-8: the operating system allows any bytes in a name."""
    return not re.search("[\ud800-\udfff]", path)


def file_names_sizes_and_change_times(path: Path) -> list[tuple[str, int, int]]:
    """Return name, size and time of the last change of each file of a trace. Errors: `TraceError`."""
    try:
        return [
            (file.name, status.st_size, status.st_mtime_ns) for file in drive_files(path) for status in [file.stat()]
        ]
    except OSError as error:
        raise _unreadable_error(path, error) from error


def _unreadable_error(path: Path, error: OSError) -> TraceError:
    file = Path(error.filename or path)
    return TraceError(f"{file}: {why_unreadable(file) or f'cannot be read: {error.strerror or error}'}")


def identify(path: Path) -> Identity:
    """Return the identity of a trace: the hash of its file, or of the names and hashes of its folder's files in the order of `drive_files`.

    Errors: `TraceError` if it cannot be read.
    """
    if (why := why_unreadable(path)) is not None:
        raise TraceError(f"{path}: {why}")
    try:
        if path.is_dir():
            folder = hashlib.sha256()
            for file in drive_files(path):
                folder.update(f"{file.name}\0{_sha256(file)}\n".encode())
            digest = folder.hexdigest()
        else:
            digest = _sha256(path)
    except OSError as error:
        raise _unreadable_error(path, error) from error
    whole = os.path.abspath(path)  # noqa: PTH100 (resolve would name the target of a link)
    if not is_utf8(whole):
        raise TraceError(f"{escape_invisible(whole)}: its name is not UTF-8, which the result files require: rename it")
    name = Path(whole).name
    stem = name if path.is_dir() else Path(name).stem
    return Identity(f"{stem}-{digest[:8]}", name, digest)


def _sha256(path: Path) -> str:
    if is_pipe_or_device(path):
        raise OSError(errno.EINVAL, "it is a pipe or a device", str(path))
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
