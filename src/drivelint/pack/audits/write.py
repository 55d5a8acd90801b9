"""Writes the content of the pack of an audit: its tables, the rules, and the data that reproduce its worst findings."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pyarrow.parquet as pq

from drivelint.audit.run import RULES_FILE
from drivelint.audit.store import LocalFolder
from drivelint.audit.unpacked import SUMMARY_FILE
from drivelint.errors import UsageError
from drivelint.fleet_report.audit_views import open_audit_in_evidence_pack, open_audits
from drivelint.pack import contents, reproduction
from drivelint.pack.audits import tables
from drivelint.pack.audits.statement import in_toto_statement
from drivelint.pack.copying import copy_into_new_folder, copy_rule_files, copy_rules_dirs, write_files
from drivelint.pack.request import PackContentFunctions

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.catalogue import Rule
    from drivelint.pack.request import PackRequest
    from drivelint.result.request import RunRequest


def functions_that_pack_audit(request: PackRequest) -> PackContentFunctions:
    """Return the functions that pack an audit. Errors: `UsageError` for an audit that has not ended."""
    with open_audits(str(request.folder)) as (_, audit, _):
        if audit.warning:
            raise UsageError(audit.warning)
    return PackContentFunctions(lambda work: _write_payload_and_return_evidence(work, request), in_toto_statement)


def _write_payload_and_return_evidence(pack_folder: Path, request: PackRequest) -> dict[str, Any]:
    """Copy the tables, judge the drives of the worst findings again, and write their evidence. Return the content of `evidence.json`."""
    results = LocalFolder(request.folder)
    names = tables.packed_file_names(results)
    for name in names:
        (pack_folder / tables.AUDIT_FOLDER / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(request.folder / name, pack_folder / tables.AUDIT_FOLDER / name)
    with open_audit_in_evidence_pack(pack_folder / tables.AUDIT_FOLDER) as (con, audit):
        summary = json.loads((pack_folder / tables.AUDIT_FOLDER / SUMMARY_FILE).read_bytes())
        if wrong := tables.contradicted_summary_keys(con, audit, summary):
            raise UsageError(f"{request.folder}: its summary and its tables do not agree ({wrong[0]}): audit again")
        rules = pq.read_table(pack_folder / tables.AUDIT_FOLDER / RULES_FILE)
        findings = tables.worst_findings(con, request.findings)
        dirs = tables.judge_settings(audit).rules_dirs
        loaded_rules = reproduction.rules_of_table(rules, dirs)
        copy_rule_files(loaded_rules, pack_folder)
        inputs = _InputCopier(pack_folder, with_inputs=request.with_inputs)
        logs = tables.given_logs_by_key(con, findings, request.traces)
        entries = []
        for drive in tables.packed_drives(con, audit, rules, findings, dirs):
            check_request = tables.drive_request_with_present_paths(drive, logs.get(drive.key), request.map)
            inputs.copy_inputs_of_drive(drive.key, check_request)
            entries += _write_evidence_and_return_finding_entries(pack_folder, drive, check_request, loaded_rules)
        order = {(row["key"], row["finding_id"]): no for no, row in enumerate(findings)}
        evidence = {
            "evidence": contents.AUDIT_FORMAT_VERSION,
            **tables.evidence_values_of_audit(pack_folder, con, audit, rules.to_pylist()),
            "packed_with": contents.library_versions(),
            "mappings": inputs.mappings,
            "rules_dirs": copy_rules_dirs(dirs, pack_folder),
            "inputs": {"traces": inputs.traces, "maps": inputs.maps} if request.with_inputs else None,
            "findings": sorted(entries, key=lambda row: order[row["key"], row["finding_id"]]),
        }
    evidence["findings_left_out"] = 0 if request.findings is None else max(evidence["n_findings"] - request.findings, 0)
    there = {path.relative_to(request.folder).parts[0] for path in request.folder.rglob("*") if path.is_file()}
    evidence["left_out"] = sorted(name for name in there - {Path(name).parts[0] for name in names} if name[0] != ".")
    (pack_folder / contents.EVIDENCE_FILE).write_bytes(
        (json.dumps(evidence, indent=2, ensure_ascii=False) + "\n").encode()
    )
    return evidence


def _write_evidence_and_return_finding_entries(
    pack_folder: Path, drive: tables.PackedDrive, check_request: RunRequest, loaded_rules: Sequence[Rule]
) -> list[dict[str, Any]]:
    """Write the data that reproduce the findings of a drive; return their entries for `evidence.json`."""
    place = f"{contents.FINDINGS_FOLDER}/{drive.key}"
    evidence = reproduction.evidence_of_findings(drive.result, check_request, loaded_rules=loaded_rules)
    for name, files in evidence.items():
        if isinstance(files, dict):
            write_files(files, pack_folder / place / name, pack_folder)
    entries = contents.finding_entries(drive.result.findings.to_pylist(), evidence, place)
    return [{"key": drive.key, **row} for row in entries]


class _InputCopier:
    """Copies mappings, and with `with_inputs` also logs and maps, into a pack. A file that drives share is copied once. Each dict: key of a
    drive -> path in the pack."""

    def __init__(self, pack_folder: Path, *, with_inputs: bool) -> None:
        self._work, self._with_inputs = pack_folder, with_inputs
        self._places: dict[Path, str] = {}
        self.mappings: dict[str, str] = {}
        self.traces: dict[str, str] = {}
        self.maps: dict[str, str] = {}

    def copy_inputs_of_drive(self, key: str, check_request: RunRequest) -> None:
        """Copy the mapping of a drive, and with `with_inputs` its log and map. `check_request` has their present paths."""
        if (
            check_request.mapping is not None and Path(check_request.mapping).is_file()
        ):  # else the name of a built-in mapping
            self.mappings[key] = self._copy_once(Path(check_request.mapping), "mapping")
        if not self._with_inputs:
            return
        (log,) = check_request.traces.values()
        self.traces[key] = self._copy_once(Path(log), "inputs/traces")
        if (road := check_request.map or check_request.map_dir) is not None:
            self.maps[key] = self._copy_once(road, "inputs/maps")

    def _copy_once(self, source: Path, folder: str) -> str:
        if source not in self._places:
            place = self._work / "data" / folder / str(len(self._places))
            self._places[source] = copy_into_new_folder(source, place, self._work)
        return self._places[source]
