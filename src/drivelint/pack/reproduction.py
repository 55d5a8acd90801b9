"""Judges the drives of a result again: reproduces the whole result, and the evidence of each finding."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec
import pyarrow.parquet as pq

from drivelint import catalogue
from drivelint.engine.memory import DEFAULT_MEMORY_BYTES, MemoryLimit
from drivelint.engine.profiles import load_profiles, profile_table
from drivelint.engine.session import JudgingSession
from drivelint.errors import UsageError
from drivelint.evaluate.evaluation import Evaluation
from drivelint.evaluate.sql_fragments import Binding
from drivelint.explain.source import open_judged_drive_and_source_text
from drivelint.pack import finding_rows, finding_sql
from drivelint.pack.bag import Problem
from drivelint.report.progress import Silent
from drivelint.result.counts import group_rows
from drivelint.run import CheckOptions, check
from drivelint.sql import store

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    import duckdb
    import pyarrow as pa

    from drivelint.catalogue import Rule
    from drivelint.engine.batch import Drive
    from drivelint.pack.finding_sql import Row
    from drivelint.result.model import Result
    from drivelint.result.request import RunRequest

Evidence = dict[str, dict[str, bytes] | str]
"""Id of a finding -> the files that reproduce its numbers (name -> content), or the reason why there are none."""


def rules_of_result(result: Result, check_request: RunRequest) -> list[Rule]:
    """Return the rules of a result. Errors: `UsageError` for a rule that is not in the catalogue or was changed since."""
    return rules_of_table(result.rules, check_request.rules_dirs)


def rules_of_table(rules: pa.Table, rules_dirs: Sequence[Path]) -> list[Rule]:
    """Return the rules of a table `rule`. Errors: `UsageError` for a rule that is not in the catalogue or was changed since."""
    rules_by_id = catalogue.load_rules(rules_dirs)
    selection = []
    for row in rules.to_pylist():
        rule = rules_by_id.get(row["rule_id"])
        if rule is None or rule.version != row["rule_version"]:
            state = "is not in the catalogue any more" if rule is None else "was changed since"
            raise UsageError(f"rule {row['rule_id']} {state}: check the drives again")
        selection.append(msgspec.structs.replace(rule, is_named=row["is_named"]))
    return selection


def check_again(
    result: Result, check_request: RunRequest, margins_folder: Path | None, *, evidence: bool = True
) -> Result:
    """Run the check of a result again, and return the new result. `margins_folder`: folder for the margins; None: margins are not computed.
    `evidence`: also gather what reports show.

    Errors: `UsageError` for a rule that is not in the catalogue or was changed since, and the errors of a check.
    """
    rules = rules_of_result(result, check_request)
    values = {
        name: getattr(check_request, name) for name in CheckOptions.__dataclass_fields__ if hasattr(check_request, name)
    }
    values |= {
        "traces": tuple(check_request.traces[name] for name in sorted(check_request.traces)),
        "rules": tuple(rule.id for rule in rules),
        "named_rules": tuple(rule.id for rule in rules if rule.is_named),
        "fail_on": result.fail_on,
        "strict": result.strict,
        "require": result.required,
        "robustness": check_request.robustness,
        "out": margins_folder,
        "margins": margins_folder is not None,
        "annotate": False,
        "pictures": False,
        "evidence": evidence,
    }
    return check(CheckOptions(**values), Silent())


def param_values_by_rule(rules: Iterable[Rule], check_request: RunRequest) -> dict[str, dict[str, object]]:
    """Return rule -> parameter -> value, for the given rules of a check."""
    rules_of_run = list(rules)
    names = {rule.id for rule in rules_of_run}
    settings = catalogue.parse_params(
        rules_of_run, [p for p in check_request.params if p.partition("=")[0].rpartition(".")[0] in names]
    )
    return {
        rule.id: {name: settings.get(rule.id, {}).get(name, param.default) for name, param in rule.params.items()}
        for rule in rules_of_run
    }


def evidence_of_findings(
    result: Result,
    check_request: RunRequest,
    loaded_rules: Sequence[Rule] = (),
) -> Evidence:
    """Return the data that reproduce the numbers of each finding. `check_request` has the paths of the logs. `loaded_rules`: the rules of
    the result, if already loaded."""
    rules = {rule.id: rule for rule in loaded_rules or rules_of_result(result, check_request)}
    evidence: Evidence = {}
    findings = result.findings.to_pylist()
    for (drive_id, ego_id), rows in group_rows(findings, lambda row: (row["drive_id"], row["ego_id"])).items():
        trace = Path(check_request.traces[drive_id])
        drive, _ = open_judged_drive_and_source_text(
            trace.parent, check_request, drive_id, ego_id, trace=trace, map_=check_request.map
        )
        evidence |= _evidence_of_drive(drive, rows, rules, check_request)
    return evidence


def _evidence_of_drive(
    drive: Drive, findings: Sequence[Row], rules: Mapping[str, Rule], check_request: RunRequest
) -> Evidence:
    """Return the evidence of the findings of one ego in one drive."""
    broken_rules = [rules[name] for name in sorted({row["rule_id"] for row in findings})]
    params = param_values_by_rule(broken_rules, check_request)
    evidence: Evidence = {}

    def gather_evidence(con: duckdb.DuckDBPyConnection, _drives: Sequence[Drive], /, **_part: bool) -> None:
        for rule in broken_rules:
            rows = [row for row in findings if row["rule_id"] == rule.id]
            evidence.update(_evidence_of_rule(con, rule, params[rule.id], rows))

    with store.temporary_database(DEFAULT_MEMORY_BYTES) as con:
        store.insert(con, "profile", profile_table(load_profiles(check_request.rules_dirs), check_request.profiles))
        session = JudgingSession(
            con, broken_rules, params, None, observers=[gather_evidence], memory=MemoryLimit(con, DEFAULT_MEMORY_BYTES)
        )
        session.judge([drive])
        session.close()
    return evidence


def _evidence_of_rule(
    con: duckdb.DuckDBPyConnection, rule: Rule, params: Mapping[str, object], findings: Sequence[Row]
) -> Evidence:
    """Return the evidence of the findings of one rule. The database must still have the rows of the drive."""
    first = findings[0]
    references: dict[int, int] = {}
    with store.cursor(con) as cursor:
        if rule.kind != "invariant":
            binding = Binding(rule, 0, params)
            evaluation = Evaluation(cursor, [binding], margins=True)
            evaluation.prepare()
            evaluation.judge_rule(binding)
            # the reference steps as the condition reads them
            cursor.execute("CREATE TEMP VIEW reference_step AS SELECT * EXCLUDE (rule_no) FROM _reference_step")
            references = dict(cursor.execute("SELECT DISTINCT ref_no, ref_id FROM reference_step").fetchall())
        tables = {
            table: finding_rows.rows_of_ego(cursor, table, first["drive_id"], first["ego_id"])
            for table in finding_sql.tables_of_condition(rule)
        }
    return {
        row["finding_id"]: finding_rows.reproducing_files_or_reason(
            rule, params, row, references.get(row["ref_id"]), tables
        )
        for row in findings
    }


def file_problems_and_whether_bytes_differ(
    folder: Path, files: Mapping[str, bytes], packed: Mapping[str, bytes], *, other_libraries: bool
) -> tuple[list[Problem], bool]:
    """Return the files that differ from those in the pack, and whether any has other bytes.

    `files`: path -> reproduced content. `packed`: path -> content to compare with instead of the file in the pack. `other_libraries`: the
    pack was written with other versions of libraries.
    """
    wrong, other_bytes = [], False
    for path, content in files.items():
        if not (folder / path).is_file():
            wrong.append(Problem("result not reproduced", f"{path}: is not in the pack"))
            continue
        there = packed[path] if path in packed else (folder / path).read_bytes()
        if there != content:
            other_bytes = True
            # the same libraries write the same bytes: any other difference is a change of the pack
            if not (other_libraries and path.endswith(".parquet") and has_same_rows(there, content)):
                wrong.append(Problem("result not reproduced", path))
    return wrong, other_bytes


def has_same_rows(a: bytes, b: bytes) -> bool:
    """Return whether two Parquet files have the same rows and column comments, even if their bytes differ."""
    first, second = (pq.read_table(io.BytesIO(content)) for content in (a, b))
    return bool(first.schema.equals(second.schema, check_metadata=True) and first.equals(second))
