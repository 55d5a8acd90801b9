"""Packs the many small files of an audit into chunks of some thousand drives: one file per table, and one for the receipts.

The receipts of a chunk are written last: a chunk without receipts does not count. Only after that, the small files of its drives are
removed. An audit that is killed at any moment therefore neither loses a drive nor has it twice.
"""

from __future__ import annotations

from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, Final

import duckdb
import msgspec
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq

from drivelint.audit.driver import empty_tables
from drivelint.audit.model import Receipt, digest
from drivelint.audit.worker import TABLES, batch_name, receipt_name
from drivelint.errors import DriveLintError, UsageError
from drivelint.sql import progress_bar
from drivelint.sql.statements import statement
from drivelint.sql.store import quoted

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from drivelint.audit.store import ResultStore

DRIVES_PER_CHUNK: Final = 4_000
DATABASE_MEMORY_LIMIT: Final = "1GB"
RECEIPT_SCHEMA: Final = pa.schema(
    [
        *((name, pa.string()) for name in ("key", "source_id", "batch", "status", "log")),
        ("size", pa.int64()),
        *((name, pa.string()) for name in ("stamp", "drive_id", "log_sha256", "map_sha256", "reason")),
        ("lossy", pa.bool_()),
        ("off_map", pa.bool_()),
        ("rows_sha256", pa.string()),
        ("km", pa.float64()),
        ("duration_s", pa.float64()),
        ("counts", pa.map_(pa.string(), pa.int64())),
        ("failed", pa.map_(pa.string(), pa.int64())),
        ("unknown", pa.int64()),
        ("beyond_limits", pa.int64()),
        ("tags", pa.map_(pa.string(), pa.string())),
        ("options", pa.string()),
        ("n_in_batch", pa.int64()),
        ("version", pa.int64()),
    ]
)
_VERDICT_SORT_COLUMNS: Final = (
    "key, ego_id, rule_id, profile NULLS FIRST, object_id NULLS FIRST, occurrence, "
    "ref_id NULLS FIRST, t_start_ns NULLS FIRST"
)
_SORT_COLUMNS_OF_TABLE: Final = {
    "verdicts": _VERDICT_SORT_COLUMNS,
    "findings": f"{_VERDICT_SORT_COLUMNS}, finding_id",
    "drives": "key",
}


def chunk_name(table: str, chunk: str) -> str:
    """Return the file name of a chunk in one table, or of its receipts."""
    return f"tables/{table}/{chunk}.parquet"


def chunk_ids(results: ResultStore) -> list[str]:
    """Return the ids of the complete chunks, sorted."""
    return sorted(Path(name).stem for name in results.names("tables/receipts"))


def compact(results: ResultStore, *, while_judging: bool = False) -> int:
    """Pack every receipt that is in no chunk yet, with the drive's rows. Return how many were packed.

    `while_judging`: workers may be writing, so only batches with all their receipts are packed.
    Only one process may compact an audit at a time. Errors: `OutputError`; `DriveLintError` for results that contradict each other.
    """
    _remove_unfinished_chunks(results)
    n_packed = 0
    with open_database() as con, TemporaryDirectory(prefix="drivelint-compact-") as downloads:
        for receipts in unpacked_receipts(results, only_whole_batches=while_judging):
            n_packed += _pack_receipts(results, con, receipts, Path(downloads))
    if not while_judging:
        _remove_unreceipted_batches(results)
    return n_packed


def remove_drives(results: ResultStore, keys: pa.Array) -> None:
    """Remove the drives with these keys from the chunks, so that they are judged again. No other process may compact meanwhile."""
    with TemporaryDirectory(prefix="drivelint-compact-") as downloads:
        for chunk in chunk_ids(results) if len(keys) else ():
            receipts = _read_chunk(results, "receipts", chunk, Path(downloads))
            remaining = receipts.filter(pc.invert(pc.is_in(receipts["key"], value_set=keys)))
            if remaining.num_rows == receipts.num_rows:
                continue
            left = remaining["key"].combine_chunks()
            rows = {table: _read_chunk(results, table, chunk, Path(downloads)) for table in TABLES}
            rows = {table: of.filter(pc.is_in(of["key"], value_set=left)) for table, of in rows.items()}
            # remove the old receipts first: if killed in between, drives are judged again, but never exist twice
            results.delete([chunk_name("receipts", chunk), *(chunk_name(table, chunk) for table in TABLES)])
            if remaining.num_rows:
                _write_chunk(results, {table: _parquet_bytes(of) for table, of in rows.items()}, remaining)


@contextmanager
def open_database() -> Iterator[duckdb.DuckDBPyConnection]:
    """Open a database in memory that writes to disk what exceeds `DATABASE_MEMORY_LIMIT`."""
    with TemporaryDirectory(prefix="drivelint-audit-") as spill, duckdb.connect() as con:
        con.execute(f"SET memory_limit='{DATABASE_MEMORY_LIMIT}'")
        con.execute("SET temp_directory=?", [spill])
        progress_bar.turn_off(con)
        con.execute("SET python_enable_replacements=false")
        yield con


def create_views(con: duckdb.DuckDBPyConnection, results: ResultStore, downloads: Path, prefix: str = "") -> None:
    """Create the views `verdicts`, `findings`, `drives`, `rules` and `receipts` over all chunks.

    Everything must be packed before. `downloads`: folder for copies of remote files. `prefix`: prefix of the view names.
    """
    con.read_parquet(escape_wildcards([str(results.fetch("rules.parquet", downloads))])).create_view(
        f"{prefix}rules", replace=True
    )
    ids = chunk_ids(results)
    for table in (*TABLES, "receipts"):
        files = [str(results.fetch(chunk_name(table, chunk_id), downloads)) for chunk_id in ids]
        if files:
            con.read_parquet(escape_wildcards(files)).create_view(f"{prefix}{table}", replace=True)
        else:
            con.register("_empty", RECEIPT_SCHEMA.empty_table() if table == "receipts" else empty_tables()[table])
            con.execute(f"CREATE OR REPLACE TABLE _no_{prefix}{table} AS FROM _empty")
            con.execute(f"CREATE OR REPLACE VIEW {prefix}{table} AS FROM _no_{prefix}{table}")


def tables_digest(con: duckdb.DuckDBPyConnection) -> str:
    """Return a hash of all rows of the views. It does not depend on the chunks, on the order of rows, or on the paths of the logs."""
    hashed_rows: list[Any] = []
    for table in TABLES:
        left_out = " EXCLUDE (log)" if table == "drives" else ""
        row = con.execute(statement("audit/digest", table=table, columns=f"*{left_out}")).fetchone()
        hashed_rows.append([str(value) for value in row or ()])
    return digest(hashed_rows)


def unpacked_receipts(results: ResultStore, *, only_whole_batches: bool) -> Iterator[list[Receipt]]:
    """Yield lists of some thousand receipts that are in no chunk. The receipts of one batch are in the same list."""
    by_batch: dict[str, list[Receipt]] = {}
    for name in sorted(results.names("receipts")):
        content = results.read(name)
        if content is None:
            continue
        try:
            receipt = Receipt.from_json(content)
        except msgspec.MsgspecError as error:
            raise UsageError(
                f"{name}: not a receipt of drivelint ({error}): remove it to judge the drive again"
            ) from error
        by_batch.setdefault(receipt.batch, []).append(receipt)
    some: list[Receipt] = []
    for _, receipts in sorted(by_batch.items()):
        if only_whole_batches and len(receipts) < receipts[0].n_in_batch:
            continue
        some += receipts
        if len(some) >= DRIVES_PER_CHUNK:
            yield some
            some = []
    if some:
        yield some


def _pack_receipts(
    results: ResultStore, con: duckdb.DuckDBPyConnection, receipts: Sequence[Receipt], downloads: Path
) -> int:
    """Write a chunk of these receipts and their rows, then remove the small files. Return the number of drives in the chunk."""
    lost_batches = {
        batch for batch in {receipt.batch for receipt in receipts} if results.read(batch_name("drives", batch)) is None
    }
    if lost_batches:  # the rows were removed: without a receipt, the drives are judged again
        results.delete(receipt_name(receipt.key) for receipt in receipts if receipt.batch in lost_batches)
        receipts = [receipt for receipt in receipts if receipt.batch not in lost_batches]
    packed_keys = _packed_keys(results, con, receipts, downloads)
    new = [receipt for receipt in receipts if receipt.key not in packed_keys]
    if new:
        table = pa.Table.from_pylist([receipt_row(receipt) for receipt in new], schema=RECEIPT_SCHEMA).sort_by("key")
        con.register("_packed", table.select(["key", "batch"]))
        rows = {}
        for name in TABLES:
            rows[name] = downloads / f"{name}.parquet"
            packed = batch_rows_query(con, results, downloads, name, new)
            row_count = con.execute(
                f"COPY ({packed}) TO {quoted(rows[name])} (FORMAT parquet, COMPRESSION zstd)"
            ).fetchone()
            if name == "drives" and row_count != (len(new),):
                n_written = row_count[0] if row_count else 0
                raise DriveLintError(
                    f"{len(new)} receipts have {n_written} rows in the table drives: judge these drives again"
                )
        con.unregister("_packed")
        _write_chunk(results, {name: file.read_bytes() for name, file in rows.items()}, table)
    results.delete(receipt_name(receipt.key) for receipt in receipts)
    results.delete(batch_name(name, batch) for batch in {receipt.batch for receipt in receipts} for name in TABLES)
    return len(new)


def batch_rows_query(
    con: duckdb.DuckDBPyConnection, results: ResultStore, downloads: Path, table: str, receipts: Sequence[Receipt]
) -> str:
    """Return the SELECT that reads one table's rows from the batches of these receipts, for the drives in the relation `_packed`."""
    files = {receipt.batch: str(results.fetch(batch_name(table, receipt.batch), downloads)) for receipt in receipts}
    con.read_parquet(escape_wildcards(files.values()), filename=True).create_view("_rows", replace=True)
    return statement("audit/packed", order=_SORT_COLUMNS_OF_TABLE[table])


def _packed_keys(
    results: ResultStore, con: duckdb.DuckDBPyConnection, receipts: Sequence[Receipt], downloads: Path
) -> set[str]:
    """Return the keys that a chunk already contains, because a log was moved or a compaction was killed."""
    ids = chunk_ids(results)
    if not ids:
        return set()
    files = [str(results.fetch(chunk_name("receipts", chunk_id), downloads)) for chunk_id in ids]
    con.register("_new", pa.table({"key": [r.key for r in receipts], "rows_sha256": [r.rows_sha256 for r in receipts]}))
    con.read_parquet(escape_wildcards(files)).create_view("_old", replace=True)
    key_rows = con.execute(statement("audit/known")).fetchall()
    con.unregister("_new")
    for key, there, here in key_rows:
        if there != here:
            raise DriveLintError(
                f"two workers got different results for one key ({key}): use one machine image for all workers"
            )
    return {key for key, _, _ in key_rows}


def _write_chunk(results: ResultStore, tables: dict[str, bytes], receipts: pa.Table) -> None:
    chunk = digest(receipts["key"].to_pylist())[:32]
    for table, content in tables.items():
        results.write(chunk_name(table, chunk), content)
    results.write(chunk_name("receipts", chunk), _parquet_bytes(receipts))


def _remove_unfinished_chunks(results: ResultStore) -> None:
    """Remove files of chunks without receipts. Their compaction was killed, and the small files still have their content."""
    whole = set(chunk_ids(results))
    results.delete(
        name for table in TABLES for name in list(results.names(f"tables/{table}")) if Path(name).stem not in whole
    )


def _remove_unreceipted_batches(results: ResultStore) -> None:
    """Remove batches without a receipt. Their worker was killed, and their drives have no result."""
    used = {
        Receipt.from_json(content).batch
        for name in results.names("receipts")
        if (content := results.read(name)) is not None
    }
    results.delete(
        name for table in TABLES for name in list(results.names(f"batches/{table}")) if Path(name).stem not in used
    )


def _read_chunk(results: ResultStore, table: str, chunk: str, downloads: Path) -> pa.Table:
    return pq.read_table(results.fetch(chunk_name(table, chunk), downloads), partitioning=None)


def receipt_row(receipt: Receipt) -> dict[str, Any]:
    """Return a receipt as a row of the table `receipts`."""
    values = msgspec.to_builtins(receipt)
    return {**values, **{key: sorted(values[key].items()) for key in ("counts", "failed", "tags")}}


def _parquet_bytes(rows: pa.Table) -> bytes:
    sink = pa.BufferOutputStream()
    pq.write_table(rows.combine_chunks(), sink, compression="zstd")
    return bytes(sink.getvalue())


def escape_wildcards(files: Iterable[str]) -> list[str]:
    """Return the paths with wildcard characters escaped for DuckDB."""
    return [file.replace("[", "[[]").replace("*", "[*]").replace("?", "[?]") for file in files]
