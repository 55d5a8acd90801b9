"""The place of an audit's results: a folder, or a prefix in an object store. A file with its final name is always complete."""

from __future__ import annotations

import os
import uuid
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from drivelint.audit.bucket import Bucket, is_url
from drivelint.errors import UsageError
from drivelint.result.publishing import OutputError

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator


class ResultStore(Protocol):
    """Stores files under names, with `/` between folders. Errors of every method: `OutputError` (exit code 75) if the store fails."""

    def create(self, name: str, content: bytes) -> bool:
        """Write a file unless a file of that name exists; return whether it was written. Of several concurrent writers, exactly one
        succeeds."""
        ...

    def write(self, name: str, content: bytes) -> None:
        """Write a file, and replace an existing file of that name."""
        ...

    def read(self, name: str) -> bytes | None:
        """Return the content of a file; None: the file does not exist."""
        ...

    def names(self, prefix: str) -> Iterator[str]:
        """Yield the names of all files below a folder, in any order."""
        ...

    def delete(self, names: Iterable[str]) -> None:
        """Remove files; ignore files that do not exist."""
        ...

    def fetch(self, name: str, folder: Path) -> Path:
        """Return a local path of a file: the file itself, or a copy in `folder`."""
        ...


class LocalFolder:
    """A folder on a local or shared disk. A file is synced to the disk before it gets its final name."""

    def __init__(self, root: Path) -> None:
        if root.exists() and not root.is_dir():
            raise UsageError(f"--out {root}: is a file: give a folder for the results")
        self.root = root

    def create(self, name: str, content: bytes) -> bool:
        """See `ResultStore.create`."""
        path = self.root / name
        try:
            temporary = self._write_temporary_file(path, content)
            try:
                os.link(temporary, path)  # unlike a rename, this fails if the name exists
            except FileExistsError:
                return False
            finally:
                temporary.unlink(missing_ok=True)
            _sync_folder(path.parent)
        except OSError as error:
            raise self._output_error(error) from error
        return True

    def write(self, name: str, content: bytes) -> None:
        """See `ResultStore.write`."""
        path = self.root / name
        try:
            self._write_temporary_file(path, content).replace(path)
            _sync_folder(path.parent)
        except OSError as error:
            raise self._output_error(error) from error

    def read(self, name: str) -> bytes | None:
        """See `ResultStore.read`."""
        try:
            return (self.root / name).read_bytes()
        except FileNotFoundError:
            return None
        except OSError as error:
            raise self._output_error(error) from error

    def names(self, prefix: str) -> Iterator[str]:
        """See `ResultStore.names`. Files that are being written are left out."""
        todo = [self.root / prefix]
        while todo:
            try:
                entries = list(os.scandir(todo.pop()))
            except FileNotFoundError:
                continue
            except OSError as error:
                raise self._output_error(error) from error
            for entry in entries:
                if entry.is_dir():
                    todo.append(Path(entry.path))
                elif not entry.name.startswith("."):
                    yield Path(entry.path).relative_to(self.root).as_posix()

    def delete(self, names: Iterable[str]) -> None:
        """See `ResultStore.delete`."""
        try:
            for name in names:
                (self.root / name).unlink(missing_ok=True)
        except OSError as error:
            raise self._output_error(error) from error

    def fetch(self, name: str, folder: Path) -> Path:  # noqa: ARG002 - as in `ResultStore`
        """See `ResultStore.fetch`."""
        return self.root / name

    def remove_unfinished_files(self) -> None:
        """Remove unfinished files of killed writers. No process may write meanwhile."""
        for file in self.root.rglob(".*.tmp"):
            file.unlink(missing_ok=True)

    def _write_temporary_file(self, path: Path, content: bytes) -> Path:
        path.parent.mkdir(parents=True, exist_ok=True)
        temporary = path.with_name(f".{path.name}.{uuid.uuid4().hex}.tmp")
        temporary.write_bytes(content)
        _sync_file(temporary)
        return temporary

    def _output_error(self, error: OSError) -> OutputError:
        return OutputError(
            f"{self.root}: cannot write the results: {error.strerror or error}: free the disk or choose another --out"
        )


def open_store(dest: str) -> ResultStore:
    """Return the store that `--out` names: a bucket for a URL, else a folder. Errors: `UsageError`."""
    if is_url(dest):
        return Bucket(dest)
    return LocalFolder(Path(dest))


def _sync_file(path: Path) -> None:
    with path.open("rb") as file:
        os.fsync(file.fileno())


def _sync_folder(path: Path) -> None:
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
