"""The one word that a run's result comes to, for every report that a person reads."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from drivelint.errors import ExitCode
from drivelint.result import counts
from drivelint.result.model import exit_status

if TYPE_CHECKING:
    from collections.abc import Iterable

    from drivelint.result.model import Result
    from drivelint.result.text import Row

LABELS: Final = {
    ExitCode.OK: "PASS",
    ExitCode.FAILED: "FAIL",
    ExitCode.USAGE: "ERROR",
    ExitCode.LOSSY: "LOSSY",
    ExitCode.NOT_JUDGED: "NOT JUDGED",
    ExitCode.INTERRUPTED: "PARTIAL",
}


def outcome_label(result: Result, n_findings: int) -> str:
    """Return the word. Findings that do not gate are no pass, nor is a run that decided nothing.

    `n_findings`: findings that a baseline or a waiver does not let through.
    """
    code, decided = exit_status(result).code, counts.total(result.verdicts)
    if code == ExitCode.OK and (n_findings or not decided["pass"] + decided["fail"]):
        return "FINDINGS" if n_findings else "UNKNOWN"
    return LABELS.get(code, "?")


def by_severity(rows: Iterable[Row]) -> str:
    """Return how many findings there are of each severity; '' for none."""
    found = [row["severity"] for row in rows]
    return ", ".join(f"{found.count(severity)} {severity}" for severity in counts.SEVERITIES if severity in found)
