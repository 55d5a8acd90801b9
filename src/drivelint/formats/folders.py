"""Folders that are one drive: how each kind is recognised, and which of its files make up the drive."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

from drivelint.formats.mcap.bag_folder import METADATA_FILE, is_bag
from drivelint.formats.search import why_unreadable

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from pathlib import Path

CANONICAL_FILES = (
    "actor.parquet", "actor_state.parquet", "data_log.parquet", "declared_event.parquet", "drive_condition.parquet",
    "map.xodr", "quality.parquet", "signal_state.parquet",
)  # fmt: skip
"""The files of a canonical folder, in name order; all but `actor_state.parquet` may be missing."""


class FolderKind(NamedTuple):
    """A kind of folder that is one drive.

    `marks`: patterns of `Path.glob`; the folder has a file for each pattern. `files`: patterns of the files that are read, in the order in
    which they are hashed.
    """

    name: str
    marks: tuple[str, ...]
    files: tuple[str, ...]


FOLDER_KINDS: Final = (
    FolderKind("canonical", ("actor_state.parquet",), CANONICAL_FILES),
    FolderKind("bag", (METADATA_FILE,), (METADATA_FILE,)),  # its other files are those that the metadata lists
    FolderKind(
        "argoverse2-sensor",
        ("city_SE3_egovehicle.feather", "annotations*.feather"),
        ("annotations*.feather", "city_SE3_egovehicle.feather", "map/log_map_archive_*.json"),
    ),
    FolderKind("argoverse2-forecasting", ("scenario_*.parquet",), ("log_map_archive_*.json", "scenario_*.parquet")),
    FolderKind(
        "123d",
        ("ego_state_se3.arrow", "sync.arrow"),
        (
            "box_detections_se3.arrow",
            "ego_state_se3.arrow",
            "map.arrow",
            "sync.arrow",
            "traffic_light_detections.arrow",
        ),
    ),
)
"""The kinds in the order in which they are tried: a folder is of the first kind whose marks it has."""


def folder_kind(path: Path) -> str | None:
    """Return the kind of a folder that is one drive; None for any other folder."""
    for kind in FOLDER_KINDS:
        if all(_first_matching_file(path, mark) for mark in kind.marks) and (kind.name != "bag" or is_bag(path)):
            return kind.name
    return None


def is_canonical_folder(path: Path) -> bool:
    """Return whether `path` is a folder with one drive as canonical Parquet tables."""
    return folder_kind(path) == "canonical"


def is_drive_folder(path: Path) -> bool:
    """Return whether `path` is a folder that is one drive."""
    return folder_kind(path) is not None


def drive_folders(folders: Iterable[Path]) -> list[Path]:
    """Return the given folders that are one drive each."""
    return [folder for folder in folders if why_unreadable(folder) is None and is_drive_folder(folder)]


def drive_files(path: Path) -> list[Path]:
    """Return the files of a trace: the file itself, or the files of its folder. Errors: `TraceError` for a bag that cannot be read."""
    if not path.is_dir():
        return [path]
    kind = folder_kind(path)
    if kind == "bag":
        from drivelint.formats.mcap.bag import bag_files

        return [
            path / METADATA_FILE,
            *(path / file.name for file in bag_files(path) if (path / file.name).is_file()),
        ]
    patterns = next((entry.files for entry in FOLDER_KINDS if entry.name == kind), ())
    return [file for pattern in patterns for file in _matching_files(path, pattern)]


def _matching_files(path: Path, pattern: str) -> Iterator[Path]:
    """Return the files that match a pattern. Dead links are included: reading them fails."""
    files = sorted(path.glob(pattern)) if "*" in pattern else [path / pattern]
    return (file for file in files if file.is_file() or (file.is_symlink() and not file.exists()))


def _first_matching_file(path: Path, pattern: str) -> Path | None:
    return next(_matching_files(path, pattern), None)
