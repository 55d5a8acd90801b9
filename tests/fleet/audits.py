"""Audits as `drivelint.fleet` sees them: views over the results of `check`, or over small tables made by hand."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import duckdb
import pyarrow as pa

from drivelint.sql.store import arrow_schemas
from tests.report.synthetic import drive, finding, verdict

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path

Row = dict[str, Any]


def add_results(
    con: duckdb.DuckDBPyConnection, folder: Path, of: str = "", tags: Callable[[Row], Mapping[str, str]] = lambda _: {}
) -> None:
    """Make the views of an audit of what `check --out` wrote."""
    drives = con.execute("SELECT drive_id, file_name FROM read_parquet(?) ORDER BY ALL", [f"{folder}/drives.parquet"])
    told = [dict(zip(("drive_id", "file_name"), row, strict=True)) for row in drives.fetchall()]
    con.execute(f"CREATE TABLE {of}tagged (drive_id VARCHAR, tags MAP(VARCHAR, VARCHAR))")
    for row in told:
        con.execute(f"INSERT INTO {of}tagged VALUES (?, ?)", [row["drive_id"], tags(row)])
    con.execute(
        f"CREATE VIEW {of}drives AS SELECT d.*, d.drive_id AS key, d.file_name AS log, t.tags "
        f"FROM '{folder}/drives.parquet' d JOIN {of}tagged t USING (drive_id)"
    )
    for name in ("verdicts", "findings"):
        con.execute(f"CREATE VIEW {of}{name} AS SELECT *, drive_id AS key FROM '{folder}/{name}.parquet'")
    con.execute(f"CREATE VIEW {of}rules AS FROM '{folder}/rules.parquet'")


def add_rows(
    con: duckdb.DuckDBPyConnection,
    drives: list[Row],
    verdicts: list[Row],
    findings: list[Row],
    rules: list[Row],
    *,
    of: str = "",
) -> None:
    """Make the tables of an audit of rows by hand; a row's drive_id is its key. `drives`: with `tags`, a dictionary."""
    tags = pa.map_(pa.string(), pa.string())
    for name, table, rows in (
        ("drives", "drive", drives),
        ("verdicts", "verdict", verdicts),
        ("findings", "finding", findings),
        ("rules", "rule", rules),
    ):
        schema = arrow_schemas()[table]
        if name != "rules":
            schema = schema.append(pa.field("key", pa.string()))
        if name == "drives":
            schema = schema.append(pa.field("log", pa.string())).append(pa.field("tags", tags))
        full = [{"key": row.get("drive_id"), "log": row.get("file_name")} | row for row in rows]
        full = [row | {"tags": list((row.get("tags") or {}).items())} if name == "drives" else row for row in full]
        con.register(f"{of}{name}_rows", pa.Table.from_pylist(full, schema=schema))
        con.execute(f"CREATE TABLE {of}{name} AS FROM {of}{name}_rows")


def ego_drive(name: str, km: float = 100.0, hours: float = 2.0, **over: Any) -> dict[str, Any]:
    way = {
        "ego_id": "1",
        "km": km,
        "hours": hours,
        "engaged_km": over.pop("engaged_km", km),
        "engaged_hours": hours,
        "n_steps": 9,
    }
    return drive(name, **({"sha256": name, "exposure": [way], "tags": {"release": "a"}} | over))


def drive_verdict(drive_id: str, word: str, **over: Any) -> dict[str, Any]:
    return verdict(word, **({"drive_id": drive_id, "profile": None} | over))


def drive_finding(drive_id: str, **over: Any) -> dict[str, Any]:
    times = dict.fromkeys(("t_start_ns", "t_end_ns", "t_worst_ns"), 0)
    return finding(**({"drive_id": drive_id, "profile": None, "finding_id": drive_id} | times | over))
