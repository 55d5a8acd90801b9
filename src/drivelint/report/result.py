"""What a run comes to: its tables, its exit code with the reason, its files."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

import pyarrow as pa
import pyarrow.compute as pc

from drivelint.errors import ExitCode
from drivelint.report.contract import FILES, conform, empty
from drivelint.report.counts import SEVERITIES

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path


class Outcome(NamedTuple):
    """The exit code and, in one sentence, why."""

    code: ExitCode
    why: str


@dataclass(frozen=True)
class Result:
    """The tables of one run, totally ordered, each with the columns of `schemas/verdict.sql`, `output.sql` or `evidence.sql`.

    `scenes`, `lanes`: the evidence for pictures, empty where none was gathered.
    `margins_file`: finished Parquet of every judged step, or None; `write` takes it over.
    `fail_on`: critical, major, minor or never. `strict`: unknown is not good enough.
    Errors: `DriveLintError` when a table lacks a column or has one too many.
    """

    verdicts: pa.Table
    findings: pa.Table
    drives: pa.Table
    rules: pa.Table
    scenes: pa.Table = field(default_factory=lambda: empty("scene"))
    lanes: pa.Table = field(default_factory=lambda: empty("lane_shape"))
    margins_file: Path | None = None
    fail_on: str = "critical"
    strict: bool = False

    def __post_init__(self) -> None:
        for name, table in FILES.items():
            object.__setattr__(self, name, conform(getattr(self, name), table))

    @property
    def lossy(self) -> bool:
        """Some judged drive had lost parts of its log."""
        return bool(pc.any(pc.and_(self.drives["lossy"], pc.equal(self.drives["status"], "judged"))).as_py())


def outcome(result: Result) -> Outcome:
    """Return the exit code of DESIGN.md, by its precedence 2 > 1 > 4 > 3 > 0, and why.

    Only stable rules gate: a draft's failure or unknown is shown, never an exit code. A rule that erred is always 2.
    """
    return next(_outcomes(result))


def _outcomes(result: Result) -> Iterator[Outcome]:
    """Yield what the run comes to, weightiest first."""
    gating = _rows_of(result.verdicts, result.rules.filter(pc.equal(result.rules["status"], "stable")))
    if errors := _count(result.verdicts, "error"):
        yield Outcome(ExitCode.USAGE, f"{_many(errors, 'verdict')} in error: a rule could not be run")
    if failed := _failed(gating, result.fail_on):
        yield Outcome(ExitCode.FAILED, f"{_many(failed, 'verdict')} failed at or above severity {result.fail_on}")
    if lost := int(pc.sum(pc.equal(result.drives["status"], "not_judged")).as_py() or 0):
        yield Outcome(ExitCode.NOT_JUDGED, f"{lost} of {_many(result.drives.num_rows, 'drive')} could not be judged")
    if result.strict and (unknown := _count(gating, "unknown")):
        yield Outcome(ExitCode.NOT_JUDGED, f"{_many(unknown, 'verdict')} unknown, and --strict is set")
    if result.lossy:
        yield Outcome(ExitCode.LOSSY, "judged on lossy input: parts of a log were lost")
    if result.fail_on == "never":
        yield Outcome(ExitCode.OK, "failures do not gate (--fail-on never)")
    yield Outcome(ExitCode.OK, f"nothing failed at or above severity {result.fail_on}")


def exit_code(result: Result) -> ExitCode:
    """Return the exit code of DESIGN.md for a finished run."""
    return outcome(result).code


def _many(n: int, noun: str) -> str:
    return f"{n} {noun}" if n == 1 else f"{n} {noun}s"


def _count(verdicts: pa.Table, verdict: str) -> int:
    return int(pc.sum(pc.equal(verdicts["verdict"], verdict)).as_py() or 0)


def _rows_of(verdicts: pa.Table, rules: pa.Table) -> pa.Table:
    return verdicts.filter(pc.is_in(verdicts["rule_id"], value_set=rules["rule_id"].combine_chunks()))


def _failed(verdicts: pa.Table, fail_on: str) -> int:
    if fail_on == "never":
        return 0
    gates = pa.array(SEVERITIES[: SEVERITIES.index(fail_on) + 1])
    return _count(verdicts.filter(pc.is_in(verdicts["severity"], value_set=gates)), "fail")
