"""Finds the verdict that a repeated judgement gives for the explained verdict."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Iterable

    from drivelint.catalogue import Rule
    from drivelint.explain.model import Row, Step
    from drivelint.explain.sandbox import Judgement
    from drivelint.explain.target import Target

SAME_REFERENCE_NS: Final = 2_000_000_000
"""A reference point that moved by no more is the same one."""
_WORST: Final = ("error", "fail", "unknown", "pass", "not_applicable")


def verdicts_by_drive(rule: Rule, target: Target, judged: Judgement, drives: Iterable[str]) -> dict[str, str]:
    """Return, for each drive, the verdict on the target's interval, profile and object."""
    verdicts: dict[str, list[Row]] = {drive: [] for drive in drives}
    steps: dict[str, list[Row]] = {drive: [] for drive in verdicts}
    for row in judged.verdicts:
        if _same(rule, target, row):
            verdicts[row["drive_id"]].append(row)
    for row in judged.steps:
        if _same(rule, target, row):
            steps[row["drive_id"]].append(row)
    return {drive: _outcome(rule, target, verdicts[drive], steps[drive]) for drive in verdicts}


def _same(rule: Rule, target: Target, row: Row) -> bool:
    if row["ego_id"] != target.verdict_row["ego_id"] or row["profile"] != target.verdict_row["profile"]:
        return False
    about_all = target.span is None or rule.combine != "each"  # then the object is only the one that decided
    return about_all or row["object_id"] == target.verdict_row["object_id"]


def _outcome(rule: Rule, target: Target, verdicts: list[Row], steps: list[Row]) -> str:
    span = target.span
    if any(row["verdict"] == "error" for row in verdicts):
        return "error"
    if span is None:
        return _worst(verdicts)
    if rule.kind != "invariant":
        return _worst(_at_reference(target, verdicts))
    within = [row["holds"] for row in steps if span[0] <= row["t_ns"] <= span[1]]
    if any(holds is False for holds in within):
        return "fail"
    over = [row for row in verdicts if _overlaps(row, span)]
    if any(holds is None for holds in within) or (not within and any(row["verdict"] == "unknown" for row in over)):
        return "unknown"
    return "pass" if within else "not_applicable"


def _at_reference(target: Target, verdicts: list[Row]) -> list[Row]:
    """Return the verdicts at the reference point nearest to the target's."""
    t_ref = target.verdict_row["t_ref_ns"]
    if t_ref is None:
        return verdicts
    apart = {id(row): abs(row["t_ref_ns"] - t_ref) for row in verdicts if row["t_ref_ns"] is not None}
    least = min(apart.values(), default=SAME_REFERENCE_NS + 1)
    return [row for row in verdicts if apart.get(id(row)) == least] if least <= SAME_REFERENCE_NS else []


def _overlaps(row: Row, span: tuple[int, int]) -> bool:
    if row["t_start_ns"] is None or row["t_end_ns"] is None:
        return True
    return bool(row["t_start_ns"] <= span[1] and row["t_end_ns"] >= span[0])


def _worst(rows: list[Row]) -> str:
    return min((row["verdict"] for row in rows), key=_WORST.index, default="not_applicable")


def first_unknown(series: Iterable[Step]) -> int | None:
    """Return the time of the first step that could not be judged."""
    return next((step.t_ns for step in series if step.holds is None), None)
