"""Verifies the pack of an audit: its tables, its statement, and the drives whose logs are available."""

from __future__ import annotations

import json
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import PurePath
from typing import TYPE_CHECKING, Any, Final

import duckdb
import msgspec
import pyarrow.parquet as pq

from drivelint import __version__
from drivelint.audit.identity import run_id, versions
from drivelint.audit.run import RULES_FILE
from drivelint.audit.store import LocalFolder
from drivelint.audit.unpacked import SUMMARY_FILE
from drivelint.audit.worker import TABLES, rows_sha256, with_key
from drivelint.errors import DriveLintError, UsageError
from drivelint.fleet_report.audit_views import open_audit_in_evidence_pack
from drivelint.pack import consistency, reproduction, signature
from drivelint.pack.audits import tables
from drivelint.pack.audits.statement import in_toto_statement
from drivelint.pack.bag import DATA, Problem
from drivelint.pack.consistency import READ_ERRORS
from drivelint.pack.contents import (
    AUDIT_FORMAT_VERSION,
    EVIDENCE_FILE,
    FINDINGS_FOLDER,
    library_versions,
    path_inside_pack,
)
from drivelint.pack.statement import ENVELOPE_FILE, STATEMENT_FILE, statement_problems
from drivelint.phrases import name_list, plural

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    import pyarrow as pa

    from drivelint.catalogue import Rule
    from drivelint.fleet_report.audit_views import Audit
    from drivelint.pack.finding_sql import Row
    from drivelint.pack.request import VerifyRequest
    from drivelint.result.model import Result
    from drivelint.result.request import RunRequest

_READ_ERRORS: Final = (*READ_ERRORS, duckdb.Error, msgspec.MsgspecError, DriveLintError)
_UNDERIVED_EVIDENCE_KEYS: Final = frozenset({
    "evidence", "packed_with", "mappings", "rules_dirs", "inputs", "findings", "findings_left_out", "left_out",
})  # fmt: skip


@dataclass
class _AuditPack:
    """The opened pack of an audit, with counts of what was verified.

    `rules_by_id`: the rules that judged; None: this drivelint has other rules. `packed_by`: version of drivelint that wrote the pack.
    `n_copies`: number of judged drives without a finding in the pack whose log has the content of another one.
    `n_judged`: number of drives that were judged again. `n_alone`: number of drives without a log, for which only the findings' SQL was
    run. `n_run`: number of their findings.
    """

    folder: Path
    con: duckdb.DuckDBPyConnection
    audit: Audit
    evidence: dict[str, Any]
    rules: pa.Table
    rules_dirs: tuple[Path, ...]
    rules_by_id: dict[str, Rule] | None
    packed_by: str
    n_copies: int = 0
    n_judged: int = 0
    n_alone: int = 0
    n_run: int = 0
    other_bytes: bool = False


def verify_audit_pack(request: VerifyRequest) -> tuple[list[Problem], str, str, list[str]]:
    """Return the problems, a phrase about the drives judged again, the result stated in the pack, and notes on what was not examined.

    Errors: `UsageError` for given logs or a given map that belong to no drive in the pack.
    """
    with ExitStack() as stack:
        try:
            con, audit = stack.enter_context(open_audit_in_evidence_pack(request.folder / tables.AUDIT_FOLDER))
            evidence = consistency.read_evidence(request.folder, AUDIT_FORMAT_VERSION)
            rules = pq.read_table(request.folder / tables.AUDIT_FOLDER / RULES_FILE)
            dirs = tuple(path_inside_pack(request.folder, place) for place in evidence["rules_dirs"])
            packed_by = consistency.packing_version(evidence)
            pack = _AuditPack(request.folder, con, audit, evidence, rules, dirs, _rules_by_id(rules, dirs), packed_by)
            findings = tables.worst_findings(con, tables.n_packed_findings(evidence))
            pack.n_copies = tables.n_copies_without_findings(con, findings)
            wrong = [*_problems_of_tables(pack), *_problems_of_evidence(pack, findings)]
            due = in_toto_statement(pack.folder, evidence)
            wrong = _problems_of_statement(pack.folder, due) + wrong
            outcome = str(json.loads(due)["predicate"]["result"])
        except _READ_ERRORS as error:
            return [Problem("result not readable", str(error))], "", "", []
        if wrong:
            return wrong, "not judged again", "", []
        logs = tables.given_logs_by_key(con, findings, request.traces)
        try:
            for drive in tables.packed_drives(con, audit, rules, findings, dirs):
                wrong += _problems_of_drive(pack, drive, logs.get(drive.key), request.map)
        except msgspec.MsgspecError as error:
            wrong.append(Problem("receipts not readable", str(error)))
        return wrong, _judged_again_phrase(pack), outcome, _notes_on_unexamined(pack)


def _problems_of_tables(pack: _AuditPack) -> Iterator[Problem]:
    """Yield the contradictions between the tables, receipts, rules and summary of the audit."""
    place = pack.folder / tables.AUDIT_FOLDER
    audit_json = pack.audit.audit_json
    summary = json.loads((place / SUMMARY_FILE).read_bytes())
    for key in tables.contradicted_summary_keys(pack.con, pack.audit, summary):
        yield Problem("summary.json does not match the tables", key)
    yield from tables.receipt_problems(LocalFolder(place), pack.rules, same_libraries=_has_same_pyarrow(pack))
    if pack.rules_by_id is not None:
        check_request = tables.equivalent_check_request(pack.audit, None, pack.rules_dirs)
        if why := consistency.rules_contradiction(list(pack.rules_by_id.values()), pack.rules, check_request):
            yield Problem("audit.json does not match the result", why)
    settings = replace(tables.judge_settings(pack.audit), rules_dirs=pack.rules_dirs)
    if audit_json["versions"] == versions() and audit_json["run_id"] != run_id(settings):
        yield Problem("audit.json does not match the result", "run_id")


def _problems_of_evidence(pack: _AuditPack, findings: Sequence[Row]) -> Iterator[Problem]:
    """Yield the contradictions between `evidence.json` and the tables, and the files that are not named anywhere."""
    folder, evidence = pack.folder, pack.evidence
    due = tables.evidence_values_of_audit(folder, pack.con, pack.audit, pack.rules.to_pylist())
    due["findings_left_out"] = max(due["n_findings"] - tables.n_packed_findings(evidence), 0)
    finding_keys = [{key: row[key] for key in tables.FINDING_KEYS} for row in findings]
    keys = consistency.differing_evidence_keys(evidence, due, finding_keys, pack.rules.to_pylist())
    inputs = evidence["inputs"] or {"traces": {}, "maps": {}}
    of_findings = {row["key"] for row in findings}
    if evidence["inputs"] is not None and inputs["traces"].keys() != of_findings:
        keys.append("inputs")
    for key in [*keys, *sorted(evidence.keys() - due.keys() - _UNDERIVED_EVIDENCE_KEYS)]:
        yield Problem("evidence.json does not match the result", key)
    files_of_evidence = {EVIDENCE_FILE, *due["outputs"], *(rule["file"] for rule in evidence["rules"])}
    places = [
        *evidence["rules_dirs"],
        *evidence["mappings"].values(),
        *inputs["traces"].values(),
        *inputs["maps"].values(),
    ]
    input_folders = tuple(f"{DATA}/{name}/" for name in ("mapping", "rules_dirs", "inputs"))
    of_audit = {
        f"{tables.AUDIT_FOLDER}/{name}" for name in tables.packed_file_names(LocalFolder(folder / tables.AUDIT_FOLDER))
    }
    files_of_evidence -= {name for name in due["outputs"] if name not in of_audit}
    yield from consistency.unnamed_files(
        folder, evidence, files_of_evidence, [place for place in places if place.startswith(input_folders)]
    )


def _problems_of_statement(folder: Path, due: bytes) -> list[Problem]:
    name = ENVELOPE_FILE if (folder / ENVELOPE_FILE).is_file() else STATEMENT_FILE
    if not (folder / name).is_file():
        return [Problem("statement missing", STATEMENT_FILE)]
    content = (folder / name).read_bytes()
    return statement_problems(signature.payload_of_envelope(content) if name == ENVELOPE_FILE else content, due)


def _problems_of_drive(
    pack: _AuditPack, drive: tables.PackedDrive, log: Path | None, map_: Path | None
) -> list[Problem]:
    """Judge a drive again, or, without its log, run the SQL of its findings. Return the problems.

    Errors: `UsageError` if a log was given but its map cannot be found.
    """
    inputs = pack.evidence["inputs"]
    try:
        drive = drive._replace(check_request=_request_with_pack_paths(pack, drive))
    except READ_ERRORS as error:
        return [Problem("evidence.json not readable", str(error))]
    if log is None and inputs is None:
        return _problems_of_finding_sql(pack, drive)
    try:
        check_request = tables.drive_request_with_present_paths(drive, log, map_)
    except UsageError as error:
        if log is not None:
            raise
        return [Problem("inputs do not match the result", str(error))]
    pack.n_judged += 1
    try:
        fresh = reproduction.check_again(drive.result, check_request, None, evidence=False)
        evidence = reproduction.evidence_of_findings(
            drive.result, check_request, loaded_rules=[*(pack.rules_by_id or {}).values()]
        )
    except DriveLintError as error:
        return [Problem("result not reproduced", str(error))]
    wrong = (
        []
        if _has_same_rows_as_audit(pack, drive, fresh)
        else [
            Problem("result not reproduced", f"the rows of {_drive_name_and_key(drive)}{_renaming_phrase(drive, log)}")
        ]
    )
    place = f"{FINDINGS_FOLDER}/{drive.key}"
    files = {
        f"{place}/{name}/{file}": content
        for name, contents in evidence.items()
        if isinstance(contents, dict)
        for file, content in contents.items()
    }
    other_libraries = pack.evidence["packed_with"] != library_versions()
    differing, other_bytes = reproduction.file_problems_and_whether_bytes_differ(
        pack.folder, files, {}, other_libraries=other_libraries
    )
    pack.other_bytes |= other_bytes
    there = {path.relative_to(pack.folder).as_posix() for path in (pack.folder / place).rglob("*") if path.is_file()}
    extra = sorted(there - files.keys())
    return [*wrong, *differing, *(Problem("result not reproduced", f"{path}: no finding gives it") for path in extra)]


def _request_with_pack_paths(pack: _AuditPack, drive: tables.PackedDrive) -> RunRequest:
    """Return the check of a drive with the paths of the files in the pack. Errors: `ValueError` for a path outside the pack."""
    check_request = drive.check_request
    if drive.key in pack.evidence["mappings"]:
        check_request = replace(
            check_request, mapping=str(path_inside_pack(pack.folder, pack.evidence["mappings"][drive.key]))
        )
    if (inputs := pack.evidence["inputs"]) is not None:
        road = path_inside_pack(pack.folder, inputs["maps"][drive.key]) if drive.key in inputs["maps"] else None
        is_folder = road is not None and road.is_dir()
        traces = {drive.receipt["drive_id"]: str(path_inside_pack(pack.folder, inputs["traces"][drive.key]))}
        check_request = replace(
            check_request, traces=traces, map=None if is_folder else road, map_dir=road if is_folder else None
        )
    return check_request


def _problems_of_finding_sql(pack: _AuditPack, drive: tables.PackedDrive) -> list[Problem]:
    """Run the SQL of a drive's findings on the rows in the pack, and return the findings with other numbers."""
    pack.n_alone += 1
    if pack.rules_by_id is None:
        return []
    rows = {f"{FINDINGS_FOLDER}/{drive.key}/{row['finding_id']}": row for row in drive.result.findings.to_pylist()}
    wrong, n = consistency.check_sql_in_folders(pack.folder, rows, pack.rules_by_id, drive.check_request)
    pack.n_run += n
    return wrong


def _rules_by_id(rules: pa.Table, rules_dirs: tuple[Path, ...]) -> dict[str, Rule] | None:
    try:
        return {rule.id: rule for rule in reproduction.rules_of_table(rules, rules_dirs)}
    except UsageError:
        return None


def _has_same_rows_as_audit(pack: _AuditPack, drive: tables.PackedDrive, fresh: Result) -> bool:
    """Return whether the new result of a drive has the same rows as the audit."""
    rows = {table: with_key(getattr(fresh, table), drive.key, None) for table in TABLES}
    if rows_sha256(rows) == drive.receipt["rows_sha256"]:
        return True
    pack.other_bytes = True
    return not _has_same_pyarrow(pack) and all(
        pack.con.execute(f"FROM {table} WHERE key = ?", [drive.key])
        .to_arrow_table()
        .select(of.column_names)
        .to_pylist()
        == of.to_pylist()
        for table, of in rows.items()
    )


def _has_same_pyarrow(pack: _AuditPack) -> bool:
    return bool(pack.audit.audit_json["versions"].get("pyarrow") == versions()["pyarrow"])


def _drive_name_and_key(drive: tables.PackedDrive) -> str:
    return f"{drive.receipt['drive_id']} ({drive.key})"


def _renaming_phrase(drive: tables.PackedDrive, log: Path | None) -> str:
    """Return a phrase that says that a given log has another name than when it was judged; '' if it has not."""
    name = PurePath(drive.receipt["log"]).name
    return "" if log is None or log.name == name else f": {log} was named {name} when it was judged: give it this name"


def _judged_again_phrase(pack: _AuditPack) -> str:
    if not pack.n_judged:
        return "not judged again"
    same = "the same rows, written by another version of a library" if pack.other_bytes else "the same bytes"
    return f"{pack.n_judged} of {plural(pack.evidence['n_drives'] - pack.n_copies, 'drive')} judged again: {same}"


def _notes_on_unexamined(pack: _AuditPack) -> list[str]:
    """Return notes on results that were not compared with the logs, on other versions, and on rules that are not drivelint's own."""
    notes, evidence, audit_versions = [], pack.evidence, pack.audit.audit_json["versions"]
    if pack.n_alone:
        ran = (
            f"{plural(pack.n_run, 'finding')} of theirs gave the numbers from the rows in the pack"
            if pack.rules_by_id is not None
            else "the SQL of their findings was not run: this drivelint has other rules"
        )
        notes.append(f"{plural(pack.n_alone, 'drive')} without a log: judged again only with --trace and --map; {ran}")
    assurance = (
        "not judged again; their rows have the hashes in the receipts"
        if _has_same_pyarrow(pack)
        else "not judged again; the hashes of their rows were not compared, as another pyarrow wrote them"
    )
    ((n_refused,),) = pack.con.execute("SELECT count(*) FROM receipts WHERE status <> 'judged'").fetchall()
    if rest := evidence["n_drives"] - n_refused - pack.n_copies - pack.n_judged - pack.n_alone:
        notes.append(f"{plural(rest, 'drive')} without a finding in the pack: {assurance}")
    if pack.n_copies:
        notes.append(f"{plural(pack.n_copies, 'log')} with the content of another log, counted once: {assurance}")
    if left := evidence["findings_left_out"]:
        notes.append(f"{plural(left, 'finding')} of less weight: no rows in the pack")
    if evidence["not_judged"]:
        names = name_list([row["log"] for row in evidence["not_judged"]], 3)
        of = f" ({plural(n_refused, 'drive')})" if n_refused > len(evidence["not_judged"]) else ""
        notes.append(f"not judged when it was audited, nor now: {names}{of}")
    if other_versions := sorted(name for name, value in versions().items() if audit_versions.get(name) != value):
        notes.append(f"audited by other versions of {', '.join(other_versions)}")
    if pack.packed_by != __version__:
        notes.append(f"packed by drivelint {pack.packed_by}, and this is {__version__}")
    if evidence["rules_dirs"]:
        notes.append(f"rules and profiles in {', '.join(evidence['rules_dirs'])} are not drivelint's: read them")
    return notes
