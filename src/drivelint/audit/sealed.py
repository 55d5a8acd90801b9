"""Checks whether an audit's files were changed after they were written.

An audit that has ended has `files.json`, with the SHA-256 of its tables and summary, like the folder of a check. In an audit that has not
ended, each receipt has the hash of its drive's rows.
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
from drivelint.audit.compact import RECEIPT_SCHEMA, chunk_ids, chunk_name, unpacked_receipts
from drivelint.audit.driver import empty_tables
from drivelint.audit.unpacked import RUNNING_AUDIT_MESSAGE, SUMMARY_FILE
from drivelint.audit.worker import TABLES, batch_name, rows_sha256
from drivelint.errors import UsageError
from drivelint.result.folder import hashes_in_manifest, manifest_bytes
from drivelint.result.names import MANIFEST

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from drivelint.audit.store import ResultStore

_TABLES_FOLDER: Final = "tables"
_ADVICE_ON_CHANGED_FILE: Final = "audit the drives again into another --out"


def seal(results: ResultStore, names: Iterable[str], summary: bytes) -> None:
    """Write the summary, then the list `files.json` with the hashes of the summary, the files `names` and all tables. Errors:
    `OutputError`."""
    hashes = {name: sha256(results.read(name) or b"").hexdigest() for name in {*names, *results.names(_TABLES_FOLDER)}}
    hashes[SUMMARY_FILE] = sha256(summary).hexdigest()
    results.write(SUMMARY_FILE, summary)  # before the list: an audit with a summary must have one
    results.write(MANIFEST, manifest_bytes(set(hashes), dict(sorted(hashes.items()))))


def unseal(results: ResultStore) -> None:
    """Remove the list `files.json`, before any listed file changes. Errors: `OutputError`."""
    results.delete([MANIFEST])


def require_listed_files_unchanged_and_return_has_list(results: ResultStore, downloads: Path, dest: str) -> bool:
    """Raise `UsageError`, which names the first changed file, if the audit's files have changed since it ended.

    Return whether the audit has `files.json`. An audit without it has not ended, or is of an older version. `downloads`: folder for
    copies.
    Errors: also `OutputError`.
    """
    hashes = hashes_in_manifest(results.read(MANIFEST) or b"")
    if not hashes:
        return False
    for name in sorted({*results.names(_TABLES_FOLDER), *hashes}):
        if name not in hashes or _file_sha256(results, downloads, name) != hashes[name]:
            if results.read(MANIFEST) is None:  # a shard has found the files unchanged, and has begun to change them
                return False
            raise UsageError(
                f"{dest.rstrip('/')}/{name}: was changed since drivelint audit wrote it: {_ADVICE_ON_CHANGED_FILE}"
            )
    return True


def require_audit_unchanged(results: ResultStore, downloads: Path, dest: str) -> None:
    """Raise `UsageError` if an audit was changed: it has ended but lacks `files.json`, or a file or a drive's rows differ from their hash.

    `downloads`: folder for copies. Errors: also `OutputError`.
    """
    require_file_list(results, dest)
    is_listed = require_listed_files_unchanged_and_return_has_list(results, downloads, dest)
    before = _file_names(results)
    try:
        require_rows_unchanged(results, dest, packed=not is_listed)
    except UsageError as error:
        if _file_names(results) != before:
            raise UsageError(f"{dest}: {RUNNING_AUDIT_MESSAGE}") from error
        raise


def require_file_list(results: ResultStore, dest: str) -> None:
    """Raise `UsageError` if an audit has ended but has no readable list of its files. Errors: also `OutputError`."""
    if not hashes_in_manifest(results.read(MANIFEST) or b"") and _has_ended(results):
        raise UsageError(
            f"{dest}: has ended, and {MANIFEST}, the list of its files, is missing or not readable: "
            "give the same audit again, which holds all rows against their receipts"
        )


def _has_ended(results: ResultStore) -> bool:
    """Return whether an audit has ended: it has a summary, or its only part, the audit of all drives, has ended."""
    if results.read(SUMMARY_FILE) is not None:
        return True
    return parts.begun_or_expected_parts(results) == {parts.ALL_DRIVES} and not parts.unfinished_parts(results)


def _file_names(results: ResultStore) -> set[str]:
    return {name for folder in ("receipts", "batches", _TABLES_FOLDER) for name in results.names(folder)}


def require_rows_unchanged(results: ResultStore, dest: str, *, packed: bool) -> None:
    """Raise `UsageError`, which names the log, if a drive's rows do not match the hash in its receipt, or a file cannot be read.

    No other process may pack meanwhile. `packed`: also check the results that are already packed. Errors: also `OutputError`.
    """
    for some in unpacked_receipts(results, only_whole_batches=False):
        for batch, receipts in groupby(some, key=lambda receipt: receipt.batch):
            if results.read(batch_name("drives", batch)) is None:
                continue  # the rows were removed: these drives are judged again
            expected_hashes = {receipt.key: (receipt.log, receipt.rows_sha256) for receipt in receipts}
            _require_rows_match_hashes(
                results, dest, {table: batch_name(table, batch) for table in TABLES}, expected_hashes
            )
    for chunk in chunk_ids(results) if packed else ():
        names = {table: chunk_name(table, chunk) for table in (*TABLES, "receipts")}
        with TemporaryDirectory(prefix="drivelint-audit-") as downloads:
            receipts = _read_table(results, dest, names.pop("receipts"), Path(downloads), RECEIPT_SCHEMA).to_pylist()
        expected_hashes = {receipt["key"]: (receipt["log"], receipt["rows_sha256"]) for receipt in receipts}
        _require_rows_match_hashes(results, dest, names, expected_hashes, refuse_other_drives=True)


def _require_rows_match_hashes(
    results: ResultStore,
    dest: str,
    names: dict[str, str],
    expected_hashes: dict[str, tuple[str, str]],
    *,
    refuse_other_drives: bool = False,
) -> None:
    """Raise `UsageError` if rows do not match `expected_hashes`: key -> (log, hash). `names`: table -> its file. `refuse_other_drives`:
    also refuse rows of other drives."""
    with TemporaryDirectory(prefix="drivelint-audit-") as downloads:
        rows_by_table = {
            table: _read_table(results, dest, name, Path(downloads), empty_tables()[table].schema)
            for table, name in names.items()
        }
    by_key = {table: dict(_rows_by_key(rows)) for table, rows in rows_by_table.items()}
    for key, (log, rows_hash) in expected_hashes.items():
        if (
            rows_sha256({table: by_key[table].get(key, rows.slice(0, 0)) for table, rows in rows_by_table.items()})
            != rows_hash
        ):
            raise UsageError(
                f"{dest}: the rows of {log} were changed since drivelint audit wrote them: {_ADVICE_ON_CHANGED_FILE}"
            )
    for table, rows in by_key.items():
        n_told = sum(of.num_rows for key, of in rows.items() if key in expected_hashes or not refuse_other_drives)
        if n_told != rows_by_table[table].num_rows:
            raise UsageError(
                f"{dest.rstrip('/')}/{names[table]}: has rows that drivelint audit did not write: {_ADVICE_ON_CHANGED_FILE}"
            )


def _rows_by_key(rows: pa.Table) -> Iterator[tuple[str, pa.Table]]:
    """Yield each key with its rows. The rows of a key are contiguous."""
    ends = pc.run_end_encode(rows["key"].combine_chunks())
    first = 0
    for key, end in zip(ends.values.to_pylist(), ends.run_ends.to_pylist(), strict=True):
        yield key, rows.slice(first, end - first)
        first = end


def _read_table(
    results: ResultStore, dest: str, name: str, downloads: Path, schema: pa.Schema | None = None
) -> pa.Table:
    try:
        rows = pq.read_table(results.fetch(name, downloads), partitioning=None)
        return rows if schema is None else rows.cast(schema)
    except (OSError, ValueError) as error:  # errors of pyarrow are subclasses of these
        raise UsageError(
            f"{dest.rstrip('/')}/{name}: was changed since drivelint audit wrote it: {_ADVICE_ON_CHANGED_FILE}"
        ) from error


def _file_sha256(results: ResultStore, downloads: Path, name: str) -> str | None:
    """Return the hash of a file; None: there is no such file. The name may come from a damaged list."""
    try:
        with results.fetch(name, downloads).open("rb") as file:
            return file_digest(file, "sha256").hexdigest()
    except (OSError, ValueError):
        return None
