"""What goes into the pack of an audit: its tables, the rules, and what gives its worst findings again."""

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
from drivelint.fleet_report.audit_views import open_audits, opened_packed
from drivelint.pack import again, contents
from drivelint.pack.audits import tables
from drivelint.pack.audits.statement import statement
from drivelint.pack.copying import copy, copy_rules, copy_rules_dirs, write_files
from drivelint.pack.request import Content

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.catalogue import Rule
    from drivelint.pack.request import PackRequest
    from drivelint.result.request import RunRequest


def content(request: PackRequest) -> Content:
    """Return what makes a pack of an audit. Errors: `UsageError` for one that has not ended."""
    with open_audits(str(request.folder)) as (_, audit, _):
        if audit.warning:
            raise UsageError(audit.warning)
    return Content(lambda work: _payload(work, request), statement)


def _payload(work: Path, request: PackRequest) -> dict[str, Any]:
    """Copy the tables; then judge the drives of the worst findings again, one by one. Return what `evidence.json` says."""
    results = LocalFolder(request.folder)
    names = tables.names(results)
    for name in names:
        (work / tables.AUDIT / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(request.folder / name, work / tables.AUDIT / name)
    with opened_packed(work / tables.AUDIT) as (con, audit):
        said = json.loads((work / tables.AUDIT / SUMMARY_FILE).read_bytes())
        if wrong := tables.unlike_summary(con, audit, said):
            raise UsageError(f"{request.folder}: its summary and its tables do not agree ({wrong[0]}): audit again")
        rules = pq.read_table(work / tables.AUDIT / RULES_FILE)
        findings = tables.worst_findings(con, request.findings)
        dirs = tables.settings_of(audit).rules_dirs
        known = again.rules_of_table(rules, dirs)
        copy_rules(known, work)
        inputs = _Inputs(work, kept=request.with_inputs)
        given = tables.logs_of(con, findings, request.traces)
        found = []
        for drive in tables.packed_drives(con, audit, rules, findings, dirs):
            asked = tables.located_drive(drive, given.get(drive.receipt["log_sha256"]), request.map)
            inputs.add(drive.key, asked)
            found += _findings(work, drive, asked, known)
        order = {(row["key"], row["finding_id"]): no for no, row in enumerate(findings)}
        told = {
            "evidence": contents.FORM,
            **tables.facts(work, con, audit, rules.to_pylist()),
            "packed_with": contents.library_versions(),
            "mappings": inputs.mappings,
            "rules_dirs": copy_rules_dirs(dirs, work),
            "inputs": {"traces": inputs.traces, "maps": inputs.maps} if request.with_inputs else None,
            "findings": sorted(found, key=lambda row: order[row["key"], row["finding_id"]]),
        }
    told["findings_left_out"] = told["n_findings"] - len(found)
    there = {path.relative_to(request.folder).parts[0] for path in request.folder.rglob("*") if path.is_file()}
    told["left_out"] = sorted(name for name in there - {Path(name).parts[0] for name in names} if name[0] != ".")
    (work / contents.EVIDENCE).write_bytes((json.dumps(told, indent=2, ensure_ascii=False) + "\n").encode())
    return told


def _findings(work: Path, drive: tables.PackedDrive, asked: RunRequest, known: Sequence[Rule]) -> list[dict[str, Any]]:
    """Write what gives the findings of a drive again; return what `evidence.json` says of them."""
    place = f"{contents.FINDINGS}/{drive.key}"
    evidence = again.finding_evidence(drive.result, asked, known=known)
    for name, files in evidence.items():
        if isinstance(files, dict):
            write_files(files, work / place / name, work)
    told = contents.findings(drive.result.findings.to_pylist(), evidence, place)
    return [{"key": drive.key, **row} for row in told]


class _Inputs:
    """Copies mappings, and with `kept` logs and maps, into a pack; what many drives have, once. Each dict: key of a drive -> place."""

    def __init__(self, work: Path, *, kept: bool) -> None:
        self._work, self._kept = work, kept
        self._places: dict[Path, str] = {}
        self.mappings: dict[str, str] = {}
        self.traces: dict[str, str] = {}
        self.maps: dict[str, str] = {}

    def add(self, key: str, asked: RunRequest) -> None:
        """Copy what a drive was judged from and on; `asked` says where it is now."""
        if asked.mapping is not None and Path(asked.mapping).is_file():  # else the name of a shipped one
            self.mappings[key] = self._place(Path(asked.mapping), "mapping")
        if not self._kept:
            return
        (log,) = asked.traces.values()
        self.traces[key] = self._place(Path(log), "inputs/traces")
        if (road := asked.map or asked.map_dir) is not None:
            self.maps[key] = self._place(road, "inputs/maps")

    def _place(self, source: Path, folder: str) -> str:
        if source not in self._places:
            place = self._work / "data" / folder / str(len(self._places))
            self._places[source] = copy(source, place, self._work)
        return self._places[source]
