"""A verdict with everything needed to judge it again: rule, parameters and profiles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from drivelint.explain import evidence
from drivelint.explain.outcome import verdicts_by_drive
from drivelint.explain.sandbox import Sandbox, crop

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import pyarrow as pa

    from drivelint.catalogue import Rule
    from drivelint.engine.batch import Drive
    from drivelint.explain.model import Step
    from drivelint.explain.sandbox import Judgement
    from drivelint.explain.target import Target


@dataclass(frozen=True)
class VerdictContext:
    """A verdict to explain."""

    rule: Rule
    target: Target
    params: Mapping[str, object]
    profiles: pa.Table
    memory: int | None

    def sandbox(self, drives: Sequence[Drive]) -> Sandbox:
        """Return a database with these drives, derived for the rule."""
        return Sandbox(self.rule, drives, self.profiles, self.memory)

    def judge(self, sandbox: Sandbox, params: Mapping[str, object] | None = None) -> str:
        """Return the verdict on the one drive in a sandbox, with other parameters if they are given."""
        return self.verdicts_on(sandbox.judge(self.params if params is None else params), [sandbox.drive_id])[0]

    def verdicts_on(self, judged: Judgement, drives: Sequence[str]) -> list[str]:
        """Return the verdict on each of these drives, in their order."""
        found = verdicts_by_drive(self.rule, self.target, judged, drives)
        return [found[drive] for drive in drives]

    @property
    def lacks_signal(self) -> bool:
        """Whether the rule was not run because the log or map lacks something: no number alters that."""
        code = "" if self.target.finding else self.target.verdict["reason_code"]
        return lacks_signal(self.target.verdict["verdict"], code)


CROP_MARGINS_NS = (20_000_000_000, 60_000_000_000)
"""How much of a drive around what is explained is enough, if the verdict is the same there; tried in this order."""


def lacks_signal(verdict: str, reason_code: str) -> bool:
    """Whether a verdict is unknown for want of a signal that the rule requires."""
    return verdict == "unknown" and reason_code.startswith("missing_") and reason_code != "missing_step"


def sufficient_part(case: VerdictContext, drive: Drive, now: str) -> tuple[Drive, tuple[int, int] | None]:
    """Return the shortest tried part of a drive with the same verdict, and its interval; None for the whole drive."""
    span = case.target.span
    if span is None or now == "not_applicable":
        return drive, None
    log = drive.trace.tables["data_log"].to_pylist()[0]
    for margin in CROP_MARGINS_NS:
        part = (max(log["t_start_ns"], span[0] - margin), min(log["t_end_ns"], span[1] + margin))
        if part == (log["t_start_ns"], log["t_end_ns"]):
            break
        small = crop(drive, *part)
        with case.sandbox([small]) as sandbox:
            judged = sandbox.judge(case.params)
            if case.verdicts_on(judged, [sandbox.drive_id]) == [now] and _same_numbers(
                case, evidence.judged_steps(case.rule, case.target, judged)
            ):
                return small, part
    return drive, None


def _same_numbers(case: VerdictContext, series: list[Step]) -> bool:
    """Tell whether the deciding step has the same numbers in a part of the drive as in all of it."""
    row = case.target.verdict_row
    if case.rule.sense == "holds" or row["margin"] is None:
        return True
    here = [step.margin for step in series if step.t_ns == row["t_worst_ns"] and step.margin is not None]
    return any(abs(margin - row["margin"]) < 1e-6 for margin in here)
