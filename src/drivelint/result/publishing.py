"""Files of a result appear whole or not at all: temporary file in the same folder, fsync, rename."""

from __future__ import annotations

import os
import shutil
from hashlib import sha256
from typing import TYPE_CHECKING

from drivelint.errors import DriveLintError, ExitCode, UsageError

if TYPE_CHECKING:
    from pathlib import Path


class OutputError(DriveLintError):
    """A result could not be written; nothing half-written is left under its final name."""

    exit_code = ExitCode.TEMPFAIL


def prepare_folder(out: Path) -> None:
    """Make the folder for results and make sure that files can be written there, before hours of work are done for it.

    Errors: `UsageError` where it is a file, `OutputError`.
    """
    if out.exists() and not out.is_dir():
        raise UsageError(f"--out {out}: is a file: give a folder for the results")
    probe = out / f".drivelint.{os.getpid()}.tmp"
    try:
        out.mkdir(parents=True, exist_ok=True)
        probe.touch()
        probe.unlink()
    except OSError as error:
        raise _unwritable(out, error) from error


def publish(
    out: Path, contents: dict[str, bytes], finished_files: dict[str, Path | None], mark: str | None = None
) -> None:
    """Write files into the folder `out`, all of them complete on disk before the first gets its name.

    `contents`: name -> bytes; `finished_files`: name -> a finished file that is taken over, or None: what an earlier run left under that
    name goes, because it is not of this run. Names are published in order, those of `finished_files` first. `mark`: the name of the file
    that shows that the folder is complete: the earlier one goes before anything else changes. Errors: `OutputError` when the folder
    cannot be written (exit 75).
    """
    staged: list[tuple[Path, Path]] = []
    try:
        out.mkdir(parents=True, exist_ok=True)
        for name, source in finished_files.items():
            if source is not None:
                staged.append(_temporary(out / name))
                shutil.move(source, staged[-1][0])
        for name, content in contents.items():
            staged.append(_temporary(out / name))
            staged[-1][0].write_bytes(content)
        for temporary, _ in staged:
            _sync(temporary)
        for name in [mark] if mark else []:
            (out / name).unlink(missing_ok=True)
            _sync(out)
        for name in [name for name, source in finished_files.items() if source is None]:
            (out / name).unlink(missing_ok=True)
        for temporary, final in staged:
            temporary.replace(final)
        _sync(out)
    except OSError as error:
        raise _unwritable(out, error) from error
    finally:
        for temporary, _ in staged:
            temporary.unlink(missing_ok=True)


def _temporary(final: Path) -> tuple[Path, Path]:
    """Return the name beside a file under which it is written, and its own."""
    final.parent.mkdir(exist_ok=True)
    # its own name may be as long as names can be
    digest = sha256(final.name.encode("utf-8", "surrogateescape")).hexdigest()
    return final.with_name(f".{digest[:16]}.{os.getpid()}.tmp"), final


def _unwritable(out: Path, error: OSError) -> OutputError:
    return OutputError(
        f"{out}: cannot write the results: {error.strerror or error}; free the disk or choose another --out"
    )


def _sync(path: Path) -> None:
    """Force a file's content, or a folder's names, to the disk."""
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
