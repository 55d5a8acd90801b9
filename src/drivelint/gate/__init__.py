"""The gate decides which findings fail a run: findings that are not in the baseline and that no waiver covers.

Baseline and waivers only change the effect of a finding on the exit code. Verdicts and findings stay unchanged, and do not depend on a
clock.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import msgspec

from drivelint.errors import UsageError
from drivelint.gate import descriptions, diff, waivers
from drivelint.result.certainty import POSSIBLE, certainty
from drivelint.result.gate import ComparedFinding, Difference, Gate, Waiver
from drivelint.result.load import load_result

if TYPE_CHECKING:
    from collections.abc import Callable
    from datetime import date
    from pathlib import Path

    from drivelint.result.model import Result

__all__ = [
    "ComparedFinding",
    "Difference",
    "Gate",
    "GateInputs",
    "Waiver",
    "compare_results",
    "refuse_to_overwrite_baseline",
]


@dataclass(frozen=True)
class GateInputs:
    """The inputs of the gate: the baseline, the waivers, and the day on which waivers must be valid."""

    today: date
    baseline: Result | None = None
    baseline_name: str = "baseline"
    waivers: tuple[Waiver, ...] = ()
    confidence: float | None = None

    @classmethod
    def from_files(
        cls,
        baseline: Path | None,
        waiver_file: Path | None,
        settings_file: Path | None,
        today: date,
        out: Path | None,
        *,
        confidence: float | None = None,
        load: Callable[[Path], Result] = load_result,
    ) -> GateInputs | None:
        """Return the gate inputs in these files; None if the files contain none.

        `settings_file` may contain waivers besides other settings; it may be None or missing. `load`: function that reads a baseline.
        Errors: `UsageError` for an unusable file or folder, or a baseline that this run would overwrite.
        """
        all_waivers = waivers.read(waiver_file) if waiver_file else []
        if settings_file and settings_file.is_file():
            all_waivers += waivers.read(settings_file, only_waivers=False)
        if baseline is None and not all_waivers and confidence is None:
            return None
        refuse_to_overwrite_baseline(baseline, out)
        if baseline is None:
            return cls(today, waivers=tuple(all_waivers), confidence=confidence)
        return cls(today, load(baseline), baseline.resolve().name, tuple(all_waivers), confidence)

    def apply_to(self, result: Result) -> Result:
        """Return the result with its gate: the difference from the baseline, the applied waivers, and the findings that are only
        possible."""
        stated, waived = waivers.states_and_matches(self.waivers, result, self.today)
        difference = None
        if self.baseline is not None:
            difference = diff.compare(self.baseline, result, self.baseline_name, "this result")
        today = self.today.isoformat() if self.waivers else None
        possible: list[str] = []
        if self.confidence is not None:
            rows = result.findings.select(["finding_id", "n_copies", "n_stays"]).to_pylist()
            possible = sorted(row["finding_id"] for row in rows if certainty(row, self.confidence) == POSSIBLE)
        return replace(result, gate=Gate(today, difference, stated, waived, self.confidence, tuple(possible)))


def refuse_to_overwrite_baseline(baseline: Path | None, out: Path | None) -> None:
    """Raise `UsageError` if the run would overwrite its own baseline."""
    if baseline is not None and out is not None and baseline.resolve() == out.resolve():
        raise UsageError(
            f"--baseline {baseline}: is also --out: findings that are new now would be known in the next run; "
            "write the results into another folder"
        )


def compare_results(
    base: Result, new: Result, names: tuple[str, str], fail_on: str
) -> tuple[Difference, list[ComparedFinding]]:
    """Return the difference of two results, and its new findings that fail the run."""
    difference = msgspec.structs.replace(diff.compare(base, new, *names), is_partial=new.interrupted)
    return difference, descriptions.gating_findings(difference, fail_on, new.gate)
