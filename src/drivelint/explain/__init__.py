"""Explains one verdict: its clause, SQL and numbers, changes of numbers that would change it, and how sure it is.

`explain` judges the drive again by the verdict's rule alone, from the kept database or from the log.
"""

from __future__ import annotations

import json
from contextlib import ExitStack
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

import msgspec
import pyarrow.compute as pc

from drivelint import catalogue
from drivelint.engine.memory import DEFAULT_MEMORY_BYTES
from drivelint.engine.profiles import load_profiles, profile_table
from drivelint.engine.robustness.copies import MeasurementErrors
from drivelint.errors import UsageError
from drivelint.explain import evidence
from drivelint.explain.change import nearest_changes_of_verdict
from drivelint.explain.model import Explanation
from drivelint.explain.sensitivity import (
    measurement_errors_with_default_number_of_copies,
    sensitivity_from_copies_of_check,
    verdict_sensitivity,
)
from drivelint.explain.source import open_judged_drive_and_source_text
from drivelint.explain.target import VerdictFilter, find_verdict
from drivelint.explain.verdict_context import VerdictContext, lacks_signal, shortest_part_with_same_verdict
from drivelint.reasons import reason_text
from drivelint.reasons.signals import missing_signal, unknown_condition_column
from drivelint.result import request as run_request
from drivelint.result.load import load_result

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    import pyarrow as pa

    from drivelint.catalogue import Rule
    from drivelint.engine.batch import Drive
    from drivelint.explain.model import NearestChange, Row, Sensitivity, Step
    from drivelint.explain.sandbox import Sandbox
    from drivelint.explain.target import Target
    from drivelint.result.request import RunRequest

__all__ = ["ExplainRequest", "Explanation", "MeasurementErrors", "VerdictFilter", "explain"]

_RULE_COLUMNS: Final = (
    "title", "breach", "clause", "hypothesis", "kind", "severity", "legal", "status", "sense", "unit", "observes",
    "near_margin",
)  # fmt: skip
_DRIVE_COLUMNS: Final = ["drive_id", "file_name", "format", "t_start_ns", "duration_s", "map_name"]


@dataclass(frozen=True)
class ExplainRequest:
    """A request to `explain`: a finding or rule, the result folder, and the paths of log and map if they were moved."""

    name: str
    folder: Path
    verdict_filter: VerdictFilter = field(default_factory=VerdictFilter)
    trace: Path | None = None
    map: Path | None = None
    errors: MeasurementErrors = field(default_factory=MeasurementErrors)
    memory: int | None = DEFAULT_MEMORY_BYTES
    """The bytes that the database may use before it uses the disk; None: 80 % of the machine's memory."""


def explain(request: ExplainRequest) -> Explanation:
    """Explain one verdict of a result.

    Errors: `UsageError` if the finding, rule, folder or log does not exist.
    """
    result = load_result(request.folder)
    target = find_verdict(result, request.name, request.verdict_filter)
    run_options = run_request.load(request.folder).of_drive(target.verdict_row["drive_id"])
    case = _context_of_verdict(run_options, target, result.rules, request.memory)
    row = target.verdict_row
    of_drive = next(drive for drive in result.drives.to_pylist() if drive["drive_id"] == row["drive_id"])
    drive, source = open_judged_drive_and_source_text(
        request.folder,
        run_options,
        row["drive_id"],
        row["ego_id"],
        trace=request.trace,
        map_=request.map,
        map_sha256=of_drive["map_sha256"],
    )
    with ExitStack() as exit_stack:
        sandbox = exit_stack.enter_context(case.sandbox([drive]))
        judgement = sandbox.judge(case.params)
        now = case.verdicts_on(judgement, [sandbox.drive_id])[0]
        series = evidence.judged_steps(case.rule, target, judgement)
        decides = _deciding_time_ns(target, series, now)
        parts = evidence.required_value_parts(case.rule, target, sandbox, case.params, decides)
        lacking = missing_signal(row["reason_code"]) if lacks_signal(row) else None
        condition = (
            unknown_condition_column(row["reason_code"]) if row["verdict"] == "unknown" and not target.finding else None
        )
        rows = evidence.rows_read_by_rule(
            case.rule, target, sandbox, decides, missing_signal=lacking, condition=condition
        )
        changes: list[NearestChange] = []
        sensitivity = None
        if not lacks_signal(row):
            changes, sensitivity = _changes_and_sensitivity(
                case, drive, sandbox, now, errors=request.errors, exit_stack=exit_stack
            )
    rule = case.rule
    about = {name: of_drive[name] for name in _DRIVE_COLUMNS}
    return Explanation(
        rule={
            "rule_id": rule.id,
            "rule_version": rule.version,
            **{key: getattr(rule, key) for key in _RULE_COLUMNS},
            "applies": rule.applies.restricted_conditions,
        },
        drive=about,
        verdict={**row, "judged_anew": now},
        other_verdicts=target.other_verdicts,
        asks=_advice_on_unknown(rule, row, about["t_start_ns"] or 0),
        decides_ns=decides,
        parts=parts,
        sql=evidence.sql_with_values(rule, case.params),
        params=[
            {"name": name, "value": case.params[name], "unit": p.unit, "why": p.why, "source": p.source}
            for name, p in rule.params.items()
        ],
        rows=rows,
        series=series,
        changes=changes,
        sensitivity=sensitivity,
        source=source,
        notes=[*_notes_on_changes_since_run(case, now), *_notes_on_removed_track_ends(of_drive, row["reason_code"])],
    )


def _changes_and_sensitivity(
    context: VerdictContext,
    drive: Drive,
    whole_sandbox: Sandbox,
    verdict: str,
    *,
    errors: MeasurementErrors,
    exit_stack: ExitStack,
) -> tuple[list[NearestChange], Sensitivity | None]:
    """Return the least changes of the rule's numbers that change the verdict, and the verdict's sensitivity to measurement errors.

    `whole_sandbox`: a sandbox with the whole drive, on which the verdict is `verdict`. The sensitivity is None if no copies were requested.
    """
    row = context.target.verdict_row
    part, span, sandbox = shortest_part_with_same_verdict(context, drive, whole_sandbox, verdict, exit_stack)
    sensitivity = None
    if context.rule.version == row["rule_version"] and verdict == row["verdict"]:
        sensitivity = sensitivity_from_copies_of_check(context.target.worst_finding, errors)
    of_verdict = measurement_errors_with_default_number_of_copies(errors, row["verdict"])
    if of_verdict.samples and sensitivity is None:
        sensitivity = verdict_sensitivity(context, part, of_verdict, span)
    return nearest_changes_of_verdict(context, sandbox, verdict), sensitivity


def _context_of_verdict(run_options: RunRequest, target: Target, rules: pa.Table, memory: int | None) -> VerdictContext:
    """Return the context of a verdict, with the rule, parameters and profiles of its run. `rules`: the run's table of rules."""
    rule_id = target.verdict_row["rule_id"]
    rule = catalogue.load_rule(rule_id, run_options.rules_dirs)
    if rule is None:
        raise UsageError(f"rule {rule_id} is not in the catalogue any more: check the drives again")
    (row,) = rules.filter(pc.equal(rules["rule_id"], rule_id)).to_pylist()
    rule = msgspec.structs.replace(rule, is_named=row["is_named"])
    settings = [
        setting for setting in run_options.params if setting.partition("=")[0].strip().rpartition(".")[0] == rule_id
    ]
    values = catalogue.parse_params([rule], settings).get(rule_id, {})
    params = {name: values.get(name, param.default) for name, param in rule.params.items()}
    return VerdictContext(
        rule, target, params, profile_table(load_profiles(run_options.rules_dirs), run_options.profiles), memory
    )


def _advice_on_unknown(rule: Rule, row: Mapping[str, Any], start_ns: int) -> str | None:
    """Return in words what the user can record or provide to decide an unknown verdict; None: nothing helps."""
    if row["cause_code"] is not None:
        return reason_text.sentence_if_it_has_advice(
            row["cause_code"], json.loads(row["cause_args"] or "{}"), start_ns, rule.reasons
        )
    return {"reference_time_unknown": rule.without_time, "anchor_unknown": rule.without_anchor}.get(row["reason_code"])


def _deciding_time_ns(target: Target, series: list[Step], verdict: str) -> int | None:
    """Return the time of the step that decides the verdict; None if no step decides it."""
    # for an actor whose track ends, the first unknown step
    unknown = [step.t_ns for step in series if step.holds is None and verdict == "unknown"]
    times = [*unknown[:1], target.verdict_row["t_worst_ns"], target.verdict_row["t_start_ns"]]
    return next((t_ns for t_ns in times if t_ns is not None), None)


def _notes_on_changes_since_run(context: VerdictContext, verdict: str) -> list[str]:
    notes = []
    version, before = context.target.verdict_row["rule_version"], context.target.verdict["verdict"]
    if context.rule.version != version:
        notes.append(
            f"The rule has changed since (version {version[:8]} before, {context.rule.version[:8]} now): "
            "the SQL and everything computed from it are those of the present version."
        )
    if verdict != before:
        notes.append(
            f"Judged again, the verdict is {verdict}, but the result contains {before}: the tool or the rule has changed."
        )
    return notes


def _notes_on_removed_track_ends(drive: Row, reason_code: str | None) -> list[str]:
    """Return notes on tracks whose ends drivelint removed, if the verdict is unknown because a track ends."""
    messages = [check["message"] for check in drive["quality"] if check["check_id"] == "removed"]
    introduction = "drivelint removed the ends of tracks; a longer recording would not change this"
    return [f"{introduction}: {message}." for message in messages if (reason_code or "").startswith("lost_")]
