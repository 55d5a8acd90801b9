"""The gate: which findings of a result may fail a run. A baseline's are known, waived ones somebody answers for.

Both only change what a finding leads to: verdicts and findings stay as they are, and no clock is in them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from drivelint.errors import UsageError
from drivelint.gate import diff, waivers, words
from drivelint.result.gate import Difference, Entry, Gate, Waiver

if TYPE_CHECKING:
    from datetime import date
    from pathlib import Path

    from drivelint.result.model import Result

__all__ = ["Difference", "Entry", "Gate", "GateInputs", "Waiver", "compared"]


@dataclass(frozen=True)
class GateInputs:
    """What a run is held against: an earlier result, waivers, the day that counts."""

    today: date
    baseline: Result | None = None
    baseline_name: str = "baseline"
    waivers: tuple[Waiver, ...] = ()

    @classmethod
    def of(
        cls, baseline: Path | None, waiver_file: Path | None, settings_file: Path | None, today: date, out: Path | None
    ) -> GateInputs | None:
        """Return what these files say, before any drive is judged; None: nothing was given.

        `settings_file` may hold waivers beside other settings; None: there is none. Errors: `UsageError` for a file or folder
        that cannot be used, or a baseline that this run would overwrite.
        """
        from drivelint.result.load import load

        said = [*(waivers.read(waiver_file) if waiver_file else ()), *(_beside(settings_file) if settings_file else ())]
        if baseline is None and not said:
            return None
        if baseline is not None and out is not None and baseline.resolve() == out.resolve():
            raise UsageError(
                f"--baseline {baseline}: is also --out: what is new today would be known tomorrow; write the results elsewhere"
            )
        earlier = None if baseline is None else load(baseline)
        name = "baseline" if baseline is None else baseline.resolve().name
        return cls(today, earlier, name, tuple(said))

    def gate(self, result: Result) -> Result:
        """Return the result with what its gate knows."""
        stated, waived = waivers.apply(self.waivers, result, self.today)
        difference = None
        if self.baseline is not None:
            difference = diff.compare(self.baseline, result, self.baseline_name, "this result")
        today = self.today.isoformat() if self.waivers else None
        return replace(result, gate=Gate(today, difference, stated, waived))


def compared(base: Result, new: Result, names: tuple[str, str], fail_on: str) -> tuple[Difference, list[Entry]]:
    """Return what differs between two results, and the new findings that gate; `names` are for the reader."""
    found = diff.compare(base, new, *names)
    return found, words.gating(found, fail_on, new.gate)


def _beside(settings_file: Path) -> list[Waiver]:
    return waivers.read(settings_file, alone=False) if settings_file.is_file() else []
