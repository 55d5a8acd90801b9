"""Builds the content of `evidence.json`: the logs, rules, outputs and findings of a pack."""

from __future__ import annotations

import json
import platform
from dataclasses import fields
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from drivelint import __version__
from drivelint.drive.trace import DriveInput
from drivelint.pack.bag import sha256_of
from drivelint.pack.inputs import judged_drives
from drivelint.phrases import plural
from drivelint.result import request as run_request
from drivelint.result.counts import extra_rows_sentence, one_finding_per_event
from drivelint.result.names import MANIFEST, RESULT_FILE_GLOBS

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from drivelint.pack.finding_sql import Row
    from drivelint.pack.reproduction import Evidence
    from drivelint.result.model import Result
    from drivelint.result.request import RunRequest

EVIDENCE_FILE: Final = "data/evidence.json"
RESULT_FOLDER: Final = "data/result"
FINDINGS_FOLDER: Final = "data/findings"
FORMAT_VERSION: Final = 1
"""Version of the format, the value of `evidence` in `evidence.json`: raised when a key is removed or changes its meaning."""
AUDIT_FORMAT_VERSION: Final = 2
"""The same for the pack of an audit. Since version 2, `n_findings` and `findings_left_out` count findings as the audit does."""
COPIED_RESULT_FILES: Final = frozenset(name for name in RESULT_FILE_GLOBS if not ("*" in name or "/" in name)) - {
    "drivelint.duckdb",
    MANIFEST,
}
"""The files of a result that are copied into a pack. The manifest is left out, because the bag has its own."""
FINDING_ENTRY_COLUMNS: Final = ("finding_id", "rule_id", "drive_id", "observed", "required", "margin", "unit")
_DRIVE_COLUMNS_IN_EVIDENCE: Final = ("drive_id", "file_name", "sha256", "format", "map_name", "map_sha256")
_LIBRARIES_WITH_STATED_VERSION: Final = ("duckdb", "duckdb-extension-spatial", "pyarrow", "numpy", "shapely", "polars")
"""Libraries that affect verdicts or the bytes of files."""


def packed_summary(folder: Path) -> dict[str, Any]:
    """Return the content of `summary.json` in a pack."""
    summary: dict[str, Any] = json.loads((folder / RESULT_FOLDER / "summary.json").read_text("utf-8"))
    return summary


def evidence_values_of_result(folder: Path, result: Result, check_request: RunRequest) -> dict[str, Any]:
    """Return the values of `evidence.json` that follow from the result and the rules in the pack `folder`."""
    drives, rules = result.drives.to_pylist(), result.rules.to_pylist()
    return {
        "tool": packed_summary(folder)["tool"],
        "drives": [{key: drive[key] for key in _DRIVE_COLUMNS_IN_EVIDENCE} for drive in judged_drives(drives)],
        "not_judged": [drive["file_name"] for drive in drives if drive["status"] != "judged"],
        "options": _options_of_check(check_request, result),
        **evidence_values_of_rules(folder, rules),
        "outputs": sha256_by_path(folder, RESULT_FOLDER),
    }


def evidence_values_of_rules(folder: Path, rules: Sequence[Row]) -> dict[str, Any]:
    """Return the files and the parameters of the rules of a result; `rules`: its table `rule`."""
    return {
        "rules": [_rule_entry(folder, rule["rule_id"]) for rule in rules],
        "parameters": {
            f"{rule['rule_id']}.{param['name']}": param["value"] for rule in rules for param in rule["params"]
        },
    }


def sha256_by_path(folder: Path, subfolder: str) -> dict[str, str]:
    """Return file -> hash for all files below a folder of the pack."""
    files = sorted(path for path in (folder / subfolder).rglob("*") if path.is_file())
    return {path.relative_to(folder).as_posix(): sha256_of(path) for path in files}


def _rule_entry(folder: Path, rule_id: str) -> dict[str, str]:
    """Return the entry of a rule: its file in the pack, the file's hash, and the version, which is the start of the hash."""
    pack, _, name = rule_id.partition(".")
    file = f"data/rules/{pack}/{name}.sql"
    digest = sha256_of(folder / file)
    return {"rule_id": rule_id, "rule_version": digest[:16], "sha256": digest, "file": file}


def _options_of_check(check_request: RunRequest, result: Result) -> dict[str, Any]:
    """Return the options of the check, without the paths of logs, maps, mapping and rules."""
    plain = json.loads(run_request.render(check_request, Path()))
    names = {field.name for field in fields(DriveInput)} - {"map", "map_dir", "mapping"}
    options = {key: value for key, value in plain.items() if key in {*names, "profiles"}}
    return {**options, "fail_on": result.fail_on, "strict": result.strict, "required": list(result.required)}


def library_versions() -> dict[str, str]:
    """Return the versions of drivelint, Python and the libraries in use."""
    return {
        "drivelint": __version__,
        "python": platform.python_version(),
        **{name: version(name) for name in _LIBRARIES_WITH_STATED_VERSION},
    }


def path_inside_pack(folder: Path, path: str) -> Path:
    """Return the path of a file that `evidence.json` names. Errors: `ValueError` for a path outside the pack."""
    inside = folder / path
    if not inside.resolve().is_relative_to(folder.resolve()):
        raise ValueError(f"{EVIDENCE_FILE} leads out of the pack: {path}")
    return inside


def phrase_on_findings_with_sql(rows: Sequence[Row], entries: Iterable[Mapping[str, Any]]) -> str:
    """Return in words how many findings of a check have SQL, one per event, as its reports count them.

    `rows`: the table `finding`; `entries`: the entries of `findings`.
    """
    with_sql = {entry["finding_id"] for entry in entries if entry["sql"]}
    events = one_finding_per_event(rows)
    n = sum(row["finding_id"] in with_sql for row in events)
    phrase = f"{n} of {plural(len(events), 'finding')} {'has' if n == 1 else 'have'} SQL that computes the margin"
    more = extra_rows_sentence(rows, events)
    return f"{phrase} ({more})" if more else phrase


def finding_entries(
    rows: Iterable[Row], evidence: Evidence, findings_folder: str = FINDINGS_FOLDER
) -> list[dict[str, Any]]:
    """Return the entries of findings: their numbers, and the path of the SQL or the reason why there is none. `findings_folder`: folder
    of the findings in the pack."""
    new_entries = []
    for row in rows:
        files = evidence[row["finding_id"]]
        has_files = isinstance(files, dict)
        new_entries.append({
            **{key: row[key] for key in FINDING_ENTRY_COLUMNS},
            "sql": f"{findings_folder}/{row['finding_id']}/finding.sql" if has_files else None,
            "without_sql_because": None if has_files else files,
        })  # fmt: skip
    return new_entries
