"""Checks that the parts of a pack agree: its statement, `evidence.json`, the tables, the reports, the findings, and its files."""

from __future__ import annotations

import json
import re
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import pyarrow as pa
import pyarrow.parquet as pq

from drivelint import __version__, catalogue
from drivelint.engine.profiles import DEFAULT_PROFILES
from drivelint.errors import DriveLintError
from drivelint.incident import possible_sheet_ids
from drivelint.pack import finding_rows, finding_sql, reproduction, sheets, signature
from drivelint.pack.bag import DATA, Problem
from drivelint.pack.contents import (
    COPIED_RESULT_FILES,
    EVIDENCE_FILE,
    FINDING_ENTRY_COLUMNS,
    FINDINGS_FOLDER,
    FORMAT_VERSION,
    RESULT_FOLDER,
    evidence_values_of_result,
    packed_summary,
)
from drivelint.pack.statement import (
    ENVELOPE_FILE,
    STATEMENT_FILE,
    altered_file_problems,
    in_toto_statement,
    statement_problems,
)
from drivelint.phrases import plural
from drivelint.report import summary
from drivelint.report.outputs import REPORT_FORMATS
from drivelint.result import collect
from drivelint.result import request as run_request
from drivelint.result.counts import one_finding_per_event
from drivelint.result.load import load_result

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from pathlib import Path

    from drivelint.catalogue import Rule
    from drivelint.result.model import Result
    from drivelint.result.request import RunRequest

READ_ERRORS: Final = (OSError, ValueError, LookupError, TypeError, AttributeError, RecursionError, pa.ArrowException)
"""The errors that reading an untrusted file can raise. A signer can put anything into a pack."""
_UNDERIVED_EVIDENCE_KEYS: Final = (
    "evidence",
    "packed_with",
    "mapping",
    "rules_dirs",
    "inputs",
    "incidents",
    "findings",
    "left_out",
)
_REFERENCE_ID_PATTERN: Final = re.compile(r"\bref_id = (\d+);\n\Z")


class PackContent(NamedTuple):
    """The content of a pack: the result, `evidence.json`, and the one-word result of the statement."""

    result: Result
    evidence: dict[str, Any]
    outcome: str


def problems_and_content(folder: Path) -> tuple[list[Problem], PackContent | None]:
    """Return the contradictions in a pack, and the pack's content; None: the content cannot be read."""
    name = ENVELOPE_FILE if (folder / ENVELOPE_FILE).is_file() else STATEMENT_FILE
    try:
        evidence = read_evidence(folder)
        result = load_result(folder / RESULT_FOLDER)
        wrong = _problems_of_evidence(folder, result, evidence) + _unnamed_payload_files(folder, evidence)
        wrong += _differing_reports(folder, result, evidence)
        due = in_toto_statement(folder, result, packed_summary(folder), evidence)
        stated = PackContent(result, evidence, json.loads(due)["predicate"]["result"])
        if not (folder / name).is_file():
            return [Problem("statement missing", STATEMENT_FILE)], stated
        content = (folder / name).read_bytes()
        statement = signature.payload_of_envelope(content) if name == ENVELOPE_FILE else content
    except (DriveLintError, *READ_ERRORS) as error:
        return [*_altered_files(folder), Problem("result not readable", str(error))], None
    return statement_problems(statement, due) + wrong, stated


def _altered_files(folder: Path) -> list[Problem]:
    """Return the files whose hashes are not those in the statement; [] if the statement cannot be read."""
    try:
        sealed = (folder / ENVELOPE_FILE).is_file()
        content = (folder / (ENVELOPE_FILE if sealed else STATEMENT_FILE)).read_bytes()
        return altered_file_problems(signature.payload_of_envelope(content) if sealed else content, folder)
    except (DriveLintError, *READ_ERRORS):
        return []


def read_evidence(folder: Path, version: int = FORMAT_VERSION) -> dict[str, Any]:
    """Return the content of `evidence.json`. Errors: `ValueError` if a key occurs twice, or for another version of the format."""

    def dict_of_distinct_keys(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        values = dict(pairs)
        if len(values) < len(pairs):
            raise ValueError(f"{EVIDENCE_FILE} says something twice")
        return values

    evidence: dict[str, Any] = json.loads(
        (folder / EVIDENCE_FILE).read_text("utf-8"), object_pairs_hook=dict_of_distinct_keys
    )
    if evidence["evidence"] != version:
        raise ValueError(f"{EVIDENCE_FILE} is of form {evidence['evidence']}, this drivelint reads {version}")
    return evidence


def _problems_of_evidence(folder: Path, result: Result, evidence: dict[str, Any]) -> list[Problem]:
    """Return the contradictions between `evidence.json` and the result and rules in the pack."""
    due = evidence_values_of_result(folder, result, run_request.load(folder / RESULT_FOLDER))
    keys = differing_evidence_keys(
        evidence, due, result.findings.select(FINDING_ENTRY_COLUMNS).to_pylist(), result.rules.to_pylist()
    )
    keys += sorted(evidence.keys() - due.keys() - set(_UNDERIVED_EVIDENCE_KEYS))
    keys += _inputs_with_wrong_paths(json.loads((folder / RESULT_FOLDER / "run.json").read_text("utf-8")), evidence)
    keys += sheets.invalid_sheets(folder, evidence, possible_sheet_ids(result))
    wrong = [Problem("evidence.json does not match the result", key) for key in keys]
    packed, computed = packed_summary(folder), json.loads(summary.render(result))
    keys = sorted(
        key for key in computed.keys() | packed.keys() if key != "tool" and packed.get(key) != computed.get(key)
    )
    return wrong + [Problem("summary.json does not match the tables", key) for key in keys]


def differing_evidence_keys(
    evidence: dict[str, Any], facts: dict[str, Any], findings: list[dict[str, Any]], rules: Iterable[dict[str, Any]]
) -> list[str]:
    """Return the keys of `evidence.json` that differ from these facts, findings, versions of rules, or the paths of the SQL."""
    due: dict[str, Any] = {**facts, "findings": findings}
    keys = findings[0].keys() if findings else ()
    values = {**evidence, "findings": [{key: row.get(key) for key in keys} for row in evidence["findings"]]}
    due["rule versions"] = [rule["rule_version"] for rule in rules]
    values["rule versions"] = [rule["rule_version"] for rule in facts["rules"]]
    due["sql"] = [_expected_sql_path(row, has_drive_folder="key" in keys) for row in evidence["findings"]]
    values["sql"] = [row["sql"] for row in evidence["findings"]]
    return [key for key, value in due.items() if values.get(key) != value]


def _expected_sql_path(finding: dict[str, Any], *, has_drive_folder: bool) -> str | None:
    """Return the path where the SQL of a finding must be; None: the pack has a reason instead of the SQL."""
    reason = finding["without_sql_because"]
    place = f"{FINDINGS_FOLDER}/{finding['key']}" if has_drive_folder else FINDINGS_FOLDER
    return None if isinstance(reason, str) and reason else f"{place}/{finding['finding_id']}/{finding_rows.SQL_FILE}"


def _inputs_with_wrong_paths(run_json: dict[str, Any], evidence: dict[str, Any]) -> list[str]:
    """Return the names of the inputs of the check whose path in the pack is missing or unexpected in `evidence.json`."""
    wrong = [] if isinstance(run_json["mapping"], dict) == (evidence["mapping"] is not None) else ["mapping"]
    if len(run_json["rules_dirs"]) != len(evidence["rules_dirs"]):
        wrong.append("rules_dirs")
    inside = evidence["inputs"]
    drive_ids = {drive["drive_id"] for drive in evidence["drives"]}
    has_map = run_json["map"] is not None or run_json["map_dir"] is not None
    if inside is not None and (inside["traces"].keys() != drive_ids or has_map != (len(inside) > 1)):
        wrong.append("inputs")
    return wrong


def _unnamed_payload_files(folder: Path, evidence: dict[str, Any]) -> list[Problem]:
    """Return the files of the payload that `evidence.json` does not name."""
    named_files = {
        EVIDENCE_FILE,
        *(f"{RESULT_FOLDER}/{name}" for name in COPIED_RESULT_FILES),
        *(rule["file"] for rule in evidence["rules"]),
    }
    named_files |= set(sheets.sheet_paths_in_evidence(evidence))
    inside = evidence["inputs"] or {"traces": {}}
    places = [evidence["mapping"], *evidence["rules_dirs"], *inside["traces"].values()]
    places += [inside.get("map"), inside.get("map_dir")]
    input_folders = tuple(f"{DATA}/{name}/" for name in ("mapping", "rules_dirs", "inputs"))
    return unnamed_files(
        folder,
        evidence,
        named_files,
        [place for place in places if place is not None and place.startswith(input_folders)],
    )


def unnamed_files(
    folder: Path, evidence: dict[str, Any], named_files: set[str], named_folders: Iterable[str]
) -> list[Problem]:
    """Return the files of the payload that are not in `named_files`, not below `named_folders`, and not data of a finding."""
    known_paths = {
        *named_folders,
        *(row["sql"].removesuffix(f"/{finding_rows.SQL_FILE}") for row in evidence["findings"] if row["sql"]),
    }
    files = {path.relative_to(folder) for path in (folder / DATA).rglob("*") if path.is_file()}
    names = [
        path.as_posix() for path in files if known_paths.isdisjoint(place.as_posix() for place in (path, *path.parents))
    ]
    return [Problem("file that nothing names", name) for name in sorted(set(names) - named_files)]


def _differing_reports(folder: Path, result: Result, evidence: dict[str, Any]) -> list[Problem]:
    """Return the reports that differ from those that drivelint writes from the tables. Compare only if the same version wrote the pack."""
    if packing_version(evidence) != __version__:
        return []
    return [
        Problem("report does not match the tables", f"{RESULT_FOLDER}/{name}")
        for name, render in REPORT_FORMATS.values()
        if (folder / RESULT_FOLDER / name).is_file() and (folder / RESULT_FOLDER / name).read_bytes() != render(result)
    ]


def packing_version(evidence: dict[str, Any]) -> str:
    """Return the version of drivelint that wrote a pack."""
    return str(evidence["packed_with"]["drivelint"])


def check_sql_of_findings(folder: Path, result: Result, check_request: RunRequest) -> tuple[list[Problem], str]:
    """Run the SQL of each finding on the rows in the pack. Return the findings with other numbers, and a phrase about how many were run.

    The SQL that runs is generated from the rule; the SQL in the pack must be the same text. Only the log can show whether the rows are
    right.
    """
    try:
        rules = {rule.id: rule for rule in reproduction.rules_of_result(result, check_request)}
    except DriveLintError as error:
        return [], f"the findings' SQL was not run: {error}"
    if why := rules_contradiction(list(rules.values()), result.rules, check_request):
        return [Problem("run.json does not match the result", why)], ""
    rows = {f"{FINDINGS_FOLDER}/{row['finding_id']}": row for row in result.findings.to_pylist()}
    wrong, n = check_sql_in_folders(folder, rows, rules, check_request)
    return wrong, f"{plural(n, 'finding')} gave {'its' if n == 1 else 'their'} numbers from the rows in the pack"


def rules_contradiction(rules: list[Rule], table: pa.Table, check_request: RunRequest) -> str:
    """Return the contradiction between the table `rule` and the requested rules and parameters; '' if there is none."""
    try:
        params = catalogue.parse_params(rules, check_request.params)
        due = collect.rule_table(rules, params, check_request.profiles or DEFAULT_PROFILES)
    except DriveLintError as error:
        return str(error)
    return "" if due.to_pylist() == table.to_pylist() else "rules.parquet has other parameters, profiles or rules"


def check_sql_in_folders(
    folder: Path,
    findings_by_folder: Mapping[str, finding_sql.Row],
    rules: Mapping[str, Rule],
    check_request: RunRequest,
) -> tuple[list[Problem], int]:
    """Return the findings whose SQL returns other numbers, and how many findings were run, one per event."""
    params = reproduction.param_values_by_rule(rules.values(), check_request)
    wrong, run = [], []
    for inner, row in findings_by_folder.items():
        place = folder / inner
        if not (place / finding_rows.SQL_FILE).is_file():
            continue
        run.append(row)
        rule = rules[row["rule_id"]]
        text = (place / finding_rows.SQL_FILE).read_text("utf-8", "replace")
        reference = _REFERENCE_ID_PATTERN.search(text)
        sql = finding_sql.select_of_finding(rule, params[rule.id], row, int(reference[1]) if reference else None)
        tables = finding_sql.tables_of_condition(rule)
        try:
            rows = {table: pq.read_table(place / f"{table}.parquet") for table in tables}
            same = finding_sql.finding_sql_text(rule, row, sql, tables) == text and finding_rows.gives_finding_numbers(
                sql, row, rows
            )
        except READ_ERRORS:
            same = False
        if not same:
            wrong.append(Problem("finding does not give its numbers", inner))
    return wrong, len(one_finding_per_event(run))
