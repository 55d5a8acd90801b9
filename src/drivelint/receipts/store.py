"""Stores receipts in the user's cache folder: one file each, protected by a hash, and limited in number and size.

A file consists of a line of JSON about the run, the files that the run wrote, and a hash of 32 bytes. Files are written atomically; damaged
files are ignored. The least recently used receipts are removed first.
"""

from __future__ import annotations

import json
import os
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass, field
from hashlib import sha256
from pathlib import Path
from shutil import copyfileobj
from tempfile import NamedTemporaryFile
from typing import IO, TYPE_CHECKING, Any, Final

from drivelint.memo import cache_folder
from drivelint.receipts.inputs import RunInputs

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

MOST_KEPT_RECEIPTS: Final = 100
MOST_BYTES_OF_ALL_RECEIPTS: Final = 1_000_000_000
"""Limit of the size of all receipts together in bytes."""
MOST_BYTES_OF_ONE_RECEIPT: Final = 200_000_000
"""Limit of the output of one run in bytes. A larger run is judged again, because copying its output takes long, too."""
_RECEIPT_FORMAT: Final = "drivelint receipt 1"
_HASH_BYTES: Final = 32
_PIECE_BYTES: Final = 1 << 20


@dataclass(frozen=True)
class Receipt:
    """The receipt of a run: its inputs, output, notes and exit code, and the names and sizes of the files that it wrote.

    `day`: the day of the run, if the result depends on it. `grown_files`: names of files that were written in pieces during the run.
    """

    inputs: RunInputs
    stdout: str
    notes: tuple[str, ...]
    exit_code: int
    day: str | None = None
    files: dict[str, int] = field(default_factory=dict)
    grown_files: tuple[str, ...] = ()


class OpenedReceipt:
    """A receipt whose file is open, so that its content cannot be replaced meanwhile."""

    def __init__(self, receipt: Receipt, file: IO[bytes], start: int) -> None:
        self.receipt = receipt
        self._file = file
        self._start = start

    def unpack(self, work: Path) -> tuple[dict[str, bytes], dict[str, Path]]:
        """Return name -> content of the files, and name -> path of the `grown_files`, which are written into `work`."""
        self._file.seek(self._start)
        contents: dict[str, bytes] = {}
        grown_files: dict[str, Path] = {}
        for name, size in self.receipt.files.items():
            content = self._file.read(size)
            if name in self.receipt.grown_files:
                grown_files[name] = work / name
                grown_files[name].parent.mkdir(parents=True, exist_ok=True)
                grown_files[name].write_bytes(content)
            else:
                contents[name] = content
        return contents, grown_files


@contextmanager
def open_receipt(key: str) -> Iterator[OpenedReceipt | None]:
    """Open the receipt of a key; None: it does not exist or is damaged."""
    home = _receipts_folder()
    try:
        file = None if home is None else (home / key).open("rb")
    except OSError:
        file = None
    if file is None or home is None:
        yield None
        return
    with file:
        opened_receipt = _read_receipt(file, key)
        if opened_receipt is not None:
            with suppress(OSError):
                os.utime(home / key)
        yield opened_receipt


def store_receipt(key: str, receipt: Receipt, out: Path | None) -> None:
    """Store a receipt with the files that the run wrote into `out`, unless they are too large or the cache folder is not writable."""
    home = _receipts_folder()
    if home is None or sum(receipt.files.values()) > MOST_BYTES_OF_ONE_RECEIPT:
        return
    with suppress(OSError):
        home.mkdir(parents=True, exist_ok=True)
        with NamedTemporaryFile(dir=home, prefix=".new-", delete=False) as part:
            try:
                _write_receipt(part, key, receipt, [out / name for name in receipt.files] if out else [])
            except BaseException:
                Path(part.name).unlink(missing_ok=True)
                raise
        Path(part.name).replace(home / key)
        _remove_least_recently_used(home)


def _receipts_folder() -> Path | None:
    home = cache_folder()
    return None if home is None else home / "receipts"


def _write_receipt(target: IO[bytes], key: str, receipt: Receipt, files: Sequence[Path]) -> None:
    """Write a receipt. Errors: `OSError`, also if a file does not have its stated size."""
    head = {"format": _RECEIPT_FORMAT, "key": key, **asdict(receipt)}
    target.write(json.dumps(head).encode() + b"\n")
    for file, size in zip(files, receipt.files.values(), strict=True):
        before = target.tell()
        with file.open("rb") as content:
            copyfileobj(content, target, _PIECE_BYTES)
        if target.tell() - before != size:
            raise OSError(f"{file}: its size changed after the run wrote it")
    target.flush()
    with Path(target.name).open("rb") as content:
        target.write(_hash_of(content, target.tell()))


def _read_receipt(file: IO[bytes], key: str) -> OpenedReceipt | None:
    size = file.seek(0, os.SEEK_END) - _HASH_BYTES
    file.seek(0)
    if size <= 0 or _hash_of(file, size) != file.read(_HASH_BYTES):
        return None
    file.seek(0)
    try:
        stored_fields: dict[str, Any] = json.loads(file.readline())
        if stored_fields.pop("format") != _RECEIPT_FORMAT or stored_fields.pop("key") != key:
            return None
        return OpenedReceipt(_receipt_from_fields(stored_fields), file, file.tell())
    except (ValueError, KeyError, TypeError, RecursionError):
        return None


def _receipt_from_fields(stored_fields: Mapping[str, Any]) -> Receipt:
    lists = {name: tuple(stored_fields[name]) for name in ("notes", "grown_files")}
    return Receipt(**{**stored_fields, **lists, "inputs": RunInputs(**stored_fields["inputs"])})


def _hash_of(file: IO[bytes], size: int) -> bytes:
    """Return the hash of the next `size` bytes of a file."""
    whole = sha256()
    while size > 0 and (piece := file.read(min(size, _PIECE_BYTES))):
        whole.update(piece)
        size -= len(piece)
    return whole.digest()


def _remove_least_recently_used(home: Path) -> None:
    """Remove the least recently used receipts until the limits are met, including incomplete files of killed processes."""
    receipts = sorted(((path.stat().st_mtime_ns, path) for path in home.iterdir()), reverse=True)
    size = 0
    for n, (_, path) in enumerate(receipts, 1):
        size += path.stat().st_size
        if n > MOST_KEPT_RECEIPTS or size > MOST_BYTES_OF_ALL_RECEIPTS:
            path.unlink(missing_ok=True)
