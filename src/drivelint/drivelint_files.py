"""Recognises files that drivelint wrote itself, such as the results of a check or an audit: a search for logs leaves them out."""

from __future__ import annotations

import json
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from pathlib import Path

MANIFEST: Final = "files.json"
"""The list of the files that drivelint wrote into a folder and below it."""
MANIFEST_FILES_KEY: Final = "written_by_drivelint"
"""The field of `MANIFEST` that contains the file names."""
RESULT_GLOBS_WITH_LOG_SUFFIX: Final = (
    *(
        f"{name}.parquet"
        for name in (
            "courses", "drives", "findings", "lanes", "margins", "opportunities", "overtakes", "pictures", "rules", "scenes",
            "spaces", "tracks", "verdicts",
        )
    ),
    "annotated/*.mcap",
)  # fmt: skip
"""Globs of the files of `check --out` that have a log's suffix. They apply even if the list is missing, as in a copy of some files."""
AUDIT_GLOBS_WITH_LOG_SUFFIX: Final = ("rules.parquet", "batches/*/*.parquet", "tables/*/*.parquet")
"""Globs of the files of `audit --out` that have a log's suffix. They apply even if the audit has not ended, and so has no list."""


class DrivelintFiles:
    """The files that drivelint wrote into a folder and its subfolders, according to the lists there."""

    def __init__(self, searched_folder: Path) -> None:
        self._searched = searched_folder
        self._written: dict[Path, tuple[frozenset[str], tuple[str, ...]]] = {}

    def __contains__(self, file: Path) -> bool:
        """Return whether drivelint wrote a file below the searched folder.

        Lists above this folder are ignored: a user who names the folder of annotated logs wants to read these logs.
        """
        for folder in file.parents:
            names, globs = self._names_and_globs(folder)
            name = file.relative_to(folder).as_posix()
            if name in names or any(_matches(name, glob) for glob in globs):
                return True
            if folder == self._searched:
                return False
        return False

    def _names_and_globs(self, folder: Path) -> tuple[frozenset[str], tuple[str, ...]]:
        """Return the names of the files that drivelint wrote into a folder, and globs for further files."""
        if folder not in self._written:
            names = frozenset(written_files(folder))
            globs = (
                RESULT_GLOBS_WITH_LOG_SUFFIX
                if _is_result_folder(folder)
                else AUDIT_GLOBS_WITH_LOG_SUFFIX
                if _is_audit_folder(folder) and not names
                else ()
            )
            self._written[folder] = names, globs
        return self._written[folder]


def written_files(folder: Path) -> set[str]:
    """Return the names of the files that drivelint wrote into a folder, except the list itself; empty without a valid list."""
    try:
        return set(map(str, json.loads((folder / MANIFEST).read_text(encoding="utf-8"))[MANIFEST_FILES_KEY]))
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return set()  # there is no list, or another program wrote it


def _matches(name: str, glob: str) -> bool:
    return name.count("/") == glob.count("/") and fnmatchcase(name, glob)


def _is_result_folder(folder: Path) -> bool:
    return (folder / "summary.json").is_file() and (folder / "verdicts.parquet").is_file()


def _is_audit_folder(folder: Path) -> bool:
    return (folder / "audit.json").is_file() and (folder / "rules.parquet").is_file()
