"""Writes files of a result atomically: temporary file in the same folder, fsync, rename."""

from __future__ import annotations

import os
import shutil
from hashlib import sha256
from typing import TYPE_CHECKING

from drivelint.errors import DriveLintError, ExitCode, UsageError

if TYPE_CHECKING:
    from pathlib import Path


class OutputError(DriveLintError):
    """A result could not be written; no incomplete file has its final name."""

    exit_code = ExitCode.TEMPFAIL


def ensure_writable_folder(out: Path) -> None:
    """Create the folder for results and check that files can be written there, before a long run begins.

    Errors: `UsageError` if `out` is a file; `OutputError`.
    """
    if out.exists() and not out.is_dir():
        raise UsageError(f"--out {out}: is a file: give a folder for the results")
    probe = out / f".drivelint.{os.getpid()}.tmp"
    try:
        out.mkdir(parents=True, exist_ok=True)
        probe.touch()
        probe.unlink()
    except OSError as error:
        raise _unwritable_error(out, error) from error


def publish(
    out: Path, contents: dict[str, bytes], finished_files: dict[str, Path | None], mark_file: str | None = None
) -> None:
    """Write files into the folder `out`; all files are complete on disk before the first is renamed to its final name.

    `contents`: name -> bytes; `finished_files`: name -> a finished file to move there, or None to remove an earlier run's file of that
    name. Files get their names in order, first `finished_files`, then `contents`. `mark_file`: the name of the file that marks the folder
    as complete; an earlier mark is removed before any other change. Errors: `OutputError` if the folder cannot be written (exit 75).
    """
    staged: list[tuple[Path, Path]] = []
    try:
        out.mkdir(parents=True, exist_ok=True)
        for name, source in finished_files.items():
            if source is not None:
                staged.append(_temporary_and_final_path(out / name))
                shutil.move(source, staged[-1][0])
        for name, content in contents.items():
            staged.append(_temporary_and_final_path(out / name))
            staged[-1][0].write_bytes(content)
        for temporary, _ in staged:
            _sync_to_disk(temporary)
        for name in [mark_file] if mark_file else []:
            (out / name).unlink(missing_ok=True)
            _sync_to_disk(out)
        for name in [name for name, source in finished_files.items() if source is None]:
            (out / name).unlink(missing_ok=True)
        for temporary, final in staged:
            temporary.replace(final)
        _sync_to_disk(out)
    except OSError as error:
        raise _unwritable_error(out, error) from error
    finally:
        for temporary, _ in staged:
            temporary.unlink(missing_ok=True)


def _temporary_and_final_path(final: Path) -> tuple[Path, Path]:
    """Return the temporary path in the folder of a file, and the file's final path."""
    final.parent.mkdir(exist_ok=True)
    # the final name may already have the greatest length, so the temporary name uses a digest
    digest = sha256(final.name.encode("utf-8", "surrogateescape")).hexdigest()
    return final.with_name(f".{digest[:16]}.{os.getpid()}.tmp"), final


def _unwritable_error(out: Path, error: OSError) -> OutputError:
    return OutputError(
        f"{out}: cannot write the results: {error.strerror or error}; free the disk or choose another --out"
    )


def _sync_to_disk(path: Path) -> None:
    """Write a file's content, or a folder's entries, to the disk (fsync)."""
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
