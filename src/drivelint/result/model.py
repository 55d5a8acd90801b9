"""The result of a run: its tables, its exit code and the reason for the exit code."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import chain
from typing import TYPE_CHECKING, Final, NamedTuple

import pyarrow as pa
import pyarrow.compute as pc

from drivelint.drive.trace import EGO_ABSENT_CHECK
from drivelint.errors import ExitCode
from drivelint.phrases import name_list, plural
from drivelint.reasons.signals import UNRECORDED_PREFIX, signal_name
from drivelint.result.counts import (
    SEVERITIES,
    distinct_rows,
    group_rows,
    one_finding_per_event,
    verdicts_lacking_signal,
)
from drivelint.result.gate import NOT_FIXED_WORDS, n_findings
from drivelint.result.names import TABLE_OF_FILE, TABLE_OF_PICTURE_FILE
from drivelint.result.schemas import conform, empty_table

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from drivelint.result.gate import ComparedFinding, Gate
    from drivelint.result.request import RunRequest
    from drivelint.result.text import Row


MAP_MISFIT_CODES: Final = frozenset(
    {"ego_not_a_vehicle", "seldom_on_lane", "often_against_lane", "far_from_centre_line"}
)
"""Reasons for a missing signal `registration` that mean that the map does not fit."""
LIMIT_ERROR_CODES: Final = ("rule_timeout", "out_of_memory")
"""Reason codes of errors because a rule exceeded its time or memory. The rule's SQL is valid; another machine may run it."""


class ExitStatus(NamedTuple):
    """The exit code, and its reason in one sentence."""

    code: ExitCode
    why: str


@dataclass(frozen=True)
class Result:
    """The tables of one run, totally ordered, each with the columns of `schemas/verdict.sql`, `output.sql` or `evidence.sql`.

    `scenes` to `opportunities`: the evidence for drawings and charts, which may be empty. `pictures`: camera pictures, may be empty.
    `margins_file`: a Parquet file with every judged step, or None; `write` moves it into the result.
    `fail_on`: critical, major, minor or never. `strict`: no verdict may be unknown. `required`: ids of the rules that may not be unknown.
    `min_judged`: the least share of rules that must be decided, see `decided_share`; None: no limit.
    `interrupted`: the run was interrupted before all drives were judged.
    `gate`: which findings are known, waived or only possible; None: all findings gate. `run_options`: the options of the run, if known.
    `folder`: the folder of the result's files, or None. `notes`: messages about the logs from reading and judging.
    `halted`: where and by which alarm `watch` halted the drive, or None. `ended_early`: why a watched recording ended early, or None.
    Errors: `DriveLintError` if a table has a missing or an additional column.
    """

    verdicts: pa.Table
    findings: pa.Table
    drives: pa.Table
    rules: pa.Table
    scenes: pa.Table = field(default_factory=lambda: empty_table("scene"))
    lanes: pa.Table = field(default_factory=lambda: empty_table("lane_shape"))
    spaces: pa.Table = field(default_factory=lambda: empty_table("danger_space"))
    courses: pa.Table = field(default_factory=lambda: empty_table("course"))
    tracks: pa.Table = field(default_factory=lambda: empty_table("track"))
    overtakes: pa.Table = field(default_factory=lambda: empty_table("overtake_record"))
    opportunities: pa.Table = field(default_factory=lambda: empty_table("opportunity_record"))
    pictures: pa.Table = field(default_factory=lambda: empty_table("picture"))
    margins_file: Path | None = None
    fail_on: str = "critical"
    strict: bool = False
    required: tuple[str, ...] = ()
    min_judged: float | None = None
    interrupted: bool = False
    gate: Gate | None = None
    run_options: RunRequest | None = None
    folder: Path | None = None
    notes: tuple[str, ...] = ()
    halted: str | None = None
    ended_early: str | None = None

    def __post_init__(self) -> None:
        for name, table in {**TABLE_OF_FILE, **TABLE_OF_PICTURE_FILE}.items():
            object.__setattr__(self, name, conform(getattr(self, name), table))

    @property
    def start_times(self) -> dict[str, int | None]:
        """drive_id -> the drive's first time stamp in ns, on the log's clock."""
        return dict(zip(self.drives["drive_id"].to_pylist(), self.drives["t_start_ns"].to_pylist(), strict=True))

    @property
    def is_lossy(self) -> bool:
        """Whether parts of any judged log could not be read."""
        return bool(pc.any(pc.and_(self.drives["lossy"], pc.equal(self.drives["status"], "judged"))).as_py())


def exit_status(result: Result) -> ExitStatus:
    """Return the exit code, by the precedence 130 > 2 > 1 > 4 > 3 > 0, and its reason.

    Only stable rules gate: verdicts of draft rules are shown but do not change the exit code. A rule in error always gives 2. A rule that
    exceeded its limits gives 4, since it has not judged. For exit code 1, the reason also states the first of these: drives or rules that
    were not judged, or lossy input. Otherwise the user would see it only in the next run, after correcting the failure.
    """
    status = next(_exit_statuses(result))
    hidden = (
        next(chain(_not_judged_statuses(result), _lossy_status(result)), None)
        if status.code is ExitCode.FAILED
        else None
    )
    return status if hidden is None else ExitStatus(status.code, f"{status.why}; also {hidden.why}")


def _exit_statuses(result: Result) -> Iterator[ExitStatus]:
    """Yield the exit codes of the run with their reasons, by descending precedence."""
    if result.interrupted:
        yield ExitStatus(ExitCode.INTERRUPTED, interruption_sentence(result.drives))
    if (erring := _error_verdicts(result, beyond_limits=False)).num_rows:
        yield ExitStatus(ExitCode.USAGE, f"{_error_phrase(erring)}: could not be run: {_rule_ids_text(erring)}")
    if result.halted is not None:
        yield ExitStatus(ExitCode.FAILED, result.halted)
    stopped, let_through = _failure_words(result), _let_through_words(result)
    if stopped:
        yield ExitStatus(ExitCode.FAILED, f"{stopped} at or above severity {result.fail_on}{let_through}")
    yield from _not_judged_statuses(result)
    yield from _lossy_status(result)
    if result.fail_on == "never":
        yield ExitStatus(ExitCode.OK, "failures do not gate (--fail-on never)")
    if undecided := _why_nothing_decided(result):
        yield ExitStatus(ExitCode.OK, f"{undecided}; no rule of the run is stable")
    new = "new " if result.gate is not None and result.gate.baseline is not None else ""
    unstable = _findings_of_unstable_rules_words(result)
    yield ExitStatus(ExitCode.OK, f"nothing {new}failed at or above severity {result.fail_on}{let_through}{unstable}")


def _not_judged_statuses(result: Result) -> Iterator[ExitStatus]:
    """Yield exit code 4 for each kind of part that should have been judged but was not."""
    if n_not_judged := int(pc.sum(pc.equal(result.drives["status"], "not_judged")).as_py() or 0):
        yield ExitStatus(
            ExitCode.NOT_JUDGED, f"{n_not_judged} of {plural(result.drives.num_rows, 'drive')} could not be judged"
        )
    if (limited := _error_verdicts(result, beyond_limits=True)).num_rows:
        yield ExitStatus(
            ExitCode.NOT_JUDGED, f"{_error_phrase(limited)}: exceeded its limits: {_rule_ids_text(limited)}"
        )
    off_map = [reason for drive in result.drives.to_pylist() if (reason := map_misfit_reason(drive)) is not None]
    if off_map:
        drives = plural(result.drives.num_rows, "drive")
        yield ExitStatus(ExitCode.NOT_JUDGED, f"the map does not fit {len(off_map)} of {drives}: {off_map[0]}")
    if unfixed := gating_unfixed_findings(result):
        yield ExitStatus(ExitCode.NOT_JUDGED, _unfixed_findings_sentence(result, unfixed))
    if (unknown := gating_unknowns(result)).num_rows:
        yield ExitStatus(ExitCode.NOT_JUDGED, _unknown_verdicts_sentence(result, unknown))
    if result.ended_early is not None:
        yield ExitStatus(ExitCode.NOT_JUDGED, result.ended_early)
    if too_little := why_too_little_decided(result):
        yield ExitStatus(ExitCode.NOT_JUDGED, too_little)


def _error_verdicts(result: Result, *, beyond_limits: bool) -> pa.Table:
    """Return the verdicts in error: with `beyond_limits` those due to too much time or memory, else all other errors."""
    rows = result.verdicts.filter(pc.equal(result.verdicts["verdict"], "error"))
    limited = pc.is_in(rows["reason_code"], value_set=pa.array(LIMIT_ERROR_CODES, pa.string()))
    return rows.filter(limited if beyond_limits else pc.invert(limited))


def _error_phrase(rows: pa.Table) -> str:
    return f"{plural(rows.num_rows, 'verdict')} in error"


def _rule_ids_text(rows: pa.Table) -> str:
    return name_list(sorted(rows["rule_id"].unique().to_pylist()))


def _lossy_status(result: Result) -> Iterator[ExitStatus]:
    """Yield exit code 3 if parts of judged logs were lost."""
    if result.is_lossy:
        judged_drives = [drive for drive in result.drives.to_pylist() if drive["status"] == "judged"]
        absent = [words for drive in judged_drives for words in ego_absence_texts(drive)]
        more = f" and {plural(len(absent) - 1, 'more ego')}" if absent[1:] else ""
        why = "; ".join(["judged on lossy input: parts of a log were lost", *absent[:1]])
        yield ExitStatus(ExitCode.LOSSY, f"{why}{more}")


def interruption_sentence(drives: pa.Table) -> str:
    """Return how many drives an interrupted run has judged, in words. `drives`: its table `drive`."""
    n_judged = int(pc.sum(pc.equal(drives["status"], "judged")).as_py() or 0)
    return f"partial: {n_judged} of {plural(drives.num_rows, 'drive')} judged, interrupted"


def gating_findings(result: Result) -> pa.Table:
    """Return the findings that cause exit code 1: of stable rules, severe enough, and gating by `Gate.is_gating`."""
    rows = _severe_rows_of_stable_rules(result, result.findings)
    if (gate := result.gate) is None:
        return rows
    return rows.filter(pa.array([gate.is_gating(name) for name in rows["finding_id"].to_pylist()], pa.bool_()))


def gating_unfixed_findings(result: Result) -> list[ComparedFinding]:
    """Return the baseline's findings that cause exit code 4: of stable rules, severe enough, absent from the run but not fixed."""
    before = None if result.gate is None else result.gate.baseline
    entries = [] if before is None else before.unfixed_findings()
    return [entry for entry in entries if entry.stable and entry.severity in _gating_severities(result)]


def failures_without_finding(result: Result) -> pa.Table:
    """Return the failed verdicts without a finding of the same drive, ego, rule and profile.

    Baseline and waivers exempt findings, not verdicts: such a verdict causes exit code 1 if its rule is stable and severe enough.
    """
    keys = ["drive_id", "ego_id", "rule_id", "profile"]
    keys_of_findings = {tuple(row.values()) for row in result.findings.select(keys).to_pylist()}
    rows = result.verdicts.filter(pc.equal(result.verdicts["verdict"], "fail"))
    return rows.filter(
        pa.array([tuple(row.values()) not in keys_of_findings for row in rows.select(keys).to_pylist()], pa.bool_())
    )


def gating_unknowns(result: Result) -> pa.Table:
    """Return the verdicts that cause exit code 4 as unknown: of every stable rule (with `strict`), or of the required stable rules.

    They include verdicts that are not applicable because the log lacks a signal.
    """
    rows = _rows_of_stable_rules(result, result.verdicts)
    rows = rows.filter(
        pc.or_(pc.equal(rows["verdict"], "unknown"), pc.starts_with(rows["reason_code"], UNRECORDED_PREFIX))
    )
    required = pa.array(result.required, pa.string())
    return rows if result.strict else rows.filter(pc.is_in(rows["rule_id"], value_set=required))


def gating_verdicts_lacking_signal(result: Result) -> pa.Table:
    """Return the verdicts of `gating_unknowns` that are not applicable because the log lacks a signal."""
    return verdicts_lacking_signal(gating_unknowns(result))


def why_too_little_decided(result: Result) -> str | None:
    """Return why this run decided too little (exit code 4): nothing, or a smaller share than `min_judged`; None: it decided enough."""
    if _rows_of_stable_rules(result, result.verdicts).num_rows and (why := _why_nothing_decided(result)):
        return why
    share = None if result.min_judged is None else decided_share(result.verdicts)
    if share is None or result.min_judged is None or share >= result.min_judged:
        return None
    # rounded down: a share below the limit must not be shown as equal to the limit
    return f"{int(1000 * share) / 10:g} % of the rules that may apply were decided, fewer than {100 * result.min_judged:g} % (--min-judged)"


def decided_share(verdicts: pa.Table) -> float | None:
    """Return the share of decided rules among the rules that may apply, see `decision_counts`; None if no rule may apply."""
    n_decided, n = decision_counts(verdicts)
    return n_decided / n if n else None


def decision_counts(verdicts: pa.Table) -> tuple[int, int]:
    """Return how many rules are decided, and how many may apply; each rule is counted per drive and ego.

    A rule is decided if any of its verdicts for this drive and ego is pass or fail. It may apply if any is not "not applicable", or if the
    log lacks a signal that it needs.
    """
    lacks = pc.starts_with(verdicts["reason_code"], UNRECORDED_PREFIX)
    rows = verdicts.select(["drive_id", "ego_id", "rule_id", "verdict"]).append_column("lacks", lacks)
    is_decided: dict[tuple[str, str, str], bool] = {}
    for row in distinct_rows(rows, rows.column_names):
        key = row["drive_id"], row["ego_id"], row["rule_id"]
        if row["verdict"] != "not_applicable" or row["lacks"]:
            is_decided[key] = is_decided.get(key, False) or row["verdict"] in {"pass", "fail"}
    return sum(is_decided.values()), len(is_decided)


def is_first_not_judged_reason_too_little_decided(result: Result) -> bool:
    """Return whether the first reason for exit code 4 is that the run decided too little."""
    first = next(_not_judged_statuses(result), None)
    return first is not None and first.why == why_too_little_decided(result)


def _why_nothing_decided(result: Result) -> str | None:
    """Return why nothing could be decided, in words; None if something was decided."""
    lacking, n = verdicts_lacking_signal(result.verdicts).num_rows, result.verdicts.num_rows
    if not n or _n_of_verdict(result.verdicts, "unknown") + lacking != n:
        return None
    why = "the log lacks a signal for every rule" if lacking == n else "every verdict is unknown"
    return f"nothing failed, because nothing could be decided: {why}"


def ego_absence_texts(drive: Row) -> list[str]:
    """Return how long each ego of a drive is absent from its log, for absences that count as a loss. `drive`: a row of `drive`."""
    return [
        finding["message"].partition(",")[0] for finding in drive["quality"] if finding["check_id"] == EGO_ABSENT_CHECK
    ]


def map_misfit_reason(drive: Row) -> str | None:
    """Return why the map does not fit a drive, for its first ego; None if the map fits an ego, the fit is unknown, or there is no map.

    `drive`: a row of the table `drive`.
    """
    reasons = {
        row["ego_id"]: str(row["reason"]) for row in drive["not_judged"] if row["reason_code"] in MAP_MISFIT_CODES
    }
    egos = [ego["ego_id"] for ego in drive["exposure"]]
    return reasons[egos[0]] if egos and reasons.keys() >= set(egos) else None


def _n_of_verdict(verdicts: pa.Table, verdict: str) -> int:
    return int(pc.sum(pc.equal(verdicts["verdict"], verdict)).as_py() or 0)


def _rows_of_stable_rules(result: Result, rows: pa.Table) -> pa.Table:
    stable = result.rules.filter(pc.equal(result.rules["status"], "stable"))["rule_id"]
    return rows.filter(pc.is_in(rows["rule_id"], value_set=stable.combine_chunks()))


def _severe_rows_of_stable_rules(result: Result, rows: pa.Table) -> pa.Table:
    """Return the rows of stable rules at or above the severity that causes exit code 1."""
    rows = _rows_of_stable_rules(result, rows)
    return rows.filter(pc.is_in(rows["severity"], value_set=pa.array(_gating_severities(result), pa.string())))


def _gating_severities(result: Result) -> tuple[str, ...]:
    return () if result.fail_on == "never" else SEVERITIES[: SEVERITIES.index(result.fail_on) + 1]


def _failure_words(result: Result) -> str:
    """Return the reason for exit code 1, in words; '' for none."""
    failures, bare = (
        len(one_finding_per_event(gating_findings(result).to_pylist())),
        _severe_rows_of_stable_rules(result, failures_without_finding(result)).num_rows,
    )
    new = "new finding" if result.gate is not None and result.gate.baseline is not None else "finding"
    parts = [plural(failures, new)] if failures else []
    parts += [f"{plural(bare, 'failed verdict')} without a finding"] if bare else []
    return " and ".join(parts)


def _let_through_words(result: Result) -> str:
    """Return how many severe findings baseline, waivers and confidence exempt, in words; '' without any of these."""
    if (gate := result.gate) is None:
        return ""
    of_standing = group_rows(
        _severe_rows_of_stable_rules(result, result.findings).to_pylist(),
        lambda row: gate.status_at_gate(row["finding_id"]),
    )
    is_listed = {
        "known": gate.baseline is not None,
        "waived": bool(gate.waivers),
        "possible": gate.confidence is not None,
    }
    words = {"known": "known", "waived": "waived", "possible": "only possible"}
    through = [
        f"{len(one_finding_per_event(of_standing.get(name, ())))} {words[name]}"
        for name, listed in is_listed.items()
        if listed
    ]
    return f" (of that severity {', '.join(through)})" if through else ""


def _findings_of_unstable_rules_words(result: Result) -> str:
    """Return how many severe findings do not gate because their rules are not stable, in words; '' for none."""
    stable = set(_severe_rows_of_stable_rules(result, result.findings)["finding_id"].to_pylist())
    gating = _gating_severities(result)
    severe = [row for row in result.findings.to_pylist() if row["severity"] in gating]
    n = len(one_finding_per_event([row for row in severe if row["finding_id"] not in stable]))
    rules_text = "a rule that is not stable does" if n == 1 else "rules that are not stable do"
    return f"; {plural(n, 'finding')} of {rules_text} not count" if n else ""


def _unfixed_findings_sentence(result: Result, unfixed: Sequence[ComparedFinding]) -> str:
    """Return in words how many of the baseline's severe findings are absent but not fixed, and why."""
    by_status = {status: [entry for entry in unfixed if entry.standing == status] for status in NOT_FIXED_WORDS}
    why = [f"{n_findings(entries)} {NOT_FIXED_WORDS[status]}" for status, entries in by_status.items() if entries]
    n = n_findings(unfixed)
    verb = "is" if n == 1 else "are"
    subject = f"{plural(n, 'finding')} of the baseline at or above severity {result.fail_on}"
    return f"{subject} {verb} gone but not fixed: {', '.join(why)}"


def _unknown_verdicts_sentence(result: Result, unknown: pa.Table) -> str:
    """Return in words how many verdicts are unknown but may not be: per signal with `strict`, else per required rule."""
    if result.strict:
        rows = unknown.select(["rule_id", "reason_code"]).to_pylist()
        of_signal = group_rows(rows, lambda row: signal_name(row["reason_code"]))
        n_rules = {name: len({row["rule_id"] for row in rows_of_signal}) for name, rows_of_signal in of_signal.items()}
        order = sorted(n_rules.items(), key=lambda item: (-item[1], item[0]))
        why = name_list([f"{name} ({plural(n, 'rule')})" for name, n in order])
        return f"{plural(unknown.num_rows, 'verdict')} unknown: {why} (--strict)"
    of_rules = pc.value_counts(unknown["rule_id"]).to_pylist()
    texts = [
        f"{count['counts']} of {count['values']}" for count in sorted(of_rules, key=lambda count: str(count["values"]))
    ]
    return f"{plural(unknown.num_rows, 'verdict')} of required rules unknown (--require): {name_list(texts)}"
