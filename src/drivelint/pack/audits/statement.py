"""The in-toto statement about an audit: every drive with its log, its map, its status and its verdicts by kind.

Each drive is a test. It has passed if its complete log was judged on a map that fits, and no verdict is a failure, unknown or a near miss.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from drivelint.errors import ExitCode
from drivelint.fleet_report.audit_views import open_audit_in_evidence_pack
from drivelint.pack import bag
from drivelint.pack.audits.tables import AUDIT_FOLDER
from drivelint.pack.statement import (
    FILES_IN_STATEMENT,
    PREDICATE_TYPE,
    STATEMENT_TYPE,
    resource_descriptor,
    result_word,
)
from drivelint.result.model import MAP_MISFIT_CODES
from drivelint.sql.statements import statement as query

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path


def in_toto_statement(folder: Path, evidence: Mapping[str, Any]) -> bytes:
    """Return the statement about the audit whose tables and manifest are in the pack `folder`."""
    with open_audit_in_evidence_pack(folder / AUDIT_FOLDER) as (con, _):
        drives = (
            con.execute(query("audit/drive_outcomes"), {"misfits": sorted(MAP_MISFIT_CODES)})
            .to_arrow_table()
            .to_pylist()
        )
    outcomes = {word: _test_names_with_outcome(drives, word) for word in ("pass", "near_miss", "fail", "unknown")}
    maps = sorted({(drive["map"], drive["map_sha256"]) for drive in drives if drive["map_sha256"]})
    audit = evidence["audit"]
    content = {
        "_type": STATEMENT_TYPE,
        "subject": [
            resource_descriptor(drive["log"], drive["log_sha256"]) for drive in drives if drive["status"] == "judged"
        ],
        "predicateType": PREDICATE_TYPE,
        "predicate": {
            "result": result_word(outcomes, is_clean=evidence["exit"]["code"] == ExitCode.OK),
            "configuration": [
                *(resource_descriptor(f"map {name}", digest) for name, digest in maps),
                *(resource_descriptor(f"rule {rule['rule_id']}", rule["sha256"]) for rule in evidence["rules"]),
                {"name": "audit", "annotations": {**audit, "parameters": evidence["parameters"]}},
            ],
            "passedTests": outcomes["pass"],
            "warnedTests": outcomes["near_miss"],
            "failedTests": outcomes["fail"],
            "drivelint_undecidedTests": outcomes["unknown"],
            "drivelint_drives": drives,
            "drivelint_exit": evidence["exit"],
            "drivelint_pack": [resource_descriptor(name, bag.sha256_of(folder / name)) for name in FILES_IN_STATEMENT],
        },
    }
    return (json.dumps(content, indent=2, ensure_ascii=False) + "\n").encode()


def _test_names_with_outcome(drives: list[dict[str, Any]], outcome: str) -> list[str]:
    return [f"{drive['drive_id']} {drive['key']}" for drive in drives if drive["outcome"] == outcome]
