"""Writes the packed tables of an audit as Delta tables, which Spark, Databricks, Trino and others read.

A Delta table is a folder of Parquet files with a log that lists the files of each version. The Parquet files are copies of the packed
files, named by the hash of their content. One commit adds new files and removes files that the audit does not have. A reader sees either
the former version or the next one, even if the writer is killed.
"""

from __future__ import annotations

import hashlib
import json
import re
import time
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Final, NamedTuple, TypeVar

import pyarrow as pa
import pyarrow.parquet as pq

from drivelint.audit.bucket import is_url
from drivelint.audit.compact import chunk_ids, chunk_name
from drivelint.audit.store import open_store
from drivelint.audit.worker import TABLES
from drivelint.errors import UsageError
from drivelint.phrases import plural
from drivelint.result.publishing import OutputError

if TYPE_CHECKING:
    from collections.abc import Callable

    import duckdb
    from deltalake import DeltaTable

    from drivelint.audit.store import ResultStore

T = TypeVar("T")

TABLE_NAMES: Final = ("rules", *TABLES, "receipts")
"""The Delta tables in the order in which they are written. Receipts are written last, as in a chunk."""
DIGEST_KEY: Final = "drivelint.digest"
"""The key in the metadata of a commit for the `digest` of the audit's summary."""
_STORAGE_OPTIONS: Final = {"allow_http": "true", "retry_timeout": "20s"}
_MAX_STORE_ATTEMPTS: Final = 6
"""Six attempts of 20 s make the two minutes after which a run gives up on a busy store."""
_COLOUR_CODE: Final = re.compile(r"\x1b\[[0-9;]*m")
"""Colour codes in the error messages of deltalake."""


class DeltaChange(NamedTuple):
    """The number of files that were added and removed, in all tables."""

    n_added: int
    n_removed: int

    def sentence(self, dest: str) -> str:
        """Return the numbers as a sentence."""
        if not self.n_added and not self.n_removed:
            return f"{dest}: the Delta tables were up to date"
        return f"{dest}: {plural(self.n_added, 'file')} added to the Delta tables, {self.n_removed} removed"


def require_writable(dest: str, out: str, run_id: str) -> None:
    """Raise an error, before any drive is judged, if the tables of the audit in `out` cannot be written to `dest`. `run_id`: the audit's
    run id.

    Errors: `UsageError` if deltalake is not installed, or if `dest` is a file, is within `out`, or has other tables; `OutputError`.
    """
    try:
        import deltalake  # noqa: F401 - only tests whether it is installed
    except ModuleNotFoundError as error:
        raise UsageError(f"--delta: {error.name} is not installed: pip install 'drivelint[delta]'") from error
    if f"{_absolute_place(dest)}/".startswith(f"{_absolute_place(out)}/"):
        raise UsageError(f"--delta {dest}: lies within the audit: choose a folder outside {out}")
    if not is_url(dest) and Path(dest).exists() and not Path(dest).is_dir():
        raise UsageError(f"--delta {dest}: is a file: give a folder for the Delta tables")
    for table in TABLE_NAMES:
        where = _table_place(dest, table)
        _run_with_retries(where, partial(_open_table, where, table, run_id))


def write_tables(
    con: duckdb.DuckDBPyConnection,
    results: ResultStore,
    downloads: Path,
    dest: str,
    *,
    run_id: str,
    digest: str | None,
) -> DeltaChange:
    """Make the Delta tables in `dest` equal to the packed tables, with one commit for each table that differs.

    `con` has the views of `create_views`; `downloads` has local copies of the files. `digest`: the digest in the audit's summary.
    Only one process may write an audit's tables at a time. Errors: `UsageError` for a table of another program; `OutputError`.
    """
    ids = chunk_ids(results)
    n_added = n_removed = 0
    for table in TABLE_NAMES:
        names = ["rules.parquet"] if table == "rules" else [chunk_name(table, chunk_id) for chunk_id in ids]
        files = {_file_name_by_hash(file): file for file in (results.fetch(name, downloads) for name in names)}
        schema = con.table(table).limit(0).to_arrow_table().schema
        where = _table_place(dest, table)
        job = partial(_write_table, where, table, files, schema, run_id=run_id, digest=digest)
        change = _run_with_retries(where, job)
        n_added, n_removed = n_added + change.n_added, n_removed + change.n_removed
    return DeltaChange(n_added, n_removed)


def _write_table(
    where: str, table: str, files: dict[str, Path], schema: pa.Schema, *, run_id: str, digest: str | None
) -> DeltaChange:
    from deltalake import CommitProperties, Schema
    from deltalake.transaction import AddAction, RemoveAction, create_table_with_add_actions

    store, there = open_store(where), _open_table(where, table, run_id)
    active = {} if there is None else _sizes_of_active_files(there)
    now = int(time.time() * 1000)
    additions = []
    for name in sorted(files.keys() - active.keys()):
        content = files[name].read_bytes()
        store.write(name, content)
        stats = json.dumps({"numRecords": pq.read_metadata(pa.BufferReader(content)).num_rows})
        additions.append(AddAction(name, len(content), {}, now, data_change=True, stats=stats))
    removals = [RemoveAction(name, True, now, active[name], {}) for name in sorted(active.keys() - files.keys())]
    about = CommitProperties(custom_metadata={DIGEST_KEY: digest})
    if there is None:
        create_table_with_add_actions(
            _table_uri(where),
            Schema.from_arrow(schema),
            additions,
            name=_delta_lake_table_name(table),
            description=_delta_lake_table_description(run_id),
            storage_options=_STORAGE_OPTIONS,
            commit_properties=about,
        )
    elif additions or removals or _digest_of_newest_commit(store, there.version()) != digest:
        there.create_write_transaction([*additions, *removals], "append", there.schema(), commit_properties=about)
    return DeltaChange(len(additions), len(removals))


def _open_table(where: str, table: str, run_id: str) -> DeltaTable | None:
    """Return the Delta table at `where`; None: there is none. Errors: `UsageError` for a table of another audit or program."""
    from deltalake import DeltaTable
    from deltalake.exceptions import TableNotFoundError

    try:
        delta_table = DeltaTable(_table_uri(where), storage_options=_STORAGE_OPTIONS)
    except TableNotFoundError:
        return None
    about = delta_table.metadata()
    if (about.name, about.description) != (_delta_lake_table_name(table), _delta_lake_table_description(run_id)):
        of = (
            "by other rules, parameters or versions"
            if about.name == _delta_lake_table_name(table)
            else "that drivelint did not write"
        )
        raise UsageError(f"{where}: has a Delta table {of}: choose another --delta")
    return delta_table


def _sizes_of_active_files(table: DeltaTable) -> dict[str, int]:
    """Return the files of the table's newest version: name -> size in bytes."""
    actions = pa.table(table.get_add_actions(flatten=True)).select(["path", "size_bytes"])
    return {row["path"]: row["size_bytes"] for row in actions.to_pylist()}


def _digest_of_newest_commit(store: ResultStore, version: int) -> str | None:
    """Return the digest in the newest commit; None: it has none, or the commit file was deleted."""
    lines = (store.read(f"_delta_log/{version:020}.json") or b"").splitlines()
    infos = [info for line in lines if (info := json.loads(line).get("commitInfo"))]
    return infos[0].get(DIGEST_KEY) if infos else None


def _file_name_by_hash(file: Path) -> str:
    with file.open("rb") as content:
        return f"{hashlib.file_digest(content, 'sha256').hexdigest()}.parquet"


def _delta_lake_table_name(table: str) -> str:
    return f"drivelint {table}"


def _delta_lake_table_description(run_id: str) -> str:
    return f"audit {run_id}"


def _table_place(dest: str, table: str) -> str:
    return f"{dest.rstrip('/')}/{table}"


def _table_uri(where: str) -> str:
    """Return the URI of a place. The path of a local folder may contain any character."""
    return where if is_url(where) else Path(where).absolute().as_uri()


def _absolute_place(place: str) -> str:
    return place.rstrip("/") if is_url(place) else str(Path(place).resolve())


def _run_with_retries(where: str, job: Callable[[], T]) -> T:
    """Run a job on a Delta table, and repeat it if it fails: deltalake does not repeat a request whose answer was cut off.

    The job reads the state of the table anew each time. Errors: `OutputError`.
    """
    from deltalake.exceptions import DeltaError

    for attempt in range(_MAX_STORE_ATTEMPTS):
        try:
            return job()
        except (DeltaError, OSError) as error:
            if attempt + 1 == _MAX_STORE_ATTEMPTS:
                why = " ".join(_COLOUR_CODE.sub("", str(error)).split())[:300]
                raise OutputError(f"{where}: the Delta table failed: {why}: run the same command again") from error
    raise AssertionError("unreachable")
