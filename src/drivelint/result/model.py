"""Defines the result of a run: its tables, its exit code and the reason for that."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final, NamedTuple

import pyarrow as pa
import pyarrow.compute as pc

from drivelint.errors import ExitCode
from drivelint.phrases import plural
from drivelint.result.counts import SEVERITIES
from drivelint.result.schemas import TABLE_OF_FILE, conform, empty_table

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from drivelint.result.gate import Gate
    from drivelint.result.request import RunRequest
    from drivelint.result.text import Row


MISFITS: Final = frozenset({"ego_not_a_vehicle", "seldom_on_lane", "often_against_lane", "far_from_centre_line"})
"""Reasons for which the signal `registration` is missing that tell of a map which does not fit."""


class ExitStatus(NamedTuple):
    """The exit code and, in one sentence, why."""

    code: ExitCode
    why: str


@dataclass(frozen=True)
class Result:
    """The tables of one run, totally ordered, each with the columns of `schemas/verdict.sql`, `output.sql` or `evidence.sql`.

    `scenes` to `opportunities`: the evidence for pictures and charts, empty where none was gathered.
    `margins_file`: finished Parquet of every judged step, or None; `write` takes it over.
    `fail_on`: critical, major, minor or never. `strict`: unknown is not good enough.
    `gate`: what findings are known or waived, or None: all gate. `asked`: what the run was asked to do, if that is known.
    Errors: `DriveLintError` when a table lacks a column or has one too many.
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
    margins_file: Path | None = None
    fail_on: str = "critical"
    strict: bool = False
    gate: Gate | None = None
    asked: RunRequest | None = None

    def __post_init__(self) -> None:
        for name, table in TABLE_OF_FILE.items():
            object.__setattr__(self, name, conform(getattr(self, name), table))

    @property
    def start_times(self) -> dict[str, int | None]:
        """drive_id -> the drive's first time stamp in ns, on the log's clock."""
        return dict(zip(self.drives["drive_id"].to_pylist(), self.drives["t_start_ns"].to_pylist(), strict=True))

    @property
    def lossy(self) -> bool:
        """Whether parts of a judged log could not be read."""
        return bool(pc.any(pc.and_(self.drives["lossy"], pc.equal(self.drives["status"], "judged"))).as_py())


def exit_status(result: Result) -> ExitStatus:
    """Return the exit code of DESIGN.md, by its precedence 2 > 1 > 4 > 3 > 0, and why.

    Only stable rules gate: a draft's failure or unknown is shown, never an exit code. A rule that erred is always 2.
    """
    return next(_outcomes(result))


def _outcomes(result: Result) -> Iterator[ExitStatus]:
    """Yield what the run comes to, weightiest first."""
    gating = _of_stable_rules(result, result.verdicts)
    if errors := _count(result.verdicts, "error"):
        yield ExitStatus(ExitCode.USAGE, f"{plural(errors, 'verdict')} in error: a rule could not be run")
    let_through = ""
    if result.gate is None:
        if failed := _count(_at_or_above(gating, result.fail_on), "fail"):
            yield ExitStatus(
                ExitCode.FAILED, f"{plural(failed, 'verdict')} failed at or above severity {result.fail_on}"
            )
    else:
        stopped, let_through = _gate(result, result.gate, gating)
        if stopped:
            yield ExitStatus(ExitCode.FAILED, f"{stopped} at or above severity {result.fail_on}{let_through}")
    if lost := int(pc.sum(pc.equal(result.drives["status"], "not_judged")).as_py() or 0):
        yield ExitStatus(
            ExitCode.NOT_JUDGED, f"{lost} of {plural(result.drives.num_rows, 'drive')} could not be judged"
        )
    off_map = [reason for drive in result.drives.to_pylist() if (reason := off_map_reason(drive)) is not None]
    if off_map:
        drives = plural(result.drives.num_rows, "drive")
        yield ExitStatus(ExitCode.NOT_JUDGED, f"the map does not fit {len(off_map)} of {drives}: {off_map[0]}")
    if result.strict and (unknown := _count(gating, "unknown")):
        yield ExitStatus(ExitCode.NOT_JUDGED, f"{plural(unknown, 'verdict')} unknown, and --strict is set")
    if result.lossy:
        yield ExitStatus(ExitCode.LOSSY, "judged on lossy input: parts of a log were lost")
    if result.fail_on == "never":
        yield ExitStatus(ExitCode.OK, "failures do not gate (--fail-on never)")
    if _count(result.verdicts, "unknown") == result.verdicts.num_rows > 0:
        yield ExitStatus(
            ExitCode.OK, "nothing failed, as nothing could be decided: every verdict is unknown (--strict makes it 4)"
        )
    new = "new " if result.gate is not None and result.gate.baseline is not None else ""
    yield ExitStatus(ExitCode.OK, f"nothing {new}failed at or above severity {result.fail_on}{let_through}")


def off_map_reason(drive: Row) -> str | None:
    """Return why the map does not fit a drive, by its first ego; None: it fits some ego, it is not known, or there is no map.

    `drive`: a row of the table `drive`.
    """
    lost = {row["ego_id"]: str(row["reason"]) for row in drive["not_judged"] if row["reason_code"] in MISFITS}
    egos = [ego["ego_id"] for ego in drive["exposure"]]
    return lost[egos[0]] if egos and lost.keys() >= set(egos) else None


def _count(verdicts: pa.Table, verdict: str) -> int:
    return int(pc.sum(pc.equal(verdicts["verdict"], verdict)).as_py() or 0)


def _of_stable_rules(result: Result, rows: pa.Table) -> pa.Table:
    stable = result.rules.filter(pc.equal(result.rules["status"], "stable"))["rule_id"]
    return rows.filter(pc.is_in(rows["rule_id"], value_set=stable.combine_chunks()))


def _at_or_above(rows: pa.Table, fail_on: str) -> pa.Table:
    if fail_on == "never":
        return rows.slice(0, 0)
    return rows.filter(pc.is_in(rows["severity"], value_set=pa.array(SEVERITIES[: SEVERITIES.index(fail_on) + 1])))


def _gate(result: Result, gate: Gate, gating: pa.Table) -> tuple[str, str]:
    """Return what a gate stops ('' for nothing) and what it lets through, in words.

    It lets findings through, not verdicts: a failed verdict of a drive, ego, rule and profile without any finding is stopped.
    """
    findings = _at_or_above(_of_stable_rules(result, result.findings), result.fail_on)
    ids = findings["finding_id"].to_pylist()
    waived = sum(gate.waiver(name) is not None for name in ids)
    known = sum(gate.waiver(name) is None and gate.in_baseline(name) for name in ids)
    possible = sum(gate.is_possible(name) and gate.waiver(name) is None and not gate.in_baseline(name) for name in ids)
    stopped = len(ids) - waived - known - possible
    keys = ["drive_id", "ego_id", "rule_id", "profile"]
    told = {tuple(row.values()) for row in findings.select(keys).to_pylist()}
    failed = _at_or_above(gating, result.fail_on)
    failed = failed.filter(pc.equal(failed["verdict"], "fail")).select(keys)
    bare = sum(tuple(row.values()) not in told for row in failed.to_pylist())
    new = "new finding" if gate.baseline is not None else "finding"
    parts = [plural(stopped, new)] if stopped else []
    parts += [f"{plural(bare, 'failed verdict')} without a finding"] if bare else []
    through = [f"{known} known"] if gate.baseline is not None else []
    through += [f"{waived} waived"] if gate.waivers else []
    through += [f"{possible} only possible"] if gate.confidence is not None else []
    return " and ".join(parts), f" ({', '.join(through)})" if through else ""
