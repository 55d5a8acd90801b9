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
from drivelint.errors import TraceError, UsageError
from drivelint.formats.folders import drive_files, drive_folders, is_drive_folder
from drivelint.formats.search import is_pipe_or_device, tree, why_not_here
from drivelint.own_files import OwnFiles
from drivelint.phrases import escape_invisible

if TYPE_CHECKING:
    from collections.abc import Sequence

TRACE_SUFFIXES = frozenset({".mcap", ".parquet", ".csv", ".osi", ".pkl"})
"""What a folder of traces is searched for, besides XML that is a log of SUMO or CommonRoad: maps and routes lie there as XML too.

Of pickles, which may hold anything, only those count that are called as ScenarioNet calls its scenarios.
"""
MAP_SUFFIXES = frozenset({".xodr", ".osm"})
"""Endings that maps have, and no format of logs."""
_SEARCHED_SUFFIXES = TRACE_SUFFIXES | {".xml"}
_HEAD_BYTES = 4096
SCENARIO_LISTS = frozenset({"dataset_summary.pkl", "dataset_mapping.pkl"})
"""Files that ScenarioNet writes beside its scenarios, which are no scenarios."""


def expand_traces(traces: Sequence[str], *, but: Path | None = None) -> list[Path]:
    """Return the traces that files, globs and folders name, sorted, each file once.

    A path that exists is always taken literally, `[`, `*` and `?` in its name included. A folder that is one drive (`folders.KINDS`:
    canonical tables, rosbag2, Argoverse 2, 123D) is taken as it is; any other is searched, with subfolders, for such folders and MCAP,
    Parquet, CSV, OSI, ScenarioNet, SUMO's FCD files and scenarios of CommonRoad with obstacles, except for what an earlier check or
    audit wrote there. Subfolders that cannot be read, links to folders elsewhere and dead links are among what is returned: `read_trace`
    says why they cannot be judged.
    `but`: the map, which a glob finds beside the logs: left out if anything else is there, and if its suffix says that it is no log. A
    scenario of CommonRoad is both, and stays.
    Errors: `UsageError` for a URI or an empty name, `TraceError` for something that matches nothing.
    """
    trace_by_key: dict[Path, Path] = {}
    for text in traces:
        for path in _matches(text):
            trace_by_key.setdefault(path.resolve(), path)
    if but is not None and but.suffix.lower() in MAP_SUFFIXES and len(trace_by_key) > 1:
        trace_by_key.pop(but.resolve(), None)
    if not SCENARIO_LISTS.issuperset(path.name for path in trace_by_key.values()):
        trace_by_key = {key: path for key, path in trace_by_key.items() if path.name not in SCENARIO_LISTS}
    return [trace_by_key[key] for key in sorted(trace_by_key, key=str)]


def _matches(text: str) -> list[Path]:
    if not text.strip():
        raise UsageError("an empty trace name was given: name a file, a glob or a folder")
    path = Path(text)
    if _exists(path):
        return _inside(path)
    if re.match(r"[A-Za-z][A-Za-z0-9+.-]+://", text):
        raise UsageError(f"{text}: URIs cannot be read yet: copy the log to this machine and name the file")
    matches = [Path(match) for match in sorted(glob(text, recursive=True))]  # noqa: PTH207 (Path.glob refuses absolute patterns)
    if not matches:
        what = "no file matches this pattern" if re.search(r"[*?\[]", text) else "no such file or folder"
        raise TraceError(f"{text}: {what}: check the path")
    return [file for match in matches for file in _inside(match)]


def _exists(path: Path) -> bool:
    try:
        return path.exists()
    except (OSError, ValueError):  # a pattern can be longer than a file name may be
        return False


def _inside(path: Path) -> list[Path]:
    """Return the logs of a folder, and the paths that may contain logs but cannot be searched; reading those refuses with the reason."""
    if not path.is_dir() or why_not_here(path) is not None or is_drive_folder(path):
        return [path]
    content = tree(path, _SEARCHED_SUFFIXES)
    drives = drive_folders([*content.folders, *content.links])
    inside, own = frozenset(drives), OwnFiles(path)
    files = [
        file
        for file in content.files
        if file.suffix.lower() in _SEARCHED_SUFFIXES
        and inside.isdisjoint(file.parents)
        and file not in own
        and (is_log_name(file.name) or (file.suffix.lower() == ".xml" and _is_xml_log(file)))
    ]
    missed = [each for each in (*content.links, *content.unreadable) if inside.isdisjoint((each, *each.parents))]
    if not (drives or files or missed):
        raise TraceError(
            f"{path}: no trace in this folder (looked for {', '.join(sorted(TRACE_SUFFIXES))}, SUMO and CommonRoad .xml): check the path"
        )
    return drives + files + missed


def is_log_name(name: str) -> bool:
    """Whether a file or URL is called as logs are: by its suffix, and a pickle as ScenarioNet calls its scenarios."""
    file = PurePath(name)
    if file.suffix.lower() == ".pkl":
        return file.name.startswith("sd_") or file.stem.isdecimal()
    return file.suffix.lower() in TRACE_SUFFIXES


def _is_xml_log(file: Path) -> bool:
    """Say whether a file is a log; one that cannot be opened may be, and is refused by its reader."""
    from drivelint.formats.commonroad.scenario import has_obstacles
    from drivelint.formats.sumo.fcd import is_fcd

    try:
        with file.open("rb") as opened:
            head = opened.read(_HEAD_BYTES)
        return is_fcd(file, head) or has_obstacles(file, head)
    except OSError:
        return True


def is_utf8(path: str) -> bool:
    """Whether a path can be written as text: the system takes any bytes for a name."""
    return not re.search("[\ud800-\udfff]", path)


def file_states(path: Path) -> list[tuple[str, int, int]]:
    """Return name, size and time of the last change of each file of a trace. Errors: `TraceError`."""
    try:
        return [(file.name, found.st_size, found.st_mtime_ns) for file in drive_files(path) for found in [file.stat()]]
    except OSError as error:
        raise _unreadable(path, error) from error


def _unreadable(path: Path, error: OSError) -> TraceError:
    file = Path(error.filename or path)
    return TraceError(f"{file}: {why_not_here(file) or f'cannot be read: {error.strerror or error}'}")


def identify(path: Path) -> Identity:
    """Hash a trace: a file's bytes, or a folder's tables in name order or parts in order, each with its name.

    Errors: `TraceError` when it cannot be read.
    """
    if (why := why_not_here(path)) is not None:
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
        raise _unreadable(path, error) from error
    whole = os.path.abspath(path)  # noqa: PTH100 (resolve would name the target of a link)
    if not is_utf8(whole):
        raise TraceError(f"{escape_invisible(whole)}: its name is not UTF-8, which results need: rename it")
    name = Path(whole).name
    stem = name if path.is_dir() else Path(name).stem
    return Identity(f"{stem}-{digest[:8]}", name, digest)


def _sha256(path: Path) -> str:
    if is_pipe_or_device(path):
        raise OSError(errno.EINVAL, "it is a pipe or a device", str(path))
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
