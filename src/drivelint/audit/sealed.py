"""Checks whether an audit's files were changed after they were written.

An audit that has ended has `files.json`, the sha256 of tables and summary, as in the folder of a check. One that has not ended has
the receipts, each with the hash of its drive's rows.
"""

from __future__ import annotations

from hashlib import file_digest, sha256
from itertools import groupby
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Final

import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq

from drivelint.audit import parts
from drivelint.audit.compact import RECEIPT_SCHEMA, chunk_name, chunks, loose_receipts
from drivelint.audit.driver import empty_rows
from drivelint.audit.unpacked import AT_WORK, SUMMARY_FILE
from drivelint.audit.worker import TABLES, batch_name, rows_sha256
from drivelint.errors import UsageError
from drivelint.result.folder import hashes_in, manifest
from drivelint.result.names import MANIFEST

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from drivelint.audit.store import ResultStore

_TABLES: Final = "tables"
_AGAIN: Final = "audit the drives again into another --out"


def seal(results: ResultStore, names: Iterable[str], summary: bytes) -> None:
    """Write the summary, and then the list of it, of these files and of all tables. Errors: `OutputError`."""
    hashes = {name: sha256(results.read(name) or b"").hexdigest() for name in {*names, *results.names(_TABLES)}}
    hashes[SUMMARY_FILE] = sha256(summary).hexdigest()
    results.write(SUMMARY_FILE, summary)  # after all is hashed: with it the audit has ended, and has to have the list
    results.write(MANIFEST, manifest(set(hashes), dict(sorted(hashes.items()))))


def unseal(results: ResultStore) -> None:
    """Remove the list, before anything is changed that it lists. Errors: `OutputError`."""
    results.delete([MANIFEST])


def require_unchanged(results: ResultStore, home: Path, dest: str) -> bool:
    """Refuse an audit whose files have changed since it ended; return whether it has the list of them.

    One without a list has not ended, or is of an older version. `home`: for copies. Errors: `UsageError`, which names the first of
    these files; `OutputError`.
    """
    said = hashes_in(results.read(MANIFEST) or b"")
    if not said:
        return False
    for name in sorted({*results.names(_TABLES), *said}):
        if name not in said or _sha256(results, home, name) != said[name]:
            if results.read(MANIFEST) is None:  # a shard has found the files as they were, and has begun to change them
                return False
            raise UsageError(f"{dest.rstrip('/')}/{name}: was changed since drivelint audit wrote it: {_AGAIN}")
    return True


def require_as_written(results: ResultStore, home: Path, dest: str) -> None:
    """Refuse to read an audit that was changed: it has ended and lacks its list, a file or the rows of a receipt are others.

    `home`: for copies. Errors: `UsageError`; `OutputError`.
    """
    require_list(results, dest)
    is_listed = require_unchanged(results, home, dest)
    before = _names(results)
    try:
        require_rows_unchanged(results, dest, packed=not is_listed)
    except UsageError as error:
        if _names(results) != before:
            raise UsageError(f"{dest}: {AT_WORK}") from error
        raise


def require_list(results: ResultStore, dest: str) -> None:
    """Refuse an audit that has ended and does not say how its files were. Errors: `UsageError`; `OutputError`."""
    if not hashes_in(results.read(MANIFEST) or b"") and _has_ended(results):
        raise UsageError(
            f"{dest}: has ended, and {MANIFEST}, the list of its files, is missing or not readable: "
            "give the same audit again, which holds all rows against their receipts"
        )


def _has_ended(results: ResultStore) -> bool:
    """Whether an audit has come to its end: that of all drives has, or what was judged was summed up."""
    if results.read(SUMMARY_FILE) is not None:
        return True
    return parts.begun(results) == {parts.ALL} and not parts.unfinished_parts(results)


def _names(results: ResultStore) -> set[str]:
    return {name for folder in ("receipts", "batches", _TABLES) for name in results.names(folder)}


def require_rows_unchanged(results: ResultStore, dest: str, *, packed: bool) -> None:
    """Refuse an audit in which a drive's rows are not those of its receipt. Not while another process packs.

    `packed`: look at packed results, too, besides those that are not packed yet. Errors: `UsageError`, which names the first such
    log, or a file that cannot be read; `OutputError`.
    """
    for some in loose_receipts(results, whole_batches=False):
        for batch, receipts in groupby(some, key=lambda receipt: receipt.batch):
            if results.read(batch_name("drives", batch)) is None:
                continue  # its drives are judged again
            expected_hashes = {each.key: (each.log, each.rows_sha256) for each in receipts}
            _require_rows(results, dest, {table: batch_name(table, batch) for table in TABLES}, expected_hashes)
    for chunk in chunks(results) if packed else ():
        names = {table: chunk_name(table, chunk) for table in (*TABLES, "receipts")}
        with TemporaryDirectory(prefix="drivelint-audit-") as home:
            receipts = _read(results, dest, names.pop("receipts"), Path(home), RECEIPT_SCHEMA).to_pylist()
        expected_hashes = {each["key"]: (each["log"], each["rows_sha256"]) for each in receipts}
        _require_rows(results, dest, names, expected_hashes, nothing_else=True)


def _require_rows(
    results: ResultStore,
    dest: str,
    names: dict[str, str],
    expected_hashes: dict[str, tuple[str, str]],
    *,
    nothing_else: bool = False,
) -> None:
    """Compare rows with `expected_hashes`: key -> log and hash. `names`: table -> its file; `nothing_else`: no rows of another drive."""
    with TemporaryDirectory(prefix="drivelint-audit-") as home:
        read = {
            table: _read(results, dest, name, Path(home), empty_rows()[table].schema) for table, name in names.items()
        }
    by_key = {table: dict(_by_key(rows)) for table, rows in read.items()}
    for key, (log, rows_hash) in expected_hashes.items():
        if rows_sha256({table: by_key[table].get(key, rows.slice(0, 0)) for table, rows in read.items()}) != rows_hash:
            raise UsageError(f"{dest}: the rows of {log} were changed since drivelint audit wrote them: {_AGAIN}")
    for table, rows in by_key.items():
        n_told = sum(of.num_rows for key, of in rows.items() if key in expected_hashes or not nothing_else)
        if n_told != read[table].num_rows:
            raise UsageError(
                f"{dest.rstrip('/')}/{names[table]}: has rows that drivelint audit did not write: {_AGAIN}"
            )


def _by_key(rows: pa.Table) -> Iterator[tuple[str, pa.Table]]:
    """Yield each key with its rows, which stand together."""
    ends = pc.run_end_encode(rows["key"].combine_chunks())
    first = 0
    for key, end in zip(ends.values.to_pylist(), ends.run_ends.to_pylist(), strict=True):
        yield key, rows.slice(first, end - first)
        first = end


def _read(results: ResultStore, dest: str, name: str, home: Path, schema: pa.Schema | None = None) -> pa.Table:
    try:
        rows = pq.read_table(results.fetch(name, home), partitioning=None)
        return rows if schema is None else rows.cast(schema)
    except (OSError, ValueError) as error:  # those of pyarrow are among these
        raise UsageError(f"{dest.rstrip('/')}/{name}: was changed since drivelint audit wrote it: {_AGAIN}") from error


def _sha256(results: ResultStore, home: Path, name: str) -> str | None:
    """Return the hash of a file; None where there is none: its name may come from a damaged list."""
    try:
        with results.fetch(name, home).open("rb") as file:
            return file_digest(file, "sha256").hexdigest()
    except (OSError, ValueError):
        return None
