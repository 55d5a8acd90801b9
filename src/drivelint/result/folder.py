"""The folder that `check --out` writes; a later run replaces the whole result. Files that drivelint did not write are not changed.

`files.json` lists the files that drivelint wrote, with the sha256 of the tables and the summary. A run works in its own subfolder. An
earlier result must not be taken for the result of a failed run. So its reports are removed when a run begins, and its other files move to
`earlier/` if the run fails.
"""

from __future__ import annotations

import json
import os
import shutil
from contextlib import contextmanager, suppress
from hashlib import file_digest, sha256
from typing import TYPE_CHECKING, Final

from drivelint.drivelint_files import MANIFEST_FILES_KEY, written_files
from drivelint.errors import UsageError
from drivelint.phrases import name_list
from drivelint.result.names import MANIFEST
from drivelint.result.publishing import OutputError, ensure_writable_folder, publish

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence
    from pathlib import Path

_HASHES_KEY: Final = "sha256"
_WORK_FOLDER_PREFIX: Final = ".drivelint.work"
EARLIER_RESULT_FOLDER: Final = "earlier"
"""The subfolder for an earlier result after a run that ended without a result. The next result replaces the earlier one."""


@contextmanager
def working_folder(
    out: Path, patterns: Sequence[str], report_names: Sequence[str], mark_file: str, *, overwrite: bool = False
) -> Iterator[Path]:
    """Create the folder `out` and yield an empty subfolder for the files of a run; the subfolder is removed at the end.

    `patterns`: globs of the file names of a result; `report_names`: names of the reports, which can be made again from the tables and
    which a build server shows; `mark_file`: as in `replace_result`. Errors: `UsageError` if `out` is a file, or, without `overwrite`, has
    files that match `patterns` but were not written by drivelint; `OutputError`.
    """
    ensure_writable_folder(out)
    present = _matching_files(out, patterns)
    foreign = sorted(present - written_files(out) - {MANIFEST})
    if foreign and not overwrite:
        raise UsageError(
            f"--out {out}: has {name_list(foreign, 3)}, which drivelint did not write there ({MANIFEST} does not list it): "
            "choose another folder, or replace it with --overwrite"
        )
    with _lock_folder(out) as is_ours:
        for left in out.glob(f"{_WORK_FOLDER_PREFIX}.*") if is_ours else ():
            shutil.rmtree(left, ignore_errors=True)  # left by a killed run
        work, before, is_done = (
            out / f"{_WORK_FOLDER_PREFIX}.{os.getpid()}",
            _inode_and_mtime_ns(out / mark_file),
            False,
        )
        try:
            work.mkdir()
            _remove_files(
                out, sorted(_replaceable_files(out, patterns, overwrite=overwrite).intersection(report_names))
            )
            yield work
            is_done = True
        finally:
            shutil.rmtree(work, ignore_errors=True)
            if not is_done and before is not None and _inode_and_mtime_ns(out / mark_file) == before:
                _move_earlier_result_aside(out, patterns, mark_file, overwrite=overwrite)


def _move_earlier_result_aside(out: Path, patterns: Sequence[str], mark_file: str, *, overwrite: bool) -> None:
    """Move an earlier result into the subfolder `EARLIER_RESULT_FOLDER`. The mark moves first: without it, `out` has no result."""
    earlier = out / EARLIER_RESULT_FOLDER
    with suppress(OutputError):  # files that remain are replaced below; this error must not hide why the run ended
        _remove_files(earlier, sorted(_replaceable_files(earlier, patterns, overwrite=False)))
    names = _replaceable_files(out, patterns, overwrite=overwrite)
    try:
        for name in (mark_file, *sorted(names - {mark_file}), MANIFEST):
            if (out / name).exists():
                (earlier / name).parent.mkdir(parents=True, exist_ok=True)
                (out / name).replace(earlier / name)
    except OSError:
        _remove_files(out, [mark_file])  # without the mark, the files that cannot be moved are no result
    _remove_empty_subfolders(out, names)


def _remove_files(out: Path, names: Sequence[str]) -> None:
    """Remove these files of a folder, and the subfolders that are empty afterwards. Errors: `OutputError`."""
    try:
        for name in names:
            (out / name).unlink(missing_ok=True)
    except OSError as error:
        raise OutputError(f"{out}: an earlier result cannot be removed: {error.strerror or error}") from error
    _remove_empty_subfolders(out, names)


def _remove_empty_subfolders(out: Path, names: Iterable[str]) -> None:
    for folder in {(out / name).parent for name in names} - {out}:
        with suppress(OSError):  # another program's file is there
            folder.rmdir()


def _inode_and_mtime_ns(path: Path) -> tuple[int, int] | None:
    """Return inode and modification time, which distinguish a file from its replacement; None without a file."""
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_ino, status.st_mtime_ns


@contextmanager
def _lock_folder(out: Path) -> Iterator[bool]:
    """Lock a folder for this process; yield whether the lock was obtained: not every file system has locks.

    The operating system releases a lock when the process ends. A file with a process id is no substitute: every container has a process 1.
    Errors: `UsageError` if another process has locked the folder.
    """
    try:
        import fcntl

        place = os.open(out, os.O_RDONLY)
    except (ImportError, OSError):  # Windows; a folder that cannot be listed
        yield False
        return
    try:
        try:
            fcntl.flock(place, fcntl.LOCK_EX | fcntl.LOCK_NB)
            is_ours = True
        except BlockingIOError:
            raise UsageError(
                f"--out {out}: another check is writing there: wait for its end, or choose another folder"
            ) from None
        except OSError:
            is_ours = False
        yield is_ours
    finally:
        os.close(place)


def replace_result(
    out: Path,
    contents: dict[str, bytes],
    finished_files: dict[str, Path],
    mark_file: str,
    patterns: Sequence[str],
    *,
    overwrite: bool,
) -> None:
    """Replace the result in `out` by these files. The file `mark_file` appears last: without it, `out` has no result.

    Other files that drivelint wrote there earlier are removed; with `overwrite`, every other file that matches `patterns`.
    Errors: `OutputError`.
    """
    names = {*contents, *finished_files}
    before = _replaceable_files(out, patterns, overwrite=overwrite)
    # if the machine fails halfway, the list has both the old and the new files for the next run
    publish(out, {MANIFEST: manifest_bytes(before | names)}, {})
    unused_files: dict[str, Path | None] = dict.fromkeys(sorted(before - names))
    hashed = {name: data for name, data in contents.items() if name == mark_file or name.endswith(".parquet")}
    hashes = {name: sha256(data).hexdigest() for name, data in sorted(hashed.items())}
    publish(out, {MANIFEST: manifest_bytes(names, hashes), **contents}, {**unused_files, **finished_files}, mark_file)
    _remove_empty_subfolders(out, unused_files)
    earlier = out / EARLIER_RESULT_FOLDER
    _remove_files(
        earlier,
        [
            *sorted(_replaceable_files(earlier, patterns, overwrite=False)),
            *([MANIFEST] if written_files(earlier) else []),
        ],
    )
    with suppress(OSError):  # another program's file is in the folder, or the folder does not exist
        earlier.rmdir()


def add_file(out: Path, name: str, content: bytes) -> None:
    """Write one more file into the folder of a result. Errors: `OutputError`."""
    publish(out, {MANIFEST: manifest_bytes({*written_files(out), name}, _stored_hashes(out)), name: content}, {})


def changed_files(out: Path) -> list[str]:
    """Return the names of the tables and the summary that were changed after drivelint wrote them; empty without stored hashes."""
    return [name for name, stored_hash in _stored_hashes(out).items() if _sha256(out / name) != stored_hash]


def folder_of_killed_run(out: Path) -> Path | None:
    """Return the working folder that a killed run left, so that the result in `out` is of an earlier run; else None."""
    left = sorted(out.glob(f"{_WORK_FOLDER_PREFIX}.*"))
    if not left:
        return None
    try:
        with _lock_folder(out) as is_ours:
            return left[0] if is_ours else None
    except UsageError:
        return None


def _sha256(path: Path) -> str | None:
    """Return the hash of a file; None if the file cannot be read: a damaged list may have given a wrong name."""
    try:
        with path.open("rb") as file:
            return file_digest(file, "sha256").hexdigest()
    except (OSError, ValueError):
        return None


def _matching_files(out: Path, patterns: Sequence[str]) -> set[str]:
    return {path.relative_to(out).as_posix() for pattern in patterns for path in out.glob(pattern)}


def _replaceable_files(out: Path, patterns: Sequence[str], *, overwrite: bool) -> set[str]:
    """Return the files of an earlier result, except `files.json`: the listed files, or with `overwrite` all that match `patterns`."""
    present = _matching_files(out, patterns) - {MANIFEST}
    return present if overwrite else present & written_files(out)


def _stored_hashes(out: Path) -> dict[str, str]:
    try:
        return hashes_in_manifest((out / MANIFEST).read_bytes())
    except OSError:
        return {}  # the result was copied without its list


def hashes_in_manifest(content: bytes) -> dict[str, str]:
    """Return name -> sha256 from the content of `files.json`; empty for a damaged file or one of an older version."""
    try:
        return {str(name): str(digest) for name, digest in json.loads(content)[_HASHES_KEY].items()}
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return {}


def manifest_bytes(names: set[str], hashes: Mapping[str, str] | None = None) -> bytes:
    """Return the content of `files.json` for the files of these names."""
    document = {MANIFEST_FILES_KEY: sorted(names), **({_HASHES_KEY: hashes} if hashes else {})}
    return (json.dumps(document, indent=2, ensure_ascii=False) + "\n").encode()
