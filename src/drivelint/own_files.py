"""Files that drivelint wrote itself, in a folder that is searched for logs: results of a check or of an audit are no logs."""

from __future__ import annotations

import json
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from pathlib import Path

MANIFEST: Final = "files.json"
"""The list of the files that drivelint wrote into a folder and below it."""
MANIFEST_KEY: Final = "written_by_drivelint"
"""The field of that list which has their names."""
RESULT_LOGS: Final = (
    *(
        f"{name}.parquet"
        for name in (
            "courses", "drives", "findings", "lanes", "margins", "opportunities", "overtakes", "pictures", "rules", "scenes",
            "spaces", "tracks", "verdicts",
        )
    ),
    "annotated/*.mcap",
)  # fmt: skip
"""Globs of the files of `check --out` that have a log's suffix. They hold where the list is missing, as in a copy of some files."""


class OwnFiles:
    """Tells what drivelint wrote in a folder and its subfolders, by the lists there."""

    def __init__(self, searched: Path) -> None:
        self._searched = searched
        self._written: dict[Path, tuple[frozenset[str], tuple[str, ...]]] = {}

    def __contains__(self, file: Path) -> bool:
        """Whether drivelint wrote a file below the searched folder. What lies above that folder does not count: who names the folder of
        annotated logs itself, means them.
        """
        for folder in file.parents:
            names, globs = self._of(folder)
            name = file.relative_to(folder).as_posix()
            if name in names or any(_matches(name, glob) for glob in globs):
                return True
            if folder == self._searched:
                return False
        return False

    def _of(self, folder: Path) -> tuple[frozenset[str], tuple[str, ...]]:
        """Return the names of the files that drivelint wrote into a folder, and globs of others."""
        if folder not in self._written:
            self._written[folder] = frozenset(written_files(folder)), RESULT_LOGS if _is_result(folder) else ()
        return self._written[folder]


def written_files(folder: Path) -> set[str]:
    """Return the names of the files that drivelint wrote into a folder, without their list; none where nothing says so."""
    try:
        return set(map(str, json.loads((folder / MANIFEST).read_text(encoding="utf-8"))[MANIFEST_KEY]))
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return set()  # whatever it is, it is not known to be drivelint's


def _matches(name: str, glob: str) -> bool:
    return name.count("/") == glob.count("/") and fnmatchcase(name, glob)


def _is_result(folder: Path) -> bool:
    return (folder / "summary.json").is_file() and (folder / "verdicts.parquet").is_file()
