"""Computes the state of files and folders that a run reads. If the state is the same, the input is the same.

The content of every file is hashed, because different contents can have the same size and modification time.
"""

from __future__ import annotations

import json
import os
from dataclasses import dataclass, field
from glob import glob
from hashlib import file_digest, sha256
from pathlib import Path
from stat import S_ISDIR, S_ISREG
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    IsOutput = Callable[[str], bool]
    """Returns whether an absolute path without links is an output of the run."""

ABSENT_PATH_STATE: Final = "absent"


def file_sha256(path: Path | str) -> str:
    """Return the hash of a file's bytes. Errors: `OSError`."""
    with Path(path).open("rb") as file:
        return file_digest(file, "sha256").hexdigest()


def path_state_if_known(path: str, is_output: IsOutput) -> str | None:
    """Return a state that stays the same while nothing changes at a path; None: the state cannot be known, as for a pipe.

    The state of a file is its content, the state of a folder the names in it; both include the targets of links.
    """
    try:
        mode = os.stat(path).st_mode  # noqa: PTH116 - thousands of paths
        real = os.path.realpath(path)
        if S_ISREG(mode):
            return f"file {file_sha256(path)} {real}"
        return f"folder {_hash_of_listing(path, real, is_output)} {real}" if S_ISDIR(mode) else None
    except (FileNotFoundError, NotADirectoryError):
        return ABSENT_PATH_STATE
    except (OSError, ValueError):
        return None


def hash_of_matching_file_names(pattern: str, is_output: IsOutput) -> str:
    """Return the hash of the file names that a glob pattern matches."""
    names = glob(pattern, recursive=True)  # noqa: PTH207 - same function as the search for logs
    return _hash(sorted(name for name in names if not is_output(os.path.realpath(name))))


@dataclass(frozen=True)
class RunInputs:
    """The inputs of a run. `states`: absolute path -> state. `globs`: pattern -> hash of the names that matched."""

    states: dict[str, str] = field(default_factory=dict)
    globs: dict[str, str] = field(default_factory=dict)

    def are_unchanged(self, is_output: IsOutput) -> bool:
        """Return whether all inputs have the same state as before."""
        names = all(hash_of_matching_file_names(pattern, is_output) == stored for pattern, stored in self.globs.items())
        return names and all(path_state_if_known(path, is_output) == stored for path, stored in self.states.items())


def _hash_of_listing(folder: str, real_folder: str, is_output: IsOutput) -> str:
    with os.scandir(folder) as entries:
        inputs = [entry for entry in entries if not is_output(os.path.join(real_folder, entry.name))]  # noqa: PTH118
    facts = [(entry.name, *_kind_and_link_target(entry)) for entry in sorted(inputs, key=lambda entry: entry.name)]
    return _hash(facts)


def _kind_and_link_target(entry: os.DirEntry[str]) -> tuple[str, str]:
    """Return the kind of a folder's entry, and the target if it is a link."""
    kind = "folder" if entry.is_dir() else "file" if entry.is_file() else "other"
    return kind, os.readlink(entry.path) if entry.is_symlink() else ""  # noqa: PTH115


def _hash(names: Iterable[object]) -> str:
    return sha256(json.dumps(list(names)).encode()).hexdigest()
