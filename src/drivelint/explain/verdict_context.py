"""A verdict with its rule, parameters and profiles, with which the verdict can be judged again."""

from __future__ import annotations

from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from drivelint.engine.batch import have_few_states
from drivelint.engine.robustness.copies import crop
from drivelint.explain import evidence
from drivelint.explain.sandbox import Sandbox
from drivelint.reasons.signals import MISSING_PREFIX, UNRECORDED_PREFIX
from drivelint.result.counts import group_rows
from drivelint.sql import store

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    import pyarrow as pa

    from drivelint.catalogue import Rule
    from drivelint.engine.batch import Drive
    from drivelint.explain.model import Row, Step
    from drivelint.explain.sandbox import Judgement
    from drivelint.explain.target import Target

SAME_REFERENCE_POINT_TOLERANCE_NS: Final = 2_000_000_000
"""A reference point that moved by at most this time counts as the same reference point."""
TRIED_CROP_MARGINS_NS = (20_000_000_000, 60_000_000_000)
"""The margins around the explained interval with which parts of the drive are tried, in this order."""
_VERDICTS_FROM_WORST: Final = ("error", "fail", "unknown", "pass", "not_applicable")


@dataclass(frozen=True)
class VerdictContext:
    """A verdict to explain, with the rule, parameters and profiles to judge it again."""

    rule: Rule
    target: Target
    params: Mapping[str, object]
    profiles: pa.Table
    memory: int | None

    @contextmanager
    def sandbox(self, drives: Sequence[Drive]) -> Iterator[Sandbox]:
        """Open a sandbox: a database with these drives and the derived tables that the rule needs."""
        with store.temporary_database(self.memory, threads=1 if have_few_states(drives) else None) as con:
            yield Sandbox(self.rule, drives, self.profiles, con, self.memory)

    def verdicts_on(self, judgement: Judgement, drives: Sequence[str]) -> list[str]:
        """Return the verdict on the target's interval, profile and object in each of these drives, in the same order."""
        verdict_row, about = self.target.verdict_row, ["ego_id", "profile"]
        if (
            self.target.judged_span_ns is not None and self.rule.combine == "each"
        ):  # else it is just the deciding object
            about.append("object_id")
        verdicts, steps = (
            group_rows(
                (row for row in rows if all(row[name] == verdict_row[name] for name in about)),
                lambda row: row["drive_id"],
            )
            for rows in (judgement.verdicts, judgement.steps)
        )
        return [
            _verdict_word_on_target(self.rule, self.target, verdicts.get(drive, []), steps.get(drive, []))
            for drive in drives
        ]


def lacks_signal(row: Row) -> bool:
    """Return whether a required signal is missing: the rule then did not run. Its verdict is unknown, or not applicable (unrecorded)."""
    code: str = row["reason_code"]
    is_missing = row["verdict"] == "unknown" and code.startswith(MISSING_PREFIX) and code != "missing_step"
    return is_missing or (row["verdict"] == "not_applicable" and code.startswith(UNRECORDED_PREFIX))


def shortest_part_with_same_verdict(
    context: VerdictContext, drive: Drive, sandbox: Sandbox, verdict: str, exit_stack: ExitStack
) -> tuple[Drive, tuple[int, int] | None, Sandbox]:
    """Return the shortest tried part of a drive with the same verdict, its interval (None: the whole drive), and a sandbox with it.

    `sandbox` contains the whole drive. `exit_stack` closes the sandbox of a part.
    """
    span = context.target.judged_span_ns
    if span is None or verdict == "not_applicable":
        return drive, None, sandbox
    log = drive.trace.tables["data_log"].to_pylist()[0]
    for margin in TRIED_CROP_MARGINS_NS:
        part = (max(log["t_start_ns"], span[0] - margin), min(log["t_end_ns"], span[1] + margin))
        if part == (log["t_start_ns"], log["t_end_ns"]):
            break
        small = crop(drive, *part)
        with ExitStack() as tried:
            of_part = tried.enter_context(context.sandbox([small]))
            judgement = of_part.judge(context.params)
            if context.verdicts_on(judgement, [of_part.drive_id]) == [verdict] and _has_same_margin(
                context, evidence.judged_steps(context.rule, context.target, judgement)
            ):
                exit_stack.push(tried.pop_all())
                return small, part, of_part
    return drive, None, sandbox


def _has_same_margin(context: VerdictContext, series: list[Step]) -> bool:
    """Return whether the deciding step has the same margin in a part of the drive as in the whole drive."""
    row = context.target.verdict_row
    if context.rule.sense == "holds" or row["margin"] is None:
        return True
    here = [step.margin for step in series if step.t_ns == row["t_worst_ns"] and step.margin is not None]
    return any(abs(margin - row["margin"]) < 1e-6 for margin in here)


def _verdict_word_on_target(rule: Rule, target: Target, verdicts: list[Row], steps: list[Row]) -> str:
    span = target.judged_span_ns
    if any(row["verdict"] == "error" for row in verdicts):
        return "error"
    if span is None:
        return _worst_verdict(verdicts)
    if rule.kind != "invariant":
        return _worst_verdict(_verdicts_at_nearest_reference_point(target, verdicts))
    within = [row["holds"] for row in steps if span[0] <= row["t_ns"] <= span[1]]
    if any(holds is False for holds in within):
        return "fail"
    open_ = [(row["t_start_ns"], row["t_end_ns"]) for row in verdicts if row["verdict"] == "unknown"]
    over = any(None in times or (times[0] <= span[1] and times[1] >= span[0]) for times in open_)
    if any(holds is None for holds in within) or (over and not within):
        return "unknown"
    return "pass" if within else "not_applicable"


def _verdicts_at_nearest_reference_point(target: Target, verdicts: list[Row]) -> list[Row]:
    """Return the verdicts at the reference point nearest to the target's.

    [] if it is more than `SAME_REFERENCE_POINT_TOLERANCE_NS` away.
    """
    t_ref = target.verdict_row["t_ref_ns"]
    if t_ref is None:
        return verdicts
    apart = {id(row): abs(row["t_ref_ns"] - t_ref) for row in verdicts if row["t_ref_ns"] is not None}
    least = min(apart.values(), default=SAME_REFERENCE_POINT_TOLERANCE_NS + 1)
    return (
        [row for row in verdicts if apart.get(id(row)) == least] if least <= SAME_REFERENCE_POINT_TOLERANCE_NS else []
    )


def _worst_verdict(rows: list[Row]) -> str:
    return min((row["verdict"] for row in rows), key=_VERDICTS_FROM_WORST.index, default="not_applicable")
