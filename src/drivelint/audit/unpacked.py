"""Creates the views of a complete audit over an audit that has not ended or is not packed, and returns a warning."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Final, NamedTuple

import duckdb
import pyarrow as pa
import pyarrow.parquet as pq

from drivelint.audit import parts
from drivelint.audit.compact import (
    RECEIPT_SCHEMA,
    batch_rows_query,
    chunk_ids,
    chunk_name,
    create_views,
    receipt_row,
    unpacked_receipts,
)
from drivelint.audit.driver import empty_tables
from drivelint.audit.worker import TABLES, batch_name
from drivelint.errors import UsageError
from drivelint.phrases import plural
from drivelint.result.names import MANIFEST

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.audit.model import Receipt
    from drivelint.audit.store import ResultStore

SUMMARY_FILE: Final = "summary.json"
RUNNING_AUDIT_MESSAGE: Final = "an audit is running there and has just packed results: repeat the query"


class AuditProgress(NamedTuple):
    """The progress of an audit. `digest`: hash of all rows; None: the audit has not ended. `n_unpacked`: how many of the `n_results`
    results are not packed yet.

    `n_asked`: drives of the unfinished parts, or of all parts if none is unfinished; None: not known.
    """

    digest: str | None
    n_unpacked: int = 0
    n_results: int = 0
    n_asked: int | None = None
    missing_parts: tuple[str, ...] = ()

    @property
    def warning(self) -> str:
        """A sentence about the progress of the audit; '' if it has ended."""
        if self.digest is not None and not self.n_unpacked and not self.missing_parts:
            return ""
        of = "" if self.n_asked is None else f" of {self.n_asked}"
        more = f"{self.n_results}{of} drives have a result; "
        more += (
            f"{plural(self.n_unpacked, 'judged drive')} {'is' if self.n_unpacked == 1 else 'are'} not packed yet; "
            if self.n_unpacked
            else ""
        )
        again = (
            "give the same audit again"
            if self.missing_parts in {(), (parts.ALL_DRIVES,)}
            else (f"parts without an end: {', '.join(self.missing_parts)}; give them again, then drivelint merge")
        )
        return f"the audit has not ended: {more}{again}, to have all"


def create_views_of_all_results(
    con: duckdb.DuckDBPyConnection, results: ResultStore, downloads: Path, prefix: str = ""
) -> AuditProgress:
    """Create the views of `create_views` over all results, including results that are not packed. `prefix`: as in `create_views`.

    Errors: `UsageError` if the results are being packed, or a file was removed or changed.
    """
    inner = f"packed_{prefix}"
    try:
        create_views(con, results, downloads, inner)
        loose = _unpacked_receipts_with_rows(con, results, inner)
        for table in (*TABLES, "receipts"):
            _fill_unpacked_rows(con, results, downloads, table, loose)
            con.execute(f"CREATE OR REPLACE TABLE loose_{prefix}{table} AS FROM _loose")
            query = f"FROM {inner}{table}" + (f" UNION ALL BY NAME FROM loose_{prefix}{table}" if loose else "")
            con.execute(f"CREATE OR REPLACE VIEW {prefix}{table} AS {query}")
        con.execute(f"CREATE OR REPLACE VIEW {prefix}rules AS FROM {inner}rules")
        (n,) = con.execute(f"SELECT count(*) FROM {prefix}receipts").fetchone() or (0,)
        summary = json.loads(results.read(SUMMARY_FILE) or b"{}")
    except (duckdb.IOException, FileNotFoundError) as error:
        if results.read(MANIFEST) is not None:
            raise UsageError(
                "a file that files.json lists is missing there: audit the drives again into another --out"
            ) from error
        raise UsageError(RUNNING_AUDIT_MESSAGE) from error
    except (duckdb.Error, ValueError) as error:
        why = " ".join(str(error).split())[:300]
        raise UsageError(
            f"a file there was changed since drivelint audit wrote it ({why}): audit the drives again into another --out"
        ) from error
    unfinished_parts = parts.unfinished_parts(results)
    return AuditProgress(
        summary.get("digest"), len(loose), n, parts.n_expected_drives(results), tuple(unfinished_parts)
    )


def n_results(results: ResultStore, downloads: Path) -> int:
    """Return the number of drives that have a result."""
    n = sum(1 for _ in results.names("receipts"))
    for chunk_id in chunk_ids(results):
        n += pq.read_metadata(results.fetch(chunk_name("receipts", chunk_id), downloads)).num_rows
    return n


def _unpacked_receipts_with_rows(
    con: duckdb.DuckDBPyConnection, results: ResultStore, packed_prefix: str
) -> list[Receipt]:
    """Return the receipts that are in no chunk and whose rows exist."""
    packed_keys = {key for (key,) in con.execute(f"SELECT key FROM {packed_prefix}receipts").fetchall()}
    receipts = [
        receipt
        for some in unpacked_receipts(results, only_whole_batches=False)
        for receipt in some
        if receipt.key not in packed_keys
    ]
    there = {name.rpartition("/")[2] for name in results.names(f"batches/{TABLES[-1]}")}
    return [receipt for receipt in receipts if batch_name("", receipt.batch).rpartition("/")[2] in there]


def _fill_unpacked_rows(
    con: duckdb.DuckDBPyConnection, results: ResultStore, downloads: Path, table: str, unpacked: list[Receipt]
) -> None:
    """Create the table `_loose` with the rows of these receipts."""
    receipts = pa.Table.from_pylist([receipt_row(receipt) for receipt in unpacked], schema=RECEIPT_SCHEMA)
    if table == "receipts" or not unpacked:
        con.register("_some", receipts if table == "receipts" else empty_tables()[table])
        con.execute("CREATE OR REPLACE TABLE _loose AS FROM _some")
        con.unregister("_some")
        return
    con.register("_packed", receipts.select(["key", "batch"]))
    con.execute(f"CREATE OR REPLACE TABLE _loose AS {batch_rows_query(con, results, downloads, table, unpacked)}")
    con.unregister("_packed")
