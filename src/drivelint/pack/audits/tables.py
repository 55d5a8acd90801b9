"""The tables of an audit in a pack: checks their consistency, selects the worst findings, and returns one drive as a check's result."""

from __future__ import annotations

from dataclasses import fields
from itertools import pairwise
from operator import index
from pathlib import Path, PurePath
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import msgspec
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq

from drivelint.audit import JudgeSettings
from drivelint.audit.compact import chunk_ids, chunk_name
from drivelint.audit.driver import empty_tables
from drivelint.audit.run import AUDIT_FILE, RULES_FILE
from drivelint.audit.summary import summary_of_all_drives
from drivelint.audit.unpacked import SUMMARY_FILE
from drivelint.audit.worker import TABLES, receipt_fields
from drivelint.drive.trace import DriveInput
from drivelint.errors import UsageError
from drivelint.fleet.distinct_logs import COUNTED_PREFIX, create_counted_views
from drivelint.fleet_report.audit_views import open_audit_in_evidence_pack
from drivelint.fleet_report.rows import counted_finding_of_each_finding_sql, finding_per_event_sql
from drivelint.formats import expand_traces
from drivelint.formats.files import identify
from drivelint.formats.search import why_unreadable
from drivelint.pack.bag import DATA, Problem, sha256_of
from drivelint.pack.contents import (
    FINDING_ENTRY_COLUMNS,
    evidence_values_of_rules,
    phrase_on_findings_with_sql,
    sha256_by_path,
)
from drivelint.pack.inputs import request_with_present_paths
from drivelint.result.certainty import LEAST_SHARE_OF_COPIES_FOR_CERTAIN_FINDING
from drivelint.result.counts import group_rows
from drivelint.result.model import Result
from drivelint.result.request import RunRequest
from drivelint.sql.statements import statement
from drivelint.sql.store import arrow_schemas

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import duckdb

    from drivelint.audit.store import ResultStore
    from drivelint.fleet_report.audit_views import Audit
    from drivelint.pack.finding_sql import Row

AUDIT_FOLDER: Final = f"{DATA}/audit"
UNCHUNKED_FILES: Final = (AUDIT_FILE, SUMMARY_FILE, RULES_FILE)
FINDING_KEYS: Final = ("key", *FINDING_ENTRY_COLUMNS)
"""The fields of `evidence.json` about a finding of an audit. `key` identifies its drive."""
_SUMMARY_KEYS_NOT_FROM_TABLES: Final = frozenset({"reused", "n_asked", "n_absent"})
"""The keys of `summary.json` about the run that wrote it; they cannot be derived from the tables."""


class PackedDrive(NamedTuple):
    """A drive, as the result of a check, with those of its findings whose rows are in the pack. `receipt`: its row of `receipts`."""

    key: str
    receipt: Row
    result: Result
    check_request: RunRequest


def is_audit_folder(folder: Path) -> bool:
    """Return whether a folder was written by `audit --out`."""
    return (folder / AUDIT_FILE).is_file()


def is_pack_of_audit(folder: Path) -> bool:
    """Return whether a pack contains an audit."""
    return (folder / AUDIT_FOLDER).is_dir()


def packed_file_names(results: ResultStore) -> list[str]:
    """Return the files of an audit that a pack contains: its settings, summary and rules, and all chunks of its tables."""
    return [
        *UNCHUNKED_FILES,
        *(chunk_name(table, chunk_id) for table in (*TABLES, "receipts") for chunk_id in chunk_ids(results)),
    ]


def evidence_values_of_audit(
    folder: Path, con: duckdb.DuckDBPyConnection, audit: Audit, rules: Sequence[Row]
) -> dict[str, Any]:
    """Return the values of `evidence.json` that follow from the tables in the pack `folder`."""
    summary = summary_of_all_drives(con, 0)
    fail_on = str(audit.audit_json["fail_on"])
    not_judged = con.execute(statement("audit/not_judged")).to_arrow_table().to_pylist()
    return {
        "audit": audit.audit_json,
        "n_drives": summary.n_drives,
        "n_copies": summary.copies + summary.copies_not_judged,
        "n_lossy": summary.lossy,
        "n_findings": sum(summary.findings.values()),
        "not_judged": not_judged,
        "exit": {"code": int(summary.exit_code(fail_on, strict=False)), "fail_on": fail_on},
        **evidence_values_of_rules(folder, rules),
        "outputs": sha256_by_path(folder, AUDIT_FOLDER),
    }


def contradicted_summary_keys(
    con: duckdb.DuckDBPyConnection, audit: Audit, packed_summary: dict[str, Any]
) -> list[str]:
    """Return the keys of `summary.json` that contradict the tables."""
    values = summary_of_all_drives(con, 0).file_content() | {"robust": bool(audit.settings["robustness"])}
    return sorted(
        key
        for key in (values.keys() | packed_summary.keys()) - _SUMMARY_KEYS_NOT_FROM_TABLES
        if packed_summary.get(key) != values.get(key)
    )


def receipt_problems(results: ResultStore, rules: pa.Table, *, same_libraries: bool) -> Iterator[Problem]:
    """Yield the differences between receipts and the rows of their drives, chunk by chunk.

    `same_libraries`: also compare the hashes of the rows, which depend on the version of pyarrow.
    """
    stable = rules.filter(pc.equal(rules["status"], "stable"))["rule_id"].combine_chunks()
    schemas = {table: rows.schema for table, rows in empty_tables().items()}
    checked_keys: set[str] = set()
    for chunk in chunk_ids(results):
        with TemporaryDirectory(prefix="drivelint-pack-") as home:
            parts = {}
            for table in (*TABLES, "receipts"):
                rows = pq.read_table(results.fetch(chunk_name(table, chunk), Path(home)), partitioning=None)
                parts[table] = _rows_by_drive_key(rows.cast(schemas[table]) if table in schemas else rows)
        receipts = {key: part.to_pylist() for key, part in parts.pop("receipts").items()}
        for key in sorted({*receipts, *(key for part in parts.values() for key in part)}):
            rows_of_key = {table: parts[table].get(key, schemas[table].empty_table()) for table in TABLES}
            is_one = len(receipts.get(key, ())) == rows_of_key["drives"].num_rows == 1 and key not in checked_keys
            checked_keys.add(key)
            if not is_one:
                yield Problem(
                    "receipts do not match the tables", f"{key}: a drive has one receipt and one row in drives"
                )
                continue
            for field in _differing_receipt_fields(
                receipts[key][0], receipt_fields(rows_of_key, stable), same_libraries=same_libraries
            ):
                yield Problem("receipts do not match the tables", f"{receipts[key][0]['drive_id']} ({key}): {field}")


def _differing_receipt_fields(receipt: Row, due: dict[str, Any], *, same_libraries: bool) -> list[str]:
    """Return the fields of a receipt that differ from `due`, the values computed from the drive's rows."""
    values = {name: dict(value) if isinstance(due.get(name), dict) else value for name, value in receipt.items()}
    if values["status"] == "quarantined" and due["status"] == "refused":
        due |= {"status": "quarantined"}
        if str(due["reason"]).endswith(str(values["reason"])):  # the row has the log's name in front
            due |= {"reason": values["reason"]}
    if not same_libraries:
        due.pop("rows_sha256")
    return sorted(name for name, value in due.items() if values.get(name) != value)


def _rows_by_drive_key(rows: pa.Table) -> dict[str, pa.Table]:
    """Return key -> its rows. The rows of a key are contiguous, as in chunks."""
    key_counts = pc.value_counts(rows["key"]).to_pylist()
    ends = [0]
    for key_count in key_counts:
        ends.append(ends[-1] + key_count["counts"])
    return {
        key_count["values"]: rows.slice(a, b - a) for key_count, (a, b) in zip(key_counts, pairwise(ends), strict=True)
    }


def worst_findings(con: duckdb.DuckDBPyConnection, max_findings: int | None) -> list[Row]:
    """Return the rows of the worst findings, each with the key of its drive, in the order of reports.

    Findings are counted as in the summary of the audit: a finding that copies of a log share has only the row of the first of them, and an
    overtake under two profiles is one finding with two rows. `max_findings`: None: all findings.
    """
    create_counted_views(con)
    sql = statement(
        "audit/worst_findings",
        event=finding_per_event_sql(COUNTED_PREFIX),
        counted_id=counted_finding_of_each_finding_sql(COUNTED_PREFIX),
        least_share=str(LEAST_SHARE_OF_COPIES_FOR_CERTAIN_FINDING),
    )
    worst: list[Row] = con.execute(sql, {"most": max_findings}).to_arrow_table().to_pylist()
    return worst


def n_packed_findings(evidence: dict[str, Any]) -> int:
    """Return how many findings have their rows in a pack. Errors: `TypeError` if `evidence.json` has no whole numbers."""
    return index(evidence["n_findings"]) - index(evidence["findings_left_out"])


def n_copies_without_findings(con: duckdb.DuckDBPyConnection, findings: Sequence[Row]) -> int:
    """Return how many judged drives repeat the log of another one and have none of these findings, which are from `worst_findings`."""
    sql = "SELECT count(*) FROM counted_key JOIN drives USING (key) WHERE no > 1 AND status = 'judged' AND NOT list_contains($keys, key)"
    ((n,),) = con.execute(sql, {"keys": sorted({row["key"] for row in findings})}).fetchall()
    return int(n)


def packed_findings_text(pack_folder: Path, evidence: dict[str, Any]) -> str:
    """Return in words how many of the findings in the pack of an audit have SQL."""
    with open_audit_in_evidence_pack(pack_folder / AUDIT_FOLDER) as (con, _):
        return phrase_on_findings_with_sql(worst_findings(con, n_packed_findings(evidence)), evidence["findings"])


def packed_drives(
    con: duckdb.DuckDBPyConnection, audit: Audit, rules: pa.Table, findings: Sequence[Row], rules_dirs: tuple[Path, ...]
) -> Iterator[PackedDrive]:
    """Yield the drives of these findings as results of checks. `rules_dirs`: the present paths of the folders of rules."""
    for key, rows in group_rows(findings, lambda row: row["key"]).items():
        (receipt,), (drive,) = (
            con.execute(f"FROM {table} WHERE key = ?", [key]).to_arrow_table().to_pylist()
            for table in ("receipts", "drives")
        )
        finding_rows = [{name: value for name, value in row.items() if name != "key"} for row in rows]
        about = {name: value for name, value in drive.items() if name not in {"key", "log", "tags"}}
        result = Result(
            verdicts=arrow_schemas()["verdict"].empty_table(),
            findings=pa.Table.from_pylist(finding_rows, schema=arrow_schemas()["finding"]),
            drives=pa.Table.from_pylist([about], schema=arrow_schemas()["drive"]),
            rules=rules,
            fail_on=str(audit.audit_json["fail_on"]),
        )
        yield PackedDrive(key, receipt, result, equivalent_check_request(audit, receipt, rules_dirs))


def equivalent_check_request(audit: Audit, receipt: Row | None, rules_dirs: tuple[Path, ...]) -> RunRequest:
    """Return the request of a check that has the same result as the audit for the drive of a receipt. `receipt`: None: a request without a
    drive."""
    options = msgspec.json.decode(
        (receipt or {}).get("options") or "{}", type=DriveInput, dec_hook=lambda kind, value: kind(value)
    )
    values = {field.name: getattr(options, field.name) for field in fields(DriveInput)}
    settings = judge_settings(audit)
    traces = {} if receipt is None else {receipt["drive_id"]: receipt["log"]}
    return RunRequest(
        **values,
        traces=traces,
        profiles=settings.profiles,
        params=settings.params,
        rules_dirs=rules_dirs,
        robustness=settings.robustness,
    )


def judge_settings(audit: Audit) -> JudgeSettings:
    """Return the settings that determined the verdicts of an audit, with the original paths of the folders of rules."""
    return msgspec.convert(audit.settings, JudgeSettings, dec_hook=lambda kind, value: kind(value))


def given_logs_by_key(
    con: duckdb.DuckDBPyConnection, findings: Sequence[Row], log_paths: Sequence[Path]
) -> dict[str, Path]:
    """Return key of a drive -> path of its given log, for the drives with these findings. Folders are searched.

    If several given logs have the hash of the drive's log, the one with its name is taken: the name is a part of the rows. Files of other
    sizes are not read. Errors: `UsageError` if no log belongs to such a drive; `TraceError` for a missing path.
    """
    if not log_paths:
        return {}
    keys = sorted({row["key"] for row in findings})
    sql = "SELECT key, log, log_sha256, size FROM receipts WHERE list_contains($keys, key)"
    receipts = con.execute(sql, {"keys": keys}).fetchall()
    sizes = {size for _, _, _, size in receipts}
    there = [path for path in expand_traces(list(map(str, log_paths))) if why_unreadable(path) is None]
    likely = [path for path in there if path.is_dir() or path.stat().st_size in sizes]
    by_digest = group_rows(likely, lambda path: identify(path).sha256)
    path_by_key = {
        key: max(by_digest[digest], key=lambda path: path.name == PurePath(log).name)
        for key, log, digest, _ in receipts
        if digest in by_digest
    }
    if not path_by_key:
        raise UsageError(f"--trace {log_paths[0]}: no log there belongs to a drive with a finding in the pack")
    return path_by_key


def drive_request_with_present_paths(drive: PackedDrive, log: Path | None, map_: Path | None) -> RunRequest:
    """Return the check of a drive with the present paths of its log and map, after comparing both with their hashes.

    `log`: None: the original path. `map_`: used only if the drive was judged on this map. Errors: as `request_with_present_paths`.
    """
    if map_ is not None and (not map_.is_file() or sha256_of(map_) != drive.receipt["map_sha256"]):
        map_ = None
    return request_with_present_paths(
        drive.check_request, drive.result.drives.to_pylist(), () if log is None else (log,), map_
    )
