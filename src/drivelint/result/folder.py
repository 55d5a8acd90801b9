"""The folder that `check --out` writes, replaced as one by a later run. What drivelint did not write there is never touched.

`files.json` lists what drivelint wrote, and the sha256 of tables and summary. A run works in a folder of its own within. An earlier result
must not pass for that of a run that ended without one: its reports go when the run begins, the rest moves to `earlier/` when it fails.
"""

from __future__ import annotations

import json
import os
import shutil
from contextlib import contextmanager, suppress
from hashlib import file_digest, sha256
from typing import TYPE_CHECKING, Final

from drivelint.errors import UsageError
from drivelint.own_files import MANIFEST_KEY, written_files
from drivelint.phrases import listed
from drivelint.result.names import MANIFEST
from drivelint.result.publishing import OutputError, prepare_folder, publish

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence
    from pathlib import Path

_HASHES: Final = "sha256"
_WORK: Final = ".drivelint.work"
EARLIER: Final = "earlier"
"""The folder, within that of results, of an earlier result after a run that ended without one; the next result replaces it."""


@contextmanager
def working_folder(
    out: Path, patterns: Sequence[str], reports: Sequence[str], mark: str, *, overwrite: bool = False
) -> Iterator[Path]:
    """Make the folder `out` and yield an empty one within for the files of a run, which goes afterwards.

    `patterns`: globs of the names that a result may have; `reports`: names of those that the tables give again, which a build server
    shows; `mark`: as in `replace`. Errors: `UsageError` where `out` is a file, or has such names that drivelint
    did not write, unless they may be overwritten; `OutputError`.
    """
    prepare_folder(out)
    present = _present(out, patterns)
    foreign = sorted(present - written_files(out) - {MANIFEST})
    if foreign and not overwrite:
        raise UsageError(
            f"--out {out}: has {listed(foreign, 3)}, which drivelint did not write there ({MANIFEST} does not list it): "
            "choose another folder, or replace it with --overwrite"
        )
    with _locked(out) as is_ours:
        for left in out.glob(f"{_WORK}.*") if is_ours else ():
            shutil.rmtree(left, ignore_errors=True)  # of a run that was killed
        work, before, is_done = out / f"{_WORK}.{os.getpid()}", _identity(out / mark), False
        try:
            work.mkdir()
            _remove(out, sorted(_result_files(out, patterns, overwrite=overwrite).intersection(reports)))
            yield work
            is_done = True
        finally:
            shutil.rmtree(work, ignore_errors=True)
            if not is_done and before is not None and _identity(out / mark) == before:
                _set_aside(out, patterns, mark, overwrite=overwrite)


def _set_aside(out: Path, patterns: Sequence[str], mark: str, *, overwrite: bool) -> None:
    """Move an earlier result into its folder within `out`; without its mark there is no result in `out` from the first move on."""
    earlier = out / EARLIER
    with suppress(OutputError):  # what stays there is replaced; why the run ended must not be hidden by it
        _remove(earlier, sorted(_result_files(earlier, patterns, overwrite=False)))
    names = _result_files(out, patterns, overwrite=overwrite)
    try:
        for name in (mark, *sorted(names - {mark}), MANIFEST):
            if (out / name).exists():
                (earlier / name).parent.mkdir(parents=True, exist_ok=True)
                (out / name).replace(earlier / name)
    except OSError:
        _remove(out, [mark])  # what cannot be moved is no result
    _remove_empty(out, names)


def _remove(out: Path, names: Sequence[str]) -> None:
    """Remove these files of a folder, and the folders that they leave empty. Errors: `OutputError`."""
    try:
        for name in names:
            (out / name).unlink(missing_ok=True)
    except OSError as error:
        raise OutputError(f"{out}: an earlier result cannot be removed: {error.strerror or error}") from error
    _remove_empty(out, names)


def _remove_empty(out: Path, names: Iterable[str]) -> None:
    for folder in {(out / name).parent for name in names} - {out}:
        with suppress(OSError):  # a foreign file is there
            folder.rmdir()


def _identity(path: Path) -> tuple[int, int] | None:
    """Return an identity that distinguishes a file from its replacement; None: there is none."""
    try:
        said = path.stat()
    except OSError:
        return None
    return said.st_ino, said.st_mtime_ns


@contextmanager
def _locked(out: Path) -> Iterator[bool]:
    """Hold a folder for this process alone; show whether that is so, which not every file system can.

    The system ends a lock with its process. Numbers of processes would not show it: every container has a process 1.
    Errors: `UsageError` where another process has the folder.
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


def replace(
    out: Path,
    contents: dict[str, bytes],
    finished_files: dict[str, Path],
    mark: str,
    patterns: Sequence[str],
    *,
    overwrite: bool,
) -> None:
    """Replace the result in `out` by these files. It is whole when `mark` is there: until then no result is.

    What drivelint wrote there earlier and these files lack goes; with `overwrite` whatever has the name of a result does.
    Errors: `OutputError`.
    """
    names = {*contents, *finished_files}
    before = _result_files(out, patterns, overwrite=overwrite)
    # should the machine fail halfway, the next run knows both the old and the new files
    publish(out, {MANIFEST: manifest(before | names)}, {})
    unused_files: dict[str, Path | None] = dict.fromkeys(sorted(before - names))
    hashed = {name: data for name, data in contents.items() if name == mark or name.endswith(".parquet")}
    hashes = {name: sha256(data).hexdigest() for name, data in sorted(hashed.items())}
    publish(out, {MANIFEST: manifest(names, hashes), **contents}, {**unused_files, **finished_files}, mark)
    _remove_empty(out, unused_files)
    earlier = out / EARLIER
    _remove(
        earlier,
        [*sorted(_result_files(earlier, patterns, overwrite=False)), *([MANIFEST] if written_files(earlier) else [])],
    )
    with suppress(OSError):  # a foreign file is there, or there is none
        earlier.rmdir()


def add(out: Path, name: str, content: bytes) -> None:
    """Write one more file into the folder of a result. Errors: `OutputError`."""
    publish(out, {MANIFEST: manifest({*written_files(out), name}, _hashes(out)), name: content}, {})


def changed_files(out: Path) -> list[str]:
    """Return the tables, and the summary, of a result that are not as they were written; none where nothing says how they were."""
    return [name for name, said in _hashes(out).items() if _sha256(out / name) != said]


def left_by_killed_run(out: Path) -> Path | None:
    """Return the working folder of a run that was killed, so that the result in `out` is an earlier one; None where a run goes on."""
    left = sorted(out.glob(f"{_WORK}.*"))
    if not left:
        return None
    try:
        with _locked(out) as is_ours:
            return left[0] if is_ours else None
    except UsageError:
        return None


def _sha256(path: Path) -> str | None:
    """Return the hash of a file; None where none can be read: its name may come from a damaged list."""
    try:
        with path.open("rb") as file:
            return file_digest(file, "sha256").hexdigest()
    except (OSError, ValueError):
        return None


def _present(out: Path, patterns: Sequence[str]) -> set[str]:
    return {path.relative_to(out).as_posix() for pattern in patterns for path in out.glob(pattern)}


def _result_files(out: Path, patterns: Sequence[str], *, overwrite: bool) -> set[str]:
    """Return the names of an earlier result's files, without their list: those that are listed, or all that may be overwritten."""
    present = _present(out, patterns) - {MANIFEST}
    return present if overwrite else present & written_files(out)


def _hashes(out: Path) -> dict[str, str]:
    try:
        return hashes_in((out / MANIFEST).read_bytes())
    except OSError:
        return {}  # copied without it


def hashes_in(content: bytes) -> dict[str, str]:
    """Return name -> sha256 from `files.json`; nothing for one of an older version, or a damaged one."""
    try:
        return {str(name): str(said) for name, said in json.loads(content)[_HASHES].items()}
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return {}


def manifest(names: set[str], hashes: Mapping[str, str] | None = None) -> bytes:
    """Return the content of `files.json` for the files of these names."""
    said = {MANIFEST_KEY: sorted(names), **({_HASHES: hashes} if hashes else {})}
    return (json.dumps(said, indent=2, ensure_ascii=False) + "\n").encode()
