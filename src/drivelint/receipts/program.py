"""Hashes everything that determines a result besides its inputs: the program, Python's version and search path, the kind of machine, the
installed packages, the request, and the working folder."""

from __future__ import annotations

import json
import os
import platform
import sys
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING, Final

from drivelint.resources import folder

if TYPE_CHECKING:
    from collections.abc import Mapping

ENVIRONMENT_VARIABLES: Final = (
    *("COLUMNS", "LINES", "TERM", "COLORTERM", "NO_COLOR", "FORCE_COLOR", "TTY_COMPATIBLE", "TTY_INTERACTIVE"),
    *("JUPYTER_COLUMNS", "JUPYTER_LINES", "UNICODE_VERSION", "TZ", "LANG", "LC_ALL", "LC_CTYPE"),
    *("PROJ_DATA", "PROJ_LIB", "PROJ_NETWORK", "PYARROW_IGNORE_TIMEZONE", "PYDANTIC_DISABLE_PLUGINS"),
    *(
        "PROTOCOL_BUFFERS_PYTHON_IMPLEMENTATION",
        "TEMPORARILY_DISABLE_PROTOBUF_VERSION_CHECK",
        "PYTHON_ZSTANDARD_IMPORT_POLICY",
    ),
)
"""The environment variables that can affect a result or its presentation."""


def program_folders() -> tuple[Path, ...]:
    """Return the folders of drivelint's own files: code, queries and schemas."""
    return Path(__file__).parents[1], folder("queries"), folder("schemas")


@cache
def program_sha256() -> str:
    """Return the hash of all files of the program, of Python's version, and of the names and versions of installed packages.

    Developers change drivelint without changing its version.
    """
    whole = sha256()
    for root in program_folders():
        for place, folders, names in os.walk(root):
            folders[:] = sorted(name for name in folders if name != "__pycache__")
            for name in sorted(names):
                path = os.path.join(place, name)  # noqa: PTH118 - faster for a thousand files
                with open(path, "rb", buffering=0) as file:  # noqa: PTH123
                    content = file.read()
                whole.update(f"{os.path.relpath(path, root)} {len(content)}\0".encode("utf-8", "surrogateescape"))
                whole.update(content)
    machine = [sys.version, sys.platform, platform.machine(), sys.path, _package_metadata_folders()]
    whole.update(json.dumps(machine).encode())
    return whole.hexdigest()


def _package_metadata_folders() -> list[str]:
    """Return the names of the metadata folders of installed packages, which contain name and version."""
    folders: list[str] = []
    for place in sys.path:
        try:
            folders += [name for name in os.listdir(place or ".") if name.endswith((".dist-info", ".egg-info"))]  # noqa: PTH208
        except OSError:
            continue
    return sorted(folders)


def receipt_key(arguments: Mapping[str, object]) -> str:
    """Return the hash of the program and of the request: the options, the working folder, the terminal, and the environment variables."""
    document = {
        "arguments": arguments,
        "folder": os.getcwd(),  # noqa: PTH109 - relative paths start there
        "stdout": [sys.stdout.encoding, sys.stdout.isatty(), _terminal_size()],
        "names": sys.getfilesystemencoding(),
        "environment": {name: os.environ.get(name) for name in ENVIRONMENT_VARIABLES},
    }
    return sha256(f"{program_sha256()} {json.dumps(document, sort_keys=True, default=str)}".encode()).hexdigest()


def _terminal_size() -> tuple[int, int] | None:
    """Return the columns and lines of the terminal; None if stdout is not a terminal."""
    if not sys.stdout.isatty():
        return None
    for stream in (0, 1, 2):
        try:
            return tuple(os.get_terminal_size(stream))  # type: ignore[return-value]
        except OSError:
            continue
    return None
