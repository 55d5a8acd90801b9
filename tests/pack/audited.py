"""An audit of a small fleet, packed, and what somebody who tampers with such a pack does."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, NamedTuple

import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq

from drivelint.audit.driver import empty_tables
from drivelint.audit.summary import summary_of_all_drives
from drivelint.audit.worker import TABLES, receipt_fields
from drivelint.fleet_report.audit_views import open_audit_in_evidence_pack
from drivelint.pack.audits.statement import in_toto_statement
from drivelint.pack.signature import private_key, signed_envelope
from tests.audit import fleet
from tests.audit.here import InThisProcess, run_audit
from tests.pack.packed import STATEMENT, change_evidence, make_key, make_pack, rehash

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

N_DRIVES, SEED = 6, 12
CONTACT, LOSSY_CONTACT = "drive-00001.parquet", "drive-00004.parquet"
LOSSY, REFUSED, QUARANTINED = "drive-00002.parquet", "drive-00003.parquet", "drive-00005.parquet"
AUDIT = "data/audit"


class PackedAudit(NamedTuple):
    """An audit with two contacts, one in a lossy drive; a lossy drive without, a log that cannot be read, one that kills workers."""

    drives: fleet.Fleet
    audit: Path
    pack: Path
    key: Path
    public: Path
    other_key: Path


def write_audit(folder: Path) -> PackedAudit:
    """Judge the fleet and pack its audit with the logs."""
    drives = fleet.write(folder / "fleet", N_DRIVES, seed=SEED)
    assert drives.planted == {CONTACT, LOSSY_CONTACT}
    logs = folder / "fleet/logs"
    for name in (LOSSY, LOSSY_CONTACT):
        rows = pq.read_table(logs / name)
        times = rows["t_ns"].to_pylist()
        pq.write_table(rows.set_column(3, "t_ns", pa.array([*times[:-1], None], pa.int64())), logs / name)
    (logs / REFUSED).write_bytes(b"<html>not found</html>")
    run_audit(drives, folder / "audit", InThisProcess(poison=QUARANTINED))
    key, public = make_key(folder, "ours")
    pack = make_pack(folder / "audit", folder / "pack", key, with_inputs=True)
    return PackedAudit(drives, folder / "audit", pack, key, public, make_key(folder, "theirs")[0])


def table_of(pack: Path, table: str) -> Path:
    (file,) = (pack / AUDIT / "tables" / table).iterdir()
    return file


def keep_rows(pack: Path, table: str, keep: Callable[[dict[str, Any]], bool]) -> None:
    """Remove rows of a table of the audit."""
    file = table_of(pack, table)
    rows = pq.read_table(file)
    pq.write_table(rows.filter(pa.array([keep(row) for row in rows.to_pylist()], pa.bool_())), file)


def change_json(path: Path, change: Callable[[dict[str, Any]], None]) -> None:
    content = json.loads(path.read_bytes())
    change(content)
    path.write_text(json.dumps(content, indent=2, sort_keys=True) + "\n", encoding="utf-8")


def follow_rows(pack: Path) -> None:
    """Let the receipts of judged drives say what the changed tables say."""
    file = table_of(pack, "receipts")
    receipts = pq.read_table(file)
    stable = pq.read_table(pack / AUDIT / "rules.parquet")["rule_id"].combine_chunks()
    tables = {table: pq.read_table(table_of(pack, table)).cast(empty_tables()[table].schema) for table in TABLES}
    told = []
    for row in receipts.to_pylist():
        mine = {table: rows.filter(pc.equal(rows["key"], row["key"])) for table, rows in tables.items()}
        said = receipt_fields(mine, stable) if row["status"] == "judged" else {}
        plain = {key: [*value.items()] if isinstance(value, dict) else value for key, value in said.items()}
        told.append({**row, **plain})
    pq.write_table(pa.Table.from_pylist(told, schema=receipts.schema), file)


def follow_tables(pack: Path) -> None:
    """Let the summary and the hashes in `evidence.json` say what the changed tables say."""
    with open_audit_in_evidence_pack(pack / AUDIT) as (con, _):
        counted = summary_of_all_drives(con, 0)
    change_json(pack / AUDIT / "summary.json", lambda summary: summary.update(counted.file_content()))
    change_evidence(pack, lambda _evidence: None)


def sign_anew(pack: Path, key: Path) -> None:
    """Let the statement follow from the changed pack, and sign it: what the owner of a key can forge."""
    rehash(pack)
    said = in_toto_statement(pack, json.loads((pack / "data/evidence.json").read_text("utf-8")))
    (pack / STATEMENT).write_bytes(signed_envelope(said, private_key(key)))
    rehash(pack, payload=False)
