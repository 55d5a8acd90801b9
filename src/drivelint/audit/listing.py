"""Lists the drives of the sources in a database table, which is compared with the receipts."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import msgspec
import pyarrow as pa

from drivelint.audit import sources
from drivelint.audit.bucket import find_object, is_url
from drivelint.audit.identity import OptionHashes
from drivelint.audit.model import AuditDrive, digest
from drivelint.drive.trace import DriveInput
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import duckdb

_ROWS_PER_INSERT: Final = 20_000


def fill_listed_drives(
    con: duckdb.DuckDBPyConnection,
    source_names: Sequence[str],
    options: DriveInput,
    run_id: str,
    shard: tuple[int, int] | None,
) -> int:
    """Fill the table `_listed` with the drives of the sources, or of one shard. Return the number of drives."""
    con.execute(statement("audit/listed"))
    hashes = OptionHashes()
    some: list[dict[str, Any]] = []
    for drive in sources.drives(source_names, options):
        if shard and int(digest(drive.log)[:8], 16) % shard[1] != shard[0] - 1:
            continue
        options_id = hashes.hash_of(drive.options)
        size, stamp = (drive.size, drive.stamp) if drive.stamp else _size_and_stamp(drive.log)
        drive_with_ids = drive.with_ids(size, stamp, run_id, options_id)
        some.append(
            {
                "source_id": drive_with_ids.source_id,
                "log": drive_with_ids.log,
                "size": size,
                "stamp": stamp,
                "options_id": options_id,
                "options": drive.options_json,
                "tags": sorted(drive.tags.items()),
            }
        )
        if len(some) >= _ROWS_PER_INSERT:
            _insert_drives(con, some)
            some = []
    if some:
        _insert_drives(con, some)
    (n,) = con.execute("SELECT count(*) FROM _listed").fetchall()[0]
    return int(n)


def _insert_drives(con: duckdb.DuckDBPyConnection, rows: list[dict[str, Any]]) -> None:
    text = ("source_id", "log", "stamp", "options_id", "options")
    schema = pa.schema(
        [(name, pa.string()) for name in text] + [("size", pa.int64()), ("tags", pa.map_(pa.string(), pa.string()))]
    )
    con.register("_some", pa.Table.from_pylist(rows, schema=schema))
    con.execute("INSERT INTO _listed BY NAME FROM _some")
    con.unregister("_some")


def unjudged_drives(con: duckdb.DuckDBPyConnection) -> Iterator[AuditDrive]:
    """Yield the listed drives that have no receipt, ordered by log."""
    rows = con.cursor().execute(statement("audit/todo"))
    for batch in rows.to_arrow_reader(1_000):
        for row in batch.to_pylist():
            options = msgspec.json.decode(row["options"], type=DriveInput, dec_hook=lambda kind, value: kind(value))
            tags = dict(row["tags"])
            yield AuditDrive(row["log"], options, tags, row["size"], row["stamp"], row["source_id"], row["options_id"])


def _size_and_stamp(log: str) -> tuple[int, str]:
    """Return a log's size in bytes, and the time of its last change or its ETag; (0, "") if the log cannot be read."""
    if is_url(log):
        remote = find_object(log)
        return (0, "") if remote is None else (remote.size, remote.e_tag)
    path = Path(log)
    try:
        files = sorted(file for file in path.rglob("*") if file.is_file()) if path.is_dir() else [path]
        about = [(file.stat().st_size, file.stat().st_mtime_ns) for file in files]
    except OSError:
        return 0, ""
    return sum(size for size, _ in about), str(max((mtime for _, mtime in about), default=0))
