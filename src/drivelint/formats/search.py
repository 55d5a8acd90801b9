"""Searches a folder for logs, and lists the paths that could not be searched: logs in them are not judged.

A link to a folder is not followed, as it may form a cycle or leave the folder; it is listed if its target lies outside the folder. A dead
link (git-annex has one for a file that is not fetched) or a DVC pointer without its target means that a log or a folder is missing.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Final, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Collection
    from pathlib import Path

_POINTER_SUFFIX: Final = ".dvc"
"""The suffix that DVC appends to the name of a log or a folder, for the small file that it keeps in place of it."""


class FolderTree(NamedTuple):
    """The content of a folder at any depth, in order of names: folders, files, links to folders elsewhere, and unreadable paths."""

    folders: list[Path]
    files: list[Path]
    links: list[Path]
    unreadable: list[Path]


def folder_tree(root: Path, missing_file_suffixes: Collection[str]) -> FolderTree:
    """Return what is below a folder. A missing file is listed only if it has one of `missing_file_suffixes`, or none, as a folder has."""
    content = FolderTree([], [], [], [])
    waiting = [root]
    inside = root.resolve()
    while waiting:
        folder = waiting.pop()
        try:
            with os.scandir(folder) as entries:
                names = sorted(entries, key=lambda entry: entry.name)
        except OSError:
            content.unreadable.append(folder)
            continue
        below = []
        for entry in names:
            path = folder / entry.name
            if entry.is_dir(follow_symlinks=False):
                below.append(path)
            elif entry.is_symlink() and path.is_dir():
                if not path.resolve().is_relative_to(inside):
                    content.links.append(path)
            elif path.is_file():
                content.files.append(path)
                if _is_lone_dvc_pointer(path) and _may_be_log(path.with_suffix(""), missing_file_suffixes):
                    content.unreadable.append(path)
            elif entry.is_symlink() and not path.exists() and _may_be_log(path, missing_file_suffixes):
                content.unreadable.append(path)
        content.folders.extend(below)
        waiting += reversed(below)
    return content


def why_unreadable(path: Path) -> str | None:
    """Return why a path that may be a log cannot be read, and the remedy; None if it can be read or does not exist."""
    if os.path.islink(path) and not path.exists():  # noqa: PTH114 - no error for an invalid name, as in a damaged bag
        return f"a dead link to {path.readlink()}: the target is missing: fetch or mount it (git annex get, dvc pull)"
    if _is_lone_dvc_pointer(path) and path.is_file():
        return "a pointer of DVC without its file: fetch the file with dvc pull"
    if is_pipe_or_device(path):
        return "a pipe or a device, but a log is read more than once: write its output to a file, and give that file"
    if not os.path.isdir(path):  # noqa: PTH112 - as above
        return None
    try:
        with os.scandir(path):
            return None
    except OSError as error:
        return f"a folder that cannot be searched ({error.strerror or error}): it is not known whether it has logs: make it readable"


def is_pipe_or_device(path: Path | str) -> bool:
    """Return whether a path exists but is neither a file nor a folder: reading it may block or never end."""
    return os.path.exists(path) and not os.path.isfile(path) and not os.path.isdir(path)  # noqa: PTH110, PTH112, PTH113 - no error for long names


def why_link_not_followed(path: Path) -> str | None:
    """Return why a folder that is not a drive was not searched, and the remedy; None if it is not a link."""
    if not path.is_symlink():
        return None
    return f"a link to the folder {path.readlink()}, which the search does not follow: give that folder, too"


def _is_lone_dvc_pointer(path: Path) -> bool:
    return path.suffix == _POINTER_SUFFIX and path.name != _POINTER_SUFFIX and not path.with_suffix("").exists()


def _may_be_log(path: Path, suffixes: Collection[str]) -> bool:
    return path.suffix.lower() in suffixes or (not path.suffix and not path.name.startswith("."))
