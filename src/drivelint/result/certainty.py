"""Classifies a finding as sure or only possible, by the share of the drive's copies with recording errors that keep it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from collections.abc import Mapping

SURE: Final = "sure"
POSSIBLE: Final = "possible"
LEAST_SHARE_OF_COPIES_FOR_CERTAIN_FINDING: Final = 0.95
"""The share of copies that must keep a finding; below that share the finding is only possible."""


def certainty(finding: Mapping[str, Any], least_share: float = LEAST_SHARE_OF_COPIES_FOR_CERTAIN_FINDING) -> str | None:
    """Return `SURE` or `POSSIBLE` for a row of the table `finding`; None if no copies were judged."""
    if finding["n_copies"] is None:
        return None
    return SURE if finding["n_stays"] >= least_share * finding["n_copies"] else POSSIBLE


def doubt_words(row: Mapping[str, Any]) -> str:
    """Return in words that a finding is only possible, and in how many copies; '' for other findings and for verdicts."""
    if row.get("n_copies") is None or certainty(row) == SURE:
        return ""
    return f"possible, in {row['n_stays']} of {row['n_copies']} copies with recording errors"
